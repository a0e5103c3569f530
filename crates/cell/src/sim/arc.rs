//! A simulated welding power source.

use seamline::arc::{ArcCommand, ArcSource};

use super::random::Random;
use crate::cell::Cell;

/// A power source whose arc burns some time after the current is on; deterministic.
#[derive(Debug, Clone)]
pub struct SimulatedArc {
    /// Seconds from current to arc.
    ignition: f64,
    /// Probability that a strike does not light.
    misfire: f64,
    random: Random,
    /// Seconds since the current came on; `None` without current.
    elapsed: Option<f64>,
    misfires: bool,
    fault: Option<ArcFault>,
}

/// A fault to try the controller with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArcFault {
    /// No strike lights.
    NoIgnition,
    /// A burning arc goes out, and comes back with the next strike.
    Loss,
}

impl SimulatedArc {
    /// An arc that burns `ignition` seconds after the current is on, and not at all with the probability `misfire`.
    #[must_use]
    pub fn new(ignition: f64, misfire: f64, seed: u64) -> Self {
        let random = Random::new(seed);
        Self { ignition, misfire, random, elapsed: None, misfires: false, fault: None }
    }

    /// The power source that a cell describes.
    #[must_use]
    pub fn from_cell(cell: &Cell) -> Self {
        let simulation = &cell.simulation;
        Self::new(simulation.arc_ignition, simulation.arc_misfire, u64::from(simulation.seed))
    }

    /// Puts a fault in force.
    pub fn inject(&mut self, fault: ArcFault) {
        self.fault = Some(fault);
    }

    /// Ends the fault.
    pub fn clear_faults(&mut self) {
        self.fault = None;
    }
}

impl ArcSource for SimulatedArc {
    fn exchange(&mut self, command: &ArcCommand, period: f64) -> Option<bool> {
        let before = if command.on { self.elapsed } else { None };
        self.elapsed = command.on.then(|| before.map_or(0.0, |elapsed| elapsed + period));
        let Some(elapsed) = self.elapsed else { return Some(false) };
        if before.is_none() {
            self.misfires = self.random.unit() < self.misfire || self.fault == Some(ArcFault::NoIgnition);
            if self.fault == Some(ArcFault::Loss) {
                self.fault = None;
            }
        }
        Some(!self.misfires && self.fault != Some(ArcFault::Loss) && elapsed >= self.ignition)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamline::arc::ArcSetting;

    fn burns(arc: &mut SimulatedArc, on: bool, cycles: u32) -> Option<bool> {
        let command = ArcCommand { on, setting: ArcSetting::NONE };
        (0..cycles).map(|_| arc.exchange(&command, 1e-3)).last().flatten()
    }

    #[test]
    fn it_lights_late_goes_out_at_once_and_comes_back() {
        let mut arc = SimulatedArc::new(0.03, 0.0, 1);
        assert_eq!(burns(&mut arc, true, 30), Some(false));
        assert_eq!(burns(&mut arc, true, 2), Some(true));
        arc.inject(ArcFault::Loss);
        assert_eq!(burns(&mut arc, true, 100), Some(false));
        assert_eq!(burns(&mut arc, false, 1), Some(false));
        assert_eq!(burns(&mut arc, true, 40), Some(true));
        arc.inject(ArcFault::NoIgnition);
        assert_eq!(burns(&mut arc, false, 1), Some(false));
        assert_eq!(burns(&mut arc, true, 1_000), Some(false));
    }

    #[test]
    fn misfires_are_as_frequent_as_asked_for() {
        let mut arc = SimulatedArc::new(0.0, 0.2, 7);
        let lit = (0..10_000).filter(|_| {
            burns(&mut arc, false, 1);
            burns(&mut arc, true, 1) == Some(true)
        });
        let share = lit.count() as f64 / 10_000.0;
        assert!((share - 0.8).abs() < 0.02, "{share}");
    }
}
