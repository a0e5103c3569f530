//! Prefilters on the joint commands: what they do to limits, stops, corners, and to an arm that is flexible.

use std::f64::consts::TAU;

use seamline::arc::ArcSetting;
use seamline::control::{Command, CycleOutput, Event, Mode};
use seamline::safety::Fault;
use seamline_cell::cell::Cell;
use seamline_cell::job::{MovePath, Speed, Zone, joints_from_pulses, pulses_from_joints};
use seamline_cell::plan::{Arm, Planner};

use crate::bench::{
    Ar2010, Bench, Random, flexible, independent_forward, independent_torch, move_to, worst_shares,
};
use crate::chain::{RandomRun, Way, random_runs};

const START: [f64; 6] = [0.0, 0.2, -0.2, 0.1, -1.2, 0.3];
const END: [f64; 6] = [0.15, 0.25, -0.15, 0.2, -1.1, 0.2];
/// Line of the job that goes straight from the start to the end.
pub(crate) const LINE: u32 = 2;
pub(crate) const NAMES: [&str; 9] =
    ["zv", "zvd", "fir", "fir-zv", "fir-zvd", "mzv", "ei", "2hump-ei", "3hump-ei"];

/// A job under way: MOVJ to the start, a marker, MOVL, a marker, a dwell, the arc on and off, MOVJ back.
pub(crate) struct Run {
    pub(crate) bench: Bench,
    arm: Ar2010,
    pub(crate) outputs: Vec<CycleOutput<6>>,
}

impl Run {
    pub(crate) fn start(cell: &Cell, mm_s: f64) -> Self {
        let arm: Ar2010 = Arm::from_cell(cell).unwrap();
        let mut planner = Planner::new(&arm, cell, arm.home).unwrap();
        let mut commands = Vec::new();
        let moves = [
            move_to(1, MovePath::Joint, Speed::JointPercent(80.0), &arm, &START),
            move_to(LINE, MovePath::Linear, Speed::Linear { mm_s }, &arm, &END),
            move_to(3, MovePath::Joint, Speed::JointPercent(100.0), &arm, &START),
        ];
        for (number, step) in (1..).zip(&moves) {
            commands.extend(planner.plan(step).unwrap().commands);
            commands.push(Command::Marker(number));
            if number == LINE {
                commands.push(Command::Dwell { line: 20, segment: 20, duration: 0.05 });
                commands.extend([true, false].map(|on| Command::Arc { on, setting: ArcSetting::NONE }));
            }
        }
        commands.push(Command::End);
        let mut run = Self { bench: Bench::new(cell, &arm, commands), arm, outputs: Vec::new() };
        run.bench.input.event = Some(Event::Start);
        run
    }

    /// One cycle; what is at rest stays where it is.
    pub(crate) fn cycle(&mut self) -> CycleOutput<6> {
        let goes_on = self.bench.input.event.is_some();
        let before = self.outputs.last().copied();
        let output = self.bench.cycle();
        if let Some(before) =
            before.filter(|before| before.status.at_rest && output.status.at_rest && !goes_on)
        {
            assert_eq!(before.command.position, output.command.position, "at rest");
            assert_eq!(output.command.velocity, [0.0; 6]);
        }
        self.outputs.push(output);
        output
    }

    pub(crate) fn until(&mut self, reached: impl Fn(&CycleOutput<6>) -> bool) -> CycleOutput<6> {
        for _ in 0..20_000 {
            let output = self.cycle();
            if reached(&output) {
                return output;
            }
        }
        panic!("not reached");
    }

    pub(crate) fn rows(&self) -> Vec<[f64; 6]> {
        self.outputs.iter().map(|output| output.command.position).collect()
    }

    pub(crate) fn assert_within_limits(&self, case: &str) {
        let mut rows = vec![self.arm.home; 3];
        rows.extend(self.rows());
        let [velocity, acceleration, jerk] = worst_shares(&rows, &self.arm, self.bench.period);
        let within = velocity <= 1.0 + 1e-6 && acceleration <= 1.001 && jerk <= 1.01;
        assert!(within, "{case}: {velocity} {acceleration} {jerk}");
    }

    /// Distance of the tool from the line between the taught points, in metres.
    pub(crate) fn off_the_line(&self, joints: &[f64; 6]) -> f64 {
        let tcp = |q: &[f64; 6]| (independent_forward(q) * independent_torch()).translation.vector;
        let rounded = |joints: &[f64; 6]| {
            let pulses = pulses_from_joints(joints, &self.arm.pulses_per_unit);
            joints_from_pulses(&pulses, &self.arm.pulses_per_unit).unwrap()
        };
        let (start, end) = (tcp(&rounded(&START)), tcp(&rounded(&END)));
        let direction = (end - start).normalize();
        let offset = tcp(joints) - start;
        (offset - direction * offset.dot(&direction)).norm()
    }
}

/// 90 runs, each prefilter ten times, for one mode and for two, with pauses, overrides, stops and emergency stops at random instants and
/// soon after each other, also before the last one has brought the arm to rest: the joints keep their limits, by differences, and
/// each stop of the line comes to rest on it.
#[test]
fn limits_hold_whatever_is_asked_for() {
    interrupted(21, 90, flexible, 1e-9);
}

/// Runs with interruptions at random instants, each prefilter in turn, for one mode and for two: limits hold, and each stop of the line is on
/// it to `off` metres.
pub(crate) fn interrupted(seed: u64, cases: usize, cell: fn(&str, &[f64]) -> Cell, off_at_most: f64) {
    let mut random = Random(seed);
    for case in 0..cases {
        let name = NAMES[case % NAMES.len()];
        let modes = [random.within(5.0, 25.0), random.within(25.0, 60.0)];
        let cell = cell(name, &modes[..1 + case % 2]);
        let mut run = Run::start(&cell, 20.0 * 40_f64.powf(random.unit()));
        let mut stops = 0;
        for _ in 0..12 {
            for _ in 0..(400.0 * random.unit()) as usize {
                let output = run.cycle();
                if output.status.at_rest && output.status.line == LINE && output.status.rate == 0.0 {
                    let off = run.off_the_line(&output.command.position);
                    assert!(off < off_at_most, "{name} {case}: {off}");
                    stops += 1;
                }
            }
            run.bench.input.speed_override = if random.unit() < 0.5 { 1.0 } else { random.unit() };
            match (run.bench.cycle.mode(), random.within(0.0, 5.0) as u8) {
                (Mode::Running, 0 | 1) => run.bench.input.event = Some(Event::Hold),
                (Mode::Running, 2) => run.bench.input.fault = Some(Fault::EmergencyStop),
                (Mode::Holding, _) => run.bench.input.event = Some(Event::Resume),
                (Mode::Fault, _) => run.bench.input.event = Some(Event::Reset),
                _ => {}
            }
        }
        let stopped = run.bench.cycle.mode() == Mode::Running && random.unit() < 0.3;
        run.bench.input.event = stopped.then_some(Event::Stop);
        run.bench.input.speed_override = 1.0;
        for _ in 0..30_000 {
            let output = run.cycle();
            run.bench.input.event = match output.status.mode {
                Mode::Holding => Some(Event::Resume),
                Mode::Fault if output.status.at_rest => Some(Event::Reset),
                _ => None,
            };
            if output.status.mode == Mode::Standstill {
                break;
            }
        }
        assert_eq!(run.bench.cycle.mode(), Mode::Standstill, "{name} {case}");
        run.assert_within_limits(&format!("{name} {case}"));
        assert!(stops < 10_000);
    }
}

/// Halts at random instants, from the prefiltered command: each joint stops within its limits, and after a reset the controller holds
/// where it stands.
#[test]
fn a_halt_begins_where_the_prefilter_has_come() {
    let mut random = Random(22);
    for case in 0..45 {
        let name = NAMES[case % NAMES.len()];
        let cell = flexible(name, &[random.within(5.0, 40.0)]);
        let mut run = Run::start(&cell, 400.0);
        for _ in 0..300 + (700.0 * random.unit()) as usize {
            run.cycle();
        }
        let raised = Fault::Workspace { position: independent_torch().translation.vector };
        run.bench.input.fault = Some(raised);
        assert_eq!(run.cycle().status.fault, Some(raised));
        let rest = run.until(|output| output.status.at_rest);
        run.cycle();
        run.assert_within_limits(&format!("{name} {case}"));
        run.bench.input.event = Some(Event::Reset);
        let reset = run.cycle();
        assert_eq!((reset.status.mode, reset.command.position), (Mode::Holding, rest.command.position));
        assert!(run.cycle().status.at_rest);
    }
}

/// Each move ends exactly where it ends without a prefilter; what follows a move waits for that, and a dwell takes its time from then on.
#[test]
fn what_follows_a_stop_begins_at_true_rest() {
    let mut bare = Run::start(&Cell::default_cell().unwrap(), 100.0);
    let end_of = |run: &Run, marker: u32| {
        let at = run.outputs.iter().position(|output| output.status.marker == marker).unwrap();
        (at, run.outputs[at].command.position)
    };
    bare.until(|output| output.status.mode == Mode::Standstill);
    for name in NAMES {
        let cell = flexible(name, &[8.0, 21.0]);
        let mut run = Run::start(&cell, 100.0);
        run.until(|output| output.status.mode == Mode::Standstill);
        let length: f64 = cell.vibration.kernels().iter().map(seamline::vibration::Kernel::length).sum();
        let (at, end) = end_of(&run, 2);
        assert_eq!(end, end_of(&bare, 2).1, "{name}");
        assert_eq!(run.outputs[at - 1].command.position, end, "{name}: at rest before the marker");
        let dwell: Vec<_> = run.outputs.iter().filter(|output| output.status.line == 20).collect();
        // And one cycle, in which the arc is asked for.
        assert_eq!(dwell.len(), 51, "{name}");
        assert!(dwell.iter().all(|output| output.command.position == end));
        // The line takes as much longer as what is inside takes to run out, give or take the cycles at its ends.
        let time = |run: &Run| run.outputs.iter().filter(|output| output.status.line == LINE).count();
        let longer = time(&run) as f64 - time(&bare) as f64;
        assert!((longer - length / run.bench.period).abs() <= 3.0, "{name}: {longer} cycles for {length} s");
        let arrived = run.outputs.last().unwrap().command.position;
        assert_eq!(arrived, bare.outputs.last().unwrap().command.position);
    }
}

/// The middle of a line at constant speed: the same speed behind the prefilter, cycle by cycle, and velocity and acceleration of the command
/// are those of its positions.
#[test]
fn constant_speed_passes_unchanged() {
    let tcp = |output: &CycleOutput<6>| output.status.base_from_tcp.translation.vector;
    for name in NAMES {
        let mut run = Run::start(&flexible(name, &[8.0, 21.0]), 50.0);
        run.until(|output| output.status.mode == Mode::Standstill);
        let line: Vec<_> = run.outputs.iter().filter(|output| output.status.line == LINE).collect();
        let middle = &line[line.len() * 2 / 5..line.len() * 3 / 5];
        for pair in middle.windows(2) {
            let speed = (tcp(pair[1]) - tcp(pair[0])).norm() / run.bench.period;
            assert!((speed / 0.05 - 1.0).abs() < 1e-4, "{name}: {speed}");
        }
        for three in run.outputs.windows(3) {
            for joint in 0..6 {
                let q = |k: usize| three[k].command.position[joint];
                let velocity = (q(2) - q(0)) / (2.0 * run.bench.period);
                let found = three[1].command.velocity[joint];
                let limit = run.arm.limits.velocity[joint];
                assert!((velocity - found).abs() < 2e-4 * limit, "{name}: {velocity} {found}");
            }
        }
    }
}

/// A joint that follows its command as a flexible mode does, the command being straight within a cycle.
#[derive(Clone, Copy)]
struct Flexible {
    omega: f64,
    damping: f64,
    position: f64,
    velocity: f64,
    command: f64,
}

impl Flexible {
    fn follow(&mut self, command: f64, period: f64) {
        const STEPS: u32 = 20;
        let h = period / f64::from(STEPS);
        for k in 0..STEPS {
            let at = |f: f64| self.command + (command - self.command) * (f64::from(k) + f) / f64::from(STEPS);
            // The midpoint rule.
            let acceleration = |p: f64, v: f64, u: f64| {
                self.omega * self.omega * (u - p) - 2.0 * self.damping * self.omega * v
            };
            let half_v = self.velocity + 0.5 * h * acceleration(self.position, self.velocity, at(0.0));
            let half_p = self.position + 0.5 * h * self.velocity;
            let middle = acceleration(half_p, half_v, at(0.5));
            self.position += h * half_v;
            self.velocity += h * middle;
        }
        self.command = command;
    }

    /// Amplitude of the vibration around the command.
    fn amplitude(&self) -> f64 {
        (self.position - self.command).hypot(self.velocity / self.omega)
    }
}

/// Greatest amplitude over the joints once the command rests, from modes of these frequencies on each joint.
fn ringing(rows: &[[f64; 6]], frequencies: &[f64], period: f64) -> f64 {
    let amplitude = |joint: usize, frequency: f64| {
        let start = rows[0][joint];
        let mut arm = Flexible {
            omega: TAU * frequency,
            damping: 0.02,
            position: start,
            velocity: 0.0,
            command: start,
        };
        rows.iter().for_each(|row| arm.follow(row[joint], period));
        arm.amplitude()
    };
    let all = (0..6).flat_map(|joint| frequencies.iter().map(move |frequency| (joint, *frequency)));
    all.map(|(joint, frequency)| amplitude(joint, frequency)).fold(0.0, f64::max)
}

/// What rings after the joint move, and after the line or a pause on it at an instant.
pub(crate) fn left_ringing(cell: &Cell, frequencies: &[f64], pause: Option<usize>) -> (f64, f64) {
    let mut run = Run::start(cell, 200.0);
    run.until(|output| output.status.marker == 1);
    let first = ringing(&run.rows(), frequencies, run.bench.period);
    if let Some(instant) = pause {
        for _ in 0..instant {
            run.cycle();
        }
        run.bench.input.event = Some(Event::Hold);
        run.until(|output| output.status.at_rest);
    } else {
        run.until(|output| output.status.marker == 2);
    }
    // What the first move left behind does not count.
    let begin = run.outputs.iter().position(|output| output.status.marker == 1).unwrap();
    (first, ringing(&run.rows()[begin..], frequencies, run.bench.period))
}

/// A line from stop to stop, a joint move and pauses on the line at four instants, each judged at the instant at which the controller says that the arm is
/// at rest: the flexible joints ring at most a thousandth of what they do without prefilter, with two modes as well.
#[test]
fn a_flexible_arm_does_not_ring() {
    for frequencies in [&[6.34][..], &[9.0, 23.0]] {
        for pause in [None, Some(250), Some(400), Some(650), Some(900)] {
            let bare = left_ringing(&Cell::default_cell().unwrap(), frequencies, pause);
            for name in ["zv", "zvd", "fir-zv", "fir-zvd", "mzv"] {
                let shaped = left_ringing(&flexible(name, frequencies), frequencies, pause);
                println!(
                    "{name} {frequencies:?} pause {pause:?}: {:.5} {:.5}",
                    shaped.0 / bare.0,
                    shaped.1 / bare.1
                );
                assert!(shaped.0 < 1e-3 * bare.0 && shaped.1 < 1e-3 * bare.1, "{name}: {shaped:?} {bare:?}");
            }
        }
    }
}

/// Random runs as in `chain`, with prefilters for slow modes and fast ones: limits, corner errors, and no speed above the programmed ones.
#[test]
fn corners_keep_their_error_behind_a_prefilter() {
    for (seed, name, modes) in
        [(31, "zv", &[9.0][..]), (32, "fir-zvd", &[6.34]), (33, "ei", &[14.0]), (34, "fir-zv", &[8.0, 25.0])]
    {
        random_runs(seed, 12, &flexible(name, modes));
    }
}

/// Runs of which the look-ahead for the prefilter ended with a corner: what rounding left of the way behind it had no joints, and the
/// arm would have had to jump.
#[test]
fn a_look_ahead_may_end_with_a_corner() {
    for (seed, name, modes, case) in [
        (8144, "fir-zv", &[11.0, 30.0], 18),
        (9143, "fir", &[11.0, 30.0], 37),
        (10149, "3hump-ei", &[11.0, 30.0], 3),
    ] {
        let (cell, mut random) = (flexible(name, modes), Random(seed));
        let runs = std::iter::repeat_with(|| RandomRun::new(&mut random, &cell));
        runs.skip(case).take(1).for_each(|run| run.judge(case));
    }
}

/// As above, many: `cargo test --release -p seamline-cell --test machine many_prefiltered -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn many_prefiltered_runs() {
    for (seed, name) in (41..).zip(NAMES) {
        random_runs(seed, 100, &flexible(name, &[7.0]));
        random_runs(seed + 100, 50, &flexible(name, &[11.0, 30.0]));
    }
}

/// Corners of a weld that are slow enough keep their speed as well.
#[test]
fn a_slow_weld_goes_round_its_corners_at_speed() {
    let way = Way::in_cell(
        flexible("fir-zvd", &[10.0]),
        &[([40.0, 0.0], 0.0), ([75.0, 13.0], 3.0), ([75.0, 60.0], 0.0), ([45.0, 25.0], -4.0)],
    );
    let parts = way.plan(&way.lines(8.0, Zone::Unspecified));
    let notices: Vec<_> = parts.iter().flat_map(|part| &part.notices).collect();
    assert!(notices.is_empty(), "{notices:?}");
    let trace = way.run(&parts);
    for pose in &way.poses[1..4] {
        let error = trace.distance(pose);
        assert!((0.05..=0.5).contains(&error), "{error}");
    }
    let speeds = trace.speeds();
    let middle = &speeds[400..speeds.len() - 600];
    // Round a corner the tool takes the shorter way in the same time; everywhere else it has its speed.
    assert!(middle.iter().all(|speed| (2.0..8.01).contains(speed)));
    let at_speed = middle.iter().filter(|speed| **speed > 7.92).count();
    assert!(at_speed * 10 > middle.len() * 9, "{at_speed} of {}", middle.len());
}

/// A zigzag with corners of 20 to 150 degrees and a right angle at speed: every corner within its error, the filter's part included, and the
/// tool never farther off its way than the path error and that.
#[test]
fn a_zigzag_keeps_its_corners_and_its_lines() {
    for mm_s in [10.0, 60.0, 200.0] {
        let way = Way::in_cell(
            flexible("fir-zvd", &[6.34]),
            &[
                ([40.0, 0.0], 0.0),
                ([75.0, 13.0], 3.0),
                ([75.0, 60.0], 0.0),
                ([45.0, 25.0], -4.0),
                ([80.0, 22.0], 0.0),
            ],
        );
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
