//! Inverse after forward is the identity, on the four built-in arms.

use seamline::geometry::Pose;
use seamline::kinematics::{InverseError, Kinematics, SixAxisArm, models};

use crate::support::{Random, joint_error, pose_error};

/// What was seen over all cases.
#[derive(Default, Debug)]
struct Worst {
    distance: f64,
    angle: f64,
    joints: f64,
}

/// Random joint positions within the limits: every branch found reaches the pose, and the nearest to the joint positions
/// is the joint positions.
fn identity<const N: usize>(arm: &impl Kinematics<N>, seed: u64, cases: usize) -> Worst {
    let mut random = Random::new(seed);
    let mut worst = Worst::default();
    for _ in 0..cases {
        let q = random.joints(arm.position_limits());
        let pose = arm.forward(&q);
        let mut check = |found: Result<[f64; N], InverseError>, pose: &Pose| {
            let found = found.unwrap_or_else(|error| panic!("{q:?}: {error:?}"));
            let (distance, angle) = pose_error(&arm.forward(&found), pose);
            worst.distance = worst.distance.max(distance);
            worst.angle = worst.angle.max(angle);
            found
        };
        let nearest = check(arm.inverse_nearest(&pose, &q), &pose);
        for branch in arm.inverse_branches(&pose, &q).unwrap() {
            check(Ok(branch), &pose);
        }
        worst.joints = worst.joints.max(joint_error(&nearest, &q));
    }
    worst
}

fn all_arms(cases: usize) {
    let worst = [
        identity(&models::ar2010(), 71, cases),
        identity(&models::irb2400(), 72, cases),
        identity(&SixAxisArm::from_chain(models::ur5e()), 73, cases),
        identity(&models::scara600(), 74, cases),
    ];
    for worst in &worst {
        assert!(worst.distance < 1e-14 && worst.angle < 1e-14, "{worst:?}");
        // Joints follow the pose's rounding with its square root beside the elbow's singularity.
        assert!(worst.joints < 1e-6, "{worst:?}");
    }
}

#[test]
fn inverse_after_forward_is_the_identity() {
    all_arms(25_000);
}

#[test]
#[ignore = "a million poses of each arm: run with --release, a few seconds"]
fn inverse_after_forward_is_the_identity_a_million_times() {
    all_arms(1_000_000);
}
