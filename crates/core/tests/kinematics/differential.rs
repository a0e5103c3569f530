//! Jacobian, its derivative, motion forwards and back, singular values and distances.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Matrix6;
use seamline::geometry::{Pose, PoseJet, Vector3};
use seamline::kinematics::{
    Jacobian, JointAxes, JointJet, JointLimits, Kinematics, SerialChain, SingularValues, models,
};

use crate::support::{Random, joint_error};

/// Central differences of fourth order.
fn difference<T>(f: impl Fn(f64) -> T, h: f64) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    ((f(h) - f(-h)) * 8.0 - (f(2.0 * h) - f(-2.0 * h))) * (1.0 / (12.0 * h))
}

fn moved<const N: usize>(q: &[f64; N], axis: usize, t: f64) -> [f64; N] {
    let mut moved = *q;
    moved[axis] += t;
    moved
}

/// Against differences of the forward kinematics: linear rows from the position, angular rows from the rotation's
/// columns.
fn check_jacobian<const N: usize>(arm: &impl Kinematics<N>, q: &[f64; N]) {
    let JointAxes { base_from_flange, .. } = arm.axes(q);
    assert!((base_from_flange.translation.vector - arm.forward(q).translation.vector).norm() < 1e-14);
    let jacobian = arm.axes(q).jacobian();
    for axis in 0..N {
        let linear = difference(|t| arm.forward(&moved(q, axis, t)).translation.vector, 1e-3);
        assert!((jacobian.fixed_view::<3, 1>(0, axis) - linear).norm() < 1e-10, "{q:?} joint {axis}");
        for unit in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let turning = difference(|t| arm.forward(&moved(q, axis, t)).rotation * unit, 1e-3);
            let angular: Vector3 = jacobian.fixed_view::<3, 1>(3, axis).into();
            assert!((angular.cross(&(base_from_flange.rotation * unit)) - turning).norm() < 1e-10);
        }
    }
}

/// 500 random joint positions each, of arms with every kind of frame and joint.
#[test]
fn the_jacobian_is_the_derivative_of_the_flange() {
    let mut random = Random::new(21);
    for _ in 0..500 {
        check_jacobian(&models::ar2010(), &random.joints(models::ar2010().position_limits()));
        check_jacobian(&models::irb2400(), &random.joints(models::irb2400().position_limits()));
        check_jacobian(&models::ur5e(), &random.joints(models::ur5e().position_limits()));
        check_jacobian(&models::scara600(), &random.joints(models::scara600().position_limits()));
    }
}

/// 500 random states: the Jacobian's derivative against differences of the Jacobian along the motion.
#[test]
fn the_jacobian_s_derivative() {
    let mut random = Random::new(22);
    let scara = models::scara600();
    let mixed = mixed_chain();
    for _ in 0..500 {
        let q: [f64; 4] = random.joints(scara.position_limits());
        let rate = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        check_derivative(&scara, &q, &rate);
        let q: [f64; 7] = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let rate = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        check_derivative(&mixed, &q, &rate);
    }
}

fn check_derivative<const N: usize>(arm: &impl Kinematics<N>, q: &[f64; N], rate: &[f64; N]) {
    let along = |t: f64| arm.axes(&std::array::from_fn(|i| q[i] + t * rate[i])).jacobian();
    let expected: Jacobian<N> = difference(along, 1e-3);
    let got = arm.axes(q).jacobian_derivative(rate);
    assert!((got - expected).norm() < 1e-9, "{got} {expected}");
}

/// Seven joints, two of them sliding, axes in no special direction.
pub(crate) fn mixed_chain() -> SerialChain<7> {
    use seamline::kinematics::{JointDescription, JointKind};
    let mut random = Random::new(23);
    let joints = [0, 1, 2, 3, 4, 5, 6].map(|i| JointDescription {
        parent_from_joint: Pose::new(random.vector(0.4), random.vector(2.0)),
        axis: random.vector(1.0),
        kind: if i == 1 || i == 4 { JointKind::Prismatic } else { JointKind::Revolute },
    });
    let flange = Pose::new(random.vector(0.2), random.vector(1.0));
    SerialChain::try_new(&joints, &flange, JointLimits::unlimited()).unwrap()
}

fn random_joint_jet<const N: usize>(random: &mut Random, position: [f64; N]) -> JointJet<N> {
    let mut vector = || std::array::from_fn(|_| random.uniform(-1.0, 1.0));
    JointJet { position, velocity: vector(), acceleration: vector(), jerk: vector() }
}

/// The flange's derivatives for a joint motion, against differences of the forward kinematics along it: 300 motions of
/// a chain with all kinds of joints.
#[test]
fn forward_derivatives() {
    let arm = mixed_chain();
    let mut random = Random::new(24);
    for _ in 0..300 {
        let q: [f64; 7] = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let joints = random_joint_jet(&mut random, q);
        let jet = arm.axes(&q).forward_jet(&joints);
        let JointJet { velocity: v, acceleration: a, jerk: j, .. } = joints;
        let at = |t: f64| -> ([f64; 7], JointJet<7>) {
            let position = std::array::from_fn(|i| q[i] + t * (v[i] + t * (a[i] / 2.0 + t * j[i] / 6.0)));
            let velocity = std::array::from_fn(|i| v[i] + t * (a[i] + t * j[i] / 2.0));
            let acceleration = std::array::from_fn(|i| a[i] + t * j[i]);
            (position, JointJet { position, velocity, acceleration, jerk: j })
        };
        let along = |t: f64| {
            let (position, joints) = at(t);
            arm.axes(&position).forward_jet(&joints)
        };
        let velocity = difference(|t| along(t).pose.translation.vector, 1e-3);
        assert!((jet.linear[0] - velocity).norm() < 1e-9);
        for order in 0..2 {
            let linear = difference(|t| along(t).linear[order], 1e-3);
            let angular = difference(|t| along(t).angular[order], 1e-3);
            assert!((jet.linear[order + 1] - linear).norm() < 1e-8, "{order}");
            assert!((jet.angular[order + 1] - angular).norm() < 1e-8, "{order}");
        }
        let turning = difference(|t| along(t).pose.rotation * Vector3::x(), 1e-3);
        assert!((jet.angular[0].cross(&(jet.pose.rotation * Vector3::x())) - turning).norm() < 1e-9);
    }
}

/// Joint derivatives → flange derivatives → joint derivatives, both by other means: from the axes forwards, in closed
/// form back. 5,000 motions of each arm that are not near a singularity.
#[test]
fn closed_form_joint_derivatives_invert_the_forward_ones() {
    let mut random = Random::new(25);
    for arm in [models::ar2010(), models::irb2400()] {
        let mut tried = 0;
        while tried < 5_000 {
            let q = random.joints(arm.position_limits());
            let distances = arm.singularity_distances(&q);
            if distances.wrist < 0.1 || distances.elbow < 0.1 || distances.shoulder < 0.1 {
                continue;
            }
            tried += 1;
            check_round_trip(&arm, &random_joint_jet(&mut random, q), 1e-9);
        }
    }
    let scara = models::scara600();
    for _ in 0..5_000 {
        let mut q = random.joints(scara.position_limits());
        if scara.elbow_distance(&q) < 0.1 {
            q[1] = 1.0;
        }
        check_round_trip(&scara, &random_joint_jet(&mut random, q), 1e-10);
    }
}

/// At a distance δ from each singularity, down to 1e-6, the k-th joint derivatives come back to 1e-14/δᵏ: what rounding
/// alone makes of them.
#[test]
fn joint_derivatives_beside_singularities() {
    let arm = models::ar2010();
    let g = arm.geometry();
    let stretched = FRAC_PI_2 + g.elbow_offset.atan2(g.forearm);
    let q = [0.3, 0.4, 0.5, 0.6, -0.7, 0.8];
    // Joint 2 that brings the wrist centre onto axis 1, by bisection.
    let radius = |q2: f64| {
        let centre = arm.axes(&moved(&q, 1, q2 - q[1])).axes[4].point;
        centre.x * q[0].cos() + centre.y * q[0].sin()
    };
    let (mut low, mut high) = (-2.5, 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if radius(middle) < 0.0 { low = middle } else { high = middle }
    }
    let mut random = Random::new(29);
    for exponent in 1..=6 {
        let delta = 10.0_f64.powi(-exponent);
        for (axis, singular) in [(4, 0.0), (2, stretched), (1, low)] {
            for sign in [-1.0, 1.0] {
                let mut position = q;
                position[axis] = singular + sign * delta;
                let joints = random_joint_jet(&mut random, position);
                let motion = arm.axes(&position).forward_jet(&joints);
                let back = arm.joint_jet(&motion, &position).unwrap();
                for (k, (got, expected)) in [
                    (back.velocity, joints.velocity),
                    (back.acceleration, joints.acceleration),
                    (back.jerk, joints.jerk),
                ]
                .iter()
                .enumerate()
                {
                    let error = joint_error(got, expected);
                    let bound = 1e-14 / delta.powi(k as i32 + 1);
                    assert!(error < bound, "joint {axis} at {delta:e}, order {}: {error:e}", k + 1);
                }
            }
        }
    }
}

/// The same through the general chain's solution by the Jacobian: 2,000 motions of `ur5e`.
#[test]
fn numeric_joint_derivatives_invert_the_forward_ones() {
    let mut random = Random::new(26);
    let arm = models::ur5e();
    let mut tried = 0;
    while tried < 2_000 {
        let q = random.joints(arm.position_limits());
        if SingularValues::of(&arm.axes(&q).jacobian(), 1.0).condition_number() > 50.0 {
            continue;
        }
        tried += 1;
        check_round_trip(&arm, &random_joint_jet(&mut random, q), 1e-10);
    }
}

fn check_round_trip<const N: usize>(arm: &impl Kinematics<N>, joints: &JointJet<N>, tolerance: f64) {
    let motion: PoseJet = arm.axes(&joints.position).forward_jet(joints);
    let back = arm.joint_jet(&motion, &joints.position).unwrap();
    for axis in 0..N {
        let error = (back.velocity[axis] - joints.velocity[axis]).abs()
            + (back.acceleration[axis] - joints.acceleration[axis]).abs()
            + (back.jerk[axis] - joints.jerk[axis]).abs();
        assert!(error < tolerance, "joint {axis} {error:e}: {joints:?} {back:?}");
    }
}

/// A redundant arm takes the shortest joint velocity, and the flange still moves as asked.
#[test]
fn seven_joints_follow_a_motion() {
    let arm = mixed_chain();
    let mut random = Random::new(27);
    for _ in 0..500 {
        let q: [f64; 7] = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let motion = arm.axes(&q).forward_jet(&random_joint_jet(&mut random, q));
        let joints = arm.joint_jet(&motion, &q).unwrap();
        let again = arm.axes(&q).forward_jet(&joints);
        for order in 0..3 {
            assert!((again.linear[order] - motion.linear[order]).norm() < 1e-9);
            assert!((again.angular[order] - motion.angular[order]).norm() < 1e-9);
        }
    }
}

/// Against nalgebra's own decomposition and determinant, 500 poses; and at a singular pose.
#[test]
fn singular_values_and_manipulability() {
    let arm = models::ar2010();
    let mut random = Random::new(28);
    for _ in 0..500 {
        let jacobian: Matrix6<f64> = arm.axes(&random.joints(arm.position_limits())).jacobian();
        let ours = SingularValues::of(&jacobian, 1.0);
        let theirs = jacobian.svd(false, false).singular_values;
        for (a, b) in ours.as_slice().iter().zip(theirs.iter()) {
            assert!((a - b).abs() < 1e-13, "{ours:?} {theirs}");
        }
        assert!((ours.manipulability() - jacobian.determinant().abs()).abs() < 1e-13);
        assert!(
            (ours.condition_number() - theirs[0] / theirs[5]).abs() < 1e-9 * ours.condition_number().powi(2)
        );
    }
    let pole = SingularValues::of(&arm.axes(&[0.1, 0.2, 0.3, 0.4, 0.0, 0.5]).jacobian(), 1.0);
    assert!(pole.condition_number() > 1e15 && pole.manipulability() < 1e-15);
    let seven = mixed_chain().axes(&[0.1; 7]).jacobian();
    let theirs = seven.transpose().svd(false, false).singular_values;
    for (a, b) in SingularValues::of(&seven, 1.0).as_slice().iter().zip(theirs.iter()) {
        assert!((a - b).abs() < 1e-13);
    }
}

#[test]
fn distances_name_each_singularity() {
    let arm = models::ar2010();
    let distances = arm.singularity_distances(&[0.3, 0.2, 0.1, 1.0, 0.4, 2.0]);
    assert!((distances.wrist - 0.4_f64.sin()).abs() < 1e-15);
    // At zero the forearm leans 0.2 m up over 1.082 m, square to the upper arm.
    let at_zero = arm.singularity_distances(&[0.0; 6]);
    assert_eq!(at_zero.wrist, 0.0);
    assert!((at_zero.elbow - (FRAC_PI_2 - 0.2_f64.atan2(1.082)).sin()).abs() < 1e-15);
    assert!((at_zero.shoulder - 1.232).abs() < 1e-15);
}
