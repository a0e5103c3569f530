//! From steps of a job to blocks for the cycle.

use std::collections::VecDeque;

use seamline::arc::{ArcSetting, ArcVoltage};
use seamline::control::Command;
use seamline::geometry::Pose;

use super::arm::{Arm, PlanningArm};
use super::error::{PlanError, Problem};
use super::joint_move::JointMove;
use super::pass::{Kept, Memo};
use super::resolve::{self, Goal, ToolPose, goal};
use super::run::{Link, Run, Stops};
use super::speed;
use super::tool_path;
use super::track::Section;
use super::weave::WeaveOrder;
use super::workspace;
use crate::cell::Cell;
use crate::job::{Action, ArcCondition, ArcPart, Frame, Location, Move, MovePath, Step};
use crate::record::{OnSeam, SegmentInfo, SegmentKind};

/// A weave over more pieces of moves than these ends on the way and begins again.
const LONGEST_WEAVE: usize = 2000;

/// What a step, or a part of it, becomes. A step without motion has one of these; a move has several where it is handed over in
/// parts, and one more for the corner at its end.
#[derive(Debug, Clone)]
pub struct Planned<const N: usize> {
    /// The instruction.
    pub at: Location,
    /// What it does, where this is the first of its parts.
    pub action: Option<Action>,
    /// For the cycle's queue, in this order.
    pub commands: Vec<Command<N>>,
    /// What the motion is held against afterwards. One with the number of an earlier one takes its place.
    pub segment: Option<SegmentInfo>,
    /// What the operator should know.
    pub notices: Vec<String>,
    /// Duration at full override, in seconds.
    pub duration: f64,
}

impl<const N: usize> Planned<N> {
    /// The first part of a step.
    pub(super) fn of(step: &Step) -> Self {
        let notices = step.notes.iter().map(ToString::to_string).collect();
        Self { action: Some(step.action.clone()), notices, ..Self::part(&step.at) }
    }

    /// A part of a step, but for the first.
    pub(super) fn part(at: &Location) -> Self {
        let (commands, notices) = (Vec::new(), Vec::new());
        Self { at: at.clone(), action: None, commands, segment: None, notices, duration: 0.0 }
    }

    /// What a move begins with.
    pub(super) fn begin(link: &Link<N>) -> Self {
        let mut planned = Self::of(&link.step);
        planned.notices.extend(link.notices.iter().cloned());
        planned
    }
}

/// The planner's place in a job: what the next step starts from.
///
/// Moves that may run on into the next are held back until enough of the way is known: [`Planner::take`] hands out what is settled, [`Planner::finish`] the rest, which then ends at rest.
#[derive(Debug, Clone)]
pub struct Planner<'a, const N: usize, K> {
    pub(super) arm: &'a Arm<N, K>,
    pub(super) cell: &'a Cell,
    /// Where the arm is when all that was handed out is done.
    pub(super) joints: [f64; N],
    pub(super) tool: ToolPose,
    pub(super) arc: bool,
    /// The weave that is on.
    pub(super) weave: Option<WeaveOrder>,
    /// The next path begins beside where it was taught: a seam was tracked before it.
    pub(super) beside: bool,
    /// Where a seam is tracked.
    pub(super) section: Option<Section<N>>,
    /// Between MEMON and MEMOF; and what is kept.
    pub(super) memo: Option<Memo>,
    pub(super) kept: Kept,
    segment: u32,
    pub(super) run: Run<N>,
    /// A joint move that waits for the step after it; the run is empty then.
    pub(super) held: Option<JointMove<N>>,
    /// Steps taken and not yet looked at.
    pub(super) waiting: VecDeque<Step>,
}

impl<'a, const N: usize, K: PlanningArm<N>> Planner<'a, N, K> {
    /// Begins with the arm at rest at `joints`.
    ///
    /// # Errors
    /// [`Problem::UnknownTool`] where the cell has no tool 0.
    pub fn new(arm: &'a Arm<N, K>, cell: &'a Cell, joints: [f64; N]) -> Result<Self, Problem> {
        let (tool, run) = (ToolPose::of(cell, 0)?, Run::new(&cell.vibration));
        Ok(Self {
            arm,
            cell,
            joints,
            tool,
            arc: false,
            weave: None,
            beside: false,
            section: None,
            memo: None,
            kept: Kept::default(),
            segment: 0,
            run,
            held: None,
            waiting: VecDeque::new(),
        })
    }

    /// The joints when all that was handed out is done.
    #[must_use]
    pub fn joints(&self) -> &[f64; N] {
        &self.joints
    }

    /// Tool centre point in the flange frame, of the tool last used.
    #[must_use]
    pub fn flange_from_tcp(&self) -> &Pose {
        &self.tool.flange_from_tcp
    }

    /// The commands of one step alone, which ends at rest. Steps that neither move nor take time (outputs, messages) have none.
    ///
    /// # Errors
    /// [`PlanError`] with the line; the planner then still stands where it was.
    pub fn plan(&mut self, step: &Step) -> Result<Planned<N>, PlanError> {
        let before = self.clone();
        let mut parts = Vec::new();
        let result = self.take(step, &mut parts).and_then(|()| self.finish(&mut parts));
        if let Err(error) = result {
            *self = before;
            return Err(error);
        }
        let mut whole = Planned::of(step);
        whole.notices.clear();
        for part in parts {
            whole.commands.extend(part.commands);
            whole.notices.extend(part.notices);
            whole.segment = part.segment.or(whole.segment);
            whole.duration += part.duration;
        }
        Ok(whole)
    }

    /// Takes the next step, and hands out what is settled by now.
    ///
    /// # Errors
    /// [`PlanError`] with the line of the step at fault, which need not be this one. What was handed out before stays good; the
    /// next call goes on as if the step at fault had been done, where its target has joints.
    pub fn take(&mut self, step: &Step, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        self.waiting.push_back(step.clone());
        self.take_waiting(out)
    }

    /// Hands out all that is left, ending at rest.
    ///
    /// # Errors
    /// As [`Planner::take`]; then call it again.
    pub fn finish(&mut self, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        self.take_waiting(out)?;
        let mut parts = Vec::new();
        let result = self.end_run(None, &mut parts);
        self.pass_on(parts, true, out);
        result
    }

    fn take_waiting(&mut self, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        while let Some(step) = self.waiting.front().cloned() {
            let mut parts = Vec::new();
            let result = self.take_first(&step, &mut parts);
            self.pass_on(parts, false, out);
            result?;
        }
        Ok(())
    }

    /// Takes the first waiting step. It stays waiting where a move before it is at fault.
    fn take_first(&mut self, step: &Step, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        match &step.action {
            Action::Move(r#move) if r#move.path == MovePath::Joint => self.take_joint_move(step, r#move, out),
            Action::Move(r#move) => self.take_path_move(step, r#move, out),
            Action::Output(_) | Action::Message { .. } | Action::Accepted { .. } | Action::ArcSet(_)
                if self.is_under_way() =>
            {
                self.waiting.pop_front();
                self.add_aside(step);
                Ok(())
            }
            _ => {
                self.end_run(None, out)?;
                self.waiting.pop_front();
                let planned = self.plan_alone(step).map_err(|problem| self.leave_out(step, problem))?;
                out.push(planned);
                Ok(())
            }
        }
    }

    /// Whether some of the steps taken have not been handed out: [`Planner::finish`] does that.
    #[must_use]
    pub fn holds_back(&self) -> bool {
        self.is_under_way()
            || !self.waiting.is_empty()
            || self.section.as_ref().is_some_and(Section::holds_back)
    }

    /// A move is held back.
    fn is_under_way(&self) -> bool {
        self.held.is_some() || !self.run.is_empty()
    }

    /// A step that takes no time, when the move that is held back is done.
    fn add_aside(&mut self, step: &Step) {
        match &mut self.held {
            Some(held) => held.after.push(step.clone()),
            None => self.run.add_aside(step.clone()),
        }
    }

    /// The state that the next step finds after one that has no plan.
    pub(super) fn leave_out(&mut self, step: &Step, problem: Problem) -> PlanError {
        self.skip(step);
        PlanError { at: step.at.clone(), problem }
    }

    /// Goes on from a step's target as if it had been reached, where the target has joints.
    fn skip(&mut self, step: &Step) {
        let Action::Move(r#move) = &step.action else { return };
        let target = goal(&r#move.target, self.cell, self.arm, &self.joints);
        if let Ok(Goal { joints: Ok(joints), tool, .. }) = target {
            (self.joints, self.tool) = (joints, tool);
        }
    }

    /// Gives up the run from the piece with this number on; the moves after it are taken again.
    pub(super) fn give_up(&mut self, index: usize, problem: Problem) -> PlanError {
        let step = self.run.piece(index).map(|piece| piece.link.step.clone());
        let after = self.run.give_up_after(index);
        for step in after.into_iter().rev() {
            self.waiting.push_front(step);
        }
        let at = step.as_ref().map_or(Location { job: "".into(), line: 0 }, |step| step.at.clone());
        if let Some(step) = step {
            self.skip(&step);
        }
        PlanError { at, problem }
    }

    /// A step that begins and ends at rest.
    fn plan_alone(&mut self, step: &Step) -> Result<Planned<N>, Problem> {
        let mut planned = self.aside(step);
        match &step.action {
            Action::ArcOn(condition) => self.arc_on(condition, &mut planned)?,
            Action::ArcOff(condition) => self.arc_off(condition, &mut planned)?,
            Action::WeaveOn(condition) => self.weave = Some(WeaveOrder::try_new(condition, self.cell)?),
            Action::WeaveOff => self.weave = None,
            Action::TrackOn => self.track_on()?,
            Action::TrackOff => self.track_off(&mut planned),
            Action::MemoryOn { record, file } => self.memory_on(*record, *file)?,
            Action::MemoryOff => self.memory_off()?,
            Action::Dwell { seconds } => self.dwell(*seconds, &mut planned),
            Action::Unsupported { text, reason } => {
                return Err(Problem::Refused { text: text.clone(), reason: reason.clone() });
            }
            _ => {}
        }
        Ok(planned)
    }

    /// How long it takes at the end of a move until the prefilters have let all of it through, in seconds.
    pub(super) fn run_out(&self) -> f64 {
        self.run.smear.map_or(0.0, |smear| smear.length)
    }

    /// A step that takes no time and leaves the motion as it is.
    pub(super) fn aside(&self, step: &Step) -> Planned<N> {
        let mut planned = Planned::of(step);
        if let Action::ArcSet(condition) = &step.action {
            let file = condition.file.and_then(|number| self.cell.arc_start(number));
            let setting = arc_setting(condition, file.map(|file| (file.current, file.voltage)));
            planned.commands.push(Command::ArcSetting(setting));
        }
        planned
    }

    pub(super) fn next_segment(&mut self) -> u32 {
        self.segment += 1;
        self.segment
    }

    fn dwell(&mut self, duration: f64, planned: &mut Planned<N>) {
        let (segment, line) = (self.next_segment(), planned.at.line);
        planned.segment = Some(SegmentInfo {
            segment,
            line,
            kind: SegmentKind::Dwell,
            speed: None,
            arc: self.arc,
            constant_part: None,
            rounded: [0.0; 2],
            seam: OnSeam::No,
        });
        planned.commands.push(Command::Dwell { line, segment, duration });
        planned.duration += duration;
    }

    /// Gas, then the arc, then the time to form the pool.
    fn arc_on(&mut self, condition: &ArcCondition, planned: &mut Planned<N>) -> Result<(), Problem> {
        let file = condition.file.map(|number| {
            let missing = Problem::UnknownCondition { kind: "ASF", number, table: "[[arc_start]]" };
            self.cell.arc_start(number).ok_or(missing)
        });
        let file = file.transpose()?;
        let preflow = file.map_or(0.0, |file| file.gas_preflow);
        let hold = condition.seconds.or(file.map(|file| file.dwell)).unwrap_or(0.0);
        let setting = arc_setting(condition, file.map(|file| (file.current, file.voltage)));
        self.dwell(preflow, planned);
        planned.commands.push(Command::Arc { on: true, setting });
        self.arc = true;
        self.dwell(hold, planned);
        Ok(())
    }

    /// The time to fill the crater, then the arc out.
    fn arc_off(&mut self, condition: &ArcCondition, planned: &mut Planned<N>) -> Result<(), Problem> {
        let file = condition.file.map(|number| {
            let missing = Problem::UnknownCondition { kind: "AEF", number, table: "[[arc_end]]" };
            self.cell.arc_end(number).ok_or(missing)
        });
        let file = file.transpose()?;
        let crater = condition.seconds.or(file.map(|file| file.crater_dwell)).unwrap_or(0.0);
        let setting = arc_setting(condition, file.map(|file| (file.current, file.voltage)));
        planned.commands.push(Command::ArcSetting(setting));
        self.dwell(crater, planned);
        planned.commands.push(Command::Arc { on: false, setting });
        self.arc = false;
        Ok(())
    }

    /// A move of the tool centre point goes on with the run, or begins one.
    fn take_path_move(
        &mut self,
        step: &Step,
        r#move: &Move,
        out: &mut Vec<Planned<N>>,
    ) -> Result<(), PlanError> {
        if self.held.is_some() {
            self.end_run(Some(Stops("a move of the tool follows")), out)?;
        }
        if !self.run.is_empty() && self.tool_of(r#move).is_some_and(|tool| tool != self.tool) {
            self.end_run(Some(Stops("the next move has another tool")), out)?;
        }
        let link = match self.link(step, r#move) {
            Ok(link) => link,
            Err(problem) => {
                self.end_run(None, out)?;
                self.waiting.pop_front();
                return Err(self.leave_out(step, problem));
            }
        };
        if link.path.length() == 0.0 {
            return self.take_move_without_way(&link, out);
        }
        self.run.most_bent = self.most_bent();
        let rests = link.pass.is_none() || !link.travels();
        if !link.travels() && !self.run.is_empty() {
            self.end_run(Some(Stops("the next move turns on the spot")), out)?;
        }
        if let Err(stops) = self.run.push(&link, &mut self.segment) {
            self.end_run(Some(stops), out)?;
            self.run.begin(&link, &mut self.segment);
        }
        self.waiting.pop_front();
        if rests {
            return self.end_run(None, out);
        }
        // Where a weave ends must be known before it begins.
        match &self.weave {
            Some(_) if self.run.count() < LONGEST_WEAVE => Ok(()),
            Some(_) => self.end_run(Some(Stops("the weave is long enough")), out),
            None if self.tracks() => Ok(()),
            None => self.advance(false, out),
        }
    }

    /// A move to where the run leads already, such as the first MOVC of an arc, does not stop it unless it is to.
    fn take_move_without_way(&mut self, link: &Link<N>, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        if link.pass.is_none() || self.run.is_empty() {
            self.end_run(None, out)?;
            let segment = Some(link.info(self.next_segment()));
            out.push(Planned { segment, ..Planned::begin(link) });
        } else {
            self.run.add_aside(link.step.clone());
        }
        self.waiting.pop_front();
        Ok(())
    }

    fn tool_of(&self, r#move: &Move) -> Option<ToolPose> {
        let number = match &r#move.path {
            MovePath::Incremental { .. } => return None,
            _ => r#move.target.position.tool,
        };
        ToolPose::of(self.cell, number).ok()
    }

    /// A move with its geometry.
    fn link(&mut self, step: &Step, r#move: &Move) -> Result<Link<N>, Problem> {
        let reference = self.run.last().and_then(|link| link.goal?.joints.ok()).unwrap_or(self.joints);
        let target = |target| goal(target, self.cell, self.arm, &reference);
        let mut notices = Vec::new();
        let (path, goal) = match &r#move.path {
            MovePath::Circular(arc) => {
                let [first, second, third] = &arc.points;
                let goals = [target(first)?, target(second)?, target(third)?];
                self.tool = goals[2].tool;
                let poses = goals.each_ref().map(|goal| goal.base_from_tcp);
                let (path, straight) = tool_path::arc(&self.pose(), &poses, arc.part);
                if straight {
                    notices
                        .push("the three points of the arc lie on one line: the robot goes straight".into());
                }
                let [_, second, third] = goals;
                (path, Some(if arc.part == ArcPart::First { second } else { third }))
            }
            MovePath::Incremental { frame } => {
                (tool_path::line(&self.pose(), &self.increment(r#move, *frame)?), None)
            }
            MovePath::Spline(piece) => {
                let goals = piece.points.iter().map(target).collect::<Result<Vec<_>, _>>()?;
                let goal = goals.get(piece.end).copied();
                self.tool = goal.map_or(self.tool, |goal| goal.tool);
                let poses: Vec<Pose> = goals.iter().map(|goal| goal.base_from_tcp).collect();
                (tool_path::spline_piece(&poses, piece)?, goal)
            }
            MovePath::Curve(piece) => {
                let goal = target(&r#move.target)?;
                self.tool = goal.tool;
                (tool_path::curve(piece, &r#move.target, &goal.base_from_tcp, self.cell)?, Some(goal))
            }
            MovePath::Linear | MovePath::Joint => {
                let goal = target(&r#move.target)?;
                self.tool = goal.tool;
                (tool_path::line(&self.pose(), &goal.base_from_tcp), Some(goal))
            }
        };
        workspace::check_path(&path, &self.cell.safety)?;
        let mut permitted = speed::path_limits(&path, r#move, &self.cell.cartesian)?;
        if let MovePath::Circular(_) | MovePath::Curve(_) = r#move.path {
            permitted = speed::bending(&path, &permitted);
        }
        let limits = speed::gentle(&permitted);
        let pass = tool_path::pass(&r#move.zone, &self.cell.job);
        Ok(Link { step: step.clone(), path, limits, permitted, goal, pass, arc: self.arc, notices })
    }

    /// Where an increment leads: in a frame, or joint by joint in pulses.
    fn increment(&self, r#move: &Move, frame: Option<Frame>) -> Result<Pose, Problem> {
        match frame {
            Some(frame) => tool_path::increment(&self.pose(), &r#move.target, frame, self.cell),
            None => {
                let from = self.run.last().and_then(|link| link.goal?.joints.ok()).unwrap_or(self.joints);
                let joints = resolve::pulse_increment(&r#move.target, self.arm, &from)?;
                Ok(self.arm.kinematics.forward(&joints) * self.tool.flange_from_tcp)
            }
        }
    }

    /// The tool centre point where the plan stands.
    pub(super) fn pose(&self) -> Pose {
        let at_rest = || self.arm.kinematics.forward(&self.joints) * self.tool.flange_from_tcp;
        self.run.end().unwrap_or_else(at_rest)
    }
}

/// What the power source is set to: what the line says, otherwise the cell's condition.
pub(super) fn arc_setting(condition: &ArcCondition, file: Option<(f64, ArcVoltage)>) -> ArcSetting {
    let volts = condition.voltage.map(ArcVoltage::Volts);
    let percent = condition.voltage_percent.map(|percent| ArcVoltage::Synergic(percent / 100.0));
    ArcSetting {
        current: condition.current.or(file.map(|(current, _)| current)).unwrap_or(ArcSetting::NONE.current),
        voltage: volts.or(percent).or(file.map(|(_, voltage)| voltage)).unwrap_or(ArcSetting::NONE.voltage),
    }
}
