//! The four-axis SCARA arm.

use std::f64::consts::PI;

use seamline::geometry::{Pose, PoseJet, Rotation, Vector3};
use seamline::kinematics::{
    Handedness, InverseError, JointLimits, Kinematics, ScaraArm, ScaraGeometry, Singularity, models,
};

use crate::support::{Random, joint_error, pose_error};

#[test]
fn scara600_stands_at_zero_as_described() {
    let arm = models::scara600();
    let pose = arm.forward(&[0.0; 4]);
    assert!((pose.translation.vector - Vector3::new(0.6, 0.0, 0.0)).norm() < 1e-15);
    assert_eq!(pose.rotation * Vector3::z(), -Vector3::z());
    let limits = JointLimits::try_new(*arm.position_limits(), *arm.velocity_limits()).unwrap();
    assert_eq!(ScaraArm::try_new(*arm.geometry(), limits), Ok(arm));
}

/// 20,000 random joint positions, also with the arm mounted askew: both branches reach the pose, the own one comes back,
/// nearest finds it.
#[test]
fn both_elbows_reach_the_pose() {
    let askew = ScaraGeometry {
        base_from_shoulder: Pose::new(Vector3::new(0.1, 0.2, 0.3), Vector3::new(0.4, 1.1, -0.5)),
        last_from_flange: Pose::new(Vector3::new(0.05, -0.02, 0.3), Vector3::new(0.2, -0.7, 1.4)),
        ..*models::scara600().geometry()
    };
    let limits = *models::scara600().limits();
    let mut random = Random::new(41);
    for arm in [models::scara600(), ScaraArm::try_new(askew, limits).unwrap()] {
        for _ in 0..10_000 {
            let q = random.joints(arm.position_limits());
            let pose = arm.forward(&q);
            let solutions = arm.inverse(&pose, &q).unwrap();
            assert_eq!(solutions.as_slice().len(), 2);
            for solution in solutions.as_slice() {
                let (distance, angle) = pose_error(&arm.forward(&solution.q), &pose);
                assert!(distance < 1e-14 && angle < 1e-14, "{q:?} {distance:e} {angle:e}");
                let right = solution.q[1] >= 0.0;
                assert_eq!(right, solution.handedness == Handedness::Right);
            }
            let found = arm.inverse_nearest(&pose, &q).unwrap();
            assert!(joint_error(&found, &q) < 1e-7, "{q:?} {found:?}");
            assert!(!arm.inverse_branches(&pose, &q).unwrap().as_slice().is_empty());
        }
    }
}

/// The path of the SCARA experiment comes as near to axis 1 as 145 mm: within the limits.
#[test]
fn the_experiment_s_path_is_within_reach() {
    let arm = models::scara600();
    for [x, y] in [[0.180, 0.0], [0.140, 0.040], [0.275, 0.100], [0.410, 0.040], [0.360, 0.090], [0.270, 0.0]]
    {
        let down = arm.forward(&[0.0; 4]).rotation;
        let pose = Pose::from_parts([x, y, -0.1].into(), down);
        assert_eq!(arm.inverse_branches(&pose, &[0.0; 4]).unwrap().as_slice().len(), 2);
    }
}

#[test]
fn stretched_folded_and_out_of_reach() {
    let arm = models::scara600();
    for bend in [0.0, 1e-12, 1e-9, 1e-6] {
        let q = [0.3, bend, -0.1, 0.2];
        let found = arm.inverse_nearest(&arm.forward(&q), &q).unwrap();
        assert!(pose_error(&arm.forward(&found), &arm.forward(&q)).0 < 1e-14);
    }
    let equal = ScaraGeometry { upper_arm: 0.3, forearm: 0.3, ..*arm.geometry() };
    let equal = ScaraArm::try_new(equal, JointLimits::unlimited()).unwrap();
    let folded = [0.7, PI, -0.1, 0.2];
    let found = equal.inverse_nearest(&equal.forward(&folded), &folded).unwrap();
    assert!(joint_error(&found, &folded) < 1e-14, "{found:?}");
    let down = arm.forward(&[0.0; 4]).rotation;
    let far = Pose::from_parts([0.7, 0.0, 0.0].into(), down);
    assert!(matches!(
        arm.inverse_nearest(&far, &[0.0; 4]),
        Err(InverseError::OutOfReach { distance, .. }) if (distance - 0.7).abs() < 1e-15
    ));
    let low = Pose::from_parts([0.5, 0.0, -0.3].into(), down);
    assert!(matches!(
        arm.inverse_nearest(&low, &[0.0; 4]),
        Err(InverseError::PositionLimit { axis: 2, value, .. }) if (value + 0.3).abs() < 1e-15
    ));
}

#[test]
fn a_tilted_flange_is_refused() {
    let arm = models::scara600();
    let mut pose = arm.forward(&[0.3, 0.4, -0.1, 0.2]);
    pose.rotation *= Rotation::from_scaled_axis(Vector3::new(1e-3, 0.0, 0.0));
    match arm.inverse_nearest(&pose, &[0.0; 4]) {
        Err(InverseError::OutOfOrientation { angle }) => assert!((angle - 1e-3).abs() < 1e-12),
        other => panic!("{other:?}"),
    }
    let q = [0.3, 0.4, -0.1, 0.2];
    let mut motion = PoseJet::at_rest(arm.forward(&q));
    motion.angular[0] = Vector3::x();
    assert_eq!(arm.joint_jet(&motion, &q), Err(InverseError::NotFollowed { missing: 1.0 }));
    let stretched = [0.3, 0.0, -0.1, 0.2];
    let mut motion = PoseJet::at_rest(arm.forward(&stretched));
    assert!(arm.joint_jet(&motion, &stretched).is_ok());
    motion.linear[0] = Vector3::x();
    assert!(matches!(
        arm.joint_jet(&motion, &stretched),
        Err(InverseError::Singular { singularity: Singularity::Elbow, .. })
    ));
}
