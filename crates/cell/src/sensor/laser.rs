//! A simulated laser on the torch.

use std::collections::VecDeque;

use seamline::path::SeamFrame;
use seamline::seam::{Instant, Reading, SeamSensor, Sensor, TaughtPath};

use super::seam::{Sight, SimulatedSeam};
use crate::cell::{Cell, LaserErrors};
use crate::sim::random::Random;

/// The crossing is looked for so far before and behind the look-ahead, in metres, ...
const SEARCH: f64 = 15e-3;
/// ... by so many halvings: to 10⁻¹⁴ m.
const HALVINGS: usize = 42;
/// Cycles come at rounded times: what is due within a nanosecond is due.
const ROUNDING: f64 = 1e-9;
/// Readings under way at most: a second at 10 kHz. Their places are there from the start.
const UNDER_WAY: usize = 10_000;

/// A laser's plane on the torch. It reads where the seam crosses the plane, hands that over after its latency, and errs at random: equal
/// seeds, equal readings.
///
/// It exposes at the cycle's instants, with the pose that the torch really has; a laser faster than the cycle exposes once a cycle.
#[derive(Debug, Clone)]
pub struct SimulatedLaser {
    seam: SimulatedSeam,
    /// Seconds between two exposures.
    apart: f64,
    latency: f64,
    errors: LaserErrors,
    random: Random,
    next_exposure: f64,
    /// The cycle of the last exposure.
    exposed: f64,
    /// With the times of their arrival.
    under_way: VecDeque<(f64, Reading)>,
}

impl SimulatedLaser {
    /// The laser that a cell describes, on a torch that welds along a taught path beside which the cell's seam runs. Its first exposure is
    /// at a random instant of the first period.
    #[must_use]
    pub fn from_cell(cell: &Cell) -> Self {
        let (sensor, simulation) = (&cell.sensor, &cell.simulation);
        let mut random = Random::new(u64::from(simulation.seed));
        let apart = 1.0 / sensor.rate_hz;
        Self {
            seam: SimulatedSeam { features: simulation.seam.clone() },
            apart,
            latency: sensor.latency,
            errors: simulation.laser,
            next_exposure: apart * random.unit(),
            exposed: f64::NEG_INFINITY,
            random,
            under_way: VecDeque::with_capacity(UNDER_WAY),
        }
    }

    /// The seam: where the weld really belongs.
    #[must_use]
    pub fn seam(&self) -> &SimulatedSeam {
        &self.seam
    }

    fn expose(&mut self, torch: &Instant, sensor: &Sensor, path: &impl TaughtPath) {
        self.exposed = torch.time;
        // After a stretch without cycles the laser goes on from now.
        self.next_exposure = (self.next_exposure + self.apart).max(torch.time);
        // Each exposure takes the same random numbers, whatever is seen: so one error more does not change all that follow.
        let dropped = self.random.unit() < self.errors.dropout_probability;
        let spike = self.random.unit() < self.errors.spike_probability;
        let mut error = || {
            let noise = self.errors.noise * self.random.normal();
            let sign = if self.random.unit() < 0.5 { -1.0 } else { 1.0 };
            if spike { noise + sign * self.errors.spike } else { noise }
        };
        let errors = [error(), error()];
        if dropped || self.under_way.len() == UNDER_WAY {
            return;
        }
        let Some((sight, [lateral, height])) = crossing(&self.seam, torch, sensor, path) else { return };
        let reading = Reading {
            lateral: lateral + errors[0],
            height: height + errors[1],
            gap: Some(sight.gap),
            exposure: torch.time,
            quality: sight.quality,
        };
        self.under_way.push_back((torch.time + self.latency, reading));
    }
}

/// Where the laser's plane cuts the seam: what stands there, and its place along the sensor's y and z. By bisection over the path.
fn crossing(
    seam: &SimulatedSeam,
    torch: &Instant,
    sensor: &Sensor,
    path: &impl TaughtPath,
) -> Option<(Sight, [f64; 2])> {
    let sensor_from_base = (torch.base_from_tcp * sensor.tcp_from_sensor).inverse();
    let seen = |s: f64, sight: Option<Sight>| {
        let jet = path.jet(s);
        let frame = SeamFrame::of(&jet)?;
        let offset = sight.map_or_else(|| seam.offset(s), |sight| sight.offset);
        let aside = frame.vector([0.0, offset.x, offset.y]);
        let point = nalgebra::Point3::from(jet.pose.translation.vector + aside);
        Some((sensor_from_base * point).coords)
    };
    let (first, last) = path.span();
    let near = torch.s + sensor.look_ahead();
    let (mut low, mut high) = ((near - SEARCH).max(first), (near + SEARCH).min(last));
    if low >= high || seen(low, None)?.x > 0.0 || seen(high, None)?.x < 0.0 {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if seen(middle, None)?.x < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let sight = seam.sight(low)?;
    let point = seen(low, Some(sight))?;
    Some((sight, [point.y, point.z]))
}

impl SeamSensor for SimulatedLaser {
    fn poll(&mut self, torch: &Instant, sensor: &Sensor, path: &impl TaughtPath) -> Option<Reading> {
        if torch.time + ROUNDING >= self.next_exposure && torch.time > self.exposed {
            self.expose(torch, sensor, path);
        }
        let due = self.under_way.front().is_some_and(|(arrival, _)| *arrival <= torch.time + ROUNDING);
        if due { self.under_way.pop_front().map(|(_, reading)| reading) } else { None }
    }
}
