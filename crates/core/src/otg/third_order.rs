//! One axis with limited jerk: when it can arrive. See `docs/otg.md`, sections 4 and 5.
//!
//! For a fixed duration T the displacements that can be reached form one interval, [P⁻(T), P⁺(T)]. So T is possible exactly where the interval
//! holds the displacement asked for, the least duration is the first such T, and the others are found by the same test.

use super::extremal::{Extremal, Family, Problem};

/// The axis' problem with the motions that get farthest either way.
#[derive(Debug, Clone, Copy)]
pub(super) struct ThirdOrder {
    pub(super) problem: Problem,
    /// Farthest forward.
    pub(super) up: Family,
    /// Farthest backward, as the farthest forward of the mirrored problem.
    pub(super) down: Family,
    /// The possible times begin here for good; one motion only takes this time.
    start: Extremal,
    /// Uncertainty of the displacement, from the rounding of the coordinates.
    resolution: f64,
}

/// Which way an extreme motion goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Up,
    Down,
}

/// An extreme motion that meets the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrival {
    pub(super) direction: Direction,
    pub(super) extremal: Extremal,
}

/// The two extreme motions of one duration; backward as seen in the mirror.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) up: Extremal,
    pub(super) down: Extremal,
}

/// Where a displacement lies with regard to a span.
enum Side {
    Above,
    Inside,
    Below,
}

/// Rounding of a displacement, as a fraction of the sum of its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl ThirdOrder {
    /// `resolution`: how far the displacement may be off because its ends are large.
    pub(super) fn new(problem: Problem, resolution: f64) -> Self {
        let up = Family::new(&problem);
        let down = Family::new(&problem.mirror());
        let start = up.at_start();
        let terms = problem.v0.abs()
            + problem.vf.abs()
            + problem.a0 * problem.a0
            + problem.af * problem.af
            + start.x * start.x;
        let resolution = resolution + ROUNDING * terms * start.t;
        let (up, down) = (up.with_resolution(resolution), down.with_resolution(resolution));
        Self { problem, up, down, start, resolution }
    }

    /// The first arrival at or after the time `from`, at which the axis cannot arrive (or `from` is 0).
    pub(super) fn earliest(&self, from: f64) -> Arrival {
        if let Some(arrival) = self.earliest_on_island(from) {
            return arrival;
        }
        let p = self.problem.displacement;
        let span = if from <= self.start.t {
            Span { up: self.start, down: self.down.at_start() }
        } else {
            self.span(from, false)
        };
        match self.side(&span) {
            Side::Inside => Arrival::up(span.up),
            Side::Above => Arrival::up(self.up.first_reaching(p, &span.up)),
            Side::Below => Arrival::down(self.down.first_reaching(-p, &span.down)),
        }
    }

    fn earliest_on_island(&self, from: f64) -> Option<Arrival> {
        let p = self.problem.displacement;
        let meets =
            |extremal: &Extremal, p: f64| from <= extremal.t && (p - extremal.p).abs() <= self.resolution;
        match (self.up.island(), self.down.island()) {
            (Some((first, last)), Some(_)) if from <= last.t => {
                let span = self.span(from.max(first.t), true);
                match self.side(&span) {
                    Side::Inside => Some(Arrival::up(span.up)),
                    Side::Above => self.up.first_reaching_on_island(p, &span.up).map(Arrival::up),
                    Side::Below => self.down.first_reaching_on_island(-p, &span.down).map(Arrival::down),
                }
            }
            // An island of one motion only, which rounding has hidden from one of the families.
            (Some((only, _)), None) if meets(&only, p) => Some(Arrival::up(only)),
            (None, Some((only, _))) if meets(&only, -p) => Some(Arrival::down(only)),
            _ => None,
        }
    }

    /// The extreme motions of duration `t`, if the axis can arrive then.
    pub(super) fn reachable(&self, t: f64) -> Option<Span> {
        let on_island = t < self.start.t;
        if on_island {
            let ((first, last), _) = (self.up.island()?, self.down.island()?);
            if t < first.t || t > last.t {
                return None;
            }
        }
        let span = self.span(t, on_island);
        let p = self.problem.displacement;
        (p <= span.up.p && -p <= span.down.p).then_some(span)
    }

    #[inline]
    fn span(&self, t: f64, on_island: bool) -> Span {
        Span { up: self.up.at_duration(t, on_island), down: self.down.at_duration(t, on_island) }
    }

    fn side(&self, span: &Span) -> Side {
        let p = self.problem.displacement;
        if p > span.up.p + self.resolution {
            Side::Above
        } else if -p > span.down.p + self.resolution {
            Side::Below
        } else {
            Side::Inside
        }
    }
}

impl Arrival {
    fn up(extremal: Extremal) -> Self {
        Self { direction: Direction::Up, extremal }
    }

    fn down(extremal: Extremal) -> Self {
        Self { direction: Direction::Down, extremal }
    }
}
