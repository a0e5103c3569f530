//! Joint limits and full turns.

use core::f64::consts::{PI, TAU};

use super::branches::{Branches, nearest};
use super::{InverseError, JointKind, ModelError};
use crate::math::float::{ceil, floor, round};

/// A position this little beyond its limit is rounding, and is set onto the limit. Radians (2 pm at 2 m), or
/// metres.
const ROUNDING: f64 = 1e-12;

/// Position and velocity limits of N joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLimits<const N: usize> {
    position: [(f64, f64); N],
    velocity: [f64; N],
}

impl<const N: usize> JointLimits<N> {
    /// Limits from least and greatest positions (rad, or m) and greatest speeds (rad/s, or m/s). Infinite ones are
    /// allowed.
    ///
    /// # Errors
    /// [`ModelError::PositionLimits`], [`ModelError::VelocityLimit`] with the first joint that has none.
    pub fn try_new(position: [(f64, f64); N], velocity: [f64; N]) -> Result<Self, ModelError> {
        for (axis, (&(min, max), &value)) in position.iter().zip(&velocity).enumerate() {
            // NaN is neither.
            let (ordered, positive) = (min < max, value > 0.0);
            if !ordered {
                return Err(ModelError::PositionLimits { axis, min, max });
            }
            if !positive {
                return Err(ModelError::VelocityLimit { axis, value });
            }
        }
        Ok(Self::of_valid(position, velocity))
    }

    /// Limits that are known to be valid.
    pub(super) fn of_valid(position: [(f64, f64); N], velocity: [f64; N]) -> Self {
        Self { position, velocity }
    }

    /// No limits at all.
    #[must_use]
    pub fn unlimited() -> Self {
        Self { position: [(f64::NEG_INFINITY, f64::INFINITY); N], velocity: [f64::INFINITY; N] }
    }

    /// Least and greatest position of each joint.
    #[must_use]
    pub fn position(&self) -> &[(f64, f64); N] {
        &self.position
    }

    /// Greatest speed of each joint.
    #[must_use]
    pub fn velocity(&self) -> &[f64; N] {
        &self.velocity
    }

    /// Each joint within its limits, a turning joint in the turn nearest to the reference. Nothing if one cannot be.
    #[inline]
    pub(super) fn turned_within(
        &self,
        q: &[f64; N],
        reference: &[f64; N],
        kinds: &[JointKind; N],
    ) -> Option<[f64; N]> {
        let mut turned = *q;
        for (axis, position) in turned.iter_mut().enumerate() {
            let (min, max) = self.position[axis];
            *position = match kinds[axis] {
                JointKind::Revolute => nearest_turn_within(*position, reference[axis], (min, max))?,
                JointKind::Prismatic => within((min, max), *position)?,
            };
        }
        Some(turned)
    }

    /// Of several joint positions those within the limits, in the turns nearest to the reference; where there is none,
    /// what keeps the one nearest to it outside.
    pub(super) fn branches_within<const MAX: usize>(
        &self,
        all: &[[f64; N]],
        reference: &[f64; N],
        kinds: &[JointKind; N],
    ) -> Result<Branches<[f64; N], MAX>, InverseError> {
        let mut kept = Branches::none(*reference);
        all.iter().filter_map(|q| self.turned_within(q, reference, kinds)).for_each(|q| kept.push(q));
        if kept.as_slice().is_empty() {
            let turned = |q: &[f64; N]| core::array::from_fn(|i| nearest_turn(q[i], reference[i]));
            let q = nearest(all.iter().map(turned), reference).unwrap_or(*reference);
            return Err(self.worst_violation(&q, kinds));
        }
        Ok(kept)
    }

    /// Of joint positions that are not within the limits in any turn: the joint furthest outside.
    #[cold]
    pub(super) fn worst_violation(&self, q: &[f64; N], kinds: &[JointKind; N]) -> InverseError {
        let (mut worst, mut most) = ((0, 0.0, (0.0, 0.0)), -1.0);
        for (axis, (&position, &(min, max))) in q.iter().zip(&self.position).enumerate() {
            let (value, excess) = match kinds[axis] {
                JointKind::Revolute => least_excess_turn(position, (min, max)),
                JointKind::Prismatic => (position, (min - position).max(position - max)),
            };
            if excess > most {
                (worst, most) = ((axis, value, (min, max)), excess);
            }
        }
        let (axis, value, (min, max)) = worst;
        InverseError::PositionLimit { axis, value, min, max }
    }

    /// The first joint that passes its limit, with its position.
    #[must_use]
    pub fn first_violation(&self, q: &[f64; N]) -> Option<(usize, f64)> {
        let outside = |(axis, &value): (usize, &f64)| {
            let (min, max) = self.position[axis];
            (!(min..=max).contains(&value)).then_some((axis, value))
        };
        q.iter().enumerate().find_map(outside)
    }
}

/// The angle equal to `angle` modulo full turns, within (min, max), that lies nearest to `reference`.
#[inline]
pub(super) fn nearest_turn_within(angle: f64, reference: f64, (min, max): (f64, f64)) -> Option<f64> {
    let nearest = nearest_turn(angle, reference);
    let turned = if nearest > max + ROUNDING {
        angle + TAU * floor((max + ROUNDING - angle) / TAU)
    } else if nearest < min - ROUNDING {
        angle + TAU * ceil((min - ROUNDING - angle) / TAU)
    } else {
        nearest
    };
    within((min, max), turned)
}

/// The position, within (min, max) but for rounding.
#[inline]
fn within((min, max): (f64, f64), position: f64) -> Option<f64> {
    (position >= min - ROUNDING && position <= max + ROUNDING).then(|| position.max(min).min(max))
}

/// The angle equal to `angle` modulo full turns that lies nearest to `reference`.
#[inline]
pub(super) fn nearest_turn(angle: f64, reference: f64) -> f64 {
    let difference = reference - angle;
    if difference.abs() <= PI { angle } else { angle + TAU * round(difference / TAU) }
}

/// The angle modulo full turns in (−π, π], or within rounding of it.
#[inline]
pub(super) fn principal(angle: f64) -> f64 {
    if angle > PI || angle <= -PI { angle - TAU * round(angle / TAU) } else { angle }
}

/// The turn of `angle` that passes the range (min, max) least, and how far it passes it.
pub(super) fn least_excess_turn(angle: f64, (min, max): (f64, f64)) -> (f64, f64) {
    if let Some(inside) = nearest_turn_within(angle, angle, (min, max)) {
        return (inside, 0.0);
    }
    let above = angle + TAU * ceil((max - angle) / TAU);
    let below = angle + TAU * floor((min - angle) / TAU);
    if above - max < min - below { (above, above - max) } else { (below, min - below) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_to_the_reference_and_stay_inside() {
        let wide = (-2.5 * PI, 2.5 * PI);
        assert_eq!(nearest_turn_within(0.1, 6.0, wide), Some(0.1 + TAU));
        assert_eq!(nearest_turn_within(0.1, 100.0, wide), Some(0.1 + TAU));
        assert_eq!(nearest_turn_within(0.1, -100.0, wide), Some(0.1 - TAU));
        assert_eq!(nearest_turn_within(2.0, 0.0, (-1.0, 1.0)), None);
        assert_eq!(nearest_turn_within(5.0, 0.0, (-2.0, -1.0)), Some(5.0 - TAU));
        assert_eq!(nearest_turn_within(-PI, 3.0, (-PI, PI)), Some(PI));
    }

    #[test]
    fn a_rounding_error_beyond_the_limit_is_the_limit() {
        assert_eq!(nearest_turn_within(1.0 + 4e-16, 0.0, (-1.0, 1.0)), Some(1.0));
        assert_eq!(nearest_turn_within(-1.0 - 4e-16, 0.0, (-1.0, 1.0)), Some(-1.0));
        assert_eq!(nearest_turn_within(1.0 + 1e-11, 0.0, (-1.0, 1.0)), None);
    }

    #[test]
    fn the_least_excess_is_over_the_nearer_end() {
        let (value, excess) = least_excess_turn(1.2, (-1.0, 1.0));
        assert!((value - 1.2).abs() < 1e-15 && (excess - 0.2).abs() < 1e-15);
        let (value, excess) = least_excess_turn(5.0, (-1.0, 1.0));
        assert!((value - (5.0 - TAU)).abs() < 1e-15 && (excess - (TAU - 6.0)).abs() < 1e-14);
    }

    #[test]
    fn limits_that_enclose_nothing_are_refused() {
        let error = JointLimits::try_new([(0.0, 1.0), (1.0, 1.0)], [1.0, 1.0]);
        assert_eq!(error, Err(ModelError::PositionLimits { axis: 1, min: 1.0, max: 1.0 }));
        assert!(JointLimits::try_new([(0.0, f64::NAN)], [1.0]).is_err());
        assert_eq!(
            JointLimits::try_new([(0.0, 1.0)], [0.0]),
            Err(ModelError::VelocityLimit { axis: 0, value: 0.0 })
        );
    }
}
