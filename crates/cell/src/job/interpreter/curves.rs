//! Points whose path is known only when later ones are: MOVC and MOVS.

use super::super::step::{Action, Step};
use super::arcs::Arcs;
use super::splines::Splines;

/// What the point of a move is for its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Point {
    /// A move of its own, or no move at all.
    Single,
    /// A point of MOVC; with `FPT` it ends its arc.
    Circular {
        /// `FPT`.
        fixed: bool,
    },
    /// A point of MOVS.
    Spline,
}

/// A step on its way out of the interpreter.
#[derive(Debug)]
pub(super) struct Raw {
    pub(super) step: Step,
    pub(super) point: Point,
}

/// The steps held back. At most one of the two holds any.
#[derive(Debug, Clone, Default)]
pub(super) struct Curves {
    arcs: Arcs,
    splines: Splines,
}

impl Curves {
    /// The next step that may leave.
    pub(super) fn pop(&mut self) -> Option<Step> {
        // A spline that has ended lies before whatever came after it.
        self.splines.pop().or_else(|| self.arcs.pop())
    }

    /// Takes a step in. All that may leave has left before.
    pub(super) fn push(&mut self, Raw { step, point }: Raw) {
        let is_move = matches!(step.action, Action::Move(_));
        if point == Point::Spline {
            self.arcs.end_run();
            self.splines.push(step);
        } else if self.splines.is_open() && !is_move {
            self.splines.push(step);
        } else {
            self.splines.flush();
            self.arcs.push(step, point);
        }
    }

    /// Nothing more will come.
    pub(super) fn flush(&mut self) {
        self.splines.flush();
        self.arcs.flush();
    }
}
