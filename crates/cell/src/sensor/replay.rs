//! Readings of an earlier run once more.

use seamline::seam::{Instant, Reading, SeamSensor, Sensor, TaughtPath};

use super::csv::Arrival;

/// Recorded readings, each handed over at its time of arrival on the cycle's clock.
#[derive(Debug, Clone)]
pub struct Replay {
    arrivals: Vec<Arrival>,
    next: usize,
}

impl Replay {
    /// Readings in the order of their arrival, as [`super::csv::read`] gives them.
    #[must_use]
    pub fn new(arrivals: Vec<Arrival>) -> Self {
        Self { arrivals, next: 0 }
    }

    /// How many have not been handed over yet.
    #[must_use]
    pub fn left(&self) -> usize {
        self.arrivals.len() - self.next
    }
}

impl SeamSensor for Replay {
    fn poll(&mut self, torch: &Instant, _: &Sensor, _: &impl TaughtPath) -> Option<Reading> {
        let arrival = self.arrivals.get(self.next).filter(|arrival| arrival.time <= torch.time)?;
        self.next += 1;
        Some(arrival.reading)
    }
}
