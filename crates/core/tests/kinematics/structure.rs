//! A chain shows its spherical wrist whatever its frames, and a calibrated arm is met exactly.

use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::{
    ClosedForm, InverseMethod, JointAxes, JointLimits, Kinematics, OpwParameters, SerialChain, SixAxisArm,
    SphericalWristArm, models,
};

use crate::support::{Random, joint_error, joint_error_modulo_turns, pose_error};

/// The arm's axes at zero with every free choice made at random: points slid along their axes, directions turned
/// about with the joint's sign, zero moved, base and flange put elsewhere.
fn disguised(arm: &SphericalWristArm, random: &mut Random, keep_directions: bool) -> SerialChain<6> {
    let zero = if keep_directions { [0.0; 6] } else { std::array::from_fn(|_| random.uniform(-3.0, 3.0)) };
    let JointAxes { mut axes, base_from_flange } = arm.axes(&zero);
    for axis in &mut axes {
        axis.point += axis.direction * random.uniform(-0.5, 0.5);
        if !keep_directions && random.uniform(-1.0, 1.0) < 0.0 {
            axis.direction = -axis.direction;
        }
    }
    SerialChain::from_axes(&JointAxes { axes, base_from_flange }, JointLimits::unlimited()).unwrap()
}

/// 300 disguises of three arms: found, and the closed form is the chain at 10 joint positions each, Jacobian too.
#[test]
fn the_structure_is_found_in_any_frames() {
    let lateral = OpwParameters {
        a1: 0.2,
        a2: 0.05,
        b: -0.13,
        c1: 0.4,
        c2: 0.6,
        c3: 0.7,
        c4: 0.12,
        offsets: [0.0; 6],
        signs: [1.0; 6],
    };
    let lateral = SphericalWristArm::try_new(lateral.geometry(), JointLimits::unlimited()).unwrap();
    let mut random = Random::new(51);
    for arm in [models::ar2010(), models::irb2400(), lateral] {
        for _ in 0..100 {
            let chain = disguised(&arm, &mut random, false);
            let found = chain.spherical_wrist(1e-10).unwrap();
            for _ in 0..10 {
                let q: [f64; 6] = std::array::from_fn(|_| random.uniform(-3.0, 3.0));
                let (distance, angle) = pose_error(&found.forward(&q), &chain.forward(&q));
                assert!(distance < 2e-14 && angle < 2e-14, "{distance:e} {angle:e}");
                assert!((found.axes(&q).jacobian() - chain.axes(&q).jacobian()).norm() < 1e-13);
            }
        }
    }
}

/// Where the description keeps the maker's directions and zero, the names of the branches stay too.
#[test]
fn postures_keep_their_names() {
    let mut random = Random::new(52);
    for arm in [models::ar2010(), models::irb2400()] {
        let found = disguised(&arm, &mut random, true).spherical_wrist(1e-10).unwrap();
        for _ in 0..2_000 {
            let q = random.joints(arm.position_limits());
            assert_eq!(found.posture(&q), arm.posture(&q), "{q:?}");
        }
    }
}

#[test]
fn other_arms_are_not_taken_for_one() {
    assert_eq!(models::ur5e().spherical_wrist(1e-3), None);
    assert!(matches!(
        SixAxisArm::from_chain(models::ur5e()).method(),
        InverseMethod::Exact(ClosedForm::ThreeParallel(_))
    ));
    assert_eq!(disguised(&models::ar2010(), &mut Random::new(56), true).three_parallel(1e-3), None);
    let mut skew = models::ur5e().axes(&[0.5; 6]);
    skew.axes[3].direction = Vector3::new(0.6, 0.0, 0.8);
    let chain = SerialChain::from_axes(&skew, JointLimits::unlimited()).unwrap();
    assert_eq!(SixAxisArm::from_chain(chain).method(), &InverseMethod::Numeric);
    let chain = disguised(&models::ar2010(), &mut Random::new(53), true);
    assert!(matches!(
        SixAxisArm::from_chain(chain).method(),
        InverseMethod::Exact(ClosedForm::SphericalWrist(_))
    ));
}

#[test]
fn a_named_arm_stays_itself() {
    let arm = SixAxisArm::from(models::ar2010());
    assert_eq!(arm.method(), &InverseMethod::Exact(ClosedForm::SphericalWrist(models::ar2010())));
    let q = [0.1, 0.2, 0.3, 0.4, -0.5, 0.6];
    assert!(pose_error(&arm.chain().forward(&q), &arm.forward(&q)).0 < 1e-14);
    let nearest = arm.inverse_nearest(&arm.forward(&q), &q).unwrap();
    assert_eq!(Ok(nearest), models::ar2010().inverse_nearest(&arm.forward(&q), &q));
}

/// 20 calibrations (axes off by up to 0.5 mm and 1 mrad), 100 poses each: every branch of the nominal arm is met on the
/// real one to 1e-12, and nearest gives the joints back.
#[test]
fn a_calibrated_arm_is_met_exactly() {
    let nominal = models::ar2010();
    let mut random = Random::new(54);
    for _ in 0..20 {
        let JointAxes { mut axes, base_from_flange } = nominal.axes(&[0.0; 6]);
        for axis in &mut axes {
            axis.point += random.vector(5e-4);
            axis.direction = (axis.direction + random.vector(1e-3)).normalize();
        }
        let flange = base_from_flange * Pose::new(random.vector(1e-3), random.vector(1e-3));
        let real = JointAxes { axes, base_from_flange: flange };
        let chain = SerialChain::from_axes(&real, *nominal.limits()).unwrap();
        let arm = SixAxisArm::from_chain(chain);
        assert!(matches!(arm.method(), InverseMethod::Polished(_)));
        let mut tried = 0;
        while tried < 100 {
            let q = random.joints(arm.position_limits());
            let distances = nominal.singularity_distances(&q);
            if distances.wrist < 0.05 || distances.elbow < 0.05 || distances.shoulder < 0.05 {
                continue;
            }
            tried += 1;
            let pose = arm.forward(&q);
            let found = arm.inverse_nearest(&pose, &q).unwrap();
            assert!(joint_error(&found, &q) < 1e-9, "{q:?} {found:?}");
            let branches = arm.inverse_branches(&pose, &q).unwrap();
            assert!(joint_error_modulo_turns(&branches.as_slice()[0], &q) < 1e-9);
            for branch in branches.as_slice() {
                let (distance, angle) = pose_error(&arm.forward(branch), &pose);
                assert!(distance < 1.1e-12 && angle < 1.1e-12, "{distance:e} {angle:e}");
            }
        }
    }
}

/// A description with angles rounded to 1.5708 and the like is an arm of its own: found, polished, met exactly.
#[test]
fn rounded_descriptions_are_polished() {
    let mut random = Random::new(55);
    let mut axes = models::irb2400().axes(&[0.0; 6]);
    for axis in &mut axes.axes {
        axis.direction = (axis.direction + random.vector(3.7e-6)).normalize();
    }
    let chain = SerialChain::from_axes(&axes, *models::irb2400().limits()).unwrap();
    let arm = SixAxisArm::from_chain(chain);
    assert!(matches!(arm.method(), InverseMethod::Polished(_)));
    let q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let found = arm.inverse_nearest(&chain.forward(&q), &q).unwrap();
    assert!(joint_error(&found, &q) < 1e-10);
}
