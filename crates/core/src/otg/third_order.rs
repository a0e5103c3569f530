//! One axis with limited jerk: when it can arrive. See `docs/otg.md`, sections 4 and 5.
//!
//! For a fixed duration T the displacements that can be reached form one interval, [P⁻(T), P⁺(T)]. So T is possible exactly where the interval
//! holds the displacement asked for, the least duration is the first such T, and the others are found by the same test.

use super::extremal::{Extremal, Family, Problem, Shape};
use super::fixed_duration::Mixture;
use super::number::{NOISE, larger, smaller};

/// The axis' problem, ready to be asked when the axis can arrive.
#[derive(Debug, Clone, Copy)]
pub(super) struct ThirdOrder {
    pub(super) problem: Problem,
    /// The motions that get farthest forward. Those that get farthest backward are made from the mirrored problem where
    /// they are needed.
    up: Family,
    /// The possible times begin here for good; one motion only takes this time.
    start: Extremal,
    /// Uncertainty of the displacement, because its ends are large.
    coordinates: f64,
    /// Uncertainty of a displacement per time it takes, from the rounding of its terms.
    rounding: f64,
}

/// An extreme motion that meets the target: when, which way, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrival {
    pub(super) t: f64,
    pub(super) sign: f64,
    pub(super) shape: Shape,
    /// The start differs from the motion's by rounding: the motion is reckoned back from the target to there, so that the difference does
    /// not stay.
    pub(super) from_end: bool,
}

/// A motion of given duration.
#[derive(Debug, Clone, Copy)]
pub(super) enum Passage {
    /// The weighted mean of the two extreme ones.
    Mean(Mixture),
    /// One of them.
    Extreme(Arrival),
}

/// The two extreme motions of one duration; backward as seen in the mirror.
#[derive(Debug, Clone, Copy)]
struct Span {
    up: Extremal,
    down: Extremal,
}

/// Both families.
#[derive(Debug, Clone, Copy)]
struct Families {
    up: Family,
    down: Family,
}

/// Where a displacement lies with regard to a span.
enum Side {
    Above,
    Inside,
    Below,
}

impl ThirdOrder {
    /// `coordinates`: how far the displacement may be off because its ends are large.
    pub(super) fn new(problem: Problem, coordinates: f64) -> Self {
        let Problem { v0, a0, vf, af, .. } = problem;
        let up = Family::new(&problem);
        let start = up.at_start();
        let terms = v0.abs() + vf.abs() + a0 * a0 + af * af + start.x * start.x;
        Self { problem, up, start, coordinates, rounding: NOISE * terms }
    }

    /// Displacements of about this duration that are closer than this are one.
    fn resolution(&self, t: f64) -> f64 {
        self.coordinates + self.rounding * t
    }

    /// The first arrival at or after the time `from`, at which the axis cannot arrive (or `from` is 0).
    pub(super) fn earliest(&self, from: f64) -> Arrival {
        if let Some(arrival) = self.earliest_on_island(from) {
            return arrival;
        }
        let p = self.problem.displacement;
        if from > self.start.t {
            let families = self.families();
            let span = families.span(from, false);
            return match self.side(&span, self.resolution(from)) {
                Side::Inside => families.nearest(p, &span),
                Side::Above => self.up_to(&span.up),
                Side::Below => self.down_to(&families.down, &span.down),
            };
        }
        self.earliest_from_start(p)
    }

    /// The same problem, with the target nearer by the rounding of positions as `arrival` comes to it.
    pub(super) fn nearer(&self, arrival: &Arrival) -> Self {
        let mut nearer = *self;
        nearer.problem.displacement -= arrival.sign * self.resolution(arrival.t);
        nearer
    }

    /// The first arrival on the main arc. At its start both families have the same motion.
    fn earliest_from_start(&self, p: f64) -> Arrival {
        let start = &self.start;
        if (p - start.p).abs() <= self.resolution(start.t) {
            return Arrival { from_end: true, ..Arrival::up(&self.up, start) };
        }
        // Where the way leads on towards p, the time grows from the start's on as p does. Otherwise the axis has to come round again, and must
        // not do so for a rounding error.
        if p > start.p {
            let round_again = start.slope <= 0.0;
            self.near_start(p, round_again).unwrap_or_else(|| self.up_to(start))
        } else {
            let down = self.down();
            let down_start = down.at_start();
            let round_again = down_start.slope <= 0.0;
            self.near_start(p, round_again).unwrap_or_else(|| self.down_to(&down, &down_start))
        }
    }

    /// The motion at the start, moved by the rounding of the velocities so that it leads to `p`.
    fn near_start(&self, p: f64, round_again: bool) -> Option<Arrival> {
        if !round_again {
            return None;
        }
        let near = self.up.moved_start(&self.start, (p - self.start.p) / self.start.slope, self.rounding)?;
        Some(Arrival { from_end: true, ..Arrival::up(&self.up, &near) })
    }

    /// The extreme motion that arrives after the time `t`, if one does but for rounding.
    #[cold]
    fn nearest_at(&self, t: f64, span: Option<&Span>) -> Option<Arrival> {
        let p = self.problem.displacement;
        let resolution = self.resolution(t);
        if let Some(span) = span {
            let arrival = self.families().nearest(p, span);
            let off = smaller((span.up.p - p).abs(), (span.down.p + p).abs());
            return (off <= resolution).then_some(Arrival { from_end: true, ..arrival });
        }
        let moved = self.up.moved_start(&self.start, t - self.start.t, self.rounding)?;
        let close = (moved.p - p).abs() <= resolution;
        close.then_some(Arrival { from_end: true, ..Arrival::up(&self.up, &moved) })
    }

    /// As [`Self::at`], before the times that are possible for good.
    pub(super) fn at_on_island(&self, t: f64) -> Option<Passage> {
        if t < self.start.t { self.at(t) } else { None }
    }

    /// The motion that arrives after the time `t`, if it is a possible one: between the two extreme ones, or one of them.
    pub(super) fn at(&self, t: f64) -> Option<Passage> {
        let families = self.families();
        let on_island = t < self.start.t;
        if on_island && !families.island().is_some_and(|(first, last)| first.t <= t && t <= last.t) {
            return self.nearest_at(t, None).map(Passage::Extreme);
        }
        let span = families.span(t, on_island);
        let Span { up, down } = span;
        let p = self.problem.displacement;
        if p > up.p || -p > down.p {
            return self.nearest_at(t, Some(&span)).map(Passage::Extreme);
        }
        let reach = up.p + down.p;
        let share = if reach > 0.0 { (p + down.p) / reach } else { 1.0 };
        Some(Passage::Mean(Mixture { up: families.up.shape(&up), down: families.down.shape(&down), share }))
    }

    /// Before the times that are possible for good there may be an interval of possible ones, an island, if the acceleration need not
    /// change its sign.
    pub(super) fn earliest_on_island(&self, from: f64) -> Option<Arrival> {
        let Problem { displacement: p, v0, a0, vf, af, .. } = self.problem;
        // The velocity must change by more than on the straight way from a₀ to a_f, and by less than on the way via zero. (Not by
        // rounding: the families decide.)
        let (change, sum) = ((vf - v0).abs(), a0 * a0 + af * af);
        let direct = (a0 * a0 - af * af).abs();
        let slack = NOISE * (v0.abs() + vf.abs() + sum);
        if a0 * af <= 0.0
            || 0.5 * direct > change + slack
            || change > 0.5 * sum + slack
            || from >= self.start.t
        {
            return None;
        }
        let families = self.families();
        if let Some((first, last)) = families.island() {
            if from > last.t {
                return None;
            }
            let span = families.span(larger(from, first.t), true);
            let resolution = self.resolution(last.t);
            return match self.side(&span, resolution) {
                Side::Inside => Some(families.nearest(p, &span)),
                Side::Above => {
                    let extremal = families.up.first_reaching_on_island(p, &span.up, resolution)?;
                    Some(Arrival::up(&families.up, &extremal))
                }
                Side::Below => {
                    let extremal = families.down.first_reaching_on_island(-p, &span.down, resolution)?;
                    Some(Arrival::down(&families.down, &extremal))
                }
            };
        }
        // An island of one motion only, which rounding has hidden from one of the families.
        let meets = |extremal: &Extremal, p: f64| {
            from <= extremal.t && (p - extremal.p).abs() <= self.resolution(extremal.t)
        };
        match (families.up.island(), families.down.island()) {
            (Some((only, _)), None) if meets(&only, p) => Some(Arrival::up(&families.up, &only)),
            (None, Some((only, _))) if meets(&only, -p) => Some(Arrival::down(&families.down, &only)),
            _ => None,
        }
    }

    fn up_to(&self, from: &Extremal) -> Arrival {
        let extremal = self.up.first_reaching(self.problem.displacement, from, self.resolution(from.t));
        Arrival::up(&self.up, &extremal)
    }

    fn down_to(&self, down: &Family, from: &Extremal) -> Arrival {
        Arrival::down(down, &down.first_reaching(-self.problem.displacement, from, self.resolution(from.t)))
    }

    fn down(&self) -> Family {
        Family::new(&self.problem.mirror())
    }

    fn families(&self) -> Families {
        Families { up: self.up, down: self.down() }
    }

    fn side(&self, span: &Span, resolution: f64) -> Side {
        let p = self.problem.displacement;
        if p > span.up.p + resolution {
            Side::Above
        } else if -p > span.down.p + resolution {
            Side::Below
        } else {
            Side::Inside
        }
    }
}

impl Families {
    /// First and last motion of the island, if both families have one.
    fn island(&self) -> Option<(Extremal, Extremal)> {
        self.down.island().and(self.up.island())
    }

    /// The one of the two motions that meets the displacement but for rounding.
    fn nearest(&self, p: f64, span: &Span) -> Arrival {
        if span.up.p - p <= p + span.down.p {
            Arrival::up(&self.up, &span.up)
        } else {
            Arrival::down(&self.down, &span.down)
        }
    }

    fn span(&self, t: f64, on_island: bool) -> Span {
        Span { up: self.up.at_duration(t, on_island), down: self.down.at_duration(t, on_island) }
    }
}

impl Arrival {
    fn up(family: &Family, extremal: &Extremal) -> Self {
        Self { t: extremal.t, sign: 1.0, shape: family.shape(extremal), from_end: false }
    }

    fn down(family: &Family, extremal: &Extremal) -> Self {
        Self { t: extremal.t, sign: -1.0, shape: family.shape(extremal), from_end: false }
    }
}
