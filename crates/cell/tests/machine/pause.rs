//! Pauses at random instants of random lines, beside singularities too: how soon the arm stands.

use seamline::control::{Block, Command, Event, Mode, Motion};
use seamline::kinematics::{JointJet, Kinematics};
use seamline::path::PathState;
use seamline_cell::cell::Cell;
use seamline_cell::job::{MovePath, Speed};
use seamline_cell::plan::{Arm, Planner};
use seamline_cell::sim::{Servo, SimulatedDrive};

use crate::bench::{Ar2010, Bench, move_to, worst_shares};

/// splitmix64.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Joints in the middle of the working range; every third time with the wrist nearly stretched.
    fn joints(&mut self, beside_wrist: bool) -> [f64; 6] {
        let wrist = if beside_wrist { self.within(-0.05, 0.05) } else { self.within(-1.4, -0.4) };
        [
            self.within(-0.6, 0.6),
            self.within(-0.3, 0.6),
            self.within(-0.6, 0.3),
            self.within(-0.8, 0.8),
            wrist,
            self.within(-1.0, 1.0),
        ]
    }
}

/// A line at a random speed from 5 mm/s to 1 m/s that the arm can follow, and where it starts.
fn random_line(
    random: &mut Random,
    case: usize,
    cell: &Cell,
    arm: &Ar2010,
) -> (Vec<Command<6>>, [f64; 6], f64) {
    for _ in 0..1_000 {
        let start = random.joints(case.is_multiple_of(3));
        let mut end = random.joints(case.is_multiple_of(3));
        let share = random.within(0.1, 0.6);
        (0..6).for_each(|k| end[k] = start[k] + share * (end[k] - start[k]));
        let mm_s = 5.0 * 200_f64.powf(random.unit());
        let mut planner = Planner::new(arm, cell, start).unwrap();
        let step = move_to(1, MovePath::Linear, Speed::Linear { mm_s }, arm, &end);
        if let Ok(planned) = planner.plan(&step)
            && planned.duration > 0.05
        {
            return (planned.commands, start, planned.duration);
        }
    }
    panic!("no line found");
}

/// The joints in programme time, at a time since the start of the blocks.
fn joints(blocks: &[Block<6>], mut time: f64, arm: &Ar2010, seed: &[f64; 6]) -> Option<JointJet<6>> {
    for block in blocks {
        if time < block.duration() {
            let Motion::Path(motion) = &block.motion else { return None };
            let flange = motion.flange(time);
            let q = arm.kinematics.inverse_nearest(&flange.pose, seed).ok()?;
            return arm.kinematics.joint_jet(&flange, &q).ok();
        }
        time -= block.duration();
    }
    None
}

/// The motion along the path at a programme time, and its acceleration limit.
fn along(blocks: &[Block<6>], mut time: f64) -> Option<(PathState, f64)> {
    for block in blocks {
        if time < block.duration() {
            let Motion::Path(motion) = &block.motion else { return None };
            return Some((motion.state(time), motion.acceleration)).filter(|(state, _)| state.velocity > 0.0);
        }
        time -= block.duration();
    }
    None
}

/// Least time to stand under the acceleration limits alone, by small steps, from full rate at `now`.
fn second_order_stop(blocks: &[Block<6>], mut now: f64, arm: &Ar2010, mut seed: [f64; 6]) -> f64 {
    const STEP: f64 = 1e-4;
    let (mut rate, mut time) = (1.0_f64, 0.0);
    while rate > 0.0 {
        let Some(jet) = joints(blocks, now, arm, &seed) else { return time };
        seed = jet.position;
        let mut slope = f64::NEG_INFINITY;
        for (axis, limit) in arm.limits.acceleration.into_iter().enumerate() {
            let (v, a) = (jet.velocity[axis], jet.acceleration[axis] * rate * rate);
            if v != 0.0 {
                slope = slope.max((-limit - a * v.signum()) / v.abs());
            }
        }
        if let Some((state, limit)) = along(blocks, now) {
            slope = slope.max((-limit - state.acceleration * rate * rate) / state.velocity);
        }
        now += rate * STEP;
        rate += (slope * STEP).max(-rate);
        time += STEP;
    }
    time
}

/// One pause: time to stand beyond the second-order least, and the commands' shares of the limits.
fn pause(random: &mut Random, case: usize, cell: &Cell, arm: &Ar2010) -> (f64, [f64; 3]) {
    let (mut commands, start, duration) = random_line(random, case, cell, arm);
    let as_block = |command: &Command<6>| match command {
        Command::Move(block) => Some(*block),
        _ => None,
    };
    let blocks: Vec<_> = commands.iter().filter_map(as_block).collect();
    commands.push(Command::End);
    let mut here = arm.clone();
    here.home = start;
    let drive = SimulatedDrive::new([Servo::IDEAL; 6], start);
    let mut bench = Bench::with_drive(cell, &here, drive, commands);
    bench.cycle_with(Event::Start);
    let mut rows = Vec::new();
    let before = (random.unit() * duration / bench.period) as usize;
    (0..before).for_each(|_| rows.push(bench.cycle().command.position));
    let now = (before + 1) as f64 * bench.period;
    let seed = rows.last().copied().unwrap_or(start);
    let least = second_order_stop(&blocks, now, arm, seed);
    if bench.cycle.mode() != Mode::Running {
        return (0.0, [0.0; 3]);
    }
    bench.input.event = Some(Event::Hold);
    let mut stopping = 0_u32;
    loop {
        let output = bench.cycle();
        rows.push(output.command.position);
        stopping += 1;
        assert!(stopping < 5_000, "case {case}: it must stand");
        if output.status.at_rest {
            break;
        }
    }
    if bench.cycle.mode() == Mode::Holding {
        bench.input.event = Some(Event::Resume);
        (0..200).for_each(|_| rows.push(bench.cycle().command.position));
    }
    (f64::from(stopping) * bench.period - least, worst_shares(&rows, arm, bench.period))
}

fn pauses(count: usize) -> Vec<f64> {
    let cell = Cell::default_cell().unwrap();
    let arm = Arm::from_cell(&cell).unwrap();
    let mut random = Random(1);
    let mut excess = Vec::new();
    for case in 0..count {
        let (beyond, [velocity, acceleration, jerk]) = pause(&mut random, case, &cell, &arm);
        assert!(
            velocity <= 1.0 + 1e-6 && acceleration <= 1.001 && jerk <= 1.01,
            "case {case}: {velocity} {acceleration} {jerk}"
        );
        excess.push(beyond);
    }
    excess.sort_by(f64::total_cmp);
    let at = |share: f64| excess[((count - 1) as f64 * share) as usize] * 1e3;
    println!(
        "{count} pauses, beyond the second-order stop: median {:.1} ms, 90 % {:.1}, 99 % {:.1}, greatest {:.1}",
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
    excess
}

/// 150 lines, each paused once and resumed: it stands, soon, and every limit holds.
#[test]
fn a_line_pauses_soon_and_within_its_limits() {
    let excess = pauses(150);
    assert!(excess[75] < 0.04 && excess[149] < 0.2);
}

/// The same with 1,000: `cargo test --release -p seamline-cell --test machine a_thousand -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes without optimization"]
fn a_thousand_pauses() {
    pauses(1_000);
}
