//! What the program says to questions that are none.

use serde_json::json;

use crate::program::{answers, run, stderr};

/// Asks them all at once, good ones in between: each gets its message and the stream goes on.
fn check(arguments: &[&str], good: &str, table: &[(&str, &str)]) {
    let text: String = table.iter().map(|(question, _)| format!("{question}\n{good}\n")).collect();
    let answers = answers(arguments, &text);
    assert_eq!(answers.len(), 2 * table.len());
    for (pair, (question, message)) in answers.chunks(2).zip(table) {
        assert_eq!(pair[0]["ok"], false, "{question}");
        assert_eq!(pair[0]["error"], *message, "{question}");
        assert_eq!(pair[0].as_object().unwrap().len(), 3, "{question}");
        assert_eq!(pair[1]["id"], "good", "{question}");
        assert!(pair[1].get("error").is_none(), "{question}");
    }
}

/// A question of two axes, with something in place of something.
fn otg(part: &str, instead: &str) -> String {
    let whole = r#"{"id":7,"current":{"position":[0,0]},"target":{"position":[1,1]},"limits":{"velocity_max":[1,1],"acceleration_max":[2,2],"jerk_max":[9,9]}}"#;
    assert_eq!(whole.matches(part).count(), 1, "{part}");
    whole.replace(part, instead)
}

#[test]
fn otg_names_what_where_and_what_was_expected() {
    let lines = [
        ("nonsense", "line 1: not JSON at column 2: expected ident"),
        ("{\"id\": 3", "line 3: not JSON at column 8: EOF while parsing an object"),
        ("{} {}", "line 5: not JSON at column 4: trailing characters"),
        (
            "{\"id\": 1, \"current\": {\"position\": [1e999]}}",
            "line 7: not JSON at column 40: number out of range",
        ),
        (
            "{\"limits\": {\"jerk_max\": [NaN]}}",
            "line 9: not JSON at column 26: expected value; JSON has no NaN or Infinity, no limit is null",
        ),
        (
            "{\"limits\": {\"jerk_max\": [Infinity]}}",
            "line 11: not JSON at column 26: expected value; JSON has no NaN or Infinity, no limit is null",
        ),
        ("[]", "line 13: the line: found a list of 0, expected an object"),
        ("12", "line 15: the line: found 12, expected an object"),
        ("null", "line 17: the line: found null, expected an object"),
        ("{}", "line 19: current.position: missing, expected a list of 1 to 16 numbers"),
    ];
    let good =
        r#"{"id":"good","current":{"position":[0]},"target":{"position":[1]},"limits":{"velocity_max":[1]}}"#;
    check(&["otg"], good, &lines);
    let members = [
        (
            "\"current\":{\"position\":[0,0]},",
            "",
            "current.position: missing, expected a list of 1 to 16 numbers",
        ),
        ("{\"position\":[0,0]}", "null", "current.position: missing, expected a list of 1 to 16 numbers"),
        (
            "{\"position\":[0,0]}",
            "[0,0]",
            "current: found a list of 2, expected an object with position, velocity, acceleration",
        ),
        ("[0,0]", "[]", "current.position: found a list of 0, expected a list of 1 to 16 numbers"),
        ("[0,0]", "0", "current.position: found 0, expected a list of 1 to 16 numbers"),
        (
            "[0,0]",
            "[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]",
            "current.position: found a list of 17, expected a list of 1 to 16 numbers",
        ),
        ("[0,0]", "[0,null]", "current.position[1]: found null, expected a number"),
        ("[0,0]", "[0,\"1\"]", "current.position[1]: found \"1\", expected a number"),
        ("[0,0]", "[{},0]", "current.position[0]: found an object, expected a number"),
        (
            "[0,0]",
            "[0,0],\"velocity\":[0]",
            "current.velocity: found a list of 1, expected a list of 2 numbers",
        ),
        ("[0,0]", "[0,0],\"velocity\":[0,null]", "current.velocity[1]: found null, expected a number"),
        (
            "[0,0]",
            "[0,0],\"speed\":[0,0]",
            "current.speed: unknown, expected one of position, velocity, acceleration",
        ),
        (
            "\"target\":{\"position\":[1,1]},",
            "",
            "target.position[0]: missing, expected a number (only axes in velocity control need none)",
        ),
        (
            "[1,1]}",
            "[1,null]}",
            "target.position[1]: missing, expected a number (only axes in velocity control need none)",
        ),
        ("[1,1]}", "[1,1,1]}", "target.position: found a list of 3, expected a list of 2 numbers"),
        ("[1,1]}", "[1,true]}", "target.position[1]: found true, expected a number"),
        ("[1,1]}", "[1,1],\"velocity\":[0,2]}", "axis 1: target velocity needs 2, beyond the limit 1"),
        (
            "[1,1]}",
            "[1,1],\"acceleration\":[-3,0]}",
            "axis 0: target acceleration needs -3, beyond the limit -2",
        ),
        (
            "\"velocity_max\"",
            "\"velocity\"",
            "limits.velocity: unknown, expected one of velocity_max, velocity_min, acceleration_max, acceleration_min, jerk_max, position_max, position_min",
        ),
        (
            "[9,9]",
            "[9,-9]",
            "limits.jerk_max[1]: found -9, expected a number of 0 or more, or null for no limit",
        ),
        ("[9,9]", "[9,9,9]", "limits.jerk_max: found a list of 3, expected a list of 2 numbers"),
        ("[9,9]", "9", "limits.jerk_max: found 9, expected a list of 2 numbers"),
        (
            "[9,9]",
            "[9,9],\"velocity_min\":[0,0.5]",
            "limits.velocity_min[1]: found 0.5, expected a number of 0 or less, or null for no limit",
        ),
        ("\"limits\"", "\"limit\"", "limit: unknown, did you mean limits?"),
        (
            "\"id\":7",
            "\"id\":7,\"synchronisation\":\"phase\"",
            "synchronisation: unknown, did you mean synchronization?",
        ),
        (
            "\"id\":7",
            "\"id\":7,\"synchronization\":\"phases\"",
            "synchronization: found \"phases\", expected \"none\", \"time\", \"time_if_necessary\", \"phase\", \"phase_strict\"",
        ),
        (
            "\"id\":7",
            "\"id\":7,\"synchronization\":[\"time\"]",
            "synchronization: found a list of 1, expected one word, or a list of 2",
        ),
        (
            "\"id\":7",
            "\"id\":7,\"synchronization\":[\"time\",1]",
            "synchronization[1]: found 1, expected \"none\", \"time\", \"time_if_necessary\", \"phase\", \"phase_strict\"",
        ),
        (
            "\"id\":7",
            "\"id\":7,\"control\":\"torque\"",
            "control: found \"torque\", expected \"position\", \"velocity\"",
        ),
        ("\"id\":7", "\"id\":7,\"duration_min\":-1", "duration_min: found -1, expected seconds, 0 or more"),
        (
            "\"id\":7",
            "\"id\":7,\"duration_min\":\"2 s\"",
            "duration_min: found \"2 s\", expected seconds, 0 or more",
        ),
        ("\"id\":7", "\"id\":7,\"sample\":[0,1.01]", "sample[1]: found 1.01, expected a number from 0 to 1"),
        ("\"id\":7", "\"id\":7,\"sample\":0.5", "sample: found 0.5, expected a list of numbers"),
        ("\"id\":7", "\"id\":7,\"profiles\":1", "profiles: found 1, expected true or false"),
        (
            "\"velocity_max\":[1,1],\"acceleration_max\":[2,2],\"jerk_max\":[9,9]",
            "",
            "axis 0: velocity, acceleration and jerk are all unlimited",
        ),
        ("\"velocity_max\":[1,1]", "\"velocity_max\":[1,0]", "axis 1: a zero limit keeps it from its target"),
        (
            "[1,1]}",
            "[1,1],\"velocity\":[0.1,0]},\"synchronization\":\"phase_strict\"",
            "axis 1: displacement, velocity and acceleration are not parallel to the line",
        ),
    ];
    let questions: Vec<String> = members.iter().map(|(part, instead, _)| otg(part, instead)).collect();
    let table: Vec<(&str, &str)> = questions
        .iter()
        .zip(&members)
        .map(|(question, (_, _, message))| (question.as_str(), *message))
        .collect();
    check(&["otg"], good, &table);
}

#[test]
fn bytes_that_are_no_text_are_told_apart() {
    let mut child = crate::program::seamline(&["otg"]).spawn().unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), b"{\"id\": \"\xff\"}\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert_eq!(
        String::from_utf8(output.stdout).unwrap(),
        "{\"id\":null,\"ok\":false,\"error\":\"line 1: not JSON at column 9: invalid unicode code point\"}\n"
    );
}

#[test]
fn fk_names_what_where_and_what_was_expected() {
    let good = r#"{"id":"good","q":[0,0,0,0,0,0]}"#;
    let table = [
        ("{\"id\":1}", "q: missing, expected a list of 6 numbers"),
        ("{\"q\":null}", "line 3: q: missing, expected a list of 6 numbers"),
        ("{\"id\":1,\"q\":[0,0,0,0,0]}", "q: found a list of 5, expected a list of 6 numbers"),
        ("{\"id\":1,\"q\":{}}", "q: found an object, expected a list of 6 numbers"),
        ("{\"id\":1,\"q\":[0,0,0,0,0,null]}", "q[5]: found null, expected a number from -1e6 to 1e6"),
        ("{\"id\":1,\"q\":[0,0,1e7,0,0,0]}", "q[2]: found 10000000.0, expected a number from -1e6 to 1e6"),
    ];
    check(&["fk"], good, &table);
}

#[test]
fn ik_names_what_where_and_what_was_expected() {
    let good = r#"{"id":"good","position_m":[1,0.1,0.5],"quaternion_xyzw":[0,1,0,0]}"#;
    let table = [
        ("{\"id\":1}", "position_m: missing, expected a list of 3 numbers"),
        ("{\"id\":1,\"position_m\":[1,2]}", "position_m: found a list of 2, expected a list of 3 numbers"),
        ("{\"id\":1,\"position_m\":[1,2,3]}", "quaternion_xyzw: missing, expected a list of 4 numbers"),
        (
            "{\"id\":1,\"position_m\":[1,0,0],\"quaternion_xyzw\":[0,0,0,0.5]}",
            "quaternion_xyzw: found one of length 0.5, expected length 1",
        ),
        (
            "{\"id\":1,\"position_m\":[1,0,0],\"quaternion_xyzw\":[0,0,0,0]}",
            "quaternion_xyzw: found one of length 0, expected length 1",
        ),
        (
            "{\"id\":1,\"position_m\":[1,0,0],\"quaternion_xyzw\":[0,0,0,1],\"seed\":[0]}",
            "seed: found a list of 1, expected a list of 6 numbers",
        ),
        (
            "{\"id\":1,\"position_m\":[1,0,0],\"quaternion_xyzw\":[0,0,0,1],\"seed\":[0,0,0,0,\"a\",0]}",
            "seed[4]: found \"a\", expected a number from -1e6 to 1e6",
        ),
        ("{\"id\":1,\"position\":[1,0,0]}", "position: unknown, did you mean position_m?"),
        (
            "{\"id\":1,\"position_m\":[3,0,0],\"quaternion_xyzw\":[0,0,0,1]}",
            "out of reach: the links would span 2.851754 m, expected 0.340329 to 1.860329 m",
        ),
    ];
    check(&["ik"], good, &table);
    let tilted = r#"{"id":1,"position_m":[0.4,0.1,-0.05],"quaternion_xyzw":[0,0,0,1]}"#;
    let answers = answers(&["ik", "--robot", "scara600"], tilted);
    assert_eq!(answers[0]["error"], "the orientation is 3.141593 rad from the nearest that the arm can take");
    let low = r#"{"id":1,"position_m":[0.4,0.1,-0.3],"quaternion_xyzw":[1,0,0,0]}"#;
    let answers = crate::program::answers(&["ik", "--robot", "scara600"], low);
    assert_eq!(answers[0]["error"], "joint 3 would be at -0.300000 m, expected -0.200000 to 0.000000 m");
}

#[test]
fn a_robot_that_is_none_is_told() {
    for (arguments, status, message) in [
        (
            vec!["fk", "--robot", "r2d2"],
            2,
            "error: invalid value 'r2d2' for '--robot <NAME|F.urdf|F.toml>': expected ar2010, irb2400, ur5e, scara600, or a file .urdf or .toml\n\nFor more information, try '--help'.\n",
        ),
        (
            vec!["ik", "--robot", "no/arm.urdf"],
            1,
            "seamline: no/arm.urdf: cannot be read: No such file or directory (os error 2)\n",
        ),
        (
            vec!["ik", "--robot", "no/cell.toml"],
            1,
            "seamline: no/cell.toml: cannot be read: No such file or directory (os error 2)\n",
        ),
        (
            vec!["fk", "--tip", "tool0"],
            1,
            "seamline: --base and --tip name links of a URDF file, and --robot is none\n",
        ),
    ] {
        let output = run(&arguments, &json!({"id": 1}).to_string());
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(status), message));
        assert!(output.stdout.is_empty());
    }
}
