//! Splines, judged by their points.

use std::vec::Vec;

use super::random::Random;
use super::*;

fn through(poses: &[Pose]) -> Vec<Path> {
    joined(poses, None, None)
}

fn joined(poses: &[Pose], start: Option<&PoseJet>, end: Option<&PoseJet>) -> Vec<Path> {
    let mut pieces = vec_of(poses.len() - 1);
    spline(poses, start, end, &mut pieces).unwrap();
    pieces
}

fn vec_of(count: usize) -> Vec<Path> {
    (0..count).map(|_| Path::line(&Pose::identity(), &Pose::identity())).collect()
}

/// A way that goes on: steps of 50 to 150 mm, each turned by up to a radian or so from the last one.
fn way(random: &mut Random, count: usize) -> Vec<Pose> {
    let mut pose = random.pose(0.5, 1.0);
    let mut direction = random.vector(1.0).normalize();
    (0..count)
        .map(|_| {
            direction = (direction + random.vector(0.5)).normalize();
            let step = Pose::new(direction * random.within(0.05, 0.15), Vector3::zeros());
            let turn = Rotation::from_scaled_axis(random.vector(0.3));
            pose = Pose::from_parts((step * pose).translation, turn * pose.rotation);
            pose
        })
        .collect()
}

fn angle(a: &Rotation, b: &Rotation) -> f64 {
    (a * b.inverse()).scaled_axis().norm()
}

/// Same pose, tangent, curvature and turning, with its change, to rounding; curvature also by differences.
fn assert_goes_on(before: &Path, after: &Path) {
    let (end, start) = (before.jet(before.length()), after.jet(0.0));
    assert!((end.pose.translation.vector - start.pose.translation.vector).norm() < 1e-14);
    assert!(angle(&end.pose.rotation, &start.pose.rotation) < 1e-13);
    for order in 0..2 {
        assert!((end.linear[order] - start.linear[order]).norm() < 1e-9, "position, order {order}");
        assert!((end.angular[order] - start.angular[order]).norm() < 1e-9, "turn, order {order}");
    }
    // Tangents and turning rates across the joint: a step of their slope would show as a difference of this size.
    let h = 1e-4 * before.length().min(after.length());
    let [back, ahead] = [before.jet(before.length() - h), after.jet(h)];
    let bend = |of: &dyn Fn(&PoseJet) -> Vector3| {
        ((of(&ahead) - of(&start)) / h - (of(&end) - of(&back)) / h).norm()
    };
    assert!(bend(&|jet| jet.linear[0]) < 1e-3 * (1.0 + end.linear[2].norm() + start.linear[2].norm()));
    assert!(bend(&|jet| jet.angular[0]) < 1e-3 * (1.0 + end.angular[2].norm() + start.angular[2].norm()));
}

#[test]
fn a_spline_passes_every_pose_with_continuous_curvature() {
    let mut random = Random(8);
    for _ in 0..200 {
        let poses = way(&mut random, 7);
        let pieces = through(&poses);
        for (piece, pair) in pieces.iter().zip(poses.windows(2)) {
            for (got, taught) in [(piece.pose(0.0), &pair[0]), (piece.pose(piece.length()), &pair[1])] {
                assert!((got.translation.vector - taught.translation.vector).norm() < 1e-14);
                assert!(angle(&got.rotation, &taught.rotation) < 1e-13);
            }
        }
        for pair in pieces.windows(2) {
            assert_goes_on(&pair[0], &pair[1]);
        }
    }
}

#[test]
fn a_spline_goes_on_from_its_neighbours() {
    let mut random = Random(9);
    for _ in 0..100 {
        let mut poses = way(&mut random, 5);
        let before = Path::arc(&poses[0], &poses[1], &poses[2]).unwrap();
        poses.drain(0..2);
        let start = before.jet(before.length());
        let last = poses[2];
        let beyond = Pose::from_parts(
            (last.translation.vector * 2.0 - poses[1].translation.vector + random.vector(0.02)).into(),
            Rotation::from_scaled_axis(random.vector(0.2)) * last.rotation,
        );
        let after = Path::line(&last, &beyond);
        let pieces = joined(&poses, Some(&start), Some(&after.jet(0.0)));
        assert_goes_on(&before, &pieces[0]);
        assert_goes_on(&pieces[1], &after);
    }
}

#[test]
fn three_points_of_a_parabola_give_nearly_that_parabola() {
    // y = x²/2 at −0.2, 0, 0.2, a sag of 20 mm.
    let poses = [-0.2, 0.0, 0.2].map(|x: f64| pose(x, 0.5 * x * x, 0.0, [0.0, 0.0, x]));
    for piece in through(&poses) {
        for k in 0..=20 {
            let point = piece.pose(piece.length() * f64::from(k) / 20.0).translation.vector;
            assert!((point.y - 0.5 * point.x * point.x).abs() < 0.01 * 0.02);
        }
    }
}

#[test]
fn symmetric_poses_give_a_symmetric_curve() {
    let mut random = Random(10);
    for _ in 0..50 {
        let poses = way(&mut random, 6);
        let backwards: Vec<Pose> = poses.iter().rev().copied().collect();
        for (piece, back) in through(&poses).iter().zip(through(&backwards).iter().rev()) {
            for k in 0..=10 {
                let s = piece.length() * f64::from(k) / 10.0;
                let (here, there) = (piece.pose(s), back.pose(back.length() - s));
                assert!((here.translation.vector - there.translation.vector).norm() < 1e-13);
                assert!(angle(&here.rotation, &there.rotation) < 1e-12);
            }
        }
    }
}

#[test]
fn points_of_a_circle_give_nearly_the_circle() {
    let radius = 0.1;
    for (count, distance, curvature) in [(8, 6e-5, 2e-3), (16, 1e-6, 2e-4)] {
        let at = |k: i32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            pose(radius * angle.cos(), radius * angle.sin(), 0.0, [0.0, 0.0, angle])
        };
        let poses: Vec<Pose> = (-1..=count + 1).map(at).collect();
        let pieces = through(&poses);
        let mut worst: (f64, f64, f64) = (0.0, 0.0, 0.0);
        for piece in &pieces[1..pieces.len() - 1] {
            for k in 0..=50 {
                let jet = piece.jet(piece.length() * f64::from(k) / 50.0);
                let point = jet.pose.translation.vector;
                // The torch turns with the circle: its x axis points outward.
                let outward = jet.pose.rotation * Vector3::x();
                worst.0 = worst.0.max((point.norm() / radius - 1.0).abs());
                worst.1 = worst.1.max((jet.linear[1].norm() * radius - 1.0).abs());
                worst.2 = worst.2.max(outward.cross(&point.normalize()).norm());
            }
        }
        assert!(worst.0 < distance && worst.1 < curvature && worst.2 < distance, "{worst:?}");
    }
}

#[test]
fn what_gives_no_spline_is_refused() {
    let at = |x: f64, y: f64| pose(x, y, 0.0, [0.0; 3]);
    let refused = |poses: &[Pose], count: usize| spline(poses, None, None, &mut vec_of(count)).unwrap_err();
    assert_eq!(refused(&[at(0.0, 0.0), at(1.0, 0.0)], 1), SplineError::TooFew);
    assert_eq!(refused(&[at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0)], 3), SplineError::Pieces);
    assert_eq!(refused(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.0)], 2), SplineError::Coincident(2));
    assert_eq!(refused(&[at(0.0, 0.0), at(1.0, 0.0), at(0.0, 0.1)], 2), SplineError::Reversal(1));
    assert_eq!(refused(&[at(0.0, 0.0), at(f64::NAN, 0.0), at(0.0, 0.1)], 2), SplineError::Coincident(1));
}
