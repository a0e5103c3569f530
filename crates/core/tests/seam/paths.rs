//! Taught paths in space, with a torch that is tilted on them.

use nalgebra::Unit;
use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::path::{Path, spline};
use seamline::seam::PathChain;

const MM: f64 = 1e-3;

/// A torch at `position`, its wire tilted by a work angle (about the travel) and a travel angle (about the lateral axis) from straight
/// down on a path in direction `tangent` on a plate with the normal `up`.
fn torch(position: Vector3, tangent: Vector3, up: Vector3, work: f64, travel: f64) -> Pose {
    let left = up.cross(&tangent);
    // Tool x along the travel, z down.
    let upright = Rotation::from_basis_unchecked(&[tangent, -left, -up]);
    let work = Rotation::from_axis_angle(&Unit::new_normalize(tangent), work);
    let travel = Rotation::from_axis_angle(&Unit::new_normalize(left), travel);
    Pose::from_parts(position.into(), work * travel * upright)
}

/// A frame somewhere in the cell, so that no axis is special.
fn somewhere() -> Pose {
    Pose::new(Vector3::new(0.9, -0.3, 0.2), Vector3::new(0.3, -0.5, 0.8))
}

fn placed(local: Pose) -> Pose {
    somewhere() * local
}

/// A straight path.
pub(crate) fn line(length: f64, work: f64, travel: f64) -> Path {
    let at = |x: f64| placed(torch(Vector3::new(x, 0.0, 0.0), Vector3::x(), Vector3::z(), work, travel));
    Path::line(&at(0.0), &at(length))
}

/// An arc to the left; the torch turns with it.
pub(crate) fn arc(radius: f64, length: f64, work: f64, travel: f64) -> Path {
    let at = |way: f64| {
        let (sin, cos) = (way / radius).sin_cos();
        let position = Vector3::new(sin, 1.0 - cos, 0.0) * radius;
        placed(torch(position, Vector3::new(cos, sin, 0.0), Vector3::z(), work, travel))
    };
    Path::arc(&at(0.0), &at(0.5 * length), &at(length)).expect("an arc")
}

pub(crate) const LENGTH: f64 = 300.0 * MM;

/// A curve in space through poses with a turning torch, as the moves of a weld would have it.
pub(crate) fn curve() -> PathChain<8> {
    let at = |k: usize| {
        let way = 60.0 * MM * k as f64;
        let position = Vector3::new(way, 40.0 * MM * (way / 0.15).sin(), 15.0 * MM * (way / 0.1).cos());
        let tangent = Vector3::new(1.0, 0.27 * (way / 0.15).cos(), -0.15 * (way / 0.1).sin()).normalize();
        let up = (Vector3::z() - tangent * tangent.z).normalize();
        placed(torch(position, tangent, up, 0.3 + 0.1 * k as f64, 0.2 - 0.05 * k as f64))
    };
    let poses: [Pose; 7] = core::array::from_fn(at);
    let mut pieces = [Path::line(&poses[0], &poses[1]); 6];
    spline(&poses, None, None, &mut pieces).expect("a spline");
    let mut chain = PathChain::new(0.0);
    for piece in &pieces {
        chain.push(piece).expect("smooth");
    }
    chain
}
