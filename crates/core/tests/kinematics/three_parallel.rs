//! Arms with three parallel axes: the UR5e, and others of its kind in any frames.

use std::f64::consts::PI;

use seamline::geometry::Vector3;
use seamline::kinematics::{
    ClosedForm, InverseError, InverseMethod, JointAxes, JointLimits, Kinematics, SerialChain, SixAxisArm,
    ThreeParallelArm, models,
};

use crate::support::{Random, joint_error, joint_error_modulo_turns, pose_error};

fn ur5e() -> ThreeParallelArm {
    models::ur5e().three_parallel(1e-10).unwrap()
}

/// The UR5e, and one with its shoulder beside axis 1, another zero, and directions turned about.
fn arms() -> [ThreeParallelArm; 2] {
    let JointAxes { mut axes, base_from_flange } = models::ur5e().axes(&[0.4, -1.0, 0.7, 2.0, -0.6, 1.0]);
    let beside = axes[0].point + Vector3::new(0.1, 0.07, 0.0);
    axes[0].point = beside;
    for (i, axis) in axes.iter_mut().enumerate() {
        axis.point += axis.direction * (0.1 * i as f64 - 0.2);
        if i % 2 == 1 {
            axis.direction = -axis.direction;
        }
    }
    let other =
        SerialChain::from_axes(&JointAxes { axes, base_from_flange }, *models::ur5e().limits()).unwrap();
    [ur5e(), other.three_parallel(1e-10).unwrap()]
}

/// 20,000 random joint positions each: the branch they came from is found, every branch reaches the pose to 1e-13 m and
/// 1e-13 rad, no two agree, and nearest gives the joints back.
#[test]
fn every_branch_reaches_the_pose() {
    let mut random = Random::new(61);
    for arm in arms() {
        let (mut worst_distance, mut worst_angle, mut most) = (0.0_f64, 0.0_f64, 0);
        for _ in 0..20_000 {
            let q = random.joints(arm.position_limits());
            let pose = arm.forward(&q);
            let all = arm.inverse(&pose, &q).unwrap();
            let branches = all.as_slice();
            most = most.max(branches.len());
            for (i, branch) in branches.iter().enumerate() {
                let (distance, angle) = pose_error(&arm.forward(branch), &pose);
                worst_distance = worst_distance.max(distance);
                worst_angle = worst_angle.max(angle);
                assert!(branches[..i].iter().all(|other| joint_error_modulo_turns(branch, other) > 1e-9));
            }
            let own = branches.iter().map(|b| joint_error_modulo_turns(b, &q)).fold(f64::INFINITY, f64::min);
            assert!(own < 1e-6, "{q:?} {branches:?}");
            let found = arm.inverse_nearest(&pose, &q).unwrap();
            assert!(joint_error(&found, &q) < 1e-6, "{q:?} {found:?}");
        }
        assert!(worst_distance < 1e-13 && worst_angle < 1e-13, "{worst_distance:e} {worst_angle:e}");
        assert_eq!(most, 8);
    }
}

/// Near and at each singularity: the pose is met, and the branch stays at the seed.
#[test]
fn singular_poses_are_met() {
    let arm = ur5e();
    // The shoulder is singular where the wrist is as near to axis 1 as its offset lets it: found by bisection.
    let shoulder = {
        let radial = |q2: f64| {
            let wrist = arm.axes(&[0.0, q2, 1.2, 0.3, 0.9, 0.4]).axes[5].point;
            wrist.x
        };
        let (mut low, mut high) = (-2.8, -1.2);
        assert!(radial(low) * radial(high) < 0.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if radial(low) * radial(middle) > 0.0 { low = middle } else { high = middle }
        }
        low
    };
    for exponent in 1..=17 {
        let offset = if exponent == 17 { 0.0 } else { 10.0_f64.powi(-exponent) };
        for (name, q) in [
            ("wrist", [0.3, -1.0, 1.2, 0.4, offset, -0.7]),
            ("wrist half turn", [0.3, -1.0, 1.2, 0.4, PI - offset, -0.7]),
            ("elbow stretched", [0.3, -1.0, offset, 0.4, 0.8, -0.7]),
            ("shoulder", [0.0, shoulder + offset, 1.2, 0.3, 0.9, 0.4]),
        ] {
            let pose = arm.forward(&q);
            let all = arm.inverse(&pose, &q).unwrap();
            for branch in all.as_slice() {
                let (distance, angle) = pose_error(&arm.forward(branch), &pose);
                assert!(distance < 1e-13 && angle < 3e-13, "{name} {offset:e}: {distance:e} {angle:e}");
            }
            let found = arm.inverse_nearest(&pose, &q).unwrap();
            let rounding = 1e-6 + if offset == 0.0 { 0.0 } else { 4e-15 / offset };
            assert!(joint_error(&found, &q) < rounding + 4.0 * offset, "{name} {offset:e} {found:?}");
        }
    }
}

#[test]
fn limits_and_reach() {
    let narrow = JointLimits::try_new([(-1.0, 1.0); 6], [1.0; 6]).unwrap();
    let at_zero = models::ur5e().axes(&[0.0; 6]);
    let arm = SerialChain::from_axes(&at_zero, narrow).unwrap().three_parallel(1e-10).unwrap();
    let q = [0.5, -0.5, 0.5, 0.5, 1.5, 0.5];
    assert!(matches!(
        arm.inverse_nearest(&arm.forward(&q), &q),
        Err(InverseError::PositionLimit { axis: 4, value, .. }) if (value - 1.5).abs() < 1e-12
    ));
    let far = seamline::geometry::Pose::translation(1.5, 0.0, 0.0);
    assert!(matches!(arm.inverse_nearest(&far, &q), Err(InverseError::OutOfReach { .. })));
    let near = seamline::geometry::Pose::translation(0.05, 0.0, 0.5);
    assert!(matches!(arm.inverse_nearest(&near, &q), Err(InverseError::InsideLateralOffset { .. })));
}

/// Ten calibrations of a UR5e, 100 poses each: met to 1e-12 on the real arm.
#[test]
fn a_calibrated_arm_is_polished() {
    let mut random = Random::new(62);
    for _ in 0..10 {
        let mut axes = models::ur5e().axes(&[0.0; 6]);
        for axis in &mut axes.axes {
            axis.point += random.vector(5e-4);
            axis.direction = (axis.direction + random.vector(1e-3)).normalize();
        }
        let chain = SerialChain::from_axes(&axes, *models::ur5e().limits()).unwrap();
        let arm = SixAxisArm::from_chain(chain);
        assert!(matches!(arm.method(), InverseMethod::Polished(ClosedForm::ThreeParallel(_))));
        for _ in 0..100 {
            let q =
                random.joints(&[(-3.0, 3.0), (-2.0, 0.0), (0.3, 2.5), (-3.0, 3.0), (0.3, 2.8), (-3.0, 3.0)]);
            let pose = arm.forward(&q);
            for branch in arm.inverse_branches(&pose, &q).unwrap() {
                let (distance, angle) = pose_error(&arm.forward(&branch), &pose);
                assert!(distance < 1.1e-12 && angle < 1.1e-12, "{distance:e} {angle:e}");
            }
        }
    }
}
