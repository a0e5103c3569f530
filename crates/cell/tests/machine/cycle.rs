//! Planned moves through the control cycle and the simulated drives, judged by an independent arm model.

use crate::bench::{Ar2010, Bench, independent_forward, independent_torch, move_to, worst_shares};
use seamline::control::{Command, Event, Mode};
use seamline::kinematics::Kinematics;
use seamline::seam::NoSensor;
use seamline_cell::cell::Cell;
use seamline_cell::job::{MovePath, Speed};
use seamline_cell::plan::{Arm, Planner};

const START: [f64; 6] = [0.0, 0.2, -0.2, 0.1, -1.2, 0.3];
const END: [f64; 6] = [0.35, 0.35, -0.1, 0.3, -1.0, 0.1];

fn setup() -> (Cell, Ar2010) {
    let cell = Cell::default_cell().unwrap();
    let arm = Arm::from_cell(&cell).unwrap();
    (cell, arm)
}

/// MOVJ to the start, MOVL to the end, MOVJ home.
fn commands(cell: &Cell, arm: &Ar2010, speed_mm_s: f64) -> Vec<Command<6>> {
    let mut planner = Planner::new(arm, cell, arm.home).unwrap();
    let linear = Speed::Linear { mm_s: speed_mm_s };
    let steps = [
        move_to(1, MovePath::Joint, Speed::JointPercent(50.0), arm, &START),
        move_to(2, MovePath::Linear, linear, arm, &END),
        move_to(3, MovePath::Joint, Speed::JointPercent(100.0), arm, &arm.home),
    ];
    let mut all: Vec<_> = steps.iter().flat_map(|step| planner.plan(step).unwrap().commands).collect();
    all.push(Command::End);
    all
}

struct Row {
    joints: [f64; 6],
    line: u32,
}

fn run(bench: &mut Bench, mut operator: impl FnMut(usize, &mut Bench)) -> Vec<Row> {
    bench.cycle_with(Event::Start);
    let mut rows = Vec::new();
    for k in 0..200_000 {
        operator(k, bench);
        let output = bench.cycle();
        assert_eq!(output.status.fault, None, "cycle {k}");
        rows.push(Row { joints: output.command.position, line: output.status.line });
        if output.status.mode == Mode::Standstill {
            return rows;
        }
    }
    panic!("the job does not end");
}

fn assert_line(rows: &[Row]) {
    let tcp = |row: &Row| independent_forward(&row.joints) * independent_torch();
    let on_line: Vec<_> = rows.iter().filter(|row| row.line == 2).map(tcp).collect();
    let (first, last) = (on_line[0], on_line[on_line.len() - 1]);
    let direction = (last.translation.vector - first.translation.vector).normalize();
    let whole = first.rotation.angle_to(&last.rotation);
    for pose in &on_line {
        let offset = pose.translation.vector - first.translation.vector;
        let deviation = (offset - direction * offset.dot(&direction)).norm();
        assert!(deviation < 1e-9, "off the line by {deviation} m");
        let turned = first.rotation.angle_to(&pose.rotation);
        let along = offset.norm() / (last.translation.vector - first.translation.vector).norm();
        let left = pose.rotation.angle_to(&last.rotation);
        assert!((turned + left - whole).abs() < 1e-6, "off the geodesic");
        assert!((turned - along * whole).abs() < 1e-6, "translation and rotation run together");
    }
}

#[test]
fn the_model_agrees_with_the_makers_data() {
    let (_, arm) = setup();
    for k in 0..1_000_u32 {
        let q: [f64; 6] = std::array::from_fn(|joint| {
            let (low, high) = arm.limits.position[joint];
            low + (high - low) * f64::from((k * 7919 + joint as u32 * 104_729) % 1_000) / 1_000.0
        });
        let (ours, theirs) = (arm.kinematics.forward(&q), independent_forward(&q));
        assert!((ours.translation.vector - theirs.translation.vector).norm() < 1e-14);
        assert!(ours.rotation.angle_to(&theirs.rotation) < 1e-7);
    }
}

#[test]
fn a_job_keeps_line_and_limits() {
    let (cell, arm) = setup();
    for speed in [10.0, 200.0, 1_500.0] {
        let mut bench = Bench::new(&cell, &arm, commands(&cell, &arm, speed));
        let rows = run(&mut bench, |_, _| {});
        assert_line(&rows);
        let joints: Vec<_> = rows.iter().map(|row| row.joints).collect();
        let [velocity, acceleration, jerk] = worst_shares(&joints, &arm, cell.cycle.period);
        println!("{speed} mm/s: velocity {velocity:.4}, acceleration {acceleration:.4}, jerk {jerk:.4}");
        assert!(velocity <= 1.0 + 1e-9 && acceleration <= 1.0 + 1e-6 && jerk <= 1.01);
        let end = joints[joints.len() - 1];
        assert!(end.iter().zip(arm.home).all(|(a, b)| (a - b).abs() < 1e-5), "{end:?}");
    }
}

/// Override and pauses at random instants, 40 runs: same path, same limits, the job ends.
#[test]
fn override_and_pause_never_leave_the_path() {
    let (cell, arm) = setup();
    let mut seed = 5_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let mut worst = [0.0_f64; 3];
    for case in 0..40 {
        let speed = [50.0, 300.0, 1_500.0][case % 3];
        let mut bench = Bench::new(&cell, &arm, commands(&cell, &arm, speed));
        let rows = run(&mut bench, |_, bench| {
            if random() < 0.004 {
                bench.input.speed_override = [0.1, 0.4, 0.8, 1.0][(random() * 4.0) as usize];
            }
            match bench.cycle.mode() {
                Mode::Running if random() < 0.003 => bench.input.event = Some(Event::Hold),
                Mode::Holding if random() < 0.01 => bench.input.event = Some(Event::Resume),
                _ => {}
            }
        });
        assert_line(&rows);
        let joints: Vec<_> = rows.iter().map(|row| row.joints).collect();
        let shares = worst_shares(&joints, &arm, cell.cycle.period);
        worst = std::array::from_fn(|k| worst[k].max(shares[k]));
    }
    println!("worst shares of velocity, acceleration, jerk: {worst:?}");
    assert!(worst[0] <= 1.0 + 1e-9 && worst[1] <= 1.0 + 1e-3 && worst[2] <= 1.01);
}

/// A clock that runs backwards costs the measurement, never the cycle.
#[test]
fn a_clock_that_jumps_back_does_no_harm() {
    struct Backwards(u64);
    impl seamline::control::StageClock for Backwards {
        fn now_ns(&mut self) -> u64 {
            self.0 -= 1_000;
            self.0
        }
    }
    let (cell, arm) = setup();
    let mut bench = Bench::new(&cell, &arm, commands(&cell, &arm, 200.0));
    bench.cycle_with(Event::Start);
    let output = bench.cycle.step(&bench.input, &mut bench.queue, &mut NoSensor, &mut Backwards(1_000_000));
    assert_eq!((output.status.fault, output.status.stage_ns), (None, [0; 4]));
}
