//! The program, one step at a time.

mod arcs;
mod curves;
mod data;
mod evaluate;
mod flow;
mod moves;
mod outputs;
mod process;
mod speed;
mod splines;
mod variables;

use std::sync::Arc;

use self::curves::{Curves, Point, Raw};
use self::outputs::Outputs;
use self::speed::Speeds;
use self::variables::{Value, Variables};
use super::disposition::{Disposition, disposition};
use super::error::{JobError, Mistake};
use super::expression::VariableKind;
use super::instruction::{Instruction, Interpolation};
use super::lexer::Fault;
use super::position::PositionKind;
use super::program::{Job, Statement};
use super::set::JobSet;
use super::step::{Action, ArcCondition, LinearSpeedUnit, Location, Note, Step};
use super::world::World;

/// Instructions that may run between two steps that take time.
pub const MAX_IDLE: u32 = 100_000;

/// Jobs that may be called within each other.
pub const MAX_CALLS: usize = 32;

/// Walks a set of jobs from the entry job's first line, and yields what is to be done.
///
/// Pull style: it has no clock and no thread, and does nothing between two calls of [`next`](Self::next). A program
/// is read ahead of the robot only where an arc needs its third point, or a spline all of its points.
#[derive(Debug, Clone)]
pub struct Interpreter {
    jobs: JobSet,
    v_unit: LinearSpeedUnit,
    calls: Vec<Call>,
    globals: Variables,
    outputs: Outputs,
    speeds: Speeds,
    /// Between ARCON and ARCOF.
    arc: Option<ArcCondition>,
    /// `$RV`.
    returned: Option<Value>,
    curves: Curves,
    /// Instructions since the last step that takes time.
    idle: u32,
}

/// One job under way.
#[derive(Debug, Clone)]
struct Call {
    job: usize,
    /// The statement that runs next.
    next: usize,
    locals: Variables,
    arguments: Vec<Value>,
}

impl Call {
    fn new(job: usize, arguments: Vec<Value>) -> Self {
        Self { job, next: 0, locals: Variables::default(), arguments }
    }
}

/// What a statement comes to.
#[derive(Debug)]
enum Outcome {
    /// Nothing to be done outside; the program goes on.
    Nothing,
    /// Something to be done, with remarks.
    Do(Action, Vec<Note>),
    /// A point of a path that later points decide.
    Point(Action, Vec<Note>, Point),
}

impl From<Action> for Outcome {
    fn from(action: Action) -> Self {
        Self::Do(action, Vec::new())
    }
}

impl Interpreter {
    /// At the first line of the set's entry job. Position variables that the jobs bring along are set; where two
    /// jobs bring the same, the entry job's counts, then that of the job that was found first.
    #[must_use]
    pub fn new(jobs: &JobSet, v_unit: LinearSpeedUnit) -> Self {
        let mut globals = Variables::default();
        let all: Vec<&Job> = jobs.jobs().collect();
        for job in all.iter().rev() {
            for (name, position) in &job.positions {
                let kind = match name.kind {
                    PositionKind::P => VariableKind::P,
                    PositionKind::Bp => VariableKind::Bp,
                    PositionKind::Ex => VariableKind::Ex,
                    PositionKind::C | PositionKind::Bc | PositionKind::Ec => continue,
                };
                globals.set_position(kind, name.number, position.clone());
            }
        }
        Self {
            jobs: jobs.clone(),
            v_unit,
            calls: vec![Call::new(0, Vec::new())],
            globals,
            outputs: Outputs::default(),
            speeds: Speeds::default(),
            arc: None,
            returned: None,
            curves: Curves::default(),
            idle: 0,
        }
    }

    /// The next thing to do, or `None` after [`Action::End`].
    ///
    /// Bounded: at most [`MAX_IDLE`] instructions run in one call and between two steps that take time.
    ///
    /// # Errors
    /// What only running shows: division by zero, a value out of its range, a position variable that was never set, a
    /// missing speed, calls nested too deeply, a loop in which nothing takes time. The interpreter ends then.
    pub fn next(&mut self, world: &mut impl World) -> Result<Option<Step>, JobError> {
        loop {
            if let Some(step) = self.curves.pop() {
                return Ok(Some(step));
            }
            // Ends: `run_one` counts instructions, and gives an error where their bound is passed.
            match self.run_one(world) {
                Ok(Some(raw)) => self.curves.push(raw),
                Ok(None) if self.calls.is_empty() => {
                    self.curves.flush();
                    return Ok(self.curves.pop());
                }
                Ok(None) => {}
                Err(error) => {
                    self.calls.clear();
                    return Err(error);
                }
            }
        }
    }

    /// Runs one statement.
    fn run_one(&mut self, world: &mut impl World) -> Result<Option<Raw>, JobError> {
        let Some((job, index)) = self.current() else { return Ok(None) };
        let Some(statement) = job.program.get(index) else {
            // Only a jump behind END leads here, and END is a statement: the job is over.
            self.calls.pop();
            return Ok(None);
        };
        let fail = |fault: Fault| job.error(statement.line, fault.column, fault.mistake);
        self.idle += 1;
        if self.idle > MAX_IDLE {
            let mistake = Mistake::EndlessLoop { limit: MAX_IDLE };
            return Err(fail(Fault { column: statement.column, mistake }));
        }
        self.go_to(index + 1);
        let outcome = match disposition(&statement.instruction) {
            Disposition::Refused(reason) => {
                Action::Unsupported { text: statement.text.clone(), reason: reason.into_owned() }.into()
            }
            Disposition::Accepted(note) if is_reported_only(&statement.instruction) => {
                Action::Accepted { text: statement.text.clone(), note }.into()
            }
            Disposition::Accepted(_) | Disposition::Executed => {
                self.execute(&job, index, statement, world).map_err(fail)?
            }
        };
        let (action, notes, point) = match outcome {
            Outcome::Nothing => return Ok(None),
            Outcome::Do(action, notes) => (action, notes, Point::Single),
            Outcome::Point(action, notes, point) => (action, notes, point),
        };
        if takes_time(&action, world) {
            self.idle = 0;
        }
        let at = location(&job, statement);
        Ok(Some(Raw { step: Step { at, action, notes }, point }))
    }

    fn execute(
        &mut self,
        job: &Arc<Job>,
        index: usize,
        statement: &Statement,
        world: &mut impl World,
    ) -> Result<Outcome, Fault> {
        match &statement.instruction {
            Instruction::Nop | Instruction::Label(_) | Instruction::Disabled | Instruction::Other { .. } => {
                Ok(Outcome::Nothing)
            }
            Instruction::Move(step) => {
                let (action, notes) = self.motion(job, index, statement, step, world)?;
                Ok(match step.interpolation {
                    Interpolation::Circular => {
                        Outcome::Point(action, notes, Point::Circular { fixed: step.fixed_point })
                    }
                    Interpolation::Spline => Outcome::Point(action, notes, Point::Spline),
                    _ => Outcome::Do(action, notes),
                })
            }
            Instruction::Speed(tags) => {
                self.set_speeds(tags, &location(job, statement), world).map(|()| Outcome::Nothing)
            }
            Instruction::Flow(flow) => self.flow(job, index, statement.column, flow, world),
            Instruction::Data(data) => self.data(data, world),
            Instruction::Io(io) => self.io(io, world),
            Instruction::Weld(weld) => self.weld(weld, world),
        }
    }

    /// The job that runs, and the statement that comes next.
    fn current(&self) -> Option<(Arc<Job>, usize)> {
        let call = self.calls.last()?;
        self.jobs.at(call.job).map(|job| (Arc::clone(job), call.next))
    }

    fn go_to(&mut self, statement: usize) {
        if let Some(call) = self.calls.last_mut() {
            call.next = statement;
        }
    }
}

fn location(job: &Job, statement: &Statement) -> Location {
    Location { job: Arc::clone(&job.name), line: statement.line }
}

/// Accepted without anything to execute.
fn is_reported_only(instruction: &Instruction) -> bool {
    matches!(instruction, Instruction::Other { .. })
}

/// Whether the world moves on while this is done. A wait whose condition holds already does not.
fn takes_time(action: &Action, world: &mut impl World) -> bool {
    match action {
        Action::Move(_) | Action::Pause => true,
        Action::Dwell { seconds } => *seconds > 0.0,
        Action::Wait { condition, timeout_seconds } => {
            *timeout_seconds != Some(0.0) && !condition.holds(&mut |kind, number| world.input(kind, number))
        }
        _ => false,
    }
}
