//! One axis with limited jerk: when it can arrive. See `docs/otg.md`, sections 4 and 5.
//!
//! For a fixed duration T the displacements that can be reached form one interval, [P⁻(T), P⁺(T)]. So T is possible exactly where the interval
//! holds the displacement asked for, the least duration is the first such T, and the others are found by the same test.

use super::extremal::{Extremal, Family, Problem, Shape};
use super::fixed_duration::Mixture;
use super::number::{NOISE, larger};

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
        // At the start both families have the same motion.
        let resolution = self.resolution(self.start.t);
        if p > self.start.p + resolution {
            self.up_to(&self.start)
        } else if p < self.start.p - resolution {
            let down = self.down();
            self.down_to(&down, &down.at_start())
        } else {
            Arrival::up(&self.up, &self.start)
        }
    }

    /// The mean of the two extreme motions that arrives after the time `t`, if it is a possible one.
    pub(super) fn mixture(&self, t: f64) -> Option<Mixture> {
        let families = self.families();
        let on_island = t < self.start.t;
        if on_island {
            let (first, last) = families.island()?;
            if t < first.t || t > last.t {
                return None;
            }
        }
        let Span { up, down } = families.span(t, on_island);
        let p = self.problem.displacement;
        let reach = up.p + down.p;
        let possible = p <= up.p && -p <= down.p;
        possible.then(|| {
            let share = if reach > 0.0 { (p + down.p) / reach } else { 1.0 };
            Mixture { up: families.up.shape(&up), down: families.down.shape(&down), share }
        })
    }

    /// Before the times that are possible for good there may be an interval of possible ones, an island, if the acceleration need not
    /// change its sign.
    fn earliest_on_island(&self, from: f64) -> Option<Arrival> {
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
        Self { t: extremal.t, sign: 1.0, shape: family.shape(extremal) }
    }

    fn down(family: &Family, extremal: &Extremal) -> Self {
        Self { t: extremal.t, sign: -1.0, shape: family.shape(extremal) }
    }
}
