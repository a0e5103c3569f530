//! The robots of `fk` and `ik`: forward kinematics of each against what its source says.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::program::{answer, answers, lines, numbers, run};
use crate::random::Random;

pub(crate) const BUILT_IN: [&str; 4] = ["ar2010", "irb2400", "ur5e", "scara600"];

/// A file beside the tests.
pub(crate) fn data(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "tests", "json_lines", "data", name].iter().collect();
    path.to_str().unwrap().to_owned()
}

/// A file that a test writes.
pub(crate) fn scratch(name: &str, content: &str) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).unwrap();
    path.to_str().unwrap().to_owned()
}

/// What `fk --info` says.
pub(crate) fn info(robot: &[&str]) -> Value {
    answer(&[&["fk", "--info", "--robot"], robot].concat(), "")
}

/// Random joint positions within the limits, at most a turn from zero.
pub(crate) fn random_q(info: &Value, random: &mut Random) -> Vec<f64> {
    let bound = |value: &Value, none: f64| value.as_f64().unwrap_or(none).clamp(-6.0, 6.0);
    let joints = info["joints"].as_array().unwrap();
    joints
        .iter()
        .map(|joint| random.between(bound(&joint["position_min"], -6.0), bound(&joint["position_max"], 6.0)))
        .collect()
}

/// Poses at random joint positions.
pub(crate) fn poses(robot: &[&str], qs: &[Vec<f64>]) -> Vec<Value> {
    let questions: Vec<Value> = qs.iter().enumerate().map(|(id, q)| json!({"id": id, "q": q})).collect();
    let answers = answers(&[&["fk", "--robot"], robot].concat(), &lines(&questions));
    assert_eq!(answers.len(), qs.len());
    answers
}

pub(crate) fn distance(a: &Value, b: &Value) -> f64 {
    let square = |(a, b): (f64, f64)| (a - b) * (a - b);
    numbers(a).into_iter().zip(numbers(b)).map(square).sum::<f64>().sqrt()
}

/// Positions apart in metres, and orientations in radians (q and −q are one).
pub(crate) fn apart(a: &Value, b: &Value) -> (f64, f64) {
    let (p, q) = (numbers(&a["quaternion_xyzw"]), numbers(&b["quaternion_xyzw"]));
    let sign = p.iter().zip(&q).map(|(p, q)| p * q).sum::<f64>().signum();
    let half_sine = p.iter().zip(&q).map(|(p, q)| (p - sign * q).powi(2)).sum::<f64>().sqrt();
    (distance(&a["position_m"], &b["position_m"]), 2.0 * half_sine)
}

/// Two robots that are one: the same poses and Jacobians at 50 random joint positions.
pub(crate) fn assert_same_arm(a: &[&str], b: &[&str], tolerance: f64) {
    let (a_info, b_info) = (info(a), info(b));
    assert_eq!(a_info["joints"].as_array().unwrap().len(), b_info["joints"].as_array().unwrap().len());
    let mut random = Random::new(5);
    let qs: Vec<Vec<f64>> = (0..50).map(|_| random_q(&a_info, &mut random)).collect();
    for (a, b) in poses(a, &qs).iter().zip(&poses(b, &qs)) {
        let (metres, radians) = apart(a, b);
        assert!(metres <= tolerance && radians <= tolerance, "{a} {b}");
        for (a, b) in a["jacobian"].as_array().unwrap().iter().zip(b["jacobian"].as_array().unwrap()) {
            assert!(distance(a, b) <= tolerance, "{a} {b}");
        }
    }
}

/// Poses at zero, from the makers' drawings.
#[test]
fn built_in_robots_stand_where_their_makers_say() {
    let half = 0.5_f64.sqrt();
    for (robot, position, quaternion) in [
        ("ar2010", [1.332, 0.0, 0.960], [half, 0.0, half, 0.0]),
        ("irb2400", [0.940, 0.0, 1.455], [0.0, half, 0.0, half]),
        ("ur5e", [-0.8172, -0.2329, 0.0628], [half, 0.0, 0.0, half]),
        ("scara600", [0.6, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]),
    ] {
        let zero = vec![0.0; info(&[robot])["joints"].as_array().unwrap().len()];
        let expected = json!({"position_m": position, "quaternion_xyzw": quaternion});
        let found = &poses(&[robot], &[zero])[0];
        let (metres, radians) = apart(found, &expected);
        assert!(metres <= 1e-12 && radians <= 1e-12, "{robot}: {found}");
    }
}

#[test]
fn info_lists_joints_and_limits() {
    let text = String::from_utf8(run(&["fk", "--info", "--robot", "scara600"], "").stdout).unwrap();
    let info: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(info["robot"], "scara600");
    assert_eq!(info["inverse"], "closed form");
    let joint = &info["joints"][2];
    let expected = json!({"name": "3", "kind": "prismatic", "position_min": -0.2, "position_max": 0.0, "velocity_max": 1.0});
    assert_eq!(*joint, expected);
    let names: Vec<Value> = self::info(&["ar2010"])["joints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|joint| joint["name"].clone())
        .collect();
    assert_eq!(names, ["S", "L", "U", "R", "B", "T"]);
    for (robot, inverse) in
        [("ar2010", "closed form"), ("irb2400", "closed form"), ("scara600", "closed form")]
    {
        assert_eq!(self::info(&[robot])["inverse"], inverse);
    }
}

/// The Jacobian against differences of poses, 20 random postures a robot: it has 6 rows, linear ones first, in the
/// base frame.
#[test]
fn jacobians_are_derivatives() {
    let gantry = data("gantry.urdf");
    for robot in BUILT_IN.into_iter().chain([gantry.as_str()]) {
        let info = info(&[robot]);
        let mut random = Random::new(7);
        for _ in 0..20 {
            let q = random_q(&info, &mut random);
            let step = 1e-6;
            let mut qs = vec![q.clone()];
            for axis in 0..q.len() {
                for sign in [-1.0, 1.0] {
                    let mut moved = q.clone();
                    moved[axis] += sign * step;
                    qs.push(moved);
                }
            }
            let poses = poses(&[robot], &qs);
            let jacobian = poses[0]["jacobian"].as_array().unwrap();
            assert_eq!(jacobian.len(), 6);
            for axis in 0..q.len() {
                let (before, after) = (&poses[1 + 2 * axis], &poses[2 + 2 * axis]);
                let difference = twist(before, after).map(|x| x / (2.0 * step));
                for (row, difference) in jacobian.iter().zip(difference) {
                    let row = numbers(row);
                    assert_eq!(row.len(), q.len());
                    assert!(
                        (row[axis] - difference).abs() <= 1e-8,
                        "{robot}: {} for {difference}",
                        row[axis]
                    );
                }
            }
        }
    }
}

/// Translation and small rotation from one pose to another, in the base frame: 2·vec(q₂ q₁*).
fn twist(from: &Value, to: &Value) -> [f64; 6] {
    let (p, r) = (numbers(&from["position_m"]), numbers(&to["position_m"]));
    let (a, b) = (numbers(&from["quaternion_xyzw"]), numbers(&to["quaternion_xyzw"]));
    let dot: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let (ax, ay, az, aw) = (a[0], a[1], a[2], a[3]);
    let (bx, by, bz, bw) = (b[0], b[1], b[2], b[3]);
    let turn = [
        -bw * ax + bx * aw - by * az + bz * ay,
        -bw * ay + bx * az + by * aw - bz * ax,
        -bw * az - bx * ay + by * ax + bz * aw,
    ]
    .map(|x| 2.0 * x * dot.signum());
    [r[0] - p[0], r[1] - p[1], r[2] - p[2], turn[0], turn[1], turn[2]]
}

fn joint_tables(count: usize, extra: &str) -> String {
    (1..=count)
        .map(|number| {
            format!(
                "[[robot.joint]]\nnumber = {number}\nname = \"J{number}\"\nposition_min_deg = -170\n\
                 position_max_deg = 170\nsoft_margin_deg = 1\nvelocity_deg_s = 180\nacceleration_deg_s2 = 900\n\
                 jerk_deg_s3 = 9000\npulses_per_deg = 1000\npulse_direction = \"positive\"\n\
                 following_error_deg = 1\nhome_deg = 0\n{extra}"
            )
        })
        .collect()
}

/// Cell files: the default one, and the built-in robots written as dimensions, table and URDF.
#[test]
fn cell_files_describe_the_same_arms() {
    let printed = String::from_utf8(run(&["cell", "--print"], "").stdout).unwrap();
    let default = scratch("default_cell.toml", &printed);
    assert_same_arm(&["ar2010"], &[&default], 1e-13);
    // IRB 2400 by its dimensions.
    let opw = "[robot]\nmodel = \"opw\"\n[robot.opw]\na1_mm = 100\na2_mm = -135\nb_mm = 0\nc1_mm = 615\nc2_mm = 705\n\
        c3_mm = 755\nc4_mm = 85\noffsets_deg = [0, 0, -90, 0, 0, 0]\nsigns = [1, 1, 1, 1, 1, 1]\n";
    let opw = scratch("opw_cell.toml", &format!("{opw}{}", joint_tables(6, "")));
    assert_same_arm(&["irb2400"], &[&opw], 1e-12);
    // UR5e by its table.
    let rows =
        [(0, 90, 162.5), (-425, 0, 0.0), (-3922, 0, 0.0), (0, 90, 133.3), (0, -90, 99.7), (0, 0, 99.6)];
    let mut dh = "[robot]\nmodel = \"dh\"\n[robot.dh]\nconvention = \"standard\"\n".to_owned();
    for (index, (a, alpha, d)) in rows.into_iter().enumerate() {
        let a = if a == -3922 { -392.2 } else { f64::from(a) };
        dh += &format!(
            "[[robot.dh.row]]\nnumber = {}\na_mm = {a:?}\nalpha_deg = {alpha}\nd_mm = {d:?}\ntheta_deg = 0\n",
            index + 1
        );
    }
    let dh = scratch("dh_cell.toml", &format!("{dh}{}", joint_tables(6, "")));
    assert_same_arm(&["ur5e"], &[&dh], 1e-12);
    // A URDF file, named from the cell file's own folder, within the cell's soft limits.
    std::fs::copy(data("arc_arm.urdf"), PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("arm_of_cell.urdf"))
        .unwrap();
    let urdf =
        "[robot]\nmodel = \"urdf\"\n[robot.urdf]\npath = \"arm_of_cell.urdf\"\nbase_link = \"robot_frame\"\n";
    let urdf = scratch("urdf_cell.toml", &format!("{urdf}{}", joint_tables(6, "")));
    assert_same_arm(&["ar2010"], &[&urdf], 1e-12);
    let info = info(&[&urdf]);
    assert_eq!(info["inverse"], "closed form");
    assert!((info["joints"][0]["position_max"].as_f64().unwrap() - 169_f64.to_radians()).abs() <= 1e-15);
    assert_eq!(info["joints"][0]["name"], "J1");
}

#[test]
fn a_cell_that_does_not_fit_its_model_is_told() {
    let urdf = |joints: &str| {
        std::fs::copy(data("arc_arm.urdf"), PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("misfit.urdf"))
            .unwrap();
        let cell = format!("[robot]\nmodel = \"urdf\"\n[robot.urdf]\npath = \"misfit.urdf\"\n{joints}");
        scratch("misfit_cell.toml", &cell)
    };
    let message = |cell: &str| crate::program::stderr(&run(&["fk", "--robot", cell], ""));
    let five = urdf(&joint_tables(5, ""));
    assert_eq!(message(&five), format!("seamline: {five}: robot: found 6 joints, expected 5\n"));
    let sliding =
        joint_tables(6, "kind = \"prismatic\"\n").replace("_deg_s3", "_mm_s3").replace("_deg_s2", "_mm_s2");
    let sliding =
        urdf(&sliding.replace("_deg_s ", "_mm_s ").replace("_per_deg", "_per_mm").replace("_deg ", "_mm "));
    assert_eq!(
        message(&sliding),
        format!(
            "seamline: {sliding}: robot: joint J1: the model's is revolute, the cell file's is prismatic\n"
        )
    );
}

#[test]
fn bench_tells_times() {
    let q = "{\"q\": [0, 0.3, -0.2, 0, 0.5, 0]}\n".repeat(20);
    let pose = run(&["fk"], &q).stdout;
    for (command, input, other) in
        [("fk", q.as_str(), "jacobian"), ("ik", std::str::from_utf8(&pose).unwrap(), "nearest")]
    {
        let measured = answer(&[command, "--bench"], input);
        assert_eq!((&measured["cases"], &measured["dofs"]), (&json!(20), &json!(6)));
        for times in [&measured, &measured[other]] {
            let time = |name: &str| times[name].as_f64().unwrap();
            assert!(
                time("mean_ns") > 0.0
                    && time("mean_ns") <= time("max_ns")
                    && time("p99_ns") <= time("max_ns")
            );
        }
    }
}
