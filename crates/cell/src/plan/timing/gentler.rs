//! The plain motion under lower limits, stretch by stretch.
//!
//! On a course of many short stretches it is a few ramps, mostly beside corners, that ask a little too much of a joint. There a window
//! would be solved over hundreds of stretches to win nothing: with less acceleration and jerk in those stretches the plain motion fits,
//! and keeps every speed. And where no window has a solution, lower speeds in those stretches are a motion that comes to a stop nowhere.

use super::assemble::Task;
use super::check::{Check, Load};
use super::course::Limits;
use super::motion::TimingPiece;
use super::plain::Plain;
use super::window::ROUNDING;
use super::{JointPath, TimingError};

/// Rounds of lowering limits: for ramps alone, and for everything. The judge tells at most a factor of 1.5 in each.
const ROUNDS: [usize; 2] = [6, 30];
/// Limits are lowered by so much more than was asked for, as a share of what is missing: a change on one side of a place changes the other.
const BEYOND: f64 = 0.2;
/// Ramps that ask for more than this factor on time are left to a window, and so are all where a stretch takes longer than this on the
/// average, in seconds: a window makes the best of it.
const RAMPS: f64 = 1.2;
const SHORT: f64 = 0.1;

/// What is lowered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lower {
    /// Acceleration and jerk, where they alone are too high.
    Ramps,
    /// Speeds too.
    All,
}

impl<const N: usize, P: JointPath<N>> Task<'_, N, P> {
    /// The plain motion under limits that are lowered where a joint cannot follow, with these limits; `None` where that does not do.
    pub(super) fn gentler(&mut self, lower: Lower) -> Result<Option<(Plain, Limits)>, TimingError<P::Error>> {
        let mut limits = self.limits.clone();
        let mut known = Vec::new();
        for _ in 0..ROUNDS[usize::from(lower == Lower::All)] {
            let Ok(plain) = Plain::new::<P::Error>(&limits, self.start) else { return Ok(None) };
            if lower == Lower::Ramps && plain.duration > SHORT * limits.all().count() as f64 {
                return Ok(None);
            }
            known = self.factors(&plain, &limits, &known)?;
            let Some(factors) = asked(&known, &limits, lower) else { return Ok(None) };
            if factors.iter().all(|factor| *factor <= 1.0 + ROUNDING) {
                return Ok(Some((plain, limits)));
            }
            for (limits, factor) in
                limits.all_mut().zip(&factors).filter(|(_, factor)| **factor > 1.0 + ROUNDING)
            {
                let factor = factor + BEYOND * (factor - 1.0);
                limits.acceleration /= factor * factor;
                limits.jerk /= factor * factor * factor;
                if lower == Lower::All {
                    limits.speed /= factor;
                }
            }
        }
        Ok(None)
    }

    /// Each piece of a motion with the factor on time that it asks for. What is `known` of the same pieces, in order, stays.
    fn factors(
        &mut self,
        plain: &Plain,
        limits: &Limits,
        known: &[(TimingPiece, f64)],
    ) -> Result<Vec<(TimingPiece, f64)>, TimingError<P::Error>> {
        let mut check = Check::new(self.path, self.joints, limits);
        let mut judged = |piece: &TimingPiece| {
            let index = known.partition_point(|(other, _)| other.position < piece.position);
            if let Some((_, factor)) = known.get(index).filter(|(other, _)| other == piece) {
                return Ok((*piece, *factor));
            }
            let load = Load { path: [0.0; 3], ..check.piece(piece, |_, _, _| {})? };
            Ok((*piece, load.stretch()))
        };
        plain.pieces.iter().map(&mut judged).collect()
    }
}

/// By which factor each stretch should be slower; `None` where this sort of lowering will not do.
fn asked(pieces: &[(TimingPiece, f64)], limits: &Limits, lower: Lower) -> Option<Vec<f64>> {
    let mut factors = vec![1.0_f64; limits.all().count()];
    for (piece, factor) in pieces {
        let cruises = piece.acceleration == 0.0 && piece.jerk == 0.0;
        if lower == Lower::Ramps && (*factor > RAMPS || (cruises && *factor > 1.0 + ROUNDING)) {
            return None;
        }
        for stretch in &mut factors[limits.between(piece.position, piece.end().position)] {
            *stretch = stretch.max(*factor);
        }
    }
    Some(factors)
}
