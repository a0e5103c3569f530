//! What several tests need: an independent arm model, and runs of planned steps.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use seamline::arc::ArcSource;
use seamline::control::{
    ActsOn, ArcRules, Command, CommandSource, Cycle, CycleConfig, CycleInput, CycleOutput, Event, Mode,
    NoClock, PrefilterEntry, ServoModel,
};
use seamline::drive::Drive;
use seamline::kinematics::SixAxisArm;
use seamline::safety::WorkspaceBox;
use seamline::seam::NoSensor;
use seamline_cell::cell::Cell;
use seamline_cell::job::{
    Action, Coordinates, JobPosition, Location, Move, MovePath, PositionKind, PositionName, Speed,
    SpeedOrigin, Step, Target, Zone, pulses_from_joints,
};
use seamline_cell::plan::{Arm, PlanError, Planned, Planner, PlanningArm};
use seamline_cell::run::{arc_rules, command_prefilter};
use seamline_cell::sim::{SimulatedArc, SimulatedDrive};

pub(crate) type Ar2010 = Arm<6, SixAxisArm>;

/// Flange pose of the default robot by the product of exponentials, from the makers' data alone: axes at zero z, y, −y,
/// −x, −y, −x through the points named; flange at zero at (1.332, 0, 0.960) with z along +x and x along +z.
pub(crate) fn independent_forward(q: &[f64; 6]) -> Isometry3<f64> {
    let axes = [
        (Vector3::z(), Vector3::zeros()),
        (Vector3::y(), Vector3::new(0.150, 0.0, 0.0)),
        (-Vector3::y(), Vector3::new(0.150, 0.0, 0.760)),
        (-Vector3::x(), Vector3::new(0.150, 0.0, 0.960)),
        (-Vector3::y(), Vector3::new(1.232, 0.0, 0.960)),
        (-Vector3::x(), Vector3::new(1.232, 0.0, 0.960)),
    ];
    let zero = nalgebra::Matrix3::from_columns(&[Vector3::z(), -Vector3::y(), Vector3::x()]);
    let flange = UnitQuaternion::from_matrix(&zero);
    let mut pose = Isometry3::from_parts(Translation3::new(1.332, 0.0, 0.960), flange);
    for (angle, (axis, point)) in q.iter().zip(axes).rev() {
        let turn = UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), *angle);
        pose = Isometry3::from_parts((point - turn * point).into(), turn) * pose;
    }
    pose
}

/// The default torch: translation (−43.83, 0, 458.48) mm, then −22° about y.
pub(crate) fn independent_torch() -> Isometry3<f64> {
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -22_f64.to_radians());
    Isometry3::from_parts(Translation3::new(-0.04383, 0.0, 0.45848), tilt)
}

#[derive(Clone)]
pub(crate) struct Queue<const N: usize>(pub(crate) VecDeque<Command<N>>);

impl<const N: usize> CommandSource<N> for Queue<N> {
    fn next(&mut self) -> Option<Command<N>> {
        self.0.pop_front()
    }
}

pub(crate) fn location(line: u32) -> Location {
    Location { job: Arc::from("TEST"), line }
}

pub(crate) fn step(line: u32, action: Action) -> Step {
    Step { at: location(line), action, notes: Vec::new() }
}

/// A move to joint positions, given in pulses as a robot saves them.
pub(crate) fn move_to<const N: usize, K>(
    line: u32,
    path: MovePath,
    speed: Speed,
    arm: &Arm<N, K>,
    joints: &[f64; N],
) -> Step {
    let pulses = pulses_from_joints(joints, &arm.pulses_per_unit);
    move_at(line, path, speed, Coordinates::Pulses(pulses))
}

/// A move to a position with tool 0, which ends at rest.
pub(crate) fn move_at(line: u32, path: MovePath, speed: Speed, coordinates: Coordinates) -> Step {
    let name = PositionName { local: false, kind: PositionKind::C, number: line };
    let position = JobPosition { coordinates, tool: 0 };
    step(
        line,
        Action::Move(Box::new(Move {
            path,
            target: Target { name: Some(name), position },
            speed,
            speed_origin: SpeedOrigin::Written,
            zone: Zone::Exact,
            acceleration: 1.0,
            deceleration: 1.0,
            no_wait: false,
        })),
    )
}

/// The step with another zone.
pub(crate) fn with_zone(mut step: Step, zone: Zone) -> Step {
    if let Action::Move(r#move) = &mut step.action {
        r#move.zone = zone;
    }
    step
}

/// What the steps become, all planned ahead.
pub(crate) fn planned<const N: usize, K: PlanningArm<N>>(
    cell: &Cell,
    arm: &Arm<N, K>,
    steps: &[Step],
) -> Result<Vec<Planned<N>>, PlanError> {
    let mut planner = Planner::new(arm, cell, arm.home).unwrap();
    let mut parts = Vec::new();
    for step in steps {
        planner.take(step, &mut parts)?;
    }
    planner.finish(&mut parts)?;
    Ok(parts)
}

/// The commands of a whole run. As in a run of the program, a marker follows each part.
pub(crate) fn commands<const N: usize>(parts: &[Planned<N>]) -> Vec<Command<N>> {
    let mark = |(k, part): (usize, &Planned<N>)| {
        part.commands.iter().copied().chain([Command::Marker(k as u32 + 1)]).collect::<Vec<_>>()
    };
    parts.iter().enumerate().flat_map(mark).chain([Command::End]).collect()
}

pub(crate) fn config<const N: usize, K: PlanningArm<N>>(cell: &Cell, arm: &Arm<N, K>) -> CycleConfig<N> {
    let planner = Planner::new(arm, cell, arm.home).unwrap();
    CycleConfig {
        period: cell.cycle.period,
        limits: arm.limits,
        workspace: WorkspaceBox { low: cell.safety.workspace_min, high: cell.safety.workspace_max },
        flange_from_tcp: *planner.flange_from_tcp(),
        servo: ServoModel {
            lag: std::array::from_fn(|joint| cell.simulation.servo_lag[joint]),
            feed_forward: [cell.simulation.velocity_feed_forward; N],
            following_error: arm.following_error,
        },
        overruns_in_row: 10,
        arc: ArcRules::PLAIN,
    }
}

/// A controller with its simulated drives, and with a power source where it welds.
#[derive(Clone)]
pub(crate) struct Bench<const N: usize = 6, K = SixAxisArm> {
    pub(crate) cycle: Box<Cycle<N, K, Box<[PrefilterEntry<N>]>>>,
    pub(crate) drive: SimulatedDrive<N>,
    pub(crate) arc: Option<SimulatedArc>,
    pub(crate) queue: Queue<N>,
    pub(crate) input: CycleInput<N>,
    pub(crate) period: f64,
}

impl<const N: usize, K: PlanningArm<N>> Bench<N, K> {
    /// With the cell's drives, which stand where the arm does.
    pub(crate) fn new(cell: &Cell, arm: &Arm<N, K>, commands: Vec<Command<N>>) -> Self {
        let mut cell = cell.clone();
        for (joint, home) in cell.robot.joints.iter_mut().zip(arm.home) {
            joint.home = home;
        }
        Self::with_drive(&cell, arm, SimulatedDrive::from_cell(&cell).unwrap(), commands)
    }

    /// With the power source of the cell, handled as the cell says.
    pub(crate) fn welding(cell: &Cell, arm: &Arm<N, K>, commands: Vec<Command<N>>) -> Self {
        let config = CycleConfig { arc: arc_rules(cell), ..config(cell, arm) };
        let bench = Self::new(cell, arm, commands);
        let cycle =
            Cycle::with_prefilter(config, arm.kinematics.clone(), command_prefilter(cell).unwrap(), arm.home);
        let mut bench = Self { cycle: Box::new(cycle), arc: Some(SimulatedArc::from_cell(cell)), ..bench };
        bench.cycle_with(Event::Enable);
        bench
    }

    pub(crate) fn with_drive(
        cell: &Cell,
        arm: &Arm<N, K>,
        drive: SimulatedDrive<N>,
        commands: Vec<Command<N>>,
    ) -> Self {
        let prefilter = command_prefilter(cell).unwrap();
        let mut bench = Self {
            cycle: Box::new(Cycle::with_prefilter(
                config(cell, arm),
                arm.kinematics.clone(),
                prefilter,
                arm.home,
            )),
            drive,
            arc: None,
            queue: Queue(commands.into()),
            input: CycleInput {
                measured: Ok(arm.home),
                speed_override: 1.0,
                event: None,
                fault: None,
                late: false,
                arc_burning: None,
            },
            period: cell.cycle.period,
        };
        bench.cycle_with(Event::Enable);
        bench
    }

    /// From the start of the job to its end, without a fault: the commanded joints and the segment of each cycle. The joints' limits
    /// hold.
    pub(crate) fn run_to_end(&mut self, arm: &Arm<N, K>) -> (Vec<[f64; N]>, Vec<u32>) {
        self.cycle_with(Event::Start);
        let (mut joints, mut segments) = (Vec::new(), Vec::new());
        for _ in 0..100_000 {
            let output = self.cycle();
            assert_eq!(output.status.fault, None);
            joints.push(output.command.position);
            segments.push(output.status.segment);
            if output.status.mode == Mode::Standstill {
                let shares = worst_shares(&joints, arm, self.period);
                assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
                return (joints, segments);
            }
        }
        panic!("the run does not end");
    }

    pub(crate) fn cycle_with(&mut self, event: Event) -> CycleOutput<N> {
        self.input.event = Some(event);
        let output = self.cycle();
        assert_eq!(output.status.refused, None, "{event:?}");
        output
    }

    pub(crate) fn cycle(&mut self) -> CycleOutput<N> {
        let output = self.cycle.step(&self.input, &mut self.queue, &mut NoSensor, &mut NoClock);
        self.input.event = None;
        self.input.fault = None;
        self.input.measured = Drive::exchange(&mut self.drive, &output.command, self.period);
        self.input.arc_burning =
            self.arc.as_mut().and_then(|source| source.exchange(&output.arc, self.period));
        output
    }
}

/// Largest differences of the commands as shares of the limits: velocity, acceleration, jerk.
pub(crate) fn worst_shares<const N: usize, K>(
    commands: &[[f64; N]],
    arm: &Arm<N, K>,
    period: f64,
) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for q in commands.windows(4) {
        for joint in 0..N {
            let d = |k: usize| (q[k + 1][joint] - q[k][joint]) / period;
            let shares = [
                d(2) / arm.limits.velocity[joint],
                (d(2) - d(1)) / period / arm.limits.acceleration[joint],
                (d(2) - 2.0 * d(1) + d(0)) / (period * period) / arm.limits.jerk[joint],
            ];
            worst = std::array::from_fn(|k| worst[k].max(shares[k].abs()));
        }
    }
    worst
}

/// A cell whose arm has flexible modes (Hz), and a prefilter for them.
pub(crate) fn flexible(prefilter: &str, modes: &[f64]) -> Cell {
    let mut text = format!("[vibration]\nprefilter = \"{prefilter}\"\n[arc]\nrefuse_slowdown = false\n");
    for (k, frequency) in modes.iter().enumerate() {
        let number = k + 1;
        text +=
            &format!("[[flexible_mode]]\nnumber = {number}\nfrequency_hz = {frequency:?}\ndamping = 0.02\n");
    }
    Cell::parse(&text, "flexible.toml").unwrap()
}

/// The same with the prefilter on the feedrate.
pub(crate) fn on_feedrate(prefilter: &str, modes: &[f64]) -> Cell {
    let mut cell = flexible(prefilter, modes);
    cell.vibration = cell.vibration.acting_on(ActsOn::Feedrate);
    cell
}

/// splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
