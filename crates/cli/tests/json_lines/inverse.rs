//! `fk`, then `ik`, then `fk` again: the pose one began with.

use serde_json::{Value, json};

use crate::program::{answers, lines, numbers};
use crate::random::Random;
use crate::robots::{BUILT_IN, apart, data, info, poses, random_q};

const POSES: usize = 200;

/// 200 random postures a robot, with a seed near each. Every solution reaches the pose and keeps the limits; a closed
/// form finds the posture itself among them.
#[test]
fn every_solution_reaches_its_pose() {
    let (arm, gantry, rounded) = (data("arc_arm.urdf"), data("gantry.urdf"), data("rounded.urdf"));
    for robot in BUILT_IN.into_iter().chain([arm.as_str(), gantry.as_str(), rounded.as_str()]) {
        let info = info(&[robot]);
        let closed = info["inverse"] == "closed form";
        let tolerance = match info["inverse"].as_str().unwrap() {
            "closed form" => 1e-12,
            "closed form and numeric" => 1e-11,
            // The solver's own tolerance.
            _ => 1.001e-6,
        };
        let mut random = Random::new(3);
        let qs: Vec<Vec<f64>> = (0..POSES).map(|_| random_q(&info, &mut random)).collect();
        let poses_wanted = poses(&[robot], &qs);
        let questions: Vec<Value> = poses_wanted
            .iter()
            .zip(&qs)
            .map(|(pose, q)| {
                let seed: Vec<f64> = q.iter().map(|q| q + random.between(-0.05, 0.05)).collect();
                let mut question = pose.clone();
                question["seed"] = json!(seed);
                question
            })
            .collect();
        let solved = answers(&["ik", "--robot", robot], &lines(&questions));
        assert_eq!(solved.len(), POSES);
        let mut reached = Vec::new();
        let mut wanted = Vec::new();
        for ((answer, pose), q) in solved.iter().zip(&poses_wanted).zip(&qs) {
            assert_eq!(answer["ok"], true, "{robot} at {q:?}: {}", answer["error"]);
            let solutions = answer["solutions"].as_array().unwrap();
            let nearest = &answer["nearest"];
            if closed {
                assert!(solutions.contains(nearest), "{robot}: {answer}");
                let off = numbers(nearest).iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off <= 0.2, "{robot}: {q:?} became {nearest}");
            }
            for solution in solutions.iter().chain([nearest]) {
                let solution = numbers(solution);
                for (q, joint) in solution.iter().zip(info["joints"].as_array().unwrap()) {
                    let (min, max) = (joint["position_min"].as_f64(), joint["position_max"].as_f64());
                    assert!(
                        min.is_none_or(|min| min <= *q) && max.is_none_or(|max| *q <= max),
                        "{robot}: {answer}"
                    );
                }
                reached.push(solution);
                wanted.push(pose);
            }
        }
        for (reached, wanted) in poses(&[robot], &reached).iter().zip(wanted) {
            let (metres, radians) = apart(reached, wanted);
            assert!(
                metres <= tolerance && radians <= tolerance,
                "{robot}: {metres} m, {radians} rad off {wanted}"
            );
        }
    }
}

/// Without a seed the joints near zero are looked for.
#[test]
fn a_missing_seed_is_zero() {
    let q = [0.4, -0.2, 0.3, 0.5, -0.6, 0.7];
    let pose = &poses(&["ar2010"], &[q.to_vec()])[0];
    let mut seeded = pose.clone();
    seeded["seed"] = json!([0, 0, 0, 0, 0, 0]);
    let both = answers(&["ik"], &lines(&[pose.clone(), seeded]));
    assert_eq!(both[0], both[1]);
    assert!(both[0]["solutions"].as_array().unwrap().len() >= 2);
}

/// Quaternions printed with six digits still name a pose.
#[test]
fn rounded_quaternions_are_taken() {
    let pose = r#"{"id":1,"position_m":[1.2,0.3,0.4],"quaternion_xyzw":[0.707107,0.0,0.707107,0.0]}"#;
    let answer = &answers(&["ik"], pose)[0];
    assert_eq!(answer["ok"], true);
    let reached = &poses(&["ar2010"], &[numbers(&answer["nearest"])])[0];
    let half = 0.5_f64.sqrt();
    let exact = json!({"position_m": [1.2, 0.3, 0.4], "quaternion_xyzw": [half, 0, half, 0]});
    let (metres, radians) = apart(reached, &exact);
    assert!(metres <= 1e-12 && radians <= 1e-12, "{metres} {radians}");
}
