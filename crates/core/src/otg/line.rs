//! Phase synchronization: all axes of a line as one scalar problem. See `docs/otg.md`, section 10.

use super::axis::AxisInput;
use super::input::{Control, Input};
use super::profile::Point;

/// A line: axis i moves as p₀ᵢ + uᵢ s(t), and the axis `reference` has u = 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<const N: usize> {
    pub(super) reference: usize,
    pub(super) direction: [f64; N],
    /// The motion s(t), from s = 0, under the tightest of the axes' limits.
    pub(super) scalar: AxisInput,
}

/// Velocities and accelerations are parallel if what is left over is this fraction of their size.
const PARALLEL: f64 = 1e-12;
/// Displacements are parallel if what is left over is this fraction of their coordinates.
const PARALLEL_POSITION: f64 = 1024.0 * f64::EPSILON;
/// The displacement gives the direction if that leaves the others parallel but for this many roundings: a line that is planned
/// anew on every cycle then leads to the target each time, and rounding does not add up.
const EXACT_ENOUGH: f64 = 128.0;

/// One of the vectors that must be parallel, with the size that its components' rounding errors are reckoned by.
#[derive(Debug, Clone, Copy)]
struct Parallel<const N: usize> {
    value: [f64; N],
    size: [f64; N],
    tolerance: f64,
}

impl<const N: usize> Line<N> {
    /// The line of the axes in `members`, or an axis that leaves it.
    pub(super) fn new(input: &Input<N>, members: &[bool; N]) -> Result<Self, usize> {
        let axes: [AxisInput; N] = core::array::from_fn(|axis| AxisInput::of(input, axis));
        let member = |axis: &usize| members[*axis];
        let first = (0..N).find(member).unwrap_or(0);
        let control = axes[first].control;
        // What is reached must be the same, whether it moves, and whether accelerations count.
        let kind =
            |axis: usize| (axes[axis].control, axes[axis].jerk == f64::INFINITY, input.target_moves[axis]);
        if let Some(other) = (0..N).filter(member).find(|&axis| kind(axis) != kind(first)) {
            return Err(other);
        }
        let vectors = parallels(&axes, control);
        let (chosen, reference) = guide(&vectors, members, first);
        let along = vectors[chosen].value[reference];
        let mut direction: [f64; N] = core::array::from_fn(|axis| {
            if members[axis] && along != 0.0 { vectors[chosen].value[axis] / along } else { 0.0 }
        });
        // Where there is nothing to do the line is that axis' own.
        direction[reference] = 1.0;
        for vector in &vectors {
            for axis in (0..N).filter(member) {
                let off = vector.value[axis] - direction[axis] * vector.value[reference];
                let size = vector.size[axis] + direction[axis].abs() * vector.size[reference];
                if off.abs() > vector.tolerance * size {
                    return Err(axis);
                }
            }
        }
        let scalar = scalar(&axes, members, &direction, reference);
        // One axis' jerk limit and another's velocity limit may keep the line from a target that each axis alone could reach.
        let on_the_way = scalar.target.v - 0.5 * scalar.target.a * scalar.target.a.abs() / scalar.jerk;
        let slack = PARALLEL * (scalar.target.v.abs() + on_the_way.abs());
        let reachable = scalar.v_min - slack <= on_the_way && on_the_way <= scalar.v_max + slack;
        if control == Control::Position && scalar.jerk > 0.0 && !reachable {
            return Err(reference);
        }
        Ok(Self { reference, direction, scalar })
    }
}

/// Displacement, velocities and accelerations; in velocity control the change of velocity and the accelerations.
fn parallels<const N: usize>(axes: &[AxisInput; N], control: Control) -> [Parallel<N>; 5] {
    let vector = |tolerance, component: fn(&AxisInput) -> (f64, f64)| Parallel {
        value: core::array::from_fn(|axis| component(&axes[axis]).0),
        size: core::array::from_fn(|axis| component(&axes[axis]).1),
        tolerance,
    };
    let displacement: fn(&AxisInput) -> (f64, f64) = |a| (a.target.p - a.current.p, a.coordinates);
    let change: fn(&AxisInput) -> (f64, f64) = |a| (a.target.v - a.current.v, velocity_size(a));
    let nothing: fn(&AxisInput) -> (f64, f64) = |_| (0.0, 0.0);
    let in_position = control == Control::Position;
    [
        vector(PARALLEL_POSITION, if in_position { displacement } else { change }),
        vector(PARALLEL, if in_position { |a| (a.current.v, velocity_size(a)) } else { nothing }),
        // A target that moves on must do so along the line.
        vector(PARALLEL, if in_position { |a| (a.target.v + a.drift, velocity_size(a)) } else { nothing }),
        vector(PARALLEL, |a| (a.current.a, acceleration_size(a))),
        vector(PARALLEL, |a| (a.target.a, acceleration_size(a))),
    ]
}

/// The limit, or the velocities themselves where there is none.
fn velocity_size(axis: &AxisInput) -> f64 {
    let limit = axis.v_max.max(-axis.v_min);
    let own = axis.current.v.abs().max(axis.target.v.abs()) + axis.drift.abs();
    if limit < f64::INFINITY && axis.control == Control::Position { limit.max(own) } else { own }
}

fn acceleration_size(axis: &AxisInput) -> f64 {
    let limit = axis.a_max.max(-axis.a_min);
    let own = axis.current.a.abs().max(axis.target.a.abs());
    if limit < f64::INFINITY { limit.max(own) } else { own }
}

/// Vector and axis that give the direction: the displacement if it is exact enough, otherwise the most exact.
fn guide<const N: usize>(vectors: &[Parallel<N>; 5], members: &[bool; N], first: usize) -> (usize, usize) {
    let mut best = (0, first);
    let mut least = f64::INFINITY;
    for (index, vector) in vectors.iter().enumerate() {
        let reference = largest(vector, members, first);
        let roundings = worst(vectors, vector, members, reference);
        if roundings < least {
            (least, best) = (roundings, (index, reference));
        }
        if index == 0 && roundings <= EXACT_ENOUGH {
            break;
        }
    }
    best
}

/// The axis on which a vector is largest for its size.
fn largest<const N: usize>(vector: &Parallel<N>, members: &[bool; N], first: usize) -> usize {
    let mut best = first;
    let mut share = 0.0;
    for axis in (0..N).filter(|&axis| members[axis]) {
        let own = vector.value[axis].abs() / vector.size[axis];
        // Not true at 0/0.
        if own > share {
            (share, best) = (own, axis);
        }
    }
    best
}

/// By how many roundings of their sizes the vectors may be off a direction that is taken from `guide`.
///
/// Component i of the direction is off by guide.sizeᵢ / guide.value roundings, and what a vector makes of that is to be held against its own
/// size.
fn worst<const N: usize>(
    vectors: &[Parallel<N>; 5],
    guide: &Parallel<N>,
    members: &[bool; N],
    reference: usize,
) -> f64 {
    let along = guide.value[reference].abs();
    if along == 0.0 {
        return f64::INFINITY;
    }
    let mut worst = 0.0;
    for vector in vectors {
        let scale = vector.value[reference].abs() / along;
        for axis in (0..N).filter(|&axis| members[axis] && guide.size[axis] > 0.0) {
            let off = scale * guide.size[axis] / vector.size[axis];
            if off > worst {
                worst = off;
            }
        }
    }
    worst
}

/// The problem along the line, within the tightest limits of its axes.
fn scalar<const N: usize>(
    axes: &[AxisInput; N],
    members: &[bool; N],
    direction: &[f64; N],
    reference: usize,
) -> AxisInput {
    let own = &axes[reference];
    let velocity_control = own.control == Control::Velocity;
    // In velocity control the line is one of velocities: s starts at rest.
    let base = if velocity_control { own.current.v } else { 0.0 };
    let mut scalar = AxisInput {
        control: own.control,
        current: Point { p: 0.0, v: own.current.v - base, a: own.current.a },
        target: Point { p: own.target.p - own.current.p, v: own.target.v - base, a: own.target.a },
        v_max: f64::INFINITY,
        v_min: f64::NEG_INFINITY,
        a_max: f64::INFINITY,
        a_min: f64::NEG_INFINITY,
        jerk: f64::INFINITY,
        drift: own.drift,
        coordinates: own.coordinates,
    };
    for axis in (0..N).filter(|&axis| members[axis] && direction[axis] != 0.0) {
        let (limits, u) = (&axes[axis], direction[axis]);
        let (v_high, v_low) = turned(limits.v_max, limits.v_min, u);
        let (a_high, a_low) = turned(limits.a_max, limits.a_min, u);
        scalar.v_max = scalar.v_max.min(v_high / u.abs());
        scalar.v_min = scalar.v_min.max(v_low / u.abs());
        scalar.a_max = scalar.a_max.min(a_high / u.abs());
        scalar.a_min = scalar.a_min.max(a_low / u.abs());
        scalar.jerk = scalar.jerk.min(limits.jerk / u.abs());
    }
    scalar
}

/// Upper and lower limit along a direction that may point backward.
fn turned(max: f64, min: f64, direction: f64) -> (f64, f64) {
    if direction > 0.0 { (max, min) } else { (-min, -max) }
}
