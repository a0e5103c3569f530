//! Where the program is, as far as the arm has come.

use crate::arc::ArcSetting;

/// Changes that may be under way.
const CHANGES: usize = 256;
/// Rounding of a way that went through a prefilter, in metres.
const ROUNDING: f64 = 1e-9;

/// A place of the program.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Mark {
    pub(super) line: u32,
    pub(super) segment: u32,
    pub(super) marker: u32,
    pub(super) arc: bool,
    pub(super) setting: ArcSetting,
}

/// Path covered by the program since its start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Way {
    /// In the unit of each path, and in seconds for a move of the joints.
    pub(super) path: f64,
    /// By the tool along its paths, in metres.
    pub(super) tool: f64,
}

impl Way {
    /// This way and another one after it.
    pub(super) fn plus(self, other: Self) -> Self {
        Self { path: self.path + other.path, tool: self.tool + other.tool }
    }
}

/// Marks that lie on the way between the program and the arm.
///
/// A prefilter lets the arm lag the program by some of its path. Marks wait at the place of the path where they were set, and the arm picks
/// them up there. With more than 256 under way, the oldest is picked up before.
#[derive(Debug, Clone)]
pub(super) struct Trail {
    /// Way from the program's start, and what holds from there on.
    changes: [(f64, Mark); CHANGES],
    first: usize,
    count: usize,
    /// What holds at the program, and at the arm.
    set: Mark,
    reached: Mark,
}

impl Trail {
    /// Nothing under way.
    pub(super) fn at(mark: Mark) -> Self {
        Self { changes: [(0.0, mark); CHANGES], first: 0, count: 0, set: mark, reached: mark }
    }

    /// Forgets what is under way.
    pub(super) fn reset(&mut self, mark: Mark) {
        (self.count, self.set, self.reached) = (0, mark, mark);
    }

    /// Takes the mark that holds from the way `since` on, and gives the one that holds at the way `reached`.
    pub(super) fn pass(&mut self, mark: Mark, since: f64, reached: f64) -> Mark {
        if mark != self.set {
            if self.count == CHANGES {
                self.pick_up();
            }
            self.changes[(self.first + self.count) % CHANGES] = (since, mark);
            self.count += 1;
            self.set = mark;
        }
        // At most all of them.
        while self.count > 0 && self.changes[self.first].0 <= reached + ROUNDING {
            self.pick_up();
        }
        self.reached
    }

    fn pick_up(&mut self) {
        self.reached = self.changes[self.first].1;
        self.first = (self.first + 1) % CHANGES;
        self.count -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(line: u32) -> Mark {
        Mark { line, ..Mark::default() }
    }

    #[test]
    fn marks_are_picked_up_where_they_were_set() {
        let mut trail = Trail::at(mark(0));
        for step in 0..2_000_u32 {
            let way = f64::from(step) * 0.1;
            // A new mark at each whole way; the arm is 2.5 behind.
            let line = step / 10;
            let found = trail.pass(mark(line), f64::from(line), way - 2.5);
            assert_eq!(found.line, (step.max(25) - 25) / 10, "{step}");
        }
        assert_eq!(trail.pass(mark(199), 199.0, 199.9), mark(199));
        trail.reset(mark(7));
        assert_eq!(trail.pass(mark(7), 0.0, 0.0), mark(7));
    }

    #[test]
    fn with_too_many_under_way_the_oldest_goes_first() {
        let mut trail = Trail::at(mark(0));
        for line in 1..=300 {
            let found = trail.pass(mark(line), f64::from(line), 0.0);
            assert_eq!(found.line, line.saturating_sub(CHANGES as u32));
        }
    }
}
