//! What several tests need: an independent arm model, and runs of planned steps.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use seamline::control::{
    Command, CommandSource, Cycle, CycleConfig, CycleInput, CycleOutput, Event, NoClock, PrefilterEntry,
    ServoModel,
};
use seamline::drive::Drive;
use seamline::kinematics::SixAxisArm;
use seamline::safety::WorkspaceBox;
use seamline_cell::cell::Cell;
use seamline_cell::job::{
    Action, Coordinates, JobPosition, Location, Move, MovePath, PositionKind, PositionName, Speed,
    SpeedOrigin, Step, Target, Zone, pulses_from_joints,
};
use seamline_cell::plan::{Arm, Planner};
use seamline_cell::run::joint_prefilter;
use seamline_cell::sim::SimulatedDrive;

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

pub(crate) struct Queue(pub(crate) VecDeque<Command<6>>);

impl CommandSource<6> for Queue {
    fn next(&mut self) -> Option<Command<6>> {
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
pub(crate) fn move_to(line: u32, path: MovePath, speed: Speed, arm: &Ar2010, joints: &[f64; 6]) -> Step {
    let pulses = pulses_from_joints(joints, &arm.pulses_per_unit);
    let name = PositionName { local: false, kind: PositionKind::C, number: line };
    let position = JobPosition { coordinates: Coordinates::Pulses(pulses), tool: 0 };
    step(
        line,
        Action::Move(Box::new(Move {
            path,
            target: Target { name, position },
            speed,
            speed_origin: SpeedOrigin::Written,
            zone: Zone::Exact,
            acceleration: 1.0,
            deceleration: 1.0,
            no_wait: false,
        })),
    )
}

pub(crate) fn config(cell: &Cell, arm: &Ar2010) -> CycleConfig<6> {
    let planner = Planner::new(arm, cell, arm.home).unwrap();
    CycleConfig {
        period: cell.cycle.period,
        limits: arm.limits,
        workspace: WorkspaceBox { low: cell.safety.workspace_min, high: cell.safety.workspace_max },
        flange_from_tcp: *planner.flange_from_tcp(),
        servo: ServoModel {
            lag: std::array::from_fn(|joint| cell.simulation.servo_lag[joint]),
            feed_forward: [cell.simulation.velocity_feed_forward; 6],
            following_error: arm.following_error,
        },
        overruns_in_row: 10,
    }
}

/// A controller with its simulated drives.
pub(crate) struct Bench {
    pub(crate) cycle: Cycle<6, SixAxisArm, Box<[PrefilterEntry<6>]>>,
    pub(crate) drive: SimulatedDrive<6>,
    pub(crate) queue: Queue,
    pub(crate) input: CycleInput<6>,
    pub(crate) period: f64,
}

impl Bench {
    pub(crate) fn new(cell: &Cell, arm: &Ar2010, commands: Vec<Command<6>>) -> Self {
        Self::with_drive(cell, arm, SimulatedDrive::from_cell(cell).unwrap(), commands)
    }

    pub(crate) fn with_drive(
        cell: &Cell,
        arm: &Ar2010,
        drive: SimulatedDrive<6>,
        commands: Vec<Command<6>>,
    ) -> Self {
        let mut bench = Self {
            cycle: Cycle::with_prefilter(
                config(cell, arm),
                arm.kinematics,
                joint_prefilter(cell).unwrap(),
                arm.home,
            ),
            drive,
            queue: Queue(commands.into()),
            input: CycleInput {
                measured: Ok(arm.home),
                speed_override: 1.0,
                event: None,
                fault: None,
                late: false,
            },
            period: cell.cycle.period,
        };
        bench.cycle_with(Event::Enable);
        bench
    }

    pub(crate) fn cycle_with(&mut self, event: Event) -> CycleOutput<6> {
        self.input.event = Some(event);
        let output = self.cycle();
        assert_eq!(output.status.refused, None, "{event:?}");
        output
    }

    pub(crate) fn cycle(&mut self) -> CycleOutput<6> {
        let output = self.cycle.step(&self.input, &mut self.queue, &mut NoClock);
        self.input.event = None;
        self.input.fault = None;
        self.input.measured = Drive::exchange(&mut self.drive, &output.command, self.period);
        output
    }
}

/// Largest differences of the commands as shares of the limits: velocity, acceleration, jerk.
pub(crate) fn worst_shares(commands: &[[f64; 6]], arm: &Ar2010, period: f64) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for q in commands.windows(4) {
        for joint in 0..6 {
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
