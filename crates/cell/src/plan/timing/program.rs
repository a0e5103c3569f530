//! The optimization problem on one window: the fastest β(w) = ẇ² under every limit.
//!
//! With derivatives with respect to w, a joint's velocity, acceleration and jerk in time are
//!
//! q̇² = q_w² β,  q̈ = q_ww β + ½ q_w β′,  q⃛ = (q_www β + 3/2 q_ww β′ + ½ q_w β″) √β,
//!
//! so that velocity and acceleration limits are linear in β and its derivatives, and the jerk limit reads
//! |q_www β + 3/2 q_ww β′ + ½ q_w β″| ≤ J β^(−1/2). Its right side is convex in β: replaced by a tangent it
//! becomes a linear constraint that is never looser than the true one. The duration ∫ β^(−1/2) dw is convex
//! too. β is a uniform cubic B-spline, and the limits are imposed at its knots and in the middle between
//! them.

/// What one axis (a joint, or the path itself) demands at one site, as shares of its limits: the factors of
/// β, h β′ and h² β″.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Demand {
    /// q_w² / V²
    velocity: f64,
    acceleration: [f64; 2],
    jerk: [f64; 3],
}

impl Demand {
    /// From derivatives with respect to w, limits (velocity, acceleration, jerk) and the knots' distance.
    pub(super) fn new(derivatives: [f64; 3], limits: [f64; 3], step: f64) -> Self {
        let [d1, d2, d3] = derivatives;
        let [velocity, acceleration, jerk] = limits;
        Self {
            velocity: (d1 / velocity) * (d1 / velocity),
            acceleration: [d2 / acceleration, d1 / (2.0 * step * acceleration)],
            jerk: [d3 / jerk, 1.5 * d2 / (step * jerk), d1 / (2.0 * step * step * jerk)],
        }
    }

    /// Highest constant β that this demand allows.
    pub(super) fn constant_bound(&self) -> f64 {
        let jerk = self.jerk[0].abs().cbrt();
        1.0 / self.velocity.max(self.acceleration[0].abs()).max(jerk * jerk)
    }
}

/// Controls that matter at a site.
pub(super) const SUPPORT: usize = 4;

/// How β, h β′, h² β″ come from the four controls of an interval: at its start, its middle and its end.
const BASIS: [[[f64; SUPPORT]; 3]; 3] = [
    [[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 0.0], [-0.5, 0.0, 0.5, 0.0], [1.0, -2.0, 1.0, 0.0]],
    [
        [1.0 / 48.0, 23.0 / 48.0, 23.0 / 48.0, 1.0 / 48.0],
        [-0.125, -0.625, 0.625, 0.125],
        [0.5, -0.5, -0.5, 0.5],
    ],
    [[0.0, 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0], [0.0, -0.5, 0.0, 0.5], [0.0, 1.0, -2.0, 1.0]],
];

/// A place where limits are imposed: each knot and the middle between two. Site 2k is knot k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Site {
    /// The interval whose controls, this one and the next three, matter.
    pub(super) interval: usize,
    basis: &'static [[f64; SUPPORT]; 3],
}

impl Site {
    pub(super) fn new(index: usize, intervals: usize) -> Self {
        if index == 2 * intervals {
            Self { interval: intervals - 1, basis: &BASIS[2] }
        } else {
            Self { interval: index / 2, basis: &BASIS[index % 2] }
        }
    }

    /// β, h β′, h² β″ for these controls of the whole spline.
    #[inline]
    pub(super) fn value(&self, controls: &[f64]) -> [f64; 3] {
        let c = &controls[self.interval..self.interval + SUPPORT];
        self.basis.map(|b| b[0] * c[0] + b[1] * c[1] + b[2] * c[2] + b[3] * c[3])
    }

    /// A gradient with respect to (β, h β′, h² β″), carried over to the four controls and added there.
    #[inline]
    pub(super) fn spread(&self, gradient: &[f64; 3], onto: &mut [f64]) {
        let onto = &mut onto[self.interval..self.interval + SUPPORT];
        for (factors, value) in self.basis.iter().zip(gradient) {
            for (to, factor) in onto.iter_mut().zip(factors) {
                *to += factor * value;
            }
        }
    }

    /// A symmetric matrix over (β, h β′, h² β″), lower triangle by columns, carried over to the four
    /// controls.
    #[inline]
    pub(super) fn square(&self, m: &[f64; 6]) -> [[f64; SUPPORT]; SUPPORT] {
        let [aa, ba, ca, bb, cb, cc] = *m;
        let b = self.basis;
        core::array::from_fn(|i| {
            let [x, y, z] = [b[0][i], b[1][i], b[2][i]];
            let row = [aa * x + ba * y + ca * z, ba * x + bb * y + cb * z, ca * x + cb * y + cc * z];
            core::array::from_fn(|j| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j])
        })
    }
}

/// β, h β′, h² β″ at a site, and the power of β that the rows need.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) x: [f64; 3],
    /// β^(−1/2)
    pub(super) root: f64,
}

impl Point {
    pub(super) fn new(x: [f64; 3]) -> Self {
        Self { x, root: 1.0 / x[0].sqrt() }
    }

    /// Slope of the tangent to −β^(−1/2).
    pub(super) fn tangent(&self) -> f64 {
        self.root / (2.0 * self.x[0])
    }
}

/// A number for each row of a demand: velocity, acceleration up and down, jerk up and down.
pub(super) type Rows = [f64; 5];

impl Demand {
    /// The rows at a point; none of them may be positive.
    #[inline]
    pub(super) fn rows(&self, point: &Point) -> Rows {
        let [velocity, acceleration, jerk] = self.image(&point.x);
        let root = point.root;
        [velocity - 1.0, acceleration - 1.0, -acceleration - 1.0, jerk - root, -jerk - root]
    }

    /// How the rows change along a direction of (β, h β′, h² β″); the jerk's rows by their tangent.
    #[inline]
    pub(super) fn along(&self, tangent: f64, direction: &[f64; 3]) -> Rows {
        let [velocity, acceleration, jerk] = self.image(direction);
        let bound = tangent * direction[0];
        [velocity, acceleration, -acceleration, bound + jerk, bound - jerk]
    }

    /// The sum of the rows' gradients, weighted.
    #[inline]
    pub(super) fn gradient(&self, tangent: f64, weights: &Rows) -> [f64; 3] {
        let [velocity, up, down, jerk_up, jerk_down] = *weights;
        let ([a0, a1], [j0, j1, j2]) = (self.acceleration, self.jerk);
        let (a, j) = (up - down, jerk_up - jerk_down);
        let bound = tangent * (jerk_up + jerk_down);
        [self.velocity * velocity + a0 * a + j0 * j + bound, a1 * a + j1 * j, j2 * j]
    }

    /// The sum of the gradients' squares g gᵀ, weighted: lower triangle by columns.
    #[inline]
    pub(super) fn square(&self, tangent: f64, weights: &Rows) -> [f64; 6] {
        let [velocity, up, down, jerk_up, jerk_down] = *weights;
        let ([a0, a1], [j0, j1, j2]) = (self.acceleration, self.jerk);
        let (a, j) = (up + down, jerk_up + jerk_down);
        let bound = tangent * (jerk_up - jerk_down);
        [
            self.velocity * self.velocity * velocity
                + a * a0 * a0
                + j * (j0 * j0 + tangent * tangent)
                + 2.0 * bound * j0,
            a * a0 * a1 + j * j0 * j1 + bound * j1,
            j * j0 * j2 + bound * j2,
            a * a1 * a1 + j * j1 * j1,
            j * j1 * j2,
            j * j2 * j2,
        ]
    }

    fn image(&self, x: &[f64; 3]) -> [f64; 3] {
        let ([a0, a1], [j0, j1, j2]) = (self.acceleration, self.jerk);
        [self.velocity * x[0], a0 * x[0] + a1 * x[1], j0 * x[0] + j1 * x[1] + j2 * x[2]]
    }
}

/// The demands of all axes at all sites.
#[derive(Debug, Clone, Default)]
pub(super) struct Program {
    /// Site by site, axis by axis.
    pub(super) demands: Vec<Demand>,
    pub(super) axes: usize,
    /// Whether β is held at 1 at either end; else the end rests.
    pub(super) held: [bool; 2],
}

impl Program {
    pub(super) fn sites(&self) -> usize {
        self.demands.len() / self.axes
    }

    pub(super) fn intervals(&self) -> usize {
        (self.sites() - 1) / 2
    }

    pub(super) fn site(&self, index: usize) -> Site {
        Site::new(index, self.intervals())
    }

    /// Highest constant β under all demands.
    pub(super) fn constant_bound(&self) -> f64 {
        self.demands.iter().map(Demand::constant_bound).fold(f64::INFINITY, f64::min)
    }
}
