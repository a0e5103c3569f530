//! G-code: what programs become, step by step; what is wrong in them; and whole parts in motion, judged by their way.

#![allow(clippy::expect_used, clippy::panic, reason = "a failing test says what it missed")]

#[path = "common/parts.rs"]
mod parts;

use std::fs;
use std::path::Path;

use parts::{Part, distances, parts, places};
use seamline::geometry::Pose;
use seamline_cell::cell::Cell;
use seamline_cell::gcode::{Interpreter, Program, Setup};
use seamline_cell::job::{Action, Configuration, Coordinates, Frame, Move, MovePath, Speed, Step, Zone};
use seamline_cell::plan::CellArm;
use seamline_cell::run::RunOptions;

fn setup() -> Setup {
    let frame = |x: f64| Some(Pose::translation(x, 0.0, 0.0));
    Setup {
        frames: [frame(0.0), frame(0.1), None, None, None, None],
        start: Pose::translation(0.3, 0.0, 0.2),
        configuration: Configuration::default(),
        rapid_mm_s: 1000.0,
        joint_percent: 10.0,
        tolerance_mm: 0.01,
    }
}

/// The steps of a program, and the mistakes on its way in their own words.
fn walked(text: &str) -> (Vec<Step>, Vec<String>) {
    let program = match Program::parse("part.ngc", text.into()) {
        Ok(program) => program,
        Err(errors) => return (Vec::new(), errors.to_string().lines().map(str::to_owned).collect()),
    };
    let mut interpreter = Interpreter::new(&program, setup());
    let (mut steps, mut mistakes) = (Vec::new(), Vec::new());
    // Every line gives a bounded number of steps.
    for _ in 0..1000 {
        match interpreter.next_step() {
            Ok(Some(step)) => steps.push(step),
            Ok(None) => return (steps, mistakes),
            Err(error) => mistakes.push(error.to_string()),
        }
    }
    panic!("the program does not end: {text}");
}

fn moves(text: &str) -> Vec<Move> {
    let (steps, mistakes) = walked(text);
    assert!(mistakes.is_empty(), "{mistakes:?}");
    let of = |step: Step| match step.action {
        Action::Move(r#move) => Some(*r#move),
        _ => None,
    };
    steps.into_iter().filter_map(of).collect()
}

/// Frame and end point of a move, to a nanometre.
fn end(r#move: &Move) -> (Frame, [f64; 3]) {
    let Coordinates::Rectangular(position) = &r#move.target.position.coordinates else {
        panic!("no coordinates: {move:?}");
    };
    (position.frame, position.position_mm.map(|x| (x * 1e6).round() / 1e6 + 0.0))
}

fn ends(text: &str) -> Vec<[f64; 3]> {
    moves(text).iter().map(|r#move| end(r#move).1).collect()
}

#[test]
fn coordinates_are_absolute_or_incremental_in_either_unit() {
    let text = "G21 G90 G0 X10 Y20 Z30\nG1 X11 F600\nG91 Y-1\nG20 Z.1\nG90 X1\nM2";
    let wanted = [
        [10.0, 20.0, 30.0],
        [11.0, 20.0, 30.0],
        [11.0, 19.0, 30.0],
        [11.0, 19.0, 32.54],
        [25.4, 19.0, 32.54],
    ];
    assert_eq!(ends(text), wanted);
}

#[test]
fn speeds_are_the_cell_s_and_the_feed_in_the_unit_of_its_line() {
    let text = "G0 X400 Y0 Z0\nG0 X410\nG1 X420 F600\nX430 F1200\nG20 F15 X17\nG0 X18\nM2";
    let speeds: Vec<Speed> = moves(text).iter().map(|r#move| r#move.speed).collect();
    let linear = |mm_s| Speed::Linear { mm_s };
    let wanted =
        [Speed::JointPercent(10.0), linear(1000.0), linear(10.0), linear(20.0), linear(6.35), linear(1000.0)];
    assert_eq!(speeds, wanted);
}

#[test]
fn frames_are_the_cell_s_and_the_tool_stays_where_it_is() {
    let text = "G0 X400 Y0 Z0\nG55 G91 G1 X1 F600\nG54 X1\nM2";
    let ends: Vec<(Frame, [f64; 3])> = moves(text).iter().map(end).collect();
    let wanted = [
        (Frame::User(1), [400.0, 0.0, 0.0]),
        (Frame::User(2), [301.0, 0.0, 0.0]),
        (Frame::User(1), [402.0, 0.0, 0.0]),
    ];
    assert_eq!(ends, wanted);
}

/// A quarter of a circle by I and J, by R, and by absolute centre comes to the same; a negative R is the way round.
#[test]
fn arcs_by_centre_and_by_radius_are_the_same() {
    let vias = |line: &str| -> Vec<[f64; 3]> {
        let text = format!("G0 X410 Y0 Z0\n{line} F600\nM2");
        let of = |r#move: &Move| match &r#move.path {
            MovePath::Circular(arc) => {
                Some(arc.points.each_ref().map(|point| match &point.position.coordinates {
                    Coordinates::Rectangular(place) => place.position_mm,
                    _ => [f64::NAN; 3],
                }))
            }
            _ => None,
        };
        let rounded = |point: [f64; 3]| point.map(|x| (x * 1e6).round() / 1e6 + 0.0);
        moves(&text).iter().filter_map(of).flatten().map(rounded).collect()
    };
    let half = 5.0 * 2_f64.sqrt();
    let via = [400.0 + half, half, 0.0].map(|x: f64| (x * 1e6).round() / 1e6);
    let quarter = [[410.0, 0.0, 0.0], via, [400.0, 10.0, 0.0]];
    for line in ["G3 X400 Y10 I-10", "G3 X400 Y10 R10", "G90.1 G3 X400 Y10 I400 J0"] {
        assert_eq!(vias(line), quarter, "{line}");
    }
    // 270 degrees the other way, about the mirrored centre: in three pieces.
    let round = vias("G3 X400 Y10 R-10");
    assert_eq!((round.len(), round[0], round[8]), (9, [410.0, 0.0, 0.0], [400.0, 10.0, 0.0]));
    for point in round {
        assert!(((point[0] - 410.0).hypot(point[1] - 10.0) - 10.0).abs() < 1e-5, "{point:?}");
    }
}

#[test]
fn corners_are_as_the_program_asks_for() {
    let zones = |line: &str| -> Vec<Zone> {
        let text = format!("G0 X400 Y0 Z0\n{line}\nG1 X401 F600\nM2");
        moves(&text).iter().skip(1).map(|r#move| r#move.zone).collect()
    };
    let within = |mm| Zone::Tolerance { mm };
    assert_eq!(zones(""), [within(0.01)]);
    assert_eq!(zones("G64 P0.02"), [within(0.02)]);
    assert_eq!(zones("G20\nG64 P0.01\nG21"), [within(0.254)]);
    assert_eq!(zones("G61"), [within(0.0)]);
    assert_eq!(zones("G61.1"), [Zone::Exact]);
    assert_eq!(zones("G64 P0.02\nG64"), [within(0.01)]);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let cases = [
        ("G1 X1\nM2", "part.ngc:1:4: `G1` has no feed"),
        ("G0 X1\nG1 X1 X2 F9\nM2", "part.ngc:2:7: "),
        ("G0 X1 G1\nM2", "part.ngc:1:7: "),
        ("G0 X1\nG1 X#3 F9\nM2", "part.ngc:2:4: `X#` is refused: parameters"),
        ("G0 X1\nG1 X1.2.3 F9\nM2", "part.ngc:2:4: "),
        ("G0 X1\n(half\nM2", "part.ngc:2:1: "),
        ("G0 X1\n", "the file ends without M2"),
        ("G0 X410\nG2 X400 Y10 I-9 F9\nM2", "part.ngc:2:4: the arc starts 9"),
        ("G0 X410\nG2 X430 R9 F9\nM2", "part.ngc:2:4: R is 9 mm"),
        ("G0 X410\nG2 X430 F9\nM2", "part.ngc:2:4: "),
        ("G0 X410\nG4\nM2", "part.ngc:2:1: "),
        ("G0 X410\nG1 X1 K5 F9\nM2", "part.ngc:2:7: "),
        ("G2 X430 R19 F9\nM2", "part.ngc:1:4: "),
        ("G0 X1e5\nM2", "part.ngc:1:6: "),
    ];
    for (text, wanted) in cases {
        let (_, mistakes) = walked(text);
        assert!(mistakes.len() == 1 && mistakes[0].contains(wanted), "{text}: {mistakes:?}");
    }
}

#[test]
fn comments_messages_and_numbers_of_lines_move_nothing() {
    let (steps, mistakes) = walked("%\nO12\nN1 (a comment) G0 X1 ; more\n(MSG, mind the clamp)\n/ \nM30");
    assert_eq!((steps.len(), mistakes.len()), (0, 1), "a line that a switch leaves out: {mistakes:?}");
    let (steps, mistakes) =
        walked("%\nO12\nN1 (a comment) g 0 x 400 ; more\n(MSG, mind the clamp)\nG4 P0.5\nM0\nM30\nG1");
    assert!(mistakes.is_empty(), "{mistakes:?}");
    let seen: Vec<&Action> = steps.iter().map(|step| &step.action).collect();
    assert!(matches!(seen[0], Action::Move(_)));
    assert_eq!(seen[1], &Action::Message { text: "mind the clamp".into() });
    assert_eq!(seen[2..], [&Action::Dwell { seconds: 0.5 }, &Action::Pause, &Action::End]);
}

/// Rows of chords become curves within half of what is permitted, and corners stay corners.
#[test]
fn short_lines_of_a_curve_run_as_one() {
    let mut text = String::from("G0 X400 Y0 Z0\nG64 P0.02 F600\n");
    for step in 1..=60 {
        let angle = f64::from(step) * 0.01;
        text += &format!("G1 X{:.4} Y{:.4}\n", 400.0 + 20.0 * angle.sin(), 20.0 - 20.0 * angle.cos());
    }
    text += "G1 X420 Y40\nM2";
    let moves = moves(&text);
    let curves = moves.iter().filter(|r#move| matches!(r#move.path, MovePath::Curve(_))).count();
    let lines = moves.iter().filter(|r#move| matches!(r#move.path, MovePath::Linear)).count();
    assert!((1..=3).contains(&curves) && lines <= 3, "{curves} curves, {lines} lines");
    assert_eq!(end(&moves[moves.len() - 1]).1, [420.0, 40.0, 0.0]);
    // With Q 0 nothing is merged.
    let all = self::moves(&text.replace("G64 P0.02", "G64 P0.02 Q0"));
    assert_eq!(all.len(), 62);
}

/// The arm's tool goes as the part's way does: never off by more than G64 P, with no joint past a limit.
fn runs_within_its_tolerance(part: &Part, cell: &Cell, name: &str) {
    let arm = CellArm::from_cell(cell).expect("an arm");
    let program = Program::parse(part.name, part.text.clone().into_bytes()).expect("a program").into();
    let check = arm.check(&program, cell).expect("a check");
    assert!(check.errors.is_empty(), "{:?}", check.errors);
    let stops = check.findings.iter().filter(|finding| finding.text.contains("stops on the way")).count();
    assert_eq!(stops, 0, "{}", part.name);
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("gcode-{name}-{}", part.name));
    let options = RunOptions { out: out.clone(), speed_override: 1.0, realtime: false };
    let run = arm.run(&program, cell, &options, |_| {}).expect("a run");
    let recording = fs::read_to_string(out.join("recording.csv")).expect("a recording");
    let work = cell.user_frame(1).expect("a work frame").base_from_user;
    let [off, missed] = distances(&part.way, &places(&recording, &work));
    assert!(off <= part.tolerance * 1.001 + 1e-6, "{}: {off} of {} mm", part.name, part.tolerance);
    // Places are joined by lines, a cycle long, that cut a corner's tip by less than half a micrometre.
    assert!(missed <= part.tolerance + 5e-4, "{}: {missed} of {} mm", part.name, part.tolerance);
    assert!(
        off.max(missed) > 0.3 * part.tolerance,
        "{}: {off}, {missed}: the tolerance is made use of",
        part.name
    );
    for joint in &run.findings.joints {
        let shares = [joint.velocity.fraction, joint.acceleration.fraction, joint.jerk.fraction];
        assert!(shares.iter().all(|share| *share <= 1.002), "{}: {joint:?}", part.name);
    }
    // It takes at least as long as its feeds say.
    assert!(run.findings.duration > part.nominal_seconds, "{}", part.name);
}

#[test]
fn parts_of_short_lines_keep_tolerance_and_limits_on_a_scara() {
    let cell = Cell::built_in("scara").expect("it is built in").expect("it is sound");
    for part in parts(600) {
        runs_within_its_tolerance(&part, &cell, "scara");
    }
}

#[test]
fn parts_of_short_lines_keep_tolerance_and_limits_on_six_axes() {
    let cell = Cell::load(Path::new("../../examples/cells/plate.toml")).expect("a cell");
    for part in parts(600) {
        runs_within_its_tolerance(&part, &cell, "plate");
    }
}
