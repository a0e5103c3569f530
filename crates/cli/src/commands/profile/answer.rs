//! The motion in numbers.

use seamline::otg;
use seamline::timed::Activity;
use serde::Serialize;

use super::Arguments;
use super::run::{self, Run};

#[derive(Serialize)]
pub(super) struct Answer {
    from_mm: f64,
    to_mm: f64,
    time_s: f64,
    n: f64,
    velocity_mm_s: f64,
    acceleration_mm_s2: f64,
    jerk_mm_s3: f64,
    switch_times_s: [f64; 7],
    end_s: f64,
    retarget: Option<Retarget>,
    samples: Vec<Sample>,
}

#[derive(Serialize)]
struct Retarget {
    mode: &'static str,
    at_s: f64,
    to_mm: f64,
    r#while: &'static str,
    from: Sample,
    arrival_s: f64,
    limits: Limits,
    velocity_jump_mm_s: f64,
    acceleration_jump_mm_s2: f64,
}

#[derive(Serialize)]
struct Limits {
    velocity_mm_s: f64,
    acceleration_mm_s2: f64,
    jerk_mm_s3: f64,
}

#[derive(Serialize)]
struct Sample {
    time_s: f64,
    activity: &'static str,
    position_mm: f64,
    velocity_mm_s: f64,
    acceleration_mm_s2: f64,
    jerk_mm_s3: f64,
}

impl Answer {
    pub(super) fn new(arguments: &Arguments, run: &Run) -> Self {
        let ([velocity_mm_s], [acceleration_mm_s2], [jerk_mm_s3]) =
            (run.profile.velocity(), run.profile.acceleration(), run.profile.jerk());
        Self {
            from_mm: arguments.from_mm,
            to_mm: arguments.to_mm,
            time_s: arguments.time,
            n: arguments.n,
            velocity_mm_s,
            acceleration_mm_s2,
            jerk_mm_s3,
            switch_times_s: run.profile.switch_times(),
            end_s: run.end,
            retarget: run.retarget.as_ref().map(|retarget| Retarget::new(arguments, run, retarget)),
            samples: run.instants(arguments.samples).map(|time| Sample::new(time, run.at(time))).collect(),
        }
    }
}

impl Retarget {
    fn new(arguments: &Arguments, run: &Run, retarget: &run::Retarget) -> Self {
        let before = run.before(retarget);
        let planned = &retarget.planned;
        let ([velocity_jump_mm_s], [acceleration_jump_mm_s2]) =
            (planned.velocity_jump, planned.acceleration_jump);
        let otg::Limits {
            velocity_max: [velocity_mm_s],
            acceleration_max: [acceleration_mm_s2],
            jerk_max: [jerk_mm_s3],
            ..
        } = planned.limits;
        Self {
            mode: arguments.mode.name(),
            at_s: retarget.at,
            to_mm: retarget.target,
            r#while: before.0.name(),
            from: Sample::new(retarget.at, before),
            arrival_s: run.end,
            limits: Limits { velocity_mm_s, acceleration_mm_s2, jerk_mm_s3 },
            velocity_jump_mm_s,
            acceleration_jump_mm_s2,
        }
    }
}

impl Sample {
    fn new(time_s: f64, (activity, sample): (Activity, otg::Sample<1>)) -> Self {
        let otg::Sample {
            position: [position_mm],
            velocity: [velocity_mm_s],
            acceleration: [acceleration_mm_s2],
            jerk: [jerk_mm_s3],
        } = sample;
        Self { time_s, activity: activity.name(), position_mm, velocity_mm_s, acceleration_mm_s2, jerk_mm_s3 }
    }
}
