//! General chains: descriptions, and the numeric inverse.

use std::f64::consts::{FRAC_PI_2, PI};

use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::{
    DhConvention, DhRow, InverseError, JointDescription, JointKind, JointLimits, Kinematics, ModelError,
    SerialChain, SolverSettings, models,
};

use crate::differential::mixed_chain;
use crate::support::{Random, joint_error, pose_error};

fn irb2400() -> SerialChain<6> {
    let arm = models::irb2400();
    SerialChain::from_axes(&arm.axes(&[0.0; 6]), *arm.limits()).unwrap()
}

/// 2,000 joint positions: the chain of the arm's axes is the arm.
#[test]
fn a_chain_of_the_axes_is_the_arm() {
    let (arm, chain) = (models::irb2400(), irb2400());
    let mut random = Random::new(31);
    for _ in 0..2_000 {
        let q = random.joints(arm.position_limits());
        let (distance, angle) = pose_error(&chain.forward(&q), &arm.forward(&q));
        assert!(distance < 1e-14 && angle < 1e-14, "{distance:e} {angle:e}");
        assert!((chain.axes(&q).jacobian() - arm.axes(&q).jacobian()).norm() < 1e-14);
    }
}

/// The same arm by both Denavit–Hartenberg conventions: the UR5e, and its modified table.
#[test]
fn both_conventions_give_the_same_arm() {
    let row = |a, alpha, d| DhRow { a, alpha, d, theta: 0.0, kind: JointKind::Revolute };
    let modified = [
        row(0.0, 0.0, 0.1625),
        row(0.0, FRAC_PI_2, 0.0),
        row(-0.425, 0.0, 0.0),
        row(-0.3922, 0.0, 0.1333),
        row(0.0, FRAC_PI_2, 0.0997),
        row(0.0, -FRAC_PI_2, 0.0996),
    ];
    let identity = Pose::identity();
    let chain = SerialChain::from_dh(
        &modified,
        DhConvention::Modified,
        &identity,
        &identity,
        JointLimits::unlimited(),
    )
    .unwrap();
    let mut random = Random::new(32);
    for _ in 0..500 {
        let q = random.joints(models::ur5e().position_limits());
        let (distance, angle) = pose_error(&chain.forward(&q), &models::ur5e().forward(&q));
        assert!(distance < 1e-14 && angle < 1e-14);
    }
}

#[test]
fn an_axis_without_direction_is_refused() {
    let joint =
        |axis| JointDescription { parent_from_joint: Pose::identity(), axis, kind: JointKind::Revolute };
    let joints = [joint(Vector3::z()), joint(Vector3::zeros())];
    let refused = SerialChain::try_new(&joints, &Pose::identity(), JointLimits::unlimited());
    assert_eq!(refused, Err(ModelError::Axis { axis: 1 }));
    let backwards = [joint(-Vector3::z())];
    let chain = SerialChain::try_new(&backwards, &Pose::identity(), JointLimits::unlimited()).unwrap();
    assert!((chain.forward(&[FRAC_PI_2]) * Vector3::x() + Vector3::y()).norm() < 1e-15);
}

/// 10,000 poses each, seeded within 0.05 rad in every joint: all found to 1e-9, within a few iterations.
#[test]
fn numeric_inverse_from_a_near_seed() {
    let settings =
        SolverSettings { position_tolerance: 1e-9, rotation_tolerance: 1e-9, ..SolverSettings::default() };
    let mut random = Random::new(33);
    for (name, chain) in [("irb2400", irb2400()), ("ur5e", models::ur5e())] {
        let mut iterations = 0;
        for _ in 0..10_000 {
            let q = random.joints(chain.position_limits());
            let seed = q.map(|angle| angle + random.uniform(-0.05, 0.05));
            let pose = chain.forward(&q);
            let found = chain.solve(&pose, &seed, &settings).unwrap();
            let (distance, angle) = pose_error(&chain.forward(&found.q), &pose);
            assert!(distance < 1e-9 && angle < 1e-9, "{name} {q:?}: {distance:e} {angle:e}");
            assert!((distance - found.position_residual).abs() < 1e-12);
            assert_eq!(chain.limits().first_violation(&found.q), None);
            iterations += found.iterations;
        }
        assert!(iterations < 25_000, "{name}: {iterations} iterations");
    }
}

/// 3,000 poses each from random seeds: at least 99.9 % found, within the limits, to the default 1e-6.
#[test]
fn numeric_inverse_from_a_random_seed() {
    let settings = SolverSettings::default();
    let mut random = Random::new(34);
    for (name, chain) in [("irb2400", irb2400()), ("ur5e", models::ur5e())] {
        let mut lost = 0;
        for _ in 0..3_000 {
            let pose = chain.forward(&random.joints(chain.position_limits()));
            let seed = random.joints(chain.position_limits());
            match chain.solve(&pose, &seed, &settings) {
                Ok(found) => {
                    let (distance, angle) = pose_error(&chain.forward(&found.q), &pose);
                    assert!(distance < 1e-6 && angle < 1e-6);
                    assert_eq!(chain.limits().first_violation(&found.q), None);
                    // The same question has the same answer.
                    assert_eq!(chain.solve(&pose, &seed, &settings), Ok(found));
                }
                Err(_) => lost += 1,
            }
        }
        assert!(lost <= 3, "{name}: {lost} lost");
    }
}

/// 1,000 poses with the wrist at its pole and 1,000 with the arm stretched, seeded within 0.01 rad: from the seed alone
/// nearly all are met to rounding, and all of them from other starts.
#[test]
fn numeric_inverse_at_singular_poses() {
    let one_start = SolverSettings { starts: 1, ..SolverSettings::TO_ROUNDING };
    let mut random = Random::new(36);
    for chain in [irb2400(), models::ur5e()] {
        let stretched = if chain == irb2400() { 0.135_f64.atan2(0.755) - FRAC_PI_2 } else { 0.0 };
        for (axis, singular) in [(4, 0.0), (2, stretched)] {
            let mut alone = 0;
            for _ in 0..500 {
                let mut q = random.joints(&[(-1.0, 1.0); 6]);
                q[axis] = singular;
                let free = SerialChain::from_axes(&chain.axes(&[0.0; 6]), JointLimits::unlimited()).unwrap();
                let pose = free.forward(&q);
                let seed = q.map(|angle| angle + random.uniform(-0.01, 0.01));
                alone += usize::from(free.solve(&pose, &seed, &one_start).is_ok());
                let found = free.inverse_nearest(&pose, &seed).unwrap();
                let (distance, angle) = pose_error(&free.forward(&found), &pose);
                assert!(distance < 1.1e-12 && angle < 1.1e-12, "{distance:e} {angle:e}");
            }
            assert!(alone >= 495, "joint {axis}: {alone} of 500");
        }
    }
}

#[test]
fn sliding_joints_and_seven_of_them() {
    let chain = mixed_chain();
    let mut random = Random::new(35);
    for _ in 0..500 {
        let q: [f64; 7] = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let seed = q.map(|x| x + random.uniform(-0.05, 0.05));
        let pose = chain.forward(&q);
        let found = chain.inverse_nearest(&pose, &seed).unwrap();
        let (distance, angle) = pose_error(&chain.forward(&found), &pose);
        assert!(distance < 1e-6 && angle < 1e-6 && joint_error(&found, &seed) < 0.5);
    }
}

#[test]
fn a_pose_out_of_reach_costs_no_more_than_asked() {
    let chain = models::ur5e();
    let far = Pose::translation(2.0, 0.0, 0.0);
    let settings = SolverSettings { starts: 3, iterations_per_start: 10, ..SolverSettings::default() };
    match chain.solve(&far, &[0.1; 6], &settings) {
        Err(InverseError::NotConverged { iterations, position_residual, .. }) => {
            assert!(iterations <= 30 && position_residual > 0.9);
        }
        other => panic!("{other:?}"),
    }
    let nan = Pose::translation(f64::NAN, 0.0, 0.0);
    assert_eq!(chain.solve(&nan, &[0.1; 6], &settings), Err(InverseError::NotFinite));
}

#[test]
fn solutions_outside_the_limits_name_the_joint() {
    let narrow = JointLimits::try_new([(0.2, 0.4)], [1.0]).unwrap();
    let joint = JointDescription {
        parent_from_joint: Pose::identity(),
        axis: Vector3::z(),
        kind: JointKind::Revolute,
    };
    let chain = SerialChain::try_new(&[joint], &Pose::translation(1.0, 0.0, 0.0), narrow).unwrap();
    match chain.inverse_nearest(&chain.forward(&[0.5]), &[0.3]) {
        Err(InverseError::PositionLimit { axis: 0, value, max, .. }) => {
            assert!((value - 0.5).abs() < 1e-6 && max == 0.4);
        }
        other => panic!("{other:?}"),
    }
    let turned = chain.inverse_nearest(&chain.forward(&[0.3 - 2.0 * PI]), &[0.3]).unwrap();
    assert!((turned[0] - 0.3).abs() < 1e-6);
}
