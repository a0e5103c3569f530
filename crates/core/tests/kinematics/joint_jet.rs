//! Joint derivatives along a moving pose.

use seamline::geometry::{Pose, PoseJet, Rotation, Vector3};
use seamline::kinematics::{InverseError, JointJet, Kinematics, Singularity, models};

use crate::support::{Random, joint_error, pose_error};

fn random_jet(random: &mut Random, pose: Pose) -> PoseJet {
    PoseJet {
        pose,
        linear: [random.vector(1.0), random.vector(1.0), random.vector(1.0)],
        angular: [random.vector(1.0), random.vector(1.0), random.vector(1.0)],
    }
}

/// The pose at t of a motion with this jet at 0, up to O(t⁴): the position's polynomial, and the rotation by the
/// first terms of its Magnus series.
fn pose_at(jet: &PoseJet, t: f64) -> Pose {
    let [v, a, j] = jet.linear;
    let [w, dw, ddw] = jet.angular;
    let position = jet.pose.translation.vector + v * t + a * (t * t / 2.0) + j * (t * t * t / 6.0);
    let turn = w * t + dw * (t * t / 2.0) + ddw * (t * t * t / 6.0) + dw.cross(&w) * (t * t * t / 12.0);
    Pose::from_parts(position.into(), Rotation::from_scaled_axis(turn) * jet.pose.rotation)
}

fn joints_at<const N: usize>(jet: &JointJet<N>, t: f64) -> [f64; N] {
    std::array::from_fn(|i| {
        jet.position[i] + t * (jet.velocity[i] + t * (jet.acceleration[i] / 2.0 + t * jet.jerk[i] / 6.0))
    })
}

/// 3,000 random motions through random poses: the flange of the joints' cubic departs from the motion with the fourth
/// power of time, so that nothing is wrong up to the third derivative.
#[test]
fn the_joints_follow_the_motion_to_third_order() {
    let arm = models::ar2010();
    let mut random = Random::new(11);
    let mut tried = 0;
    while tried < 3_000 {
        let q = random.joints(arm.position_limits());
        let motion = random_jet(&mut random, arm.forward(&q));
        let jet = arm.joint_jet(&motion, &q).unwrap();
        let fastest = jet.velocity.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        if fastest > 20.0 {
            continue;
        }
        tried += 1;
        let error = |t: f64| {
            let (distance, angle) = pose_error(&arm.forward(&joints_at(&jet, t)), &pose_at(&motion, t));
            distance + angle
        };
        let h = 2e-2 / (1.0 + fastest);
        let (coarse, fine) = (error(h).max(error(-h)), error(h / 4.0).max(error(-h / 4.0)));
        assert!(fine < coarse / 128.0 + 1e-14, "{q:?}: {coarse:e} {fine:e}");
    }
}

/// The zero pose of this arm is a wrist singularity: standing there is no fault, moving the wrist off it is.
#[test]
fn at_rest_and_at_a_singularity() {
    let arm = models::ar2010();
    let home = [0.0; 6];
    let pose = arm.forward(&home);
    assert_eq!(arm.joint_jet(&PoseJet::at_rest(pose), &home), Ok(JointJet::at_rest(home)));
    let mut sideways = PoseJet::at_rest(pose);
    sideways.linear[0] = Vector3::y();
    assert_eq!(
        arm.joint_jet(&sideways, &home),
        Err(InverseError::Singular { singularity: Singularity::Wrist, distance: 0.0 })
    );
    // A turn about axis 1 carries the straight wrist along.
    let mut about_axis_1 = PoseJet::at_rest(pose);
    about_axis_1.angular[0] = Vector3::z();
    let p = pose.translation.vector;
    about_axis_1.linear =
        [Vector3::z().cross(&p), Vector3::z().cross(&Vector3::z().cross(&p)), -Vector3::z().cross(&p)];
    let jet = arm.joint_jet(&about_axis_1, &home).unwrap();
    let only_axis_1 = JointJet { velocity: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], ..JointJet::at_rest(home) };
    for (got, expected) in [
        (jet.velocity, only_axis_1.velocity),
        (jet.acceleration, only_axis_1.acceleration),
        (jet.jerk, only_axis_1.jerk),
    ] {
        for (g, e) in got.iter().zip(expected) {
            assert!((g - e).abs() < 1e-12, "{jet:?}");
        }
    }
}

#[test]
fn stretched_arm_and_wrist_centre_on_axis_1() {
    let arm = models::ar2010();
    let g = arm.geometry();
    // θ₃ = −ψ stretches the arm; q₃ = ½π − θ₃.
    let mut stretched = [0.2, 0.4, 0.0, 0.3, -0.9, 0.1];
    stretched[2] = std::f64::consts::FRAC_PI_2 + g.elbow_offset.atan2(g.forearm);
    let mut outward = PoseJet::at_rest(arm.forward(&stretched));
    assert_eq!(arm.joint_jet(&outward, &stretched), Ok(JointJet::at_rest(stretched)));
    outward.linear[0] = Vector3::x();
    let error = arm.joint_jet(&outward, &stretched);
    assert!(
        matches!(error, Err(InverseError::Singular { singularity: Singularity::Elbow, .. })),
        "{error:?}"
    );
    // θ₂ such that the upper arm and the line to the wrist end above axis 1: a₁ + c₂ sin θ₂ + … = 0 by Newton.
    let mut over_head = [0.2, -0.5, 0.4, 0.3, -0.9, 0.1];
    for _ in 0..20 {
        let axes = arm.axes(&over_head);
        let centre = axes.axes[4].point;
        let out = centre.x * 0.2_f64.cos() + centre.y * 0.2_f64.sin();
        over_head[1] -= out / (centre.z - axes.axes[1].point.z);
    }
    let mut sideways = PoseJet::at_rest(arm.forward(&over_head));
    assert_eq!(arm.joint_jet(&sideways, &over_head), Ok(JointJet::at_rest(over_head)));
    sideways.linear[0] = Vector3::x();
    let error = arm.joint_jet(&sideways, &over_head);
    assert!(
        matches!(error, Err(InverseError::Singular { singularity: Singularity::Shoulder, .. })),
        "{error:?}"
    );
}

/// An arm that moves in its own plane passes the wrist's pole and axis 1 without noticing: joints 1, 4 and 6 rest, and
/// all derivatives exist, at the singularity and beside it.
#[test]
fn in_its_own_plane_an_arm_passes_its_singularities() {
    let arm = models::ar2010();
    let joints = |q2: f64, q5: f64| JointJet {
        position: [0.0, q2, 0.4, 0.0, q5, 0.0],
        velocity: [0.0, 0.3, -0.2, 0.0, 0.7, 0.0],
        acceleration: [0.0, -0.4, 0.1, 0.0, 0.2, 0.0],
        jerk: [0.0, 0.1, 0.5, 0.0, -0.3, 0.0],
    };
    // Joint 2 with the wrist centre over axis 1.
    let mut over_head = -0.5;
    for _ in 0..20 {
        let axes = arm.axes(&joints(over_head, 0.3).position).axes;
        over_head -= axes[4].point.x / (axes[4].point.z - axes[1].point.z);
    }
    for offset in [0.0, 1e-15, 1e-12, 1e-9, -1e-6, 1e-3] {
        for joints in [joints(0.2, offset), joints(over_head + offset, 0.3), joints(over_head, offset)] {
            let motion = arm.axes(&joints.position).forward_jet(&joints);
            let back = arm.joint_jet(&motion, &joints.position).unwrap();
            for (got, expected) in [
                (back.velocity, joints.velocity),
                (back.acceleration, joints.acceleration),
                (back.jerk, joints.jerk),
            ] {
                assert!(joint_error(&got, &expected) < 1e-11, "{offset:e} {back:?}");
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let arm = models::ar2010();
    let q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let mut motion = PoseJet::at_rest(arm.forward(&q));
    motion.angular[2].y = f64::NAN;
    assert_eq!(arm.joint_jet(&motion, &q), Err(InverseError::NotFinite));
    assert_eq!(models::ur5e().joint_jet(&motion, &q), Err(InverseError::NotFinite));
    assert_eq!(models::scara600().joint_jet(&motion, &[0.1; 4]), Err(InverseError::NotFinite));
}
