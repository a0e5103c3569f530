//! Lines, arcs, blends and splines as functions of their coordinate.

mod corner;
mod quintic;
mod random;
mod spline;

use super::*;
use crate::geometry::{Rotation, Vector3};

fn pose(x: f64, y: f64, z: f64, turn: [f64; 3]) -> Pose {
    Pose::new(Vector3::new(x, y, z), Vector3::from(turn))
}

/// Angular velocity from R(s+h)·R(s−h)ᵀ, and derivatives of the position, all by differences.
fn assert_derivatives(path: &Path, s: f64) {
    let h = 1e-4 * path.length();
    let (before, here, after) = (path.jet(s - h), path.jet(s), path.jet(s + h));
    let spin = (after.pose.rotation * before.pose.rotation.inverse()).scaled_axis() / (2.0 * h);
    assert!((here.angular[0] - spin).norm() < 1e-5 * (1.0 + spin.norm()), "angular velocity at {s}");
    let velocity = (after.pose.translation.vector - before.pose.translation.vector) / (2.0 * h);
    if path.measure() == Measure::Length {
        assert!((here.linear[0] - velocity).norm() < 1e-6);
        assert!((here.linear[0].norm() - 1.0).abs() < 1e-12, "the coordinate is arc length");
    }
    for order in 0..2 {
        let linear = (after.linear[order] - before.linear[order]) / (2.0 * h);
        assert!(
            (here.linear[order + 1] - linear).norm() < 1e-5 * (1.0 + linear.norm()),
            "position, order {order}"
        );
        let angular = (after.angular[order] - before.angular[order]) / (2.0 * h);
        assert!(
            (here.angular[order + 1] - angular).norm() < 1e-5 * (1.0 + angular.norm()),
            "turn, order {order}"
        );
    }
}

#[test]
fn line_goes_straight_and_turns_with_it() {
    let (start, end) = (pose(1.0, 0.0, 0.2, [0.0, 3.0, 0.0]), pose(1.2, -0.3, 0.4, [0.4, 2.5, 0.3]));
    let path = Path::line(&start, &end);
    assert!((path.length() - 0.17_f64.sqrt()).abs() < 1e-15);
    assert!((path.pose(0.0).inverse() * start).translation.vector.norm() < 1e-15);
    let last = path.pose(path.length());
    assert!((last.translation.vector - end.translation.vector).norm() < 1e-15);
    assert_eq!(last.rotation, end.rotation);
    let middle = path.pose(path.length() / 2.0);
    let whole = start.rotation.angle_to(&end.rotation);
    assert!((start.rotation.angle_to(&middle.rotation) - whole / 2.0).abs() < 1e-14);
    for k in 1..10 {
        assert_derivatives(&path, path.length() * f64::from(k) / 10.0);
    }
}

#[test]
fn a_turn_on_the_spot_counts_radians() {
    let path = Path::line(&pose(1.0, 0.0, 0.2, [0.0, 0.0, 0.0]), &pose(1.0, 0.0, 0.2, [0.0, 0.0, 0.5]));
    assert_eq!(path.measure(), Measure::Angle);
    assert!((path.length() - 0.5).abs() < 1e-15);
    let jet = path.jet(0.25);
    assert!((jet.angular[0] - Vector3::z()).norm() < 1e-14 && jet.linear[0].norm() == 0.0);
}

#[test]
fn arc_passes_through_its_three_points_with_their_orientations() {
    let torch = |angle: f64| {
        let turn = Rotation::from_axis_angle(&Vector3::z_axis(), angle);
        let position = turn * Vector3::new(0.1, 0.0, 0.3);
        Pose::from_parts(position.into(), turn * Rotation::from_euler_angles(2.4, 0.2, 0.1))
    };
    // 250 degrees: the geodesic from start to end would turn the other way.
    let (start, via, end) = (torch(0.0), torch(2.0), torch(250_f64.to_radians()));
    let path = Path::arc(&start, &via, &end).unwrap();
    assert!((path.length() - 0.1 * 250_f64.to_radians()).abs() < 1e-13);
    for angle in [0.0, 1.0, 2.0, 3.0, 4.0, 250_f64.to_radians()] {
        let got = path.pose(0.1 * angle);
        assert!((got.translation.vector - torch(angle).translation.vector).norm() < 1e-14);
        assert!(got.rotation.angle_to(&torch(angle).rotation) < 1e-7, "at {angle}");
    }
    for k in 1..20 {
        assert_derivatives(&path, path.length() * f64::from(k) / 20.0);
    }
}

#[test]
fn arc_with_an_uneven_turn_is_smooth() {
    let path = Path::arc(
        &pose(1.0, -0.1, 0.0, [0.1, 2.0, 0.3]),
        &pose(1.1, 0.0, 0.05, [0.3, 2.4, -0.3]),
        &pose(1.0, 0.1, 0.0, [0.9, 2.2, 0.8]),
    )
    .unwrap();
    for k in 1..40 {
        assert_derivatives(&path, path.length() * f64::from(k) / 40.0);
    }
}

#[test]
fn three_points_that_give_no_circle_are_refused() {
    let at = |x: f64, y: f64| pose(x, y, 0.0, [0.0; 3]);
    assert_eq!(Path::arc(&at(0.0, 0.0), &at(0.0, 0.0), &at(1.0, 0.0)), Err(ArcError::Coincident(0, 1)));
    assert_eq!(Path::arc(&at(0.0, 0.0), &at(1.0, 0.0), &at(0.0, 0.0)), Err(ArcError::Coincident(0, 2)));
    assert_eq!(Path::arc(&at(0.0, 0.0), &at(1.0, 0.0), &at(1.0, 0.0)), Err(ArcError::Coincident(1, 2)));
    assert_eq!(Path::arc(&at(0.0, 0.0), &at(1.0, 0.0), &at(2.0, 1e-7)), Err(ArcError::Collinear));
}

#[test]
fn part_of_a_circle_keeps_its_sense() {
    let at = |angle: f64| pose(angle.cos(), angle.sin(), 0.0, [0.0, 0.0, angle]);
    let path = Path::arc_between(&at(0.0), &at(1.0), &at(2.0), &at(1.0), &at(2.0)).unwrap();
    assert!((path.length() - 1.0).abs() < 1e-14);
    for angle in [1.0, 1.3, 2.0] {
        let error = path.pose(angle - 1.0).inverse() * at(angle);
        assert!(error.translation.vector.norm() < 1e-14 && error.rotation.angle() < 1e-7);
    }
    let back = Path::arc_between(&at(2.0), &at(1.0), &at(0.0), &at(1.0), &at(0.0)).unwrap();
    assert!((back.pose(0.5).translation.vector - at(0.5).translation.vector).norm() < 1e-14);
}

#[test]
fn a_tilted_path_has_the_same_points_and_turns_likewise() {
    let poses = [
        pose(1.0, -0.1, 0.0, [0.1, 2.0, 0.3]),
        pose(1.1, 0.0, 0.0, [0.3, 2.4, -0.3]),
        pose(1.0, 0.1, 0.0, [0.9, 2.2, 0.8]),
    ];
    let tilt = Rotation::from_scaled_axis(Vector3::new(0.1, -0.05, 0.02));
    for path in [Path::line(&poses[0], &poses[2]), Path::arc(&poses[0], &poses[1], &poses[2]).unwrap()] {
        let tilted = path.tilted(&tilt);
        for k in 0..=10 {
            let (jet, other) = (
                path.jet(path.length() * 0.1 * f64::from(k)),
                tilted.jet(path.length() * 0.1 * f64::from(k)),
            );
            assert_eq!((jet.linear, jet.angular), (other.linear, other.angular));
            assert_eq!(jet.pose.translation, other.pose.translation);
            assert!((jet.pose.rotation * tilt).angle_to(&other.pose.rotation) < 1e-7);
        }
    }
}
