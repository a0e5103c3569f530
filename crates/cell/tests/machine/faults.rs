//! Faults in motion: each is named, stops the arm as its category says, and loses nothing that could go on.

use crate::bench::{Ar2010, Bench, independent_forward, independent_torch, move_to, worst_shares};
use seamline::arc::ArcSetting;
use seamline::control::{Command, CycleOutput, Event, Mode, Motion, PathMotion};
use seamline::drive::DriveFault;
use seamline::path::TimingPiece;
use seamline::safety::Fault;
use seamline_cell::cell::Cell;
use seamline_cell::job::{MovePath, Speed};
use seamline_cell::plan::{Arm, Planner};
use seamline_cell::sim::{InjectedFault, SimulatedDrive};

const START: [f64; 6] = [0.0, 0.2, -0.2, 0.1, -1.2, 0.3];
const END: [f64; 6] = [0.35, 0.35, -0.1, 0.3, -1.0, 0.1];
const LINE: u32 = 2;

fn setup() -> (Cell, Ar2010) {
    let cell = Cell::default_cell().unwrap();
    let arm = Arm::from_cell(&cell).unwrap();
    (cell, arm)
}

/// MOVJ to the start, MOVL at 200 mm/s.
fn commands(cell: &Cell, arm: &Ar2010) -> Vec<Command<6>> {
    let mut planner = Planner::new(arm, cell, arm.home).unwrap();
    let steps = [
        move_to(1, MovePath::Joint, Speed::JointPercent(100.0), arm, &START),
        move_to(LINE, MovePath::Linear, Speed::Linear { mm_s: 200.0 }, arm, &END),
    ];
    let mut all = vec![Command::Arc { on: true, setting: ArcSetting::NONE }];
    all.extend(steps.iter().flat_map(|step| planner.plan(step).unwrap().commands));
    all.push(Command::End);
    all
}

struct Run {
    bench: Bench,
    outputs: Vec<CycleOutput<6>>,
}

impl Run {
    fn start(cell: &Cell, arm: &Ar2010) -> Self {
        let mut bench = Bench::new(cell, arm, commands(cell, arm));
        let first = bench.cycle_with(Event::Start);
        Self { bench, outputs: vec![first] }
    }

    fn cycle(&mut self) -> CycleOutput<6> {
        let output = self.bench.cycle();
        self.outputs.push(output);
        output
    }

    fn until(&mut self, done: impl Fn(&CycleOutput<6>) -> bool) -> CycleOutput<6> {
        for _ in 0..20_000 {
            let output = self.cycle();
            if done(&output) {
                return output;
            }
        }
        panic!("it does not come to that");
    }

    fn run_into_line(&mut self, cycles: usize) {
        self.until(|output| output.status.line == LINE);
        (0..cycles).for_each(|_| {
            self.cycle();
        });
    }

    fn commands(&self) -> Vec<[f64; 6]> {
        self.outputs.iter().map(|output| output.command.position).collect()
    }

    fn assert_within_limits(&self, arm: &Ar2010, period: f64) {
        let [velocity, acceleration, jerk] = worst_shares(&self.commands(), arm, period);
        assert!(
            velocity <= 1.0 + 1e-6 && acceleration <= 1.001 && jerk <= 1.01,
            "{velocity} {acceleration} {jerk}"
        );
    }

    /// Greatest distance of the tool centre point from the line between the taught points, for commands on it.
    fn off_the_line(&self, arm: &Ar2010) -> f64 {
        let tcp = |q: &[f64; 6]| (independent_forward(q) * independent_torch()).translation.vector;
        let rounded = |joints: &[f64; 6]| {
            let pulses = seamline_cell::job::pulses_from_joints(joints, &arm.pulses_per_unit);
            seamline_cell::job::joints_from_pulses(&pulses, &arm.pulses_per_unit).unwrap()
        };
        let (start, end) = (tcp(&rounded(&START)), tcp(&rounded(&END)));
        let direction = (end - start).normalize();
        let on_line = self.outputs.iter().filter(|output| output.status.line == LINE);
        on_line
            .map(|output| tcp(&output.command.position) - start)
            .map(|offset| (offset - direction * offset.dot(&direction)).norm())
            .fold(0.0, f64::max)
    }
}

/// 100 emergency stops at random instants of the line, each followed by reset and resume.
#[test]
fn an_emergency_stop_keeps_the_line_and_the_job_goes_on_after_reset() {
    let (cell, arm) = setup();
    for case in 0..100_usize {
        let mut run = Run::start(&cell, &arm);
        run.run_into_line(case * 37 % 900);
        run.bench.input.fault = Some(Fault::EmergencyStop);
        let hit = run.cycle();
        assert_eq!(
            (hit.status.mode, hit.status.fault, hit.arc.on),
            (Mode::Fault, Some(Fault::EmergencyStop), false)
        );
        run.bench.input.event = Some(Event::Resume);
        assert_eq!(run.cycle().status.refused, Some(Event::Resume), "no restart without reset");
        run.until(|output| output.status.at_rest);
        let (stopped, later) = (run.cycle(), run.cycle());
        assert_eq!(stopped.command.position, later.command.position);
        run.bench.input.event = Some(Event::Reset);
        let reset = run.cycle();
        assert_eq!(
            (reset.status.mode, reset.status.fault, reset.status.refused),
            (Mode::Holding, None, None)
        );
        run.bench.input.event = Some(Event::Resume);
        let end = run.until(|output| output.status.mode == Mode::Standstill);
        assert!(end.command.position.iter().zip(END).all(|(a, b)| (a - b).abs() < 2e-5), "case {case}");
        run.assert_within_limits(&arm, cell.cycle.period);
        assert!(run.off_the_line(&arm) < 1e-9, "case {case}: {}", run.off_the_line(&arm));
    }
}

#[test]
fn a_stuck_joint_is_a_following_error_and_stops_on_the_line() {
    let (cell, arm) = setup();
    for joint in [0, 1] {
        let mut run = Run::start(&cell, &arm);
        run.run_into_line(100);
        run.bench.drive.inject(InjectedFault::Stuck { joint }).unwrap();
        let fault = run.until(|output| output.status.fault.is_some());
        assert!(
            matches!(fault.status.fault, Some(Fault::FollowingError { axis, .. }) if axis == joint),
            "{fault:?}"
        );
        run.until(|output| output.status.at_rest);
        run.assert_within_limits(&arm, cell.cycle.period);
        assert!(run.off_the_line(&arm) < 1e-9);
    }
}

#[test]
fn an_encoder_jump_is_found_at_once() {
    let (cell, arm) = setup();
    let mut run = Run::start(&cell, &arm);
    run.run_into_line(100);
    run.bench.drive.inject(InjectedFault::EncoderJump { joint: 3, offset: -0.5 }).unwrap();
    run.cycle();
    run.cycle();
    assert!(matches!(run.cycle().status.fault, Some(Fault::FollowingError { axis: 3, .. })));
}

#[test]
fn silent_drives_and_alarms_are_category_zero() {
    let (cell, arm) = setup();
    let alarm = InjectedFault::Alarm { joint: 4, code: 77 };
    for (injected, expected) in
        [(InjectedFault::Silent, DriveFault::Silent), (alarm, DriveFault::Axis(4, 77))]
    {
        let mut run = Run::start(&cell, &arm);
        run.run_into_line(200);
        run.bench.drive.inject(injected).unwrap();
        let before = run.cycle();
        let output = run.cycle();
        assert_eq!(output.status.fault, Some(Fault::Drive(expected)));
        assert!(!output.power && !output.arc.on, "power and arc off at once");
        assert_eq!(output.command.position, before.command.position, "nothing more is commanded");
        run.bench.drive.clear_faults();
        run.cycle();
        run.bench.input.event = Some(Event::Reset);
        let reset = run.cycle();
        assert_eq!((reset.status.fault, reset.status.mode), (None, Mode::Holding), "the job can go on");
    }
}

/// Without power the arm is moved by hand to where the tool is outside the workspace: after the reset it may stand there, comes back, and the job is done.
#[test]
fn an_arm_that_was_moved_out_of_the_workspace_comes_back() {
    let (mut cell, arm) = setup();
    let mut whole = Run::start(&cell, &arm);
    let done = whole.until(|output| output.status.mode == Mode::Standstill);
    let least = |outputs: &[CycleOutput<6>]| {
        let y = outputs.iter().map(|output| output.status.base_from_tcp.translation.y);
        y.fold(f64::INFINITY, f64::min)
    };
    cell.safety.workspace_min.y = least(&whole.outputs) - 0.01;
    let mut run = Run::start(&cell, &arm);
    run.run_into_line(200);
    run.bench.drive.inject(InjectedFault::Silent).unwrap();
    run.cycle();
    let mut moved = run.cycle().command.position;
    moved[0] -= 0.3;
    let mut elsewhere = cell.clone();
    elsewhere.robot.joints.iter_mut().zip(moved).for_each(|(joint, home)| joint.home = home);
    run.bench.input.measured = Ok(moved);
    run.cycle();
    run.bench.drive = SimulatedDrive::from_cell(&elsewhere).unwrap();
    run.bench.input.measured = Ok(moved);
    run.bench.input.event = Some(Event::Reset);
    for _ in 0..50 {
        let output = run.cycle();
        assert_eq!((output.status.mode, output.status.fault), (Mode::Holding, None));
    }
    assert!(run.cycle().status.base_from_tcp.translation.y < cell.safety.workspace_min.y - 0.1);
    run.bench.input.event = Some(Event::Resume);
    let end = run.until(|output| output.status.mode == Mode::Standstill || output.status.fault.is_some());
    assert_eq!((end.status.fault, end.command.position), (None, done.command.position));
}

/// A queue that runs empty in the middle of a motion: each joint stops within its own limits, and power goes.
#[test]
fn a_starved_motion_halts_within_the_joint_limits() {
    let (cell, arm) = setup();
    let mut all = commands(&cell, &arm);
    all.pop();
    let Some(Command::Move(last)) = all.last_mut() else { panic!("a move comes last") };
    last.ends_at_rest = false;
    let Motion::Path(motion) = &mut last.motion else { panic!("along a path") };
    *motion = beginning(motion);
    let mut run = Run { bench: Bench::new(&cell, &arm, all), outputs: Vec::new() };
    run.bench.cycle_with(Event::Start);
    let fault = run.until(|output| output.status.fault.is_some());
    assert_eq!(fault.status.fault, Some(Fault::Starved));
    let rest = run.until(|output| output.status.at_rest);
    assert!(!rest.power, "category 1: power off at rest");
    run.assert_within_limits(&arm, cell.cycle.period);
}

/// The first 100 ms of a line, in pieces whose borders fall on those of its S-curve (10 ms a phase): it ends in
/// full motion.
fn beginning(motion: &PathMotion) -> PathMotion {
    const STEP: f64 = 2.5e-3;
    let piece = |k: u32| {
        let (state, next) = (motion.state(f64::from(k) * STEP), motion.state(f64::from(k + 1) * STEP));
        TimingPiece {
            duration: STEP,
            position: state.position,
            velocity: state.velocity,
            acceleration: state.acceleration,
            jerk: (next.acceleration - state.acceleration) / STEP,
            ..TimingPiece::default()
        }
    };
    let pieces: Vec<_> = (0..40).map(piece).collect();
    PathMotion::new(motion.path, &independent_torch(), (motion.acceleration, motion.jerk), &pieces).unwrap()
}

/// A job queue that would drive through a limit: the envelope stops the command before it leaves the cycle.
#[test]
fn a_command_beyond_a_limit_never_leaves_the_cycle() {
    let (cell, arm) = setup();
    let mut fast = arm.clone();
    fast.limits.velocity = fast.limits.velocity.map(|v| 3.0 * v);
    fast.limits.acceleration = fast.limits.acceleration.map(|a| 3.0 * a);
    fast.limits.jerk = fast.limits.jerk.map(|j| 3.0 * j);
    let mut run = Run { bench: Bench::new(&cell, &arm, commands(&cell, &fast)), outputs: Vec::new() };
    run.bench.cycle_with(Event::Start);
    let fault = run.until(|output| output.status.fault.is_some());
    assert!(matches!(fault.status.fault, Some(Fault::JerkLimit { .. } | Fault::AccelerationLimit { .. })));
    run.until(|output| output.status.at_rest);
    run.assert_within_limits(&arm, cell.cycle.period);
}

#[test]
fn late_cycles_in_a_row_stop_the_arm_on_its_path() {
    let (cell, arm) = setup();
    let mut run = Run::start(&cell, &arm);
    run.run_into_line(100);
    run.bench.input.late = true;
    let fault = run.until(|output| output.status.fault.is_some());
    assert!(matches!(fault.status.fault, Some(Fault::Overrun { count: 11 })));
    run.until(|output| output.status.at_rest);
    assert!(run.off_the_line(&arm) < 1e-9);
}
