//! The cell as a job sees it: inputs, positions, conditions.

use seamline::geometry::Pose;

use crate::cell::{Cell, WeldSpeedRule};
use crate::gcode::Setup;
use crate::job::{
    ArcCondition, Coordinates, Frame, JobPosition, Rectangular, SignalKind, Speed, World, joints_from_pulses,
    pulses_from_joints,
};
use crate::plan::{Arm, PlanningArm};

/// The cell at one instant of a run.
#[derive(Debug, Clone)]
pub(super) struct CellWorld<'a, const N: usize, K> {
    pub(super) cell: &'a Cell,
    pub(super) arm: &'a Arm<N, K>,
    /// Seconds since the start of the job.
    pub(super) time: f64,
    /// Where the arm is when all steps so far are done.
    pub(super) joints: [f64; N],
    /// Inputs and positions read so far: a job that reads none may be planned ahead.
    pub(super) inputs_read: u64,
    /// An input that the cell refuses to be read.
    pub(super) refused: Option<u32>,
}

impl<'a, const N: usize, K: PlanningArm<N>> CellWorld<'a, N, K> {
    pub(super) fn new(cell: &'a Cell, arm: &'a Arm<N, K>) -> Self {
        Self { cell, arm, time: 0.0, joints: arm.home, inputs_read: 0, refused: None }
    }

    /// What G-code leaves to the cell: G54 to G59 are its user frames 1 to 6.
    pub(super) fn gcode_setup(&self) -> Setup {
        let flange_from_tcp = self.flange_from_tcp(0).unwrap_or_else(Pose::identity);
        let frame = |number: u32| self.cell.user_frame(number).map(|frame| frame.base_from_user);
        Setup {
            frames: [1, 2, 3, 4, 5, 6].map(frame),
            start: self.arm.kinematics.forward(&self.joints) * flange_from_tcp,
            configuration: self.arm.kinematics.configuration(&self.joints),
            rapid_mm_s: self.cell.cartesian.speed * 1000.0,
            joint_percent: self.cell.job.joint_speed * 100.0,
            tolerance_mm: self.cell.job.corner_error * 1000.0,
        }
    }

    fn single(&mut self, number: u32) -> u32 {
        match self.cell.io.at(number, self.time) {
            Some(value) => u32::from(value),
            None => {
                self.refused = self.refused.or(Some(number));
                0
            }
        }
    }

    /// `count` inputs from `first` on as bits, the first one lowest.
    fn group(&mut self, first: u32, count: u32) -> u32 {
        (0..count).fold(0, |bits, k| bits | self.single(first.saturating_add(k)) << k)
    }

    fn base_from_frame(&self, frame: Frame) -> Option<Pose> {
        match frame {
            Frame::Base | Frame::Robot => Some(Pose::identity()),
            Frame::User(number) => self.cell.user_frame(number).map(|frame| frame.base_from_user),
            Frame::Tool | Frame::MasterTool => None,
        }
    }

    fn flange_from_tcp(&self, tool: u32) -> Option<Pose> {
        self.cell.tool(tool).map(|tool| tool.flange_from_tcp)
    }

    fn base_from_flange(&self, position: &JobPosition) -> Option<Pose> {
        match &position.coordinates {
            Coordinates::Pulses(pulses) => {
                let joints = joints_from_pulses(pulses, &self.arm.pulses_per_unit)?;
                Some(self.arm.kinematics.forward(&joints))
            }
            Coordinates::Rectangular(rectangular) => {
                let base_from_tcp = self.base_from_frame(rectangular.frame)? * rectangular.pose();
                Some(base_from_tcp * self.flange_from_tcp(position.tool)?.inverse())
            }
            Coordinates::Angles(_) => None,
        }
    }
}

impl<const N: usize, K: PlanningArm<N>> World for CellWorld<'_, N, K> {
    fn input(&mut self, kind: SignalKind, number: u32) -> u32 {
        self.inputs_read += 1;
        let group = |size: u32| number.saturating_sub(1).saturating_mul(size).saturating_add(1);
        match kind {
            SignalKind::Input => self.single(number),
            SignalKind::InputGroup => self.group(group(8), 8),
            SignalKind::InputHalfGroup => self.group(group(4), 4),
            // Signals that no script of the cell describes: off.
            _ => 0,
        }
    }

    fn current_position(&mut self) -> Option<JobPosition> {
        self.inputs_read += 1;
        let pulses = pulses_from_joints(&self.joints, &self.arm.pulses_per_unit);
        Some(JobPosition { coordinates: Coordinates::Pulses(pulses), tool: 0 })
    }

    fn convert(&mut self, position: &JobPosition, frame: Frame, tool: u32) -> Option<JobPosition> {
        let base_from_flange = self.base_from_flange(position)?;
        let frame_from_tcp =
            self.base_from_frame(frame)?.inverse() * base_from_flange * self.flange_from_tcp(tool)?;
        let joints = self.arm.kinematics.inverse_nearest(&base_from_flange, &self.joints).ok()?;
        let configuration = self.arm.kinematics.configuration(&joints);
        let rectangular = Rectangular::from_pose(&frame_from_tcp, frame, configuration);
        Some(JobPosition { coordinates: Coordinates::Rectangular(rectangular), tool })
    }

    fn arc_speed_mm_s(&mut self, condition: &ArcCondition) -> Option<f64> {
        if self.cell.job.weld_speed == WeldSpeedRule::LastMove {
            return condition.speed_mm_s;
        }
        let file = condition.file.and_then(|number| self.cell.arc_start(number));
        condition.speed_mm_s.or(file.map(|file| file.speed * 1000.0))
    }

    fn default_speed(&mut self, joint: bool) -> Option<Speed> {
        let rules = &self.cell.job;
        Some(if joint {
            Speed::JointPercent(rules.joint_speed * 100.0)
        } else {
            Speed::Linear { mm_s: rules.speed * 1000.0 }
        })
    }
}
