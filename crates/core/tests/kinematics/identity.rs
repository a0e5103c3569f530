//! Inverse after forward is the identity, on the four built-in arms.

use seamline::geometry::{Pose, Rotation, Vector3};
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

/// Random poses in and out of reach, in any orientation, and absurd ones: either the answer reaches the pose within the
/// limits, or the error has finite evidence.
fn answers_are_sound<const N: usize>(arm: &impl Kinematics<N>, poses: &[Pose], tolerance: f64) -> [usize; 2] {
    let mut count = [0, 0];
    for pose in poses {
        match arm.inverse_nearest(pose, &[0.1; N]) {
            Ok(q) => {
                let (distance, angle) = pose_error(&arm.forward(&q), pose);
                assert!(distance < tolerance && angle < 1e-9, "{pose} {q:?}: {distance:e} {angle:e}");
                let limits = arm.position_limits().iter();
                assert!(q.iter().zip(limits).all(|(q, (min, max))| q >= min && q <= max), "{pose} {q:?}");
                count[0] += 1;
            }
            Err(error) => {
                assert_ne!(error, InverseError::NotFinite, "{pose}");
                assert!(!format!("{error:?}").contains("NaN"), "{pose} {error:?}");
                count[1] += 1;
            }
        }
    }
    count
}

#[test]
fn poses_in_and_out_of_reach() {
    let mut random = Random::new(75);
    let mut poses: Vec<Pose> =
        (0..5_000).map(|_| Pose::new(random.vector(1.6), random.vector(3.0))).collect();
    for size in [0.0, 5e-324, 1e-300, 1e-160, 1e-17, 1e-8, 1e8, 1e160, 1e300] {
        for direction in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 1.0, -1.0]] {
            let position = direction.map(|x| x * size);
            poses.extend(
                [0.0, 1.0, 3.0].map(|turn| Pose::from_parts(position.into(), random_turn(&mut random, turn))),
            );
        }
    }
    let looking_down = models::scara600().forward(&[0.0; 4]).rotation;
    let level: Vec<Pose> = poses
        .iter()
        .map(|pose| Pose::from_parts(pose.translation, turn_about_z(pose) * looking_down))
        .collect();
    let counts = [
        answers_are_sound(&models::ar2010(), &poses, 1e-13),
        answers_are_sound(&models::irb2400(), &poses, 1e-13),
        answers_are_sound(&SixAxisArm::from_chain(models::ur5e()), &poses, 1e-13),
        answers_are_sound(&models::scara600(), &level, 1e-13),
    ];
    for [reached, refused] in counts {
        assert!(reached > 20 && refused > 1_000, "{counts:?}");
    }
}

fn random_turn(random: &mut Random, size: f64) -> Rotation {
    Rotation::from_scaled_axis(random.vector(size))
}

/// A level orientation: of any turn only that about z.
fn turn_about_z(pose: &Pose) -> Rotation {
    Rotation::from_scaled_axis(Vector3::z() * pose.rotation.scaled_axis().z)
}

#[test]
#[ignore = "a million poses of each arm: run with --release, a few seconds"]
fn inverse_after_forward_is_the_identity_a_million_times() {
    all_arms(1_000_000);
}
