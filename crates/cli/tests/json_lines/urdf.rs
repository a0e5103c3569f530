//! URDF files: chains that are read, and files that are refused.

use serde_json::json;

use crate::program::{run, stderr};
use crate::robots::{apart, assert_same_arm, data, info, poses, scratch};

/// An arm in frames of its own is the built-in one.
#[test]
fn the_arm_is_the_one_described() {
    let arm = data("arc_arm.urdf");
    assert_same_arm(&["ar2010"], &[&arm, "--base", "robot_frame"], 1e-12);
    let whole = info(&[&arm]);
    assert_eq!((&whole["robot"], &whole["inverse"]), (&json!("arc_arm"), &json!("closed form")));
    // From the file's root, the floor, and to other links.
    let q = vec![0.0; 6];
    for (tip, position) in [("tool0", [1.332, 0.0, 1.465]), ("spindle", [1.282, 0.0, 1.465])] {
        let found = &poses(&[&arm, "--tip", tip], std::slice::from_ref(&q))[0];
        let turn = found["quaternion_xyzw"].clone();
        let (metres, _) = apart(found, &json!({"position_m": position, "quaternion_xyzw": turn}));
        assert!(metres <= 1e-12, "{found}");
    }
    let part = info(&[&arm, "--base", "upper_arm", "--tip", "wrist"]);
    assert_eq!(part["joints"].as_array().unwrap().len(), 3);
    assert_eq!((&part["inverse"], &part["joints"][2]["name"]), (&json!("numeric"), &json!("B")));
    // Angles of few digits.
    let rounded = data("rounded.urdf");
    assert_eq!(info(&[&rounded])["inverse"], "closed form and numeric");
    assert_same_arm(&[&arm], &[&rounded], 1e-4);
}

/// Slides, joints without limits, speeds that are not given.
#[test]
fn a_gantry_is_read() {
    let gantry = data("gantry.urdf");
    let info = info(&[&gantry]);
    assert_eq!(info["inverse"], "numeric");
    let joint = |index: usize| info["joints"][index].clone();
    assert_eq!(
        joint(0),
        json!({"name": "x", "kind": "prismatic", "position_min": 0.0, "position_max": 4.0, "velocity_max": 1.0})
    );
    assert_eq!(
        joint(3),
        json!({"name": "a", "kind": "revolute", "position_min": null, "position_max": null, "velocity_max": null})
    );
    assert_eq!(joint(4)["velocity_max"], json!(null));
    // Hanging down: x along x, z down, and turned about the vertical by a + c, seen from below.
    let found = &poses(&[&gantry], &[vec![1.0, 0.5, 0.25, 0.3, 0.0, -0.3]])[0];
    let (reach, (sin, cos)) = (0.15, 0.3_f64.sin_cos());
    let expected = json!({
        "position_m": [1.0 + reach * cos, 0.6 - reach * sin, 2.5 - 0.25 - 0.4],
        "quaternion_xyzw": [1, 0, 0, 0],
    });
    let (metres, radians) = apart(found, &expected);
    assert!(metres <= 1e-12 && radians <= 1e-12, "{found}");
}

#[test]
fn files_that_are_no_arm_are_told() {
    let arm = |joints: &str| {
        let links: String = ["a", "b", "c", "d"].map(|name| format!("<link name=\"{name}\"/>")).concat();
        format!("<robot name=\"r\">{links}{joints}</robot>")
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, rest: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{rest}</joint>"
        )
    };
    let limit = "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"0\"/>";
    let turning = |name: &str, parent: &str, child: &str| joint(name, "revolute", parent, child, limit);
    let line = |last: &str| arm(&(turning("1", "a", "b") + &turning("2", "b", "c") + last));
    let none: [&str; 0] = [];
    let table: Vec<(String, Vec<&str>, &str)> = vec![
        ("<sdf/".to_owned(), none.to_vec(), "not URDF: No elements found"),
        (
            line(&joint("3", "planar", "c", "d", limit)),
            vec![],
            "joint 3: type planar, expected revolute, continuous, prismatic or fixed",
        ),
        (
            line(&joint("3", "revolute", "c", "d", &format!("{limit}<mimic joint=\"2\"/>"))),
            vec![],
            "joint 3: mimics joint 2, expected joints that move independently",
        ),
        (
            line(&joint("3", "revolute", "c", "d", "")),
            vec![],
            "joint 3: limits from 0 to 0, expected lower before upper",
        ),
        (
            line(&joint("3", "prismatic", "c", "d", "<limit lower=\"1\" upper=\"-1\" velocity=\"1\"/>")),
            vec![],
            "joint 3: limits from 1 to -1, expected lower before upper",
        ),
        (
            line(&joint("3", "continuous", "c", "d", "<limit velocity=\"-1\"/>")),
            vec![],
            "joint 3: velocity limit -1, expected a positive one, or 0 for none",
        ),
        (
            line(&joint("3", "revolute", "c", "d", &format!("{limit}<axis xyz=\"0 0 0\"/>"))),
            vec![],
            "joint 3: axis [0.0, 0.0, 0.0], expected a direction",
        ),
        (
            line(&joint("3", "revolute", "c", "d", &format!("{limit}<origin xyz=\"0 0 nan\"/>"))),
            vec![],
            "joint 3: origin [0.0, 0.0, NaN] [0.0, 0.0, 0.0], expected finite numbers",
        ),
        (line(&turning("3", "c", "e")), vec![], "link e: not in the file, expected one of a, b, c, d"),
        (
            line(&turning("3", "c", "d")),
            vec!["--tip", "x"],
            "link x: not in the file, expected one of a, b, c, d",
        ),
        (line(&turning("3", "c", "d")), vec!["--base", "d", "--tip", "b"], "link b: does not hang on link d"),
        (
            line(&turning("3", "c", "d")),
            vec!["--base", "d"],
            "from link d to link d: found 0 moving joints, expected 1 to 7",
        ),
        (line(""), vec![], "base: found 2 roots (a, d), expected one, or a base link by name"),
        (
            arm(&(turning("1", "a", "b") + &turning("2", "a", "c") + &turning("3", "c", "b"))),
            vec!["--base", "a"],
            "link b: the child of joints 1 and 3, expected a tree",
        ),
        (
            arm(&(turning("1", "a", "b") + &turning("2", "b", "c") + &turning("3", "b", "d"))),
            vec![],
            "tip: found 2 ends (c, d), expected one, or a tip link by name",
        ),
        (
            arm(&(turning("1", "b", "c") + &turning("2", "c", "d") + &turning("3", "d", "b"))),
            vec!["--base", "a", "--tip", "d"],
            "link d: does not hang on link a",
        ),
    ];
    for (index, (content, links, message)) in table.iter().enumerate() {
        let file = scratch(&format!("bad_{index}.urdf"), content);
        let output = run(&[&["fk", "--info", "--robot", &file], &links[..]].concat(), "");
        assert_eq!(output.status.code(), Some(1), "{content}");
        assert_eq!(stderr(&output), format!("seamline: {file}: {message}\n"), "{content}");
        assert!(output.stdout.is_empty());
    }
    let links: String = (0..=8).map(|link| format!("<link name=\"{link}\"/>")).collect();
    let joints: String = (0..8)
        .map(|link: usize| turning(&format!("j{link}"), &link.to_string(), &(link + 1).to_string()))
        .collect();
    let file = scratch("long.urdf", &format!("<robot name=\"long\">{links}{joints}</robot>"));
    let output = run(&["fk", "--robot", &file], "");
    let message = "from link 0 to link 8: found 8 moving joints, expected 1 to 7";
    assert_eq!(stderr(&output), format!("seamline: {file}: {message}\n"));
}
