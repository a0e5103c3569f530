//! Decimation for plots that keeps every peak.

/// The most points that a trace holds.
pub const TRACE_POINTS: usize = 2 * BUCKETS;

const BUCKETS: usize = 1000;

/// A function of time for a plot: pairs of time (s) and value, in order of time.
pub type Trace = Vec<(f64, f64)>;

/// Takes a function of time value by value, and keeps the least and greatest of every stretch of it.
///
/// Memory is bounded whatever the length: when all buckets are full, neighbours become one and each bucket takes twice
/// as many values from then on. Least and greatest of all values, and their times, are always among the points.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    buckets: Vec<Bucket>,
    /// Values a bucket takes.
    width: u64,
    /// Values in the last bucket.
    filled: u64,
}

#[derive(Debug, Clone, Copy)]
struct Bucket {
    low: (f64, f64),
    high: (f64, f64),
}

impl Bucket {
    fn merged(self, other: Self) -> Self {
        Self {
            low: if other.low.1 < self.low.1 { other.low } else { self.low },
            high: if other.high.1 > self.high.1 { other.high } else { self.high },
        }
    }
}

impl Envelope {
    pub(super) fn new() -> Self {
        Self { buckets: Vec::with_capacity(BUCKETS), width: 1, filled: 1 }
    }

    /// Takes the value at a time not before the last one; passes over NaN.
    pub(super) fn push(&mut self, time: f64, value: f64) {
        if value.is_nan() {
            return;
        }
        let point = (time, value);
        match self.buckets.last_mut() {
            Some(bucket) if self.filled < self.width => {
                self.filled += 1;
                if value < bucket.low.1 {
                    bucket.low = point;
                }
                if value > bucket.high.1 {
                    bucket.high = point;
                }
            }
            _ => self.open(point),
        }
    }

    fn open(&mut self, point: (f64, f64)) {
        let bucket = Bucket { low: point, high: point };
        self.filled = 1;
        if self.buckets.len() == BUCKETS {
            for pair in 0..BUCKETS / 2 {
                self.buckets[pair] = self.buckets[2 * pair].merged(self.buckets[2 * pair + 1]);
            }
            self.buckets.truncate(BUCKETS / 2);
            self.width *= 2;
        }
        self.buckets.push(bucket);
    }

    pub(super) fn into_trace(self) -> Trace {
        let mut trace = Vec::with_capacity(2 * self.buckets.len());
        for Bucket { low, high } in self.buckets {
            let (first, second) = if low.0 <= high.0 { (low, high) } else { (high, low) };
            trace.push(first);
            if second.0 > first.0 {
                trace.push(second);
            }
        }
        trace
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::testing::Random;

    /// Runs of 1 to 300,000 values with one peak up and one down, at random places: both stay, with their times, and
    /// the points stay in order and within the bound.
    #[test]
    fn peaks_survive() {
        let mut random = Random::new(1);
        for length in [1, 2, 3, 999, 1000, 1001, 1999, 2000, 2001, 4001, 70_003, 300_000] {
            let up = (random.bits() % length) as usize;
            let down = (random.bits() % length) as usize;
            let mut envelope = Envelope::new();
            let mut values = Vec::new();
            for index in 0..length as usize {
                let noise = random.within(-1.0, 1.0);
                let value =
                    noise + if index == up { 5.0 } else { 0.0 } + if index == down { -7.5 } else { 0.0 };
                values.push(value);
                envelope.push(index as f64, value);
            }
            let trace = envelope.into_trace();
            assert!(trace.len() <= TRACE_POINTS);
            assert!(trace.windows(2).all(|pair| pair[0].0 < pair[1].0));
            for extreme in [f64::min as fn(f64, f64) -> f64, f64::max] {
                let of_values = values.iter().copied().reduce(extreme).unwrap();
                let of_trace = trace.iter().map(|point| point.1).reduce(extreme).unwrap();
                assert_eq!(of_values, of_trace);
            }
            assert!(trace.iter().all(|(time, value)| values[*time as usize] == *value));
        }
    }

    /// Every value of a short run is kept, and NaN leaves no trace.
    #[test]
    fn short_runs_are_whole() {
        let mut envelope = Envelope::new();
        for index in 0..500 {
            envelope.push(f64::from(index), if index % 2 == 0 { f64::from(index) } else { f64::NAN });
        }
        assert_eq!(envelope.into_trace().len(), 250);
    }
}
