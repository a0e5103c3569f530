//! The report of a made-up run, held against what a report must be.
//!
//! Set `SEAMLINE_REPORT_DIR` to a folder to keep the pages and look at them.

use std::f64::consts::PI;
use std::path::PathBuf;

use seamline::control::Mode;
use seamline::geometry::{EulerZyx, Pose};
use seamline::kinematics::JointKind;
use seamline::path::Path as ToolPath;
use seamline_cell::record::{
    Acceptance, Analysis, Event, EventKind, Findings, JointInfo, MAX_JOINTS, Outcome, Sample, SegmentKind,
    TRACE_POINTS, TimeHistogram,
};

use super::*;

const PERIOD: f64 = 1e-3;
/// Time to reach the speed of a move.
const RAMP: f64 = 0.25;

fn robot() -> RunInfo {
    let joint = |(name, range): (&str, [f64; 2])| JointInfo {
        name: name.to_owned(),
        kind: JointKind::Revolute,
        position: range,
        velocity: 3.6,
        acceleration: 20.0,
        jerk: 300.0,
    };
    let joints = [
        ("S", [-3.1, 3.1]),
        ("L", [-1.8, 2.7]),
        ("U", [-1.5, 2.8]),
        ("R", [-3.4, 2.6]),
        ("B", [-2.3, 1.6]),
        ("T", [-3.6, 3.6]),
    ];
    RunInfo {
        job: "FILLET <T-joint> & boss".to_owned(),
        robot: "made-up".to_owned(),
        joints: joints.into_iter().map(joint).collect(),
        period: PERIOD,
        acceptance: Acceptance::default(),
    }
}

/// A smooth one-to-one map between poses and six numbers, in place of kinematics.
fn joints_of(pose: &Pose) -> [f64; MAX_JOINTS] {
    let at = pose.translation.vector;
    let angles = EulerZyx::from_rotation(&pose.rotation);
    [at.y.atan2(at.x), 2.0 * (at.x.hypot(at.y) - 1.0), 2.0 * at.z, angles.z, angles.y, angles.x, 0.0]
}

fn pose_of(joints: &[f64; MAX_JOINTS]) -> Pose {
    let radius = 1.0 + 0.5 * joints[1];
    let at = [radius * joints[0].cos(), radius * joints[0].sin(), 0.5 * joints[2]];
    let rotation = EulerZyx { z: joints[3], y: joints[4], x: joints[5] }.to_rotation();
    Pose::from_parts(at.into(), rotation)
}

/// Distance after `time` on the way to `distance` at `speed`, with sinusoidal acceleration and deceleration.
fn travelled(time: f64, distance: f64, speed: f64) -> f64 {
    let ramp = |time: f64| 0.5 * speed * (time - RAMP / PI * (PI * time / RAMP).sin());
    let whole = distance / speed + RAMP;
    match time {
        t if t < RAMP => ramp(t),
        t if t < whole - RAMP => speed * (t - 0.5 * RAMP),
        t if t < whole => distance - ramp(whole - t),
        _ => distance,
    }
}

/// One move of the made-up job and how long it takes.
struct Move {
    info: SegmentInfo,
    from: Pose,
    to: Pose,
    speed: f64,
    duration: f64,
}

impl Move {
    fn pose(&self, time: f64) -> Pose {
        match &self.info.kind {
            SegmentKind::Path(path) | SegmentKind::Corner { path: Some(path), .. } => {
                path.pose(travelled(time, path.length(), self.speed))
            }
            SegmentKind::Joint => {
                let (from, to) = (joints_of(&self.from), joints_of(&self.to));
                let share = travelled(time, 1.0, self.speed);
                pose_of(&std::array::from_fn(|joint| from[joint] + share * (to[joint] - from[joint])))
            }
            SegmentKind::Corner { path: None, .. } | SegmentKind::Dwell => self.to,
        }
    }
}

/// A weld along one side of a joint, around a boss, and along the other side.
fn job() -> Vec<Move> {
    let pose = |x: f64, y: f64, z: f64, roll: f64, pitch: f64| {
        let angles = EulerZyx { x: roll, y: pitch, z: 0.3 };
        Pose::from_parts([x, y, z].into(), angles.to_rotation())
    };
    let home = pose(1.0, -0.5, 0.45, 0.0, 0.0);
    let above = pose(1.05, -0.2, 0.12, 0.6, -0.2);
    let start = pose(1.05, -0.2, 0.0, 0.7, -0.2);
    let boss = pose(1.05, -0.04, 0.0, 0.7, 0.1);
    let side = pose(1.09, 0.0, 0.0, 0.75, 0.15);
    let past = pose(1.05, 0.04, 0.0, 0.8, 0.2);
    let end = pose(1.05, 0.2, 0.0, 0.7, 0.35);
    let clear = pose(1.0, 0.22, 0.15, 0.6, 0.3);
    let line = |from, to| SegmentKind::Path(ToolPath::line(&from, &to));
    let arc = SegmentKind::Path(ToolPath::arc(&boss, &side, &past).unwrap());
    let moves = [
        (9, SegmentKind::Joint, home, above, 1.0, false),
        (10, line(above, start), above, start, 0.1, false),
        (12, SegmentKind::Dwell, start, start, 0.4, true),
        (13, line(start, boss), start, boss, 0.010, true),
        (15, arc, boss, past, 0.008, true),
        (16, line(past, end), past, end, 0.010, true),
        (18, SegmentKind::Dwell, end, end, 0.6, true),
        (20, line(end, clear), end, clear, 0.2, false),
        (21, SegmentKind::Joint, clear, home, 1.2, false),
    ];
    let number =
        |(index, (line, kind, from, to, speed, arc)): (usize, (u32, SegmentKind, Pose, Pose, f64, bool))| {
            let length = match &kind {
                SegmentKind::Path(path) => path.length(),
                _ => 1.0,
            };
            let duration = if matches!(kind, SegmentKind::Dwell) { speed } else { length / speed + RAMP };
            let ramp = 0.5 * speed * RAMP;
            let tool_speed = matches!(kind, SegmentKind::Path(_)).then_some(speed);
            let constant_part = tool_speed.map(|_| [ramp, length - ramp]);
            let info = SegmentInfo {
                segment: index as u32 + 1,
                line,
                kind,
                speed: tool_speed,
                arc,
                constant_part,
                rounded: [0.0; 2],
                seam: seamline_cell::record::OnSeam::No,
            };
            Move { info, from, to, speed, duration }
        };
    moves.into_iter().enumerate().map(number).collect()
}

/// Rate of programme time: half speed for a while, then a pause.
fn rate(time: f64) -> f64 {
    let smooth = |from: f64, to: f64| {
        let x = ((time - from) / (to - from)).clamp(0.0, 1.0);
        x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    1.0 - 0.5 * (smooth(9.0, 9.3) - smooth(13.0, 13.3)) - (smooth(30.0, 30.3) - smooth(33.0, 33.3))
}

/// Runs the job, or only the part of it before a fault.
fn run(fault_at: f64) -> (RunInfo, Summary, Findings) {
    let (run, job) = (robot(), job());
    let mut analysis = Analysis::new(&run);
    for of in &job {
        analysis.segment(of.info);
    }
    let event = |time: f64, line, kind, text: &str| Event { time, line, kind, text: text.to_owned() };
    analysis.event(event(0.0, 13, EventKind::Notice, "no PL: the zone stops exactly"));
    if fault_at.is_finite() {
        analysis.event(event(
            fault_at,
            15,
            EventKind::Fault,
            "following error of joint B: 1.31°, limit 1.00°",
        ));
    }
    let (mut times, mut index, mut programme, mut measured) = (TimeHistogram::new(), 0, 0.0, None);
    for cycle in 0..200_000_u32 {
        let time = f64::from(cycle) * PERIOD;
        while index < job.len() && programme > job[index].duration {
            programme -= job[index].duration;
            index += 1;
        }
        if index == job.len() {
            break;
        }
        let of = &job[index];
        let faulty = time >= fault_at;
        let (now, mean) = if faulty { (0.0, 0.0) } else { (rate(time), rate(time + 0.5 * PERIOD)) };
        let tcp = of.pose(programme);
        let command = joints_of(&tcp);
        let lagging: &mut [f64; MAX_JOINTS] = measured.get_or_insert(command);
        for joint in 0..MAX_JOINTS {
            lagging[joint] += (command[joint] - lagging[joint]) * PERIOD / 0.02;
        }
        let mode = match now {
            _ if faulty => Mode::Fault,
            0.0 => Mode::Holding,
            _ => Mode::Running,
        };
        analysis.sample(&Sample {
            time,
            mode,
            line: of.info.line,
            segment: of.info.segment,
            override_rate: now,
            command,
            measured: *lagging,
            tcp,
            tcp_speed: 0.0,
            arc: of.info.arc && !faulty,
            seam_lateral: 1e-3 * (0.2 * time).sin(),
            seam_height: 4e-4 * (0.3 * time).cos(),
            seam_error: if of.info.arc { 2e-5 * (7.0 * time).sin() } else { f64::NAN },
        });
        times.record(3000 + u64::from(cycle.wrapping_mul(2_654_435_761) >> 20));
        if time > fault_at + 1.0 {
            break;
        }
        programme += mean * PERIOD;
    }
    let findings = analysis.finish();
    let stages = ["feedback", "motion", "kinematics", "safety", "cycle"];
    let outcome = Outcome {
        stage_times: stages.into_iter().map(|stage| times.figures(stage)).collect(),
        wall_time: Some(0.3),
        ..Outcome::default()
    };
    let summary = Summary::new(&run, &findings, outcome);
    (run, summary, findings)
}

fn written(name: &str, fault_at: f64) -> (String, Findings) {
    let keep = std::env::var_os("SEAMLINE_REPORT_DIR").map(PathBuf::from);
    let folder = keep.clone().unwrap_or_else(std::env::temp_dir);
    let path = folder.join(format!("{name}-{}.html", std::process::id()));
    let path = if keep.is_some() { folder.join(format!("{name}.html")) } else { path };
    let (run, summary, findings) = run(fault_at);
    write_report(&path, &run, &summary, &findings.segments, &findings.plot).unwrap();
    let page = std::fs::read_to_string(&path).unwrap();
    if keep.is_none() {
        std::fs::remove_file(&path).unwrap();
    }
    (page, findings)
}

/// The page asks for nothing beyond itself, is small, and holds what it must.
#[test]
fn the_page_stands_alone() {
    let (page, findings) = written("report", f64::INFINITY);
    for word in ["http:", "https:", "src=", "@import", "url(", "<link", "fetch(", "XMLHttpRequest"] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.len() < 4_000_000, "{}", page.len());
    assert!(page.contains("<h1>FILLET &lt;T-joint&gt; &amp; boss</h1>"));
    assert!(page.contains("class=\"verdict"));
    for id in ["scene", "speed", "deviation", "seam", "override", "joint-grid", "following", "moves", "times"]
    {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }
    assert_eq!(findings.segments.len(), 9);
    let traces = findings.plot.joints.iter().map(|joint| joint.jerk.len());
    assert!(traces.max().unwrap() <= TRACE_POINTS);
}

/// Script elements end where they should, and the data between them is JSON that keeps the peaks.
#[test]
fn the_data_is_json() {
    let (page, findings) = written("data", f64::INFINITY);
    assert_eq!(page.matches("</script>").count(), 2);
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    let (text, _) = rest.split_once("</script>").unwrap();
    let data: serde_json::Value = serde_json::from_str(text).unwrap();
    let jerk = data["joints"][3]["traces"][3]["points"].as_array().unwrap();
    let values = jerk.iter().skip(1).step_by(2).map(|value| value.as_f64().unwrap().abs());
    let limit = robot().joints[3].jerk.to_degrees();
    let expected = findings.joints[3].jerk.fraction * limit;
    assert!((values.fold(0.0, f64::max) / expected - 1.0).abs() < 1e-4);
    assert_eq!(data["programmed"].as_array().unwrap().len(), 5);
    assert_eq!(data["programmed"][2]["position"].as_array().unwrap().len(), 3 * 65);
}

/// A run that never began has a page, too, whatever the texts in it.
#[test]
fn an_empty_run_has_a_page() {
    let run = robot();
    let mut analysis = Analysis::new(&run);
    let text = "</script><b>no drive".to_owned();
    analysis.event(Event { time: 0.0, line: 0, kind: EventKind::Fault, text });
    let findings = analysis.finish();
    let summary = Summary::new(&run, &findings, Outcome::default());
    let page = page(&run, &summary, &findings.segments, &findings.plot).unwrap();
    assert!(page.contains("id=\"scene\"") && !page.contains("id=\"times\""));
    assert!(page.matches("</script>").count() == 2 && !page.contains("<b>no drive"));
    if let Some(folder) = std::env::var_os("SEAMLINE_REPORT_DIR") {
        std::fs::write(PathBuf::from(folder).join("empty.html"), page).unwrap();
    }
}

/// A run that ends in a fault says so at the top.
#[test]
fn faults_are_shown() {
    let (page, findings) = written("fault", 38.0);
    assert!(page.contains("class=\"verdict over\">fault<"));
    assert!(page.contains("at 38.000 s, line 15: following error of joint B"));
    assert_eq!(findings.moves.last().map(|of| of.line), Some(15));
}
