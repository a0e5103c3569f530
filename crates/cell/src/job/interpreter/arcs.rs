//! MOVC points become arcs.
//!
//! The first MOVC of a run is the arc's start and is reached straight. The second is held back until the third is
//! known; both then make one arc. Every further point continues on the circle through the last three points. `FPT`, or
//! a point at the same place as the one before, ends an arc and starts the next.

use std::collections::VecDeque;

use super::super::step::{Action, ArcPart, CircularArc, Move, MovePath, Note, Step, Target};
use super::curves::Point;

/// Steps that may stand between the via point and the end of an arc.
const MAX_BETWEEN: usize = 64;

/// The run of MOVC points under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Arcs {
    /// The last points of the run, at most two.
    run: Vec<Target>,
    /// The via point that waits for its arc, with the steps that follow it.
    held: VecDeque<Step>,
    ready: VecDeque<Step>,
}

impl Arcs {
    /// The next step that may leave.
    pub(super) fn pop(&mut self) -> Option<Step> {
        self.ready.pop_front()
    }

    /// Takes a step in.
    pub(super) fn push(&mut self, step: Step, point: Point) {
        let target = match &step.action {
            Action::Move(motion) => Some(motion.target.clone()),
            _ => None,
        };
        match (target, point) {
            (Some(target), Point::Circular { fixed }) => self.point(step, target, fixed),
            (None, _) if !self.held.is_empty() && self.held.len() <= MAX_BETWEEN => self.held.push_back(step),
            (Some(_), _) => {
                self.end_run();
                self.ready.push_back(step);
            }
            (None, _) => {
                self.flush();
                self.ready.push_back(step);
            }
        }
    }

    /// A point that is none of MOVC follows.
    pub(super) fn end_run(&mut self) {
        self.flush();
        self.run.clear();
    }

    /// Nothing more will come to complete an arc: a via point that waits is reached straight.
    pub(super) fn flush(&mut self) {
        if let Some(via) = self.held.front_mut() {
            via.notes.push(Note::ArcTooShort);
            self.run.clear();
        }
        self.ready.append(&mut self.held);
    }

    fn point(&mut self, step: Step, target: Target, fixed_point: bool) {
        let again = self.run.last().is_some_and(|last| last.position == target.position);
        if again {
            self.flush();
            self.run.clear();
        }
        match (self.run.as_slice(), self.held.is_empty()) {
            ([start, via], false) => {
                let points = [start.clone(), via.clone(), target.clone()];
                self.complete(step, points);
            }
            ([before, last], true) => {
                let points = [before.clone(), last.clone(), target.clone()];
                self.ready.push_back(on_circle(step, points, ArcPart::Second));
            }
            ([_], _) => self.held.push_back(step),
            _ => self.ready.push_back(step),
        }
        if fixed_point {
            self.flush();
            self.run.clear();
        } else if self.run.len() == 2 {
            self.run.remove(0);
        }
        self.run.push(target);
    }

    /// The first arc of a run. Where steps stand between via point and end, each half is a move of its own.
    fn complete(&mut self, mut end: Step, points: [Target; 3]) {
        let Some(via) = self.held.pop_front() else { return };
        if self.held.is_empty() {
            let speed = |step: &Step| match &step.action {
                Action::Move(motion) => Some(motion.speed),
                _ => None,
            };
            let differ = speed(&via) != speed(&end);
            end.notes.splice(0..0, via.notes);
            if differ {
                end.notes.push(Note::ArcSpeedsDiffer);
            }
            self.ready.push_back(on_circle(end, points, ArcPart::Whole));
        } else {
            self.ready.push_back(on_circle(via, points.clone(), ArcPart::First));
            self.ready.append(&mut self.held);
            self.ready.push_back(on_circle(end, points, ArcPart::Second));
        }
    }
}

fn on_circle(step: Step, points: [Target; 3], part: ArcPart) -> Step {
    let Step { at, action, notes } = step;
    let action = match action {
        Action::Move(motion) => Action::Move(Box::new(Move {
            path: MovePath::Circular(Box::new(CircularArc { points, part })),
            ..*motion
        })),
        other => other,
    };
    Step { at, action, notes }
}
