//! The input's door: whatever passes here has a solution, or a named reason why it has none.

use super::error::{Error, Quantity};
use super::input::{Control, Input};
use super::number::{larger, smaller};
use crate::math::float::sqrt;

/// How far, relative to the limit, a target may lie beyond a limit and still be taken as lying on it: rounding only.
const ON_LIMIT: f64 = 1e-14;

/// Checks every number of the input.
pub(super) fn validate<const N: usize>(input: &Input<N>) -> Result<(), Error> {
    for duration in [input.duration_min, input.duration_step].into_iter().flatten() {
        if !(duration.is_finite() && duration >= 0.0) {
            return Err(Error::BadDuration { value: duration });
        }
    }
    if input.duration_step == Some(0.0) {
        return Err(Error::BadDuration { value: 0.0 });
    }
    for axis in 0..N {
        if input.enabled[axis] && !is_plain(input, axis) {
            states(input, axis)?;
            limits(input, axis)?;
            target(input, axis)?;
        }
    }
    Ok(())
}

/// Whether an axis is beyond doubt, in as few operations as that takes; the checks below say what is wrong with others, if anything.
fn is_plain<const N: usize>(input: &Input<N>, axis: usize) -> bool {
    let Input { current, target, limits: l, .. } = input;
    let (p, v, a, j) =
        (target.position[axis], target.velocity[axis], target.acceleration[axis], l.jerk_max[axis]);
    // Infinite or not a number if one of them is.
    let sum = current.position[axis] + current.velocity[axis] + current.acceleration[axis] + p + v + a;
    let on_the_way = v - 0.5 * a * a.abs() / j;
    let signs = (j > 0.0)
        & (l.acceleration_min[axis] < 0.0)
        & (l.acceleration_max[axis] > 0.0)
        & (l.velocity_min[axis] <= 0.0)
        & (l.velocity_max[axis] >= 0.0)
        & (l.position_min[axis] <= l.position_max[axis]);
    let acceleration = (l.acceleration_min[axis] <= a) & (a <= l.acceleration_max[axis]);
    let velocity = (l.velocity_min[axis] <= smaller(v, on_the_way))
        & (larger(v, on_the_way) <= l.velocity_max[axis])
        & (l.position_min[axis] <= p)
        & (p <= l.position_max[axis]);
    sum.is_finite() & signs & acceleration & (velocity | (input.control[axis] == Control::Velocity))
}

/// The error of an axis whose numbers 64-bit floats do not hold: it names the one that is farthest from one.
#[cold]
pub(super) fn out_of_range<const N: usize>(input: &Input<N>, axis: usize) -> Error {
    let Input { current, target, limits: l, .. } = input;
    let numbers = [
        (Quantity::CurrentPosition, current.position[axis]),
        (Quantity::CurrentVelocity, current.velocity[axis]),
        (Quantity::CurrentAcceleration, current.acceleration[axis]),
        (Quantity::TargetPosition, target.position[axis]),
        (Quantity::TargetVelocity, target.velocity[axis]),
        (Quantity::TargetAcceleration, target.acceleration[axis]),
        (Quantity::VelocityMax, l.velocity_max[axis]),
        (Quantity::VelocityMin, l.velocity_min[axis]),
        (Quantity::AccelerationMax, l.acceleration_max[axis]),
        (Quantity::AccelerationMin, l.acceleration_min[axis]),
        (Quantity::JerkMax, l.jerk_max[axis]),
    ];
    let mut farthest = (Quantity::CurrentPosition, current.position[axis]);
    let mut most = 0.0;
    for (quantity, value) in numbers {
        let size = larger(value.abs(), 1.0 / value.abs());
        if size.is_finite() && size > most {
            (most, farthest) = (size, (quantity, value));
        }
    }
    let (quantity, value) = farthest;
    Error::OutOfRange { axis, quantity, value }
}

fn states<const N: usize>(input: &Input<N>, axis: usize) -> Result<(), Error> {
    let (current, target) = (&input.current, &input.target);
    let position_counts = input.control[axis] == Control::Position;
    let checks = [
        (Quantity::CurrentPosition, current.position[axis]),
        (Quantity::CurrentVelocity, current.velocity[axis]),
        (Quantity::CurrentAcceleration, current.acceleration[axis]),
        (Quantity::TargetVelocity, target.velocity[axis]),
        (Quantity::TargetAcceleration, target.acceleration[axis]),
        (Quantity::TargetPosition, if position_counts { target.position[axis] } else { 0.0 }),
    ];
    match checks.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((quantity, value)) => Err(Error::NotFinite { axis, quantity, value }),
        None => Ok(()),
    }
}

fn limits<const N: usize>(input: &Input<N>, axis: usize) -> Result<(), Error> {
    let l = &input.limits;
    // Written so that NaN fails.
    let checks = [
        (Quantity::VelocityMax, l.velocity_max[axis], l.velocity_max[axis] >= 0.0),
        (Quantity::VelocityMin, l.velocity_min[axis], l.velocity_min[axis] <= 0.0),
        (Quantity::AccelerationMax, l.acceleration_max[axis], l.acceleration_max[axis] >= 0.0),
        (Quantity::AccelerationMin, l.acceleration_min[axis], l.acceleration_min[axis] <= 0.0),
        (Quantity::JerkMax, l.jerk_max[axis], l.jerk_max[axis] >= 0.0),
        (Quantity::PositionMax, l.position_max[axis], l.position_max[axis] >= l.position_min[axis]),
        (Quantity::PositionMin, l.position_min[axis], !l.position_min[axis].is_nan()),
    ];
    match checks.into_iter().find(|(_, _, good)| !good) {
        Some((quantity, value, _)) => Err(Error::BadLimit { axis, quantity, value }),
        None => Ok(()),
    }
}

/// The target must lie within the limits, and so must the way there: whoever arrives with a_f < 0 was faster by
/// a_f²/(2 j_max) when its acceleration last was zero.
fn target<const N: usize>(input: &Input<N>, axis: usize) -> Result<(), Error> {
    let (l, target) = (&input.limits, &input.target);
    let (velocity, acceleration, jerk) = (target.velocity[axis], target.acceleration[axis], l.jerk_max[axis]);
    if jerk.is_finite() {
        let quantity = Quantity::TargetAcceleration;
        within(axis, quantity, acceleration, l.acceleration_min[axis], l.acceleration_max[axis])?;
    }
    if input.control[axis] == Control::Velocity {
        return Ok(());
    }
    let quantity = Quantity::TargetPosition;
    within(axis, quantity, target.position[axis], l.position_min[axis], l.position_max[axis])?;
    let on_the_way = if jerk.is_finite() && jerk > 0.0 {
        // Divided first: the square alone may overflow.
        let scaled = acceleration / sqrt(jerk);
        velocity - 0.5 * scaled * scaled.abs()
    } else {
        velocity
    };
    let quantity = Quantity::TargetVelocity;
    within(axis, quantity, velocity, l.velocity_min[axis], l.velocity_max[axis])?;
    within(axis, quantity, on_the_way, l.velocity_min[axis], l.velocity_max[axis])
}

fn within(axis: usize, quantity: Quantity, value: f64, min: f64, max: f64) -> Result<(), Error> {
    if value > max + ON_LIMIT * max.abs() {
        Err(Error::TargetBeyondLimit { axis, quantity, value, limit: max })
    } else if value < min - ON_LIMIT * min.abs() {
        Err(Error::TargetBeyondLimit { axis, quantity, value, limit: min })
    } else {
        Ok(())
    }
}
