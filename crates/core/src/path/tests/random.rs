//! Seeded random numbers, poses and paths.

use super::*;

/// Splitmix64.
pub(super) struct Random(pub(super) u64);

impl Random {
    /// In [low, high).
    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn vector(&mut self, size: f64) -> Vector3 {
        Vector3::from_fn(|_, _| self.within(-size, size))
    }

    pub(super) fn pose(&mut self, size: f64, turn: f64) -> Pose {
        Pose::new(self.vector(size), self.vector(turn))
    }

    pub(super) fn line(&mut self) -> Path {
        Path::line(&self.pose(0.5, 1.0), &self.pose(0.5, 1.0))
    }

    pub(super) fn arc(&mut self) -> Path {
        // Three random points lie on one line once in many millions.
        Path::arc(&self.pose(0.3, 1.0), &self.pose(0.3, 1.0), &self.pose(0.3, 1.0)).unwrap()
    }

    /// A blend between two lines that meet at a random angle.
    pub(super) fn blend(&mut self) -> Path {
        let (from, corner, to) = (self.pose(0.3, 1.0), self.pose(0.3, 1.0), self.pose(0.3, 1.0));
        let (before, after) = (Path::line(&from, &corner), Path::line(&corner, &to));
        let trim = 0.4 * before.length().min(after.length());
        Path::blend(&before.jet(before.length() - trim), &after.jet(trim)).unwrap()
    }
}
