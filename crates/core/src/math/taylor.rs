//! Truncated Taylor series: a function of one parameter by its value and its first three derivatives.
//!
//! Running a closed form in this arithmetic gives its exact derivatives (Griewank & Walther, *Evaluating Derivatives*,
//! 2nd ed., ch. 13). Coefficients are scaled: cₖ = f⁽ᵏ⁾/k!, so that a product is a plain convolution.

use core::ops::{Add, Mul, Neg, Sub};

use super::float::sin_cos;

/// f(t) = c₀ + c₁t + c₂t² + c₃t³ + O(t⁴).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taylor([f64; 4]);

impl Taylor {
    /// The series of a function with this value and these first, second and third derivatives.
    #[inline]
    #[must_use]
    pub fn from_derivatives(value: f64, d1: f64, d2: f64, d3: f64) -> Self {
        Self([value, d1, d2 / 2.0, d3 / 6.0])
    }

    /// A constant.
    #[inline]
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0, 0.0])
    }

    /// The function's value.
    #[inline]
    #[must_use]
    pub fn value(&self) -> f64 {
        self.0[0]
    }

    /// The same derivatives with another value: where that is known better.
    #[inline]
    #[must_use]
    pub fn with_value(self, value: f64) -> Self {
        let [_, c1, c2, c3] = self.0;
        Self([value, c1, c2, c3])
    }

    /// First, second and third derivative.
    #[inline]
    #[must_use]
    pub fn derivatives(&self) -> [f64; 3] {
        let [_, c1, c2, c3] = self.0;
        [c1, 2.0 * c2, 6.0 * c3]
    }

    /// 10x³ − 15x⁴ + 6x⁵ at x in 0 … 1, where x changes at this rate: from 0 to 1 with two continuous derivatives at either end.
    #[must_use]
    pub fn smooth_step(x: f64, rate: f64) -> Self {
        let rest = 1.0 - x;
        let value = x * x * x * (10.0 + x * (6.0 * x - 15.0));
        let d1 = 30.0 * x * x * rest * rest;
        let d2 = 60.0 * x * rest * (1.0 - 2.0 * x);
        let d3 = 60.0 * (1.0 - 6.0 * x * rest);
        Self::from_derivatives(value, d1 * rate, d2 * rate * rate, d3 * rate * rate * rate)
    }

    /// Largest magnitude among the coefficients of t, t² and t³: zero where the function stands still.
    #[inline]
    #[must_use]
    pub fn variation(&self) -> f64 {
        let [_, c1, c2, c3] = self.0;
        c1.abs().max(c2.abs()).max(c3.abs())
    }

    /// f(t/c): the same function of a parameter that runs c times as far.
    #[inline]
    #[must_use]
    pub fn stretched(self, c: f64) -> Self {
        let [a0, a1, a2, a3] = self.0;
        let r = 1.0 / c;
        Self([a0, a1 * r, a2 * r * r, a3 * r * r * r])
    }

    /// 1/f, for f₀ ≠ 0.
    #[inline]
    #[must_use]
    pub fn reciprocal(self) -> Self {
        let [a0, a1, a2, a3] = self.0;
        let b0 = 1.0 / a0;
        let b1 = -b0 * (a1 * b0);
        let b2 = -b0 * (a1 * b1 + a2 * b0);
        let b3 = -b0 * (a1 * b2 + a2 * b1 + a3 * b0);
        Self([b0, b1, b2, b3])
    }

    /// f².
    #[inline]
    #[must_use]
    pub fn squared(self) -> Self {
        let [a0, a1, a2, a3] = self.0;
        Self([a0 * a0, 2.0 * a0 * a1, 2.0 * a0 * a2 + a1 * a1, 2.0 * (a0 * a3 + a1 * a2)])
    }

    /// The root of f that has this value at t = 0, not zero (f₀ itself is not used): of two signs, or known better
    /// than f₀ says.
    #[inline]
    #[must_use]
    pub fn sqrt_from(self, value: f64) -> Self {
        let [_, a1, a2, a3] = self.0;
        let half = 0.5 / value;
        let s1 = a1 * half;
        let s2 = (a2 - s1 * s1) * half;
        let s3 = (a3 - 2.0 * s1 * s2) * half;
        Self([value, s1, s2, s3])
    }

    /// (sin f, cos f): s′ = c f′, c′ = −s f′.
    #[inline]
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let [a0, a1, a2, a3] = self.0;
        let (s0, c0) = sin_cos(a0);
        let (s1, c1) = (c0 * a1, -s0 * a1);
        let (s2, c2) = (0.5 * c1 * a1 + c0 * a2, -0.5 * s1 * a1 - s0 * a2);
        let third = 1.0 / 3.0;
        let s3 = third * (c2 * a1 + 2.0 * c1 * a2) + c0 * a3;
        let c3 = -third * (s2 * a1 + 2.0 * s1 * a2) - s0 * a3;
        (Self([s0, s1, s2, s3]), Self([c0, c1, c2, c3]))
    }

    /// The angle of the vector (x, y), not both zero at t = 0, with `value` as its value there (the turn is the
    /// caller's to say): θ′ = (x y′ − y x′) / (x² + y²).
    #[inline]
    #[must_use]
    pub fn angle(x: Self, y: Self, value: f64) -> Self {
        let ([x0, x1, x2, x3], [y0, y1, y2, y3]) = (x.0, y.0);
        // Coefficients of x y′ − y x′ up to t², and of x² + y² up to t².
        let n0 = x0 * y1 - y0 * x1;
        let n1 = 2.0 * (x0 * y2 - y0 * x2);
        let n2 = 3.0 * (x0 * y3 - y0 * x3) + (x1 * y2 - y1 * x2);
        let d1 = 2.0 * (x0 * x1 + y0 * y1);
        let d2 = 2.0 * (x0 * x2 + y0 * y2) + x1 * x1 + y1 * y1;
        let reciprocal = 1.0 / (x0 * x0 + y0 * y0);
        // θ′ = n/d by long division, then integrated term by term.
        let w0 = n0 * reciprocal;
        let w1 = (n1 - w0 * d1) * reciprocal;
        let w2 = (n2 - w0 * d2 - w1 * d1) * reciprocal;
        Self([value, w0, w1 / 2.0, w2 / 3.0])
    }
}

impl Add for Taylor {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (self.0, other.0);
        Self([a0 + b0, a1 + b1, a2 + b2, a3 + b3])
    }
}

impl Sub for Taylor {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (self.0, other.0);
        Self([a0 - b0, a1 - b1, a2 - b2, a3 - b3])
    }
}

impl Neg for Taylor {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        let [a0, a1, a2, a3] = self.0;
        Self([-a0, -a1, -a2, -a3])
    }
}

impl Mul for Taylor {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (self.0, other.0);
        Self([a0 * b0, a0 * b1 + a1 * b0, a0 * b2 + a1 * b1 + a2 * b0, a0 * b3 + a1 * b2 + a2 * b1 + a3 * b0])
    }
}

impl Mul<f64> for Taylor {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|c| c * factor))
    }
}

impl Add<f64> for Taylor {
    type Output = Self;
    #[inline]
    fn add(self, constant: f64) -> Self {
        let [a0, a1, a2, a3] = self.0;
        Self([a0 + constant, a1, a2, a3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: Taylor, expected: [f64; 4]) {
        for (g, e) in got.0.iter().zip(expected) {
            assert!((g - e).abs() < 1e-14 * (1.0 + e.abs()), "{got:?} against {expected:?}");
        }
    }

    /// t ↦ exp(t) at 0 has coefficients 1/k!, and its functions are exponentials again.
    const EXP: Taylor = Taylor([1.0, 1.0, 0.5, 1.0 / 6.0]);

    #[test]
    fn functions_of_the_exponential() {
        close(EXP.squared(), [1.0, 2.0, 2.0, 8.0 / 6.0]);
        close(EXP * EXP, [1.0, 2.0, 2.0, 8.0 / 6.0]);
        close(EXP.sqrt_from(1.0), [1.0, 0.5, 0.125, 1.0 / 48.0]);
        close(EXP.reciprocal(), [1.0, -1.0, 0.5, -1.0 / 6.0]);
        close(EXP.stretched(2.0), [1.0, 0.5, 0.125, 1.0 / 48.0]);
        close(EXP.sqrt_from(-1.0), [-1.0, -0.5, -0.125, -1.0 / 48.0]);
        assert_eq!(EXP.derivatives(), [1.0, 1.0, 1.0]);
    }

    #[test]
    fn sine_and_cosine_of_a_cubic() {
        // sin(0.4 + t) and its derivatives; the chain rule's share is in the identity below.
        let (sin, cos) = 0.4_f64.sin_cos();
        let (s, c) = Taylor([0.4, 1.0, 0.0, 0.0]).sin_cos();
        close(s, [sin, cos, -sin / 2.0, -cos / 6.0]);
        close(c, [cos, -sin, -cos / 2.0, sin / 6.0]);
        let cubic = Taylor([0.4, -2.0, 3.0, 1.5]);
        let (s, c) = cubic.sin_cos();
        close(Taylor::angle(c, s, 0.4), cubic.0);
        close(s.squared() + c.squared(), [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn the_angle_of_a_turning_growing_vector_is_its_own() {
        // Angle 0.3 + 2t − t² + 4t³, radius exp(t).
        let (sin, cos) = 0.3_f64.sin_cos();
        let turn = [2.0, -1.0, 4.0];
        // e^{iα(t)} by its series: i(2t − t² + 4t³) + (i·)²/2 + (i·)³/6.
        let (re, im) = ([0.0, -2.0, 2.0], [turn[0], turn[1], turn[2] - 8.0 / 6.0]);
        let unit_x = Taylor([1.0, re[0], re[1], re[2]]);
        let unit_y = Taylor([0.0, im[0], im[1], im[2]]);
        let x = (unit_x * cos - unit_y * sin) * EXP;
        let y = (unit_x * sin + unit_y * cos) * EXP;
        close(Taylor::angle(x, y, 0.3), [0.3, 2.0, -1.0, 4.0]);
    }
}
