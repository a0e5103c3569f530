//! Moves: targets, paths, zones.

use super::super::error::{Mistake, Nearest};
use super::super::expression::{Expression, Node};
use super::super::instruction::{FrameTag, Instruction, Interpolation, MoveInstruction, PositionReference};
use super::super::lexer::Fault;
use super::super::position::{Coordinates, Frame, PositionName};
use super::super::program::{Job, Statement};
use super::super::step::{Action, Move, MovePath, Note, Target, Zone};
use super::super::world::World;
use super::{Interpreter, location};

type Run<T> = Result<T, Fault>;

impl Interpreter {
    pub(super) fn motion(
        &mut self,
        job: &Job,
        index: usize,
        statement: &Statement,
        step: &MoveInstruction,
        world: &mut impl World,
    ) -> Run<(Action, Vec<Note>)> {
        let at = location(job, statement);
        let mut notes = Vec::new();
        let target = self.target(job, statement.column, step, world)?;
        let (speed, speed_origin) = self.speed(step, at, statement.column, &mut notes, world)?;
        let zone = self.zone(step, world)?;
        if step.no_wait {
            notes.push(Note::TagWithoutEffect("NWAIT"));
        }
        let circular = step.interpolation == Interpolation::Circular;
        if circular && !has_neighbour(job, index) {
            notes.push(Note::ArcTooShort);
        }
        let path = match step.interpolation {
            Interpolation::Joint => MovePath::Joint,
            // MOVC and MOVS points become arcs and splines when their neighbours are known.
            Interpolation::Linear | Interpolation::Circular | Interpolation::Spline => MovePath::Linear,
            Interpolation::Incremental => self.increment(step, &target, world)?,
        };
        let acceleration = self.share(step.acceleration.as_ref(), "ACC (%)", world)?;
        let deceleration = self.share(step.deceleration.as_ref(), "DEC (%)", world)?;
        let motion = Move {
            path,
            target,
            speed,
            speed_origin,
            zone,
            acceleration,
            deceleration,
            no_wait: step.no_wait,
        };
        Ok((Action::Move(Box::new(motion)), notes))
    }

    fn target(&self, job: &Job, column: u32, step: &MoveInstruction, world: &mut impl World) -> Run<Target> {
        match &step.target {
            Some(PositionReference::Variable(variable)) => self.position(variable, world),
            Some(PositionReference::Step { column, kind, number }) => {
                let name = PositionName { local: false, kind: *kind, number: *number };
                let position = job.positions.get(&name).cloned().ok_or_else(|| {
                    let nearest = Nearest::default();
                    let mistake = Mistake::Unknown { what: "position", name: name.to_string(), nearest };
                    Fault { column: *column, mistake }
                })?;
                Ok(Target { name: Some(name), position })
            }
            None => {
                let mistake = Mistake::MissingTarget { instruction: step.word().to_owned() };
                Err(Fault { column, mistake })
            }
        }
    }

    /// IMOV's frame; a rectangular increment without one counts in the frame that it was taught in.
    fn increment(&self, step: &MoveInstruction, target: &Target, world: &mut impl World) -> Run<MovePath> {
        let frame = match (&target.position.coordinates, &step.frame) {
            (Coordinates::Rectangular(_), Some(tag)) => Some(self.frame(tag, world)?),
            (Coordinates::Rectangular(r), None) => Some(r.frame),
            (Coordinates::Pulses(_) | Coordinates::Angles(_), _) => None,
        };
        Ok(MovePath::Incremental { frame })
    }

    pub(super) fn frame(&self, tag: &FrameTag, world: &mut impl World) -> Run<Frame> {
        Ok(match tag {
            FrameTag::Base => Frame::Base,
            FrameTag::Robot => Frame::Robot,
            FrameTag::Tool => Frame::Tool,
            FrameTag::MasterTool => Frame::MasterTool,
            FrameTag::User(index) => Frame::User(self.index(index, world)?),
        })
    }

    fn zone(&self, step: &MoveInstruction, world: &mut impl World) -> Run<Zone> {
        if let Some(level) = &step.position_level {
            let level = self.natural(level, "PL", 8.0, world)?;
            // At most 8: the cast is exact.
            return Ok(if level == 0 { Zone::Exact } else { Zone::Level(level as u8) });
        }
        match &step.corner_radius {
            Some(radius) => {
                // A variable counts 0.1 mm.
                let counts = !matches!(radius.node, Node::Number { .. });
                let value = self.number(radius, world)?;
                let mm = if counts { value / 10.0 } else { value };
                in_range(radius, "CR (mm)", mm, 0.1, 6553.5)?;
                Ok(Zone::CornerRadius { mm })
            }
            None => Ok(Zone::Unspecified),
        }
    }

    fn share(&self, percent: Option<&Expression>, what: &'static str, world: &mut impl World) -> Run<f64> {
        let Some(expression) = percent else { return Ok(1.0) };
        let value = self.number(expression, world)?;
        in_range(expression, what, value, 20.0, 100.0)?;
        Ok(value / 100.0)
    }
}

/// A value that was found while running must lie in its range.
pub(super) fn in_range(
    expression: &Expression,
    what: &'static str,
    value: f64,
    min: f64,
    max: f64,
) -> Run<()> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(Fault { column: expression.column, mistake: Mistake::OutOfRange { what, value, min, max } })
}

/// Whether the move before or after this one in the file is a MOVC too.
fn has_neighbour(job: &Job, index: usize) -> bool {
    let circular = |instruction: &Instruction| match instruction {
        Instruction::Move(step) => Some(step.interpolation == Interpolation::Circular),
        _ => None,
    };
    let mut before = job.program.iter().take(index).rev().map(|s| &s.instruction);
    let mut after = job.program.iter().skip(index + 1).map(|s| &s.instruction);
    before.find_map(circular) == Some(true) || after.find_map(circular) == Some(true)
}
