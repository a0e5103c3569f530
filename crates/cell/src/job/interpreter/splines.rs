//! MOVS points become splines.
//!
//! The first MOVS of a run is the spline's start and is reached straight. The points are held back until the run ends; each further one
//! is then a piece of the spline through all of them. A run of fewer than three goes straight.

use std::collections::VecDeque;
use std::sync::Arc;

use super::super::step::{Action, MovePath, Note, SplinePiece, Step, Target};

/// Steps of a run that are held back at most, points and what stands between them. A longer run is more than one spline.
const MAX_HELD: usize = 1000;
/// Fewest points of a spline.
const MIN_POINTS: usize = 3;

/// The run of MOVS points under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Splines {
    held: VecDeque<Step>,
    ready: VecDeque<Step>,
}

impl Splines {
    /// The next step that may leave.
    pub(super) fn pop(&mut self) -> Option<Step> {
        self.ready.pop_front()
    }

    /// Points are held back.
    pub(super) fn is_open(&self) -> bool {
        !self.held.is_empty()
    }

    /// Takes a MOVS point, or a step between two of them.
    pub(super) fn push(&mut self, step: Step) {
        self.held.push_back(step);
        if self.held.len() >= MAX_HELD {
            self.flush();
        }
    }

    /// The run is over: its points are known.
    pub(super) fn flush(&mut self) {
        let points: Arc<[Target]> = self.held.iter().filter_map(target).cloned().collect();
        let mut number = 0;
        for mut step in self.held.drain(..) {
            if let Action::Move(motion) = &mut step.action {
                if points.len() < MIN_POINTS {
                    step.notes.push(Note::SplineTooShort);
                } else if number > 0 {
                    motion.path = MovePath::Spline(SplinePiece { points: Arc::clone(&points), end: number });
                }
                number += 1;
            }
            self.ready.push_back(step);
        }
    }
}

fn target(step: &Step) -> Option<&Target> {
    match &step.action {
        Action::Move(motion) => Some(&motion.target),
        _ => None,
    }
}
