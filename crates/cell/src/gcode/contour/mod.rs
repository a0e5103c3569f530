//! Rows of short lines as smooth curves.
//!
//! CAM writes a curve as hundreds of chords. Run as they are, with a corner at each, they shake the arm and cost the planner a corner
//! for every tenth of a millimetre. So a row of chords that bends like a curve runs as one: from point to point of it, as far apart
//! as half of the permitted distance allows, leads the polynomial of degree five that has position, tangent and curvature of the
//! smooth curve nearest to the neighbours there. The other half is left to the corners at the row's ends. Where
//! no such curve lies near enough, the chords stay lines.

mod fit;
mod passage;

use std::collections::VecDeque;

use seamline::geometry::Vector3;

use self::passage::passage;
use super::moves::{Holding, Manner};
use crate::job::{Action, CurvePiece, Location, Note, Passage, Step, Zone};

/// Share of the permitted distance that curves may take.
const SHARE: f64 = 0.5;
/// Share of that within which the neighbours of a point have to lie on a smooth curve, for a curve to begin or end there.
const RESIDUAL: f64 = 0.5;
/// Chords of one curve, at most, and those behind its end that are known before it is laid.
const LONGEST: usize = 64;
const BEHIND: usize = 8;
/// A point where the way turns by more than this (rad) is a corner.
const SHARP: f64 = core::f64::consts::FRAC_PI_2;

/// Steps on their way out, the last ones held back until it is known whether they are chords of a curve.
#[derive(Debug, Default)]
pub(super) struct Contour {
    ready: VecDeque<Step>,
    row: Option<Row>,
    lines: u64,
    curves: u64,
    deviation: f64,
}

/// Lines that follow each other and have everything in common but their points.
#[derive(Debug)]
struct Row {
    holding: Holding,
    manner: Manner,
    /// Permitted distance from the lines, and what of it curves may take, in mm.
    permitted: f64,
    tolerance: f64,
    /// The row's start, then the ends of its lines.
    points: Vec<Vector3>,
    /// Where each line stands.
    lines: Vec<Location>,
    /// How the curve before passes the first point.
    entry: Option<Passage>,
    /// The last step, until the next one tells what the corner between them may be; and whether it is a curve.
    last: Option<(Step, bool)>,
}

/// A line to `end`, and how much of the permitted distance curves may take at most, in mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) start: Vector3,
    pub(super) end: Vector3,
    pub(super) merging: f64,
}

impl Contour {
    /// A step that is no line, or one that stops.
    pub(super) fn push(&mut self, step: Step) {
        self.flush();
        self.ready.push_back(step);
    }

    /// A line that may be part of a curve.
    pub(super) fn line(&mut self, at: Location, line: &Line, holding: Holding, manner: Manner) {
        let permitted = match manner.zone {
            Zone::Tolerance { mm } => mm,
            _ => 0.0,
        };
        let tolerance = (SHARE * permitted).min(line.merging);
        if tolerance <= 0.0 {
            self.push(holding.line(at, &line.end, &manner));
            return;
        }
        let goes_on =
            |row: &Row| row.holding == holding && row.manner == manner && row.tolerance == tolerance;
        if !self.row.as_ref().is_some_and(goes_on) {
            self.flush();
            let (points, lines) = (vec![line.start], Vec::new());
            self.row =
                Some(Row { holding, manner, permitted, tolerance, points, lines, entry: None, last: None });
        }
        let Some(mut row) = self.row.take() else { return };
        row.points.push(line.end);
        row.lines.push(at);
        while row.lines.len() > LONGEST + BEHIND {
            self.take_piece(&mut row, false);
        }
        self.row = Some(row);
    }

    /// The end of the program, with what became of its lines.
    pub(super) fn end(&mut self, at: Location) {
        self.flush();
        let (lines, curves, deviation_mm) = (self.lines, self.curves, self.deviation);
        let note = Note::Contours { lines, curves, deviation_mm };
        let notes = if curves > 0 { vec![note] } else { Vec::new() };
        self.ready.push_back(Step { at, action: Action::End, notes });
    }

    pub(super) fn pop(&mut self) -> Option<Step> {
        self.ready.pop_front()
    }

    fn flush(&mut self) {
        let Some(mut row) = self.row.take() else { return };
        // Ends: every turn takes a line at least.
        while !row.lines.is_empty() {
            self.take_piece(&mut row, true);
        }
        if let Some((step, curve)) = row.last.take() {
            self.ready.push_back(row.with_zone(step, curve));
        }
    }

    /// Hands out the first lines of a row: as a curve, or the first one as it is.
    fn take_piece(&mut self, row: &mut Row, closed: bool) {
        let (step, count, curve) = match row.longest_curve(closed) {
            Some(found) => {
                let step = row.holding.curve(row.lines[0].clone(), found.piece, &row.manner);
                self.lines += found.count as u64;
                self.curves += 1;
                self.deviation = self.deviation.max(found.deviation);
                row.entry = (!found.ends_in_corner).then_some(found.piece.end);
                (step, found.count, true)
            }
            None => {
                row.entry = None;
                (row.holding.line(row.lines[0].clone(), &row.points[1], &row.manner), 1, false)
            }
        };
        row.points.drain(..count);
        row.lines.drain(..count);
        if let Some((before, curved)) = row.last.replace((step, curve)) {
            self.ready.push_back(row.with_zone(before, curved || curve));
        }
    }
}

/// A curve for the first lines of a row.
struct Found {
    piece: CurvePiece,
    count: usize,
    deviation: f64,
    ends_in_corner: bool,
}

impl Row {
    /// A step with the corner that it may end in: beside a curve, what curves leave.
    fn with_zone(&self, mut step: Step, beside_curve: bool) -> Step {
        if let Action::Move(r#move) = &mut step.action {
            let mm = if beside_curve { self.permitted - self.tolerance } else { self.permitted };
            r#move.zone = Zone::Tolerance { mm };
        }
        step
    }

    /// The longest curve from the first point on; `None` where not even two lines make one.
    fn longest_curve(&self, closed: bool) -> Option<Found> {
        let corner = (1..self.lines.len()).find(|point| self.is_corner(*point));
        let end = corner.or(closed.then_some(self.lines.len()));
        // Up to a corner or the row's end the points are known; a curve may end there too.
        let smooth = &self.points[..=end.unwrap_or(self.lines.len())];
        let most = end.unwrap_or(self.lines.len().saturating_sub(BEHIND)).min(LONGEST);
        let residual = RESIDUAL * self.tolerance;
        let start = match self.entry {
            Some(entry) => entry,
            None => passage(smooth, 0, true, residual)?,
        };
        let to = |count: usize| {
            let ends_in_corner = Some(count) == end;
            let end = passage(smooth, count, ends_in_corner, residual)?;
            let piece = CurvePiece { start, end };
            let deviation = fit::deviation(&piece, &smooth[..=count], self.tolerance)?;
            Some(Found { piece, count, deviation, ends_in_corner })
        };
        longest(most, to)
    }

    /// Whether no smooth curve passes this point within the tolerance: the circle through it and its neighbours does not.
    fn is_corner(&self, point: usize) -> bool {
        let [before, here, after] = [point - 1, point, point + 1].map(|index| self.points[index]);
        let (arriving, leaving) = (here - before, after - here);
        let (first, second) = (arriving.norm(), leaving.norm());
        let turn = arriving.cross(&leaving).norm().atan2(arriving.dot(&leaving));
        let longer = first.max(second);
        turn > SHARP || longer * longer * turn > 4.0 * (first + second) * self.tolerance
    }
}

/// The longest of the curves over 2 … `most` lines: doubled while they are found, then halved between the last that was and the first
/// that was not.
fn longest(most: usize, to: impl Fn(usize) -> Option<Found>) -> Option<Found> {
    let mut best: Option<Found> = None;
    let (mut count, mut failed) = (2, most + 1);
    while count <= most {
        match to(count) {
            Some(found) => best = Some(found),
            None => {
                failed = count;
                break;
            }
        }
        count = if count == most { most + 1 } else { (2 * count).min(most) };
    }
    // Ends: the interval is halved in each turn.
    while let Some(known) = best.as_ref().map(|found| found.count).filter(|known| failed - known > 1) {
        let middle = known + (failed - known) / 2;
        match to(middle) {
            Some(found) => best = Some(found),
            None => failed = middle,
        }
    }
    best
}
