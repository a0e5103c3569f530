//! What the answers of `otg` say is one motion: the pieces, integrated by what constant jerk, acceleration or velocity
//! means, lead through the samples and end at the target.

use serde_json::{Value, json};

use crate::program::{answers, lines, numbers};
use crate::random::Random;

const CASES: usize = 600;
const FRACTIONS: [f64; 7] = [0.0, 0.1, 0.3, 0.5, 0.77, 0.999, 1.0];

/// An axis at one instant.
#[derive(Debug, Clone, Copy)]
struct Point {
    p: f64,
    v: f64,
    a: f64,
}

/// The lowest derivative that may jump.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Jumps {
    Velocity,
    Acceleration,
    Jerk,
}

/// Goes through the pieces for a time. What is left of it afterwards the axis goes on at its last acceleration.
fn integrate(pieces: &[Value], start: Point, time: f64) -> (Point, Jumps) {
    let (mut now, mut rest, mut jumps) = (start, time, Jumps::Jerk);
    for piece in pieces {
        let duration = piece["duration"].as_f64().unwrap();
        assert!(duration > 0.0, "{piece}");
        let t = rest.min(duration);
        rest -= t;
        let Point { p, v, a } = now;
        if let Some(jerk) = piece["jerk"].as_f64() {
            now.p = p + v * t + a * t * t / 2.0 + jerk * t * t * t / 6.0;
            now.v = v + a * t + jerk * t * t / 2.0;
            now.a = a + jerk * t;
        } else if let Some(acceleration) = piece["acceleration"].as_f64() {
            jumps = Jumps::Acceleration;
            now.p = p + v * t + acceleration * t * t / 2.0;
            now.v = v + acceleration * t;
        } else {
            jumps = Jumps::Velocity;
            now.p = p + piece["velocity"].as_f64().unwrap() * t;
        }
    }
    (now, jumps)
}

/// A random question. Limits are on a logarithmic scale, some infinite; many axes start outside them.
fn question(random: &mut Random, id: usize) -> Value {
    let axes = 1 + id % 16;
    let mut list = |member: &mut dyn FnMut(&mut Random) -> Value| -> Vec<Value> {
        (0..axes).map(|_| member(random)).collect()
    };
    let mut limit = |r: &mut Random| json!(10_f64.powf(r.between(-1.0, 1.5)));
    let velocity_max = list(&mut limit);
    let velocity_min = list(&mut |r| json!(-(10_f64.powf(r.between(-1.0, 1.5)))));
    let mut acceleration_max = list(&mut limit);
    let mut jerk_max = list(&mut limit);
    let controls = list(&mut |r| json!(if r.happens(0.2) { "velocity" } else { "position" }));
    let position = list(&mut |r| json!(r.between(-3.0, 3.0)));
    let start = list(&mut |r| json!(r.between(-1.0, 1.0)));
    let target_position = list(&mut |r| json!(r.between(-3.0, 3.0)));
    let mut target_velocity = list(&mut |r| json!(if r.happens(0.5) { 0.0 } else { r.between(-0.1, 0.1) }));
    for axis in 0..axes {
        if random.happens(0.2) {
            jerk_max[axis] = Value::Null;
            if random.happens(0.3) && controls[axis] == "position" {
                acceleration_max[axis] = Value::Null;
                target_velocity[axis] = json!(0.0);
            }
        }
    }
    let modes = ["none", "time", "time_if_necessary", "phase"];
    json!({
        "id": id,
        "control": controls,
        "synchronization": modes[random.index(modes.len())],
        "current": {"position": position, "velocity": start, "acceleration": start},
        "target": {"position": target_position, "velocity": target_velocity},
        "limits": {
            "velocity_max": velocity_max, "velocity_min": velocity_min,
            "acceleration_max": acceleration_max, "jerk_max": jerk_max,
        },
        "sample": FRACTIONS,
        "profiles": true,
    })
}

fn close(found: f64, expected: f64, scale: f64, what: &str, question: &Value) {
    let off = (found - expected).abs();
    assert!(off <= 1e-9 * scale.max(1.0), "{what}: {found} for {expected} in {question}");
}

#[test]
fn pieces_lead_through_samples_to_the_target() {
    let mut random = Random::new(11);
    let questions: Vec<Value> = (0..CASES).map(|id| question(&mut random, id)).collect();
    let answers = answers(&["otg"], &lines(&questions));
    assert_eq!(answers.len(), CASES);
    let mut seen = [0; 3];
    for (question, answer) in questions.iter().zip(&answers) {
        assert_eq!(answer["id"], question["id"]);
        assert_eq!(answer["ok"], true, "{} in {question}", answer["error"]);
        let duration = answer["duration"].as_f64().unwrap();
        let axes = answer["profiles"].as_array().unwrap();
        assert_eq!(axes.len(), question["limits"]["jerk_max"].as_array().unwrap().len());
        for (axis, pieces) in axes.iter().enumerate() {
            let pieces = pieces.as_array().unwrap();
            let of = |state: &Value, name: &str| state[name][axis].as_f64().unwrap();
            let point = |state: &Value| Point {
                p: of(state, "position"),
                v: of(state, "velocity"),
                a: of(state, "acceleration"),
            };
            let start = point(&question["current"]);
            let own: f64 = pieces.iter().map(|piece| piece["duration"].as_f64().unwrap()).sum();
            assert!(own <= duration * (1.0 + 1e-12), "{question}");
            assert!(numbers(&answer["duration_min_per_axis"])[axis] <= own * (1.0 + 1e-12), "{question}");
            let (end, jumps) = integrate(pieces, start, own);
            seen[jumps as usize] += 1;
            // Errors of rounding grow with the distances on the way.
            let scale =
                pieces.iter().map(|piece| piece["jerk"].as_f64().unwrap_or(0.0).abs()).fold(1.0, f64::max)
                    * own.max(1.0).powi(3);
            for (sample, fraction) in answer["samples"].as_array().unwrap().iter().zip(FRACTIONS) {
                let time = sample["time"].as_f64().unwrap();
                assert_eq!(time, fraction * duration);
                if time > own {
                    continue;
                }
                let (here, _) = integrate(pieces, start, time);
                let sample = point(sample);
                close(sample.p, here.p, scale, "position", question);
                if jumps != Jumps::Velocity {
                    close(sample.v, here.v, scale, "velocity", question);
                }
                if jumps == Jumps::Jerk {
                    close(sample.a, here.a, scale, "acceleration", question);
                }
            }
            if question["control"][axis] == "position" {
                close(end.p, of(&question["target"], "position"), scale, "final position", question);
            }
            if jumps != Jumps::Velocity {
                close(end.v, of(&question["target"], "velocity"), scale, "final velocity", question);
            }
            if jumps == Jumps::Jerk {
                close(end.a, 0.0, scale, "final acceleration", question);
            }
        }
    }
    assert!(seen.iter().all(|&axes| axes > 100), "profiles of first, second and third order: {seen:?}");
}
