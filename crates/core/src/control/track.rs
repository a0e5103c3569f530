//! The path that the tool is still on when the program is beyond it: for prefilters on the feedrate.

use super::block::{Block, Motion, flange_on};
use crate::geometry::{Pose, PoseJet};
use crate::path::{Path, PathState};

/// Moves that the cycle remembers: as many may lie within the length of prefilters on the feedrate.
pub const TRACK_MOVES: usize = 64;

/// What a move of the tool ran along.
#[derive(Debug, Clone, Copy)]
struct Rail {
    path: Path,
    tcp_from_flange: Pose,
    /// Path coordinate at the move's start.
    start: f64,
}

/// A move, between two places of the program's way.
#[derive(Debug, Clone, Copy)]
struct Laid {
    from: f64,
    to: f64,
    /// `None` for a move of the joints.
    rail: Option<Rail>,
}

/// The last moves, in a ring.
#[derive(Debug, Clone)]
pub(super) struct Track {
    moves: [Option<Laid>; TRACK_MOVES],
    /// How many have been laid so far.
    count: usize,
}

/// What is at a place of the program's way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OnTrack {
    /// A path: the flange's motion.
    Path(PoseJet),
    /// A move of the joints.
    Joints,
    /// More than is remembered has been laid since.
    Forgotten,
}

impl Rail {
    fn of<const N: usize>(block: &Block<N>) -> Option<Self> {
        match &block.motion {
            Motion::Joint(_) => None,
            Motion::Path(motion) => {
                let (path, tcp_from_flange) = (motion.path, *motion.tcp_from_flange());
                Some(Self { path, tcp_from_flange, start: motion.state(0.0).position })
            }
        }
    }

    /// The flange at a way from the move's start, with its velocity and acceleration.
    fn at(&self, [way, velocity, acceleration]: [f64; 3]) -> PoseJet {
        let position = (self.start + way).clamp(0.0, self.path.length());
        let state = PathState { position, velocity, acceleration, jerk: 0.0 };
        flange_on(&self.path, &self.tcp_from_flange, &state)
    }
}

impl OnTrack {
    fn on(rail: Option<&Rail>, motion: [f64; 3]) -> Self {
        rail.map_or(Self::Joints, |rail| Self::Path(rail.at(motion)))
    }
}

impl Track {
    /// Nothing laid.
    pub(super) fn new() -> Self {
        Self { moves: [None; TRACK_MOVES], count: 0 }
    }

    /// Remembers a move that is done, between two places of the way; it follows on all others.
    pub(super) fn lay<const N: usize>(&mut self, block: &Block<N>, from: f64, to: f64) {
        self.moves[self.count % TRACK_MOVES] = Some(Laid { from, to, rail: Rail::of(block) });
        self.count += 1;
    }

    /// What is at a place of the way, with its velocity and acceleration; `head` is the move that begins where those laid end, at the way
    /// given. Beyond all that is known it is the end of that; at its start the start.
    pub(super) fn at<const N: usize>(&self, motion: [f64; 3], head: Option<(f64, &Block<N>)>) -> OnTrack {
        let [way, velocity, acceleration] = motion;
        if let Some((from, block)) = head.filter(|(from, _)| way >= *from) {
            return OnTrack::on(Rail::of(block).as_ref(), [way - from, velocity, acceleration]);
        }
        let laid = || {
            (1..=TRACK_MOVES.min(self.count))
                .filter_map(|back| self.moves[(self.count - back) % TRACK_MOVES].as_ref())
        };
        let Some(here) = laid().find(|laid| laid.from <= way) else {
            return if self.count > TRACK_MOVES { OnTrack::Forgotten } else { OnTrack::Joints };
        };
        OnTrack::on(here.rail.as_ref(), [way.min(here.to) - here.from, velocity, acceleration])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::PathMotion;
    use crate::path::TimingPiece;

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

    fn place(found: OnTrack) -> (f64, f64) {
        match found {
            OnTrack::Path(flange) => (flange.pose.translation.vector.x, flange.linear[0].x),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn places_lie_on_the_move_that_was_there() {
        let mut track = Track::new();
        for k in 0..3 {
            let from = f64::from(k);
            track.lay(&line(from), from, from + 1.0);
        }
        let head = line(3.0);
        for way in [0.0, 0.4, 1.0, 2.7, 3.0, 3.2, 4.0] {
            let found = place(track.at([way, 0.5, 0.0], Some((3.0, &head))));
            assert_eq!(found, (way, 0.5));
        }
        // Beyond what is known it is the end.
        assert_eq!(place(track.at::<1>([3.3, 0.5, 0.0], None)).0, 3.0);
    }

    #[test]
    fn what_lies_too_far_behind_is_forgotten() {
        let mut track = Track::new();
        for k in 0..=TRACK_MOVES as u32 {
            let from = f64::from(k);
            track.lay(&line(from), from, from + 1.0);
        }
        assert_eq!(place(track.at::<1>([1.5, 0.0, 0.0], None)).0, 1.5);
        assert_eq!(track.at::<1>([0.5, 0.0, 0.0], None), OnTrack::Forgotten);
    }
}
