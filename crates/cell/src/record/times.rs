//! Computing times and lateness, taken in the cycle without allocation.

use hdrhistogram::Histogram;
use serde::Serialize;

/// Times above this count as this: a minute, far beyond any cycle.
const LONGEST_NS: u64 = 60_000_000_000;

/// A histogram of times with three significant digits.
#[derive(Debug, Clone)]
pub struct TimeHistogram {
    /// None only if the fixed bounds were refused, which they are not.
    counts: Option<Histogram<u64>>,
}

/// Percentiles of a [`TimeHistogram`], in microseconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeFigures {
    /// What was timed.
    pub name: &'static str,
    /// How many times.
    pub count: u64,
    /// Median.
    pub p50: f64,
    /// 99 of 100 are at most this.
    pub p99: f64,
    /// 999 of 1000 are at most this.
    pub p99_9: f64,
    /// Longest.
    pub max: f64,
    /// How many fell between each power of the fourth root of two microseconds and the next, with the lower edge:
    /// for plots.
    #[serde(skip)]
    pub bins: Vec<(f64, u64)>,
}

impl Default for TimeHistogram {
    fn default() -> Self {
        Self::new()
    }
}

impl TimeHistogram {
    /// An empty histogram, with all its memory.
    #[must_use]
    pub fn new() -> Self {
        Self { counts: Histogram::new_with_bounds(1, LONGEST_NS, 3).ok() }
    }

    /// Counts one time. Neither allocates nor fails.
    pub fn record(&mut self, nanoseconds: u64) {
        if let Some(counts) = &mut self.counts {
            counts.saturating_record(nanoseconds);
        }
    }

    /// The figures so far.
    #[must_use]
    pub fn figures(&self, name: &'static str) -> TimeFigures {
        let percentile = |p| self.counts.as_ref().map_or(0.0, |counts| us(counts.value_at_percentile(p)));
        TimeFigures {
            name,
            count: self.counts.as_ref().map_or(0, Histogram::len),
            p50: percentile(50.0),
            p99: percentile(99.0),
            p99_9: percentile(99.9),
            max: self.counts.as_ref().map_or(0.0, |counts| us(counts.max())),
            bins: self.bins(),
        }
    }

    fn bins(&self) -> Vec<(f64, u64)> {
        let mut bins: Vec<(i32, u64)> = Vec::new();
        for value in self.counts.iter().flat_map(Histogram::iter_recorded) {
            let power = (4.0 * us(value.value_iterated_to().max(1)).log2()).floor() as i32;
            match bins.last_mut() {
                Some((last, count)) if *last == power => *count += value.count_since_last_iteration(),
                _ => bins.push((power, value.count_since_last_iteration())),
            }
        }
        bins.into_iter().map(|(power, count)| ((0.25 * f64::from(power)).exp2(), count)).collect()
    }
}

fn us(nanoseconds: u64) -> f64 {
    nanoseconds as f64 * 1e-3
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 … 100,000 ns, each once: the percentiles are known, to the histogram's three digits.
    #[test]
    fn percentiles_of_a_uniform_spread() {
        let mut times = TimeHistogram::new();
        for time in 1..=100_000 {
            times.record(time);
        }
        let figures = times.figures("cycle");
        assert_eq!(figures.count, 100_000);
        for (found, expected) in
            [(figures.p50, 50.0), (figures.p99, 99.0), (figures.p99_9, 99.9), (figures.max, 100.0)]
        {
            assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
        }
        assert_eq!(figures.bins.iter().map(|bin| bin.1).sum::<u64>(), 100_000);
        assert!(figures.bins.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn an_age_saturates_and_nothing_is_nothing() {
        let mut times = TimeHistogram::new();
        assert_eq!(times.figures("cycle").max, 0.0);
        times.record(u64::MAX);
        assert!(times.figures("cycle").max >= 6e7);
    }
}
