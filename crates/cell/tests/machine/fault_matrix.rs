//! Everything that can go wrong, at random instants of a weld, one by one and two at once: the right fault is named, the stop is a controlled
//! one within the limits, the arc is out, nothing moves again without a reset, and after reset and resume the job is done.

use rtrb::RingBuffer;
use seamline::control::{Command, CycleOutput, Event, Mode, Motion, NoClock};
use seamline::drive::DriveFault;
use seamline::kinematics::SixAxisArm;
use seamline::path::Path;
use seamline::safety::{Fault, StopCategory};
use seamline_cell::cell::{Cell, FaultKind, ScriptedFault};
use seamline_cell::run::{Devices, FaultScript, Machine};
use seamline_cell::sensor::CellSensor;
use seamline_cell::sim::{SimulatedArc, SimulatedDrive};

use crate::bench::{Ar2010, Random, independent_forward, independent_torch, worst_shares};
use crate::chain::HOME;
use crate::weld::{Track, default_cell, job, track, weld};

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Wrong {
    /// With devices, cycle times, planner or operator.
    Scripted(FaultKind),
    /// The commands end in the middle of a motion.
    Cut,
    /// A move lies out of reach, begins elsewhere, or nowhere.
    Unreachable,
    Displaced,
    Nowhere,
    /// A limit lies just before what the motion takes.
    Position,
    Velocity,
    Acceleration,
    Jerk,
    Workspace,
    /// The operator stops the job.
    Stop,
}

const ALL: [Wrong; 20] = {
    let mut all = [Wrong::Stop; 20];
    let mut k = 0;
    // Those of the seam sensor come last: this weld has none.
    while k < 10 {
        all[k] = Wrong::Scripted(FaultKind::ALL[k].1);
        k += 1;
    }
    (all[10], all[11], all[12], all[13]) = (Wrong::Cut, Wrong::Unreachable, Wrong::Displaced, Wrong::Nowhere);
    (all[14], all[15], all[16]) = (Wrong::Position, Wrong::Velocity, Wrong::Acceleration);
    (all[17], all[18]) = (Wrong::Jerk, Wrong::Workspace);
    all
};

impl Wrong {
    /// The fault is the one that this causes.
    fn causes(self, fault: &Fault) -> bool {
        use FaultKind as K;
        match self {
            Self::Scripted(K::DriveSilent) => *fault == Fault::Drive(DriveFault::Silent),
            Self::Scripted(K::DriveAlarm) => matches!(fault, Fault::Drive(DriveFault::Axis(..))),
            Self::Scripted(K::JointStuck | K::EncoderJump) => matches!(fault, Fault::FollowingError { .. }),
            Self::Scripted(K::EncoderNan) => matches!(fault, Fault::NotFinite { .. }),
            Self::Scripted(K::EmergencyStop) => *fault == Fault::EmergencyStop,
            Self::Scripted(K::LateCycles) => matches!(fault, Fault::Overrun { .. }),
            Self::Scripted(K::PlannerSilent) | Self::Cut => *fault == Fault::Starved,
            Self::Scripted(K::NoIgnition) => matches!(fault, Fault::ArcNotLit { .. }),
            Self::Scripted(K::ArcLoss) => matches!(fault, Fault::ArcLost { .. }),
            Self::Unreachable | Self::Nowhere => {
                matches!(fault, Fault::NoInverse { .. } | Fault::NotFinite { .. })
            }
            Self::Displaced => matches!(
                fault,
                Fault::VelocityLimit { .. } | Fault::AccelerationLimit { .. } | Fault::JerkLimit { .. }
            ),
            Self::Position => matches!(fault, Fault::PositionLimit { .. }),
            Self::Velocity => matches!(fault, Fault::VelocityLimit { .. }),
            Self::Acceleration => matches!(fault, Fault::AccelerationLimit { .. }),
            Self::Jerk => matches!(fault, Fault::JerkLimit { .. }),
            Self::Workspace => matches!(fault, Fault::Workspace { .. }),
            Self::Scripted(K::SensorSilent | K::SensorNan | K::SensorJump) => {
                matches!(fault, Fault::SeamLost { .. })
            }
            Self::Stop => false,
        }
    }

    /// The job itself is wrong, or the cell: it stays so after a reset.
    fn lasts(self) -> bool {
        !matches!(self, Self::Scripted(_) | Self::Stop)
    }
}

/// A weld in a cell, with the run that nothing interrupts.
struct Setting {
    cell: Cell,
    arm: Ar2010,
    commands: Vec<Command<6>>,
    track: Track,
}

type Controller = Machine<6, SixAxisArm, SimulatedDrive<6>, SimulatedArc, NoClock>;

impl Setting {
    fn new() -> Self {
        let mut cell = default_cell();
        for (joint, home) in cell.robot.joints.iter_mut().zip(HOME) {
            joint.home = home;
        }
        let (arm, commands) = job(&cell);
        let track = track(&weld(&cell));
        Self { cell, arm, commands, track }
    }

    /// Velocity, acceleration and jerk of a joint in the run that nothing interrupts.
    fn differences(&self, cycle: usize, joint: usize) -> [f64; 3] {
        let (q, period) = (|back: usize| self.track.rows[cycle - back][joint], self.cell.cycle.period);
        let d = |back: usize| (q(back) - q(back + 1)) / period;
        [d(0), (d(0) - d(1)) / period, (d(0) - 2.0 * d(1) + d(2)) / (period * period)]
    }

    /// The machine with something wrong in its job or its limits, and what goes wrong later.
    fn machine(&self, wrongs: &[Wrong], random: &mut Random) -> (Controller, FaultScript, Option<usize>) {
        let (mut cell, mut arm, mut commands) = (self.cell.clone(), self.arm.clone(), self.commands.clone());
        let (mut script, mut stop) = (Vec::new(), None);
        let start = random.unit() * self.track.rows.len() as f64;
        for wrong in wrongs {
            // The second one comes within 100 ms of the first.
            let cycle =
                (start + random.unit() * 100.0).clamp(10.0, self.track.rows.len() as f64 - 1.0) as usize;
            let joint = (random.unit() * 6.0) as usize;
            let moves: Vec<_> = (0..commands.len())
                .filter(|k| matches!(&commands[*k], Command::Move(block) if matches!(block.motion, Motion::Path(_))))
                .collect();
            let chosen = moves[(random.unit() * moves.len() as f64) as usize];
            match wrong {
                Wrong::Scripted(kind) => {
                    // The arc is struck in the first fifth of the run.
                    let cycle = if *kind == FaultKind::NoIgnition { cycle / 5 } else { cycle };
                    script.push(ScriptedFault { kind: *kind, time: cycle as f64 * cell.cycle.period, joint });
                }
                Wrong::Stop => stop = Some(cycle),
                Wrong::Cut => {
                    // A move that another one continues.
                    let moving =
                        |k: &&usize| matches!(&commands[**k], Command::Move(block) if !block.ends_at_rest);
                    let moving: Vec<_> = moves.iter().filter(moving).collect();
                    commands.truncate(moving[(random.unit() * moving.len() as f64) as usize] + 1);
                }
                Wrong::Unreachable => displace(&mut commands[chosen], 10.0),
                Wrong::Displaced => displace(&mut commands[chosen], 0.01),
                Wrong::Nowhere => displace(&mut commands[chosen], f64::NAN),
                Wrong::Velocity => arm.limits.velocity[joint] = below(self.differences(cycle, joint)[0]),
                Wrong::Acceleration => {
                    arm.limits.acceleration[joint] = below(self.differences(cycle, joint)[1])
                }
                Wrong::Jerk => arm.limits.jerk[joint] = below(self.differences(cycle, joint)[2]),
                Wrong::Position => {
                    let (q, first) = (self.track.rows[cycle][joint], HOME[joint]);
                    let range = &mut arm.limits.position[joint];
                    let margin = 1e-6;
                    if q > first { range.1 = q.max(first + margin) } else { range.0 = q.min(first - margin) }
                }
                Wrong::Workspace => {
                    let tool = |q: &[f64; 6]| (independent_forward(q) * independent_torch()).translation.y;
                    cell.safety.workspace_max.y = tool(&self.track.rows[cycle]).max(tool(&HOME) + 1e-6);
                }
            }
        }
        let (mut producer, consumer) = RingBuffer::new(commands.len());
        commands.into_iter().for_each(|command| producer.push(command).unwrap());
        let drive = SimulatedDrive::from_cell(&cell).unwrap();
        let devices = Devices {
            drive,
            arc: SimulatedArc::from_cell(&cell),
            seam: CellSensor::from_cell(&cell).unwrap(),
        };
        let machine = Machine::new(&cell, &arm, devices, NoClock, consumer).unwrap();
        (machine, FaultScript::new(&script), stop)
    }
}

/// A limit that a value passes, and not at rest.
fn below(value: f64) -> f64 {
    (0.999 * value.abs()).max(1e-3)
}

fn displace(command: &mut Command<6>, metres: f64) {
    let Command::Move(block) = command else { panic!("a move was chosen") };
    let Motion::Path(motion) = &mut block.motion else { panic!("along a path") };
    motion.path = moved(&motion.path, metres);
}

/// The line between the path's ends, elsewhere.
fn moved(path: &Path, metres: f64) -> Path {
    let at = |s: f64| {
        let mut pose = path.pose(s);
        pose.translation.vector.z += metres;
        pose
    };
    Path::line(&at(0.0), &at(path.length()))
}

/// A run with something wrong.
struct Run<'a> {
    setting: &'a Setting,
    machine: Controller,
    script: FaultScript,
    stop: Option<usize>,
    cycles: usize,
    /// Commands under power.
    rows: Vec<[f64; 6]>,
}

impl Run<'_> {
    fn cycle(&mut self) -> CycleOutput<6> {
        self.script.act(&mut self.machine);
        if self.stop == Some(self.cycles) {
            self.machine.request(Event::Stop);
        }
        let (output, _) = self.machine.cycle();
        assert!(output.command.position.iter().all(|q| q.is_finite()));
        let welds = matches!(output.status.mode, Mode::Running | Mode::Resuming);
        assert!(welds || !output.arc.on, "an arc in {:?}", output.status.mode);
        if output.power {
            self.rows.push(output.command.position);
        }
        self.cycles += 1;
        output
    }

    fn ask(&mut self, event: Event) -> CycleOutput<6> {
        self.machine.request(event);
        self.cycle()
    }

    /// To the end of the job, or to rest after a fault.
    fn until_rest(&mut self) -> CycleOutput<6> {
        for _ in 0..60_000 {
            let output = self.cycle();
            let rests = output.status.mode == Mode::Fault && output.status.at_rest;
            if rests || output.status.mode == Mode::Standstill {
                return output;
            }
        }
        panic!("it comes to no end");
    }

    fn assert_within_limits(&mut self) {
        let shares = worst_shares(&self.rows, &self.setting.arm, self.setting.cell.cycle.period);
        assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
        self.rows.clear();
    }
}

/// One run; the fault that was named.
fn run(setting: &Setting, wrongs: &[Wrong], random: &mut Random) -> Option<Fault> {
    let (machine, script, stop) = setting.machine(wrongs, random);
    let mut run = Run { setting, machine, script, stop, cycles: 0, rows: Vec::new() };
    run.ask(Event::Enable);
    run.ask(Event::Start);
    let (mut named, mut powerless) = (None, false);
    // Two faults may come one after the other; each ends by itself once it is cleared.
    for _ in 0..4 {
        let rest = run.until_rest();
        let last = rest.command.position;
        run.assert_within_limits();
        let Some(fault) = rest.status.fault else {
            let end = setting.track.rows[setting.track.rows.len() - 1];
            let done = last.iter().zip(end).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(done || run.stop.is_some(), "the job is done: {last:?}");
            let off = if done { 0.0 } else { setting.track.off(&last) };
            assert!(off < 1e-6 || wrongs.len() > 1, "a stop on the path: {off} m");
            return named;
        };
        // After a time without power the arm is taken to stand where its encoders say.
        let jumped = powerless && wrongs.contains(&Wrong::Scripted(FaultKind::EncoderJump));
        let outside = jumped && matches!(fault, Fault::Workspace { .. } | Fault::PositionLimit { .. });
        assert!(outside || wrongs.iter().any(|wrong| wrong.causes(&fault)), "{wrongs:?}: {fault:?}");
        powerless |= fault.category() == StopCategory::Category0;
        named = named.or(Some(fault));
        if fault.category() == StopCategory::Category2 && wrongs.len() == 1 && named == Some(fault) {
            assert!(setting.track.off(&last) < 1e-6, "a stop on the path: {} m", setting.track.off(&last));
        }
        for event in [Event::Resume, Event::Start, Event::Enable] {
            let output = run.ask(event);
            assert_eq!((output.status.mode, output.command.position), (Mode::Fault, last), "{event:?}");
        }
        // There the controller stays until it is started anew.
        if outside || wrongs.iter().any(|wrong| wrong.lasts()) {
            return named;
        }
        run.script.clear(&mut run.machine);
        // Until the joints are where they are commanded to be.
        (0..300).for_each(|_| {
            run.cycle();
        });
        let reset = run.ask(Event::Reset);
        if reset.status.mode == Mode::Standstill {
            return named;
        }
        if wrongs.len() > 1 && reset.status.fault.is_some() {
            // The second one has come in the meantime.
            continue;
        }
        assert_eq!((reset.status.mode, reset.status.fault), (Mode::Holding, None));
        // Without power the arm may have come elsewhere.
        run.rows.clear();
        assert_eq!(run.ask(Event::Resume).status.refused, None);
    }
    panic!("a fault that is cleared comes again and again");
}

/// Runs of each kind, one a seed.
fn singles(seeds: std::ops::Range<u64>) {
    let setting = Setting::new();
    let kind = |(k, wrong): (usize, Wrong)| {
        let of_seed = |seed: u64| run(&setting, &[wrong], &mut Random(seed * 1_000 + k as u64));
        let (faults, runs) = (seeds.clone().filter_map(of_seed).count(), seeds.clone().count());
        println!("{wrong:?}: {faults} faults in {runs} runs");
        // The whole job fits between planner and cycle: a planner that falls silent is not missed.
        let harmless = matches!(wrong, Wrong::Stop | Wrong::Scripted(FaultKind::PlannerSilent));
        assert!(harmless == (faults == 0), "{wrong:?}");
    };
    // Two threads, each with every other kind.
    std::thread::scope(|scope| {
        for first in [0, 1] {
            scope.spawn(move || ALL.into_iter().enumerate().skip(first).step_by(2).for_each(kind));
        }
    });
}

/// Two kinds within 100 ms, or one twice.
fn pairs(seeds: std::ops::Range<u64>) {
    let setting = Setting::new();
    let (mut faults, runs) = (0, seeds.clone().count());
    for seed in seeds {
        let mut random = Random(seed ^ 0x5EA);
        let wrongs = [(); 2].map(|()| ALL[(random.unit() * ALL.len() as f64) as usize]);
        faults += usize::from(run(&setting, &wrongs, &mut random).is_some());
    }
    println!("two at once: {faults} faults in {runs} runs");
    assert!(faults > runs / 2, "{faults} of {runs}");
}

/// 20 kinds, 8 seeds each.
#[test]
fn each_fault_is_named_and_the_job_goes_on() {
    singles(0..8);
}

/// 100 pairs.
#[test]
fn two_faults_at_once_are_borne() {
    pairs(0..100);
}

/// 20 kinds, 1,000 seeds each: `cargo test --release -p seamline-cell --test machine a_thousand_faults -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn a_thousand_faults_of_each_kind() {
    singles(0..1_000);
}

/// 1,000 pairs: `cargo test --release -p seamline-cell --test machine a_thousand_pairs -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn a_thousand_pairs_of_faults() {
    pairs(0..1_000);
}
