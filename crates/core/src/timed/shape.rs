//! The profile without units: displacement 1 in the time 1. It depends on n alone.

/// Displacement σ and its derivatives along u = t/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    n: f64,
    /// Greatest σ′, by equation (4).
    pub(crate) velocity: f64,
    /// Greatest σ″, by equation (5).
    pub(crate) acceleration: f64,
    /// Greatest σ‴, by equation (6).
    pub(crate) jerk: f64,
}

/// σ, σ′, σ″, σ‴ at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub(crate) displacement: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

impl Shape {
    /// For 0 < n ≤ 1/2.
    pub(crate) fn new(n: f64) -> Self {
        let velocity = 1.0 / (1.0 - n);
        let acceleration = velocity / (n - n * n);
        Self { n, velocity, acceleration, jerk: acceleration / (n * n) }
    }

    /// The ends of the seven phases.
    pub(super) fn switches(&self) -> [f64; 7] {
        let n = self.n;
        let n2 = n * n;
        [n2, n - n2, n, 1.0 - n, 1.0 - n + n2, 1.0 - n2, 1.0]
    }

    /// The whole, 0 ≤ u ≤ 1.
    pub(crate) fn at(&self, u: f64) -> Point {
        if u <= 0.5 {
            return self.first_half(u);
        }
        let from_end = self.first_half(1.0 - u);
        let (displacement, acceleration) = (1.0 - from_end.displacement, -from_end.acceleration);
        Point { displacement, acceleration, ..from_end }
    }

    /// The first half, 0 ≤ u ≤ 1/2. The second is the first one seen from the end: σ(u) = 1 − σ(1 − u).
    ///
    /// The ramp is symmetric about its middle, so that each phase is written from the end where it is shortest.
    pub(super) fn first_half(&self, u: f64) -> Point {
        let Self { n, velocity: v, acceleration: a, jerk: j } = *self;
        let n2 = n * n;
        if u < n2 {
            Point {
                displacement: j * u * u * u / 6.0,
                velocity: j * u * u / 2.0,
                acceleration: j * u,
                jerk: j,
            }
        } else if u < n - n2 {
            Point {
                displacement: a * (u * (u - n2) / 2.0 + n2 * n2 / 6.0),
                velocity: a * (u - n2 / 2.0),
                acceleration: a,
                jerk: 0.0,
            }
        } else if u < n {
            let rest = n - u;
            Point {
                displacement: v * (n / 2.0 - rest) + j * rest * rest * rest / 6.0,
                velocity: v - j * rest * rest / 2.0,
                acceleration: j * rest,
                jerk: -j,
            }
        } else {
            Point { displacement: v * (u - n / 2.0), velocity: v, acceleration: 0.0, jerk: 0.0 }
        }
    }
}
