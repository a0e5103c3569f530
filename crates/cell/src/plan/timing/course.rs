//! What is asked for along a path: stretches with limits of their own, and how the path begins and ends.

use super::{Order, PathLimits, TimingError};

/// A part of a path with limits of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Path coordinate up to which the limits hold, from where those of the stretch before end.
    pub to: f64,
    /// The limits.
    pub limits: PathLimits,
}

/// A path's limits from its start to its end, and what lies before and behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course<'a> {
    /// In order of the path; the last one ends where the path does.
    pub stretches: &'a [Stretch],
    /// Speed at the start, where there is no acceleration; 0 is rest. Any other has been reached by an earlier
    /// timing, at the place up to which it was [`settled`](super::Timing::settled).
    pub start: f64,
    /// The path will go on. Its end is at rest only until more is known, and
    /// [`Timing::settled`](super::Timing::settled) tells what does not depend on that.
    pub open: bool,
}

impl<'a> Course<'a> {
    /// From rest to rest, and nothing follows.
    #[must_use]
    pub fn whole(stretches: &'a [Stretch]) -> Self {
        Self { stretches, start: 0.0, open: false }
    }
}

/// How near to the end of the path the last stretch has to end, and how near limits are the same, as shares.
const SAME: f64 = 1e-9;
/// Two places nearer than this share of the length are one.
const SAME_PLACE: f64 = 1e-12;

/// The limits along a path, neighbours with the same limits taken together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Limits {
    stretches: Vec<Stretch>,
    length: f64,
}

impl Limits {
    /// # Errors
    /// Where a limit is unusable, or the stretches are not in order or do not end with the path.
    pub(super) fn new<E>(stretches: &[Stretch], length: f64) -> Result<Self, TimingError<E>> {
        let usable = |value: f64| value > 0.0 && value.is_finite();
        let mut merged: Vec<Stretch> = Vec::new();
        let mut begun = 0.0;
        for (index, stretch) in stretches.iter().enumerate() {
            let limits = &stretch.limits;
            let orders = [
                (Order::Velocity, limits.speed),
                (Order::Acceleration, limits.acceleration),
                (Order::Jerk, limits.jerk),
            ];
            for (order, value) in orders {
                if !usable(value) {
                    return Err(TimingError::PathLimit { order, value });
                }
            }
            let last = index + 1 == stretches.len();
            let ends = (stretch.to - length).abs() <= SAME * length;
            if !(stretch.to >= begun && stretch.to.is_finite()) || (last && !ends) {
                return Err(TimingError::Stretch { index, to: stretch.to });
            }
            let to = if last { length } else { stretch.to.min(length) };
            begun = to;
            match merged.last_mut() {
                Some(before) if alike(&before.limits, limits) => {
                    *before = Stretch { to, limits: least(&before.limits, limits) };
                }
                _ => merged.push(Stretch { to, limits: *limits }),
            }
        }
        if merged.is_empty() {
            return Err(TimingError::Stretch { index: 0, to: 0.0 });
        }
        Ok(Self { stretches: merged, length })
    }

    /// The stretches with their starts: (from, to, limits). Those without length are left out.
    pub(super) fn parts(&self) -> impl Iterator<Item = (f64, f64, PathLimits)> {
        let starts = core::iter::once(0.0).chain(self.stretches.iter().map(|stretch| stretch.to));
        starts
            .zip(&self.stretches)
            .map(|(from, stretch)| (from, stretch.to, stretch.limits))
            .filter(|(from, to, _)| to > from)
    }

    /// The least limits of all stretches between two places. Of a single place on a boundary: of both sides.
    pub(super) fn within(&self, from: f64, to: f64) -> PathLimits {
        if let [only] = &self.stretches[..] {
            return only.limits;
        }
        // What ends where this begins does not matter, give or take rounding.
        let inset = (SAME_PLACE * self.length).min((to - from).max(0.0) / 2.0);
        let (from, to) = (from + inset, to - inset);
        let last = self.stretches.len() - 1;
        let first = self.stretches.partition_point(|stretch| stretch.to < from).min(last);
        let mut limits = self.stretches[first].limits;
        for pair in self.stretches[first..].windows(2) {
            if pair[0].to > to {
                break;
            }
            limits = least(&limits, &pair[1].limits);
        }
        limits
    }

    /// The limits from a place on, which becomes the start.
    pub(super) fn after(&self, place: f64) -> Self {
        let ahead = self.stretches.iter().filter(|stretch| stretch.to > place);
        let stretches = ahead.map(|stretch| Stretch { to: stretch.to - place, ..*stretch }).collect();
        Self { stretches, length: self.length - place }
    }

    /// The stretches that lie between two places, or reach into what does.
    pub(super) fn between(&self, from: f64, to: f64) -> core::ops::Range<usize> {
        let first = self.stretches.partition_point(|stretch| stretch.to <= from);
        let last = self.stretches.partition_point(|stretch| stretch.to < to);
        first..(last + 1).min(self.stretches.len())
    }

    /// Limits of each stretch, in order.
    pub(super) fn all_mut(&mut self) -> impl Iterator<Item = &mut PathLimits> {
        self.stretches.iter_mut().map(|stretch| &mut stretch.limits)
    }

    /// Limits of each stretch, in order.
    pub(super) fn all(&self) -> impl Iterator<Item = &PathLimits> {
        self.stretches.iter().map(|stretch| &stretch.limits)
    }
}

/// The lesser limit of each order.
pub(in crate::plan) fn least(a: &PathLimits, b: &PathLimits) -> PathLimits {
    PathLimits {
        speed: a.speed.min(b.speed),
        acceleration: a.acceleration.min(b.acceleration),
        jerk: a.jerk.min(b.jerk),
    }
}

fn alike(a: &PathLimits, b: &PathLimits) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a;
    same(a.speed, b.speed) && same(a.acceleration, b.acceleration) && same(a.jerk, b.jerk)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stretch(to: f64, speed: f64) -> Stretch {
        Stretch { to, limits: PathLimits { speed, acceleration: 10.0 / speed, jerk: 500.0 } }
    }

    #[test]
    fn limits_are_found_by_place() {
        let stretches = [stretch(1.0, 0.5), stretch(2.0, 0.5), stretch(2.0, 0.01), stretch(3.0, 0.2)];
        let limits = Limits::new::<()>(&stretches, 3.0).unwrap();
        let speeds: Vec<(f64, f64, f64)> =
            limits.parts().map(|(from, to, limits)| (from, to, limits.speed)).collect();
        assert_eq!(speeds, [(0.0, 2.0, 0.5), (2.0, 3.0, 0.2)]);
        let limits = Limits::new::<()>(&[stretch(2.0, 0.5), stretch(3.0, 0.2)], 3.0).unwrap();
        for (from, to, speed) in [
            (0.0, 1.9, 0.5),
            (1.9, 2.0, 0.5),
            (2.0, 2.1, 0.2),
            (1.9, 2.1, 0.2),
            (2.0, 2.0, 0.2),
            (3.0, 3.0, 0.2),
        ] {
            assert_eq!(limits.within(from, to).speed, speed, "{from} {to}");
        }
        // Over both, the slower speed and the lesser acceleration, from different sides.
        assert_eq!(limits.within(1.5, 2.5).acceleration, 20.0);
    }

    #[test]
    fn stretches_out_of_order_are_refused() {
        let refused = |stretches: &[Stretch]| Limits::new::<()>(stretches, 3.0).unwrap_err();
        assert!(matches!(refused(&[]), TimingError::Stretch { index: 0, .. }));
        assert!(matches!(refused(&[stretch(2.0, 0.5)]), TimingError::Stretch { index: 0, .. }));
        let turned = [stretch(2.0, 0.5), stretch(1.0, 0.5), stretch(3.0, 0.5)];
        assert_eq!(refused(&turned), TimingError::Stretch { index: 1, to: 1.0 });
    }
}
