//! Windows and cruise, one after the other: where the tool is commanded to be.

use nalgebra::Vector3;
use seamline::path::Path;
use seamline::vibration::{Mode, Overlap, angle_between};

use super::super::Plant;
use super::super::blend::{PlannedCorner, superposed};
use super::window::{Course, Courses};

/// A motion along a path.
#[derive(Debug, Clone)]
pub struct QuietMotion<'a> {
    segments: Vec<Segment<'a>>,
    corners: Vec<PlannedCorner>,
    step: f64,
}

/// A segment: it comes out of one window, cruises, and goes into the next.
#[derive(Debug, Clone)]
struct Segment<'a> {
    path: &'a Path,
    feedrate: f64,
    entry_start: f64,
    entry: Course,
    exit_start: f64,
    exit: Course,
}

impl Segment<'_> {
    /// How far it is at a time.
    fn way(&self, time: f64, step: f64) -> f64 {
        let length = self.path.length();
        if time >= self.exit_start {
            length - self.exit.whole() + self.exit.way_at(time - self.exit_start, step, self.feedrate)
        } else {
            self.entry.way_at(time - self.entry_start, step, self.feedrate)
        }
    }
}

impl Course {
    /// The way at a time since the window's start: 0 before it, on in cruise after it.
    fn way_at(&self, time: f64, step: f64, cruise: f64) -> f64 {
        let last = self.feedrates.len() - 1;
        let at = (time / step).max(0.0);
        let index = (at as usize).min(last);
        let inside = (time - step * index as f64).max(0.0);
        let from = self.feedrates[index];
        let to = self.feedrates.get(index + 1).copied().unwrap_or(from);
        self.ways[index] + cruise * inside * (from + 0.5 * (to - from) * inside / step)
    }
}

impl<'a> QuietMotion<'a> {
    /// Puts the windows one after the other, with as much cruise in between as the segments are long.
    pub(super) fn lay(path: &'a [Path], feedrates: &[f64], step: f64, windows: &[Courses]) -> Self {
        let mut segments: Vec<Segment<'a>> = Vec::with_capacity(path.len());
        let mut start = 0.0;
        for ((piece, feedrate), pair) in path.iter().zip(feedrates).zip(windows.windows(2)) {
            let entry = pair[0].second.clone().unwrap_or_default();
            let exit = pair[1].first.clone().unwrap_or_default();
            let entry_end = start + step * (entry.feedrates.len() - 1) as f64;
            let cruise = (piece.length() - entry.whole() - exit.whole()).max(0.0);
            let exit_start = entry_end + cruise / feedrate;
            segments.push(Segment {
                path: piece,
                feedrate: *feedrate,
                entry_start: start,
                entry,
                exit_start,
                exit,
            });
            start = exit_start;
        }
        let mut motion = Self { segments, corners: Vec::new(), step };
        motion.corners = motion.segments.windows(2).map(|pair| motion.corner(&pair[0], &pair[1])).collect();
        motion
    }

    /// When the last command is given, in seconds.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.segments
            .last()
            .map_or(0.0, |last| last.exit_start + self.step * (last.exit.feedrates.len() - 1) as f64)
    }

    /// The commanded position at a time.
    #[must_use]
    pub fn position(&self, time: f64) -> Vector3<f64> {
        superposed(self.segments.iter().map(|segment| (segment.path, segment.way(time, self.step))))
    }

    /// The corners, in the order of the path.
    #[must_use]
    pub fn corners(&self) -> &[PlannedCorner] {
        &self.corners
    }

    /// Greatest acceleration of a tool that is as modelled, and its root mean square over the motion, in m/s².
    pub(super) fn vibration(&self, mode: &Mode) -> [f64; 2] {
        const PARTS: f64 = 5.0;
        let period = self.step / PARTS;
        let cycles = (self.duration() / period).ceil() as u32;
        let mut tool = Plant::at_rest(*mode, self.position(0.0));
        let step = |cycle: u32| tool.step(self.position(period * f64::from(cycle)), period).norm_squared();
        let (greatest, sum) =
            (1..=cycles).map(step).fold((0.0_f64, 0.0), |(greatest, sum), a| (greatest.max(a), sum + a));
        [greatest, sum / f64::from(cycles.max(1))].map(f64::sqrt)
    }

    /// A corner as it came out, in the words of the corners that are planned by overlap.
    fn corner(&self, first: &Segment<'_>, second: &Segment<'_>) -> PlannedCorner {
        let start = first.exit_start;
        let length = first.path.length();
        let at = |time: f64| {
            let ways = [(first.path, first.way(time, self.step)), (second.path, second.way(time, self.step))];
            superposed(ways.into_iter())
        };
        let corner = first.path.pose(length).translation.vector;
        let steps = first.exit.feedrates.len() - 1;
        let begins = first.exit.feedrates.iter().take_while(|f| **f > 1.0 - BEGUN).count() as f64;
        let count = steps as u32 * NEAREST;
        let times = (0..=count).map(|n| start + self.step * f64::from(n) / f64::from(NEAREST));
        let near = times.map(|time| ((at(time) - corner).norm(), time));
        let (error, nearest) = near.fold((f64::INFINITY, start), |a, b| if b.0 < a.0 { b } else { a });
        let begins = (begins - 1.0).max(0.0);
        let moved = MOVED.max(MOVED_OF_ERROR * error);
        let ends = first.exit.ways.iter().take_while(|w| **w < first.exit.whole() - moved).count() as f64;
        let starts = second.entry.ways.iter().take_while(|w| **w < moved).count() as f64;
        PlannedCorner {
            angle: angle_between(&first.path.jet(length).linear[0], &second.path.jet(0.0).linear[0]),
            overlap: Overlap {
                deceleration: self.step * (ends - begins),
                nearest: nearest - start - self.step * begins,
                overlap: self.step * (ends - starts).max(0.0),
                delay: self.step * (starts - begins),
                error,
            },
            error,
        }
    }
}

/// Over the cruise: a segment that is slower by more has begun to decelerate.
const BEGUN: f64 = 1e-3;
/// A way below this, in metres or over the corner error, is no motion yet.
const MOVED: f64 = 1e-6;
const MOVED_OF_ERROR: f64 = 0.02;
/// Places in a step among which the nearest to the corner is taken.
const NEAREST: u32 = 50;
