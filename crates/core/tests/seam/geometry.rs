//! The path frame, the motion with an offset in it, and what makes a chain or a sensor acceptable.

use seamline::geometry::{Pose, PoseJet, Vector3};
use seamline::path::{Path, SeamFrame};
use seamline::seam::{
    ChainError, Filter, LaneJet, Offset, PathChain, Sensor, Settings, SettingsError, TaughtPath, corrected,
    speed_factor,
};

use crate::paths::{arc, curve, line};
use crate::simulation::{Laser, sensor};

const MM: f64 = 1e-3;

/// An offset with all derivatives, along a path in metres.
fn lane(s: f64) -> LaneJet {
    let (a, b) = (40.0 * s, 25.0 * s + 1.0);
    let jet = |d: [f64; 2]| Offset::new(d[0], d[1]) * (4.0 * MM);
    LaneJet {
        offset: jet([a.sin(), b.sin()]),
        derivatives: [
            jet([40.0 * a.cos(), 25.0 * b.cos()]),
            jet([-1600.0 * a.sin(), -625.0 * b.sin()]),
            jet([-64_000.0 * a.cos(), -15_625.0 * b.cos()]),
        ],
    }
}

/// Derivatives of the corrected position by differences of itself.
fn differences(path: &impl TaughtPath, s: f64) -> [Vector3; 3] {
    let h = 0.5 * MM;
    let at = |k: f64| {
        let jet = path.jet(s + k * h);
        let frame = SeamFrame::of(&jet).unwrap();
        let offset = lane(s + k * h).offset;
        jet.pose.translation.vector + frame.y * offset.x + frame.z * offset.y
    };
    let p = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(at);
    [
        ((p[4] - p[2]) * 45.0 - (p[5] - p[1]) * 9.0 + (p[6] - p[0])) / (60.0 * h),
        ((p[4] + p[2]) * 270.0 - (p[5] + p[1]) * 27.0 + (p[6] + p[0]) * 2.0 - p[3] * 490.0) / (180.0 * h * h),
        ((p[2] - p[4]) * 13.0 + (p[5] - p[1]) * 8.0 + (p[0] - p[6])) / (8.0 * h * h * h),
    ]
}

fn errors(path: &impl TaughtPath, s: f64) -> [f64; 3] {
    let jet: PoseJet = corrected(&path.jet(s), &lane(s)).unwrap();
    let expected = differences(path, s);
    core::array::from_fn(|order| (jet.linear[order] - expected[order]).norm() / expected[order].norm())
}

#[test]
fn the_corrected_motion_has_its_own_derivatives() {
    for s in [0.03, 0.1, 0.21] {
        for [first, second, third] in [errors(&line(0.3, 0.6, 0.2), s), errors(&arc(0.1, 0.3, 0.6, 0.2), s)] {
            assert!(first < 1e-9 && second < 1e-7 && third < 1e-3, "{s}: {first} {second} {third}");
        }
        // On a curve whose curvature changes, the third one is near.
        let [first, second, third] = errors(&curve(), s);
        assert!(first < 1e-8 && second < 1e-6 && third < 0.02, "{s}: {first} {second} {third}");
    }
}

#[test]
fn the_speed_factor_is_the_length_of_the_first_derivative() {
    let path = arc(0.1, 0.3, 0.6, 0.2);
    let factor = |s: f64| speed_factor(&corrected(&path.jet(s), &lane(s)).unwrap());
    let (s, h) = (0.12, 1e-5);
    let (value, slope) = factor(s);
    assert!((value - differences(&path, s)[0].norm()).abs() < 1e-9);
    assert!((slope - (factor(s + h).0 - factor(s - h).0) / (2.0 * h)).abs() < 1e-6 * slope.abs());
}

/// Along x with the wire down: y is to the left, z is up. Along the wire there is no frame.
#[test]
fn the_frame_is_that_of_a_welder() {
    let down = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let at = |x: f64, z: f64| Pose::from_parts(Vector3::new(x, 0.0, z).into(), down);
    let frame = SeamFrame::of(&Path::line(&at(0.0, 0.0), &at(1.0, 0.0)).jet(0.5)).unwrap();
    assert!((frame.y - Vector3::y()).norm() < 1e-12 && (frame.z - Vector3::z()).norm() < 1e-12);
    assert_eq!(SeamFrame::of(&Path::line(&at(0.0, 0.0), &at(0.01, 1.0)).jet(0.5)), None);
    assert_eq!(Sensor::mounting(&Path::line(&at(0.0, 0.0), &at(0.0, 1.0)).jet(0.5), 0.03), None);
}

#[test]
fn a_chain_goes_on_smoothly_or_not_at_all() {
    let (whole, more) = (line(0.3, 0.6, 0.2), arc(0.1, 0.2, 0.6, 0.2));
    let mut chain = PathChain::<2>::new(0.5);
    assert_eq!(chain.span(), (0.5, 0.5));
    chain.push(&whole.part(0.0, 0.1)).unwrap();
    assert!(
        matches!(chain.push(&whole), Err(ChainError::Apart { distance }) if (distance - 0.1).abs() < 1e-9)
    );
    let end = whole.pose(0.1);
    let aside = Pose::from_parts(
        (end.translation.vector + SeamFrame::of(&whole.jet(0.1)).unwrap().y * 0.1).into(),
        end.rotation,
    );
    assert!(matches!(chain.push(&Path::line(&end, &aside)), Err(ChainError::Kink { angle }) if angle > 1.5));
    assert_eq!(chain.push(&more.part(0.1, 0.1)), Err(ChainError::NoLength));
    chain.push(&whole.part(0.1, 0.3)).unwrap();
    assert_eq!(chain.push(&more), Err(ChainError::Full { room: 2 }));
    assert!((chain.jet(0.65).pose.translation.vector - whole.pose(0.15).translation.vector).norm() < 1e-12);
    chain.drop_before(0.65);
    let (first, last) = chain.span();
    assert!((first - 0.6).abs() < 1e-12 && (last - 0.8).abs() < 1e-12);
    chain.drop_before(5.0);
    assert_eq!(chain.span(), (first, last));
}

#[test]
fn a_sensor_that_looks_too_short_is_refused_with_what_would_do() {
    let path = line(0.3, 0.6, 0.2);
    let with = |look_ahead: f64, speed: f64| {
        Settings::new(sensor(&path, &Laser { look_ahead, ..Laser::USUAL }), speed)
    };
    let budget = with(30.0 * MM, 20.0 * MM).check().unwrap();
    assert!((budget.left() - 16.6 * MM).abs() < 1e-9, "{budget:?}");
    let Err(SettingsError::LookAhead { needed, has, speed }) = with(20.0 * MM, 100.0 * MM).check() else {
        panic!("20 mm do not suffice at 100 mm/s")
    };
    assert!(needed > has && (has - 20.0 * MM).abs() < 1e-9);
    assert!(with(20.0 * MM, speed).check().is_ok(), "{speed}");
    assert!(with(20.0 * MM, speed + 2.0 * MM).check().is_err(), "{speed}");

    let good = with(30.0 * MM, 20.0 * MM);
    let bad = [
        Settings { speed: f64::NAN, ..good },
        Settings { speed: 0.0, ..good },
        Settings { jerk: -1.0, ..good },
        Settings { curvature: f64::INFINITY, ..good },
        Settings { curvature: 150.0, ..good },
        Settings { filter: Filter::Mean { readings: 0 }, ..good },
        Settings { filter: Filter::Mean { readings: 33 }, ..good },
    ];
    for settings in bad {
        let error = settings.check().expect_err("refused");
        assert!(!error.to_string().is_empty());
    }
}
