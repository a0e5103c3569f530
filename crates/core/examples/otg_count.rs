//! Calculations for an instruction counter:
//! `cargo build --release --example otg_count --features std`, then
//! `valgrind --tool=callgrind --toggle-collect='*count::calculations*' target/release/examples/otg_count`,
//! (position control of moving axes; with `rest` from rest to rest, with `velocity` velocity control),
//! and the instructions reported divided by 2000 are those of one calculation with 6 axes.

#[path = "../tests/otg_support/mod.rs"]
mod otg_support;

use otg_support::cases::{Distribution, random_input};
use otg_support::random::Random;
use seamline::otg::{Control, Input, State, Trajectory, calculate_into};

mod count {
    use super::{Input, Trajectory, calculate_into};

    /// What is counted, and nothing else.
    #[inline(never)]
    pub(super) fn calculations(inputs: &[Input<6>]) -> f64 {
        let mut trajectory = Trajectory::default();
        inputs
            .iter()
            .map(|i| calculate_into(i, &mut trajectory).map_or(0.0, |()| trajectory.duration()))
            .sum()
    }
}

fn main() {
    let kind = std::env::args().nth(1).unwrap_or_default();
    let mut random = Random(2026);
    let mut inputs = Vec::new();
    while inputs.len() < 2000 {
        let mut input: Input<6> = random_input(&mut random, Distribution::PeerTest);
        if input.limits.velocity_min == input.limits.velocity_max.map(|v| -v) {
            match kind.as_str() {
                "rest" => {
                    input.current = State::at_rest(input.current.position);
                    input.target = State::at_rest(input.target.position);
                }
                "velocity" => input.control = [Control::Velocity; 6],
                _ => {}
            }
            inputs.push(input);
        }
    }
    println!("sum of the durations: {}", count::calculations(&inputs));
}
