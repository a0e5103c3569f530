//! The joint motion of the near future, sampled in programme time: what the rate may do is decided on it.

use super::rate::RateLimits;
use crate::math::float::{cbrt, sqrt};

/// Number of samples held.
pub(super) const CAPACITY: usize = 80;

/// Derivatives with respect to programme time at one instant: of the joints, and of the path coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct JointMotion<const N: usize> {
    pub(super) velocity: [f64; N],
    pub(super) acceleration: [f64; N],
    pub(super) jerk: [f64; N],
    pub(super) path: AlongPath,
}

/// Motion of the tool along its path, with the limits that the cell sets for it; infinite where there is no path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AlongPath {
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
    pub(super) acceleration_limit: f64,
    pub(super) jerk_limit: f64,
}

impl AlongPath {
    /// No path.
    pub(super) const NONE: Self = Self {
        velocity: 0.0,
        acceleration: 0.0,
        jerk: 0.0,
        acceleration_limit: f64::INFINITY,
        jerk_limit: f64::INFINITY,
    };
}

impl<const N: usize> JointMotion<N> {
    pub(super) const REST: Self =
        Self { velocity: [0.0; N], acceleration: [0.0; N], jerk: [0.0; N], path: AlongPath::NONE };

    /// The same motion as time runs backward.
    pub(super) fn reversed(self) -> Self {
        let AlongPath { velocity, jerk, .. } = self.path;
        Self {
            velocity: self.velocity.map(|v| -v),
            jerk: self.jerk.map(|j| -j),
            path: AlongPath { velocity: -velocity, jerk: -jerk, ..self.path },
            ..self
        }
    }
}

/// A ring of samples at whole multiples of a spacing in programme time, from just before now to the horizon.
#[derive(Debug, Clone)]
pub(super) struct Lookahead<const N: usize> {
    ring: [JointMotion<N>; CAPACITY],
    /// Grid number of the oldest sample.
    first: u64,
    count: usize,
    spacing: f64,
}

/// The two samples around an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between<'a, const N: usize> {
    pub(super) left: &'a JointMotion<N>,
    pub(super) right: &'a JointMotion<N>,
    /// Where between them, 0 … 1.
    pub(super) fraction: f64,
    /// Their distance in seconds.
    pub(super) spacing: f64,
}

impl<const N: usize> Lookahead<N> {
    /// An empty look-ahead that begins at programme time zero.
    pub(super) fn new(spacing: f64) -> Self {
        Self { ring: [JointMotion::REST; CAPACITY], first: 0, count: 0, spacing }
    }

    /// Distance of the samples in seconds.
    pub(super) fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Programme time of the next sample wanted, or `None` where the ring is full.
    pub(super) fn wanted(&self) -> Option<f64> {
        (self.count < CAPACITY).then(|| self.time(self.first + self.count as u64))
    }

    /// Takes the sample last [wanted](Self::wanted).
    pub(super) fn push(&mut self, motion: JointMotion<N>) {
        if self.count < CAPACITY {
            self.ring[Self::slot(self.first + self.count as u64)] = motion;
            self.count += 1;
        }
    }

    /// Forgets what lies more than one sample before `now`.
    pub(super) fn forget_before(&mut self, now: f64) {
        let keep = self.grid(now);
        let gone = keep.saturating_sub(self.first);
        self.count = self.count.saturating_sub(gone as usize);
        self.first = self.first.max(keep);
    }

    /// Forgets what lies after `time`: a new motion begins there.
    pub(super) fn forget_after(&mut self, time: f64) {
        let keep = (self.grid(time) + 1).saturating_sub(self.first);
        self.count = self.count.min(keep as usize);
    }

    /// The samples around a programme time; `None` beyond the horizon.
    pub(super) fn around(&self, time: f64) -> Option<Between<'_, N>> {
        let left = self.grid(time).max(self.first);
        let offset = (left - self.first) as usize;
        if offset + 1 >= self.count {
            return None;
        }
        let fraction = (time / self.spacing - left as f64).clamp(0.0, 1.0);
        Some(Between {
            left: &self.ring[Self::slot(left)],
            right: &self.ring[Self::slot(left + 1)],
            fraction,
            spacing: self.spacing,
        })
    }

    /// The greatest constant rate, 1 at most, that keeps the joints' limits on all samples held. Cost: 80 samples, about 1 µs.
    pub(super) fn bearable(&self, limits: &RateLimits<N>) -> f64 {
        let mut rate = 1.0_f64;
        for k in 0..self.count {
            let motion = &self.ring[Self::slot(self.first + k as u64)];
            for axis in 0..N {
                rate = rate.min(limits.velocity[axis] / motion.velocity[axis].abs());
                let squared = rate * rate;
                // Roots are rarely needed.
                let (bends, jerks) = (motion.acceleration[axis].abs(), motion.jerk[axis].abs());
                if bends * squared > limits.acceleration[axis] {
                    rate = sqrt(limits.acceleration[axis] / bends);
                }
                if jerks * rate * rate * rate > limits.jerk[axis] {
                    rate = cbrt(limits.jerk[axis] / jerks);
                }
            }
        }
        rate
    }

    fn time(&self, grid: u64) -> f64 {
        grid as f64 * self.spacing
    }

    fn grid(&self, time: f64) -> u64 {
        // Truncation towards zero is the floor here: programme time is never negative.
        (time / self.spacing).max(0.0) as u64
    }

    fn slot(grid: u64) -> usize {
        (grid % CAPACITY as u64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(to: u64) -> Lookahead<1> {
        let mut ahead = Lookahead::new(1e-3);
        while let Some(time) = ahead.wanted().filter(|t| *t <= to as f64 * 1e-3 + 1e-12) {
            ahead.push(JointMotion { velocity: [time], ..JointMotion::REST });
        }
        ahead
    }

    #[test]
    fn samples_come_back_where_they_were_put() {
        let mut ahead = filled(50);
        for k in 0..50 {
            let time = (f64::from(k) + 0.25) * 1e-3;
            let between = ahead.around(time).unwrap();
            assert!((between.left.velocity[0] - f64::from(k) * 1e-3).abs() < 1e-12);
            assert!((between.right.velocity[0] - f64::from(k + 1) * 1e-3).abs() < 1e-12);
            assert!((between.fraction - 0.25).abs() < 1e-9);
        }
        assert!(ahead.around(0.0501).is_none());
        ahead.forget_before(0.0305);
        assert!((ahead.around(0.0305).unwrap().left.velocity[0] - 0.030).abs() < 1e-12);
        ahead.forget_after(0.0403);
        assert!(ahead.around(0.0395).is_some());
        assert!(ahead.around(0.0405).is_none());
    }

    #[test]
    fn a_full_ring_wants_nothing_until_time_moves_on() {
        let mut ahead = filled(1_000);
        assert_eq!(ahead.wanted(), None);
        ahead.forget_before(0.002);
        assert!((ahead.wanted().unwrap() - CAPACITY as f64 * 1e-3).abs() < 1e-12);
    }
}
