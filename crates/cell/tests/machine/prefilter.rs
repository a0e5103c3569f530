//! Prefilters on the joint commands: what they leave of a vibration, and that limits, paths, corners and ends hold under them.

use seamline::control::{Command, Event, Mode};
use seamline::vibration::Prefilter;
use seamline_cell::cell::{Cell, FlexibleMode, Vibration};
use seamline_cell::job::{MovePath, Speed, Zone};
use seamline_cell::plan::{Arm, Planner};

use crate::bench::{Ar2010, Bench, Random, move_to, worst_shares};
use crate::chain::Way;

const MODE: FlexibleMode = FlexibleMode { frequency_hz: 6.34, damping: 0.022 };
const SECOND: FlexibleMode = FlexibleMode { frequency_hz: 14.0, damping: 0.03 };
const PATH_ERROR: f64 = 0.5e-3;
const ENDS: [[f64; 6]; 2] = [[0.0, 0.2, -0.2, 0.1, -1.2, 0.3], [0.35, 0.35, -0.1, 0.3, -1.0, 0.1]];

fn vibration(prefilter: Prefilter, modes: &[FlexibleMode]) -> Vibration {
    Vibration::try_new(prefilter, PATH_ERROR, modes.to_vec()).unwrap()
}

/// A line, and back by a joint move at full speed.
fn setup(vibration: Vibration, mm_s: f64) -> (Cell, Ar2010, Vec<Command<6>>) {
    let mut cell = Cell::default_cell().unwrap();
    cell.vibration = vibration;
    let mut arm: Ar2010 = Arm::from_cell(&cell).unwrap();
    arm.home = ENDS[0];
    for (joint, home) in cell.robot.joints.iter_mut().zip(ENDS[0]) {
        joint.home = home;
    }
    let mut planner = Planner::new(&arm, &cell, ENDS[0]).unwrap();
    let mut commands = Vec::new();
    let there = move_to(1, MovePath::Linear, Speed::Linear { mm_s }, &arm, &ENDS[1]);
    let back = move_to(2, MovePath::Joint, Speed::JointPercent(100.0), &arm, &ENDS[0]);
    for step in [there, back] {
        commands.extend(planner.plan(&step).unwrap().commands);
    }
    commands.push(Command::End);
    (cell, arm, commands)
}

/// Runs to the end; `operate` may press buttons. The joint commands, with whether the arm was at rest.
fn run(
    cell: &Cell,
    arm: &Ar2010,
    commands: Vec<Command<6>>,
    mut operate: impl FnMut(usize, &mut Bench),
) -> Vec<([f64; 6], bool)> {
    let mut bench = Bench::new(cell, arm, commands);
    bench.cycle_with(Event::Start);
    let mut rows = Vec::new();
    for cycle in 0..100_000 {
        operate(cycle, &mut bench);
        let output = bench.cycle();
        assert_eq!(output.status.fault, None);
        rows.push((output.command.position, output.status.at_rest));
        if output.status.mode == Mode::Standstill {
            return rows;
        }
    }
    panic!("the run does not end");
}

/// Where the commands lead without a prefilter.
fn end_of(commands: &[Command<6>], cell: &Cell, arm: &Ar2010) -> [f64; 6] {
    let mut bare = cell.clone();
    bare.vibration = vibration(Prefilter::None, &[]);
    let rows = run(&bare, arm, commands.to_vec(), |_, _| {});
    rows[rows.len() - 1].0
}

fn joints(rows: &[([f64; 6], bool)]) -> Vec<[f64; 6]> {
    rows.iter().map(|(joints, _)| *joints).collect()
}

/// The greatest swing of an oscillator on each joint after its command has come to rest for good, by the definition of the mode: eight
/// steps of the midpoint rule a cycle.
fn swing(commands: &[[f64; 6]], mode: &FlexibleMode) -> f64 {
    let omega = std::f64::consts::TAU * mode.frequency_hz;
    let last = commands[commands.len() - 1];
    let rest = commands.iter().rposition(|q| *q != last).map_or(0, |k| k + 1);
    (0..6)
        .map(|joint| {
            let (mut x, mut v, mut greatest) = (commands[0][joint], 0.0, 0.0_f64);
            for cycle in 0..rest + 1_000 {
                let command = commands.get(cycle).unwrap_or(&last)[joint];
                let h = 1e-3 / 8.0;
                for _ in 0..8 {
                    let a = |x: f64, v: f64| omega * omega * (command - x) - 2.0 * mode.damping * omega * v;
                    let (xm, vm) = (x + 0.5 * h * v, v + 0.5 * h * a(x, v));
                    (x, v) = (x + h * vm, v + h * a(xm, vm));
                }
                if cycle >= rest {
                    greatest = greatest.max((x - last[joint]).abs());
                }
            }
            greatest
        })
        .fold(0.0, f64::max)
}

/// A line at three speeds and a joint move: what swings on after them.
#[test]
fn the_arm_does_not_ring_after_a_move() {
    for mm_s in [50.0, 300.0, 1_000.0] {
        let swing_with = |prefilter, modes: &[FlexibleMode], of: &FlexibleMode| {
            let (cell, arm, commands) = setup(vibration(prefilter, modes), mm_s);
            swing(&joints(&run(&cell, &arm, commands, |_, _| {})), of)
        };
        let bare = swing_with(Prefilter::None, &[], &MODE);
        for prefilter in [Prefilter::Zv, Prefilter::Zvd, Prefilter::FirZv, Prefilter::FirZvd] {
            let left = swing_with(prefilter, &[MODE], &MODE) / bare;
            println!("{mm_s} mm/s, {}: {:.3} % left", prefilter.name(), 100.0 * left);
            assert!(left < 0.01, "{mm_s} mm/s, {}: {left}", prefilter.name());
        }
        for mode in [MODE, SECOND] {
            let bare = swing_with(Prefilter::None, &[], &mode);
            let left = swing_with(Prefilter::Zvd, &[MODE, SECOND], &mode) / bare;
            assert!(left < 0.02, "{mm_s} mm/s, two modes, {} Hz: {left}", mode.frequency_hz);
        }
    }
}

/// A pause in full motion, 20 instants: the arm does not ring there either.
#[test]
fn the_arm_does_not_ring_after_a_pause() {
    let paused = |prefilter, modes: &[FlexibleMode], instant: usize| {
        let (cell, arm, commands) = setup(vibration(prefilter, modes), 300.0);
        let mut bench = Bench::new(&cell, &arm, commands);
        bench.cycle_with(Event::Start);
        let mut rows: Vec<_> = (0..instant).map(|_| bench.cycle().command.position).collect();
        bench.input.event = Some(Event::Hold);
        rows.extend((0..2_000).map(|_| bench.cycle().command.position));
        swing(&rows, &MODE)
    };
    for case in 0..20 {
        let instant = 300 + 37 * case;
        let bare = paused(Prefilter::None, &[], instant);
        let left = paused(Prefilter::FirZvd, &[MODE], instant) / bare;
        assert!(left < 0.02, "instant {instant}: {left}");
    }
}

/// Override, pauses and a stop at random instants, 30 runs with one and two modes: the limits hold by differences, and the arm comes to rest
/// exactly where the program does, before it says so.
#[test]
fn limits_and_ends_hold_under_a_prefilter() {
    let mut random = Random(11);
    let mut worst = [0.0_f64; 3];
    for case in 0..30 {
        let prefilter = [Prefilter::FirZvd, Prefilter::Zv, Prefilter::Ei][case % 3];
        let modes: &[FlexibleMode] = if case % 2 == 0 { &[MODE] } else { &[MODE, SECOND] };
        let speed = [50.0, 300.0, 1_500.0][case % 3];
        let (cell, arm, commands) = setup(vibration(prefilter, modes), speed);
        let planned = end_of(&commands, &cell, &arm);
        let rows = run(&cell, &arm, commands, |_, bench| {
            if random.unit() < 0.004 {
                bench.input.speed_override = random.within(0.1, 1.0);
            }
            match bench.cycle.mode() {
                Mode::Running if random.unit() < 0.003 => bench.input.event = Some(Event::Hold),
                Mode::Holding if random.unit() < 0.01 => bench.input.event = Some(Event::Resume),
                _ => {}
            }
        });
        let commands = joints(&rows);
        let shares = worst_shares(&commands, &arm, cell.cycle.period);
        worst = std::array::from_fn(|k| worst[k].max(shares[k]));
        for pair in rows.windows(2).filter(|pair| pair[0].1 && pair[1].1) {
            assert_eq!(pair[0].0, pair[1].0, "case {case}: it says that it rests");
        }
        assert_eq!(commands[commands.len() - 1], planned, "case {case}: where it ends");
    }
    println!("worst shares of velocity, acceleration, jerk: {worst:?}");
    assert!(worst[0] <= 1.0 + 1e-9 && worst[1] <= 1.0 + 1e-3 && worst[2] <= 1.01, "{worst:?}");
}

/// A zigzag with corners of 20 to 150 degrees and a right angle at speed: every corner within its error, the filter's part included, and the
/// tool never farther off its way than the path error and that.
#[test]
fn corners_keep_their_error_under_a_prefilter() {
    for mm_s in [10.0, 60.0, 200.0] {
        let mut way = Way::new(&[
            ([40.0, 0.0], 0.0),
            ([75.0, 13.0], 3.0),
            ([75.0, 60.0], 0.0),
            ([45.0, 25.0], -4.0),
            ([80.0, 22.0], 0.0),
        ]);
        way.cell.vibration = vibration(Prefilter::FirZvd, &[MODE]);
        let trace = way.run(&way.plan(&way.lines(mm_s, Zone::Unspecified)));
        for (k, pose) in way.poses.iter().enumerate().skip(1) {
            let permitted = if k == 5 { 0.0 } else { 0.5 };
            let error = trace.distance(pose);
            println!("{mm_s} mm/s, corner {k}: {error:.3} mm");
            assert!(error <= permitted + 2e-3, "{mm_s} mm/s, corner {k}: {error} mm");
        }
        let off = trace.tools.iter().map(|tool| {
            let p = tool.translation.vector;
            let distance = |pair: &[nalgebra::Isometry3<f64>]| {
                let (from, to) = (pair[0].translation.vector, pair[1].translation.vector);
                let way = to - from;
                let share = ((p - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                (p - from - way * share).norm() * 1e3
            };
            way.poses.windows(2).map(distance).fold(f64::INFINITY, f64::min)
        });
        let off = off.fold(0.0, f64::max);
        println!("{mm_s} mm/s: at most {off:.3} mm off");
        assert!(off <= 0.5 + 2e-3, "{mm_s} mm/s: {off} mm");
    }
}
