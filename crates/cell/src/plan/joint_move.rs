//! Joint moves: planned from rest to rest, and handed out once it is known whether the next one lets them run on.

use seamline::control::{Block, Command, Motion, TrajectoryMotion};
use seamline::otg::{Input, Limits, State, Synchronization, calculate};
use seamline::safety::MotionLimits;

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::joint_corner::JointCorner;
use super::planner::{Planned, Planner};
use super::resolve::{ToolPose, goal};
use super::run::Stops;
use super::{speed, tool_path, workspace};
use crate::job::{Move, Speed, Step};
use crate::record::{OnSeam, SegmentInfo, SegmentKind};

/// Why the robot stops before a joint move.
const BEFORE_JOINT_MOVE: &str = "a joint move follows";

const NOT_WOVEN: &str = "MOVJ goes without weave: that is along MOVL and MOVC";

/// A joint move that is planned and not handed out.
#[derive(Debug, Clone)]
pub(super) struct JointMove<const N: usize> {
    pub(super) step: Step,
    segment: u32,
    arc: bool,
    pub(super) tool: ToolPose,
    /// How far from its end the tool may pass; `None` where the move ends at rest.
    pub(super) pass: Option<f64>,
    pub(super) target: [f64; N],
    pub(super) limits: Limits<N>,
    /// What is left of it beside the corner at its beginning.
    pub(super) motion: TrajectoryMotion<N>,
    from_rest: bool,
    /// What the operator should know.
    notice: Option<&'static str>,
    /// Steps that take no time, done when the move is.
    pub(super) after: Vec<Step>,
}

impl<const N: usize> JointMove<N> {
    fn info(&self) -> SegmentInfo {
        SegmentInfo {
            segment: self.segment,
            line: self.step.at.line,
            kind: SegmentKind::Joint,
            speed: None,
            arc: self.arc,
            constant_part: None,
            rounded: [0.0; 2],
            seam: OnSeam::No,
        }
    }

    /// A motion of it; `rests` says whether the arm is at rest where that begins, and where it ends.
    fn hand_out(&self, info: SegmentInfo, motion: TrajectoryMotion<N>, rests: [bool; 2]) -> Planned<N> {
        let block = Block {
            line: info.line,
            segment: info.segment,
            flange_from_tcp: self.tool.flange_from_tcp,
            starts_at_rest: rests[0],
            ends_at_rest: rests[1],
            motion: Motion::Joint(motion),
        };
        let begins = matches!(info.kind, SegmentKind::Joint);
        let mut part = if begins { Planned::of(&self.step) } else { Planned::part(&self.step.at) };
        part.notices.extend(self.notice.filter(|_| begins).map(String::from));
        Planned {
            commands: vec![Command::Move(block)],
            segment: Some(info),
            duration: motion.duration(),
            ..part
        }
    }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// A joint move is planned, and waits for the next step where it may be passed. The one that has waited for it is handed out.
    pub(super) fn take_joint_move(
        &mut self,
        step: &Step,
        r#move: &Move,
        out: &mut Vec<Planned<N>>,
    ) -> Result<(), PlanError> {
        if !self.run.is_empty() {
            self.end_run(Some(Stops(BEFORE_JOINT_MOVE)), out)?;
        }
        let next = match self.joint_move(step, r#move) {
            Ok(next) => next,
            Err(problem) => {
                self.end_run(None, out)?;
                self.waiting.pop_front();
                return Err(self.leave_out(step, problem));
            }
        };
        self.waiting.pop_front();
        let rests = next.pass.is_none();
        match self.held.take() {
            // It is there already.
            Some(before) if next.motion.duration() == 0.0 => self.stay(before, next),
            Some(before) => match self.joint_corner(&before, &next) {
                Ok(corner) => self.run_on(&before, next, &corner, out),
                Err(stops) => {
                    self.held = Some(before);
                    self.end_run(Some(stops), out)?;
                    self.hold(next);
                }
            },
            None => self.hold(next),
        }
        if rests { self.end_run(None, out) } else { Ok(()) }
    }

    fn hold(&mut self, next: JointMove<N>) {
        self.held = Some(JointMove { segment: self.next_segment(), ..next });
    }

    /// A move to where the one that waits leads already does not stop it unless it is to.
    fn stay(&mut self, before: JointMove<N>, next: JointMove<N>) {
        let pass = before.pass.zip(next.pass).map(|(one, other)| one.min(other));
        let mut held = JointMove { pass, ..before };
        held.after.push(next.step);
        self.held = Some(held);
    }

    /// Hands out a move with the corner at its end; what is left of the next one waits.
    fn run_on(
        &mut self,
        before: &JointMove<N>,
        next: JointMove<N>,
        corner: &JointCorner<N>,
        out: &mut Vec<Planned<N>>,
    ) {
        let [left, joined] = corner.left_out;
        let line = before.motion.part(0.0, before.motion.duration() - left);
        out.push(before.hand_out(before.info(), line, [before.from_rest, false]));
        let point = self.arm.kinematics.forward(&before.target) * before.tool.flange_from_tcp;
        let kind = SegmentKind::Corner {
            path: None,
            corner: point.translation.vector,
            permitted: before.pass.unwrap_or(0.0),
        };
        let info = SegmentInfo { segment: self.next_segment(), kind, ..before.info() };
        out.push(before.hand_out(info, TrajectoryMotion::whole(corner.trajectory), [false; 2]));
        out.extend(before.after.iter().map(|step| self.aside(step)));
        let motion = next.motion.part(joined, next.motion.duration());
        self.joints = motion.at_time(0.0).position;
        self.hold(JointMove { motion, from_rest: false, ..next });
    }

    /// Hands out the joint move that waits, up to its end at rest.
    pub(super) fn end_joint_move(&mut self, out: &mut Vec<Planned<N>>) {
        let Some(held) = self.held.take() else { return };
        let planned = held.hand_out(held.info(), held.motion, [held.from_rest, true]);
        let duration = planned.duration + self.run_out();
        out.push(Planned { duration, ..planned });
        out.extend(held.after.iter().map(|step| self.aside(step)));
        self.joints = held.target;
    }

    /// All joints together from rest to rest on a straight line between their positions, each within its own limits.
    fn joint_move(&mut self, step: &Step, r#move: &Move) -> Result<JointMove<N>, Problem> {
        let start = self.held.as_ref().map_or(self.joints, |held| held.target);
        let goal = goal(&r#move.target, self.cell, self.arm, &start)?;
        let name = || r#move.target.to_string();
        let target = goal
            .joints
            .map_err(|error| Problem::Unreachable { name: name(), reason: self.arm.in_words(&error) })?;
        let Speed::JointPercent(percent) = r#move.speed else {
            return Err(Problem::Speed { found: speed::tag(&r#move.speed), expected: "VJ=" });
        };
        let input = joint_input(&self.arm.limits, &start, &target, percent / 100.0, r#move);
        let trajectory = calculate(&input)
            .map_err(|error| Problem::Generator { name: name(), reason: error.to_string() })?;
        let tool = &goal.tool.flange_from_tcp;
        workspace::check_joint_move(&trajectory, &self.arm.kinematics, tool, &self.cell.safety)?;
        self.tool = goal.tool;
        Ok(JointMove {
            step: step.clone(),
            segment: 0,
            arc: self.arc,
            tool: goal.tool,
            pass: tool_path::pass(&r#move.zone, &self.cell.job),
            target,
            limits: input.limits,
            motion: TrajectoryMotion::whole(trajectory),
            from_rest: true,
            notice: self.weave.as_ref().map(|_| NOT_WOVEN),
            after: Vec::new(),
        })
    }
}

/// Rest to rest at a share of the joints' speeds. ACC and DEC are shares too; which side of the acceleration limits
/// they mean depends on the joint's direction.
fn joint_input<const N: usize>(
    limits: &MotionLimits<N>,
    start: &[f64; N],
    target: &[f64; N],
    share: f64,
    r#move: &Move,
) -> Input<N> {
    let mut motion = Limits::symmetric(limits.velocity.map(|v| v * share), limits.acceleration, limits.jerk);
    for joint in 0..N {
        let limit = limits.acceleration[joint];
        let (speeding, slowing) = (limit * r#move.acceleration, limit * r#move.deceleration);
        let forward = target[joint] >= start[joint];
        motion.acceleration_max[joint] = if forward { speeding } else { slowing };
        motion.acceleration_min[joint] = -if forward { slowing } else { speeding };
    }
    let mut input = Input::new(State::at_rest(*start), State::at_rest(*target), motion);
    input.synchronization = [Synchronization::Phase; N];
    input
}
