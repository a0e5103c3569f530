//! Motion along a path in the least time for a vibration bound and a corner error.
//!
//! | module | holds |
//! |---|---|
//! | `compared` | the SCARA experiment with it, beside the bare command and FIR-ZVD |
//! | `motion` | windows and cruise, one after the other: where the tool is commanded to be |
//! | `program` | a convex program put together row by row |
//! | `tool` | how the tool accelerates while the command's acceleration stays the same |
//! | `window` | the motion through one corner, or at the path's ends: the convex program |
//!
//! The derivation is in `docs/vibration.md`, section 6.

mod compared;
mod motion;
mod program;
mod tool;
mod window;

use seamline::path::Path;
use seamline::vibration::Mode;

pub use self::compared::{AutoOptions, AutoOutcome, Compared, scara_auto};
pub use self::motion::QuietMotion;
use self::window::{Courses, Kept, Side, Window};
use super::ExperimentError;

/// What a motion is planned for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quiet {
    /// Greatest acceleration of the tool, in m/s².
    pub acceleration: f64,
    /// Root mean square of the tool's acceleration over the motion, in m/s²; infinite if it does not matter.
    pub acceleration_rms: f64,
    /// Greatest acceleration of the command, in m/s²: what the arm's axes can do.
    pub command: f64,
    /// How fast that acceleration may change, in m/s³, from step to step (1/32 of the mode's period); infinite if it does not matter.
    pub jerk: f64,
    /// Corner error, in metres.
    pub corner_error: f64,
    /// Fraction by which the mode's frequency may be off, up or down: over all of that range little is left after the last command. Zero
    /// trusts the mode.
    pub drift: f64,
}

/// Steps of a window in a damped period.
const STEPS: f64 = 32.0;
/// Steps on one side of a corner, at most.
const LONGEST: f64 = 300.0;
/// A side of a window takes the time of a ramp at the bound, and as many damped periods as the segment's half has room for, up to these.
const SETTLING: f64 = 0.6;
/// Where the mode may drift.
const SETTLING_DRIFTED: f64 = 1.5;
/// At least these; a segment too short for them is taken slower. The next one is tried where no motion fits into a window.
const SHORTEST: [f64; 6] = [0.4, 0.7, 1.0, 1.5, 2.5, 4.0];
/// Share of a segment that either end's window may plan to take.
const ROOM: f64 = 0.48;
/// What a window may leave of the vibration, over that of a bare stop from the feedrate, ωF.
const RESIDUAL: f64 = 1e-4;
/// The same where the mode has drifted. What a corner leaves decays until the end: it may leave more by that, up to a limit.
const DRIFTED_END: f64 = 0.006;
const DRIFTED_CORNER: f64 = 0.005;
const DRIFTED_MOST: f64 = 0.04;
/// Share of the vibration bound that a curve may take at its feedrate, so that some is left to accelerate.
const CENTRIPETAL: f64 = 0.9;
/// Rounds in which the bound asked of the windows is set so that the motion meets the one given, and how closely it must.
const ROUNDS: usize = 4;
const CLOSE: f64 = 1e-3;
/// What acceleration may cost where its root mean square is bounded, and the rounds, mostly halvings on a logarithmic scale, in which it is found.
const CALM: [f64; 2] = [0.02, 50.0];
const CALM_ROUNDS: usize = 12;
/// Where that is not enough, the greatest acceleration is lowered to this share of it, time and again.
const CALM_LOWER: f64 = 0.7;
const CALM_LOWERED: usize = 15;
/// The corner error is used to this fraction.
const ERROR_USED: f64 = 0.999;

impl<'a> QuietMotion<'a> {
    /// Plans a path's motion in its plane, x and y. Feedrates are lowered where a segment is too short to reach them, or too curved, within
    /// the bound.
    ///
    /// One to four rounds; in each a convex program for each corner and both ends, or five for those with a curved segment, each of at most
    /// 100 iterations. About 20 ms a program: 0.3 to 1.5 s for the test path. A bound of the root mean square takes up to 27 rounds more, 13 as a rule.
    ///
    /// # Errors
    /// [`ExperimentError::Bound`] where no motion keeps the bound.
    pub fn plan(
        path: &'a [Path],
        mode: &Mode,
        feedrate: f64,
        quiet: &Quiet,
    ) -> Result<Self, ExperimentError> {
        let bound = ExperimentError::Bound { bound: quiet.acceleration, rms: quiet.acceleration_rms };
        let (motion, asked) = quickest(path, mode, feedrate, quiet).ok_or(bound.clone())?;
        if motion.vibration(mode)[1] <= quiet.acceleration_rms {
            return Ok(motion);
        }
        calmer(path, mode, feedrate, quiet, asked).ok_or(bound)
    }
}

/// Path time against vibration: for each bound the greatest acceleration that comes out, in m/s², and the duration, in seconds. One round each:
/// what comes out is within a hundredth of the bound. Bounds that no motion keeps are left out.
#[must_use]
pub fn trade_off(path: &[Path], mode: &Mode, feedrate: f64, quiet: &Quiet, bounds: &[f64]) -> Vec<[f64; 2]> {
    let point = |bound: &f64| {
        let motion = fitting(path, mode, feedrate, &Quiet { acceleration: *bound, ..*quiet }, 0.0)?;
        Some([motion.vibration(mode)[0], motion.duration()])
    };
    bounds.iter().filter_map(point).collect()
}

/// The motion of least time that meets the bound, and the bound that was asked of its windows.
fn quickest<'a>(
    path: &'a [Path],
    mode: &Mode,
    feedrate: f64,
    quiet: &Quiet,
) -> Option<(QuietMotion<'a>, f64)> {
    // A bound far above what the command does is none, and would take the scale from all others.
    let most = quiet.acceleration.min(quiet.command);
    let mut asked = most;
    let mut best: Option<(QuietMotion<'a>, f64)> = None;
    for _ in 0..ROUNDS {
        let Some(motion) = fitting(path, mode, feedrate, &Quiet { acceleration: asked, ..*quiet }, 0.0)
        else {
            break;
        };
        let [reached, _] = motion.vibration(mode);
        let sooner = best.as_ref().is_none_or(|(best, _)| motion.duration() < best.duration());
        if reached <= quiet.acceleration && sooner {
            best = Some((motion, asked));
        }
        if (1.0 - CLOSE..=1.0).contains(&(reached / most)) || (asked >= quiet.command && reached <= most) {
            break;
        }
        asked = (asked * (1.0 - 0.5 * CLOSE) * most / reached).min(quiet.command);
    }
    best
}

/// The motion of least time that meets the bound of the root mean square too: acceleration costs what it must for that, found by halving.
fn calmer<'a>(
    path: &'a [Path],
    mode: &Mode,
    feedrate: f64,
    quiet: &Quiet,
    asked: f64,
) -> Option<QuietMotion<'a>> {
    let mut asking = Quiet { acceleration: asked, ..*quiet };
    let [mut low, mut high] = CALM;
    for _ in 0..CALM_LOWERED {
        let calmest = fitting(path, mode, feedrate, &asking, high)?;
        if calmest.vibration(mode)[1] <= quiet.acceleration_rms {
            break;
        }
        asking.acceleration *= CALM_LOWER;
    }
    let mut best = None;
    for _ in 0..CALM_ROUNDS {
        let middle = (low * high).sqrt();
        let Some(motion) = fitting(path, mode, feedrate, &asking, middle) else { break };
        let [greatest, rms] = motion.vibration(mode);
        if greatest > quiet.acceleration {
            asking.acceleration *= (1.0 - 0.5 * CLOSE) * quiet.acceleration / greatest;
        } else if rms <= quiet.acceleration_rms {
            high = middle;
            best = Some(motion);
        } else {
            low = middle;
        }
    }
    best
}

/// With windows as short as they can be.
fn fitting<'a>(
    path: &'a [Path],
    mode: &Mode,
    feedrate: f64,
    quiet: &Quiet,
    calm: f64,
) -> Option<QuietMotion<'a>> {
    SHORTEST.iter().find_map(|shortest| plan_once(path, mode, feedrate, quiet, calm, *shortest))
}

/// Each window for itself; nothing where one has no motion.
fn plan_once<'a>(
    path: &'a [Path],
    mode: &Mode,
    feedrate: f64,
    quiet: &Quiet,
    calm: f64,
    shortest: f64,
) -> Option<QuietMotion<'a>> {
    let period = mode.period();
    let settling = period * if quiet.drift > 0.0 { SETTLING_DRIFTED } else { SETTLING };
    let shortest = shortest * period;
    let cruises: Vec<(&Path, f64)> =
        path.iter().map(|piece| (piece, cruise(piece, feedrate, quiet.acceleration, shortest))).collect();
    let half = |(piece, feedrate): &(&Path, f64)| {
        let ramp = feedrate / quiet.acceleration;
        let room = ROOM * piece.length() / feedrate - 0.5 * ramp;
        ramp + settling.min(room).max(shortest)
    };
    let longest = cruises.iter().map(half).fold(0.0, f64::max);
    let step = (period / STEPS).max(longest / LONGEST);
    let side = |index: usize| {
        let cruise = cruises.get(index)?;
        let steps = (half(cruise) / step).ceil() as usize;
        Some(Side { path: cruise.0, feedrate: cruise.1, steps, room: 0.5 * cruise.0.length() })
    };
    let windows = (0..=path.len()).map(|index| {
        let (first, second) = (index.checked_sub(1).and_then(side), side(index));
        let loud = mode.omega() * feedrate;
        let rest: f64 = cruises.iter().skip(index).map(|(piece, feedrate)| piece.length() / feedrate).sum();
        let decay = (-mode.damping() * mode.omega() * rest).exp();
        let drifted = if second.is_none() { DRIFTED_END } else { (DRIFTED_CORNER / decay).min(DRIFTED_MOST) };
        let kept = Kept {
            acceleration: quiet.acceleration,
            command: quiet.command,
            jerk: quiet.jerk,
            corner_error: ERROR_USED * quiet.corner_error,
            residual: RESIDUAL * loud,
            drift: quiet.drift,
            drifted_residual: drifted * loud,
        };
        Window { mode, kept, calm, step, first, second }.solve()
    });
    let windows: Vec<Courses> = windows.collect::<Option<_>>()?;
    let feedrates: Vec<f64> = cruises.iter().map(|(_, feedrate)| *feedrate).collect();
    Some(QuietMotion::lay(path, &feedrates, step, &windows))
}

/// The feedrate on a segment: what the curve permits within the bound, and what both its ends can reach within half its length.
fn cruise(path: &Path, feedrate: f64, acceleration: f64, settling: f64) -> f64 {
    let on_curve = (CENTRIPETAL * acceleration / path.curve().greatest_curvature()).sqrt();
    // v (v/2a + settling) = length / 2.
    let on_way = acceleration * ((settling * settling + path.length() / acceleration).sqrt() - settling);
    feedrate.min(on_curve).min(on_way)
}
