//! Path and speed figures of every segment.

use std::collections::VecDeque;

use seamline::control::Mode;
use seamline::geometry::Vector3;
use seamline::path::{Curve, Measure, Path};
use serde::Serialize;

use super::corner::CornerWatch;
use super::deviation::{Deviation, Programmed};
use super::joints::follows;
use crate::record::info::{OnSeam, SegmentInfo, SegmentKind};
use crate::record::sample::Sample;

/// Figures of one executed segment. What a kind of segment does not have is left out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MoveFigures {
    /// Running number of the segment.
    pub segment: u32,
    /// Line of the job file.
    pub line: u32,
    /// `MOVJ`, `MOVL`, `MOVC`, `MOVS`, `corner` or `dwell`.
    pub kind: &'static str,
    /// The arc is lit.
    pub arc: bool,
    /// Time of the first sample.
    pub start_s: f64,
    /// Time of the last sample.
    pub end_s: f64,
    /// Length of the tool path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_mm: Option<f64>,
    /// Programmed speed of the tool centre point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_programmed_mm_s: Option<f64>,
    /// Least speed in the constant part (in a corner: anywhere) while the override is steady.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_min_mm_s: Option<f64>,
    /// Greatest speed in the constant part (in a corner: anywhere) while the override is steady.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_max_mm_s: Option<f64>,
    /// Greatest distance of the speed in the constant part from the programmed speed times the override, as a fraction
    /// of the programmed speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_error_max: Option<f64>,
    /// Greatest distance from the programmed line (MOVL), or from a corner's that is woven.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub straightness_max_mm: Option<f64>,
    /// Greatest distance from the programmed arc (MOVC).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arc_deviation_max_mm: Option<f64>,
    /// Greatest angle from the programmed orientation, which follows the geodesic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orientation_deviation_max_rad: Option<f64>,
    /// Least distance from a corner that is passed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_error_mm: Option<f64>,
    /// Permitted distance from it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_permitted_mm: Option<f64>,
}

impl MoveFigures {
    /// Greatest distance from the programmed line or arc.
    #[must_use]
    pub fn path_deviation_max_mm(&self) -> Option<f64> {
        self.straightness_max_mm.or(self.arc_deviation_max_mm)
    }
}

/// Follows the samples through the programmed segments.
#[derive(Debug, Clone)]
pub(super) struct MoveWatch {
    period: f64,
    /// Segments announced and not reached yet.
    ahead: VecDeque<SegmentInfo>,
    current: Option<Current>,
    last: Option<Before>,
    done: Vec<(SegmentInfo, MoveFigures)>,
}

/// What is kept of the last sample.
#[derive(Debug, Clone, Copy)]
struct Before {
    time: f64,
    segment: u32,
    position: Vector3,
    override_rate: f64,
}

/// What the move watch finds in one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// Mean speed of the tool centre point since the last sample, in m/s; NaN for the first and after a gap.
    pub(super) speed: f64,
    /// Distance from the programmed path, in metres; NaN where there is none.
    pub(super) deviation: f64,
    /// The segment that has just been entered.
    pub(super) entered: Option<SegmentInfo>,
}

#[derive(Debug, Clone)]
struct Current {
    info: SegmentInfo,
    programmed: Option<Programmed>,
    /// Of the programmed path, in its own coordinate.
    length: f64,
    corner: Option<CornerWatch>,
    start: f64,
    end: f64,
    /// Greatest distance and angle from the path, where it has not been rounded.
    off: Option<[f64; 2]>,
    /// Least and greatest speed in the constant part.
    speed: Option<[f64; 2]>,
    speed_error: f64,
    /// Path coordinate of the last sample.
    last_s: f64,
    /// Where the last sample stood at the seam.
    last_seam: Vector3,
}

/// While the override changes, and in a pause, the speed is neither the job's nor a mistake.
fn is_steady(sample: &Sample, before: Option<Before>) -> bool {
    sample.override_rate > 0.0 && before.is_some_and(|before| before.override_rate == sample.override_rate)
}

impl MoveWatch {
    pub(super) fn new(period: f64) -> Self {
        Self { period, ahead: VecDeque::new(), current: None, last: None, done: Vec::new() }
    }

    /// Announces a segment before its first sample. More that has become known of it takes the place of what was said before.
    pub(super) fn announce(&mut self, info: SegmentInfo) {
        let current = self.current.as_mut().map(|current| &mut current.info);
        let known = current.into_iter().chain(&mut self.ahead).find(|known| known.segment == info.segment);
        match known {
            Some(known) => *known = info,
            None => self.ahead.push_back(info),
        }
    }

    pub(super) fn push(&mut self, sample: &Sample) -> Moment {
        let now = Before {
            time: sample.time,
            segment: sample.segment,
            position: sample.tcp.translation.vector,
            override_rate: sample.override_rate,
        };
        let before = self.last.replace(now).filter(|last| follows(last.time, now.time, self.period));
        let speed = before.map_or(f64::NAN, |last| (now.position - last.position).norm() / self.period);
        let entered = self.enter(sample);
        let deviation = self.current.as_mut().map_or(f64::NAN, |current| current.push(sample, before, speed));
        Moment { speed, deviation, entered }
    }

    /// Goes on to the sample's segment.
    fn enter(&mut self, sample: &Sample) -> Option<SegmentInfo> {
        if self.current.as_ref().map_or(0, |current| current.info.segment) == sample.segment {
            return None;
        }
        self.leave();
        while self.ahead.front().is_some_and(|info| info.segment < sample.segment) {
            self.ahead.pop_front();
        }
        self.ahead.front().filter(|info| info.segment == sample.segment)?;
        let info = self.ahead.pop_front()?;
        self.current = Some(Current::new(info, sample.time));
        Some(info)
    }

    fn leave(&mut self) {
        if let Some(current) = self.current.take() {
            self.done.push((current.info, current.figures()));
        }
    }

    /// The executed segments in order.
    pub(super) fn finish(mut self) -> (Vec<SegmentInfo>, Vec<MoveFigures>) {
        self.leave();
        self.done.into_iter().unzip()
    }
}

impl Current {
    fn new(info: SegmentInfo, time: f64) -> Self {
        let programmed = match &info.kind {
            SegmentKind::Path(path) => Some(Programmed::new(path)),
            SegmentKind::Corner { path: Some(path), .. } if path.is_woven() => Some(Programmed::new(path)),
            _ => None,
        };
        let corner = match &info.kind {
            // A tracked seam passes a taught corner elsewhere.
            SegmentKind::Corner { corner, .. } if info.seam == OnSeam::No => Some(CornerWatch::new(*corner)),
            _ => None,
        };
        Self {
            info,
            programmed,
            length: info.kind.path().map_or(0.0, Path::length),
            corner,
            start: time,
            end: time,
            off: None,
            speed: None,
            speed_error: 0.0,
            last_s: f64::NAN,
            last_seam: Vector3::zeros(),
        }
    }

    /// Takes a sample of this segment; returns its distance from the path.
    fn push(&mut self, sample: &Sample, before: Option<Before>, speed: f64) -> f64 {
        self.end = sample.time;
        let here = sample.tcp.translation.vector;
        let off = self.programmed.as_ref().map(|programmed| programmed.deviation(&sample.tcp, self.last_s));
        let seam = off.map_or(here, |off| off.seam);
        let last_seam = std::mem::replace(&mut self.last_seam, seam);
        // A weave is judged by its travel along the seam.
        let is_woven = self.programmed.as_ref().is_some_and(Programmed::is_woven);
        let travel = before.map(|before| (seam - last_seam).norm() / (sample.time - before.time));
        let speed = travel.filter(|_| is_woven).unwrap_or(speed);
        if let Some(corner) = &mut self.corner {
            corner.push(seam);
            if before.is_some_and(|before| before.segment == sample.segment) && is_steady(sample, before) {
                self.note_speed(speed);
            }
        }
        let Some(Deviation { s, distance, angle, .. }) = off else { return f64::NAN };
        let distance = match (self.info.seam, &self.programmed) {
            (OnSeam::No, _) => distance,
            // A weave's plane goes with the tracked seam.
            (OnSeam::Tracked, Some(programmed)) if !programmed.is_woven() => {
                programmed.beside(&sample.tcp, s, [sample.seam_lateral, sample.seam_height])
            }
            _ => f64::NAN,
        };
        let [from, to] = self.info.rounded;
        if from <= s && s <= self.length - to && distance.is_finite() {
            let [most, turn] = self.off.unwrap_or_default();
            self.off = Some([most.max(distance), turn.max(angle)]);
        }
        // Both ends of the cycle must lie in the constant part, of this segment.
        let last_s = std::mem::replace(&mut self.last_s, s);
        // What fades of a correction has a speed of its own, and a weave about a tracked seam is not told from its travel.
        let judged = match self.info.seam {
            OnSeam::No => true,
            OnSeam::Tracked => !is_woven,
            OnSeam::Leaves => false,
        };
        let constant = judged && self.info.constant_part.is_some_and(|[from, to]| from <= last_s && s <= to);
        if let (true, Some(before), Some(speed_programmed)) = (constant, before, self.info.speed)
            && sample.mode == Mode::Running
            && before.segment == sample.segment
        {
            let expected = speed_programmed * 0.5 * (before.override_rate + sample.override_rate);
            self.speed_error = self.speed_error.max((speed - expected).abs() / speed_programmed);
            if is_steady(sample, Some(before)) {
                self.note_speed(speed);
            }
        }
        distance
    }

    fn note_speed(&mut self, speed: f64) {
        let [least, greatest] = self.speed.unwrap_or([speed, speed]);
        self.speed = Some([least.min(speed), greatest.max(speed)]);
    }

    fn figures(&self) -> MoveFigures {
        let info = &self.info;
        let path = match &info.kind {
            SegmentKind::Path(path) => Some(path),
            _ => None,
        };
        let permitted = match &info.kind {
            SegmentKind::Corner { permitted, .. } => Some(*permitted),
            _ => None,
        };
        let travels = info.kind.path().is_some_and(|path| path.measure() == Measure::Length);
        let is_arc = path.is_some_and(|path| matches!(path.curve(), Curve::Arc(_)));
        let mm = |metres: f64| metres * 1e3;
        MoveFigures {
            segment: info.segment,
            line: info.line,
            kind: info.kind.name(),
            arc: info.arc,
            start_s: self.start,
            end_s: self.end,
            length_mm: info.kind.path().map(|_| mm(info.length())),
            speed_programmed_mm_s: info.speed.filter(|_| travels).map(mm),
            speed_min_mm_s: self.speed.map(|[least, _]| mm(least)),
            speed_max_mm_s: self.speed.map(|[_, greatest]| mm(greatest)),
            speed_error_max: self.speed.filter(|_| path.is_some()).map(|_| self.speed_error),
            straightness_max_mm: self.off.filter(|_| !is_arc).map(|[distance, _]| mm(distance)),
            arc_deviation_max_mm: self.off.filter(|_| is_arc).map(|[distance, _]| mm(distance)),
            orientation_deviation_max_rad: self.off.map(|[_, angle]| angle),
            corner_error_mm: self.corner.as_ref().and_then(CornerWatch::distance).map(mm),
            corner_permitted_mm: permitted.map(mm),
        }
    }
}
