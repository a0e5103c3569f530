//! The whole motion: the plain S-curve wherever the joints can follow it, and windows solved around the rest.

use super::check::{Check, Load};
use super::coordinate::End;
use super::motion::{Timing, TimingKind, TimingPiece, duration, stretched};
use super::s_curve::SCurve;
use super::slowdown::slowdowns;
use super::window::{Passage, Window, Workshop};
use super::{JointPath, PathLimits, TimingError, TimingLimits};

/// Share of a limit from which on the plain motion is not trusted to leave room for braking.
const BUSY: f64 = 0.9;
/// What rounding may add to a load.
const ROUNDING: f64 = 1e-9;
/// A window reaches this many times the longest braking beyond what the joints cannot follow.
const REACH: f64 = 1.5;
/// Windows that need more stretching than this were too narrow.
const STRETCH: f64 = 1.003;
/// Bound on the rounds of stretching. Where a limit is passed far, the judge says so without saying how far,
/// and each round stretches by half as much again.
const STRETCHINGS: usize = 100;

/// A path with its limits.
pub(super) struct Task<'a, const N: usize, P> {
    pub(super) path: &'a mut P,
    pub(super) joints: &'a TimingLimits<N>,
    pub(super) limits: &'a PathLimits,
}

/// Stretches of the path (from, to), in order.
type Stretches = Vec<(f64, f64)>;

impl<const N: usize, P: JointPath<N>> Task<'_, N, P> {
    pub(super) fn timing(&mut self) -> Result<Timing, TimingError<P::Error>> {
        let length = self.path.length();
        let curve = SCurve::new(length, self.limits);
        let plain = curve.pieces();
        let (load, busy) = self.survey(&plain)?;
        if load.stretch() <= 1.0 + ROUNDING {
            return Ok(Timing::new(plain, TimingKind::Plain, Vec::new()));
        }
        let mut workshop = Workshop::default();
        let mut passage = self.attempt(&mut workshop, &curve, &self.windows(&curve, &busy))?;
        if passage.stretch > STRETCH {
            let whole = self.attempt(&mut workshop, &curve, &[whole(length)])?;
            if whole.duration() < passage.duration() {
                passage = whole;
            }
        }
        let (mut pieces, mut kind) = (all_stretched(&passage.pieces, passage.stretch), TimingKind::Optimized);
        if passage.stretch > STRETCH {
            let slow = self.stretched_plain(plain, &load)?;
            if duration(&slow) < passage.duration() {
                (pieces, kind) = (slow, TimingKind::Stretched);
            }
        }
        let slowdowns = slowdowns(self, &curve, &pieces)?;
        Ok(Timing::new(pieces, kind, slowdowns))
    }

    /// The load of the plain motion, and where it is busy.
    fn survey(&mut self, plain: &[TimingPiece]) -> Result<(Load<N>, Stretches), TimingError<P::Error>> {
        let mut check = Check::new(self.path, self.joints, self.limits);
        let mut load = Load::NONE;
        let mut busy: Stretches = Vec::new();
        for piece in plain {
            let part = check.piece(piece, |from, to, load| {
                if load.joints.iter().flatten().any(|&share| share > BUSY) {
                    match busy.last_mut() {
                        Some(last) if last.1 >= from => last.1 = to,
                        _ => busy.push((from, to)),
                    }
                }
            })?;
            // The plain motion keeps the path's own limits by construction.
            load = load.raised(&Load { path: [0.0; 3], ..part });
        }
        Ok((load, busy))
    }

    /// Windows around the busy stretches, wide enough to brake in.
    fn windows(&self, curve: &SCurve, busy: &Stretches) -> Vec<Window> {
        let PathLimits { speed, acceleration, jerk } = *self.limits;
        let braking = |v: f64, a: f64, j: f64| v / a + a / j;
        let joints = (0..N)
            .map(|i| braking(self.joints.velocity[i], self.joints.acceleration[i], self.joints.jerk[i]));
        let reach = REACH * curve.speed * joints.fold(braking(speed, acceleration, jerk), f64::max);
        let (first, last) = (curve.ramp() + reach, curve.length - curve.ramp() - reach);
        let mut windows: Vec<Window> = Vec::new();
        for &(from, to) in busy {
            let mut window = Window { from: from - reach, to: to + reach, ends: [End::Cruise; 2] };
            if window.from < first {
                (window.from, window.ends[0]) = (0.0, End::Rest);
            }
            if window.to > last {
                (window.to, window.ends[1]) = (curve.length, End::Rest);
            }
            match windows.last_mut() {
                Some(before) if window.from < before.to + reach => {
                    (before.to, before.ends[1]) = (window.to, window.ends[1]);
                }
                _ => windows.push(window),
            }
        }
        windows
    }

    /// As [`Task::through`], but no motion where rounding makes the path look torn: slower it may not.
    fn attempt(
        &mut self,
        workshop: &mut Workshop,
        curve: &SCurve,
        windows: &[Window],
    ) -> Result<Passage, TimingError<P::Error>> {
        match self.through(workshop, curve, windows) {
            Err(TimingError::Discontinuous { .. }) => Ok(Passage::NONE),
            result => result,
        }
    }

    /// The motion that passes through the windows and is plain outside them.
    fn through(
        &mut self,
        workshop: &mut Workshop,
        curve: &SCurve,
        windows: &[Window],
    ) -> Result<Passage, TimingError<P::Error>> {
        let mut pieces = Vec::new();
        let mut stretch: f64 = 1.0;
        // Where the plain motion has got to; nothing yet.
        let mut done = None;
        for window in windows {
            if window.ends[0] == End::Cruise {
                let begun = match done {
                    Some(place) => place,
                    None => {
                        pieces.extend(curve.accelerating());
                        curve.ramp()
                    }
                };
                pieces.push(curve.cruising(begun, window.from));
            }
            let passage = workshop.pass(self.path, self.joints, self.limits, window)?;
            stretch = stretch.max(passage.stretch);
            pieces.extend(passage.pieces);
            done = (window.ends[1] == End::Cruise).then_some(window.to);
        }
        if let Some(place) = done {
            pieces.push(curve.cruising(place, curve.length - curve.ramp()));
            pieces.extend(curve.decelerating());
        }
        Ok(Passage { pieces, stretch })
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
}

fn whole(length: f64) -> Window {
    Window { from: 0.0, to: length, ends: [End::Rest; 2] }
}

fn all_stretched(pieces: &[TimingPiece], factor: f64) -> Vec<TimingPiece> {
    pieces.iter().map(|piece| stretched(piece, factor)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::timing::JointJet;

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
        let mut task = Task { path: &mut Bend, joints: &joints, limits: &limits };
        let plain = SCurve::new(1.0, &limits).pieces();
        let (load, busy) = task.survey(&plain).unwrap();
        assert!(busy.iter().all(|&(from, to)| from < to && (from - 0.4).abs() < 0.1), "{busy:?}");
        let slow = task.stretched_plain(plain, &load).unwrap();
        let load = Check::new(task.path, &joints, &limits).pieces(&slow).unwrap();
        assert!(load.stretch() <= 1.0 && load.stretch() > 0.99, "{load:?}");
        let optimized = task.timing().unwrap();
        assert!(optimized.kind() == TimingKind::Optimized && optimized.duration() < duration(&slow) / 10.0);
    }
}
