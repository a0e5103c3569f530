//! The path that the tool is still on when the program is beyond it: for prefilters on the feedrate.

use super::block::{Block, Motion};
use super::seam::{Correction, Rail};
use crate::geometry::PoseJet;
use crate::path::PathState;

/// Moves that the cycle remembers: as many may lie within the length of prefilters on the feedrate.
pub const RAIL_MOVES: usize = 64;

/// A move, between two places of the program's way.
#[derive(Debug, Clone, Copy)]
struct Laid {
    from: f64,
    to: f64,
    /// With the path coordinate at the move's start; `None` for a move of the joints.
    rail: Option<(f64, Rail)>,
}

/// The last moves, in a ring.
#[derive(Debug, Clone)]
pub(super) struct Rails {
    moves: [Option<Laid>; RAIL_MOVES],
    /// How many have been laid so far.
    count: usize,
}

/// What is at a place of the program's way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OnRails {
    /// A path: the flange's motion.
    Path(PoseJet),
    /// A move of the joints.
    Joints,
    /// More than is remembered has been laid since.
    Forgotten,
}

/// What a block moves along, with the path coordinate at its start.
fn rail<const N: usize>(block: &Block<N>) -> Option<(f64, Rail)> {
    match &block.motion {
        Motion::Joint(_) => None,
        Motion::Path(motion) => Some((motion.state(0.0).position, Rail::of(motion))),
    }
}

impl OnRails {
    /// At a way from a move's start, with its velocity and acceleration.
    fn on(
        rail: Option<&(f64, Rail)>,
        [way, velocity, acceleration]: [f64; 3],
        correction: Option<Correction<'_>>,
    ) -> Self {
        rail.map_or(Self::Joints, |(start, rail)| {
            let position = (start + way).clamp(0.0, rail.length());
            let state = PathState { position, velocity, acceleration, jerk: 0.0 };
            Self::Path(rail.flange(&state, correction))
        })
    }
}

impl Rails {
    /// Nothing laid.
    pub(super) fn new() -> Self {
        Self { moves: [None; RAIL_MOVES], count: 0 }
    }

    /// Remembers a move that is done, between two places of the way; it follows on all others.
    pub(super) fn lay<const N: usize>(&mut self, block: &Block<N>, from: f64, to: f64) {
        self.moves[self.count % RAIL_MOVES] = Some(Laid { from, to, rail: rail(block) });
        self.count += 1;
    }

    /// What is at a place of the way, with its velocity and acceleration; `head` is the move that begins where those laid end, at the way
    /// given, and `correction` that of a tracked seam. Beyond all that is known it is the end of that; at its start the start.
    pub(super) fn at<const N: usize>(
        &self,
        motion: [f64; 3],
        head: Option<(f64, &Block<N>)>,
        correction: Option<Correction<'_>>,
    ) -> OnRails {
        let [way, velocity, acceleration] = motion;
        if let Some((from, block)) = head.filter(|(from, _)| way >= *from) {
            return OnRails::on(rail(block).as_ref(), [way - from, velocity, acceleration], correction);
        }
        let laid = || {
            (1..=RAIL_MOVES.min(self.count))
                .filter_map(|back| self.moves[(self.count - back) % RAIL_MOVES].as_ref())
        };
        let Some(here) = laid().find(|laid| laid.from <= way) else {
            return if self.count > RAIL_MOVES { OnRails::Forgotten } else { OnRails::Joints };
        };
        OnRails::on(here.rail.as_ref(), [way.min(here.to) - here.from, velocity, acceleration], correction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::PathMotion;
    use crate::geometry::Pose;
    use crate::path::{Path, TimingPiece};

    /// A line of one metre along x from there on.
    fn line(from: f64) -> Block<1> {
        let [start, end] = [from, from + 1.0].map(|x| Pose::translation(x, 0.0, 0.0));
        let piece = TimingPiece { duration: 1.0, velocity: 1.0, ..TimingPiece::default() };
        let path = PathMotion::new(Path::line(&start, &end), &Pose::identity(), (1.0, 1.0), &[piece]);
        Block {
            line: 1,
            segment: 1,
            flange_from_tcp: Pose::identity(),
            starts_at_rest: false,
            ends_at_rest: false,
            motion: Motion::Path(path.unwrap()),
        }
    }

    fn place(found: OnRails) -> (f64, f64) {
        match found {
            OnRails::Path(flange) => (flange.pose.translation.vector.x, flange.linear[0].x),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn places_lie_on_the_move_that_was_there() {
        let mut rails = Rails::new();
        for k in 0..3 {
            let from = f64::from(k);
            rails.lay(&line(from), from, from + 1.0);
        }
        let head = line(3.0);
        for way in [0.0, 0.4, 1.0, 2.7, 3.0, 3.2, 4.0] {
            let found = place(rails.at([way, 0.5, 0.0], Some((3.0, &head)), None));
            assert_eq!(found, (way, 0.5));
        }
        // Beyond what is known it is the end.
        assert_eq!(place(rails.at::<1>([3.3, 0.5, 0.0], None, None)).0, 3.0);
    }

    #[test]
    fn what_lies_too_far_behind_is_forgotten() {
        let mut rails = Rails::new();
        for k in 0..=RAIL_MOVES as u32 {
            let from = f64::from(k);
            rails.lay(&line(from), from, from + 1.0);
        }
        assert_eq!(place(rails.at::<1>([1.5, 0.0, 0.0], None, None)).0, 1.5);
        assert_eq!(rails.at::<1>([0.5, 0.0, 0.0], None, None), OnRails::Forgotten);
    }
}
