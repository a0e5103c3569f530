//! The platform's elementary functions.

/// Square root.
#[inline]
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Cube root, with the argument's sign.
#[inline]
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    x.cbrt()
}

/// Sine.
#[inline]
#[must_use]
pub fn sin(x: f64) -> f64 {
    x.sin()
}

/// Cosine.
#[inline]
#[must_use]
pub fn cos(x: f64) -> f64 {
    x.cos()
}

/// Arc cosine in [0, π].
#[inline]
#[must_use]
pub fn acos(x: f64) -> f64 {
    x.acos()
}

/// Exponential function.
#[inline]
#[must_use]
pub fn exp(x: f64) -> f64 {
    x.exp()
}

/// Natural logarithm.
#[inline]
#[must_use]
pub fn ln(x: f64) -> f64 {
    x.ln()
}

/// Largest whole number not above the argument.
#[inline]
#[must_use]
pub fn floor(x: f64) -> f64 {
    x.floor()
}

/// Smallest whole number not below the argument.
#[inline]
#[must_use]
pub fn ceil(x: f64) -> f64 {
    x.ceil()
}

/// Nearest whole number, halves away from zero.
#[inline]
#[must_use]
pub fn round(x: f64) -> f64 {
    x.round()
}

/// Angle of the vector (x, y) in (−π, π].
#[inline]
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    y.atan2(x)
}

/// Length of the vector (x, y), without overflow.
#[inline]
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    x.hypot(y)
}

/// Power.
#[inline]
#[must_use]
pub fn powf(x: f64, y: f64) -> f64 {
    x.powf(y)
}

/// x·y + z with one rounding.
#[inline]
#[must_use]
pub fn mul_add(x: f64, y: f64, z: f64) -> f64 {
    x.mul_add(y, z)
}

/// Sine and cosine.
#[inline]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    x.sin_cos()
}
