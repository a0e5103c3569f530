//! What the report's plots need, in bounded memory however long the run.

use std::collections::VecDeque;

use seamline::control::Mode;
use seamline::geometry::Vector3;

use super::envelope::{Envelope, Trace};
use super::info::{Event, EventKind, SegmentInfo, SegmentKind};
use super::sample::{MAX_JOINTS, Sample};

/// Curves of one joint over time, SI.
#[derive(Debug, Clone, Default)]
pub struct JointTraces {
    /// Commanded position.
    pub position: Trace,
    /// Velocity of the command, by differences.
    pub velocity: Trace,
    /// Acceleration of the command, by differences.
    pub acceleration: Trace,
    /// Jerk of the command, by differences.
    pub jerk: Trace,
    /// Command less measurement.
    pub following_error: Trace,
}

/// A point of the tool path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Time in seconds.
    pub time: f64,
    /// Commanded tool centre point in the robot frame, in metres.
    pub position: Vector3,
    /// The arc is lit from here on.
    pub arc: bool,
}

/// Data of the report's plots. Each trace has at most [`TRACE_POINTS`](super::TRACE_POINTS) points and keeps every
/// peak.
#[derive(Debug, Clone, Default)]
pub struct PlotData {
    /// One entry a joint.
    pub joints: Vec<JointTraces>,
    /// Speed of the tool centre point by differences, in m/s.
    pub tcp_speed: Trace,
    /// Distance from the programmed line or arc, in metres, while there is one.
    pub path_deviation: Trace,
    /// Rate of programme time.
    pub override_rate: Trace,
    /// Seam correction across the seam, in metres.
    pub seam_lateral: Trace,
    /// Seam correction in height, in metres.
    pub seam_height: Trace,
    /// Distance from the true seam, in metres.
    pub seam_error: Trace,
    /// The commanded path of the tool centre point.
    pub tool_path: Vec<PathPoint>,
    /// Every change of mode, with its time.
    pub modes: Vec<(f64, Mode)>,
    /// What happened, in order, with the tool centre point's position where known.
    pub events: Vec<(Event, Option<Vector3>)>,
}

/// Collects plot data sample by sample.
#[derive(Debug, Clone)]
pub(super) struct PlotCollector {
    joints: Vec<[Envelope; 5]>,
    tcp_speed: Envelope,
    path_deviation: Envelope,
    override_rate: Envelope,
    seam: [Envelope; 3],
    tool_path: ToolPath,
    modes: Vec<(f64, Mode)>,
    arc: bool,
    /// The dwell under way, with its segment.
    dwell: Option<(u32, (Event, Option<Vector3>))>,
    /// Events announced, whose sample is not here yet.
    ahead: VecDeque<Event>,
    events: Vec<(Event, Option<Vector3>)>,
}

/// What the collector is told beside the sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Derived<'a> {
    /// Velocity, acceleration and jerk of each joint, as far as known, each with the time at which it holds.
    pub(super) derivatives: &'a [(f64, [f64; MAX_JOINTS])],
    /// Time at which the speed holds, and the speed of the tool centre point in m/s; NaN where unknown.
    pub(super) speed: (f64, f64),
    /// Distance from the programmed path in metres; NaN where there is none.
    pub(super) deviation: f64,
    /// The segment that has just been entered.
    pub(super) entered: Option<&'a SegmentInfo>,
}

impl PlotCollector {
    pub(super) fn new(joints: usize) -> Self {
        let envelope = Envelope::new;
        Self {
            joints: (0..joints.min(MAX_JOINTS)).map(|_| std::array::from_fn(|_| envelope())).collect(),
            tcp_speed: envelope(),
            path_deviation: envelope(),
            override_rate: envelope(),
            seam: [envelope(), envelope(), envelope()],
            tool_path: ToolPath::new(),
            modes: Vec::new(),
            arc: false,
            dwell: None,
            ahead: VecDeque::new(),
            events: Vec::new(),
        }
    }

    /// Announces an event, at the latest before the first sample after its time.
    pub(super) fn announce(&mut self, event: Event) {
        self.ahead.push_back(event);
    }

    pub(super) fn push(&mut self, sample: &Sample, derived: &Derived<'_>) {
        let time = sample.time;
        for (joint, [position, derivatives @ .., following]) in self.joints.iter_mut().enumerate() {
            position.push(time, sample.command[joint]);
            for (envelope, (time, values)) in derivatives.iter_mut().zip(derived.derivatives) {
                envelope.push(*time, values[joint]);
            }
            following.push(time, sample.command[joint] - sample.measured[joint]);
        }
        self.tcp_speed.push(derived.speed.0, derived.speed.1);
        self.path_deviation.push(time, derived.deviation);
        self.override_rate.push(time, sample.override_rate);
        for (envelope, value) in
            self.seam.iter_mut().zip([sample.seam_lateral, sample.seam_height, sample.seam_error])
        {
            envelope.push(time, value);
        }
        let position = sample.tcp.translation.vector;
        self.tool_path.push(PathPoint { time, position, arc: sample.arc });
        if self.modes.last().is_none_or(|(_, mode)| *mode != sample.mode) {
            self.modes.push((time, sample.mode));
        }
        self.push_events(sample, position, derived.entered);
    }

    fn push_events(&mut self, sample: &Sample, position: Vector3, entered: Option<&SegmentInfo>) {
        let event = |kind| {
            (Event { time: sample.time, line: sample.line, kind, text: String::new() }, Some(position))
        };
        if sample.arc != self.arc {
            self.arc = sample.arc;
            self.events.push(event(if sample.arc { EventKind::ArcOn } else { EventKind::ArcOff }));
        }
        // A dwell becomes an event when it is over, for only then is it known how long it was.
        if self.dwell.as_ref().is_some_and(|(segment, _)| *segment != sample.segment) {
            self.end_dwell(sample.time);
        }
        if entered.is_some_and(|entered| matches!(entered.kind, SegmentKind::Dwell)) {
            self.dwell = Some((sample.segment, event(EventKind::Dwell)));
        }
        let due = self.ahead.iter().take_while(|event| event.time <= sample.time).count();
        self.events.extend(self.ahead.drain(..due).map(|event| (event, Some(position))));
    }

    fn end_dwell(&mut self, time: f64) {
        if let Some((_, (mut dwell, position))) = self.dwell.take() {
            dwell.text = format!("{:.2} s", time - dwell.time);
            self.events.push((dwell, position));
        }
    }

    pub(super) fn finish(mut self) -> PlotData {
        self.end_dwell(self.tool_path.last.map_or(0.0, |point| point.time));
        let last = self.tool_path.last.map(|point| point.position);
        self.events.extend(self.ahead.into_iter().map(|event| (event, last)));
        self.events.sort_by(|a, b| a.0.time.total_cmp(&b.0.time));
        let traces = |[position, velocity, acceleration, jerk, following]: [Envelope; 5]| JointTraces {
            position: position.into_trace(),
            velocity: velocity.into_trace(),
            acceleration: acceleration.into_trace(),
            jerk: jerk.into_trace(),
            following_error: following.into_trace(),
        };
        let [seam_lateral, seam_height, seam_error] = self.seam.map(Envelope::into_trace);
        PlotData {
            joints: self.joints.into_iter().map(traces).collect(),
            tcp_speed: self.tcp_speed.into_trace(),
            path_deviation: self.path_deviation.into_trace(),
            override_rate: self.override_rate.into_trace(),
            seam_lateral,
            seam_height,
            seam_error,
            tool_path: self.tool_path.finish(),
            modes: self.modes,
            events: self.events,
        }
    }
}

/// The path of the tool centre point, thinned by distance.
#[derive(Debug, Clone)]
struct ToolPath {
    points: Vec<PathPoint>,
    /// Least distance of neighbours, in metres.
    spacing: f64,
    last: Option<PathPoint>,
}

impl ToolPath {
    const POINTS: usize = 4000;
    const SPACING: f64 = 1e-4;

    fn new() -> Self {
        Self { points: Vec::with_capacity(Self::POINTS), spacing: Self::SPACING, last: None }
    }

    fn push(&mut self, point: PathPoint) {
        self.last = Some(point);
        if !Self::worth(self.points.last(), &point, self.spacing) {
            return;
        }
        // Where thinning frees nothing the arc switches at every point: rather more points than a wrong picture.
        if self.points.len() >= Self::POINTS {
            self.spacing *= 2.0;
            let mut kept: Option<PathPoint> = None;
            let spacing = self.spacing;
            self.points.retain(|point| {
                let worth = Self::worth(kept.as_ref(), point, spacing);
                if worth {
                    kept = Some(*point);
                }
                worth
            });
        }
        self.points.push(point);
    }

    /// A point is kept where it lies far enough from the one before, or the arc has switched.
    fn worth(before: Option<&PathPoint>, point: &PathPoint, spacing: f64) -> bool {
        before.is_none_or(|before| {
            before.arc != point.arc || (point.position - before.position).norm() >= spacing
        })
    }

    fn finish(mut self) -> Vec<PathPoint> {
        if let Some(last) = self.last.filter(|last| self.points.last().is_some_and(|kept| kept != last)) {
            self.points.push(last);
        }
        self.points
    }
}
