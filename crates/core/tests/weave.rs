//! Weaves against differences, bounds and their own description; the displaced tool against differences.

#![allow(clippy::unwrap_used, reason = "a failing test panics")]

use seamline::geometry::{Pose, Vector3};
use seamline::math::taylor::Taylor;
use seamline::path::{Path, SeamFrame, displaced};
use seamline::weave::{Pattern, Weave, WeaveError, WeaveShape};

const PLAIN: WeaveShape = WeaveShape {
    pattern: Pattern::Sine,
    amplitude: 2e-3,
    wavelength: 4e-3,
    dwells: [0.0; 3],
    tilt: 0.0,
    elevation: 0.0,
    right_first: false,
};

/// All patterns, with and without dwells, tilt, elevation.
fn shapes() -> Vec<WeaveShape> {
    let mut shapes = Vec::new();
    for pattern in [Pattern::Sine, Pattern::Triangle, Pattern::FigureEight, Pattern::Circular] {
        for (tilt, elevation, right_first) in [(0.0, 0.0, false), (0.3, 1e-3, true)] {
            shapes.push(WeaveShape { pattern, tilt, elevation, right_first, ..PLAIN });
        }
    }
    for pattern in [Pattern::Sine, Pattern::Triangle] {
        for dwells in [[0.1, 0.0, 0.2], [0.05, 0.1, 0.05], [0.0, 0.2, 0.0]] {
            shapes.push(WeaveShape { pattern, dwells, ..PLAIN });
        }
    }
    shapes
}

fn weave(shape: &WeaveShape) -> Weave {
    Weave::try_new(shape, 0.01, 0.09).unwrap()
}

fn values(offset: [Taylor; 3]) -> Vector3 {
    Vector3::from_fn(|axis, _| offset[axis].value())
}

fn derivative(offset: [Taylor; 3], order: usize) -> Vector3 {
    Vector3::from_fn(|axis, _| offset[axis].derivatives()[order])
}

/// Each derivative is the slope of the one before, at 20,000 places of each weave; the third only where it does not step.
#[test]
fn derivatives_are_those_of_the_offset() {
    for shape in shapes() {
        let weave = weave(&shape);
        let h = 1e-8;
        for k in 0..20_000 {
            let s = 0.005 + 0.09 * f64::from(k) / 20_000.0;
            let (before, here, after) = (weave.offset(s - h), weave.offset(s), weave.offset(s + h));
            let slope = (values(after) - values(before)) / (2.0 * h);
            assert!((slope - derivative(here, 0)).norm() < 1e-5, "{shape:?} at {s}");
            let slope = (derivative(after, 0) - derivative(before, 0)) / (2.0 * h);
            let step = (derivative(after, 2) - derivative(before, 2)).norm();
            assert!((slope - derivative(here, 1)).norm() < 0.5 + h * step, "{shape:?} at {s}");
            let slope = (derivative(after, 1) - derivative(before, 1)) / (2.0 * h);
            assert!(step > 1e4 || (slope - derivative(here, 2)).norm() < 100.0, "{shape:?} at {s}");
        }
    }
}

/// The peaks bound velocity, acceleration and jerk, ramps included; but for what these may add, sines and swings reach them.
#[test]
fn peaks_are_bounds_and_are_reached() {
    let long = |shape: WeaveShape| (shape, 0.09);
    let short = |shape: WeaveShape| (shape, 0.015);
    for (shape, to) in shapes().into_iter().flat_map(|shape| [long(shape), short(shape)]) {
        let (weave, speed) = (Weave::try_new(&shape, 0.01, to).unwrap(), 0.012);
        let peaks = weave.peaks(speed, 0.0);
        let mut seen = [0.0_f64; 3];
        for k in 0..200_000 {
            let offset = weave.offset(0.1 * f64::from(k) / 200_000.0);
            for (order, seen) in seen.iter_mut().enumerate() {
                *seen = seen.max(derivative(offset, order).norm() * speed.powi(order as i32 + 1));
            }
        }
        let bounds = [peaks.velocity, peaks.acceleration, peaks.jerk];
        for (seen, bound) in seen.iter().zip(bounds) {
            assert!(*seen <= bound * (1.0 + 1e-9), "{shape:?}: {seen} > {bound}");
            let exact = to > 0.05 && shape.elevation == 0.0 && shape.pattern != Pattern::FigureEight;
            assert!(!exact || *seen >= bound * 0.9, "{shape:?}: {seen} far below {bound}");
        }
    }
}

/// On arcs of small radius, to either side and with the tool turning, what the weave adds to the seam's motion stays within the peaks of that
/// turn; a circle that turns with the arc passes those of a straight seam.
#[test]
fn peaks_take_the_bend_into_account() {
    let (speed, mut beyond) = (0.02_f64, 0);
    for shape in shapes() {
        for (side, turn) in [(1.0, 0.0), (-1.0, 0.0), (1.0, 0.8), (-1.0, -0.8)] {
            let at = |angle: f64| {
                let (sin, cos) = angle.sin_cos();
                Pose::new(
                    Vector3::new(5e-3 * sin, side * 5e-3 * (1.0 - cos), 0.3),
                    Vector3::new(std::f64::consts::PI, turn * angle, 0.0),
                )
            };
            let path = Path::arc(&at(0.0), &at(2.0), &at(4.0)).unwrap();
            let weave = Weave::try_new(&shape, 0.0, path.length()).unwrap();
            let woven = path.woven(&weave, 0.0);
            let (mut seen, mut rate) = ([0.0_f64; 3], 0.0_f64);
            for k in 0..=4_000 {
                let s = path.length() * f64::from(k) / 4_000.0;
                let (woven, seam) = (woven.jet(s), path.jet(s));
                rate = rate.max(SeamFrame::turn_rate(&seam).unwrap());
                for (order, seen) in seen.iter_mut().enumerate() {
                    let added = (woven.linear[order] - seam.linear[order]).norm();
                    *seen = seen.max(added * speed.powi(order as i32 + 1));
                }
            }
            assert!(turn != 0.0 || (rate - 200.0).abs() < 1e-6, "{rate}");
            let of = |rate: f64| {
                let peaks = weave.peaks(speed, rate);
                [peaks.velocity, peaks.acceleration, peaks.jerk]
            };
            let (straight, turning) = (of(0.0), of(rate));
            for order in 0..3 {
                assert!(seen[order] <= turning[order], "{shape:?}, {side}, {turn}: order {order}");
                beyond += usize::from(seen[order] > straight[order]);
            }
        }
    }
    assert!(beyond >= 6, "{beyond}");
}

#[test]
fn a_sine_asks_for_the_jerk_of_a_sine() {
    // 2 mm at 3 Hz.
    let peaks = weave(&PLAIN).peaks(0.012, 0.0);
    let omega = std::f64::consts::TAU * 3.0;
    assert!((peaks.jerk - 1.1 * 2e-3 * omega.powi(3)).abs() < 1e-9);
}

/// The torch is at each edge for its share of the period, and nowhere beyond.
#[test]
fn dwells_hold_the_edges_and_the_middle() {
    for dwells in [[0.1, 0.0, 0.2], [0.05, 0.1, 0.15]] {
        let shape = WeaveShape { dwells, pattern: Pattern::Triangle, ..PLAIN };
        let weave = weave(&shape);
        let (from, periods) = (0.03, 5.0);
        let count = 100_000;
        let at = |k: i32| from + periods * shape.wavelength * f64::from(k) / f64::from(count);
        let place = |k: i32| weave.offset(at(k))[1].value() / shape.amplitude;
        let share = |hold: f64| {
            let held = (0..count).filter(|k| (place(*k) - hold).abs() < 1e-12).count();
            held as f64 / f64::from(count)
        };
        for (hold, expected) in [(1.0, dwells[0]), (0.0, 2.0 * dwells[1]), (-1.0, dwells[2])] {
            assert!((share(hold) - expected).abs() < 1e-3, "{dwells:?} at {hold}: {}", share(hold));
        }
        assert!((0..count).all(|k| place(k).abs() <= 1.0 + 1e-12));
    }
}

#[test]
fn it_swings_in_to_the_side_named_and_out_again() {
    for right_first in [false, true] {
        let weave = weave(&WeaveShape { right_first, ..PLAIN });
        let side = if right_first { -1.0 } else { 1.0 };
        assert!(weave.offset(0.01 + 1e-3)[1].value() * side > 0.0, "first swing");
        for s in [0.0, 0.01, 0.09, 0.1] {
            assert_eq!(values(weave.offset(s)), Vector3::zeros());
        }
        let edges = [0.01 + 1e-9, 0.09 - 1e-9].map(|s| weave.offset(s));
        assert!(edges.iter().all(|edge| derivative(*edge, 1).norm() < 1e-3), "it starts and ends smoothly");
    }
    // Shorter than its two ramps.
    let short = Weave::try_new(&PLAIN, 0.0, 0.004).unwrap();
    let greatest = (0..400).map(|k| values(short.offset(f64::from(k) * 1e-5)).norm()).fold(0.0, f64::max);
    assert!(greatest < 0.05e-3 && greatest > 0.01e-3, "{greatest}");
}

#[test]
fn what_is_no_weave_is_named() {
    let refused = |shape: WeaveShape| Weave::try_new(&shape, 0.0, 1.0).unwrap_err();
    assert_eq!(refused(WeaveShape { amplitude: -1.0, ..PLAIN }), WeaveError::Amplitude { value: -1.0 });
    assert_eq!(refused(WeaveShape { wavelength: 0.0, ..PLAIN }), WeaveError::Wavelength { value: 0.0 });
    assert!(matches!(refused(WeaveShape { wavelength: f64::NAN, ..PLAIN }), WeaveError::Wavelength { .. }));
    assert_eq!(refused(WeaveShape { dwells: [0.5, 0.1, 0.3], ..PLAIN }), WeaveError::Dwells { share: 1.0 });
    let circle = WeaveShape { pattern: Pattern::Circular, dwells: [0.1, 0.0, 0.0], ..PLAIN };
    assert_eq!(refused(circle), WeaveError::NoDwells);
    assert_eq!(refused(WeaveShape { tilt: f64::INFINITY, ..PLAIN }), WeaveError::NotFinite);
    assert_eq!(Weave::try_new(&PLAIN, 1.0, 0.0), Err(WeaveError::Part { from: 1.0, to: 0.0 }));
}

fn turning_line() -> Path {
    let start = Pose::new(Vector3::new(0.8, 0.1, 0.2), Vector3::new(3.0, 0.1, -0.2));
    let end = Pose::new(Vector3::new(0.9, 0.3, 0.15), Vector3::new(2.7, 0.3, 0.1));
    Path::line(&start, &end)
}

fn turning_arc() -> Path {
    let pose = |x: f64, y: f64, turn: f64| Pose::new(Vector3::new(x, y, 0.1), Vector3::new(3.0, turn, 0.1));
    Path::arc(&pose(0.9, 0.0, 0.0), &pose(0.93, 0.03, 0.2), &pose(0.9, 0.06, 0.35)).unwrap()
}

/// The woven tool's derivatives against differences of its place, 1,000 places each of a line and an arc with turning wire.
#[test]
fn a_displaced_tool_moves_as_its_derivatives_say() {
    let shape = WeaveShape { pattern: Pattern::FigureEight, tilt: 0.2, wavelength: 0.03, ..PLAIN };
    for seam in [turning_line(), turning_arc()] {
        let path = seam.woven(&Weave::try_new(&shape, -1.0, 1.0).unwrap(), 0.0);
        let place = |s: f64| path.pose(s).translation.vector;
        for k in 1..1_000 {
            let s = 0.01 + (path.length() - 0.02) * f64::from(k) / 1_000.0;
            let h = 1e-4;
            let p = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| place(s + k * h));
            let d1 = (p[0] - p[1] * 8.0 + p[3] * 8.0 - p[4]) / (12.0 * h);
            let d2 = (-p[0] + p[1] * 16.0 - p[2] * 30.0 + p[3] * 16.0 - p[4]) / (12.0 * h * h);
            let d3 = (-p[0] + p[1] * 2.0 - p[3] * 2.0 + p[4]) / (2.0 * h * h * h);
            let [l1, l2, l3] = path.jet(s).linear;
            assert!((d1 - l1).norm() < 1e-4, "1: {} at {s}", (d1 - l1).norm());
            assert!((d2 - l2).norm() < 0.01 * (1.0 + l2.norm()), "2: {} at {s}", (d2 - l2).norm());
            assert!(
                (d3 - l3).norm() < 0.02 * (100.0 + l3.norm()),
                "{} of {} at {s}",
                (d3 - l3).norm(),
                l3.norm()
            );
        }
    }
}

/// A tool moved to the left on a circle that turns left runs on a smaller circle, and the frame looks that way.
#[test]
fn left_is_left() {
    let arc = turning_arc();
    let jet = arc.jet(0.01);
    let frame = SeamFrame::of(&jet).unwrap();
    assert!(frame.z.z > 0.9, "out of the workpiece, with the wire pointing down");
    assert!(frame.y.dot(&jet.linear[1]) > 0.0, "the centre lies on the left");
    let offset = [0.0, 5e-3, 0.0].map(Taylor::constant);
    let moved = displaced(&jet, &offset);
    assert!(moved.linear[0].norm() < 1.0);
    let expected = jet.pose.translation.vector + frame.vector([0.0, 5e-3, 0.0]);
    assert!((moved.pose.translation.vector - expected).norm() < 1e-15);
}

/// A wire along the travel has no side: the seam itself is followed.
#[test]
fn without_a_frame_nothing_is_displaced() {
    let pose =
        |x: f64| Pose::new(Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0));
    let jet = Path::line(&pose(0.0), &pose(0.1)).jet(0.05);
    assert!(SeamFrame::of(&jet).is_none());
    assert_eq!(displaced(&jet, &[Taylor::constant(1e-3); 3]), jet);
}
