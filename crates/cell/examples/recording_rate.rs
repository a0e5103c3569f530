//! How many cycles a second the recorder takes, in which every number of every row differs from the row before:
//! `cargo run --release -p seamline-cell --example recording_rate`.
#![expect(clippy::print_stdout, reason = "the program's whole purpose")]

use std::time::Instant;

use seamline::control::Mode;
use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::JointKind;
use seamline::path::Path;
use seamline_cell::record::{
    Acceptance, JointInfo, OnSeam, Recorder, RunInfo, Sample, SegmentInfo, SegmentKind,
};

const ROWS: u32 = 2_000_000;

fn main() -> std::io::Result<()> {
    let joint = |index: usize| JointInfo {
        name: format!("J{}", index + 1),
        kind: JointKind::Revolute,
        position: [-3.0, 3.0],
        velocity: 4.0,
        acceleration: 20.0,
        jerk: 1000.0,
    };
    let run = RunInfo {
        job: "rate".to_owned(),
        robot: "bench".to_owned(),
        joints: (0..6).map(joint).collect(),
        period: 1e-3,
        acceptance: Acceptance::default(),
    };
    let path = Path::line(&Pose::identity(), &Pose::new(Vector3::x(), Vector3::new(0.1, 0.2, 0.3)));
    let file = std::env::temp_dir().join(format!("seamline-recording-rate-{}.csv", std::process::id()));
    let start = Instant::now();
    let (mut sender, recorder) = Recorder::start(&file, &run)?;
    let kind = SegmentKind::Path(path);
    recorder.segment(SegmentInfo {
        seam: OnSeam::No,
        segment: 1,
        line: 1,
        kind,
        speed: None,
        arc: true,
        constant_part: None,
        rounded: [0.0; 2],
    });
    for cycle in 0..ROWS {
        let s = f64::from(cycle) / f64::from(ROWS);
        let mut sample = Sample::at_rest();
        (sample.time, sample.mode) = (f64::from(cycle) * run.period, Mode::Running);
        (sample.segment, sample.arc, sample.tcp_speed) = (1, true, s);
        sample.tcp = path.pose(s);
        for joint in 0..6 {
            sample.command[joint] = (s + joint as f64).sin();
            sample.measured[joint] = (s + joint as f64 - 1e-6).sin();
        }
        sender.push_waiting(sample);
    }
    recorder.finish(sender)?;
    let rate = f64::from(ROWS) / start.elapsed().as_secs_f64();
    let bytes = std::fs::metadata(&file)?.len();
    std::fs::remove_file(&file)?;
    println!("{:.0} rows a second ({:.0} MB/s)", rate, rate * bytes as f64 / f64::from(ROWS) / 1e6);
    Ok(())
}
