//! Clocks for measuring: the core has none of its own.

use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};
use seamline::control::StageClock;

/// Running time since its creation.
#[derive(Debug, Clone, Copy)]
pub struct MonotonicClock(Instant);

impl Default for MonotonicClock {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl StageClock for MonotonicClock {
    fn now_ns(&mut self) -> u64 {
        u64::try_from(self.0.elapsed().as_nanos()).unwrap_or(u64::MAX)
    }
}

/// Processor time that this thread has used, in nanoseconds: unlike the clock on the wall it does not count the time
/// in which other programs ran.
#[must_use]
pub fn thread_cpu_ns() -> u64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    let (seconds, nanoseconds) =
        (u64::try_from(time.tv_sec).unwrap_or(0), u64::try_from(time.tv_nsec).unwrap_or(0));
    seconds * 1_000_000_000 + nanoseconds
}
