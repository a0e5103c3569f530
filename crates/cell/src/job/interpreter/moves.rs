//! Moves: targets, speeds, zones.

use super::super::error::{Mistake, Nearest};
use super::super::expression::{Expression, Node};
use super::super::instruction::{
    FrameTag, Instruction, Interpolation, MoveInstruction, PositionReference, SpeedKind, SpeedTag,
};
use super::super::lexer::Fault;
use super::super::position::{Coordinates, Frame, PositionName};
use super::super::program::Job;
use super::super::step::{Action, Move, MovePath, Note, Speed, SpeedOrigin, Target, Zone};
use super::super::world::World;
use super::Interpreter;

type Run<T> = Result<T, Fault>;

/// Counts of an integer variable in one percent, mm/s or deg/s.
const COUNTS_PER_PERCENT: f64 = 100.0;
const COUNTS_PER_MM_S: f64 = 10.0;
const COUNTS_PER_DEG_S: f64 = 10.0;

/// A speed and the line that gave it.
#[derive(Debug, Clone, Copy)]
struct Given {
    speed: Speed,
    line: u32,
    /// `V=` was written as an integer.
    integer: Option<f64>,
}

/// Speeds that supply moves without one.
#[derive(Debug, Default)]
pub(super) struct Speeds {
    /// From SPEED, per kind.
    set: Vec<(SpeedKind, Given)>,
    /// From the last move of each sort.
    last_joint: Option<Given>,
    last_path: Option<Given>,
}

impl Interpreter {
    pub(super) fn set_speeds(&mut self, tags: &[SpeedTag], line: u32, world: &mut impl World) -> Run<()> {
        for tag in tags {
            let given = self.given(tag, line, world)?;
            self.speeds.set.retain(|(kind, _)| *kind != tag.kind);
            self.speeds.set.push((tag.kind, given));
        }
        Ok(())
    }

    pub(super) fn motion(
        &mut self,
        job: &Job,
        index: usize,
        column: u32,
        step: &MoveInstruction,
        world: &mut impl World,
    ) -> Run<(Action, Vec<Note>)> {
        let line = job.program.get(index).map_or(0, |s| s.line);
        let mut notes = Vec::new();
        let target = self.target(job, column, step, world)?;
        let (speed, speed_origin) = self.speed(step, line, column, &mut notes, world)?;
        let zone = self.zone(step, world)?;
        if zone != Zone::Exact {
            notes.push(Note::StopsInZone(zone));
        }
        for (present, tag) in [(step.no_wait, "NWAIT"), (step.continuous, "CONT")] {
            if present {
                notes.push(Note::TagWithoutEffect(tag));
            }
        }
        let circular = step.interpolation == Interpolation::Circular;
        if circular && !has_neighbour(job, index) {
            notes.push(Note::ArcTooShort);
        }
        let path = match step.interpolation {
            Interpolation::Joint => MovePath::Joint,
            // MOVC points become arcs when their neighbours are known.
            Interpolation::Linear | Interpolation::Circular => MovePath::Linear,
            Interpolation::Spline => MovePath::Spline,
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
                Ok(Target { name, position })
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

    /// The speed, by the first rule that has one: the line; between ARCON and ARCOF the arc's condition; the last
    /// SPEED; the last move of the same sort.
    fn speed(
        &mut self,
        step: &MoveInstruction,
        line: u32,
        column: u32,
        notes: &mut Vec<Note>,
        world: &mut impl World,
    ) -> Run<(Speed, SpeedOrigin)> {
        let joint = step.interpolation == Interpolation::Joint;
        let kinds: &[SpeedKind] = if joint {
            &[SpeedKind::Joint, SpeedKind::External]
        } else {
            &[SpeedKind::Linear, SpeedKind::Rotation, SpeedKind::External]
        };
        let last = if joint { self.speeds.last_joint } else { self.speeds.last_path };
        let (given, origin) = if let Some(tag) = &step.speed {
            (self.given(tag, line, world)?, SpeedOrigin::Written)
        } else if let Some(mm_s) = self.arc_speed(joint, world) {
            let speed = Speed::Linear { mm_s };
            (Given { speed, line, integer: None }, SpeedOrigin::ArcCondition)
        } else if let Some(given) = self.speed_from_instruction(kinds) {
            (given, SpeedOrigin::SpeedInstruction { line: given.line })
        } else if let Some(given) = last {
            (given, SpeedOrigin::LastMove { line: given.line })
        } else {
            return Err(Fault { column, mistake: Mistake::NoSpeed { instruction: step.word() } });
        };
        if origin != SpeedOrigin::Written {
            let kind = kinds.first().copied().unwrap_or(SpeedKind::Linear);
            notes.push(Note::SpeedSupplied(kind, origin));
        }
        if let Some(value) = given.integer {
            notes.push(Note::IntegerSpeed { value, unit: self.v_unit });
        }
        // An arc's speed ends with the arc.
        if origin != SpeedOrigin::ArcCondition {
            let last = if joint { &mut self.speeds.last_joint } else { &mut self.speeds.last_path };
            *last = Some(Given { line, ..given });
        }
        Ok((given.speed, origin))
    }

    fn arc_speed(&self, joint: bool, world: &mut impl World) -> Option<f64> {
        let arc = self.arc.as_ref().filter(|_| !joint)?;
        arc.speed_mm_s.or_else(|| world.arc_speed_mm_s(arc))
    }

    fn speed_from_instruction(&self, kinds: &[SpeedKind]) -> Option<Given> {
        kinds
            .iter()
            .find_map(|kind| self.speeds.set.iter().find(|(set, _)| set == kind).map(|(_, given)| *given))
    }

    fn given(&self, tag: &SpeedTag, line: u32, world: &mut impl World) -> Run<Given> {
        let value = self.number(&tag.value, world)?;
        let counts = !matches!(tag.value.node, Node::Number { .. });
        let (what, min, max) = tag.kind.range();
        let per_count = |counts_per_unit: f64| if counts { 1.0 / counts_per_unit } else { 1.0 };
        let (value, speed) = match tag.kind {
            SpeedKind::Joint => {
                let percent = value * per_count(COUNTS_PER_PERCENT);
                (percent, Speed::JointPercent(percent))
            }
            SpeedKind::External => {
                let percent = value * per_count(COUNTS_PER_PERCENT);
                (percent, Speed::ExternalPercent(percent))
            }
            SpeedKind::Rotation => {
                let deg_s = value * per_count(COUNTS_PER_DEG_S);
                (deg_s, Speed::Rotation { deg_s })
            }
            // Counts are always of mm/s; numbers are in the cell's unit.
            SpeedKind::Linear if counts => {
                let mm_s = value * per_count(COUNTS_PER_MM_S);
                (mm_s, Speed::Linear { mm_s })
            }
            SpeedKind::Linear => (value, Speed::Linear { mm_s: value * self.v_unit.mm_s() }),
        };
        if !(min..=max).contains(&value) {
            let mistake = Mistake::OutOfRange { what, value, min, max };
            return Err(Fault { column: tag.value.column, mistake });
        }
        let integer = match tag.value.node {
            Node::Number { whole: true, value } if tag.kind == SpeedKind::Linear => Some(value),
            _ => None,
        };
        Ok(Given { speed, line, integer })
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
