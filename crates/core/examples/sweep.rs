//! A sweep over random problems that can be stopped and resumed: every trajectory is integrated anew and judged, and those of one axis must
//! take as long in the mirror and backwards in time.
//!
//! `cargo run --release --features std --example sweep -- --seed 1 --cases 1000000000 [--state sweep.state]`
//!
//! Case number k of a seed is the same problem on every machine. With `--state` the number of cases done is kept in a file,
//! and the next run goes on from there. Failures are printed with seed and case, and make the exit status 1.
#![allow(clippy::print_stdout)] // a program

#[path = "../tests/otg_support/mod.rs"]
mod otg_support;

use std::process::ExitCode;

use otg_support::cases::{ALL, Distribution, mirrored, random_input, reversed};
use otg_support::judge::{Verdict, judge};
use otg_support::random::Random;
use seamline::otg::{Control, Input, Synchronization, Trajectory, calculate, calculate_into};

/// Cases from one record of the state to the next.
const CHUNK: u64 = 100_000;

/// Durations of one problem seen in different ways may differ by this fraction; at a double root a rounding error costs the square root of itself.
const SAME_DURATION: f64 = 1e-7;

#[derive(Debug, Default)]
struct Tally {
    failures: u64,
    worst: Verdict,
}

impl Tally {
    fn fail(&mut self, seed: u64, case: u64, what: &str) {
        self.failures += 1;
        println!("seed {seed} case {case}: {what}");
    }

    fn run<const N: usize>(&mut self, seed: u64, case: u64, into: &mut Trajectory<N>) {
        let distribution = ALL[(case / 4 % ALL.len() as u64) as usize];
        let mut random =
            Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ case.wrapping_mul(0xd134_2543_de82_ef95));
        let mut input: Input<N> = random_input(&mut random, distribution);
        if random.chance(0.1) {
            input.control = [Control::Velocity; N];
        }
        if random.chance(0.1) {
            input.synchronization = [Synchronization::None; N];
        }
        if let Err(error) = calculate_into(&input, into) {
            return self.fail(seed, case, &format!("{distribution:?}, {N} axes: {error}"));
        }
        let verdict = judge(&input, into, input.synchronization[0] == Synchronization::Time);
        self.worst.worst(&verdict);
        if !verdict.is_good() {
            self.fail(seed, case, &format!("{distribution:?}, {N} axes: {verdict:?}"));
        }
    }

    /// The same problem in the mirror and backwards in time.
    fn turn(&mut self, seed: u64, case: u64, random: &mut Random) {
        let distribution = ALL[(case / 4 % ALL.len() as u64) as usize];
        let input = random_input(random, distribution);
        let Ok(own) = calculate(&input) else { return self.fail(seed, case, "no trajectory") };
        let mut compare = |name: &str, other: &Input<1>| {
            let Ok(other) = calculate(other) else { return };
            let braked = |t: &Trajectory<1>| !t.profiles()[0].brake().is_empty();
            let comparable = name == "mirror" || !(braked(&own) || braked(&other));
            let (a, b) = (own.duration(), other.duration());
            // Exact ties are another problem after a rounding error.
            if comparable && distribution != Distribution::Whole && (a - b).abs() > SAME_DURATION * a.max(b) {
                self.fail(seed, case, &format!("{distribution:?}: {a} s, {name} {b} s"));
            }
        };
        compare("mirror", &mirrored(&input));
        compare("backwards", &reversed(&input));
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let option =
        |name: &str| arguments.iter().position(|a| a == name).and_then(|at| arguments.get(at + 1)).cloned();
    let number = |name: &str, default: u64| option(name).and_then(|n| n.parse().ok()).unwrap_or(default);
    let (seed, cases) = (number("--seed", 1), number("--cases", 1_000_000));
    let state = option("--state");
    let done = state.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
    let mut case = done.and_then(|text| text.trim().parse().ok()).unwrap_or(0);
    let (mut one, mut three, mut six) =
        (Trajectory::<1>::default(), Trajectory::<3>::default(), Trajectory::<6>::default());
    let mut tally = Tally::default();
    while case < cases {
        let end = cases.min(case + CHUNK);
        for case in case..end {
            match case % 4 {
                0 => tally.run(seed, case, &mut one),
                1 => tally.run(seed, case, &mut three),
                2 => tally.run(seed, case, &mut six),
                _ => tally.turn(seed, case, &mut Random(seed ^ case.wrapping_mul(0x2545_f491_4f6c_dd1d))),
            }
        }
        case = end;
        if let Some(path) = &state
            && let Err(error) = std::fs::write(path, case.to_string())
        {
            println!("{path}: {error}");
        }
    }
    println!(
        "seed {seed}: {case} cases done, {} failures in this run, worst {:?}",
        tally.failures, tally.worst
    );
    if tally.failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
