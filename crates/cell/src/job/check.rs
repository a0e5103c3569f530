//! What a job refers to within itself: labels, steps, local variables, blocks.

use super::blocks;
use super::error::{JobError, Mistake, Nearest};
use super::expression::{Index, Variable, VariableKind};
use super::instruction::{Flow, Instruction, JumpTarget, MoveInstruction, PositionReference};
use super::names::nearest;
use super::position::PositionName;
use super::program::{Job, Statement};
use super::walk;

/// Whether parts of a job were read without a mistake. Where they were not, what they lack is no second mistake.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whole {
    pub(super) program: bool,
    pub(super) positions: bool,
}

/// Links the blocks of a job and returns every reference in it that leads nowhere.
pub(super) fn resolve(job: &mut Job, whole: Whole) -> Vec<JobError> {
    let (links, mut errors) = blocks::link(job);
    if !whole.program {
        errors.clear();
    }
    for statement in &job.program {
        check_statement(job, statement, whole, &mut errors);
    }
    job.links = links;
    errors
}

fn check_statement(job: &Job, statement: &Statement, whole: Whole, errors: &mut Vec<JobError>) {
    let mut complain = |column, mistake| errors.push(job.error(statement.line, column, mistake));
    match &statement.instruction {
        Instruction::Flow(Flow::Jump { target: JumpTarget::Label { column, name }, .. })
            if !job.labels.contains_key(name) =>
        {
            let nearest = nearest(name, job.labels.keys().map(String::as_str));
            let nearest = Nearest(nearest.0.map(|n| format!("*{n}")));
            complain(*column, Mistake::Unknown { what: "label", name: format!("*{name}"), nearest });
        }
        Instruction::Move(step) if whole.positions => check_steps(job, step, &mut complain),
        _ => {}
    }
    let Some(declared) = job.header.locals else { return };
    walk::variables(&statement.instruction, &mut |variable| {
        if let Some(mistake) = undeclared(variable, &declared) {
            complain(variable.column, mistake);
        }
    });
}

fn check_steps(job: &Job, first: &MoveInstruction, complain: &mut impl FnMut(u32, Mistake)) {
    let moves = std::iter::once(first).chain(&first.others);
    for reference in moves.flat_map(|step| step.target.iter().chain(&step.external)) {
        let PositionReference::Step { column, kind, number } = reference else { continue };
        let name = PositionName { local: false, kind: *kind, number: *number };
        if !job.positions.contains_key(&name) {
            let same_kind = job.positions.keys().filter(|other| other.kind == name.kind);
            let names: Vec<String> = same_kind.map(ToString::to_string).collect();
            let name = name.to_string();
            let nearest = nearest(&name, names.iter().map(String::as_str));
            complain(*column, Mistake::Unknown { what: "position", name, nearest });
        }
    }
}

/// `///LVARS` in its order. PX stands for all three kinds of positions; the robot's counts.
fn undeclared(variable: &Variable, declared: &[u32; 8]) -> Option<Mistake> {
    let Index::Fixed(number) = variable.index else { return None };
    let slot = match variable.kind {
        VariableKind::B => 0,
        VariableKind::I => 1,
        VariableKind::D => 2,
        VariableKind::R => 3,
        VariableKind::S => 4,
        VariableKind::P | VariableKind::Px => 5,
        VariableKind::Bp => 6,
        VariableKind::Ex => 7,
    };
    let declared = *declared.get(slot)?;
    (variable.local && number >= declared)
        .then(|| Mistake::UndeclaredLocal { name: variable.to_string(), declared })
}
