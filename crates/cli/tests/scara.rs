//! Jobs on the built-in SCARA cell, as a user meets them; the motion is judged by the arm's definition.

#![allow(clippy::expect_used, reason = "a failing test says what it missed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Two links bent to the left, a square with a quarter of a circle, and a descent; every point is a stop.
const HEAD: &str = "/JOB\n//NAME PART\n//POS\n///NPOS 7,0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n///RCONF 0,1,0,0,0,0\n";
const POINTS: &str = "\
C00000=350.000,-100.000,-130.000,180.0000,0.0000,0.0000
C00001=350.000,-100.000,-160.000,180.0000,0.0000,0.0000
C00002=450.000,-100.000,-160.000,180.0000,0.0000,30.0000
C00003=478.284,-88.284,-160.000,180.0000,0.0000,30.0000
C00004=490.000,-60.000,-160.000,180.0000,0.0000,30.0000
C00005=490.000,40.000,-160.000,180.0000,0.0000,0.0000
C00006=490.000,40.000,-120.000,180.0000,0.0000,0.0000
";
const MOVES: &str = "\
//INST
///DATE 2026/11/29 06:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
MOVL C00001 V=100.0 PL=0
MOVL C00002 V=160.0 PL=0
MOVC C00002 V=160.0 PL=0
MOVC C00003 V=160.0 PL=0
MOVC C00004 V=160.0 PL=0
MOVL C00005 V=160.0 PL=0
MOVL C00006 V=100.0 PL=0
END
";

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder for results");
    path
}

/// Runs a job of these points with some arguments; its folder and the program's answer.
fn run(name: &str, points: &str, extra: &[&str]) -> (PathBuf, Output) {
    run_text(name, &format!("{HEAD}{points}{MOVES}"), extra)
}

fn run_text(name: &str, text: &str, extra: &[&str]) -> (PathBuf, Output) {
    let out = folder(name);
    let job = out.join("PART.JBI");
    fs::write(&job, text).expect("a job");
    let results = out.join("out");
    let output = Command::new(env!("CARGO_BIN_EXE_seamline"))
        .arg("run")
        .args([&job, Path::new("--out"), &results])
        .args(extra)
        .output()
        .expect("the program starts");
    (results, output)
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The job's line that an arc belongs to.
const ARC: u32 = 26;

struct Row {
    line: u32,
    joints: [f64; 4],
}

fn recording(out: &Path) -> Vec<Row> {
    let text = fs::read_to_string(out.join("recording.csv")).expect("a recording");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header[5..9], ["q1_rad", "q2_rad", "q3_m", "q4_rad"]);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let joints = [5, 6, 7, 8].map(|column: usize| cells[column].parse().expect("a number"));
        Row { line: cells[2].parse().expect("a line"), joints }
    };
    lines.map(row).collect()
}

/// Where the tool is: links of 325 mm and 275 mm, a stroke downward, and 80 mm of tool.
fn tool([q1, q2, q3, _]: [f64; 4]) -> [f64; 3] {
    let (first, second) = (q1.sin_cos(), (q1 + q2).sin_cos());
    [0.325 * first.1 + 0.275 * second.1, 0.325 * first.0 + 0.275 * second.0, q3 - 0.08]
}

/// Greatest distance of a job line's motion from the line or circle it was to follow, in metres.
fn off(rows: &[Row], line: u32, distance: impl Fn([f64; 3]) -> f64) -> f64 {
    let places: Vec<_> = rows.iter().filter(|row| row.line == line).map(|row| tool(row.joints)).collect();
    assert!(places.len() > 100, "line {line}: {} cycles", places.len());
    places.into_iter().map(distance).fold(0.0, f64::max)
}

/// The figures are within their bounds, and so are the joints: the period is a millisecond, limits are as the cell has them.
fn within_limits(out: &Path, rows: &[Row]) {
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("valid JSON");
    assert_eq!(summary["verdict"], "ok", "{summary}");
    let limits = [(4.0, 42.0), (6.3, 63.0), (1.0, 10.0), (31.5, 315.0)];
    for (joint, (velocity, acceleration)) in limits.into_iter().enumerate() {
        for k in 2..rows.len() {
            let q = |back: usize| rows[k - back].joints[joint];
            let v = (q(0) - q(1)) * 1e3;
            let a = (q(0) - 2.0 * q(1) + q(2)) * 1e6;
            assert!(v.abs() <= velocity * 1.06 && a.abs() <= acceleration * 1.01, "joint {joint}: {v} {a}");
        }
    }
}

fn judge(out: &Path) {
    let rows = recording(out);
    within_limits(out, &rows);
    // Lines of the job file: 23 leads along x, the arc round (450, −60), 27 along y, all at z = −160 mm.
    assert!(off(&rows, 23, |[_, y, z]| (y + 0.1).abs().max((z + 0.16).abs())) < 1e-6);
    let round = |[x, y, z]: [f64; 3]| (f64::hypot(x - 0.45, y + 0.06) - 0.04).abs().max((z + 0.16).abs());
    assert!(off(&rows, ARC, round) < 1e-6);
    assert!(off(&rows, 27, |[x, _, z]| (x - 0.49).abs().max((z + 0.16).abs())) < 1e-6);
    let [x, y, z] = tool(rows[rows.len() - 1].joints);
    assert!((x - 0.49).abs() < 1e-6 && (y - 0.04).abs() < 1e-6 && (z + 0.12).abs() < 1e-6);
}

#[test]
fn a_job_runs_on_the_scara() {
    let (out, output) = run("scara", POINTS, &["--cell", "scara"]);
    assert!(output.status.success(), "{}", message(&output));
    judge(&out);
}

#[test]
fn a_tilted_tool_and_a_point_out_of_reach_are_refused_in_its_own_words() {
    let tilted = POINTS.replace("-160.000,180.0000,0.0000,30.0000", "-160.000,180.0000,10.0000,30.0000");
    let (_, output) = run("scara-tilted", &tilted, &["--cell", "scara"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(message(&output).contains("this arm holds it upright"), "{}", message(&output));
    let far = POINTS.replace("C00005=490.000", "C00005=690.000");
    let (results, output) = run("scara-far", &far, &["--cell", "scara"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(message(&output).contains("the arm reaches"), "{}", message(&output));
    assert!(!results.exists(), "a refused job writes nothing");
}

/// The cell has a flexible mode: a prefilter can be made for it, and every stop is exact all the same. The default cell has none.
#[test]
fn a_prefilter_needs_a_mode() {
    let (out, output) = run("scara-prefilter", POINTS, &["--cell", "scara", "--prefilter", "zvd"]);
    assert!(output.status.success(), "{}", message(&output));
    let rows = recording(&out);
    let [x, y, z] = tool(rows[rows.len() - 1].joints);
    assert!((x - 0.49).abs() < 1e-6 && (y - 0.04).abs() < 1e-6 && (z + 0.12).abs() < 1e-6);
    let (_, output) = run("no-mode", POINTS, &["--prefilter", "zvd"]);
    assert_eq!(output.status.code(), Some(1));
    let expected = "--prefilter zvd: expected a [[flexible_mode]] to make the prefilter for";
    assert!(message(&output).contains(expected), "{}", message(&output));
}

/// Corners of the test path, in metres.
const CORNERS: [[f64; 2]; 4] = [[0.14, 0.04], [0.275, 0.1], [0.41, 0.04], [0.36, 0.09]];

/// Least distance of the way from a place, in metres: of the parabola through the nearest sample and its neighbours.
fn least_distance(way: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let off = |p: &[f64; 2]| f64::hypot(p[0] - x, p[1] - y);
    let (nearest, _) = way[1..way.len() - 1]
        .iter()
        .enumerate()
        .min_by(|a, b| off(a.1).total_cmp(&off(b.1)))
        .expect("a way of three samples or more");
    let [a, b, c] = [way[nearest], way[nearest + 1], way[nearest + 2]];
    let at =
        |t: f64| [0, 1].map(|k| b[k] + 0.5 * t * (c[k] - a[k]) + 0.5 * t * t * (a[k] - 2.0 * b[k] + c[k]));
    (-100..=100).map(|t| off(&at(0.01 * f64::from(t)))).fold(f64::INFINITY, f64::min)
}

/// What a prefilter acts on is one of two.
#[test]
fn a_prefilter_acts_on_joints_or_feedrate() {
    let (_, output) = run("acts-on", POINTS, &["--cell", "scara", "--prefilter-on", "speed"]);
    assert!(!output.status.success());
    assert!(message(&output).contains("expected joints or feedrate"), "{}", message(&output));
}

/// The test path of the document, from the first move along it to its end, with the prefilters that the cell's mode asks for: no stop on
/// the way, no corner missed by more than half a millimetre, and nothing faster than programmed.
#[test]
fn the_test_path_is_one_run() {
    let text = include_str!("../../../examples/jobs/scara_path.JBI");
    // On the joints a prefilter shares the corner error with the blend; on the feedrate the tool is on its path.
    for (prefilter, on, errors) in [
        ("none", "joints", 0.49e-3..=0.5002e-3),
        ("zv", "joints", 0.15e-3..=0.5e-3),
        ("fir-zvd", "joints", 0.15e-3..=0.5e-3),
        ("fir-zvd", "feedrate", 0.49e-3..=0.5002e-3),
    ] {
        let (out, output) = run_text(
            &format!("scara-path-{prefilter}-{on}"),
            text,
            &["--cell", "scara", "--prefilter", prefilter, "--prefilter-on", on],
        );
        assert!(output.status.success(), "{}", message(&output));
        let rows = recording(&out);
        within_limits(&out, &rows);
        let on_path = rows.iter().filter(|row| row.line >= 35).map(|row| tool(row.joints));
        let way: Vec<[f64; 2]> = on_path.map(|[x, y, _]| [x, y]).collect();
        for corner in CORNERS {
            let error = least_distance(&way, corner);
            assert!(errors.contains(&error), "{prefilter}, {corner:?}: {error}");
        }
        let speeds: Vec<f64> =
            way.windows(2).map(|p| f64::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1]) * 1e3).collect();
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        // Joints averaged over a curved way may be a little faster than any of its places.
        let most = if prefilter == "none" || on == "feedrate" { 1.0001 } else { 1.001 };
        assert!(fastest < 0.16 * most, "{prefilter}: {fastest}");
        let moving = |speed: &f64| *speed > 1e-3;
        let (first, last) = (speeds.iter().position(moving), speeds.iter().rposition(moving));
        let middle = &speeds[first.expect("motion")..=last.expect("motion")];
        assert!(middle.iter().all(moving), "{prefilter}: it stops on the way");
        let [x, y, _] = tool(rows[rows.len() - 1].joints);
        assert!((x - 0.27).abs() < 1e-6 && y.abs() < 1e-6);
    }
}

/// The same path far faster than the joints can follow: it takes longer, and keeps its corners and the limits.
#[test]
fn a_path_beyond_the_joints_is_slowed() {
    let text = include_str!("../../../examples/jobs/scara_path.JBI").replace("V=160.0", "V=600.0");
    let (out, output) = run_text("scara-fast", &text, &["--cell", "scara"]);
    assert!(output.status.success(), "{}", message(&output));
    let rows = recording(&out);
    within_limits(&out, &rows);
    let way: Vec<[f64; 2]> = rows.iter().map(|row| tool(row.joints)).map(|[x, y, _]| [x, y]).collect();
    for corner in CORNERS {
        let error = least_distance(&way, corner);
        assert!((0.49e-3..=0.5002e-3).contains(&error), "{corner:?}: {error}");
    }
}

/// Corners that may be rounded cost less time than stops on the same points, whatever prefilter has to run out.
#[test]
fn a_rounded_corner_costs_less_than_a_stop() {
    let text = include_str!("../../../examples/jobs/scara_path.JBI");
    let stops = text.replace("PL=1", "PL=0");
    for prefilter in ["none", "zv", "zvd", "fir", "fir-zv", "fir-zvd", "mzv", "ei", "2hump-ei", "3hump-ei"] {
        let cycles = |kind: &str, text: &str| {
            let folder = format!("scara-{kind}-{prefilter}");
            let (out, output) = run_text(&folder, text, &["--cell", "scara", "--prefilter", prefilter]);
            assert!(output.status.success(), "{}", message(&output));
            recording(&out).len()
        };
        let (rounded, stopping) = (cycles("rounded", text), cycles("stopping", &stops));
        println!("{prefilter}: {rounded} cycles, with stops {stopping}");
        assert!(rounded < stopping, "{prefilter}: {rounded} cycles, with stops {stopping}");
    }
}
