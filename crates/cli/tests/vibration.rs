//! `shaper`, `identify`, `corner` and `experiment` as a user meets them.

#![allow(clippy::expect_used, reason = "a failing test says what it missed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn seamline(arguments: &str) -> Output {
    let binary = env!("CARGO_BIN_EXE_seamline");
    Command::new(binary).args(arguments.split_whitespace()).output().expect("the program starts")
}

fn answer(arguments: &str) -> Value {
    let output = seamline(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON value")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("numbers").iter().map(number).collect()
}

/// A file of this test's own, not there yet.
fn file(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_file(&path);
    path
}

/// A page that needs no network and has its charts.
fn is_page(path: &Path, words: &[&str]) {
    let page = fs::read_to_string(path).expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    assert!(!page.contains("src=") && !page.contains("href="));
    for word in words {
        assert!(page.contains(word), "{word}");
    }
}

/// Exit status and message of a call that fails.
fn refused(arguments: &str) -> (Option<i32>, String) {
    let output = seamline(arguments);
    assert!(output.stdout.is_empty());
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

const MODE: &str = "--frequency-hz 6.34 --damping 0.022";

/// The document's table 2, FIR-ZVD at 66.038 degrees.
#[test]
fn corner_answers_as_the_document_prints() {
    let page = file("corner.html");
    let question = format!(
        "corner --prefilter fir-zvd {MODE} --feedrate-mm-min 9600 --error-mm 0.5 --angle-deg 66.038 --plot {}",
        page.display()
    );
    let found = answer(&question);
    let printed = [("t_dec1_s", 0.316), ("t_m_s", 0.253), ("t_c_s", 0.121), ("t_d_s", 0.195)];
    for (name, printed) in printed {
        assert!((number(&found[name]) - printed).abs() <= 1e-3, "{name}: {found}");
    }
    assert!((0.4999..=0.5).contains(&number(&found["error_mm"])), "{found}");
    is_page(&page, &["Corner in time", "t_DEC1", "66.038"]);
}

#[test]
fn corner_takes_unequal_feedrates() {
    let base = format!("corner --prefilter fir {MODE} --feedrate-mm-min 9600 --error-mm 0.5 --angle-deg 90");
    let (same, slower) = (answer(&base), answer(&format!("{base} --second-feedrate-mm-min 2400")));
    assert!(number(&slower["t_c_s"]) > number(&same["t_c_s"]));
    assert!((0.4999..=0.5).contains(&number(&slower["error_mm"])));
}

#[test]
fn shaper_shows_what_a_prefilter_does() {
    let page = file("shaper.html");
    let shown = answer(&format!("shaper --prefilter zv,fir-zvd {MODE} --plot {}", page.display()));
    let [zv, fir_zvd] = shown["prefilters"].as_array().expect("prefilters").as_slice() else {
        panic!("{shown}")
    };
    assert_eq!(zv["prefilter"], "ZV");
    let weights: Vec<_> =
        zv["impulses"].as_array().expect("impulses").iter().map(|i| number(&i["weight"])).collect();
    assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15 && weights.len() == 2);
    // Two damped periods.
    let period = 1.0 / (6.34 * (1.0_f64 - 0.022 * 0.022).sqrt());
    assert!((number(&fir_zvd["length_s"]) - 2.0 * period).abs() < 1e-12);
    let command = numbers(&fir_zvd["step"]["command"]);
    assert_eq!((command.first(), command.last()), (Some(&0.0), Some(&1.0)));
    assert!(command.windows(2).all(|pair| pair[1] >= pair[0] - 1e-15));
    let (ratio, left) =
        (&fir_zvd["sensitivity"]["ratio"], &fir_zvd["sensitivity"]["vibration_over_frequency"]);
    let at = numbers(ratio).iter().position(|r| (r - 1.0).abs() < 1e-12).expect("the modelled frequency");
    assert!(numbers(left)[at] < 1e-12);
    assert_eq!(numbers(&fir_zvd["frequency"]["gain"])[0], 1.0);
    is_page(&page, &["Prefilters", "FIR-ZVD", "Residual vibration"]);
}

#[test]
fn shaper_takes_several_modes() {
    let shown = answer("shaper --prefilter zvd --frequency-hz 6.34,14 --damping 0.022,0.01");
    assert_eq!(shown["prefilters"][0]["impulses"].as_array().map(Vec::len), Some(9));
}

/// Two modes of 6.34 and 17 Hz, three seconds at 1 kHz, written with as many digits as a logger gives.
fn vibration() -> String {
    let tau = std::f64::consts::TAU;
    let mut text = String::from("time_s, acceleration\n");
    for n in 0..3000_u32 {
        let t = f64::from(n) * 1e-3;
        let part = |f: f64, z: f64, a: f64| {
            a * (-z * tau * f * t).exp() * (tau * f * (1.0 - z * z).sqrt() * t).cos()
        };
        let value = part(6.34, 0.022, 0.7) + part(17.0, 0.01, 0.2);
        text += &format!("{t:.3}, {value:.4}\n");
    }
    text
}

#[test]
fn identify_finds_both_modes() {
    let (csv, page) = (file("vibration.csv"), file("vibration.html"));
    fs::write(&csv, vibration()).expect("a file");
    let found = answer(&format!("identify {} --plot {}", csv.display(), page.display()));
    let modes = found["modes"].as_array().expect("modes");
    assert_eq!(modes.len(), 2, "{found}");
    for (mode, (frequency, damping)) in modes.iter().zip([(6.34, 0.022), (17.0, 0.01)]) {
        assert!((number(&mode["frequency_hz"]) / frequency - 1.0).abs() < 1e-4, "{mode}");
        assert!((number(&mode["damping"]) / damping - 1.0).abs() < 1e-2, "{mode}");
        assert!(number(&mode["frequency_std_hz"]) > 0.0 && number(&mode["damping_std"]) > 0.0);
    }
    is_page(&page, &["Identified modes", "Spectrum"]);
}

#[test]
fn wrong_files_get_one_message_with_the_line() {
    let csv = file("wrong.csv");
    let message = |text: &str| {
        fs::write(&csv, text).expect("a file");
        let page = file("wrong.html");
        let (status, message) = refused(&format!("identify {} --plot {}", csv.display(), page.display()));
        assert_eq!(status, Some(1), "{message}");
        assert!(message.contains("wrong.csv") && message.lines().count() == 1, "{message}");
        assert!(!page.exists());
        message
    };
    assert!(message("time_s, acceleration\n0, 1\n0.001; 2\n").contains("line 3: `0.001; 2`"));
    assert!(message("0, 1\n0, 2\n").contains("line 2: time 0 s"));
    assert!(message("").contains("no samples"));
    assert!(message("0, 1\n1, 2\n").contains("2 samples: expected at least"));
    let silent: String = (0..100).map(|n| format!("{n}, 0\n")).collect();
    assert!(message(&silent).contains("no decaying vibration"));
    let (status, message) = refused("identify nowhere.csv");
    assert!(status == Some(1) && message.contains("nowhere.csv"));
}

#[test]
fn wrong_arguments_are_usage() {
    let wrong = [
        ("shaper --prefilter boxcar --frequency-hz 6 --damping 0.1", "fir-zvd"),
        ("shaper --frequency-hz 0 --damping 0.1", "a number above 0"),
        ("shaper --frequency-hz 6 --damping 1", "0 to below 0.95"),
        (
            "corner --prefilter zv --frequency-hz 6 --damping 0.1 --feedrate-mm-min 1 --error-mm 1 --angle-deg 181",
            "0 to 180",
        ),
        (
            "corner --prefilter zv --frequency-hz 6 --damping 0.1 --feedrate-mm-min 1 --error-mm -1 --angle-deg 1",
            "error-mm",
        ),
    ];
    for (arguments, expected) in wrong {
        let (status, message) = refused(arguments);
        assert_eq!(status, Some(2), "{arguments}: {message}");
        assert!(message.contains(expected), "{message}");
    }
    let (status, message) = refused("shaper --frequency-hz 6,7 --damping 0.1");
    assert!(status == Some(1) && message.contains("one for each"), "{message}");
    let (status, message) = refused("shaper --prefilter 3hump-ei --frequency-hz 6,7,8 --damping 0.1,0.1,0.1");
    assert!(status == Some(1) && message.contains("impulses"), "{message}");
}

/// What the document asks of FIR-ZVD, also where the plant's frequency has drifted by 15 % since the identification.
#[test]
fn the_scara_experiment_keeps_its_figures() {
    let page = file("scara.html");
    for (drift, reduction, residual) in [("0", 85.12, 0.5), ("-15", 85.0, 1.5), ("15", 85.0, 1.5)] {
        let found =
            answer(&format!("experiment scara --json --plant-drift-pct {drift} --plot {}", page.display()));
        assert!((number(&found["identified"]["frequency_hz"]) / 6.34 - 1.0).abs() < 2e-3, "{found}");
        let runs = found["runs"].as_array().expect("runs");
        assert_eq!(runs.len(), 12);
        for run in runs.iter().filter(|run| run["prefilter"] == "FIR-ZVD") {
            assert!(number(&run["reduction_max_pct"]) >= reduction, "{run}");
            assert!(number(&run["residual_pct"]) <= residual, "{run}");
            let errors = numbers(&run["corner_errors_mm"]);
            let wanted = if number(&run["error_um"]) > 0.0 { 0.495..=0.5 } else { 0.0..=1e-3 };
            assert!(errors.len() == 4 && errors.iter().all(|error| wanted.contains(error)), "{run}");
        }
        is_page(
            &page,
            &[
                "SCARA experiment",
                "Feedrate",
                "158.96",
                "t_DEC1",
                "through the prefilters",
                "Spectrum of what is left",
            ],
        );
    }
    let table = seamline("experiment scara");
    let text = String::from_utf8_lossy(&table.stdout).into_owned();
    assert!(table.status.success() && text.lines().count() == 19 && text.contains("FIR-ZVD"), "{text}");
    assert_eq!(refused("experiment scara --plant-drift-pct -100").0, Some(2));
}

/// Within FIR-ZVD's vibration in 0.92 of its time; what auto is asked for is checked.
#[test]
fn the_motion_of_least_time_beside_fir_zvd() {
    let page = file("auto.html");
    let found = answer(&format!(
        "experiment scara --prefilter auto --error-um 500 --safe-drift-pct 0 --json --plot {}",
        page.display()
    ));
    let runs = found["runs"].as_array().expect("runs");
    let names: Vec<_> = runs.iter().map(|run| run["prefilter"].as_str().expect("a name")).collect();
    assert_eq!(names, ["none", "FIR-ZVD", "auto"]);
    let against = &found["against_fir_zvd"][0];
    assert!(number(&against["path_time"]) <= 0.92, "{found}");
    assert!(number(&against["max"]) <= 1.0 && number(&against["residual"]) <= 1.0, "{found}");
    is_page(&page, &["least time", "one curve a corner error", "auto, 1000 µm", "FIR-ZVD, 500 µm"]);
    let asked = answer("experiment scara --prefilter auto --error-um 250 --max-g 0.2 --json");
    let (fir_zvd, auto) = (&asked["runs"][1], &asked["runs"][2]);
    let times = [auto, fir_zvd].map(|run| number(&run["path_time_s"]));
    assert!(number(&auto["max_g"]) <= 0.2004 && times[0] < 0.9 * times[1], "{asked}");
    let wrong = [
        ("experiment scara --prefilter zv", 2, "expected auto"),
        ("experiment scara --max-g 0.2", 2, "--prefilter"),
        ("experiment scara --prefilter auto --max-g 0", 2, "above 0"),
        ("experiment scara --prefilter auto --jerk-m-s3 0", 2, "above 0"),
        ("experiment scara --prefilter auto --max-g 1e-9", 1, "no motion keeps"),
        ("check missing.JBI --prefilter auto", 2, "experiment scara"),
    ];
    for (arguments, status, expected) in wrong {
        let (found, message) = refused(arguments);
        assert!(found == Some(status) && message.contains(expected), "{arguments}: {found:?} {message}");
    }
}

#[test]
fn help_has_an_example() {
    for command in ["shaper", "identify", "corner", "experiment", "experiment scara"] {
        let output = seamline(&format!("{command} --help"));
        assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("Example:"));
    }
}
