//! Segments that overlap in time: each is a rectangular pulse of feedrate through a prefilter, and their ways add up.

use nalgebra::Vector3;
use seamline::path::Path;
use seamline::vibration::{Corner, Overlap, Ramp, angle_between, reachable_feedrate};

use crate::least::least_between;

/// The corner error is used to this fraction: curvature is met by iteration.
const CLOSE: f64 = 1e-4;
/// Bound of that iteration; two or three steps are usual.
const STEPS: usize = 30;
/// Bound of the search for the nearest point: thirds of the overlap, 100 times.
const THIRDS: usize = 100;

/// A path whose segments overlap at their corners.
#[derive(Debug)]
pub struct Blend<'a> {
    segments: Vec<Segment<'a>>,
    corners: Vec<PlannedCorner>,
}

/// A corner between two segments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedCorner {
    /// Change of direction, in radians.
    pub angle: f64,
    /// The overlap; times count from where the first segment begins to decelerate.
    pub overlap: Overlap,
    /// Least distance of the commanded path from the corner, curvature and all, in metres.
    pub error: f64,
}

#[derive(Debug, Clone, Copy)]
struct Segment<'a> {
    path: &'a Path,
    ramp: &'a Ramp,
    feedrate: f64,
    start: f64,
}

impl Segment<'_> {
    /// When it begins to decelerate.
    fn deceleration(&self) -> f64 {
        self.start + self.path.length() / self.feedrate
    }

    /// How far the tool is on it.
    fn way(&self, time: f64) -> f64 {
        let from_start = time - self.start;
        let from_deceleration = time - self.deceleration();
        if from_deceleration >= 0.0 {
            self.path.length() - self.feedrate * self.ramp.remaining(from_deceleration)
        } else {
            self.feedrate * self.ramp.integral(from_start)
        }
    }
}

/// Where segments lead that each have gone some way: their ways add up.
pub(super) fn superposed<'a>(segments: impl Iterator<Item = (&'a Path, f64)>) -> Vector3<f64> {
    let mut sum: Option<Vector3<f64>> = None;
    for (path, way) in segments {
        let at = |s: f64| path.pose(s).translation.vector;
        let start = at(0.0);
        sum = Some(sum.unwrap_or(start) + at(way.clamp(0.0, path.length())) - start);
    }
    sum.unwrap_or_default()
}

impl<'a> Blend<'a> {
    /// Plans the corners of a path, each with the permitted error in metres. Feedrates are lowered where a segment is too short.
    #[must_use]
    pub fn plan(path: &'a [Path], ramp: &'a Ramp, feedrate: f64, permitted: f64) -> Self {
        let mut segments: Vec<Segment<'a>> = Vec::with_capacity(path.len());
        let mut corners = Vec::new();
        for piece in path {
            let feedrate = reachable_feedrate(piece.length(), ramp, ramp, feedrate);
            let mut segment = Segment { path: piece, ramp, feedrate, start: 0.0 };
            if let Some(before) = segments.last() {
                let corner = plan_corner(before, &segment, permitted);
                segment.start = before.deceleration() + corner.overlap.delay;
                corners.push(corner);
            }
            segments.push(segment);
        }
        Self { segments, corners }
    }

    /// When the last segment comes to rest, in seconds.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.segments.last().map_or(0.0, |last| last.deceleration() + last.ramp.duration())
    }

    /// The commanded position at a time.
    #[must_use]
    pub fn position(&self, time: f64) -> Vector3<f64> {
        let started =
            self.segments.iter().take_while(|segment| segment.start <= time || segment.start <= 0.0);
        superposed(started.map(|segment| (segment.path, segment.way(time))))
    }

    /// The corners, in the order of the path.
    #[must_use]
    pub fn corners(&self) -> &[PlannedCorner] {
        &self.corners
    }
}

/// The tangents give the overlap; where a segment is curved, the permitted error is scaled until the path itself has it.
fn plan_corner(first: &Segment<'_>, second: &Segment<'_>, permitted: f64) -> PlannedCorner {
    let before = first.path.jet(first.path.length()).linear[0];
    let after = second.path.jet(0.0).linear[0];
    let angle = angle_between(&before, &after);
    let corner = Corner {
        deceleration: first.ramp,
        acceleration: second.ramp,
        first_feedrate: first.feedrate,
        second_feedrate: second.feedrate,
        angle,
        longest: f64::INFINITY,
    };
    let aim = permitted * (1.0 - 0.5 * CLOSE);
    let mut asked = aim;
    let mut best = PlannedCorner { angle, overlap: corner.at(0.0), error: 0.0 };
    for _ in 0..STEPS {
        let overlap = corner.overlap(asked);
        let error = distance(first, second, &overlap);
        if error <= permitted && overlap.overlap >= best.overlap.overlap {
            best = PlannedCorner { angle, overlap, error };
        }
        let whole = overlap.overlap >= overlap.deceleration && error <= permitted;
        if whole || error <= 0.0 || (error - aim).abs() <= 0.5 * CLOSE * permitted {
            break;
        }
        asked *= aim / error;
    }
    best
}

/// Least distance of the overlapping segments from their corner.
fn distance(first: &Segment<'_>, second: &Segment<'_>, overlap: &Overlap) -> f64 {
    let first = Segment { start: 0.0, ..*first };
    let begin = first.deceleration();
    let second = Segment { start: begin + overlap.delay, ..*second };
    let corner = first.path.pose(first.path.length()).translation.vector;
    let place = |time: f64| superposed([&first, &second].into_iter().map(|s| (s.path, s.way(time))));
    let at = |time: f64| (place(time) - corner).norm();
    at(least_between(at, [begin + overlap.delay, begin + overlap.deceleration], THIRDS))
}
