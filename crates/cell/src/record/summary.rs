//! `summary.json`: a run in figures.

use std::io;
use std::path::Path;

use serde::Serialize;

use super::atomic::write_whole;
use super::figures::{Findings, JointFigures, MoveFigures, Peak, SeamFigures};
use super::info::{Acceptance, Event, EventKind, RunInfo};
use super::times::TimeFigures;

/// Finite differences of rounded numbers exceed a limit that is met exactly by this much at most.
const ROUNDING: f64 = 1e-6;

/// What the run's loop knows beside the samples.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// Computing time of each stage and of the whole cycle.
    pub stage_times: Vec<TimeFigures>,
    /// How late cycles began, in real time.
    pub lateness: Option<TimeFigures>,
    /// Cycles that were late by a period or more, in real time.
    pub overruns: u64,
    /// Samples that did not reach the recording.
    pub samples_lost: u64,
    /// How long the run took on the clock on the wall, in seconds.
    pub wall_time: Option<f64>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every figure is within its bound.
    Ok,
    /// A figure is beyond its bound.
    OutOfBounds,
    /// A fault ended the run.
    Fault,
}

/// A figure beside its bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What was looked at.
    pub name: &'static str,
    /// The worst value found.
    pub value: f64,
    /// What it may be at most.
    pub bound: f64,
    /// Unit of both.
    pub unit: &'static str,
    /// Where the worst was found.
    pub place: String,
    /// The value is within the bound.
    pub ok: bool,
}

/// A fault or a notice.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Incident {
    /// Time since the start of the run.
    pub time_s: f64,
    /// Line of the job file.
    pub line: u32,
    /// What happened.
    pub text: String,
}

/// The figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Name of the job.
    pub job: String,
    /// Name of the robot.
    pub robot: String,
    /// How the run ended.
    pub verdict: Verdict,
    /// Cycles recorded.
    pub cycles: u64,
    /// Cycle time.
    pub period_ms: f64,
    /// Time of the motion.
    pub duration_s: f64,
    /// Time on the clock on the wall.
    pub wall_time_s: Option<f64>,
    /// Time of the motion over time on the wall.
    pub real_time_factor: Option<f64>,
    /// The figures that have bounds.
    pub checks: Vec<Check>,
    /// Path and speed figures of each segment.
    pub moves: Vec<MoveFigures>,
    /// Greatest joint velocity of all joints, as a fraction of its limit.
    pub joint_velocity_max: f64,
    /// Greatest joint acceleration of all joints, as a fraction of its limit.
    pub joint_acceleration_max: f64,
    /// Greatest joint jerk of all joints, as a fraction of its limit.
    pub joint_jerk_max: f64,
    /// Each joint.
    pub joints: Vec<JointFigures>,
    /// Seam tracking, where there was any.
    pub seam: Option<SeamFigures>,
    /// Computing times of the cycle and its stages.
    pub stage_times_us: Vec<TimeFigures>,
    /// How late cycles began, in real time.
    pub lateness_us: Option<TimeFigures>,
    /// Cycles that were late by a period or more, in real time.
    pub overruns: u64,
    /// Samples that did not reach the recording.
    pub samples_lost: u64,
    /// What stopped the run.
    pub faults: Vec<Incident>,
    /// What the user should know.
    pub notices: Vec<Incident>,
}

impl Summary {
    /// Puts a run's figures together.
    #[must_use]
    pub fn new(run: &RunInfo, findings: &Findings, outcome: Outcome) -> Self {
        let incidents = |kind| {
            let of_kind =
                findings.plot.events.iter().map(|(event, _)| event).filter(|event| event.kind == kind);
            of_kind.map(Incident::from).collect::<Vec<_>>()
        };
        let faults = incidents(EventKind::Fault);
        let checks = checks(run, findings, outcome.samples_lost);
        let verdict = if !faults.is_empty() {
            Verdict::Fault
        } else if checks.iter().all(|check| check.ok) {
            Verdict::Ok
        } else {
            Verdict::OutOfBounds
        };
        let greatest = |peak: fn(&JointFigures) -> Peak| {
            findings.joints.iter().map(|joint| peak(joint).fraction).fold(0.0, f64::max)
        };
        Self {
            job: run.job.clone(),
            robot: run.robot.clone(),
            verdict,
            cycles: findings.cycles,
            period_ms: run.period * 1e3,
            duration_s: findings.duration,
            wall_time_s: outcome.wall_time,
            real_time_factor: outcome
                .wall_time
                .filter(|wall| *wall > 0.0)
                .map(|wall| findings.duration / wall),
            checks,
            moves: findings.moves.clone(),
            joint_velocity_max: greatest(|joint| joint.velocity),
            joint_acceleration_max: greatest(|joint| joint.acceleration),
            joint_jerk_max: greatest(|joint| joint.jerk),
            joints: findings.joints.clone(),
            seam: findings.seam,
            stage_times_us: outcome.stage_times,
            lateness_us: outcome.lateness,
            overruns: outcome.overruns,
            samples_lost: outcome.samples_lost,
            faults,
            notices: incidents(EventKind::Notice),
        }
    }

    /// The text of `summary.json`.
    ///
    /// # Errors
    /// None that occurs: the data is plain.
    pub fn to_json(&self) -> io::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Writes `summary.json`, whole or not at all.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        write_whole(path, self.to_json()?.as_bytes())
    }
}

impl From<&Event> for Incident {
    fn from(event: &Event) -> Self {
        Self { time_s: event.time, line: event.line, text: event.text.clone() }
    }
}

/// The worst of something over the run, and where it was.
type Worst = Option<(f64, String)>;

fn checks(run: &RunInfo, findings: &Findings, samples_lost: u64) -> Vec<Check> {
    let Acceptance {
        path_deviation,
        orientation_deviation,
        corner_error,
        weld_speed_error,
        joint,
        joint_jerk,
    } = run.acceptance;
    let moves = |value: fn(&MoveFigures) -> Option<f64>| {
        worst(
            findings
                .moves
                .iter()
                .filter_map(|of| Some((value(of)?, format!("{} in line {}", of.kind, of.line)))),
        )
    };
    let joints = |peak: fn(&JointFigures) -> Peak| {
        worst(findings.joints.iter().map(|of| {
            let Peak { fraction, time_s, line } = peak(of);
            (fraction, format!("joint {} at {time_s:.3} s, line {line}", of.name))
        }))
    };
    let position = worst(findings.joints.iter().map(|of| (of.position, format!("joint {}", of.name))));
    // Maxima pass over what is no number, so that it is counted by itself.
    let not_finite = (findings.not_finite > 0).then(|| (findings.not_finite as f64, String::new()));
    let lost = Some((samples_lost as f64, String::new()));
    let rows = [
        ("path deviation", "µm", 1e6, path_deviation, moves(|of| Some(of.path_deviation_max_mm()? * 1e-3))),
        (
            "orientation deviation",
            "µrad",
            1e6,
            orientation_deviation,
            moves(|of| of.orientation_deviation_max_rad),
        ),
        (
            "corner error",
            "% of permitted",
            1e2,
            corner_error,
            moves(|of| Some(of.corner_error_mm? / of.corner_permitted_mm?)),
        ),
        ("weld speed error", "%", 1e2, weld_speed_error, moves(|of| of.speed_error_max.filter(|_| of.arc))),
        ("joint position", "% of range", 1e2, 1.0, position),
        ("joint velocity", "% of limit", 1e2, joint, joints(|of| of.velocity)),
        ("joint acceleration", "% of limit", 1e2, joint, joints(|of| of.acceleration)),
        ("joint jerk", "% of limit", 1e2, joint_jerk, joints(|of| of.jerk)),
        ("samples not finite", "", 1.0, 0.0, not_finite),
        ("samples lost", "", 1.0, 0.0, lost),
    ];
    let check = |(name, unit, scale, bound, worst): (&'static str, &'static str, f64, f64, Worst)| {
        let (value, place) = worst?;
        let ok = value <= bound * (1.0 + ROUNDING);
        Some(Check { name, value: value * scale, bound: bound * scale, unit, place, ok })
    };
    rows.into_iter().filter_map(check).collect()
}

fn worst(values: impl Iterator<Item = (f64, String)>) -> Worst {
    values.reduce(|worst, value| if value.0 > worst.0 { value } else { worst })
}
