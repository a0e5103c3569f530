//! A straight line at 1 kHz with the core library alone: generator, path, inverse kinematics.
//!
//! `cargo run -p seamline --example line` prints the joints every 100 ms.

#![allow(clippy::print_stdout, clippy::expect_used, reason = "an example, not a controller")]

use seamline::geometry::Pose;
use seamline::kinematics::{Kinematics, models};
use seamline::otg::{Input, Limits, State, calculate};
use seamline::path::Path;

fn main() {
    let arm = models::ar2010();
    let mut joints = [0.0, 0.2, -0.2, 0.0, -1.2, 0.0];
    let start = arm.forward(&joints);
    let end = Pose::translation(0.0, 0.25, -0.1) * start;
    let path = Path::line(&start, &end);

    // One scalar motion along the line: 0.3 m/s, 3 m/s², 60 m/s³, from rest to rest.
    let limits = Limits::symmetric([0.3], [3.0], [60.0]);
    let motion = Input::new(State::at_rest([0.0]), State::at_rest([path.length()]), limits);
    let motion = calculate(&motion).expect("the numbers above are valid");

    for cycle in 0..=(motion.duration() * 1e3) as u32 {
        let s = motion.at_time(f64::from(cycle) * 1e-3).position[0];
        joints = arm.inverse_nearest(&path.pose(s), &joints).expect("the line is within reach");
        if cycle % 100 == 0 {
            println!("{:.1} s  s = {:.4} m  joints = {joints:.4?} rad", f64::from(cycle) * 1e-3, s);
        }
    }
}
