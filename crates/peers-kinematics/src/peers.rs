//! The peers, each with the IRB 2400 by its own means.

use k::nalgebra as na;
use k::prelude::InverseKinematicsSolver;
use rs_opw_kinematics::constraints::{BY_PREV, Constraints};
use rs_opw_kinematics::glam::{DQuat, DVec3};
use rs_opw_kinematics::jacobian::Jacobian;
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose as OpwPose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use seamline::geometry::Pose;

/// rs-opw-kinematics.
pub struct Opw {
    free: OPWKinematics,
    limited: OPWKinematics,
}

impl Opw {
    pub fn irb2400(limits: &[(f64, f64); 6]) -> Self {
        let constraints = Constraints::new(limits.map(|l| l.0), limits.map(|l| l.1), BY_PREV);
        Self {
            free: OPWKinematics::new(Parameters::irb2400_10()),
            limited: OPWKinematics::new_with_constraints(Parameters::irb2400_10(), constraints),
        }
    }

    pub fn forward(&self, q: &[f64; 6]) -> [f64; 3] {
        self.free.forward(q).translation.to_array()
    }

    pub fn jacobian(&self, q: &[f64; 6]) -> Jacobian {
        Jacobian::new(&self.free, q, 1e-6)
    }

    pub fn inverse(&self, pose: &Pose) -> Vec<[f64; 6]> {
        self.free.inverse(&opw_pose(pose))
    }

    pub fn inverse_nearest(&self, pose: &Pose, seed: &[f64; 6]) -> Option<[f64; 6]> {
        self.limited.inverse_continuing(&opw_pose(pose), seed).first().copied()
    }
}

fn opw_pose(pose: &Pose) -> OpwPose {
    let [x, y, z] = pose.translation.vector.into();
    let rotation = pose.rotation.coords;
    OpwPose::from_parts(DVec3::new(x, y, z), DQuat::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w))
}

/// k.
pub struct General {
    chain: k::SerialChain<f64>,
    solver: k::JacobianIkSolver<f64>,
}

impl General {
    pub fn irb2400() -> Self {
        let (x, y, z) = (na::Vector3::x_axis(), na::Vector3::y_axis(), na::Vector3::z_axis());
        let joints = [
            (z, [0.0, 0.0, 0.0]),
            (y, [0.100, 0.0, 0.615]),
            (y, [0.0, 0.0, 0.705]),
            (x, [0.0, 0.0, 0.135]),
            (y, [0.755, 0.0, 0.0]),
            (x, [0.085, 0.0, 0.0]),
        ];
        let nodes: Vec<k::Node<f64>> = joints
            .iter()
            .enumerate()
            .map(|(i, (axis, at))| {
                let builder = k::NodeBuilder::new()
                    .name(&format!("joint{}", i + 1))
                    .joint_type(k::JointType::Rotational { axis: *axis })
                    .translation(na::Translation3::new(at[0], at[1], at[2]));
                k::Node::from(builder.finalize())
            })
            .collect();
        let tool = k::NodeBuilder::new()
            .name("tool")
            .joint_type(k::JointType::Fixed)
            .rotation(na::UnitQuaternion::from_axis_angle(&y, std::f64::consts::FRAC_PI_2));
        let tool = k::Node::from(tool.finalize());
        for pair in nodes.windows(2) {
            pair[1].set_parent(&pair[0]);
        }
        tool.set_parent(&nodes[5]);
        let chain = k::SerialChain::from_end(&tool);
        Self { chain, solver: k::JacobianIkSolver::new(1e-4, 1e-4, 1.0, 50) }
    }

    pub fn forward(&self, q: &[f64; 6]) -> na::Isometry3<f64> {
        self.chain.set_joint_positions_unchecked(q);
        self.chain.end_transform()
    }

    pub fn jacobian(&self, q: &[f64; 6]) -> na::DMatrix<f64> {
        self.chain.set_joint_positions_unchecked(q);
        k::jacobian(&self.chain)
    }

    /// Whether it arrives.
    pub fn solve(&self, pose: &Pose, seed: &[f64; 6]) -> bool {
        let [x, y, z] = pose.translation.vector.into();
        let c = pose.rotation.coords;
        let rotation = na::UnitQuaternion::new_unchecked(na::Quaternion::new(c.w, c.x, c.y, c.z));
        let target = na::Isometry3::from_parts(na::Translation3::new(x, y, z), rotation);
        self.chain.set_joint_positions_unchecked(seed);
        self.solver.solve(&self.chain, &target).is_ok()
    }
}
