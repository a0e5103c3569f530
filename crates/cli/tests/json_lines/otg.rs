//! `seamline otg`.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};

use serde_json::{Value, json};

use crate::program::{answer, answers, lines, numbers, run, seamline, stderr};

const REST: &str = r#"{"id": 1, "current": {"position": [0]}, "target": {"position": [1]},
    "limits": {"velocity_max": [1], "acceleration_max": [2], "jerk_max": [10]}}"#;

fn rest() -> Value {
    serde_json::from_str(REST).unwrap()
}

#[test]
fn durations_of_textbook_moves() {
    let limits =
        |v: Value, a: Value, j: Value| json!({"velocity_max": v, "acceleration_max": a, "jerk_max": j});
    // Distance 1 from rest to rest: d/v + v/a + a/j, less for each limit that is infinite.
    for (limits, duration) in [
        (limits(json!([1]), json!([2]), json!([10])), 1.7),
        (limits(json!([1]), json!([2]), json!([null])), 1.5),
        (limits(json!([1]), json!([2]), Value::Null), 1.5),
        (limits(json!([1]), Value::Null, Value::Null), 1.0),
        // Without velocity limit 2 √(d/a), with a jerk limit alone (32 d/j)^⅓.
        (limits(Value::Null, json!([4]), Value::Null), 1.0),
        (limits(Value::Null, Value::Null, json!([32])), 1.0),
    ] {
        let mut question = rest();
        question["limits"] = limits;
        let answer = answer(&["otg"], &question.to_string());
        let found = answer["duration"].as_f64().unwrap();
        assert!((found - duration).abs() <= 1e-14, "{question}: {found} for {duration}");
    }
}

#[test]
fn the_answer_has_exactly_the_documented_members() {
    let mut question = rest();
    question["sample"] = json!([0, 1]);
    let text = |question: &Value| String::from_utf8(run(&["otg"], &question.to_string()).stdout).unwrap();
    assert_eq!(
        text(&question),
        "{\"id\":1,\"ok\":true,\"duration\":1.7,\"duration_min_per_axis\":[1.7],\"synchronized\":[\"time\"],\
         \"samples\":[{\"time\":0.0,\"position\":[0.0],\"velocity\":[0.0],\"acceleration\":[0.0]},\
         {\"time\":1.7,\"position\":[1.0],\"velocity\":[0.0],\"acceleration\":[0.0]}]}\n"
    );
    question["sample"] = Value::Null;
    question["limits"] = json!({"velocity_max": [0.5]});
    question["profiles"] = json!(true);
    assert_eq!(
        text(&question),
        "{\"id\":1,\"ok\":true,\"duration\":2.0,\"duration_min_per_axis\":[2.0],\"synchronized\":[\"time\"],\
         \"samples\":[],\"profiles\":[[{\"duration\":2.0,\"velocity\":0.5}]]}\n"
    );
}

/// Pairs of questions that say the same.
#[test]
fn defaults_are_what_the_format_says() {
    let both = json!({
        "control": "velocity", "synchronization": "none",
        "current": {"position": [1, 2], "velocity": [0, 0], "acceleration": [0, 0]},
        "target": {"position": [3, 4], "velocity": [1, 0], "acceleration": [0, 0]},
        "limits": {"velocity_max": [1, 1], "velocity_min": [-1, -1], "acceleration_max": [2, 2],
            "acceleration_min": [-2, -2], "jerk_max": [10, null]},
        "sample": [0, 0.5, 1], "profiles": true,
    });
    let same: [(&str, Value); 14] = [
        ("/id", json!(null)),
        ("/control", json!(["velocity", "velocity"])),
        ("/synchronization", json!(["none", "none"])),
        ("/current/velocity", Value::Null),
        ("/current/acceleration", Value::Null),
        ("/target/position", Value::Null),
        ("/target/position", json!([null, null])),
        ("/target/position", json!([1e300, null])),
        ("/target/velocity", json!([1, null])),
        ("/target/acceleration", Value::Null),
        ("/limits/velocity_max", Value::Null),
        ("/limits/velocity_min", Value::Null),
        ("/limits/acceleration_min", Value::Null),
        ("/duration_min", json!(0)),
    ];
    let expected = answer(&["otg"], &both.to_string());
    assert_eq!(expected["ok"], true);
    for (place, value) in same {
        let mut other = both.clone();
        match other.pointer_mut(place) {
            Some(member) => *member = value.clone(),
            None => other[&place[1..]] = value.clone(),
        }
        assert_eq!(answer(&["otg"], &other.to_string()), expected, "{place} = {value}");
    }
    let mut position_control = both.clone();
    position_control["control"] = json!("position");
    let expected = answer(&["otg"], &position_control.to_string());
    assert_eq!(expected["ok"], true);
    position_control.as_object_mut().unwrap().remove("control");
    assert_eq!(answer(&["otg"], &position_control.to_string()), expected);
    position_control["control"] = json!(["position", "velocity"]);
    assert_ne!(answer(&["otg"], &position_control.to_string()), expected);
}

#[test]
fn each_axis_says_how_it_is_synchronized() {
    let line = |synchronization: Value, target: [f64; 3]| {
        json!({
            "synchronization": synchronization, "current": {"position": [0, 0, 0]}, "target": {"position": target},
            "limits": {"velocity_max": [1, 2, 3], "acceleration_max": [1, 2, 3], "jerk_max": [5, 5, 5]},
        })
    };
    for (synchronization, modes) in [
        (json!("none"), ["none", "none", "none"]),
        (json!("time"), ["time", "time", "time"]),
        (json!("time_if_necessary"), ["none", "none", "none"]),
        (json!("phase"), ["phase", "phase", "phase"]),
        (json!("phase_strict"), ["phase", "phase", "phase"]),
        (json!(["phase", "none", "phase"]), ["phase", "none", "phase"]),
    ] {
        let answer = answer(&["otg"], &line(synchronization, [1.0, 2.0, -3.0]).to_string());
        assert_eq!(answer["synchronized"], json!(modes));
    }
    let mut moving = line(json!("phase"), [1.0, 2.0, 3.0]);
    moving["current"]["velocity"] = json!([0.1, 0, 0]);
    assert_eq!(answer(&["otg"], &moving.to_string())["synchronized"], json!(["time", "time", "time"]));
}

#[test]
fn a_minimum_duration_is_met() {
    let mut question = rest();
    question["duration_min"] = json!(4.25);
    let answer = answer(&["otg"], &question.to_string());
    assert_eq!(answer["duration"], 4.25);
    assert_eq!(numbers(&answer["duration_min_per_axis"]), [1.7]);
}

#[test]
fn names_and_order_are_kept() {
    let names = [
        json!("a"),
        json!(1.5),
        json!([1, {"b": null}]),
        json!(null),
        json!(-7),
        json!("ä\"\n"),
        json!(true),
    ];
    let questions: Vec<Value> = names
        .iter()
        .map(|name| {
            let mut question = rest();
            question["id"] = name.clone();
            question
        })
        .collect();
    // Blank lines, line ends of either kind, and none at the end.
    let text = format!("\n  \r\n{}", lines(&questions).replace('\n', "\r\n").trim_end());
    let found: Vec<Value> = answers(&["otg"], &text).into_iter().map(|answer| answer["id"].clone()).collect();
    assert_eq!(found, names);
}

#[test]
fn from_one_to_sixteen_axes() {
    let question = |axes: usize| {
        let all = |value: f64| vec![value; axes];
        json!({
            "current": {"position": all(0.0)}, "target": {"position": all(1.0)}, "sample": [1],
            "limits": {"velocity_max": all(1.0), "acceleration_max": all(2.0), "jerk_max": all(10.0)},
        })
    };
    for axes in 1..=16 {
        let answer = answer(&["otg"], &question(axes).to_string());
        assert_eq!(answer["duration"], 1.7);
        assert_eq!(numbers(&answer["samples"][0]["position"]), vec![1.0; axes]);
    }
}

/// Every number comes back as it was given, and nothing is ever NaN.
#[test]
fn numbers_survive() {
    for position in
        [0.1 + 0.2, 1e-308, -5e-324, 1.0 / 3.0, 9_007_199_254_740_993.0, -2.225_073_858_507_201e-308]
    {
        let mut question = rest();
        question["current"]["position"] = json!([position]);
        question["target"]["position"] = json!([position]);
        question["sample"] = json!([0]);
        let answer = answer(&["otg"], &question.to_string());
        assert_eq!(
            numbers(&answer["samples"][0]["position"])[0].to_bits(),
            f64::to_bits(position),
            "{answer}"
        );
    }
    for huge in [1e30, 1e99, 1e150, 1e300, 1.7e308] {
        let question = json!({
            "id": huge, "control": ["velocity", "position"],
            "current": {"position": [0, -huge], "acceleration": [huge, 0]},
            "target": {"position": [null, huge]},
            "limits": {"acceleration_max": [null, 1], "jerk_max": [1e-42, 1]},
            "sample": [0, 0.5, 1], "profiles": true,
        });
        let text = String::from_utf8(run(&["otg"], &question.to_string()).stdout).unwrap();
        assert!(!text.contains("null"), "{text}");
    }
}

/// A program that waits for each answer before it asks the next.
#[test]
fn answers_come_without_the_input_ending() {
    let mut child = seamline(&["otg"]).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut output = BufReader::new(child.stdout.take().unwrap());
    for id in 0..3 {
        let asked = json!({"id": id, "current": {"position": [0]}, "target": {"position": [1]},
            "limits": {"velocity_max": [1]}});
        // The beginning of the next line must not hold the answer back.
        write!(input, "{asked}\n  ").unwrap();
        input.flush().unwrap();
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        let answer: Value = serde_json::from_str(&line).unwrap();
        assert_eq!(answer["id"], id);
        assert_eq!(answer["duration"], 1.0);
    }
    drop(input);
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_pipe_closed_early_is_no_failure() {
    let mut child = seamline(&["otg"]).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let question = rest().to_string() + "\n";
    let writer =
        std::thread::spawn(move || (0..20_000).all(|_| input.write_all(question.as_bytes()).is_ok()));
    let mut output = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    output.read_line(&mut line).unwrap();
    drop(output);
    let mut messages = String::new();
    child.stderr.take().unwrap().read_to_string(&mut messages).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(messages, "");
    writer.join().unwrap();
}

#[test]
fn only_unreadable_input_is_a_failure() {
    for (file, message) in [
        ("no/such/file", "seamline: no/such/file cannot be read: No such file or directory (os error 2)\n"),
        (".", "seamline: . cannot be read: Is a directory (os error 21)\n"),
    ] {
        let output = run(&["otg", file], "");
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(1), message));
    }
    let output = run(&["otg", "--wrong"], "");
    assert_eq!(output.status.code(), Some(2));
    let output = run(&["otg"], "nonsense\n");
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn bench_tells_times_of_each_number_of_axes() {
    let two = r#"{"current": {"position": [0, 0]}, "target": {"position": [1, 2]}, "limits": {"velocity_max": [1, 1]}}"#;
    let one = rest().to_string();
    let measured = answers(&["otg", "--bench"], &format!("{one}\n{two}\n{one}\n"));
    assert_eq!(measured.len(), 2);
    for (measured, cases, dofs) in [(&measured[0], 2, 1), (&measured[1], 1, 2)] {
        let members: Vec<&String> = measured.as_object().unwrap().keys().collect();
        assert_eq!(members, ["cases", "dofs", "max_ns", "mean_ns", "p99_ns"]);
        assert_eq!((&measured["cases"], &measured["dofs"]), (&json!(cases), &json!(dofs)));
        let time = |name: &str| measured[name].as_f64().unwrap();
        assert!(
            0.0 <= time("mean_ns") && time("mean_ns") <= time("p99_ns") && time("p99_ns") <= time("max_ns")
        );
    }
    let output = run(&["otg", "--bench"], &format!("{one}\n[]\n"));
    assert!(output.status.success());
    assert_eq!(
        stderr(&output),
        "seamline: 1 of 2 questions left out, the first: line 2: the line: found a list of 0, expected an object\n"
    );
    let output = run(&["otg", "--bench"], "");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "seamline: no question can be measured: the input is empty\n");
}

#[test]
fn every_subcommand_helps_with_an_example() {
    for name in ["otg", "fk", "ik"] {
        let output = run(&[name, "--help"], "");
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("Example:") && text.contains(&format!("seamline {name}")), "{text}");
    }
}

/// What the questions of SPEC 11 leave to the library, asked here too: position limits, axes that are not planned, steps of the duration, targets
/// that move on.
#[test]
fn limits_of_position_axes_left_out_steps_and_moving_targets() {
    let question = |more: &str| {
        let text = format!(
            r#"{{"current": {{"position": [0, 5], "velocity": [0.5, 0]}}, "target": {{"position": [1, null]}},
            "limits": {{"velocity_max": [1, 1], "acceleration_max": [2, 2], "position_max": [1.2, null]}},
            "enabled": [true, false], "sample": [1]{more}}}"#
        )
        .replace('\n', " ");
        answer(&["otg"], &text)
    };
    let plain = question("");
    let duration = plain["duration"].as_f64().unwrap();
    assert_eq!(plain["samples"][0]["position"], json!([1.0, 5.0]), "{plain}");
    let stepped = question(r#", "duration_step": 0.5"#)["duration"].as_f64().unwrap();
    assert_eq!(stepped, 0.5 * (duration / 0.5).ceil());
    // The target runs away at half the highest speed: the axis meets it where it is then.
    let mut moving: Value = serde_json::from_str(REST).unwrap();
    moving["target"]["velocity"] = json!([0.5]);
    moving["target_moves"] = json!(true);
    moving["sample"] = json!([1]);
    let met = answer(&["otg"], &moving.to_string());
    let at = met["duration"].as_f64().unwrap();
    let position = met["samples"][0]["position"][0].as_f64().unwrap();
    assert!((position - (1.0 + 0.5 * at)).abs() <= 1e-12, "{met}");
    // Too fast to stop in front of the position limit.
    let mut beyond: Value = serde_json::from_str(REST).unwrap();
    beyond["current"]["velocity"] = json!([1]);
    beyond["target"]["position"] = json!([0.1]);
    beyond["limits"]["position_max"] = json!([0.2]);
    let refused = answer(&["otg"], &beyond.to_string());
    let error = refused["error"].as_str().unwrap();
    assert!(
        error.contains("would reach position 0.34666") && error.contains("beyond the limit 0.2"),
        "{error}"
    );
}
