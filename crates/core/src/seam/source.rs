//! What stands between the cycle and a seam sensor.

use super::measurement::{Reading, Sensor};
use super::poses::Instant;
use super::taught::TaughtPath;

/// A seam sensor, simulated or real.
pub trait SeamSensor {
    /// The next reading that has arrived by this cycle, with its exposure on the cycle's clock; `None` where there is no further one.
    ///
    /// The cycle tells where the torch is, how the sensor sits on it and, for simulated ones, the taught path as far as it is known; and asks again until there is no more, as often as it can afford: what is left waits for the next
    /// cycle. The readings are as the sensor gives them; [`SeamTracker::take`](super::SeamTracker::take) judges them. Neither
    /// allocates nor blocks.
    fn poll(&mut self, torch: &Instant, sensor: &Sensor, path: &impl TaughtPath) -> Option<Reading>;
}

/// No sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoSensor;

impl SeamSensor for NoSensor {
    fn poll(&mut self, _: &Instant, _: &Sensor, _: &impl TaughtPath) -> Option<Reading> {
        None
    }
}
