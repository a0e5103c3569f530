//! The speed of a move, and the rules that supply a missing one.

use super::super::error::Mistake;
use super::super::expression::Node;
use super::super::instruction::{Interpolation, MoveInstruction, SpeedKind, SpeedTag};
use super::super::lexer::Fault;
use super::super::step::{Location, Note, Speed, SpeedOrigin};
use super::super::world::World;
use super::Interpreter;

type Run<T> = Result<T, Fault>;

/// Counts of an integer variable in one percent, mm/s or deg/s.
const COUNTS_PER_PERCENT: f64 = 100.0;
const COUNTS_PER_MM_S: f64 = 10.0;
const COUNTS_PER_DEG_S: f64 = 10.0;

/// A speed and the instruction that gave it.
#[derive(Debug, Clone)]
struct Given {
    speed: Speed,
    at: Location,
    /// `V=` was written as an integer.
    integer: Option<f64>,
}

/// Speeds that supply moves without one.
#[derive(Debug, Clone, Default)]
pub(super) struct Speeds {
    /// From SPEED, per kind.
    set: Vec<(SpeedKind, Given)>,
    /// From the last move of each sort.
    last_joint: Option<Given>,
    last_path: Option<Given>,
}

impl Interpreter {
    /// SPEED.
    pub(super) fn set_speeds(&mut self, tags: &[SpeedTag], at: &Location, world: &mut impl World) -> Run<()> {
        for tag in tags {
            let given = self.given(tag, at.clone(), world)?;
            self.speeds.set.retain(|(kind, _)| *kind != tag.kind);
            self.speeds.set.push((tag.kind, given));
        }
        Ok(())
    }

    /// The speed, by the first rule that has one: the line; between ARCON and ARCOF the arc's condition; the last
    /// SPEED; the last move of the same sort; the cell.
    pub(super) fn speed(
        &mut self,
        step: &MoveInstruction,
        at: Location,
        column: u32,
        notes: &mut Vec<Note>,
        world: &mut impl World,
    ) -> Run<(Speed, SpeedOrigin)> {
        let joint = step.interpolation == Interpolation::Joint;
        let (kinds, last): (&[SpeedKind], _) = if joint {
            (&[SpeedKind::Joint, SpeedKind::External], &self.speeds.last_joint)
        } else {
            (&[SpeedKind::Linear, SpeedKind::Rotation, SpeedKind::External], &self.speeds.last_path)
        };
        let (given, origin) = if let Some(tag) = &step.speed {
            (self.given(tag, at.clone(), world)?, SpeedOrigin::Written)
        } else if let Some(mm_s) = self.arc_speed(joint, world) {
            let speed = Speed::Linear { mm_s };
            (Given { speed, at: at.clone(), integer: None }, SpeedOrigin::ArcCondition)
        } else if let Some(given) = self.speed_from_instruction(kinds) {
            (given.clone(), SpeedOrigin::SpeedInstruction(given.at.clone()))
        } else if let Some(given) = last {
            (given.clone(), SpeedOrigin::LastMove(given.at.clone()))
        } else if let Some(speed) = world.default_speed(joint) {
            (Given { speed, at: at.clone(), integer: None }, SpeedOrigin::Cell)
        } else {
            return Err(Fault { column, mistake: Mistake::NoSpeed { instruction: step.word() } });
        };
        if origin != SpeedOrigin::Written {
            let kind = if joint { SpeedKind::Joint } else { SpeedKind::Linear };
            notes.push(Note::SpeedSupplied(kind, origin.clone()));
        }
        if let Some(value) = given.integer {
            notes.push(Note::IntegerSpeed { value, unit: self.v_unit });
        }
        let speed = given.speed;
        // An arc's speed ends with the arc.
        if origin != SpeedOrigin::ArcCondition {
            let last = if joint { &mut self.speeds.last_joint } else { &mut self.speeds.last_path };
            *last = Some(Given { at, ..given });
        }
        Ok((speed, origin))
    }

    fn arc_speed(&self, joint: bool, world: &mut impl World) -> Option<f64> {
        let arc = self.arc.as_ref().filter(|_| !joint)?;
        arc.speed_mm_s.or_else(|| world.arc_speed_mm_s(arc))
    }

    fn speed_from_instruction(&self, kinds: &[SpeedKind]) -> Option<&Given> {
        let of_kind = |kind| self.speeds.set.iter().find(move |(set, _)| set == kind);
        kinds.iter().find_map(of_kind).map(|(_, given)| given)
    }

    fn given(&self, tag: &SpeedTag, at: Location, world: &mut impl World) -> Run<Given> {
        let written = self.number(&tag.value, world)?;
        let literal = matches!(tag.value.node, Node::Number { .. });
        let in_units = |counts_per_unit: f64| if literal { written } else { written / counts_per_unit };
        let (value, speed) = match tag.kind {
            SpeedKind::Joint => {
                let percent = in_units(COUNTS_PER_PERCENT);
                (percent, Speed::JointPercent(percent))
            }
            SpeedKind::External => {
                let percent = in_units(COUNTS_PER_PERCENT);
                (percent, Speed::ExternalPercent(percent))
            }
            SpeedKind::Rotation => {
                let deg_s = in_units(COUNTS_PER_DEG_S);
                (deg_s, Speed::Rotation { deg_s })
            }
            // Numbers are in the cell's unit; counts are always of mm/s.
            SpeedKind::Linear if literal => (written, Speed::Linear { mm_s: written * self.v_unit.mm_s() }),
            SpeedKind::Linear => {
                let mm_s = in_units(COUNTS_PER_MM_S);
                (mm_s, Speed::Linear { mm_s })
            }
        };
        let (what, min, max) = tag.kind.range();
        super::moves::in_range(&tag.value, what, value, min, max)?;
        let integer = match tag.value.node {
            Node::Number { whole: true, value } if tag.kind == SpeedKind::Linear => Some(value),
            _ => None,
        };
        Ok(Given { speed, at, integer })
    }
}
