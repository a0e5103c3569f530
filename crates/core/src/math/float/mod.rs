//! Elementary functions of `f64`: the platform's with feature `std`, portable ones without. Same names, same meaning.
//!
//! Angles in radians. Out of its domain a function gives NaN, as in IEEE 754.

#[cfg(feature = "std")]
mod platform;
#[cfg(feature = "std")]
pub use platform::{
    acos, atan2, cbrt, ceil, cos, exp, floor, hypot, ln, mul_add, powf, round, sin, sin_cos, sqrt,
};

#[cfg(not(feature = "std"))]
pub use libm::{
    acos, atan2, cbrt, ceil, cos, exp, floor, fma as mul_add, hypot, log as ln, pow as powf, round, sin,
    sincos as sin_cos, sqrt,
};
