//! The run: moves of the tool centre point that follow each other without a stop, as far as they are known and not yet handed over.

use std::collections::VecDeque;
use std::sync::Arc;

use seamline::control::{ActsOn, Tracked};
use seamline::geometry::Pose;
use seamline::path::corner::Blend;
use seamline::path::{Measure, Path, TimingPiece};
use seamline::weave::Weave;

use super::corner::{BLEND_SHARES, SHARE, limits, lost_time, passing, takes_longer_than_a_stop};
use super::resolve::Goal;
use super::route::Route;
use super::smear::{Cap, Smear};
use super::smeared_corner::Pass;
use super::timing::{PathLimits, Stretch};
use crate::cell::Vibration;
use crate::job::{Location, Step};
use crate::record::{OnSeam, SegmentInfo, SegmentKind};

/// Nominal time that one look ahead covers, in seconds. The timing settles what lies before the stop that it must assume at its end.
const HORIZON: f64 = 1.0;
/// A run of which so many horizons settle nothing is ended on the way.
const FARTHEST: f64 = 8.0;
/// A closed run that takes no longer than this many horizons is looked at whole.
const WHOLE: f64 = 2.0;
/// Share of a corner's permitted error that is used: what is left is what a run's samples leave unknown of it.
const USED: f64 = 1.0 - 1e-5;
/// Two places of a path nearer than this are one: a nanometre.
const SAME_PLACE: f64 = 1e-9;

/// A move as programmed.
#[derive(Debug, Clone)]
pub(super) struct Link<const N: usize> {
    /// The instruction, with its move.
    pub(super) step: Step,
    pub(super) path: Path,
    pub(super) limits: PathLimits,
    /// What the cell permits to the tool on it: a corner may need more across the path than is of use along it.
    pub(super) permitted: PathLimits,
    pub(super) goal: Option<Goal<N>>,
    /// How far from its end the tool may pass; `None` where the move ends at rest.
    pub(super) pass: Option<f64>,
    pub(super) arc: bool,
    pub(super) notices: Vec<String>,
}

/// A path of the run with one speed: what is left of a link between its corners, or a corner.
#[derive(Debug, Clone)]
pub(super) struct Piece<const N: usize> {
    /// The move that it is, or that ends in this corner.
    pub(super) link: Arc<Link<N>>,
    pub(super) info: SegmentInfo,
    /// What is not handed over yet.
    pub(super) path: Path,
    pub(super) limits: PathLimits,
    /// Coordinate on the link's path at which `path` begins.
    pub(super) offset: f64,
    /// Part of it has been handed over.
    pub(super) begun: bool,
    /// Somewhere on it the speed is below the programmed one.
    slowed: bool,
    /// Where it follows a tracked seam.
    pub(super) tracked: Option<Tracked>,
    /// How far prefilters take the tool off it, as far as it has been looked at, in metres.
    pub(super) off: f64,
    /// Of a corner: how prefilters permit to pass it, where that is known.
    pub(super) cap: Option<Pass>,
    /// Steps that take no time, done when the piece is.
    pub(super) after: Vec<Step>,
}

/// How far the next timing looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sight {
    pub(super) to: f64,
    /// The run goes on beyond.
    pub(super) open: bool,
}

/// The run.
#[derive(Debug, Clone)]
pub(super) struct Run<const N: usize> {
    pieces: VecDeque<Piece<N>>,
    /// What prefilters do to it, and what they act on.
    pub(super) smear: Option<Smear>,
    pub(super) acts_on: ActsOn,
    /// Limits on account of places that are handed over.
    pub(super) caps: Vec<Cap>,
    /// Speed at its start, where there is no acceleration.
    pub(super) speed: f64,
    /// How long the last moves handed out take, in seconds: what prefilters on the feedrate have to remember.
    pub(super) laid: VecDeque<f64>,
    /// How it would come to rest from there, as planned when less of it was known.
    pub(super) way_to_rest: Vec<TimingPiece>,
    /// Greatest curvature of a corner that is passed, in 1/m.
    pub(super) most_bent: f64,
    /// How many times as far as usual the next look goes: where a nearer one settled nothing, it would find the same again.
    pub(super) farther: f64,
}

/// Why a move cannot be run on to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stops(pub(super) &'static str);

impl<const N: usize> Link<N> {
    pub(super) fn at(&self) -> &Location {
        &self.step.at
    }

    /// What its motion is held against.
    pub(super) fn info(&self, segment: u32) -> SegmentInfo {
        SegmentInfo {
            segment,
            line: self.at().line,
            kind: SegmentKind::Path(self.path),
            speed: Some(self.limits.speed),
            arc: self.arc,
            constant_part: None,
            rounded: [0.0; 2],
            seam: OnSeam::No,
        }
    }

    /// Whether the tool centre point moves: a turn on the spot stands alone.
    pub(super) fn travels(&self) -> bool {
        self.path.measure() == Measure::Length
    }
}

impl<const N: usize> Run<N> {
    /// Empty.
    pub(super) fn new(vibration: &Vibration) -> Self {
        let (caps, laid, way_to_rest) = (Vec::new(), VecDeque::new(), Vec::new());
        let (smear, acts_on) = (Smear::of(vibration), vibration.acts_on());
        let (pieces, most_bent) = (VecDeque::new(), f64::INFINITY);
        Self { pieces, smear, acts_on, caps, laid, speed: 0.0, way_to_rest, most_bent, farther: 1.0 }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    pub(super) fn last(&self) -> Option<&Link<N>> {
        self.pieces.back().map(|piece| &*piece.link)
    }

    /// Where it leads.
    pub(super) fn end(&self) -> Option<Pose> {
        self.last().map(|link| link.path.pose(link.path.length()))
    }

    /// Begins with a move.
    pub(super) fn begin(&mut self, link: &Link<N>, segment: &mut u32) {
        self.add(link, link.path, 0.0, segment);
    }

    /// Goes on with a move; `segment` counts on.
    ///
    /// # Errors
    /// [`Stops`] where the robot must stop on the point between; the run is unchanged.
    pub(super) fn push(&mut self, link: &Link<N>, segment: &mut u32) -> Result<(), Stops> {
        let smear = self.rounding();
        let Some(last) = self.pieces.back_mut() else {
            self.begin(link, segment);
            return Ok(());
        };
        let lengths = [last.link.path.length(), link.path.length()];
        let (speed, slower) =
            (last.limits.speed.max(link.limits.speed), last.limits.speed.min(link.limits.speed));
        let permitted = USED * last.link.pass.unwrap_or(0.0);
        let of_both = [&last.link.permitted, &link.permitted];
        let blend = |error| passing([&last.path, &link.path], lengths, speed, error);
        let Some(mut corner) = blend(permitted)? else {
            self.add(link, link.path, 0.0, segment);
            return Ok(());
        };
        if let Some(smear) = smear {
            let point = link.path.pose(0.0).translation.vector;
            let hardest = [last.limits, link.limits].map(|limits| [limits.acceleration, limits.jerk]);
            let hardest = [0, 1].map(|k| f64::max(hardest[0][k], hardest[1][k]));
            let lost = |blend: &Blend| {
                let limits = limits(blend, of_both);
                lost_time(blend, point, permitted, (speed, limits.speed, hardest), &smear, last.info.arc)
            };
            let blends = BLEND_SHARES.iter().filter_map(|share| blend(share * permitted).ok()?);
            corner = blends.min_by(|a, b| lost(a).total_cmp(&lost(b))).unwrap_or(corner);
        }
        if corner.greatest_curvature > self.most_bent {
            return Err(Stops("the tracked seam has a corner here"));
        }
        let limits = limits(&corner, of_both);
        if takes_longer_than_a_stop(&corner, &limits, slower, self.smear) {
            return Err(Stops("going round it would take longer than a stop"));
        }
        last.path = corner.before;
        last.info.rounded[1] = rounded(corner.trims[0], last.limits.speed, smear);
        *segment += 1;
        let piece = last.corner(&corner.path, limits, *segment);
        self.pieces.push_back(piece);
        self.add(link, corner.after, corner.trims[1], segment);
        Ok(())
    }

    fn add(&mut self, link: &Link<N>, path: Path, offset: f64, segment: &mut u32) {
        *segment += 1;
        let (mut info, limits) = (link.info(*segment), link.limits);
        info.rounded[0] = if offset > 0.0 { rounded(offset, limits.speed, self.rounding()) } else { 0.0 };
        let link = Arc::new(link.clone());
        let (begun, slowed, tracked, off, cap, after) = (false, false, None, 0.0, None, Vec::new());
        self.pieces.push_back(Piece {
            link,
            info,
            path,
            limits,
            offset,
            begun,
            slowed,
            tracked,
            off,
            cap,
            after,
        });
    }

    /// A step that takes no time, when all moves so far are done.
    pub(super) fn add_aside(&mut self, step: Step) {
        if let Some(last) = self.pieces.back_mut() {
            last.after.push(step);
        }
    }

    /// How many pieces it has.
    pub(super) fn count(&self) -> usize {
        self.pieces.len()
    }

    /// All of it.
    pub(super) fn pieces(&mut self) -> &mut [Piece<N>] {
        self.pieces.make_contiguous()
    }

    /// Has its pieces follow a seam, each as said: they are planned faster, since the torch is held to its speed along the seam.
    pub(super) fn track(&mut self, tracked: &[Tracked]) {
        for (piece, tracked) in self.pieces.iter_mut().zip(tracked) {
            piece.tracked = Some(*tracked);
            piece.limits.speed *= tracked.headroom;
            piece.info.seam = OnSeam::Tracked;
        }
    }

    /// How far the next timing is to look; `None` where more of the run must be known first.
    pub(super) fn sight(&self, closed: bool) -> Option<Sight> {
        let last = self.pieces.back()?;
        let whole: f64 = self.pieces.iter().map(|piece| piece.path.length()).sum();
        let time: f64 = self.pieces.iter().map(|piece| piece.path.length() / piece.limits.speed).sum();
        if closed && time <= WHOLE * HORIZON * self.farther {
            return Some(Sight { to: whole, open: false });
        }
        // The end of the last move may yet become a corner.
        let certain =
            if closed { whole } else { whole - SHARE * last.link.path.length() - 2.0 * self.reach() };
        let to = self.reached_in(HORIZON * self.farther);
        (to < certain).then_some(Sight { to, open: self.farther <= FARTHEST })
    }

    /// What prefilters do to the path itself: nothing where they act on the feedrate.
    fn rounding(&self) -> Option<Smear> {
        self.smear.filter(|_| self.acts_on == ActsOn::Joints)
    }

    /// How far a place may slow down the way before it, on account of prefilters.
    pub(super) fn reach(&self) -> f64 {
        self.smear.map_or(0.0, |smear| self.fastest() * smear.length)
    }

    /// The greatest programmed speed.
    pub(super) fn fastest(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.limits.speed).fold(0.0, f64::max)
    }

    /// The greatest acceleration and jerk along it.
    pub(super) fn hardest(&self) -> [f64; 2] {
        let of =
            |[a, j]: [f64; 2], piece: &Piece<N>| [a.max(piece.limits.acceleration), j.max(piece.limits.jerk)];
        self.pieces.iter().fold([0.0; 2], of)
    }

    /// A place ahead, or the end of the corner that it lies in: a corner is looked at whole.
    pub(super) fn past_corner(&self, place: f64) -> f64 {
        let corner = self
            .placed()
            .find(|(from, piece)| piece.is_corner() && *from < place && place < from + piece.path.length());
        corner.map_or(place, |(from, piece)| from + piece.path.length())
    }

    /// The prefilters take the tool this far off a piece.
    pub(super) fn note_off(&mut self, index: usize, off: f64) {
        if let Some(piece) = self.pieces.get_mut(index) {
            piece.off = piece.off.max(off);
        }
    }

    /// How prefilters permit to pass a corner; gives the cap.
    pub(super) fn pass_corner(&mut self, index: usize, pass: Pass) -> Option<Cap> {
        let from = self.placed().nth(index).map(|(from, _)| from)?;
        let piece = self.pieces.get_mut(index)?;
        piece.cap = Some(pass);
        Some(pass.cap([from, from + piece.path.length()]))
    }

    /// Keeps the caps on account of places before `end`, which is the new start.
    pub(super) fn keep_caps(&mut self, caps: &[Cap], end: f64) {
        let lasting = caps.iter().filter(|cap| cap.place < end && cap.to > end);
        let moved =
            |cap: &Cap| Cap { place: cap.place - end, from: cap.from - end, to: cap.to - end, ..*cap };
        self.caps = lasting.map(moved).collect();
    }

    /// The pieces with where they begin.
    pub(super) fn placed(&self) -> impl Iterator<Item = (f64, &Piece<N>)> {
        self.pieces.iter().scan(0.0, |start, piece| {
            let from = *start;
            *start += piece.path.length();
            Some((from, piece))
        })
    }

    /// The coordinate reached after a time at programmed speeds.
    fn reached_in(&self, time: f64) -> f64 {
        let mut left = time;
        let mut s = 0.0;
        for piece in &self.pieces {
            let takes = piece.path.length() / piece.limits.speed;
            if takes >= left {
                return s + left * piece.limits.speed;
            }
            (left, s) = (left - takes, s + piece.path.length());
        }
        s
    }

    /// The way up to a coordinate, with its limits.
    pub(super) fn route(&self, to: f64) -> (Route, Vec<Stretch>) {
        let (mut route, mut stretches) = (Route::default(), Vec::new());
        for piece in &self.pieces {
            let left = to - route.length();
            // A rest that rounding leaves is no path.
            if left <= SAME_PLACE {
                break;
            }
            let whole = left >= piece.path.length() - SAME_PLACE;
            let path = if whole { piece.path } else { piece.path.part(0.0, left) };
            route.push(path);
            stretches.push(Stretch { to: route.length(), limits: piece.limits });
        }
        (route, stretches)
    }

    /// Where its paths end, up to a place.
    pub(super) fn ends_up_to(&self, place: f64) -> Vec<f64> {
        let mut ends = Vec::new();
        let mut end = 0.0;
        for piece in &self.pieces {
            end += piece.path.length();
            if end >= place {
                break;
            }
            ends.push(end);
        }
        ends.push(place);
        ends
    }

    pub(super) fn piece(&self, index: usize) -> Option<&Piece<N>> {
        self.pieces.get(index)
    }

    /// Takes the first piece with its timing, and whether that is all that is left of it.
    pub(super) fn take_first(&mut self, timing: &[TimingPiece], slowed: bool) -> Option<(Piece<N>, bool)> {
        let first = self.pieces.front_mut()?;
        first.slowed |= slowed;
        first.info.constant_part = first.constant_part(timing);
        let place = timing.last().map_or(0.0, |piece| piece.end().position);
        let length = first.path.length();
        if place >= length - SAME_PLACE {
            return self.pieces.pop_front().map(|piece| (piece, true));
        }
        let mut taken = first.clone();
        taken.path = first.path.part(0.0, place);
        taken.after.clear();
        first.path = first.path.part(place, length);
        first.offset += place;
        if let Some(tracked) = &mut first.tracked {
            tracked.start += place;
        }
        first.begun = true;
        Some((taken, false))
    }

    /// Gives the run up: the steps that would have followed the piece with this number and its link.
    pub(super) fn give_up_after(&mut self, index: usize) -> Vec<Step> {
        let pieces = std::mem::take(&mut self.pieces);
        (self.speed, self.farther) = (0.0, 1.0);
        self.caps.clear();
        let Some(failed) = pieces.get(index).map(|piece| Arc::clone(&piece.link)) else { return Vec::new() };
        let mut steps = Vec::new();
        let mut of = failed;
        for piece in pieces.into_iter().skip(index) {
            if !Arc::ptr_eq(&piece.link, &of) {
                steps.push(piece.link.step.clone());
                of = Arc::clone(&piece.link);
            }
            steps.extend(piece.after);
        }
        steps
    }
}

/// How far from a corner a move is rounded by prefilters, in metres along it; `trim` is what the corner's blend took.
fn rounded(trim: f64, speed: f64, smear: Option<Smear>) -> f64 {
    smear.map_or(0.0, |smear| trim + speed * smear.length)
}

impl<const N: usize> Piece<N> {
    pub(super) fn is_corner(&self) -> bool {
        matches!(self.info.kind, SegmentKind::Corner { .. })
    }

    /// Some of what was handed out is slower than programmed.
    pub(super) fn is_slowed(&self) -> bool {
        self.slowed
    }

    /// Weaves about it; `start` is the weave's coordinate where it begins.
    pub(super) fn lay(&mut self, weave: &Weave, start: f64) {
        self.path = self.path.woven(weave, start);
        match &mut self.info.kind {
            SegmentKind::Corner { path, .. } => *path = Some(self.path),
            kind => *kind = SegmentKind::Path(self.link.path.woven(weave, start - self.offset)),
        }
    }

    /// The corner that this move, which has been cut short for it, ends in. What follows the move follows the corner.
    fn corner(&mut self, blend: &Path, limits: PathLimits, segment: u32) -> Self {
        let link = Arc::clone(&self.link);
        let length = link.path.length();
        let kind = SegmentKind::Corner {
            path: Some(*blend),
            corner: link.path.pose(length).translation.vector,
            permitted: link.pass.unwrap_or(0.0),
        };
        let info = SegmentInfo { segment, kind, speed: Some(limits.speed), constant_part: None, ..self.info };
        let after = std::mem::take(&mut self.after);
        let (begun, slowed, tracked, off, cap) = (false, false, None, 0.0, None);
        let offset = length;
        Self { link, info, path: *blend, limits, offset, begun, slowed, tracked, off, cap, after }
    }

    /// From where to where the plan holds the programmed speed, with what this timing adds; in the coordinate of the link.
    fn constant_part(&self, timing: &[TimingPiece]) -> Option<[f64; 2]> {
        if self.slowed || !matches!(self.info.kind, SegmentKind::Path(_)) {
            return None;
        }
        let cruises = |piece: &&TimingPiece| {
            piece.acceleration == 0.0
                && piece.jerk == 0.0
                && piece.velocity >= self.limits.speed * (1.0 - 1e-9)
        };
        let first = timing.iter().find(cruises).map(|piece| self.offset + piece.position);
        let last = timing.iter().rev().find(cruises).map(|piece| self.offset + piece.end().position);
        match (self.info.constant_part, first, last) {
            (Some([from, _]), _, Some(to)) => Some([from, to]),
            (None, Some(from), Some(to)) => Some([from, to]),
            (before, ..) => before,
        }
    }
}
