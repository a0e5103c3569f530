//! A run from start to end.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use rtrb::RingBuffer;
use seamline::control::ActsOn;
use seamline::seam::LaneKey;

use super::beat::{Beat, LoopFigures, Plant};
use super::check::{CheckReport, check};
use super::clock::MonotonicClock;
use super::error::RunError;
use super::inject::FaultScript;
use super::machine::{Devices, Machine};
use super::passes;
use super::program::Program;
use super::realtime;
use super::supervisor::Supervisor;
use super::walk::Walk;
use crate::cell::{Cell, Vibration};
use crate::plan::{Arm, PlanningArm};
use crate::record::{Acceptance, Findings, JointInfo, Outcome, Recorder, RunInfo, SampleSender, Summary};
use crate::sensor::CellSensor;
use crate::sim::{SimulatedArc, SimulatedDrive};

/// Commands between planner and cycle.
const QUEUE: usize = 64;
/// Time that the drives get to settle after the last command, in seconds.
const SETTLE: f64 = 0.1;

/// How a job is run.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// Folder for `recording.csv`; made where it is missing.
    pub out: PathBuf,
    /// Speed override, above 0 to 1.
    pub speed_override: f64,
    /// Once per period of the clock on the wall, instead of as fast as the machine can.
    pub realtime: bool,
}

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Seconds of robot time so far.
    pub time: f64,
    /// Seconds it will take at this override, as planned.
    pub planned: f64,
    /// Line of the job.
    pub line: u32,
}

/// What a run left behind.
#[derive(Debug)]
pub struct RunReport {
    /// Job, robot and limits.
    pub info: RunInfo,
    /// Figures, segments and data for plots.
    pub findings: Findings,
    /// The figures against their bounds.
    pub summary: Summary,
    /// What the operator should know about the run itself, such as a missing permission for real time.
    pub remarks: Vec<String>,
}

/// Checks a job and runs it in the simulated cell; writes `recording.csv`.
///
/// # Errors
/// [`RunError::Check`] where the check finds that the job cannot run (then nothing is written); the file system's own.
/// A fault in motion is no error: it stands in the report.
pub fn run<const N: usize, K: PlanningArm<N> + Send>(
    program: &Program,
    cell: &Cell,
    arm: &Arm<N, K>,
    options: &RunOptions,
    mut progress: impl FnMut(Progress),
) -> Result<RunReport, RunError> {
    let CheckReport { errors, duration, reads_inputs, .. } = check(program, cell, arm)?;
    if !errors.is_empty() {
        return Err(RunError::Check(errors));
    }
    let path = options.out.join("recording.csv");
    let file = |source| RunError::File { path: path.display().to_string(), source };
    let drive = SimulatedDrive::from_cell(cell)?;
    let seam = CellSensor::from_cell(cell)?;
    let info = run_info(program, cell, arm);
    fs::create_dir_all(&options.out).map_err(file)?;
    let (samples, recorder) = Recorder::start(&path, &info).map_err(file)?;
    let (producer, consumer) = RingBuffer::new(QUEUE);
    let devices = Devices { drive, arc: SimulatedArc::from_cell(cell), seam };
    let mut machine = Machine::new(cell, arm, devices, MonotonicClock::default(), consumer)?;
    machine.set_override(options.speed_override);
    let records = passes::load(cell)?;
    for (file, lanes) in &records {
        for (weld, lane) in (0..).zip(lanes) {
            // The planner refuses what needs more than the memory holds.
            let _ = machine.memory_mut().insert(LaneKey { file: *file, weld }, &lane.record());
        }
    }
    let walk = Walk::new(program, cell, arm)?;
    let mut supervisor = Supervisor::new(walk, producer, reads_inputs, recorder, info.joints.clone());
    let started = Instant::now();
    let planned = duration / options.speed_override;
    let mut watch = |beat: &Beat| progress(Progress { time: beat.time, planned, line: beat.line });
    let settle = (SETTLE / cell.cycle.period).ceil() as u64;
    let plant = Plant { machine, script: FaultScript::new(&cell.simulation.faults) };
    let (samples, figures) = if options.realtime {
        realtime::run(plant, samples, &mut supervisor, settle, &mut watch)
    } else {
        logical(plant, samples, &mut supervisor, settle, &mut watch)
    };
    let wall_time = Some(started.elapsed().as_secs_f64());
    let samples_lost = samples.lost();
    let LoopFigures { stage_times, lateness, overruns, remarks, memory } = figures;
    let findings = supervisor.finish(samples).map_err(file)?;
    passes::save(cell, &records, &passes::records(cell, &memory))?;
    let outcome = Outcome { stage_times, lateness, overruns, samples_lost, wall_time };
    let summary = Summary::new(&info, &findings, outcome);
    Ok(RunReport { info, findings, summary, remarks })
}

/// Cycle after cycle, as fast as the machine can: the clock is the count of cycles.
fn logical<const N: usize, K: PlanningArm<N>>(
    mut plant: Plant<N, K>,
    mut samples: SampleSender,
    supervisor: &mut Supervisor<'_, N, K>,
    settle: u64,
    watch: &mut impl FnMut(&Beat),
) -> (SampleSender, LoopFigures) {
    let mut cycle = 0;
    let mut left = settle;
    supervisor.feed(0.0);
    while left > 0 {
        let (beat, sample) = plant.cycle(cycle);
        supervisor.observe(&beat);
        samples.push_waiting(sample);
        watch(&beat);
        cycle += 1;
        left -= u64::from(cycle > 2 && beat.ends_run());
    }
    let (stage_times, remarks) = (plant.machine.stage_times(), plant.machine.seam_remarks());
    let memory = Box::new(plant.machine.memory().clone());
    (samples, LoopFigures { stage_times, remarks, memory, ..LoopFigures::default() })
}

/// The figures may be off by what the cell lets a prefilter on the joints do.
fn acceptance(cell: &Cell) -> Acceptance {
    let mut acceptance = Acceptance::default();
    if !cell.vibration.kernels().is_empty() && cell.vibration.acts_on() == ActsOn::Joints {
        acceptance.path_deviation = acceptance.path_deviation.max(cell.vibration.path_error());
        acceptance.orientation_deviation = Vibration::TURN_ERROR;
    }
    acceptance
}

fn run_info<const N: usize, K>(program: &Program, cell: &Cell, arm: &Arm<N, K>) -> RunInfo {
    let joints = (0..N).map(|joint| JointInfo {
        name: arm.joint_names[joint].clone(),
        kind: arm.joint_kinds[joint],
        position: [arm.limits.position[joint].0, arm.limits.position[joint].1],
        velocity: arm.limits.velocity[joint],
        acceleration: arm.limits.acceleration[joint],
        jerk: arm.limits.jerk[joint],
    });
    RunInfo {
        job: program.name().to_owned(),
        robot: arm.name.clone(),
        joints: joints.collect(),
        period: cell.cycle.period,
        acceptance: acceptance(cell),
    }
}
