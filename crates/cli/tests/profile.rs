//! `seamline profile` as a user meets it.

#![allow(clippy::expect_used, reason = "a failing test says what it missed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

const EXAMPLE: [&str; 9] =
    ["profile", "--from-mm", "0", "--to-mm", "100", "--time", "3", "--n", "0.3333333333333333"];
const RETARGET: [&str; 4] = ["--retarget-at", "1.2", "--retarget-to-mm", "40"];

fn seamline(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_seamline")).args(arguments).output().expect("the program starts")
}

/// The answer to the example with more arguments.
fn answer(more: &[&[&str]]) -> Value {
    let output = seamline(&[&EXAMPLE, more.concat().as_slice()].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("valid JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn near(value: &Value, expected: f64) {
    assert!((number(value) - expected).abs() < 1e-9, "{value} is not {expected}");
}

fn page(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_file(&path);
    path
}

#[test]
fn the_papers_example() {
    let answer = answer(&[&["--samples", "7"]]);
    near(&answer["velocity_mm_s"], 50.0);
    near(&answer["acceleration_mm_s2"], 75.0);
    near(&answer["jerk_mm_s3"], 225.0);
    let times = answer["switch_times_s"].as_array().expect("a list");
    for (time, expected) in times.iter().zip([1.0, 2.0, 3.0, 6.0, 7.0, 8.0, 9.0]) {
        near(time, expected / 3.0);
    }
    assert_eq!((times.len(), &answer["retarget"]), (7, &Value::Null));
    let samples = answer["samples"].as_array().expect("a list");
    assert_eq!(samples.len(), 7);
    near(&samples[1]["acceleration_mm_s2"], 75.0);
    near(&samples[3]["position_mm"], 50.0);
    let last = &samples[6];
    assert_eq!((&last["activity"], number(&last["position_mm"])), (&Value::from("holding"), 100.0));
}

#[test]
fn a_new_target_is_taken_over_without_a_jump() {
    let answer = answer(&[&RETARGET, &["--samples", "4201"]]);
    let retarget = &answer["retarget"];
    assert_eq!((&retarget["mode"], &retarget["while"]), (&"continuous".into(), &"moving".into()));
    near(&retarget["from"]["position_mm"], 35.0);
    near(&retarget["from"]["velocity_mm_s"], 50.0);
    near(&retarget["arrival_s"], 4.2);
    assert_eq!(number(&retarget["velocity_jump_mm_s"]), 0.0);
    // Differences over a millisecond, against the wider limits of the two plans.
    let limits = &retarget["limits"];
    for (of, limit) in [
        ("position_mm", number(&limits["velocity_mm_s"])),
        ("velocity_mm_s", number(&limits["acceleration_mm_s2"])),
        ("acceleration_mm_s2", number(&limits["jerk_mm_s3"])),
    ] {
        let values: Vec<f64> =
            answer["samples"].as_array().expect("a list").iter().map(|sample| number(&sample[of])).collect();
        let steepest = values.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 1e-3).fold(0.0, f64::max);
        assert!(steepest <= limit * (1.0 + 1e-6), "{of}: {steepest}, {limit}");
    }
    let last = &answer["samples"][4200];
    assert_eq!((number(&last["position_mm"]), number(&last["velocity_mm_s"])), (40.0, 0.0));
}

#[test]
fn restart_from_rest_says_how_far_the_velocity_jumps() {
    let answer = answer(&[&RETARGET, &["--mode", "restart-from-rest"]]);
    let retarget = &answer["retarget"];
    near(&retarget["velocity_jump_mm_s"], -50.0);
    near(&retarget["limits"]["velocity_mm_s"], 2.5);
    assert_eq!(number(&answer["samples"][100]["position_mm"]), 40.0);
}

#[test]
fn a_target_that_comes_late_finds_the_axis_holding() {
    let answer = answer(&[&["--retarget-at", "5", "--retarget-to-mm", "-40"]]);
    assert_eq!(answer["retarget"]["while"], "holding");
    near(&answer["end_s"], 8.0);
    // At 4 s, half-way.
    let sample = &answer["samples"][50];
    assert_eq!((&sample["activity"], number(&sample["position_mm"])), (&"holding".into(), 100.0));
}

#[test]
fn the_plot_is_one_offline_page() {
    let path = page("profile.html");
    answer(&[&RETARGET, &["--plot", path.to_str().expect("a readable path")]]);
    let text = fs::read_to_string(&path).expect("a page");
    assert_eq!(text.matches("<polyline").count(), 4);
    assert!(text.contains("V = 50.0000 mm/s") && text.contains("new target"));
    for foreign in ["http:", "https:", "url(", "src=", "href=", "<script", "NaN", "inf"] {
        assert!(!text.contains(foreign), "{foreign}");
    }
}

#[test]
fn what_has_no_profile_is_one_message() {
    for (arguments, message) in [
        (
            ["--to-mm", "1", "--time", "0"],
            "seamline: a duration of 0 s was asked for, expected a positive finite one",
        ),
        (["--to-mm", "nan", "--time", "1"], "seamline: axis 0: target is NaN, expected a finite number"),
        (
            ["--to-mm", "1", "--time", "1e-200"],
            "seamline: axis 0: velocity, acceleration or jerk is beyond the range",
        ),
    ] {
        let output = seamline(&[&["profile"], &arguments[..]].concat());
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), stderr.lines().count()), (Some(1), 1), "{stderr}");
        assert!(stderr.starts_with(message) && output.stdout.is_empty(), "{stderr}");
    }
    let output = seamline(&["profile", "--to-mm", "1", "--time", "1", "--n", "0.6"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("n is 0.6, expected a number above 0, at most 0.5")
    );
    let unwritable = ["--plot", "/nowhere/profile.html"];
    let output = seamline(&[&EXAMPLE[..], &unwritable].concat());
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("/nowhere/profile.html"));
}

#[test]
fn wrong_usage_is_exit_status_two() {
    for more in [
        &["--retarget-at", "1"][..],
        &["--retarget-to-mm", "1"],
        &["--retarget-at", "-1", "--retarget-to-mm", "1"],
        &["--retarget-at", "1", "--retarget-to-mm", "1", "--mode", "sudden"],
        &["--mode", "continuous"],
        &["--samples", "many"],
        &["--time", "soon"],
    ] {
        assert_eq!(seamline(&[&EXAMPLE[..], more].concat()).status.code(), Some(2), "{more:?}");
    }
    assert_eq!(seamline(&["profile", "--to-mm", "1"]).status.code(), Some(2));
}

#[test]
fn the_help_has_an_example() {
    let help = String::from_utf8_lossy(&seamline(&["profile", "--help"]).stdout).into_owned();
    assert!(help.contains("Example:\n  seamline profile"), "{help}");
}
