//! What stands between the cycle and a seam sensor.

use super::measurement::Reading;
use super::poses::Instant;

/// A seam sensor, simulated or real.
pub trait SeamSensor {
    /// The next reading that has arrived by this cycle, with its exposure on the cycle's clock; `None` where there is no further one.
    ///
    /// The cycle tells where the torch is, and asks again until there is no more, as often as it can afford: what is left waits for the next
    /// cycle. The readings are as the sensor gives them; [`SeamTracker::take`](super::SeamTracker::take) judges them. Neither
    /// allocates nor blocks.
    fn poll(&mut self, torch: &Instant) -> Option<Reading>;
}
