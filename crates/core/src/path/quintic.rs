//! A polynomial curve of degree five, run by arc length.
//!
//! The polynomial r(u), u in [0, 1], has no closed-form arc length. Its parameter interval is cut where the speed
//! |r′(u)| changes, so that Gauss–Legendre quadrature gives each cell's length to rounding; the parameter at a given
//! arc length follows by Halley's iteration on what the quadrature says is left.

use super::curve::PointJet;
use crate::geometry::Vector3;
use crate::math::float::sqrt;

/// Cells of the parameter interval: the gentlest curves take two, the sharpest corner blend takes them all.
const CELLS: usize = 16;
/// A cell is at most this share of the distance to the nearest place where the speed is singular. Ten nodes are then
/// exact to rounding: the error falls as (z + √(z² − 1))^−20 with z = 2/0.5 − 1 (Trefethen, *Approximation Theory and
/// Approximation Practice*, theorem 19.3).
const CELL_SHARE: f64 = 0.5;
/// Corrections of the parameter: each cubes the error, and the first guess is good to a hundredth of a cell.
const CORRECTIONS: usize = 4;
/// A correction of this share of a cell is the last: its cube is below rounding.
const NEGLIGIBLE_ROOT: f64 = 3e-6;

/// Positive nodes of Gauss–Legendre quadrature on [−1, 1], and their weights.
struct Rule<const HALF: usize> {
    nodes: [f64; HALF],
    weights: [f64; HALF],
}

const TEN: Rule<5> = Rule {
    nodes: [
        0.148_874_338_981_631_22,
        0.433_395_394_129_247_2,
        0.679_409_568_299_024_4,
        0.865_063_366_688_984_5,
        0.973_906_528_517_171_7,
    ],
    weights: [
        0.295_524_224_714_752_87,
        0.269_266_719_309_996_35,
        0.219_086_362_515_982_04,
        0.149_451_349_150_580_6,
        0.066_671_344_308_688_14,
    ],
};
const FOUR: Rule<2> = Rule {
    nodes: [0.339_981_043_584_856_26, 0.861_136_311_594_052_6],
    weights: [0.652_145_154_862_546_1, 0.347_854_845_137_453_85],
};

/// Value, first and second derivative at one end of a polynomial.
pub(super) type End = [Vector3; 3];

/// Coefficients of 1, u, … u⁵ of the polynomial that meets both ends, at u = 0 and u = 1.
pub(super) fn meeting([a, a1, a2]: &End, [b, b1, b2]: &End) -> [Vector3; 6] {
    let value = b - a - a1 - a2 / 2.0;
    let first = b1 - a1 - a2;
    let second = b2 - a2;
    [
        *a,
        *a1,
        a2 / 2.0,
        value * 10.0 - first * 4.0 + second / 2.0,
        value * -15.0 + first * 7.0 - second,
        value * 6.0 - first * 3.0 + second / 2.0,
    ]
}

/// Value and first three derivatives of a polynomial of degree five.
pub(super) fn derivatives(c: &[Vector3; 6], u: f64) -> [Vector3; 4] {
    [
        c[0] + (c[1] + (c[2] + (c[3] + (c[4] + c[5] * u) * u) * u) * u) * u,
        c[1] + (c[2] * 2.0 + (c[3] * 3.0 + (c[4] * 4.0 + c[5] * (5.0 * u)) * u) * u) * u,
        c[2] * 2.0 + (c[3] * 6.0 + (c[4] * 12.0 + c[5] * (20.0 * u)) * u) * u,
        c[3] * 6.0 + (c[4] * 24.0 + c[5] * (60.0 * u)) * u,
    ]
}

/// A polynomial curve of degree five, or a part of one, with arc length as coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quintic {
    /// Of 1, u, … u⁵, in metres.
    coefficients: [Vector3; 6],
    /// Where each cell begins: parameter, and arc length from u = 0. Those past the last cell stand at u = 1.
    parameters: [f64; CELLS],
    lengths: [f64; CELLS],
    /// Arc length of the whole polynomial.
    whole: f64,
    /// Arc length at which this part of it begins.
    from: f64,
    length: f64,
}

impl Quintic {
    /// The whole curve of a polynomial, or nothing where it stands still or is not finite.
    pub(super) fn new(coefficients: [Vector3; 6]) -> Option<Self> {
        let (mut parameters, mut lengths) = ([1.0; CELLS], [0.0; CELLS]);
        let (mut u, mut length) = (0.0, 0.0);
        for cell in 0..CELLS {
            (parameters[cell], lengths[cell]) = (u, length);
            if u >= 1.0 {
                continue;
            }
            let end = u + CELL_SHARE * evenness(&coefficients, u);
            // No sliver at the end; and the last cell takes what is left.
            let end = if end > 0.95 || cell + 1 == CELLS { 1.0 } else { end };
            length += travelled(&coefficients, u, end, &TEN);
            u = end;
        }
        let proper = length > super::SAME_POSITION && length.is_finite();
        proper.then_some(Self { coefficients, parameters, lengths, whole: length, from: 0.0, length })
    }

    /// Length in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Point and first derivative at the polynomial's own parameter, from 0 to 1 over the whole of it: a tenth of the cost of a
    /// place by arc length.
    #[must_use]
    pub fn at_parameter(&self, u: f64) -> [Vector3; 2] {
        let [point, first, ..] = derivatives(&self.coefficients, u);
        [point, first]
    }

    /// The part between two coordinates: the same polynomial.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        Self { from: self.from + from, length: to - from, ..*self }
    }

    /// The coordinate of the point nearest to `target`, and its distance in metres. Bounded search from the nearest of
    /// 33 samples: a curve that passes the target twice at almost one distance may answer with either.
    #[must_use]
    pub fn nearest(&self, target: &Vector3) -> (f64, f64) {
        let u = nearest_parameter(&self.coefficients, target, self.parameter_range());
        let s = (self.arc_length(u) - self.from).min(self.length).max(0.0);
        (s, (derivatives(&self.coefficients, u)[0] - target).norm())
    }

    /// Range of the polynomial's own parameter.
    fn parameter_range(&self) -> [f64; 2] {
        [self.parameter(self.from), self.parameter(self.from + self.length)]
    }

    /// Arc length from u = 0 to a parameter.
    fn arc_length(&self, u: f64) -> f64 {
        let cells = self.parameters.iter().zip(&self.lengths);
        let (start, before) = cells.rev().find(|(start, _)| **start <= u).unwrap_or((&0.0, &0.0));
        before + travelled(&self.coefficients, *start, u, &TEN)
    }

    /// The polynomial's parameter at an arc length counted from u = 0, held at the ends of the polynomial.
    fn parameter(&self, s: f64) -> f64 {
        let s = s.max(0.0).min(self.whole);
        let after = self.lengths.iter().skip(1).position(|length| *length > s);
        let cell = after.unwrap_or(CELLS - 1);
        let (start, at_start) = (self.parameters[cell], self.lengths[cell]);
        let (end, at_end) = match (self.parameters.get(cell + 1), self.lengths.get(cell + 1)) {
            (Some(u), Some(length)) => (*u, *length),
            _ => (1.0, self.whole),
        };
        let mut u = hermite_inverse(&self.coefficients, [start, end], [at_start, at_end], s);
        let mut left = s - at_start - travelled(&self.coefficients, start, u, &TEN);
        for _ in 0..CORRECTIONS {
            let next = (u + halley(&self.coefficients, u, left)).max(start).min(end);
            if left.abs() <= NEGLIGIBLE_ROOT * (at_end - at_start) {
                return next;
            }
            left -= travelled(&self.coefficients, u, next, &FOUR);
            u = next;
        }
        u
    }

    /// The tool centre point at coordinate `s`, and its derivatives with respect to s.
    ///
    /// With v = |r′|: u′ = 1/v, and u″, u‴ are the derivatives of that along the curve.
    pub(super) fn jet(&self, s: f64) -> PointJet {
        let [position, r1, r2, r3] = derivatives(&self.coefficients, self.parameter(self.from + s));
        let per_speed = 1.0 / sqrt(r1.norm_squared());
        let square = per_speed * per_speed;
        let along = r1.dot(&r2) * square;
        let d1 = per_speed;
        let d2 = -along * square;
        let d3 = (4.0 * along * along - (r2.norm_squared() + r1.dot(&r3)) * square) * square * per_speed;
        PointJet::new(
            position,
            [r1 * d1, r2 * square + r1 * d2, r3 * (square * d1) + r2 * (3.0 * d1 * d2) + r1 * d3],
        )
    }

    /// Greatest curvature in 1/m, to 0.2 %: sampled in each cell, since these are as small as the bends are sharp.
    #[must_use]
    pub fn greatest_curvature(&self) -> f64 {
        const SAMPLES: i32 = 8;
        let [first, last] = self.parameter_range();
        let square = |u: f64| {
            let [_, r1, r2, _] = derivatives(&self.coefficients, u.max(first).min(last));
            let speed = r1.norm_squared();
            r1.cross(&r2).norm_squared() / (speed * speed * speed)
        };
        let ends = self.parameters.iter().skip(1).chain(&[1.0]);
        let cells = self.parameters.iter().zip(ends).filter(|(start, end)| *start < end);
        let greatest = cells
            .flat_map(|(start, end)| {
                (0..SAMPLES).map(move |k| start + (end - start) * f64::from(k) / f64::from(SAMPLES))
            })
            .map(square)
            .fold(square(last), f64::max);
        sqrt(greatest)
    }

    /// The polynomial's coefficients, and the range of its parameter within `reach` metres of the coordinate `s`.
    pub(super) fn around(&self, s: f64, reach: f64) -> (&[Vector3; 6], [f64; 2]) {
        let at = |s: f64| self.parameter(self.from + s.max(0.0).min(self.length));
        (&self.coefficients, [at(s - reach), at(s + reach)])
    }
}

/// The parameter within a range whose point is nearest to `target`.
fn nearest_parameter(c: &[Vector3; 6], target: &Vector3, [first, last]: [f64; 2]) -> f64 {
    const SAMPLES: i32 = 32;
    let step = (last - first) / f64::from(SAMPLES);
    let (mut best, mut least) = (first, f64::INFINITY);
    for k in 0..=SAMPLES {
        let u = first + step * f64::from(k);
        let square = (derivatives(c, u)[0] - target).norm_squared();
        if square < least {
            (best, least) = (u, square);
        }
    }
    foot(c, target, best, [(best - step).max(first), (best + step).min(last)])
}

/// The parameter near `u` where the curve passes `target` at right angles, held to a range: Newton's iteration on
/// (r − target)·r′ = 0.
pub(super) fn foot(c: &[Vector3; 6], target: &Vector3, mut u: f64, [low, high]: [f64; 2]) -> f64 {
    const STEPS: usize = 6;
    for _ in 0..STEPS {
        let [r, r1, r2, _] = derivatives(c, u);
        let offset = r - target;
        let slope = r1.norm_squared() + offset.dot(&r2);
        // Where the distance is not convex, along the tangent only.
        let slope = if slope > 0.0 { slope } else { r1.norm_squared() };
        let next = (u - offset.dot(&r1) / slope).max(low).min(high);
        if (next - u).abs() <= 1e-12 {
            return next;
        }
        u = next;
    }
    u
}

/// About how far from `u` the speed is singular in the complex plane: exact for r′ = a + b·u with perpendicular a and
/// b, which is what the speed looks like beside its least value.
fn evenness(coefficients: &[Vector3; 6], u: f64) -> f64 {
    let [_, r1, r2, r3] = derivatives(coefficients, u);
    let [speed, second, third] = [r1, r2, r3].map(|r| sqrt(r.norm_squared()));
    let first = if second > speed { speed / second } else { 1.0 };
    if third > 2.0 * speed { first.min(sqrt(2.0 * speed / third)) } else { first }
}

/// Arc length from one parameter to another, by quadrature.
fn travelled<const HALF: usize>(c: &[Vector3; 6], from: f64, to: f64, rule: &Rule<HALF>) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let [d0, d1, d2, d3, d4] = [c[1], c[2] * 2.0, c[3] * 3.0, c[4] * 4.0, c[5] * 5.0];
    let speed = |u: f64| sqrt((d0 + (d1 + (d2 + (d3 + d4 * u) * u) * u) * u).norm_squared());
    let pairs = rule.nodes.map(|node| speed(middle - half * node) + speed(middle + half * node));
    half * pairs.iter().zip(&rule.weights).map(|(pair, weight)| pair * weight).sum::<f64>()
}

/// The parameter at arc length `s` of a cell, by the cubic that has du/ds = 1/|r′| at both ends.
fn hermite_inverse(c: &[Vector3; 6], [u0, u1]: [f64; 2], [s0, s1]: [f64; 2], s: f64) -> f64 {
    let span = s1 - s0;
    let positive = span > 0.0;
    if !positive {
        return u0;
    }
    let x = (s - s0) / span;
    let [slope0, slope1] = [u0, u1].map(|u| span / sqrt(derivatives(c, u)[1].norm_squared()));
    let rise = u1 - u0;
    let cubic =
        u0 + x * (slope0 + x * (3.0 * rise - 2.0 * slope0 - slope1 + x * (slope0 + slope1 - 2.0 * rise)));
    // A slope much above the mean makes the cubic swing; the chord does not.
    if cubic >= u0 && cubic <= u1 { cubic } else { u0 + x * rise }
}

/// Halley's step from `u` to where the arc length has grown by `left`.
fn halley(c: &[Vector3; 6], u: f64, left: f64) -> f64 {
    let [_, r1, r2, _] = derivatives(c, u);
    let speed = sqrt(r1.norm_squared());
    let step = left / speed;
    let growth = r1.dot(&r2) / (speed * speed);
    step / (1.0 + 0.5 * growth * step).max(0.5)
}
