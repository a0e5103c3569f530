//! The data that the page's script draws: numbers as short as the plots allow, in the units of the axes.

use seamline::geometry::Vector3;
use seamline::path::Curve;
use seamline_cell::record::{JointInfo, JointTraces, PlotData, RunInfo, SegmentInfo, Summary};
use seamline_cell::robot::JointUnit;
use serde::Serialize;

/// Points in which an arc is drawn.
const ARC_POINTS: usize = 64;

/// A trace as the script takes it: time, value, time, value, …
type Flat = Vec<f64>;

#[derive(Debug, Serialize)]
pub(super) struct Data {
    duration: f64,
    period: f64,
    joints: Vec<Joint>,
    speed: Flat,
    /// From, to, speed in mm/s.
    programmed_speed: Vec<[f64; 3]>,
    deviation: Flat,
    deviation_bound: f64,
    r#override: Flat,
    modes: Vec<(f64, &'static str)>,
    seam: Option<Seam>,
    tool_path: ToolPath,
    programmed: Vec<Programmed>,
    events: Vec<Event>,
}

#[derive(Debug, Serialize)]
struct Joint {
    name: String,
    /// `°` or `mm`.
    unit: &'static str,
    /// Position, velocity, acceleration, jerk.
    traces: [Trace; 4],
    following: Flat,
}

#[derive(Debug, Serialize)]
struct Trace {
    limits: [f64; 2],
    /// Greatest share of the limit that is used.
    used: f64,
    points: Flat,
}

#[derive(Debug, Serialize)]
struct Seam {
    lateral: Flat,
    height: Flat,
    error: Flat,
}

#[derive(Debug, Serialize)]
struct ToolPath {
    time: Vec<f64>,
    /// x, y, z, x, y, z, …
    position: Vec<f64>,
    arc: Vec<u8>,
}

#[derive(Debug, Serialize)]
struct Programmed {
    line: u32,
    position: Vec<f64>,
}

#[derive(Debug, Serialize)]
struct Event {
    time: f64,
    line: u32,
    kind: &'static str,
    text: String,
    position: Option<[f64; 3]>,
}

impl Data {
    pub(super) fn new(run: &RunInfo, summary: &Summary, segments: &[SegmentInfo], plot: &PlotData) -> Self {
        let mm = |trace: &_| flat(trace, 1e3);
        let joints = run.joints.iter().zip(&plot.joints).enumerate();
        let programmed_speed = summary
            .moves
            .iter()
            .filter_map(|of| Some([time(of.start_s), time(of.end_s), short(of.speed_programmed_mm_s?)]));
        Self {
            duration: time(summary.duration_s),
            period: run.period,
            joints: joints.map(|(index, (info, traces))| joint(summary, index, info, traces)).collect(),
            speed: mm(&plot.tcp_speed),
            programmed_speed: programmed_speed.collect(),
            deviation: flat(&plot.path_deviation, 1e6),
            deviation_bound: short(run.acceptance.path_deviation * 1e6),
            r#override: flat(&plot.override_rate, 1e2),
            modes: plot.modes.iter().map(|(at, mode)| (time(*at), mode.name())).collect(),
            seam: summary.seam.map(|_| Seam {
                lateral: mm(&plot.seam_lateral),
                height: mm(&plot.seam_height),
                error: mm(&plot.seam_error),
            }),
            tool_path: ToolPath {
                time: plot.tool_path.iter().map(|point| time(point.time)).collect(),
                position: plot.tool_path.iter().flat_map(|point| position(&point.position)).collect(),
                arc: plot.tool_path.iter().map(|point| u8::from(point.arc)).collect(),
            },
            programmed: segments.iter().filter_map(programmed).collect(),
            events: plot.events.iter().map(event).collect(),
        }
    }
}

fn joint(summary: &Summary, index: usize, info: &JointInfo, traces: &JointTraces) -> Joint {
    let JointUnit { name, per_si } = JointUnit::of(info.kind);
    let trace = |points: &_, [low, high]: [f64; 2], used: f64| Trace {
        limits: [short(low * per_si), short(high * per_si)],
        used: short(used),
        points: flat(points, per_si),
    };
    let symmetric = |limit: f64| [-limit, limit];
    let used = summary.joints.get(index).map_or([0.0; 4], |figures| {
        [figures.position, figures.velocity.fraction, figures.acceleration.fraction, figures.jerk.fraction]
    });
    Joint {
        name: info.name.clone(),
        unit: if name == "deg" { "°" } else { name },
        traces: [
            trace(&traces.position, info.position, used[0]),
            trace(&traces.velocity, symmetric(info.velocity), used[1]),
            trace(&traces.acceleration, symmetric(info.acceleration), used[2]),
            trace(&traces.jerk, symmetric(info.jerk), used[3]),
        ],
        following: flat(&traces.following_error, per_si),
    }
}

fn programmed(segment: &SegmentInfo) -> Option<Programmed> {
    let path = segment.kind.path()?;
    let steps = match path.curve() {
        Curve::Line { .. } => 1,
        Curve::Arc(_) | Curve::Quintic(_) => ARC_POINTS,
    };
    let at = |step: usize| {
        let pose = path.pose(path.length() * step as f64 / steps as f64);
        position(&pose.translation.vector)
    };
    Some(Programmed { line: segment.line, position: (0..=steps).flat_map(at).collect() })
}

fn event((event, place): &(seamline_cell::record::Event, Option<Vector3>)) -> Event {
    Event {
        time: time(event.time),
        line: event.line,
        kind: event.kind.name(),
        text: event.text.clone(),
        position: place.as_ref().map(position),
    }
}

fn flat(trace: &seamline_cell::record::Trace, scale: f64) -> Flat {
    trace.iter().flat_map(|(at, value)| [time(*at), short(value * scale)]).collect()
}

/// Millimetres, to a tenth of a micrometre.
fn position(position: &Vector3) -> [f64; 3] {
    [position.x, position.y, position.z].map(|metres| (metres * 1e7).round() / 1e4)
}

/// Seconds, to 10 µs.
fn time(seconds: f64) -> f64 {
    (seconds * 1e5).round() / 1e5
}

/// Five significant digits: finer than any pixel.
fn short(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
