//! The closed-form six-axis arm: model, forward, all branches, limits, turns and singular poses.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::support::{Random, joint_error, joint_error_modulo_turns, pose_error};
use seamline::geometry::{EulerZyx, Pose, Rotation, Vector3};
use seamline::kinematics::{
    Configuration, Elbow, InverseError, JointLimits, Kinematics, OpwParameters, Shoulder, SphericalWristArm,
    Wrist, models,
};

/// Arms that differ in everything the closed form knows: offsets of either sign, a lateral offset, equal links.
fn arms() -> Vec<(&'static str, SphericalWristArm)> {
    let lateral = OpwParameters {
        a1: 0.2,
        a2: 0.05,
        b: -0.13,
        c1: 0.4,
        c2: 0.6,
        c3: 0.7,
        c4: 0.12,
        offsets: [0.3, -FRAC_PI_2, 0.4, 0.1, -0.2, PI],
        signs: [-1.0, 1.0, -1.0, 1.0, -1.0, 1.0],
    };
    let equal = OpwParameters {
        a1: 0.0,
        a2: 0.0,
        b: 0.0,
        c1: 0.3,
        c2: 0.5,
        c3: 0.5,
        c4: 0.1,
        offsets: [0.0; 6],
        signs: [1.0; 6],
    };
    let arm = |p: OpwParameters| SphericalWristArm::try_new(p.geometry(), JointLimits::unlimited()).unwrap();
    let mut tilted = models::ar2010().geometry().to_owned();
    tilted.base_from_shoulder = Pose::new(Vector3::new(0.3, -2.0, 0.7), Vector3::new(0.4, -1.1, 2.0));
    tilted.wrist_from_flange = Pose::new(Vector3::new(-0.04, 0.02, 0.3), Vector3::new(1.0, 0.3, -0.5));
    vec![
        ("ar2010", models::ar2010()),
        ("irb2400", models::irb2400()),
        ("lateral offset", arm(lateral)),
        ("equal links", arm(equal)),
        ("tilted", SphericalWristArm::try_new(tilted, JointLimits::unlimited()).unwrap()),
    ]
}

/// The limits, or a turn and a quarter either way where there are none.
fn range(arm: &SphericalWristArm) -> [(f64, f64); 6] {
    arm.position_limits().map(|(min, max)| (min.max(-2.5 * PI), max.min(2.5 * PI)))
}

fn degrees(q: [f64; 6]) -> [f64; 6] {
    q.map(f64::to_radians)
}

#[test]
fn ar2010_stands_at_zero_as_the_maker_has_it() {
    let arm = models::ar2010();
    let pose = arm.forward(&[0.0; 6]);
    assert!((pose.translation.vector - Vector3::new(1.332, 0.0, 0.960)).norm() < 1e-15);
    let maker = EulerZyx { x: PI, y: -FRAC_PI_2, z: 0.0 }.to_rotation();
    assert!(pose_error(&pose, &Pose::from_parts(pose.translation, maker)).1 < 1e-15);
    assert!((pose.rotation * Vector3::z() - Vector3::x()).norm() < 1e-15);
    assert!((pose.rotation * Vector3::x() - Vector3::z()).norm() < 1e-15);
    assert_eq!(arm.position_limits()[4], ((-135.0_f64).to_radians(), 90.0_f64.to_radians()));
    assert_eq!(arm.velocity_limits()[5], 700.0_f64.to_radians());
}

/// Each joint turns the flange about the axis that the specification gives, through the point that the dimensions
/// give: a product of exponentials that shares nothing with the closed form.
#[test]
fn ar2010_turns_about_its_axes() {
    let axes = [Vector3::z(), Vector3::y(), -Vector3::y(), -Vector3::x(), -Vector3::y(), -Vector3::x()];
    let points = [
        Vector3::zeros(),
        Vector3::new(0.150, 0.0, 0.0),
        Vector3::new(0.150, 0.0, 0.760),
        Vector3::new(0.150, 0.0, 0.960),
        Vector3::new(1.232, 0.0, 0.960),
        Vector3::new(1.332, 0.0, 0.960),
    ];
    let arm = models::ar2010();
    let at_zero = arm.forward(&[0.0; 6]);
    let mut random = Random::new(1);
    for _ in 0..2_000 {
        let q = random.joints(&range(&arm));
        let mut expected = Pose::identity();
        for ((axis, point), angle) in axes.iter().zip(&points).zip(&q) {
            let turn = Rotation::from_scaled_axis(axis * *angle);
            expected *= Pose::from_parts((point - turn * point).into(), turn);
        }
        let (distance, angle) = pose_error(&arm.forward(&q), &(expected * at_zero));
        assert!(distance < 1e-14 && angle < 1e-14, "{q:?}: {distance:e} {angle:e}");
    }
}

/// 20,000 random joint positions for each of five arms: the branch they came from is found, every branch reaches the
/// pose to 1e-13 m and 1e-13 rad, no two agree, and each has the posture it says.
#[test]
fn every_branch_reaches_the_pose() {
    let mut random = Random::new(2);
    for (name, arm) in arms() {
        let (mut worst_distance, mut worst_angle) = (0.0_f64, 0.0_f64);
        for _ in 0..20_000 {
            let q = random.joints(&range(&arm));
            let pose = arm.forward(&q);
            let solutions = arm.inverse(&pose, &q).unwrap();
            let branches = solutions.as_slice();
            assert!(branches.len() >= 4 && branches.len() % 2 == 0, "{name} {q:?}: {branches:?}");
            for branch in branches {
                let (distance, angle) = pose_error(&arm.forward(&branch.q), &pose);
                worst_distance = worst_distance.max(distance);
                worst_angle = worst_angle.max(angle);
                assert_eq!(arm.posture(&branch.q), branch.posture, "{name} {q:?}");
                let others = branches.iter().filter(|other| other.posture == branch.posture);
                assert_eq!(others.count(), 1);
            }
            let own = branches.iter().find(|s| s.posture == arm.posture(&q)).unwrap();
            assert!(joint_error_modulo_turns(&own.q, &q) < 1e-7, "{name} {q:?} {own:?}");
        }
        assert!(worst_distance < 1e-13 && worst_angle < 1e-13, "{name}: {worst_distance:e} {worst_angle:e}");
    }
}

/// 20,000 random joint positions for each of five arms, seeded beside themselves: nearest gives them back.
#[test]
fn nearest_returns_to_the_seed() {
    let mut random = Random::new(3);
    for (name, arm) in arms() {
        for _ in 0..20_000 {
            let q = random.joints(&range(&arm));
            let seed = q.map(|angle| angle + random.uniform(-1e-3, 1e-3));
            let found = arm.inverse_nearest(&arm.forward(&q), &seed).unwrap();
            // Beside a singularity another branch may be as near to the seed.
            let offset = joint_error(&q, &seed);
            assert!(joint_error(&found, &seed) < 3.0 * offset + 1e-7, "{name} {q:?} {found:?}");
        }
    }
}

/// 5,000 poses: nearest is the least over all branches and all turns within the limits, found by trying every turn.
#[test]
fn nearest_is_the_least_of_all_branches_and_turns() {
    let arm = models::irb2400();
    let limits = arm.position_limits();
    let mut random = Random::new(4);
    for _ in 0..5_000 {
        let (pose, seed) = (arm.forward(&random.joints(limits)), random.joints(limits));
        let distance = |q: &[f64; 6]| q.iter().zip(&seed).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let mut least = f64::INFINITY;
        for solution in arm.inverse(&pose, &seed).unwrap().as_slice() {
            for code in 0..3_usize.pow(6) {
                let turns: [f64; 6] =
                    std::array::from_fn(|i| TAU * ((code / 3_usize.pow(i as u32) % 3) as f64 - 1.0));
                let q: [f64; 6] = std::array::from_fn(|i| solution.q[i] + turns[i]);
                if q.iter().zip(limits).all(|(angle, (min, max))| angle >= min && angle <= max) {
                    least = least.min(distance(&q));
                }
            }
        }
        let found = arm.inverse_nearest(&pose, &seed).unwrap();
        assert!((distance(&found) - least).abs() < 1e-9, "{} {least}", distance(&found));
    }
}

/// Offsets from each singularity, from 0.1 down to nothing: the pose is met, the joint that is free stays at the
/// seed, nothing is lost.
#[test]
fn singular_and_near_singular_poses() {
    let mut offsets = vec![0.0];
    for exponent in 1..=16 {
        let offset = 10.0_f64.powi(-exponent);
        offsets.extend([offset, -offset]);
    }
    for (name, arm) in arms() {
        let g = arm.geometry();
        let elbow = g.elbow_offset.atan2(g.forearm);
        // Joint positions for given θ.
        let joints = |theta: [f64; 6]| std::array::from_fn(|i| g.signs[i] * (theta[i] - g.zeros[i]));
        // θ₂ that brings the wrist centre onto axis 1, by bisection on its radius.
        let shoulder2 = {
            let out = |t2: f64| {
                g.shoulder_offset + g.upper_arm * t2.sin() + arm.elbow_to_wrist() * (t2 + 0.9).sin()
            };
            let (mut low, mut high) = (-2.0, 0.0);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if out(middle) < 0.0 { low = middle } else { high = middle }
            }
            low
        };
        for &offset in &offsets {
            let cases = [
                ("wrist", joints([0.3, 0.2, 0.9, 1.1, offset, -0.4])),
                ("wrist half turn", joints([0.3, 0.2, 0.9, 1.1, PI + offset, -0.4])),
                ("elbow stretched", joints([0.3, 0.5, -elbow + offset, 1.1, 0.7, -0.4])),
                ("elbow folded", joints([0.3, 0.5, PI - elbow + offset, 1.1, 0.7, -0.4])),
                ("shoulder", joints([0.3, shoulder2 + offset, 0.9 - elbow, 1.1, 0.7, -0.4])),
                ("wrist and elbow", joints([0.3, 0.5, -elbow + offset, 1.1, offset, -0.4])),
                (
                    "wrist and shoulder",
                    joints([0.3, shoulder2 + offset, 0.9 - elbow, 1.1, 0.3 * offset, -0.4]),
                ),
            ];
            let unlimited = SphericalWristArm::try_new(*g, JointLimits::unlimited()).unwrap();
            for (singularity, q) in cases {
                let pose = unlimited.forward(&q);
                let found = unlimited.inverse_nearest(&pose, &q).unwrap();
                let (distance, angle) = pose_error(&unlimited.forward(&found), &pose);
                let place = format!("{name}, {singularity} {offset:e}: {distance:e} m {angle:e} rad");
                assert!(distance < 1.5e-13 && angle < 3e-13, "{place}");
                let solutions = unlimited.inverse(&pose, &q).unwrap();
                assert!(!solutions.as_slice().is_empty(), "{place}");
                for solution in solutions.as_slice() {
                    let (distance, angle) = pose_error(&unlimited.forward(&solution.q), &pose);
                    assert!(distance < 1.5e-13 && angle < 3e-13, "{place}");
                }
                // Rounding moves joints by its square root at the elbow, by its quotient with the offset at wrist and
                // shoulder until the joint counts as free; at two singularities at once the pose alone counts.
                let rounding = 1e-6 + if offset == 0.0 { 0.0 } else { 4e-15 / offset.abs() };
                let moved = joint_error(&found, &q);
                let alone = !singularity.contains("and");
                assert!(!alone || moved < rounding + 4.0 * offset.abs(), "{place} {found:?}");
                if offset == 0.0 && alone && singularity.starts_with("wrist") {
                    assert!((found[3] - q[3]).abs() < 1e-15, "{place}: joint 4 is kept");
                }
            }
        }
    }
}

#[test]
fn at_the_wrist_pole_joint_four_gives_way_to_joint_six() {
    let mut limits = [(-PI, PI); 6];
    limits[5] = (-0.5, 0.5);
    let geometry = *models::ar2010().geometry();
    let arm = SphericalWristArm::try_new(geometry, JointLimits::try_new(limits, [1.0; 6]).unwrap()).unwrap();
    let pose = arm.forward(&[0.1, 0.2, 0.3, 1.0, 0.0, 0.4]);
    let found = arm.inverse_nearest(&pose, &[0.1, 0.2, 0.3, 0.0, 0.0, 0.0]).unwrap();
    assert!((found[5] - 0.5).abs() < 1e-15 && (found[3] - 0.9).abs() < 1e-14, "{found:?}");
    assert!(pose_error(&arm.forward(&found), &pose).1 < 1e-14);
}

#[test]
fn errors_name_their_evidence() {
    let arm = models::ar2010();
    let far = Pose::from_parts([3.0, 0.0, 0.0].into(), arm.forward(&[0.0; 6]).rotation);
    match arm.inverse_nearest(&far, &[0.0; 6]) {
        Err(InverseError::OutOfReach { distance, greatest, .. }) => {
            assert!(
                (distance - 2.75).abs() < 1e-12 && (greatest - (0.760 + 1.082_f64.hypot(0.2))).abs() < 1e-12
            );
        }
        other => panic!("{other:?}"),
    }
    let nan = Pose::translation(f64::NAN, 0.0, 0.0);
    assert_eq!(arm.inverse_nearest(&nan, &[0.0; 6]), Err(InverseError::NotFinite));
    let mut seed = [0.0; 6];
    seed[2] = f64::NAN;
    assert_eq!(arm.inverse_nearest(&arm.forward(&[0.0; 6]), &seed), Err(InverseError::NotFinite));
    let lateral = &arms()[2].1;
    let centre = lateral.geometry().base_from_shoulder * Pose::translation(0.05, 0.05, 0.6);
    let inside = centre * lateral.geometry().wrist_from_flange;
    assert!(matches!(
        lateral.inverse_nearest(&inside, &[0.0; 6]),
        Err(InverseError::InsideLateralOffset { radius, offset })
            if (radius - 0.05_f64.hypot(0.05)).abs() < 1e-12 && offset == 0.13
    ));
}

#[test]
fn a_pose_beyond_every_limit_names_the_joint() {
    let arm = models::ar2010();
    // Axis 4 at 170°, its limit 150°; the flipped wrist stands at −10° but turns axis 5 to 120°, its limit 90°; and
    // the wrist centre lies too far in front to be reached over the head.
    let q = degrees([0.0, 130.0, 10.0, 170.0, -120.0, 0.0]);
    assert_eq!(arm.limits().first_violation(&q), Some((3, q[3])));
    match arm.inverse_nearest(&arm.forward(&q), &q) {
        Err(InverseError::PositionLimit { axis: 3, value, min, max }) => {
            assert!((value - q[3]).abs() < 1e-12 && max == 150.0_f64.to_radians() && min == -max);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn turns_within_the_limits_follow_the_seed() {
    let arm = models::ar2010();
    let q = degrees([10.0, 20.0, -30.0, 40.0, -50.0, 200.0]);
    let pose = arm.forward(&q);
    let mut seed = q;
    assert!(joint_error(&arm.inverse_nearest(&pose, &seed).unwrap(), &q) < 1e-12);
    seed[5] = -2.0;
    let found = arm.inverse_nearest(&pose, &seed).unwrap();
    assert!((found[5] - (q[5] - TAU)).abs() < 1e-12);
    let within = arm.inverse_within_limits(&pose, &q).unwrap();
    for solution in within.as_slice() {
        assert_eq!(arm.limits().first_violation(&solution.q), None);
    }
}

/// 5,000 random joint positions: their configuration leads back to them, and its digits are RCONF's.
#[test]
fn the_configuration_leads_back() {
    let arm = models::ar2010();
    let mut random = Random::new(5);
    for _ in 0..5_000 {
        let q = random.joints(arm.position_limits());
        let configuration = arm.configuration(&q);
        assert_eq!(Configuration::from_rconf(configuration.to_rconf()), Some(configuration));
        // Joints 2, 3 and 5 have less than a full turn: the reference does not matter.
        let found = arm.inverse_in_configuration(&arm.forward(&q), &configuration, &[0.0; 6]).unwrap();
        assert!(joint_error(&found, &q) < 1e-6, "{q:?} {found:?}");
    }
    let torch_down = arm.configuration(&degrees([0.0, 0.0, -30.0, 0.0, -60.0, 0.0]));
    assert_eq!(torch_down.to_rconf(), [1, 0, 0, 0, 0, 0]);
    let posture = torch_down.posture;
    assert_eq!(
        (posture.shoulder, posture.elbow, posture.wrist),
        (Shoulder::Front, Elbow::Upper, Wrist::NoFlip)
    );
    assert_eq!(arm.configuration(&degrees([0.0, 0.0, 0.0, 0.0, 10.0, 190.0])).to_rconf(), [0, 0, 0, 0, 1, 0]);
    assert_eq!(Configuration::from_rconf([2, 0, 0, 0, 0, 0]), None);
}
