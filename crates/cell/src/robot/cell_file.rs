//! The arm of a cell file: the model from wherever the file says, the limits from the file.

use seamline::kinematics::{DhRow, JointKind};

use super::{ArmDescription, ArmError, Chain, Joint, Structure};
use crate::cell::{self, DhTable, Robot, RobotModel};

impl ArmDescription {
    /// The arm of a cell, within the cell's soft limits.
    ///
    /// # Errors
    /// [`ArmError`] for a URDF file that is wrong, or does not fit the cell's joints.
    pub fn from_cell(robot: &Robot) -> Result<Self, ArmError> {
        let structure = match &robot.model {
            RobotModel::BuiltIn(built_in) => Self::built_in(*built_in).fitting(robot)?,
            RobotModel::Urdf(source) => Self::from_urdf(source)?.fitting(robot)?,
            RobotModel::Opw(parameters) => Structure::SphericalWrist(parameters.geometry()),
            RobotModel::Dh(table) => Structure::Chain(dh_chain(table, robot)),
        };
        let joints = robot.joints.iter().map(joint).collect();
        Ok(Self { name: robot.name.clone(), joints, structure })
    }

    /// The structure, if the cell's joints are as many and of the same kinds.
    fn fitting(self, robot: &Robot) -> Result<Structure, ArmError> {
        let (found, expected) = (self.joints.len(), robot.joints.len());
        if found != expected {
            return Err(ArmError::JointCount { found, expected });
        }
        for (model, cell) in self.joints.iter().zip(&robot.joints) {
            if model.kind != cell.kind {
                let (name, model, cell) = (cell.name.clone(), kind_name(model.kind), kind_name(cell.kind));
                return Err(ArmError::JointKind { name, model, cell });
            }
        }
        Ok(self.structure)
    }
}

fn dh_chain(table: &DhTable, robot: &Robot) -> Chain {
    let row = |(row, joint): (&cell::DhRow, &cell::Joint)| {
        let cell::DhRow { a, alpha, d, theta } = *row;
        DhRow { a, alpha, d, theta, kind: joint.kind }
    };
    Chain::Dh { convention: table.convention, rows: table.rows.iter().zip(&robot.joints).map(row).collect() }
}

fn joint(joint: &cell::Joint) -> Joint {
    let (position_min, position_max) = joint.soft_limits();
    Joint {
        name: joint.name.clone(),
        kind: joint.kind,
        position_min,
        position_max,
        velocity_max: joint.velocity,
    }
}

/// The kind as cell files write it.
fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    }
}
