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

/// A displacement that differs by more, relatively, is not met by what the root search leaves, but taken for equal.
const EXACT: f64 = 16.0 * f64::EPSILON;

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
        if from > 0.0
            && let families = self.families()
            && families.on_island(from) == Some(false)
        {
            let span = families.span(from, false);
            return match self.side(&span, self.resolution(from)) {
                Side::Inside => families.nearest(self.problem.displacement, &span),
                Side::Above => self.up_to(&span.up),
                Side::Below => self.down_to(&families.down, &span.down),
            };
        }
        self.earliest_from_start(from)
    }

    /// The same problem, with the target nearer by the rounding of positions as `arrival` comes to it.
    pub(super) fn nearer(&self, arrival: &Arrival) -> Self {
        let mut nearer = *self;
        nearer.problem.displacement -= arrival.sign * self.resolution(arrival.t);
        nearer
    }

    /// The first arrival on the main arc, whose start is not before `from` but for rounding. There both families have the same motion.
    fn earliest_from_start(&self, from: f64) -> Arrival {
        let (p, start) = (self.problem.displacement, &self.start);
        if (p - start.p).abs() <= self.resolution(start.t) && start.t >= from {
            return Arrival::up(&self.up, start, p);
        }
        // Where the way leads on towards p, the time grows from the start's on as p does. Otherwise the axis has to come round again, and must
        // not do so for a rounding error.
        let near = |slope: f64| {
            let near = if slope > 0.0 { None } else { self.near_start() };
            near.filter(|arrival| arrival.t >= from)
        };
        if p > start.p {
            near(start.slope).unwrap_or_else(|| self.up_to(start))
        } else {
            let down = self.down();
            let down_start = down.at_start();
            near(down_start.slope).unwrap_or_else(|| self.down_to(&down, &down_start))
        }
    }

    /// The motion at the start, if other velocities within rounding let it lead to the target.
    #[cold]
    fn near_start(&self) -> Option<Arrival> {
        let (p, start) = (self.problem.displacement, &self.start);
        let near = self.up.moved_start(start, (p - start.p) / start.slope, self.rounding)?;
        Some(Arrival::moved(&self.up, &near, 1.0))
    }

    /// As [`Self::at`], before the times that are possible for good.
    pub(super) fn at_on_island(&self, t: f64) -> Option<Passage> {
        if t >= self.start.t {
            return None;
        }
        let families = self.families();
        match families.on_island(t) {
            Some(true) => self.between_extremes(&families, t, true),
            Some(false) => None,
            None => self.near_ends_at(&families, t, false).map(Passage::Extreme),
        }
    }

    /// The motion that arrives after the time `t`, if it is a possible one: between the two extreme ones, or one of them.
    pub(super) fn at(&self, t: f64) -> Option<Passage> {
        let families = self.families();
        match families.on_island(t) {
            Some(on_island) => self.between_extremes(&families, t, on_island),
            None => self.near_ends_at(&families, t, true).map(Passage::Extreme),
        }
    }

    fn between_extremes(&self, families: &Families, t: f64, on_island: bool) -> Option<Passage> {
        let p = self.problem.displacement;
        let span = families.span(t, on_island);
        let Span { up, down } = span;
        if p <= up.p && -p <= down.p {
            let reach = up.p + down.p;
            let share = if reach > 0.0 { (p + down.p) / reach } else { 1.0 };
            let (up, down) = (families.up.shape(&up), families.down.shape(&down));
            return Some(Passage::Mean(Mixture { up, down, share }));
        }
        let close = matches!(self.side(&span, 16.0 * self.resolution(t)), Side::Inside);
        close.then(|| Passage::Extreme(families.nearest(p, &span)))
    }

    /// The motion at an end of the island, or at the start of the main arc, that takes the time `t` and leads to the target but for rounding.
    #[cold]
    fn near_ends_at(&self, families: &Families, t: f64, with_main_arc: bool) -> Option<Arrival> {
        let (p, noise, resolution) = (self.problem.displacement, self.rounding, 16.0 * self.resolution(t));
        let near = |sign: f64| {
            let family = if sign > 0.0 { &families.up } else { &families.down };
            let leads = |moved: &Extremal| (moved.p - sign * p).abs() <= resolution;
            let start = family.at_start();
            let start = if with_main_arc { family.moved_start(&start, t - start.t, noise) } else { None };
            let island = || family.moved_island(|end| t - end.t, noise);
            let found = start.filter(leads).or_else(|| island().filter(leads))?;
            Some(Arrival::moved(family, &found, sign))
        };
        near(1.0).or_else(|| near(-1.0))
    }

    /// Before the times that are possible for good there may be an interval of possible ones, an island, if the acceleration need not
    /// change its sign.
    pub(super) fn earliest_on_island(&self, from: f64) -> Option<Arrival> {
        let Problem { v0, a0, vf, af, .. } = self.problem;
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
        let arrival = match families.island() {
            Some((first, last)) if from <= last => {
                let span = families.span(larger(from, first), true);
                self.earliest_from_span(&families, &span, self.resolution(last))
            }
            _ => None,
        };
        // An island of one motion only may be hidden from one of the families by rounding, or from both.
        arrival.or_else(|| self.near_island(&families).filter(|arrival| arrival.t >= from))
    }

    fn earliest_from_span(&self, families: &Families, span: &Span, resolution: f64) -> Option<Arrival> {
        let p = self.problem.displacement;
        match self.side(span, resolution) {
            Side::Inside => Some(families.nearest(p, span)),
            Side::Above => {
                let extremal = families.up.first_reaching_on_island(p, &span.up, resolution)?;
                Some(Arrival::up(&families.up, &extremal, p))
            }
            Side::Below => {
                let extremal = families.down.first_reaching_on_island(-p, &span.down, resolution)?;
                Some(Arrival::down(&families.down, &extremal, p))
            }
        }
    }

    /// The motion at an end of the island, if other velocities within rounding let it lead to the target.
    #[cold]
    fn near_island(&self, families: &Families) -> Option<Arrival> {
        let near = |sign: f64| {
            let family = if sign > 0.0 { &families.up } else { &families.down };
            let more = |end: &Extremal| {
                let off = sign * self.problem.displacement - end.p;
                if off.abs() <= self.resolution(end.t) { 0.0 } else { off / end.slope }
            };
            Some(Arrival::moved(family, &family.moved_island(more, self.rounding)?, sign))
        };
        near(1.0).or_else(|| near(-1.0))
    }

    fn up_to(&self, from: &Extremal) -> Arrival {
        let p = self.problem.displacement;
        Arrival::up(&self.up, &self.up.first_reaching(p, from, self.resolution(from.t)), p)
    }

    fn down_to(&self, down: &Family, from: &Extremal) -> Arrival {
        let p = self.problem.displacement;
        Arrival::down(down, &down.first_reaching(-p, from, self.resolution(from.t)), p)
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
    /// First and last time of the island, if both families have one.
    fn island(&self) -> Option<(f64, f64)> {
        let ((first, last), (other_first, other_last)) = (self.up.island()?, self.down.island()?);
        Some((larger(first.t, other_first.t), smaller(last.t, other_last.t)))
    }

    /// Whether the time `t` is one of the island or, if not, of the main arcs; rounding may have moved the ends of one or the other family.
    fn on_island(&self, t: f64) -> Option<bool> {
        if t >= self.up.at_start().t && t >= self.down.at_start().t {
            return Some(false);
        }
        self.island().is_some_and(|(first, last)| first <= t && t <= last).then_some(true)
    }

    /// The one of the two motions that meets the displacement but for rounding.
    fn nearest(&self, p: f64, span: &Span) -> Arrival {
        if span.up.p - p <= p + span.down.p {
            Arrival::up(&self.up, &span.up, p)
        } else {
            Arrival::down(&self.down, &span.down, p)
        }
    }

    fn span(&self, t: f64, on_island: bool) -> Span {
        Span { up: self.up.at_duration(t, on_island), down: self.down.at_duration(t, on_island) }
    }
}

impl Arrival {
    fn up(family: &Family, extremal: &Extremal, p: f64) -> Self {
        let from_end = (extremal.p - p).abs() > EXACT * p.abs();
        Self { from_end, ..Self::moved(family, extremal, 1.0) }
    }

    fn down(family: &Family, extremal: &Extremal, p: f64) -> Self {
        let from_end = (extremal.p + p).abs() > EXACT * p.abs();
        Self { from_end, ..Self::moved(family, extremal, -1.0) }
    }

    /// A motion that leads to the target but for rounding.
    fn moved(family: &Family, extremal: &Extremal, sign: f64) -> Self {
        Self { t: extremal.t, sign, shape: family.shape(extremal), from_end: true }
    }
}
