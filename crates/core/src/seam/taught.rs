//! The taught path, as seam tracking needs it.

use core::fmt;

use super::Offset;
use crate::geometry::{PoseJet, Vector3};
use crate::math::float::acos;
use crate::path::{Measure, Path, SAME_POSITION, SeamFrame};

/// Steps towards a foot: from a guess within a few millimetres, four reach rounding on any curve that a torch follows.
const STEPS: usize = 8;
/// Longest such step, in metres.
const LONGEST_STEP: f64 = 0.02;
/// Two paths of a chain meet if their ends lie this close, in metres, ...
const MEETING: f64 = 1e-6;
/// ... and their tangents agree to this angle, in radians.
const SMOOTH: f64 = 1e-3;

/// A path by arc length that a seam is tracked along. It has a continuous tangent.
pub trait TaughtPath {
    /// Least and greatest coordinate, in metres.
    fn span(&self) -> (f64, f64);

    /// The tool centre point's pose in the base frame at a coordinate of the span, with its derivatives along arc
    /// length.
    fn jet(&self, s: f64) -> PoseJet;
}

impl TaughtPath for Path {
    fn span(&self) -> (f64, f64) {
        (0.0, self.length())
    }

    fn jet(&self, s: f64) -> PoseJet {
        Self::jet(self, s)
    }
}

/// The point of a path that lies straight across from a point in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Its path coordinate.
    pub s: f64,
    /// The point seen from it, in the path frame.
    pub offset: Offset,
    /// What is left of the point's distance along the tangent, in metres: rounding, where the search has arrived.
    pub along: f64,
}

/// The foot of a point (base frame, metres) on a path, nearest to the coordinate `near`: Newton's method on
/// (p − P(s))·T(s) = 0. `None` where it lies beyond the path's ends, or the path has no frame there.
///
/// Cost: two to five jets of the path, eight at most.
#[must_use]
pub fn foot(path: &impl TaughtPath, point: &Vector3, near: f64) -> Option<Foot> {
    let (first, last) = path.span();
    let mut s = near.clamp(first, last);
    for _ in 0..STEPS {
        let jet = path.jet(s);
        let across = point - jet.pose.translation.vector;
        let [tangent, curvature, _] = jet.linear;
        let along = across.dot(&tangent);
        if along.abs() <= SAME_POSITION {
            let frame = SeamFrame::of(&jet)?;
            return Some(Foot { s, offset: super::frame::across(&frame, &across), along });
        }
        // Towards the centre of curvature the feet draw together; at the centre there is none.
        let spread = (1.0 - across.dot(&curvature)).max(0.2);
        let next = (s + (along / spread).clamp(-LONGEST_STEP, LONGEST_STEP)).clamp(first, last);
        if next == s || !next.is_finite() {
            return None;
        }
        s = next;
    }
    None
}

/// Paths one after the other, with one coordinate over all of them; room for `M`.
///
/// A weld of several moves: paths are added at the end as they are planned and dropped behind the torch. The chain
/// is smooth: at a corner without a blend the path frame would jump, and with it the offset of one and the same seam.
#[derive(Debug, Clone)]
pub struct PathChain<const M: usize> {
    /// Each with the coordinate at which it begins.
    pieces: [Option<(Path, f64)>; M],
    first: usize,
    count: usize,
    end: f64,
}

/// Why a path does not go on from a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ChainError {
    /// The chain is full.
    Full {
        /// Paths that it has room for.
        room: usize,
    },
    /// The path turns on the spot, or is empty.
    NoLength,
    /// It begins elsewhere.
    Apart {
        /// Distance from the chain's end, in metres.
        distance: f64,
    },
    /// It begins in another direction.
    Kink {
        /// Angle between the tangents, in radians.
        angle: f64,
    },
}

impl fmt::Display for ChainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full { room } => write!(f, "the weld has more than {room} paths ahead"),
            Self::NoLength => write!(f, "a path without length: a seam is tracked along lines and curves"),
            Self::Apart { distance } => {
                write!(f, "the path begins {:.3} mm from the end of the one before", distance * 1e3)
            }
            Self::Kink { angle } => write!(
                f,
                "the path begins at {:.2} deg to the one before: a tracked seam needs a blend there",
                angle.to_degrees()
            ),
        }
    }
}

impl core::error::Error for ChainError {}

impl<const M: usize> PathChain<M> {
    /// An empty chain, whose first path will begin at the coordinate `start`.
    #[must_use]
    pub fn new(start: f64) -> Self {
        Self { pieces: [None; M], first: 0, count: 0, end: start }
    }

    /// Adds a path at the end.
    ///
    /// # Errors
    /// [`ChainError`] where there is no room or the path does not go on smoothly.
    pub fn push(&mut self, path: &Path) -> Result<(), ChainError> {
        if self.count == M {
            return Err(ChainError::Full { room: M });
        }
        if path.measure() != Measure::Length || path.length() <= SAME_POSITION {
            return Err(ChainError::NoLength);
        }
        if self.count > 0 {
            let (before, after) = (self.jet(self.end), path.jet(0.0));
            let distance = (after.pose.translation.vector - before.pose.translation.vector).norm();
            if distance > MEETING {
                return Err(ChainError::Apart { distance });
            }
            let angle = acos(before.linear[0].dot(&after.linear[0]).clamp(-1.0, 1.0));
            if angle > SMOOTH {
                return Err(ChainError::Kink { angle });
            }
        }
        self.pieces[(self.first + self.count) % M] = Some((*path, self.end));
        self.count += 1;
        self.end += path.length();
        Ok(())
    }

    /// Drops the paths that end before the coordinate `s`; the last one stays.
    pub fn drop_before(&mut self, s: f64) {
        while self.count > 1 && self.nth(1).is_some_and(|(_, start)| *start <= s) {
            self.first = (self.first + 1) % M;
            self.count -= 1;
        }
    }

    fn nth(&self, k: usize) -> Option<&(Path, f64)> {
        self.pieces[(self.first + k) % M].as_ref()
    }
}

impl<const M: usize> TaughtPath for PathChain<M> {
    /// From the first path still held to the last. An empty chain has an empty span.
    fn span(&self) -> (f64, f64) {
        let start = if self.count > 0 { self.nth(0).map(|(_, start)| *start) } else { None };
        (start.unwrap_or(self.end), self.end)
    }

    /// At rest at the origin where the chain is empty.
    fn jet(&self, s: f64) -> PoseJet {
        let after = (1..self.count).find(|k| self.nth(*k).is_some_and(|(_, start)| *start > s));
        let piece = if self.count > 0 { self.nth(after.unwrap_or(self.count) - 1) } else { None };
        piece.map_or_else(
            || PoseJet::at_rest(crate::geometry::Pose::identity()),
            |(path, start)| path.jet((s - start).clamp(0.0, path.length())),
        )
    }
}
