//! The larger and the smaller of two numbers, in one instruction each.

/// A multiplication is several times as fast as a division.
pub(super) const SIXTH: f64 = 1.0 / 6.0;

/// How far the rounding of states may have added up over the cycles of a motion that is planned anew on each, as a fraction of the
/// numbers themselves.
pub(super) const NOISE: f64 = 1024.0 * f64::EPSILON;

/// The larger; the second if one of them is not a number. (`f64::max` takes five instructions to treat both alike.)
#[inline]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller; the second if one of them is not a number.
#[inline]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// `value` moved to the nearest point of `low..=high`.
#[inline]
pub(super) fn between(value: f64, low: f64, high: f64) -> f64 {
    smaller(larger(value, low), high)
}
