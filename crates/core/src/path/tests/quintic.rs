//! Blends between two motions, and parts of paths.

use super::random::Random;
use super::*;

/// Angle between two orientations, exact for small ones.
fn angle(a: &PoseJet, b: &PoseJet) -> f64 {
    (a.pose.rotation * b.pose.rotation.inverse()).scaled_axis().norm()
}

/// The length by a way of its own: chords between points, extrapolated to infinitely many (Richardson).
fn length_by_sampling(path: &Path, cells: i32) -> f64 {
    let chords = |n: i32| -> f64 {
        let point = |k: i32| path.pose(path.length() * f64::from(k) / f64::from(n)).translation.vector;
        (0..n).map(|k| (point(k + 1) - point(k)).norm()).sum()
    };
    let sums = [1, 2, 4, 8].map(|factor| chords(cells * factor));
    let step =
        |order: i32, coarse: f64, fine: f64| fine + (fine - coarse) / (f64::from(1 << (2 * order)) - 1.0);
    let first = [step(1, sums[0], sums[1]), step(1, sums[1], sums[2]), step(1, sums[2], sums[3])];
    let second = [step(2, first[0], first[1]), step(2, first[1], first[2])];
    step(3, second[0], second[1])
}

/// Sixth-order central differences: of positions for the tangent, of each derivative for the next one.
fn assert_exact(path: &Path, s: f64, h: f64, tolerance: f64) {
    let jets = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0].map(|k| path.jet(s + k * h));
    let here = path.jet(s);
    let slope = |value: &dyn Fn(&PoseJet) -> Vector3| {
        let [a, b, c, d, e, f] = jets.map(|jet| value(&jet));
        ((d - c) * 45.0 - (e - b) * 9.0 + (f - a)) / (60.0 * h)
    };
    let close = |got: Vector3, expected: Vector3, what: &str| {
        let error = (got - expected).norm();
        assert!(error <= tolerance * (1.0 + got.norm()), "{what} at {s}: {error:e} of {}", got.norm());
    };
    close(here.linear[0], slope(&|jet| jet.pose.translation.vector), "tangent");
    for order in 0..2 {
        close(here.linear[order + 1], slope(&|jet| jet.linear[order]), "position");
        close(here.angular[order + 1], slope(&|jet| jet.angular[order]), "turn");
    }
    // ω from the rotations themselves: relative to the one here the rotation vector is ωh + O(h³).
    let vector = |jet: &PoseJet| (jet.pose.rotation * here.pose.rotation.inverse()).scaled_axis();
    close(here.angular[0], slope(&vector), "angular velocity");
    assert!((here.linear[0].norm() - 1.0).abs() < 1e-14, "the coordinate is arc length");
}

#[test]
fn a_blend_has_the_jets_of_both_ends() {
    let mut random = Random(1);
    for _ in 0..500 {
        let (before, after) = (random.arc(), random.arc());
        // Two arcs somewhere in space, the second carried to where it starts ahead of the first's end.
        let start = before.jet(before.length());
        let ahead = start.pose.translation.vector + start.linear[0] * 0.1 + random.vector(0.05);
        let mut end = after.jet(0.0);
        end.pose.translation.vector = ahead;
        let blend = Path::blend(&start, &end).unwrap();
        for (got, expected) in [(blend.jet(0.0), start), (blend.jet(blend.length()), end)] {
            assert!((got.pose.translation.vector - expected.pose.translation.vector).norm() < 1e-14);
            assert!(angle(&got, &expected) < 1e-13);
            for order in 0..2 {
                let size = expected.linear[order].norm() + expected.angular[order].norm();
                // Rounding of a polynomial over the length, derived.
                let size = size + blend.length().powi(-1 - order as i32);
                assert!((got.linear[order] - expected.linear[order]).norm() < 1e-12 * size);
                assert!((got.angular[order] - expected.angular[order]).norm() < 1e-12 * size);
            }
        }
    }
}

#[test]
fn a_blend_runs_by_arc_length_with_exact_derivatives() {
    let mut random = Random(2);
    for _ in 0..200 {
        let blend = random.blend();
        for k in 1..8 {
            let s = blend.length() * f64::from(k) / 8.0;
            // The sharper, the faster everything changes.
            let scale = 0.3 / blend.curve().greatest_curvature();
            let h = (0.02 * blend.length()).min(0.03 * scale);
            assert_exact(&blend, s, h, 1e-9 / (scale * scale).min(1.0));
        }
    }
}

#[test]
fn the_length_of_a_blend_is_that_of_its_chords() {
    let mut random = Random(3);
    for _ in 0..100 {
        let blend = random.blend();
        let expected = length_by_sampling(&blend, 256);
        let error = (blend.length() / expected - 1.0).abs();
        let sharpness = blend.curve().greatest_curvature() * blend.length();
        assert!(error < 1e-12 || sharpness > 50.0, "{error:e} with sharpness {sharpness}");
    }
}

#[test]
fn the_sharpest_tips_are_run_by_arc_length_too() {
    for degrees in [90.0_f64, 150.0, 170.0, 175.0, 176.9] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let corner = pose(0.0, 0.0, 0.0, [0.0; 3]);
        let before = Path::line(&pose(-0.1, 0.0, 0.0, [0.0; 3]), &corner);
        let after = Path::line(&corner, &pose(0.1 * cos, 0.1 * sin, 0.0, [0.0; 3]));
        let blend = Path::blend(&before.jet(0.05), &after.jet(0.05)).unwrap();
        let tip = 1.0 / blend.curve().greatest_curvature();
        let point = |s: f64| blend.pose(s).translation.vector;
        for k in -400..=400 {
            // Dense about the tip, out to both ends.
            let share = f64::from(k) / 400.5;
            let s = blend.length() * (0.5 + 0.5 * share * share * share);
            let h =
                (0.005 * tip.hypot(s - 0.5 * blend.length())).min(0.01 * s).min(0.01 * (blend.length() - s));
            let chord = |n: f64| (point(s + n * h) - point(s - n * h)) / (2.0 * n * h);
            let tangent = chord(1.0) * 1.5 - chord(2.0) * 0.6 + chord(3.0) * 0.1;
            let error = (tangent - blend.jet(s).linear[0]).norm();
            assert!(error < 1e-9 + 1e-16 / h, "{error:e} at {share} of {degrees} degrees");
        }
    }
}

#[test]
fn a_blend_of_a_straight_continuation_is_straight() {
    let (start, end) = (pose(0.0, 0.0, 0.0, [0.0; 3]), pose(1.0, 0.0, 0.0, [0.5, 0.0, 0.0]));
    let line = Path::line(&start, &end);
    let blend = Path::blend(&line.jet(0.4), &line.jet(0.6)).unwrap();
    assert!((blend.length() - 0.2).abs() < 1e-15);
    for k in 0..=10 {
        let (jet, expected) = (blend.jet(0.02 * f64::from(k)), line.jet(0.4 + 0.02 * f64::from(k)));
        assert!((jet.pose.translation.vector - expected.pose.translation.vector).norm() < 1e-14);
        assert!(angle(&jet, &expected) < 1e-14);
        assert!(jet.linear[1].norm() < 1e-12 && jet.angular[1].norm() < 1e-12);
    }
}

#[test]
fn ends_without_a_blend_are_refused() {
    let line = Path::line(&pose(0.0, 0.0, 0.0, [0.0; 3]), &pose(1.0, 0.0, 0.0, [0.0; 3]));
    assert_eq!(Path::blend(&line.jet(0.5), &line.jet(0.5)), Err(BlendError::Coincident));
    let turn = Path::line(&pose(1.0, 0.0, 0.0, [0.0; 3]), &pose(1.0, 0.0, 0.0, [0.3, 0.0, 0.0]));
    assert_eq!(Path::blend(&line.jet(0.5), &turn.jet(0.0)), Err(BlendError::AtRest));
}

#[test]
fn a_part_has_the_same_jets() {
    let mut random = Random(4);
    for round in 0..400 {
        let path = match round % 4 {
            0 => random.line(),
            1 => random.arc(),
            2 => random.blend(),
            _ => Path::line(&pose(0.1, 0.2, 0.3, [0.0; 3]), &pose(0.1, 0.2, 0.3, [0.5, 0.1, 1.0])),
        };
        let from = path.length() * random.within(0.0, 0.6);
        let to = from + (path.length() - from) * random.within(0.1, 1.0);
        let part = path.part(from, to);
        // A part of a part is a part.
        let inner = part.part(0.25 * part.length(), part.length());
        assert!((part.length() - (to - from)).abs() < 1e-15);
        for k in 0..=10 {
            let s = part.length() * f64::from(k) / 10.0;
            assert_same(&part.jet(s), &path.jet(from + s));
            let s = inner.length() * f64::from(k) / 10.0;
            assert_same(&inner.jet(s), &part.jet(0.25 * part.length() + s));
        }
    }
}

fn assert_same(a: &PoseJet, b: &PoseJet) {
    assert!((a.pose.translation.vector - b.pose.translation.vector).norm() < 2e-15);
    assert!((a.pose.rotation.coords - b.pose.rotation.coords).norm() < 2e-15);
    for order in 0..3 {
        let size = 1.0 + b.linear[order].norm() + b.angular[order].norm();
        assert!((a.linear[order] - b.linear[order]).norm() < 1e-11 * size, "order {order}");
        assert!((a.angular[order] - b.angular[order]).norm() < 1e-11 * size, "order {order}");
    }
}

#[test]
fn the_nearest_point_of_a_blend_is_found() {
    let mut random = Random(5);
    for _ in 0..200 {
        let blend = random.blend();
        let Curve::Quintic(curve) = blend.curve() else { panic!("a blend is polynomial") };
        let s = blend.length() * random.within(0.05, 0.95);
        let jet = blend.jet(s);
        let aside = jet.linear[0].cross(&random.vector(1.0)).normalize();
        // Closer than the radius of curvature, so that the foot is the nearest point.
        let offset = 0.1 / (curve.greatest_curvature() + 10.0 / blend.length());
        let (found, distance) = curve.nearest(&(jet.pose.translation.vector + aside * offset));
        assert!((found - s).abs() < 1e-10 && (distance - offset).abs() < 1e-12);
    }
}
