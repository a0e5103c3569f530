//! The cell file as a whole: the default, what is laid over it, other robots, and files with mistakes.

use seamline::arc::ArcVoltage;
use seamline::geometry::Vector3;
use seamline::seam::Offset;

use super::*;

mod mistakes;
mod mutations;

fn parse(text: &str) -> Cell {
    Cell::parse(text, "cell.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn message(text: &str) -> String {
    Cell::parse(text, "cell.toml").map_or_else(|error| error.to_string(), |_| "accepted".to_owned())
}

#[test]
fn the_default_is_right_and_lies_over_itself() {
    let cell = Cell::default_cell().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(parse(DEFAULT_CELL_TOML), cell);
}

/// The figures of the arm's data sheet, in its own units.
#[test]
fn the_default_robot_is_the_data_sheets() {
    let cell = parse("");
    assert_eq!(cell.robot.model, RobotModel::BuiltIn(BuiltInRobot::Ar2010));
    let degrees = |value: fn(&Joint) -> f64| {
        cell.robot.joint_array::<6>(|joint| (value(joint).to_degrees() * 1e9).round() / 1e9).unwrap()
    };
    assert_eq!(degrees(|joint| joint.position_min), [-180.0, -105.0, -86.0, -150.0, -135.0, -210.0]);
    assert_eq!(degrees(|joint| joint.position_max), [180.0, 155.0, 160.0, 150.0, 90.0, 210.0]);
    assert_eq!(degrees(|joint| joint.velocity), [210.0, 210.0, 220.0, 435.0, 435.0, 700.0]);
    let pulses = [1341.380023, 1907.674052, 1592.888923, 1022.862207, 980.2392898, 454.754161];
    for (joint, pulses) in cell.robot.joints.iter().zip(pulses) {
        let one_degree = joint.position_from_pulses(pulses).to_degrees();
        assert!((one_degree - 1.0).abs() < 1e-14, "{}: {one_degree}", joint.name);
        assert!((joint.pulses_from_position(1f64.to_radians()) - pulses).abs() < 1e-11);
    }
    assert_eq!(cell.robot.joint_array::<7>(|joint| joint.home), None);
}

#[test]
fn the_default_torch_is_turned_22_degrees_back() {
    let cell = parse("");
    let tcp = cell.tool(0).unwrap().flange_from_tcp;
    assert_eq!(tcp.translation.vector, Vector3::new(-0.04383, 0.0, 0.45848));
    let (sin, cos) = (-22f64).to_radians().sin_cos();
    assert!((tcp.rotation * Vector3::z() - Vector3::new(sin, 0.0, cos)).norm() < 1e-15);
}

/// Each acceleration and jerk of the default is what its comment says, and each following error leaves room for the
/// simulated servo lag at full speed.
#[test]
fn the_default_limits_keep_their_stated_proportions() {
    let cell = parse("");
    for (index, joint) in cell.robot.joints.iter().enumerate() {
        let per_second = if index < 3 { 5.0 } else { 8.0 };
        assert!((joint.acceleration / joint.velocity - per_second).abs() < 1e-9);
        assert!((joint.jerk / joint.acceleration - 50.0).abs() < 1e-9);
        let lag_distance = joint.velocity * cell.simulation.servo_lag[index];
        assert!((1.45..1.55).contains(&(joint.following_error / lag_distance)), "{}", joint.name);
    }
}

/// Each value of the default file but those that name the robot's kind and the drive: changed in a user's file, it
/// changes the cell. So every key is read, and read into the right place at least of its own table.
#[test]
fn every_key_of_the_default_has_an_effect() {
    const FIXED: [&str; 4] = ["number", "model", "kind", "backend"];
    let default = parse("");
    let (mut header, mut tried) = (String::new(), 0);
    for line in DEFAULT_CELL_TOML.lines().filter(|line| !line.starts_with('#')) {
        if line.starts_with('[') {
            header = format!("{line}\n");
        }
        let Some((key, value)) = line.split_once(" = ") else { continue };
        if key == "number" {
            header = format!("{header}{line}\n");
        }
        if FIXED.contains(&key) {
            continue;
        }
        if key == "mean_readings" {
            header += "filter = \"mean\"\n";
        }
        if key == "prefilter" {
            header = format!("[[flexible_mode]]\nnumber = 1\nfrequency_hz = 6.0\ndamping = 0.0\n{header}");
        }
        let reference =
            if matches!(key, "mean_readings" | "prefilter") { parse(&header) } else { default.clone() };
        let effective = other_values(value).iter().any(|other| {
            Cell::parse(&format!("{header}{key} = {other}\n"), "cell.toml")
                .is_ok_and(|cell| cell != reference)
        });
        assert!(effective, "{header}{line}: no other value changes the cell");
        tried += 1;
    }
    assert_eq!(tried, 178);
}

/// Values of the same type to put in place of one in the default file.
fn other_values(value: &str) -> Vec<String> {
    let texts = [
        "other",
        "negative",
        "cm/min",
        "last_move",
        "triangle",
        "sine",
        "right",
        "mean",
        "taught_path",
        "on",
        "stop",
        "zv",
        "feedrate",
        "simulated",
        "127.0.0.1:7000",
    ];
    match value {
        "true" => vec!["false".into()],
        "false" => vec!["true".into()],
        text if text.starts_with('"') => texts.map(|text| format!("\"{text}\"")).into(),
        list if list.starts_with('[') => vec![list.replacen(']', "1]", 1)],
        number => {
            let number: f64 = number.parse().unwrap();
            [number * 0.99, number + 1.0, number + 0.1].map(|number| number.to_string()).into()
        }
    }
}

#[test]
fn a_file_gives_only_what_differs() {
    let default = parse("");
    let cell = parse(
        "[cycle]\nperiod_ms = 4\n[[tool]]\nnumber = 0\nz_mm = 470\n[[robot.joint]]\nnumber = 6\nvelocity_deg_s = 600",
    );
    let mut expected = default.clone();
    expected.cycle.period = 0.004;
    expected.tools[0].flange_from_tcp.translation.z = 0.47;
    expected.robot.joints[5].velocity = 600f64.to_radians();
    assert_eq!(cell, expected);
}

#[test]
fn new_numbers_are_added_in_order() {
    let frame = "y_mm = 0\nz_mm = -200\nrx_deg = 0\nry_deg = 0\nrz_deg = 90\n";
    let cell = parse(&format!(
        "[[user_frame]]\nnumber = 14\nx_mm = 1000\n{frame}[[user_frame]]\nnumber = 2\nname = \"low\"\nx_mm = 1\n{frame}"
    ));
    assert_eq!(cell.user_frames.iter().map(|frame| frame.number).collect::<Vec<_>>(), [2, 14]);
    assert_eq!(cell.user_frame(2).map(|frame| frame.name.as_str()), Some("low"));
    let corner = cell.user_frame(14).unwrap().base_from_user * nalgebra::Point3::new(1.0, 0.0, 0.0);
    assert!((corner - nalgebra::Point3::new(1.0, 1.0, -0.2)).norm() < 1e-15);
    assert!(cell.user_frame(3).is_none() && cell.arc_start(3).is_none() && cell.weave(9).is_none());
}

#[test]
fn one_of_two_alternatives_replaces_the_other() {
    let cell = parse("[[arc_start]]\nnumber = 1\nvoltage_v = 24.5\n[[weave]]\nnumber = 2\nwavelength_mm = 5");
    assert_eq!(cell.arc_start(1).map(|condition| condition.voltage), Some(ArcVoltage::Volts(24.5)));
    assert_eq!(cell.arc_start(2).map(|condition| condition.voltage), Some(ArcVoltage::Synergic(1.0)));
    assert_eq!(cell.weave(2).map(|weave| weave.rate), Some(WeaveRate::Wavelength(0.005)));
    assert_eq!(cell.weave(1).map(|weave| weave.rate), Some(WeaveRate::Frequency(3.0)));
}

#[test]
fn an_empty_list_drops_the_defaults_tables() {
    assert!(parse("weave = []\n").weaves.is_empty());
    let cell = parse("[[pass]]\nnumber = 2\nof = 1\nheight_mm = 3.0\n");
    let (second, third) = (cell.pass(2), cell.pass(3));
    assert_eq!((second.of, second.shift, second.file), (1, Offset::new(0.0, 0.003), None));
    assert_eq!((third.of, third.shift), (3, Offset::zeros()));
}

#[test]
fn speeds_of_jobs_are_in_the_cells_unit() {
    assert_eq!(parse("").job.speed_unit.to_si(10.0), 0.01);
    assert_eq!(parse("[job]\nspeed_unit = \"cm/min\"").job.speed_unit.to_si(60.0), 0.01);
    assert_eq!(parse("").job.position_levels, [0.0, 0.0005, 0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.01]);
}

#[test]
fn inputs_follow_their_scripts() {
    let text = "[[io.input]]\nnumber = 5\nvalue = true\n[[io.input]]\nnumber = 3\nvalue = false\ntoggle_at_s = [1.5, 2]";
    let io = parse(text).io;
    let at = |time| io.at(3, time);
    assert_eq!(
        [at(0.0), at(1.4999), at(1.5), at(1.9999), at(2.0)],
        [false, false, true, true, false].map(Some)
    );
    assert_eq!([io.at(5, 0.0), io.at(5, 1e9), io.at(4, 0.0)], [Some(true), Some(true), Some(false)]);
    let io = |policy| parse(&format!("[io]\nunscripted_input = \"{policy}\"")).io.at(1, 0.0);
    assert_eq!([io("on"), io("refuse")], [Some(true), None]);
}

#[test]
fn servo_lags_are_one_for_all_or_one_for_each() {
    assert_eq!(parse("").simulation.servo_lag, [0.015; 6]);
    let cell = parse("[simulation]\nservo_lag_ms = [1, 2, 3, 4, 5, 6]");
    assert_eq!(cell.simulation.servo_lag, [0.001, 0.002, 0.003, 0.004, 0.005, 0.006]);
}

/// The joint table of a robot of one's own.
fn joint(number: usize, kind: &str, unit: &str) -> String {
    format!(
        "[[robot.joint]]\nnumber = {number}\nname = \"J{number}\"\nkind = \"{kind}\"\nposition_min_{unit} = -100\n\
         position_max_{unit} = 100\nsoft_margin_{unit} = 0\nvelocity_{unit}_s = 100\nacceleration_{unit}_s2 = 500\n\
         jerk_{unit}_s3 = 25000\npulses_per_{unit} = 1000\npulse_direction = \"negative\"\n\
         following_error_{unit} = 5\nhome_{unit} = 10\n"
    )
}

fn joints(count: usize) -> String {
    (1..=count).map(|number| joint(number, "revolute", "deg")).collect()
}

#[test]
fn a_robot_by_its_dimensions() {
    let data = "a1_mm = 150\na2_mm = -200\nb_mm = 0\nc1_mm = 505\nc2_mm = 760\nc3_mm = 1082\nc4_mm = 100\n\
                offsets_deg = [0, 0, 0, 0, 0, 180]\nsigns = [1, 1, -1, -1, -1, -1]\n";
    let cell = parse(&format!("[robot]\nmodel = \"opw\"\n[robot.opw]\n{data}{}", joints(6)));
    assert_eq!(cell.robot.name, "opw");
    let RobotModel::Opw(opw) = cell.robot.model else { panic!("{:?}", cell.robot.model) };
    assert_eq!(
        [opw.a1, opw.a2, opw.b, opw.c1, opw.c2, opw.c3, opw.c4],
        [0.15, -0.2, 0.0, 0.505, 0.76, 1.082, 0.1]
    );
    assert_eq!(opw.signs, [1.0, 1.0, -1.0, -1.0, -1.0, -1.0]);
    assert_eq!(opw.offsets[5], std::f64::consts::PI);
    assert_eq!(
        message(&format!("[robot]\nmodel = \"opw\"\n[robot.opw]\n{data}{}", joints(5))),
        "cell.toml:13:1: robot.joint: found [[robot.joint]], expected 6 tables [[robot.joint]] for this model, not 5"
    );
}

#[test]
fn a_robot_by_its_dh_table_with_a_sliding_joint() {
    let row = |number, a, d| {
        format!(
            "[[robot.dh.row]]\nnumber = {number}\na_mm = {a}\nalpha_deg = 90\nd_mm = {d}\ntheta_deg = -90\n"
        )
    };
    let head = "[robot]\nname = \"gantry\"\nmodel = \"dh\"\n[robot.dh]\nconvention = \"modified\"\n";
    let text = format!(
        "{head}{}{}{}{}",
        row(2, 275, 10),
        row(1, 325, 0),
        joint(1, "revolute", "deg"),
        joint(2, "prismatic", "mm")
    );
    let robot = parse(&text).robot;
    assert_eq!(robot.name, "gantry");
    let RobotModel::Dh(table) = robot.model else { panic!("{:?}", robot.model) };
    assert_eq!(table.convention, DhConvention::Modified);
    let right = std::f64::consts::FRAC_PI_2;
    assert_eq!(table.rows[1], DhRow { a: 0.275, alpha: right, d: 0.01, theta: -right });
    let slide = &robot.joints[1];
    assert_eq!((slide.kind, slide.velocity, slide.home), (JointKind::Prismatic, 0.1, 0.01));
    assert_eq!(slide.pulses_per_unit, -1e6);
    assert_eq!(slide.position_from_pulses(-1000.0), 0.001);
    let wrong = text.replace("velocity_mm_s", "velocity_deg_s");
    assert!(
        message(&wrong).ends_with("robot.joint[2].velocity_deg_s: unknown key, did you mean velocity_mm_s?")
    );
}

#[test]
fn a_urdf_beside_the_cell_file() {
    let text = format!(
        "[robot]\nmodel = \"urdf\"\n[robot.urdf]\npath = \"arm.urdf\"\ntip_link = \"tool0\"\n{}",
        joints(7)
    );
    let cell = Cell::parse(&text, "cells/my/cell.toml").unwrap();
    let RobotModel::Urdf(source) = cell.robot.model else { panic!("{:?}", cell.robot.model) };
    assert_eq!(source.path, Path::new("cells/my/arm.urdf"));
    assert_eq!((source.base_link, source.tip_link.as_deref()), (None, Some("tool0")));
    assert_eq!(cell.robot.joints.len(), 7);
}

/// The examples in the default file's comments, taken out of them, are right; a robot's with as many joints as it has.
#[test]
fn the_examples_in_the_comments_are_right() {
    let lines = DEFAULT_CELL_TOML.lines().map(|line| line.strip_prefix("#     "));
    let (mut examples, mut example) = (0, String::new());
    for line in lines {
        match line {
            Some(line) => example += &format!("{line}\n"),
            None if !example.is_empty() => {
                let own_joints =
                    ["opw", "dh", "urdf"].iter().any(|kind| example.contains(&format!("model = \"{kind}\"")));
                let count = if example.contains("opw") { 6 } else { 1 };
                parse(&if own_joints { example + &joints(count) } else { example });
                (examples, example) = (examples + 1, String::new());
            }
            None => {}
        }
    }
    // The first example has a blank line in it and counts as two.
    assert_eq!(examples, 11);
}

#[test]
fn files_are_loaded_or_refused_with_their_place() {
    let error = Cell::load(Path::new("no/such/cell.toml")).unwrap_err().to_string();
    assert!(error.starts_with("no/such/cell.toml: cannot be read: "), "{error}");

    let path = std::env::temp_dir().join(format!("seamline-cell-{}.toml", std::process::id()));
    std::fs::write(&path, "\u{FEFF}[cycle]\r\nperiod_ms = 2\r\n").unwrap();
    let good = Cell::load(&path);
    std::fs::write(&path, b"[cycle]\n# gr\xF6\xDFer\nperiod_ms = 2\n").unwrap();
    let latin = Cell::load(&path);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(good.map(|cell| cell.cycle.period), Ok(0.002));
    let expected = format!("{}:2:5: not TOML: a byte that is not UTF-8", path.display());
    assert_eq!(latin.map_err(|error| error.to_string()), Err(expected));
}
