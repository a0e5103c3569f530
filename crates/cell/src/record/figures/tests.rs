//! Figures of motions whose figures are known.

use std::f64::consts::{FRAC_PI_2, PI};

use seamline::control::Mode;
use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::path::Path;
use seamline::weave::{Pattern, Weave, WeaveShape};

use super::*;
use crate::record::testing::robot;
use crate::record::{EventKind, Outcome, SegmentKind, Summary, Verdict};

const PERIOD: f64 = 1e-3;

/// The timed third-order profile, in closed form: a rest-to-rest S-curve over `distance` in `duration`, with the
/// time-scale factor `n`.
#[derive(Clone, Copy)]
struct SCurve {
    distance: f64,
    duration: f64,
    n: f64,
}

impl SCurve {
    fn velocity(self) -> f64 {
        self.distance / (self.duration * (1.0 - self.n))
    }

    fn acceleration(self) -> f64 {
        self.velocity() / (self.duration * (self.n - self.n * self.n))
    }

    fn jerk(self) -> f64 {
        self.acceleration() / (self.duration * self.n * self.n)
    }

    /// Where it is at `time`: the sum of what each switch of the jerk adds.
    fn position(self, time: f64) -> f64 {
        let n = self.n;
        let switches = [
            (0.0, 1.0),
            (n * n, -1.0),
            (n - n * n, -1.0),
            (n, 1.0),
            (1.0 - n, -1.0),
            (1.0 - n + n * n, 1.0),
            (1.0 - n * n, 1.0),
        ];
        let cubic = |(at, step): (f64, f64)| step * (time - at * self.duration).max(0.0).powi(3) / 6.0;
        if time >= self.duration {
            self.distance
        } else {
            self.jerk() * switches.map(cubic).iter().sum::<f64>()
        }
    }
}

/// Runs `cycles` of a function of time through an analysis of a robot of two joints.
fn analyse(segments: &[SegmentInfo], cycles: u32, at: impl Fn(f64, &mut Sample)) -> Findings {
    let mut analysis = Analysis::new(&robot(2));
    for segment in segments {
        analysis.segment(*segment);
    }
    for cycle in 0..cycles {
        let mut sample = Sample::at_rest();
        sample.mode = Mode::Running;
        sample.time = f64::from(cycle) * PERIOD;
        at(sample.time, &mut sample);
        analysis.sample(&sample);
    }
    analysis.finish()
}

fn segment(path: Path, speed: f64, constant_part: Option<[f64; 2]>) -> SegmentInfo {
    SegmentInfo {
        segment: 1,
        line: 12,
        kind: SegmentKind::Path(path),
        speed: Some(speed),
        arc: true,
        constant_part,
        rounded: [0.0; 2],
        seam: crate::record::OnSeam::No,
    }
}

/// The S-curve's velocity, acceleration and jerk are found as fractions of the limits, for profiles whose switches fall
/// on cycles: exact but for rounding, of which third differences over 1 ms make 10⁹ times the rounding of a position,
/// some 1e-5 rad/s³ here.
#[test]
fn joint_maxima_of_an_s_curve() {
    for (duration, n) in [(0.9, 1.0 / 3.0), (1.6, 0.25), (0.4, 0.5)] {
        let first = SCurve { distance: 0.6, duration, n };
        let second = SCurve { distance: -1.5, duration, n };
        let findings = analyse(&[], 2000, |time, sample| {
            sample.line = 7;
            sample.command[0] = first.position(time);
            sample.command[1] = 1.0 + second.position(time);
            sample.measured[1] = sample.command[1] - 0.01;
        });
        for (joint, curve, info) in [
            (&findings.joints[0], first, &robot(2).joints[0]),
            (&findings.joints[1], second, &robot(2).joints[1]),
        ] {
            let close = |peak: Peak, value: f64, limit: f64| {
                let expected = value.abs() / limit;
                let tolerance = 1e-9 + 5e-5 / limit;
                assert!((peak.fraction - expected).abs() < tolerance, "{} for {expected}", peak.fraction);
                assert_eq!(peak.line, 7);
            };
            // A triangular profile has its velocity and acceleration only for an instant, which differences over a
            // cycle flatten by J h²/8 and J h/2 at most.
            if n < 0.5 {
                close(joint.velocity, curve.velocity(), info.velocity);
                close(joint.acceleration, curve.acceleration(), info.acceleration);
            }
            close(joint.jerk, curve.jerk(), info.jerk);
        }
        let [first, second] = &findings.joints[..] else { panic!() };
        let Travel::Turning { position_max_deg, .. } = first.travel else { panic!() };
        assert!((position_max_deg - 0.6f64.to_degrees()).abs() < 1e-9);
        let Travel::Turning { position_min_deg, following_error_max_deg, .. } = second.travel else {
            panic!()
        };
        assert!((position_min_deg + 0.5f64.to_degrees()).abs() < 1e-9);
        // Joint 2 may go from −2 to 4: 1 is the middle, −0.5 half of the way to the lower limit.
        assert!((second.position - 0.5).abs() < 1e-9);
        assert!((following_error_max_deg - 0.01f64.to_degrees()).abs() < 1e-9);
        // The plots keep the same peaks.
        let plotted = |trace: &[(f64, f64)]| trace.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
        let traces = &findings.plot.joints[1];
        let info = &robot(2).joints[1];
        assert_eq!(plotted(&traces.velocity) / info.velocity, second.velocity.fraction);
        assert_eq!(plotted(&traces.acceleration) / info.acceleration, second.acceleration.fraction);
        assert_eq!(plotted(&traces.jerk) / info.jerk, second.jerk.fraction);
    }
}

/// A gap in the samples is no jump of the joints.
#[test]
fn gaps_start_the_differences_anew() {
    let findings = analyse(&[], 1000, |time, sample| {
        if time > 0.5 {
            sample.time += 0.25;
            sample.command[0] = 0.4;
        }
    });
    assert_eq!(findings.joints[0].velocity.fraction, 0.0);
    assert!(findings.plot.tcp_speed.iter().all(|point| point.1 == 0.0));
}

/// A line along which the tool wavers by a known amplitude, tilts by a known angle, and runs at a known speed.
#[test]
fn line_figures() {
    let curve = SCurve { distance: 0.2, duration: 4.0, n: 0.25 };
    let end = Pose::new(Vector3::new(0.9, 0.2, 0.1), Vector3::new(0.0, 0.3, 0.0));
    let path = Path::line(&Pose::translation(0.7, 0.2, 0.1), &end);
    let constant = [curve.position(1.0), curve.position(3.0)];
    let info = segment(path, curve.velocity(), Some(constant));
    let (waver, tilt) = (3e-7, 2e-7);
    let findings = analyse(&[info], 4001, |time, sample| {
        let wave = (20.0 * time).sin();
        let pose = path.pose(curve.position(time));
        let position = pose.translation.vector + Vector3::new(0.0, waver * wave, 0.0);
        let rotation = Rotation::from_scaled_axis(Vector3::z() * (tilt * wave)) * pose.rotation;
        sample.tcp = Pose::from_parts(position.into(), rotation);
        sample.segment = 1;
        sample.arc = true;
    });
    let [line] = &findings.moves[..] else { panic!("one move") };
    assert_eq!((line.segment, line.line, line.kind, line.arc), (1, 12, "MOVL", true));
    assert_eq!((line.start_s, line.end_s), (0.0, 4.0));
    assert!((line.length_mm.unwrap() - 200.0).abs() < 1e-9);
    assert!((line.straightness_max_mm.unwrap() - waver * 1e3).abs() < 1e-4 * waver * 1e3);
    assert!((line.orientation_deviation_max_rad.unwrap() - tilt).abs() < 1e-3 * tilt);
    let programmed = curve.velocity() * 1e3;
    for speed in [line.speed_min_mm_s, line.speed_max_mm_s, line.speed_programmed_mm_s] {
        assert!((speed.unwrap() / programmed - 1.0).abs() < 1e-6);
    }
    assert!(line.speed_error_max.unwrap() < 1e-6);
    assert_eq!(line.arc_deviation_max_mm, None);
    let deviation = findings.plot.path_deviation.iter().map(|point| point.1).fold(0.0, f64::max);
    assert_eq!(deviation * 1e3, line.straightness_max_mm.unwrap());
}

/// The speed is held against programmed speed times override, and only in the constant part.
#[test]
fn speed_is_judged_in_the_constant_part_only() {
    let path = Path::line(&Pose::identity(), &Pose::translation(1.0, 0.0, 0.0));
    let info = segment(path, 0.1, Some([0.2, 0.8]));
    // Half speed, but 2 % too fast from 0.5 m on; far too fast at first.
    let findings = analyse(&[info], 20_000, |time, sample| {
        let x = match time {
            t if t < 0.5 => 0.2 * t,
            t if t < 8.5 => 0.1 + 0.05 * (t - 0.5),
            t => 0.5 + 0.051 * (t - 8.5),
        };
        sample.tcp = Pose::translation(x.min(1.0), 0.0, 0.0);
        sample.override_rate = 0.5;
        sample.segment = 1;
    });
    let line = &findings.moves[0];
    assert!((line.speed_min_mm_s.unwrap() - 50.0).abs() < 1e-6);
    assert!((line.speed_max_mm_s.unwrap() - 51.0).abs() < 1e-6);
    assert!((line.speed_error_max.unwrap() - 0.01).abs() < 1e-6);
}

/// An arc run 2 µm too wide, then a turn on the spot.
#[test]
fn arc_and_turn_figures() {
    let at = |angle: f64| Pose::translation(0.05 * angle.cos(), 0.05 * angle.sin(), 0.3);
    let arc = Path::arc(&at(0.0), &at(1.0), &at(FRAC_PI_2)).unwrap();
    let turned = Pose::from_parts(at(FRAC_PI_2).translation, Rotation::from_scaled_axis(Vector3::x() * 0.4));
    let turn = Path::line(&at(FRAC_PI_2), &turned);
    let first = segment(arc, 0.05 * FRAC_PI_2, Some([0.0, arc.length()]));
    let second =
        SegmentInfo { segment: 2, line: 13, arc: false, constant_part: None, ..segment(turn, 0.4, None) };
    let findings = analyse(&[first, second], 2001, |time, sample| {
        if time < 1.0 {
            sample.segment = 1;
            let pose = arc.pose(time * arc.length());
            let outward = Vector3::new(pose.translation.x, pose.translation.y, 0.0).normalize();
            sample.tcp = Pose::from_parts((pose.translation.vector + outward * 2e-6).into(), pose.rotation);
        } else {
            sample.segment = 2;
            sample.tcp = turn.pose((time - 1.0) * turn.length());
        }
    });
    let [arc, turn] = &findings.moves[..] else { panic!("two moves") };
    assert_eq!(arc.kind, "MOVC");
    assert!((arc.arc_deviation_max_mm.unwrap() - 2e-3).abs() < 1e-9);
    assert!(arc.orientation_deviation_max_rad.unwrap() < 1e-12);
    // The circle is 2 µm in 50 mm wider, and so much faster is the tool; the chord of one cycle's angle of 1.57 mrad is
    // shorter than the arc by its square over 24.
    assert!((arc.speed_error_max.unwrap() - (4e-5 - 1.03e-7)).abs() < 1e-9);
    assert_eq!((turn.kind, turn.length_mm, turn.speed_programmed_mm_s), ("MOVL", Some(0.0), None));
    assert!(turn.orientation_deviation_max_rad.unwrap() < 1e-12);
    assert!(turn.straightness_max_mm.unwrap() < 1e-12);
}

/// Arc, dwell and reported events come in order, with their places; a fault decides the verdict.
#[test]
fn events_and_verdict() {
    let dwell = SegmentInfo {
        segment: 4,
        line: 20,
        kind: SegmentKind::Dwell,
        speed: None,
        arc: true,
        constant_part: None,
        rounded: [0.0; 2],
        seam: crate::record::OnSeam::No,
    };
    let run = |fault: bool| {
        let mut analysis = Analysis::new(&robot(2));
        analysis.segment(dwell);
        let event = |time: f64, kind, text: &str| Event { time, line: 9, kind, text: text.to_owned() };
        analysis.event(event(0.2, EventKind::Notice, "stops exactly"));
        if fault {
            analysis.event(event(0.9, EventKind::Fault, "following error"));
        }
        for cycle in 0..1000 {
            let mut sample = Sample::at_rest();
            sample.time = f64::from(cycle) * PERIOD;
            sample.tcp = Pose::translation(sample.time, 0.0, 0.0);
            sample.arc = (300..700).contains(&cycle);
            sample.segment = if (400..600).contains(&cycle) { 4 } else { 0 };
            analysis.sample(&sample);
        }
        analysis.finish()
    };
    let findings = run(true);
    let events: Vec<_> = findings
        .plot
        .events
        .iter()
        .map(|(event, position)| (event.kind, event.text.as_str(), (position.unwrap().x * 1e3).round()))
        .collect();
    let expected = [
        (EventKind::Notice, "stops exactly", 200.0),
        (EventKind::ArcOn, "", 300.0),
        (EventKind::Dwell, "0.20 s", 400.0),
        (EventKind::ArcOff, "", 700.0),
        (EventKind::Fault, "following error", 900.0),
    ];
    assert_eq!(events, expected);
    let summary = |findings: &Findings| Summary::new(&robot(2), findings, Outcome::default());
    assert_eq!(summary(&findings).verdict, Verdict::Fault);
    assert_eq!(summary(&run(false)).verdict, Verdict::Ok);
}

/// `summary.json` has the keys that its readers rely on, and a figure beyond its bound shows.
#[test]
fn summary_keys_and_bounds() {
    let path = Path::line(&Pose::identity(), &Pose::translation(1.0, 0.0, 0.0));
    let info = segment(path, 1.0, Some([0.1, 0.9]));
    let findings = analyse(&[info], 1001, |time, sample| {
        sample.segment = 1;
        sample.tcp = Pose::translation(time, 5e-6, 0.0);
        sample.seam_lateral = 1e-3 * time;
        sample.seam_error = 2e-5;
    });
    let mut times = crate::record::TimeHistogram::new();
    times.record(1500);
    let outcome =
        Outcome { stage_times: vec![times.figures("cycle")], wall_time: Some(0.5), ..Outcome::default() };
    let summary = Summary::new(&robot(2), &findings, outcome);
    assert_eq!(summary.verdict, Verdict::OutOfBounds);
    let json: serde_json::Value = serde_json::from_str(&summary.to_json().unwrap()).unwrap();
    for key in [
        "job",
        "robot",
        "verdict",
        "cycles",
        "period_ms",
        "duration_s",
        "real_time_factor",
        "checks",
        "moves",
        "joint_velocity_max",
        "joint_acceleration_max",
        "joint_jerk_max",
        "joints",
        "seam",
        "stage_times_us",
        "lateness_us",
        "overruns",
        "samples_lost",
        "faults",
        "notices",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
    assert_eq!(json["verdict"], "out_of_bounds");
    assert_eq!(json["real_time_factor"], 2.0);
    let line = &json["moves"][0];
    assert_eq!((&line["line"], &line["kind"]), (&12.into(), &"MOVL".into()));
    for key in ["length_mm", "straightness_max_mm", "speed_min_mm_s", "speed_max_mm_s"] {
        assert!(line[key].is_f64(), "{key}");
    }
    for key in ["p50", "p99", "p99_9", "max"] {
        assert!(json["stage_times_us"][0][key].is_f64(), "{key}");
    }
    let near = |value: &serde_json::Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-9;
    assert!(near(&json["seam"]["error_rms_mm"], 0.02) && near(&json["seam"]["lateral_max_mm"], 1.0));
    let failed: Vec<_> = summary.checks.iter().filter(|check| !check.ok).map(|check| check.name).collect();
    assert_eq!(failed, ["path deviation"]);
    let table = summary.to_string();
    assert!(table.contains("✗  path deviation") && table.contains("MOVL in line 12"), "{table}");
}

/// What is no number is not passed over, and a run without samples has figures, too.
#[test]
fn no_numbers_and_no_samples() {
    let findings = analyse(&[], 10, |time, sample| {
        if time > 0.005 {
            sample.command[1] = f64::NAN;
        }
    });
    let summary = Summary::new(&robot(2), &findings, Outcome::default());
    assert_eq!(summary.verdict, Verdict::OutOfBounds);
    let check = summary.checks.iter().find(|check| !check.ok).unwrap();
    assert_eq!((check.name, check.value), ("samples not finite", 4.0));
    let summary = Summary::new(&robot(2), &analyse(&[], 0, |_, _| ()), Outcome::default());
    assert_eq!((summary.verdict, summary.cycles, summary.joint_jerk_max), (Verdict::Ok, 0, 0.0));
    assert!(!summary.to_json().unwrap().contains("inf"));
}

/// A line of 60 mm along x with a sine of 2 mm about it.
fn woven_line() -> Path {
    let shape = WeaveShape {
        pattern: Pattern::Sine,
        amplitude: 2e-3,
        wavelength: 4e-3,
        dwells: [0.0; 3],
        tilt: 0.0,
        elevation: 0.0,
        right_first: false,
    };
    let down = |x: f64| Pose::new(Vector3::new(x, 0.0, 0.0), Vector3::new(PI, 0.0, 0.0));
    let line = Path::line(&down(0.0), &down(0.06));
    line.woven(&Weave::try_new(&shape, 0.0, line.length()).unwrap(), 0.0)
}

/// A weave is held against its own path, and its speed is that of travel: a tool that is 0.03 mm above it is that far off; one that is 2 % fast is that
/// fast; one whose swings are 0.05 mm short is off by that, and its travel as programmed but for what the nearest place makes of it.
#[test]
fn a_weave_is_held_against_its_own_path() {
    let path = woven_line();
    for (raised, speed, short) in [(3e-5, 0.01, 0.0), (0.0, 0.0102, 0.0), (0.0, 0.01, 5e-5)] {
        let info = segment(path, 0.01, Some([1e-3, 0.059]));
        let findings = analyse(&[info], 5_800, |time, sample| {
            sample.segment = 1;
            let s = speed * time;
            let woven = path.pose(s);
            let swing = woven.translation.vector.y;
            sample.tcp = Pose::translation(0.0, -swing * short / 2e-3, raised) * woven;
        });
        let figures = &findings.moves[0];
        let off = figures.straightness_max_mm.unwrap() * 1e-3;
        assert!((off - raised - short).abs() < 1e-8, "{off}");
        let error = figures.speed_error_max.unwrap();
        let expected = (speed / 0.01 - 1.0).abs();
        assert!(
            if short > 0.0 { error < 0.02 } else { (error - expected).abs() < 1e-6 },
            "{error} {expected}"
        );
    }
}

/// Past a corner that is woven, the seam's distance from the point counts.
#[test]
fn a_woven_corner_is_judged_at_the_seam() {
    let path = woven_line();
    let corner = Vector3::new(0.03, 0.3e-3, 0.0);
    let kind = SegmentKind::Corner { path: Some(path), corner, permitted: 0.5e-3 };
    let info = SegmentInfo { kind, ..segment(path, 0.01, None) };
    let findings = analyse(&[info], 5_800, |time, sample| {
        sample.segment = 1;
        sample.tcp = path.pose(0.01 * time);
    });
    let figures = &findings.moves[0];
    assert!((figures.corner_error_mm.unwrap() - 0.3).abs() < 1e-6, "{figures:?}");
    assert!((figures.speed_max_mm_s.unwrap() - 10.0).abs() < 1e-6, "{figures:?}");
    assert!(figures.path_deviation_max_mm().unwrap() < 1e-9, "{figures:?}");
}
