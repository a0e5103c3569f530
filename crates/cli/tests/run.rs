//! The program as a user meets it: the main job's results, and wrong files with their one message.

#![allow(clippy::expect_used, reason = "a failing test says what it missed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn seamline(arguments: &[&str]) -> Output {
    let binary = env!("CARGO_BIN_EXE_seamline");
    Command::new(binary).args(arguments).current_dir(root()).output().expect("the program starts")
}

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder for results");
    path
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a readable path")
}

/// Runs an example job and returns its folder and summary.
fn run_example(job: &str, extra: &[&str]) -> (PathBuf, Value) {
    let out = folder(&format!("run-{job}{}", extra.concat()));
    let path = format!("examples/jobs/{job}.JBI");
    let mut arguments = vec!["run", path.as_str(), "--out", text(&out)];
    arguments.extend(extra);
    let output = seamline(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    (out, serde_json::from_str(&summary).expect("valid JSON"))
}

#[test]
fn the_main_job_leaves_its_three_files() {
    let (out, summary) = run_example("fillet", &[]);
    assert_eq!(summary["verdict"], "ok");
    assert_eq!(summary["faults"].as_array().map(Vec::len), Some(0));
    for peak in ["joint_velocity_max", "joint_acceleration_max"] {
        assert!(summary[peak].as_f64().is_some_and(|peak| peak <= 1.0 + 1e-6), "{peak}");
    }
    assert!(summary["joint_jerk_max"].as_f64().is_some_and(|peak| peak <= 1.01));
    let recording = fs::read_to_string(out.join("recording.csv")).expect("a recording");
    assert_eq!(recording.lines().count() as u64, summary["cycles"].as_u64().unwrap_or(0) + 1);
    let report = fs::read_to_string(out.join("report.html")).expect("a report");
    assert!(report.contains("FILLET") && !report.contains("src=\"http"));
}

/// The example that tracks a seam is kept on it but for half of its step of 0.5 mm, and says what became of the readings; a silent sensor stops it with
/// its name; without a sensor the job is refused at COMARCON.
#[test]
fn a_seam_is_tracked_lost_and_missed() {
    let cell = ["--cell", "examples/cells/seam.toml"];
    let (_, summary) = run_example("seam", &cell);
    assert_eq!(summary["verdict"], "ok");
    let error = |of: &str| summary["seam"][of].as_f64().expect("a figure");
    assert!(error("error_rms_mm") < 0.03 && error("error_max_mm") < 0.3, "{}", summary["seam"]);
    let out = folder("seam-silent");
    let job = "examples/jobs/seam.JBI";
    let output =
        seamline(&["run", job, cell[0], cell[1], "--out", text(&out), "--fault", "sensor-silent@20"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("the seam is lost: seen up to") && said.contains("the sensor is silent"), "{said}");
    assert!(said.contains("seam sensor: "), "{said}");
    // A job that reads inputs is planned step by step, but along the seam as far as it reads none.
    let out = folder("seam-waits");
    let waits = out.join("waits.JBI");
    let text_of_job = fs::read_to_string(root().join(job)).expect("the example");
    fs::write(&waits, text_of_job.replace("COMARCON\r\n", "WAIT IN#(1)=OFF T=0.20\r\nCOMARCON\r\n"))
        .expect("a job");
    let output = seamline(&["run", text(&waits), cell[0], cell[1], "--out", text(&out.join("out"))]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = fs::read_to_string(out.join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("valid JSON");
    assert!(summary["seam"]["error_max_mm"].as_f64().expect("a figure") < 0.3, "{}", summary["seam"]);
    let output = seamline(&["check", job]);
    let said = String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1));
    assert!(said.contains("seam.JBI:27:1: the cell has no seam sensor: expected sensor.source"), "{said}");
}

/// The example's first leg, a line along y at x = 1100 mm and z = −50 mm that goes on over the point between its two moves: the torch swings by the
/// 2 mm of the condition, and is held against the woven path.
#[test]
fn the_weaving_example_swings_by_its_amplitude() {
    let (out, summary) = run_example("weave", &[]);
    assert_eq!(summary["verdict"], "ok");
    let recording = fs::read_to_string(out.join("recording.csv")).expect("a recording");
    let header: Vec<&str> = recording.lines().next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|word| *word == name).expect("a column");
    let [line, x, y, z] = ["line", "tcp_x_mm", "tcp_y_mm", "tcp_z_mm"].map(column);
    let mut swings = [0.0_f64; 2];
    for row in recording.lines().skip(1) {
        let value = |at: usize| row.split(',').nth(at).and_then(|word| word.parse().ok()).unwrap_or(f64::NAN);
        let half = usize::from(value(y) > 0.0);
        if [34.0, 35.0].contains(&value(line)) && (-90.0..110.0).contains(&value(y)) {
            swings[half] = swings[half].max((value(x) - 1100.0).hypot(value(z) + 50.0));
        }
    }
    assert!(swings.iter().all(|swing| (swing - 2.0).abs() < 0.02), "{swings:?}");
}

/// The fill pass lies 3 mm above the root that was tracked, all along the weld.
#[test]
fn the_second_pass_lies_above_the_first() {
    let (out, summary) = run_example("passes", &["--cell", "examples/cells/seam.toml"]);
    assert_eq!(summary["verdict"], "ok");
    let recording = fs::read_to_string(out.join("recording.csv")).expect("a recording");
    let header: Vec<&str> = recording.lines().next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|word| *word == name).expect("a column");
    let [line, time, y, height] = ["line", "time_s", "tcp_y_mm", "seam_height_mm"].map(column);
    let mut passes: [Vec<[f64; 2]>; 2] = Default::default();
    for row in recording.lines().skip(1) {
        let value = |at: usize| row.split(',').nth(at).and_then(|word| word.parse().ok()).unwrap_or(f64::NAN);
        if value(line) == 55.0 && value(height).is_finite() {
            passes[usize::from(value(time) > 50.0)].push([value(y), value(height)]);
        }
    }
    let mean = |pass: &[[f64; 2]]| pass.iter().map(|[_, height]| height).sum::<f64>() / pass.len() as f64;
    let above = mean(&passes[1]) - mean(&passes[0]);
    assert!(passes.iter().all(|pass| pass.len() > 15_000) && (above - 3.0).abs() < 0.01, "{above}");
}

#[test]
fn override_changes_time_and_not_the_path() {
    let (full, half) = (run_example("near_wrist", &[]).1, run_example("near_wrist", &["--override", "50"]).1);
    assert_eq!(half["verdict"], "ok");
    let duration = |summary: &Value| summary["duration_s"].as_f64().unwrap_or(0.0);
    let settle = 0.1;
    let ratio = (duration(&half) - settle) / (duration(&full) - settle);
    assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
}

#[test]
fn the_same_job_twice_gives_the_same_recording() {
    let bytes = |name: &str| {
        let out = folder(name);
        assert!(seamline(&["run", "examples/jobs/pulses.JBI", "--out", text(&out)]).status.success());
        fs::read(out.join("recording.csv")).expect("a recording")
    };
    assert!(bytes("twice-1") == bytes("twice-2"));
}

/// A recording's lines in which the arc is on.
fn lit(recording: &str) -> usize {
    let column = recording.lines().next().and_then(|head| head.split(',').position(|name| name == "arc"));
    let column = column.expect("a column arc");
    recording.lines().filter(|line| line.split(',').nth(column) == Some("1")).count()
}

/// The arc's misfires are drawn from the cell's seed: the same seed, the same recording; another seed, another one.
#[test]
fn the_same_seed_gives_the_same_recording_bit_by_bit() {
    let recording = |name: &str, seed: u32| {
        let out = folder(name);
        let cell = out.join("cell.toml");
        let text_of_cell =
            format!("[arc]\nstrikes = 20\n[simulation]\nseed = {seed}\narc_misfire_percent = 50");
        fs::write(&cell, text_of_cell).expect("a cell file");
        let arguments = ["run", "examples/jobs/fillet.JBI", "--out", text(&out), "--cell", text(&cell)];
        assert!(seamline(&arguments).status.success());
        fs::read(out.join("recording.csv")).expect("a recording")
    };
    let first = recording("seed-1", 3);
    assert!(first == recording("seed-2", 3));
    assert!((4..20).any(|seed| first != recording("seed-3", seed)));
}

/// Each kind on the command line and one in a cell file: the fault is named with its time and line, and the recording goes up to it.
#[test]
fn faults_on_purpose_are_named() {
    let kinds = [
        ("drive-silent@10", "drives silent (at 10.001 s, line 33)"),
        ("drive-alarm@10:3", "drive of joint U: alarm 999 (at 10.001 s, line 33)"),
        ("joint-stuck@3:2", "following error of joint L"),
        ("encoder-jump@10:4", "following error of joint R"),
        ("encoder-nan@10", "joint S is not a number (at 10.001 s, line 33)"),
        ("emergency-stop@10", "emergency stop (at 10.000 s, line 33)"),
        ("late-cycles@10", "21 cycles in a row were late (at 10.020 s, line 33)"),
        ("planner-silent@3", "no motion planned ahead"),
        ("no-ignition@1", "the arc did not light in 3 strikes"),
        ("arc-loss@10", "the arc went out (50 ms without current) (at 10.051 s, line 33)"),
    ];
    for (fault, message) in kinds {
        let out = folder(&format!("fault-{}", fault.replace([':', '@'], "-")));
        let output = seamline(&["run", "examples/jobs/fillet.JBI", "--out", text(&out), "--fault", fault]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(1) && stderr.contains(message), "{fault}: {stderr}");
        let recording = fs::read_to_string(out.join("recording.csv")).expect("a recording");
        assert!(recording.lines().any(|line| line.contains(",fault,")), "{fault}");
    }
    let out = folder("fault-cell");
    let cell = out.join("cell.toml");
    fs::write(&cell, "[[simulation.fault]]\nnumber = 1\nkind = \"arc-loss\"\ntime_s = 10")
        .expect("a cell file");
    let output = seamline(&["run", "examples/jobs/fillet.JBI", "--out", text(&out), "--cell", text(&cell)]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("the arc went out"));
}

#[test]
fn wrong_faults_get_one_message() {
    for (fault, code, message) in [
        ("gremlin@1", 2, "expected one of drive-silent, "),
        ("arc-loss@-1", 2, "expected KIND@SECONDS"),
        ("arc-loss", 2, "expected KIND@SECONDS"),
        ("joint-stuck@1:9", 1, "--fault: joint 9: expected 1 to 6"),
    ] {
        let output = seamline(&["run", "examples/jobs/fillet.JBI", "--fault", fault]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code) && stderr.contains(message), "{fault}: {stderr}");
    }
}

#[test]
fn a_dry_run_moves_the_same_way_without_an_arc() {
    let (wet, dry) = (run_example("fillet", &[]), run_example("fillet", &["--dry-run"]));
    assert_eq!(dry.1["verdict"], "ok");
    let read = |out: &Path| fs::read_to_string(out.join("recording.csv")).expect("a recording");
    assert!(lit(&read(&wet.0)) > 1_000);
    assert_eq!(lit(&read(&dry.0)), 0);
    let duration = |summary: &Value| summary["duration_s"].as_f64().unwrap_or(0.0);
    assert!((0.0..0.1).contains(&(duration(&wet.1) - duration(&dry.1))), "less the ignition");
}

#[test]
fn check_names_the_slowdown_before_anything_moves() {
    let output = seamline(&["check", "examples/jobs/near_wrist.JBI"]);
    assert!(output.status.success());
    let stdout = String::from_utf8_lossy(&output.stdout);
    assert!(stdout.contains("near_wrist.JBI:23:1: slows from 150.0 to"), "{stdout}");
    assert!(stdout.contains("joint R is at its speed limit"), "{stdout}");
    assert!(stdout.contains("mm/s could be held all along; it works with the torch tilted by"), "{stdout}");
}

/// A line on which the wrist passes beside its pole, so that joint R would have to turn by half a turn: beyond its range, or all at once. Both
/// are refused before anything moves, with the place along the move and a torch angle that works.
#[test]
fn a_flip_at_the_wrist_is_refused_before_anything_moves() {
    for (ends, reason) in [
        (
            ["0,19077,-23893,12290,15937,0", "868,17238,-23893,12290,-12284,0"],
            "joint R is at its limit of 149.0 deg",
        ),
        (
            ["0,19077,-23893,-4296,15780,0", "-886,17298,-23893,-4296,-11858,0"],
            "joint R would have to jump: the path crosses a singularity",
        ),
    ] {
        let out = folder("flip");
        let job = out.join("FLIP.JBI");
        let points = format!("C00000={}\nC00001={}", ends[0], ends[1]);
        let moves = "MOVJ C00000 VJ=25.00 PL=0\nMOVL C00001 V=100.0 PL=0";
        let text_of_job = format!(
            "/JOB\n//NAME FLIP\n//POS\n///NPOS 2,0,0,0,0,0\n///TOOL 0\n///POSTYPE PULSE\n///PULSE\n{points}\n//INST\n\
             ///DATE 2026/01/15 09:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n{moves}\nEND\n"
        );
        fs::write(&job, text_of_job).expect("a job");
        let results = out.join("results");
        for arguments in [&["check", text(&job)][..], &["run", text(&job), "--out", text(&results)]] {
            let output = seamline(arguments);
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{message}");
            assert!(message.contains("FLIP.JBI:16:1: at 140."), "{message}");
            assert!(
                message.contains(reason) && message.contains("it works with the torch tilted by"),
                "{message}"
            );
        }
        assert!(!results.join("recording.csv").exists());
    }
}

#[test]
fn the_printed_cell_is_the_default_cell() {
    let printed = seamline(&["cell", "--print"]).stdout;
    let path = folder("cell").join("cell.toml");
    fs::write(&path, printed).expect("a cell file");
    assert!(seamline(&["check", "examples/jobs/fillet.JBI", "--cell", text(&path)]).status.success());
}

#[test]
fn wrong_usage_is_exit_status_two() {
    for arguments in [
        &["run"][..],
        &["nonsense"],
        &["run", "a.JBI", "--override", "0"],
        &["run", "a.JBI", "--override", "x"],
    ] {
        assert_eq!(seamline(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn every_subcommand_has_help_with_an_example() {
    for command in ["run", "check", "cell"] {
        let help = String::from_utf8_lossy(&seamline(&[command, "--help"]).stdout).into_owned();
        assert!(help.contains("Example:\n  seamline"), "{command}: {help}");
    }
}

const JOB: &str = "\
/JOB
//NAME A
//POS
///NPOS 3,0,0,0,0,0
///TOOL 0
///POSTYPE PULSE
///PULSE
C00000=0,0,0,0,-49000,0
C00001=10000,10000,0,0,-49000,0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00002=1100.000,100.000,0.000,180.0000,0.0000,90.0000
//INST
///DATE 2026/01/15 09:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
MOVL C00001 V=50.0 PL=0
ARCON ASF#(1)
MOVL C00002 V=10.0 PL=0
ARCOF AEF#(1)
TIMER T=0.10
END
";

/// What is replaced by what, and what the message must say after the file's name.
const WRONG_JOBS: &[(&str, &str, &str)] = &[
    ("C00000=0,0,0,0,-49000,0", "C00000=0,0,0,x,-49000,0", ":8:14: "),
    ("C00000=0,0,0,0,-49000,0", "C00000=0,0,0,0,-49000", ":8:"),
    ("C00001=10000", "C00000=10000", ":9:"),
    ("///NPOS 3,0,0,0,0,0", "///NPOS 2,0,0,0,0,0", ":4:"),
    ("///NPOS 3,0,0,0,0,0", "///NPOS 3,a,0,0,0,0", ":4:"),
    ("///RCONF 1,0,0,0,0,0", "///RCONF 1,0,7,0,0,0", ":12:"),
    ("180.0000,0.0000,90.0000", "180.0000,0.0000", ":13:"),
    ("C00002=1100.000", "C00002=1100.000.1", ":13:"),
    ("VJ=50.00", "VJ=150.00", ":19:16: VJ (%) is 150, expected 0.01 to 100"),
    ("VJ=50.00", "VJ=abc", ":19:"),
    ("V=50.0", "V=-3.0", ":20:"),
    ("PL=0\nMOVL C00001", "PL=9\nMOVL C00001", ":19:"),
    ("MOVL C00001", "MOVL C00007", ":20:"),
    ("TIMER T=0.10", "TIMER T=", ":24:"),
    ("TIMER T=0.10", "JUMP *NOWHERE", ":24:"),
    ("TIMER T=0.10", "CALL JOB:MISSING", ":24:"),
    ("TIMER T=0.10", "SET B000 300", ":24:"),
    ("TIMER T=0.10", "DIV I000 0", ":24:"),
    ("TIMER T=0.10", "ENDIF", ":24:"),
    ("TIMER T=0.10", "*L\nJUMP *L", ":2"),
    ("TIMER T=0.10\nEND\n", "TIMER T=0.10\n", ":"),
    ("/JOB\n", "", ":1:"),
    ("//INST\n", "", ":"),
    ("ARCON ASF#(1)", "ARCON ASF#(99)", ":21:1: ASF#(99) is not in the cell file; expected [[arc_start]]"),
    ("///TOOL 0", "///TOOL 9", ":19:1: tool 9 is not in the cell file; expected a [[tool]]"),
    ("C00002=1100.000", "C00002=5100.000", ":22:1: the tool centre point would leave the workspace at ("),
    ("C00002=1100.000", "C00002=2100.000", ":22:1: at "),
    ("C00001=10000,", "C00001=900000,", ":20:1: C00001: joint S at 670.95 deg is outside -179.0 … 179.0 deg"),
    ("TIMER T=0.10", "WVON WEV#(7)", ":24:1: WEV#(7) is not in the cell file; expected [[weave]]"),
    ("TIMER T=0.10", "SMOVL C00000 V=10.0", ":24:1: `SMOVL"),
    ("TIMER T=0.10", "FROBNICATE C00000", ":24:1: `FROBNICATE"),
];

/// A cell file, and what the message must say after the file's name.
const WRONG_CELLS: &[(&str, &str)] = &[
    ("robot = 3", ":1:"),
    ("[robot]\nmodel = \"kuka\"", ":2:9: robot.model"),
    ("[robot]\nmodel = \"ur5e\"", "robot"),
    ("[robotics]\nmodel = \"ar2010\"", ":1:"),
    ("[[robot.joint]]\nnumber = 3\nvelocity_deg_s = -1.0", ":3:"),
    ("[[robot.joint]]\nnumber = 3\nvelocity_deg_s = \"fast\"", ":3:"),
    ("[[robot.joint]]\nnumber = 12", ":2:"),
    ("[[robot.joint]]\nnumber = 3\nvelocity_rad_s = 1.0", ":3:1: robot.joint[3].velocity_rad_s"),
    ("[[robot.joint]]\nnumber = 3\nposition_min_deg = 170.0", ":3:"),
    ("[[tool]]\nnumber = -1", ":2:"),
    ("[[tool]]\nname = \"torch\"", ":1:"),
    ("[cycle]\nperiod_ms = 0", ":2:"),
    ("[cycle]\nperiod_ms = nan", ":2:"),
    ("[cycle]\nperiod = 1", ":2:"),
    ("[job]\nspeed_unit = \"m/s\"", ":2:"),
    ("[job]\nposition_level_mm = [1, 2]", ":2:"),
    ("[arc]\nrefuse_slowdown = 1", ":2:"),
    ("[io]\nunmet_wait = \"hope\"", ":2:"),
    ("[drive]\nbackend = \"ethercat\"", ":2:"),
    ("[safety]\nworkspace_min_mm = [0, 0]", ":2:"),
    ("[simulation]\nservo_lag_ms = -5.0", ":2:"),
    ("[cycle\nperiod_ms = 1", ":1:"),
];

/// One message on stderr, exit status 1, no panic, and nothing written.
fn assert_refused(output: &Output, out: &Path, start: &str, expected: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{expected}: {stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    let message = stderr.strip_prefix("seamline: ").unwrap_or(&stderr);
    assert!(message.starts_with(start), "{message:?} should begin with {start:?}");
    assert!(message.contains(expected), "{message:?} should contain {expected:?}");
    assert!(!out.exists(), "nothing may be written: {expected}");
}

#[test]
fn wrong_jobs_get_one_message_and_no_report() {
    let folder = folder("wrong-jobs");
    for (k, (from, to, expected)) in WRONG_JOBS.iter().enumerate() {
        assert!(JOB.contains(from), "{from:?} stands in the job");
        let (job, out) = (folder.join(format!("w{k}.JBI")), folder.join(format!("out{k}")));
        fs::write(&job, JOB.replacen(from, to, 1)).expect("a job file");
        let output = seamline(&["run", text(&job), "--out", text(&out)]);
        assert_refused(&output, &out, text(&job), expected);
    }
    let right = folder.join("right.JBI");
    fs::write(&right, JOB).expect("a job file");
    let output = seamline(&["run", text(&right), "--out", text(&folder.join("right"))]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn wrong_cells_get_one_message_and_no_report() {
    let folder = folder("wrong-cells");
    for (k, (toml, expected)) in WRONG_CELLS.iter().enumerate() {
        let (cell, out) = (folder.join(format!("w{k}.toml")), folder.join(format!("out{k}")));
        fs::write(&cell, toml).expect("a cell file");
        let arguments = ["run", "examples/jobs/fillet.JBI", "--cell", text(&cell), "--out", text(&out)];
        assert_refused(
            &seamline(&arguments),
            &out,
            if *expected == "robot" { "" } else { text(&cell) },
            expected,
        );
    }
}

/// A job that gives no speed at all takes the cell's, and says so.
#[test]
fn a_missing_speed_is_the_cells() {
    let folder = folder("speeds");
    let job = folder.join("speeds.JBI");
    let text_of_job = JOB.replace(" VJ=50.00", "").replace(" V=50.0", "").replace("ARCON ASF#(1)\n", "");
    fs::write(&job, text_of_job).expect("a job file");
    let output = seamline(&["check", text(&job)]);
    let stdout = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(stdout.contains(":19:1: VJ is missing, taken from the cell's default"), "{stdout}");
    assert!(stdout.contains(":20:1: V is missing, taken from the cell's default"), "{stdout}");
}

#[test]
fn missing_files_are_named() {
    let out = folder("missing").join("out");
    let output = seamline(&["run", "nowhere.JBI", "--out", text(&out)]);
    assert_refused(&output, &out, "cannot read nowhere.JBI", "nowhere.JBI");
    let output =
        seamline(&["run", "examples/jobs/fillet.JBI", "--cell", "nowhere.toml", "--out", text(&out)]);
    assert_refused(&output, &out, "nowhere.toml", "nowhere.toml");
}

/// One job on every arm that comes with a cell: a joint move, a line and an arc, in pulses (1,000 a degree).
#[test]
fn a_job_runs_on_every_six_axis_arm() {
    let folder = folder("arms");
    let arms = [
        ("irb2400", ["0,0,0,0,45000,0", "15000,5000,-5000,5000,50000,5000", "20000,15000,-5000,0,40000,0"]),
        (
            "ur5e",
            [
                "0,-90000,90000,-90000,-90000,0",
                "15000,-80000,95000,-100000,-85000,10000",
                "25000,-95000,100000,-95000,-90000,0",
            ],
        ),
    ];
    for (arm, [first, second, third]) in arms {
        let job = format!(
            "/JOB\n//NAME ARM\n//POS\n///NPOS 3,0,0,0,0,0\n///TOOL 0\n///POSTYPE PULSE\n///PULSE\n\
             C00000={first}\nC00001={second}\nC00002={third}\n//INST\n///DATE 2026/01/15 09:00\n///ATTR SC,RW\n\
             ///GROUP1 RB1\nNOP\nMOVJ C00000 VJ=50.00 PL=0\nMOVL C00001 V=200.0 PL=0\nMOVC C00001 V=100.0 PL=0\n\
             MOVC C00002 V=100.0 PL=0\nMOVC C00000 V=100.0 PL=0\nMOVJ C00002 VJ=100.00 PL=0\nEND\n"
        );
        let (path, out) = (folder.join(format!("{arm}.JBI")), folder.join(arm));
        fs::write(&path, job).expect("a job file");
        let cell = format!("examples/cells/{arm}.toml");
        let output = seamline(&["run", text(&path), "--cell", &cell, "--out", text(&out)]);
        assert!(output.status.success(), "{arm}: {}", String::from_utf8_lossy(&output.stderr));
        let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
        let summary: Value = serde_json::from_str(&summary).expect("valid JSON");
        assert_eq!(summary["verdict"], "ok", "{arm}: {summary}");
    }
}
