//! From steps of a job to blocks for the cycle.

use seamline::control::{Block, Command, Motion};
use seamline::geometry::Pose;
use seamline::otg::{Input, Limits, State, Synchronization, calculate};

use super::arm::{Arm, PlanningArm};
use super::error::{PlanError, Problem};
use super::resolve::{self, Goal, ToolPose, goal};
use super::speed;
use super::tool_path;
use super::workspace;
use crate::cell::Cell;
use crate::job::{Action, ArcCondition, ArcPart, Frame, Location, Move, MovePath, Note, Speed, Step};
use crate::record::{SegmentInfo, SegmentKind};

/// What a step becomes.
#[derive(Debug, Clone, Default)]
pub struct Planned<const N: usize> {
    /// For the cycle's queue, in this order.
    pub commands: Vec<Command<N>>,
    /// What the motion is held against afterwards.
    pub segment: Option<SegmentInfo>,
    /// What the operator should know.
    pub notices: Vec<String>,
    /// Duration at full override, in seconds.
    pub duration: f64,
}

/// The planner's place in a job: what the next step starts from.
#[derive(Debug, Clone)]
pub struct Planner<'a, const N: usize, K> {
    pub(super) arm: &'a Arm<N, K>,
    pub(super) cell: &'a Cell,
    /// Where the arm is when all planned commands are done.
    pub(super) joints: [f64; N],
    pub(super) tool: ToolPose,
    pub(super) arc: bool,
    segment: u32,
}

impl<'a, const N: usize, K: PlanningArm<N>> Planner<'a, N, K> {
    /// Begins with the arm at rest at `joints`.
    ///
    /// # Errors
    /// [`Problem::UnknownTool`] where the cell has no tool 0.
    pub fn new(arm: &'a Arm<N, K>, cell: &'a Cell, joints: [f64; N]) -> Result<Self, Problem> {
        Ok(Self { arm, cell, joints, tool: ToolPose::of(cell, 0)?, arc: false, segment: 0 })
    }

    /// The joints when all that is planned is done.
    #[must_use]
    pub fn joints(&self) -> &[f64; N] {
        &self.joints
    }

    /// Tool centre point in the flange frame, of the tool last used.
    #[must_use]
    pub fn flange_from_tcp(&self) -> &Pose {
        &self.tool.flange_from_tcp
    }

    /// The commands of a step. Steps that neither move nor take time (outputs, messages) have none.
    ///
    /// # Errors
    /// [`PlanError`] with the line; the planner then still stands where it was.
    pub fn plan(&mut self, step: &Step) -> Result<Planned<N>, PlanError> {
        let before = self.clone();
        let result = self.plan_action(step);
        result.map_err(|problem| {
            *self = before;
            PlanError { at: step.at.clone(), problem }
        })
    }

    /// Goes on from a step's target as if it had been reached, where the target has joints.
    pub fn skip(&mut self, step: &Step) {
        let Action::Move(r#move) = &step.action else { return };
        let target = goal(&r#move.target, self.cell, self.arm, &self.joints);
        if let Ok(Goal { joints: Ok(joints), tool, .. }) = target {
            (self.joints, self.tool) = (joints, tool);
        }
    }

    fn plan_action(&mut self, step: &Step) -> Result<Planned<N>, Problem> {
        let mut planned = match &step.action {
            Action::Move(r#move) => self.plan_move(&step.at, r#move)?,
            Action::ArcOn(condition) => self.arc_on(&step.at, condition)?,
            Action::ArcOff(condition) => self.arc_off(&step.at, condition)?,
            Action::Dwell { seconds } => self.dwell(&step.at, *seconds),
            Action::Unsupported { text, reason } => {
                return Err(Problem::Refused { text: text.clone(), reason: reason.clone() });
            }
            _ => Planned::default(),
        };
        planned.notices.splice(0..0, step.notes.iter().map(Note::to_string));
        Ok(planned)
    }

    fn next_segment(&mut self) -> u32 {
        self.segment += 1;
        self.segment
    }

    fn dwell(&mut self, at: &Location, duration: f64) -> Planned<N> {
        let segment = self.next_segment();
        let info = SegmentInfo {
            segment,
            line: at.line,
            kind: SegmentKind::Dwell,
            speed: None,
            arc: self.arc,
            constant_part: None,
        };
        let commands = vec![Command::Dwell { line: at.line, segment, duration }];
        Planned { commands, segment: Some(info), notices: Vec::new(), duration }
    }

    /// Gas, then the arc, then the time to form the pool.
    fn arc_on(&mut self, at: &Location, condition: &ArcCondition) -> Result<Planned<N>, Problem> {
        let file = condition.file.map(|number| {
            let missing = Problem::UnknownCondition { kind: "ASF", number, table: "[[arc_start]]" };
            self.cell.arc_start(number).ok_or(missing)
        });
        let file = file.transpose()?;
        let preflow = file.map_or(0.0, |file| file.gas_preflow);
        let hold = condition.seconds.or(file.map(|file| file.dwell)).unwrap_or(0.0);
        let mut planned = self.dwell(at, preflow);
        planned.commands.push(Command::Arc { on: true });
        self.arc = true;
        let hold = self.dwell(at, hold);
        planned.commands.extend(hold.commands);
        planned.duration += hold.duration;
        planned.segment = hold.segment;
        Ok(planned)
    }

    /// The time to fill the crater, then the arc out.
    fn arc_off(&mut self, at: &Location, condition: &ArcCondition) -> Result<Planned<N>, Problem> {
        let file = condition.file.map(|number| {
            let missing = Problem::UnknownCondition { kind: "AEF", number, table: "[[arc_end]]" };
            self.cell.arc_end(number).ok_or(missing)
        });
        let crater = condition.seconds.or(file.transpose()?.map(|file| file.crater_dwell)).unwrap_or(0.0);
        let mut planned = self.dwell(at, crater);
        planned.commands.push(Command::Arc { on: false });
        self.arc = false;
        Ok(planned)
    }

    fn plan_move(&mut self, at: &Location, r#move: &Move) -> Result<Planned<N>, Problem> {
        let target = |target| goal(target, self.cell, self.arm, &self.joints);
        match &r#move.path {
            MovePath::Joint => {
                let goal = target(&r#move.target)?;
                self.joint_move(at, r#move, &goal)
            }
            MovePath::Linear => {
                let goal = target(&r#move.target)?;
                self.tool = goal.tool;
                let path = tool_path::line(&self.pose(), &goal.base_from_tcp);
                self.path_move(at, r#move, &path, Some(&goal))
            }
            MovePath::Circular(arc) => {
                let [first, second, third] = &arc.points;
                let goals = [target(first)?, target(second)?, target(third)?];
                self.circular_move(at, r#move, &goals, arc.part)
            }
            MovePath::Incremental { frame } => self.incremental_move(at, r#move, *frame),
            MovePath::Spline => {
                let reason = "spline moves are not executed yet".into();
                Err(Problem::Refused { text: format!("MOVS {}", r#move.target.name), reason })
            }
        }
    }

    /// A piece of the circle through three points; straight where they do not give a circle.
    fn circular_move(
        &mut self,
        at: &Location,
        r#move: &Move,
        goals: &[Goal<N>; 3],
        part: ArcPart,
    ) -> Result<Planned<N>, Problem> {
        self.tool = goals[2].tool;
        let poses = goals.each_ref().map(|goal| goal.base_from_tcp);
        let (path, straight) = tool_path::arc(&self.pose(), &poses, part);
        let end = if part == ArcPart::First { &goals[1] } else { &goals[2] };
        let mut planned = self.path_move(at, r#move, &path, Some(end))?;
        if straight {
            planned
                .notices
                .push("the three points of the arc lie on one line: the robot goes straight".into());
        }
        Ok(planned)
    }

    /// A line by an increment: in a frame, or joint by joint in pulses.
    fn incremental_move(
        &mut self,
        at: &Location,
        r#move: &Move,
        frame: Option<Frame>,
    ) -> Result<Planned<N>, Problem> {
        let end = match frame {
            Some(frame) => tool_path::increment(&self.pose(), &r#move.target, frame, self.cell)?,
            None => {
                let joints = resolve::pulse_increment(&r#move.target, self.arm, &self.joints)?;
                self.arm.kinematics.forward(&joints) * self.tool.flange_from_tcp
            }
        };
        let path = tool_path::line(&self.pose(), &end);
        self.path_move(at, r#move, &path, None)
    }

    /// The tool centre point where the plan stands.
    pub(super) fn pose(&self) -> Pose {
        self.arm.kinematics.forward(&self.joints) * self.tool.flange_from_tcp
    }

    /// All joints together, each within its own limits.
    fn joint_move(&mut self, at: &Location, r#move: &Move, goal: &Goal<N>) -> Result<Planned<N>, Problem> {
        let name = || r#move.target.name.to_string();
        let target = goal.joints.map_err(|error| Problem::Unreachable { name: name(), error })?;
        let Speed::JointPercent(percent) = r#move.speed else {
            return Err(Problem::Speed { found: speed::tag(&r#move.speed), expected: "VJ=" });
        };
        let input = joint_input(&self.arm.limits, &self.joints, &target, percent / 100.0, r#move);
        let trajectory = calculate(&input)
            .map_err(|error| Problem::Generator { name: name(), reason: error.to_string() })?;
        let tool = &goal.tool.flange_from_tcp;
        workspace::check_joint_move(&trajectory, &self.arm.kinematics, tool, &self.cell.safety)?;
        let segment = self.next_segment();
        let block = Block {
            line: at.line,
            segment,
            flange_from_tcp: goal.tool.flange_from_tcp,
            starts_at_rest: true,
            ends_at_rest: true,
            motion: Motion::Joint(trajectory),
        };
        let info = SegmentInfo {
            segment,
            line: at.line,
            kind: SegmentKind::Joint,
            speed: None,
            arc: self.arc,
            constant_part: None,
        };
        self.joints = target;
        self.tool = goal.tool;
        let commands = vec![Command::Move(block)];
        Ok(Planned { commands, segment: Some(info), notices: Vec::new(), duration: trajectory.duration() })
    }

    pub(super) fn number_segment(&mut self) -> u32 {
        self.next_segment()
    }
}

/// Rest to rest at a share of the joints' speeds. ACC and DEC are shares too; which side of the acceleration limits
/// they mean depends on the joint's direction.
fn joint_input<const N: usize>(
    limits: &seamline::safety::MotionLimits<N>,
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
    input.synchronization = [Synchronization::Time; N];
    input
}
