//! The whole motion: the plain one wherever the joints can follow it, and windows solved around the rest.

use super::check::{Check, Load};
use super::coordinate::End;
use super::course::Limits;
use super::gentler::Lower;
use super::motion::{Timing, TimingKind, TimingPiece, duration, stretched};
use super::plain::Plain;
use super::slowdown::slowdowns;
use super::window::{Passage, ROUNDING, Window, Workshop};
use super::{JointPath, TimingError, TimingLimits};

/// Share of a limit from which on the plain motion is not trusted to leave room for braking.
const BUSY: f64 = 0.9;
/// A window reaches this many times the longest braking beyond what the joints cannot follow; where that was too
/// narrow, so many times as far, in so many rounds.
const REACH: f64 = 1.5;
const WIDER: f64 = 4.0;
const ROUNDS: usize = 4;
/// A window begins and ends with so much of a cruise, in seconds, where there is one.
const INSET: f64 = 0.02;
/// From a start in motion, a motion that would have to be stretched by this stands as it is, rather than none.
const BEARABLE: f64 = 1.0005;
/// From a start in motion, lower speeds that take this many times as long as the plain motion are worse than to come to rest first.
const CRAWL: f64 = 2.0;
/// Bound on the rounds of stretching. Where a limit is passed far, the judge says so without saying how far,
/// and each round stretches by half as much again.
const STRETCHINGS: usize = 100;

/// A path with its limits.
pub(super) struct Task<'a, const N: usize, P> {
    pub(super) path: &'a mut P,
    pub(super) joints: &'a TimingLimits<N>,
    pub(super) limits: &'a Limits,
    /// Speed at the start.
    pub(super) start: f64,
    /// The path will go on beyond its end.
    pub(super) open: bool,
}

/// Where the plain motion is busy: times (from, to), and how far around it a window reaches, in seconds.
#[derive(Debug, Clone, Copy)]
struct Busy {
    from: f64,
    to: f64,
    reach: f64,
}

/// A window, when the plain motion enters and leaves it, and what was found in it.
struct Part {
    window: Window,
    from: f64,
    to: f64,
    passage: Passage,
}

impl<const N: usize, P: JointPath<N>> Task<'_, N, P> {
    pub(super) fn timing(&mut self) -> Result<Timing, TimingError<P::Error>> {
        let plain = Plain::new(self.limits, self.start)?;
        let reach = REACH * self.longest_braking();
        let (load, mut busy) = self.survey(&plain, reach)?;
        if load.stretch() <= 1.0 + ROUNDING {
            let settled = self.settled(self.limits, &plain.pieces, &[]);
            return Ok(Timing::new(plain.pieces, TimingKind::Plain, Vec::new()).settled_for(settled));
        }
        if let Some((gentler, limits)) = self.gentler(Lower::Ramps)? {
            return self.lowered(&plain, gentler, &limits);
        }
        let mut workshop = Workshop::default();
        let mut parts = Vec::new();
        for _ in 0..ROUNDS {
            let windows = laid(&plain, &busy, reach);
            parts = self.passed(&mut workshop, windows, parts)?;
            let mut narrow = parts.iter().filter(|part| !part.passage.good()).peekable();
            if narrow.peek().is_none() {
                break;
            }
            for part in narrow {
                let inside = |busy: &&mut Busy| busy.from < part.to && busy.to > part.from;
                busy.iter_mut().filter(inside).for_each(|busy| busy.reach *= WIDER);
            }
        }
        let stretch = parts.iter().fold(1.0, |most: f64, part| most.max(part.passage.stretch));
        let pieces = joined(&plain, &parts);
        if parts.iter().all(|part| part.passage.good()) || (self.start > 0.0 && stretch <= BEARABLE) {
            let settled = self.settled(self.limits, &pieces, &parts);
            let slowdowns = slowdowns(self, &plain, &pieces)?;
            return Ok(Timing::new(pieces, TimingKind::Optimized, slowdowns).settled_for(settled));
        }
        let moving = self.start > 0.0;
        let crawls = |gentler: &Plain| moving && gentler.duration > CRAWL * plain.duration;
        if let Some((gentler, limits)) = self.gentler(Lower::All)?.filter(|(gentler, _)| !crawls(gentler)) {
            return self.lowered(&plain, gentler, &limits);
        }
        if self.start > 0.0 {
            // All that is left takes time all along, the start included.
            return Err(TimingError::NoSpeed);
        }
        let slow = self.stretched_plain(plain.pieces.clone(), &load)?;
        // A window without a passage stretches to infinity, and has no pieces.
        let (pieces, kind) = if stretch.is_infinite() || duration(&slow) < duration(&pieces) * stretch {
            (slow, TimingKind::Stretched)
        } else {
            (all_stretched(&pieces, stretch), TimingKind::Optimized)
        };
        let slowdowns = slowdowns(self, &plain, &pieces)?;
        let settled = if self.open { 0 } else { pieces.len() };
        Ok(Timing::new(pieces, kind, slowdowns).settled_for(settled))
    }

    /// The timing of the plain motion under lower limits.
    fn lowered(
        &mut self,
        plain: &Plain,
        gentler: Plain,
        limits: &Limits,
    ) -> Result<Timing, TimingError<P::Error>> {
        let settled = self.settled(limits, &gentler.pieces, &[]);
        let slowdowns = slowdowns(self, plain, &gentler.pieces)?;
        Ok(Timing::new(gentler.pieces, TimingKind::Gentler, slowdowns).settled_for(settled))
    }

    /// The longest time from full speed to rest, of any joint and of the path.
    fn longest_braking(&self) -> f64 {
        let braking = |v: f64, a: f64, j: f64| v / a + a / j;
        let path = self.limits.all().map(|limits| braking(limits.speed, limits.acceleration, limits.jerk));
        let joints = (0..N)
            .map(|i| braking(self.joints.velocity[i], self.joints.acceleration[i], self.joints.jerk[i]));
        joints.chain(path).fold(0.0, f64::max)
    }

    /// The load of the plain motion, and where it is busy.
    fn survey(&mut self, plain: &Plain, reach: f64) -> Result<(Load<N>, Vec<Busy>), TimingError<P::Error>> {
        let mut check = Check::new(self.path, self.joints, self.limits);
        let mut load = Load::NONE;
        let mut busy: Vec<Busy> = Vec::new();
        for (piece, start) in plain.pieces.iter().zip(&plain.starts) {
            let part = check.piece(piece, |from, to, load| {
                let (from, to) = (start + from, start + to);
                if load.joints.iter().flatten().any(|&share| share > BUSY) {
                    match busy.last_mut() {
                        Some(last) if last.to >= from => last.to = to,
                        _ => busy.push(Busy { from, to, reach }),
                    }
                }
            })?;
            // The plain motion keeps the path's own limits by construction.
            load = load.raised(&Load { path: [0.0; 3], ..part });
        }
        Ok((load, busy))
    }

    /// The passages through the windows; what is known of them stays.
    fn passed(
        &mut self,
        workshop: &mut Workshop,
        windows: Vec<(Window, [f64; 2])>,
        mut known: Vec<Part>,
    ) -> Result<Vec<Part>, TimingError<P::Error>> {
        let mut parts = Vec::with_capacity(windows.len());
        for (window, [from, to]) in windows {
            let last = self.open && window.to == self.path.length();
            let braking = last.then(|| self.longest_braking());
            let passage = match known.iter().position(|part| part.window == window) {
                Some(index) => known.swap_remove(index).passage,
                None => match workshop.pass(self.path, self.joints, self.limits, &window, braking) {
                    // Where rounding makes the path look torn: slower it may not.
                    Err(TimingError::Discontinuous { .. }) => Passage::NONE,
                    passage => passage?,
                },
            };
            parts.push(Part { window, from, to, passage });
        }
        Ok(parts)
    }

    /// The plain motion in as much time as it takes: with all derivatives of the path finite, there is always
    /// one.
    fn stretched_plain(
        &mut self,
        mut pieces: Vec<TimingPiece>,
        load: &Load<N>,
    ) -> Result<Vec<TimingPiece>, TimingError<P::Error>> {
        let mut factor = load.stretch();
        for _ in 0..STRETCHINGS {
            pieces = all_stretched(&pieces, factor * (1.0 + ROUNDING));
            factor = Check::new(self.path, self.joints, self.limits).pieces(&pieces)?.stretch();
            if factor <= 1.0 {
                return Ok(pieces);
            }
        }
        Err(TimingError::NoSpeed)
    }

    /// How many pieces, from the start, do not depend on what comes behind the end: up to the last place where
    /// the motion is plain, at the programmed speed and without acceleration, or at an anchor.
    fn settled(&self, limits: &Limits, pieces: &[TimingPiece], parts: &[Part]) -> usize {
        if !self.open {
            return pieces.len();
        }
        let free = |place: f64| {
            let index = parts.partition_point(|part| part.window.to <= place);
            parts.get(index).is_none_or(|part| place <= part.window.from)
        };
        let anchored = |place: f64| {
            let index = parts.partition_point(|part| part.window.to <= place);
            parts.get(index).is_some_and(|part| part.passage.anchors.contains(&place))
        };
        // The next call starts from a plain motion, which has to be able to brake from there.
        let stops = |piece: &TimingPiece| {
            Plain::new::<P::Error>(&limits.after(piece.position), piece.velocity).is_ok()
        };
        let full = |piece: &TimingPiece| {
            let limit = limits.within(piece.position, piece.position).speed;
            piece.acceleration == 0.0 && piece.velocity >= limit * (1.0 - ROUNDING)
        };
        let ends = |piece: &TimingPiece| {
            (anchored(piece.position) || (full(piece) && free(piece.position))) && stops(piece)
        };
        pieces.iter().rposition(ends).unwrap_or(0)
    }
}

/// Windows around what is busy, wide enough to brake in, from hold to hold of the plain motion; with the times when
/// the plain motion enters and leaves them.
fn laid(plain: &Plain, busy: &[Busy], reach: f64) -> Vec<(Window, [f64; 2])> {
    let mut spans: Vec<[f64; 2]> = Vec::new();
    for busy in busy {
        let mut span = [entry(plain, busy.from, busy.reach), exit(plain, busy.to, busy.reach)];
        // One that was widened may reach back over several.
        while let Some(before) = spans.pop_if(|before| span[0] < before[1] + reach) {
            span = [before[0].min(span[0]), before[1].max(span[1])];
        }
        spans.push(span);
    }
    let window = |[from, to]: [f64; 2]| {
        let (first, last) = (plain.held_at(from), plain.held_at(to));
        let ends = [End::at(first.1), End::at(last.1)];
        (Window { from: first.0, to: last.0, ends }, [from, to])
    };
    spans.into_iter().map(window).collect()
}

/// Where to begin a window, at least `reach` before `time`.
fn entry(plain: &Plain, time: f64, reach: f64) -> f64 {
    let time = time - reach;
    if time < reach {
        return 0.0;
    }
    let index = plain.holds.partition_point(|hold| hold.from <= time);
    index.checked_sub(1).map_or(0.0, |index| {
        let hold = &plain.holds[index];
        time.min(hold.from.max(hold.to - INSET))
    })
}

/// Where to end a window, at least `reach` after `time`.
fn exit(plain: &Plain, time: f64, reach: f64) -> f64 {
    let time = time + reach;
    if time > plain.duration - reach {
        return plain.duration;
    }
    let index = plain.holds.partition_point(|hold| hold.to < time);
    plain.holds.get(index).map_or(plain.duration, |hold| time.max(hold.to.min(hold.from + INSET)))
}

/// The motion that passes through the windows and is plain outside them.
fn joined(plain: &Plain, parts: &[Part]) -> Vec<TimingPiece> {
    let mut pieces = Vec::new();
    let mut time = 0.0;
    for part in parts {
        pieces.extend(plain.between(time, part.from));
        pieces.extend(&part.passage.pieces);
        time = part.to;
    }
    pieces.extend(plain.between(time, plain.duration));
    pieces
}

fn all_stretched(pieces: &[TimingPiece], factor: f64) -> Vec<TimingPiece> {
    pieces.iter().map(|piece| stretched(piece, factor)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::timing::{JointJet, PathLimits, Stretch};

    /// The last resort on a joint that bends sharply once: within the limits, and one of them reached.
    #[test]
    fn stretching_alone_keeps_the_limits() {
        struct Bend;
        impl JointPath<1> for Bend {
            type Error = ();
            fn length(&self) -> f64 {
                1.0
            }
            fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
                let x = (s - 0.4) / 1e-3;
                let (t, k) = (x.tanh(), 1e3);
                let q1 = k * (1.0 - t * t);
                Ok(JointJet {
                    position: [t],
                    velocity: [q1],
                    acceleration: [-2.0 * k * t * q1],
                    jerk: [2.0 * k * k * q1 * (3.0 * t * t - 1.0)],
                })
            }
        }
        let joints = TimingLimits { velocity: [1.0], acceleration: [10.0], jerk: [500.0] };
        let limits = PathLimits { speed: 0.5, acceleration: 10.0, jerk: 500.0 };
        let limits = Limits::new::<()>(&[Stretch { to: 1.0, limits }], 1.0).unwrap();
        let mut task = Task { path: &mut Bend, joints: &joints, limits: &limits, start: 0.0, open: false };
        let plain = Plain::new::<()>(&limits, 0.0).unwrap();
        let (load, busy) = task.survey(&plain, 0.1).unwrap();
        let near = |busy: &Busy| (busy.from * 0.5 - 0.4).abs() < 0.1 && busy.from < busy.to;
        assert!(busy.iter().all(near), "{busy:?}");
        let slow = task.stretched_plain(plain.pieces, &load).unwrap();
        let load = Check::new(task.path, &joints, &limits).pieces(&slow).unwrap();
        assert!(load.stretch() <= 1.0 && load.stretch() > 0.99, "{load:?}");
        let optimized = task.timing().unwrap();
        assert!(optimized.kind() == TimingKind::Optimized && optimized.duration() < duration(&slow) / 10.0);
    }
}
