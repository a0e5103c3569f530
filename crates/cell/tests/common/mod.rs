//! Random tool paths of an AR2010-class arm, beside its singularities too, as the joints see them.

#![allow(dead_code, reason = "tests and the example each use a part")]
#![allow(clippy::panic, reason = "a generator without a result is a broken test")]

pub(crate) mod planar;

use core::f64::consts::TAU;
use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::kinematics::{InverseError, JointJet, Kinematics, Posture, SphericalWristArm, models};
use seamline::path::Path;
use seamline_cell::plan::timing::{
    Course, JointPath, PathLimits, Stretch, Timing, TimingError, TimingLimits, time_path,
};

/// Neighbouring places of a trace differ by at most this in any joint.
const TRACE_STEP: f64 = 0.2;
const TRACE_DEPTH: u32 = 50;

/// A tool path with the joints' branch followed along it.
#[derive(Clone)]
pub(crate) struct ArmPath {
    arm: SphericalWristArm,
    path: Path,
    tool_from_flange: Pose,
    /// Kept all along: beside a singularity the joints turn, they do not flip.
    posture: Posture,
    trace: Vec<(f64, [f64; 6])>,
}

impl ArmPath {
    /// The path, on the branch of `q` at `s`. None where the arm cannot follow it all along.
    pub(crate) fn try_new(path: Path, flange_from_tool: &Pose, s: f64, q: [f64; 6]) -> Option<Self> {
        let tool_from_flange = flange_from_tool.inverse();
        let arm = models::ar2010();
        let posture = arm.posture(&q);
        let mut made = Self { arm, path, tool_from_flange, posture, trace: Vec::new() };
        let mut back = made.traced(s, q, 0.0)?;
        back.reverse();
        let on = made.traced(s, q, path.length())?;
        back.pop();
        back.extend(on);
        made.trace = back;
        Some(made)
    }

    fn traced(&self, from: f64, q: [f64; 6], to: f64) -> Option<Vec<(f64, [f64; 6])>> {
        let mut trace = vec![(from, q)];
        let mut waiting = vec![(to, 0)];
        while let Some(&(s, depth)) = waiting.last() {
            let (before, seed) = trace[trace.len() - 1];
            let next = self.inverse(s, &seed)?;
            let near = next.iter().zip(&seed).all(|(a, b)| (a - b).abs() < TRACE_STEP);
            if near && (s - before).abs() < self.path.length() / 7.0 {
                trace.push((s, next));
                waiting.pop();
            } else if depth < TRACE_DEPTH {
                waiting.last_mut()?.1 += 1;
                waiting.push(((before + s) / 2.0, depth + 1));
            } else {
                return None;
            }
        }
        Some(trace)
    }

    fn flange(&self, s: f64) -> Pose {
        self.path.pose(s) * self.tool_from_flange
    }

    fn inverse(&self, s: f64, seed: &[f64; 6]) -> Option<[f64; 6]> {
        let solutions = self.arm.inverse(&self.flange(s), seed).ok()?;
        let same = solutions.as_slice().iter().find(|solution| solution.posture == self.posture)?;
        let turns: [f64; 6] = core::array::from_fn(|i| ((seed[i] - same.q[i]) / TAU).round());
        let q = core::array::from_fn(|i| same.q[i] + TAU * turns[i]);
        self.arm.limits().first_violation(&q).is_none().then_some(q)
    }

    pub(crate) fn joints(&self, s: f64) -> Option<[f64; 6]> {
        let next = self.trace.partition_point(|&(place, _)| place <= s).clamp(1, self.trace.len() - 1);
        let ((s0, q0), (s1, q1)) = (self.trace[next - 1], self.trace[next]);
        let share = (s - s0) / (s1 - s0);
        let seed = core::array::from_fn(|i| q0[i] + share * (q1[i] - q0[i]));
        self.inverse(s, &seed)
    }
}

impl JointPath<6> for ArmPath {
    /// `None`: no joint positions. `Some`: no derivatives.
    type Error = Option<InverseError>;

    fn length(&self) -> f64 {
        self.path.length()
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<6>, Self::Error> {
        let q = self.joints(s).ok_or(None)?;
        self.arm.joint_jet(&self.path.jet(s).attached(&self.tool_from_flange), &q).map_err(Some)
    }
}

/// The timing of a path with one set of limits, from rest to rest.
pub(crate) fn time_alone<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    limits: &PathLimits,
) -> Result<Timing, TimingError<P::Error>> {
    let stretches = [Stretch { to: path.length(), limits: *limits }];
    time_path(path, joints, &Course::whole(&stretches))
}

/// What a random move is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Line,
    Arc,
    BesideWrist,
    BesideShoulder,
    /// A thousand times closer.
    NeedleWrist,
    NeedleShoulder,
}

impl Kind {
    /// A mix: of five moves one is an arc, one beside the wrist's and one beside the shoulder's singularity.
    pub(crate) fn of(index: usize) -> Self {
        [Self::Arc, Self::BesideWrist, Self::BesideShoulder, Self::Line, Self::Line][index % 5]
    }

    pub(crate) fn needle(index: usize) -> Self {
        [Self::NeedleWrist, Self::NeedleShoulder][index % 2]
    }

    /// How near the singularity is passed, in radians or metres.
    fn distance(self, random: &mut Random) -> f64 {
        match self {
            Self::BesideWrist => random.log_within(1e-6, 2e-2),
            Self::BesideShoulder => random.log_within(1e-6, 1e-2),
            _ => random.log_within(1e-8, 1e-6),
        }
    }
}

/// The seed of the moves that `data/path_timing_toppra.csv` speaks of.
pub(crate) const REFERENCE_SEED: u64 = 1;

/// A random move.
pub(crate) struct Move {
    pub(crate) kind: Kind,
    pub(crate) path: ArmPath,
    pub(crate) limits: PathLimits,
}

/// Limits of the default cell: full speed in 0.2 s (0.125 s for the wrist), jerk 50 times the acceleration a
/// second.
pub(crate) fn joint_limits() -> TimingLimits<6> {
    let radians = |values: [f64; 6]| values.map(f64::to_radians);
    let acceleration = radians([1050.0, 1050.0, 1100.0, 3480.0, 3480.0, 5600.0]);
    TimingLimits {
        velocity: radians([210.0, 210.0, 220.0, 435.0, 435.0, 700.0]),
        acceleration,
        jerk: acceleration.map(|a| 50.0 * a),
    }
}

/// A torch: 459 mm ahead of the flange, bent by 22°.
pub(crate) fn torch() -> Pose {
    let bend = Rotation::from_axis_angle(&Vector3::y_axis(), -22f64.to_radians());
    Pose::from_parts([-0.04383, 0.0, 0.45848].into(), bend)
}

/// A repeatable source of randomness (splitmix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn log_within(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    fn direction(&mut self) -> Vector3 {
        let z = self.within(-1.0, 1.0);
        let (sin, cos) = self.within(0.0, TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    }

    fn joints(&mut self, arm: &SphericalWristArm) -> [f64; 6] {
        arm.position_limits().map(|(low, high)| {
            let margin = 0.1 * (high - low);
            self.within(low + margin, high - margin)
        })
    }
}

/// A random move of the kind, tried until the arm can follow it.
pub(crate) fn random_move(random: &mut Random, kind: Kind) -> Move {
    for _ in 0..100_000 {
        if let Some(path) = candidate(random, kind) {
            let speed = random.log_within(0.005, 1.0);
            let (rise, most) = (0.04, (10.0, 500.0));
            let limits = PathLimits {
                speed,
                acceleration: (2.0 * speed / rise).min(most.0),
                jerk: (8.0 * speed / (rise * rise)).min(most.1),
            };
            return Move { kind, path, limits };
        }
    }
    panic!("no {kind:?} found");
}

fn candidate(random: &mut Random, kind: Kind) -> Option<ArmPath> {
    let (arm, tool) = (models::ar2010(), torch());
    let mut middle = random.joints(&arm);
    match kind {
        Kind::Line | Kind::Arc => {}
        Kind::BesideWrist | Kind::NeedleWrist => {
            let side = if random.unit() < 0.5 { -1.0 } else { 1.0 };
            middle[4] = side * kind.distance(random);
        }
        Kind::BesideShoulder | Kind::NeedleShoulder => {
            let distance = kind.distance(random);
            middle = above_axis_1(random, distance, &arm)?;
        }
    }
    let pose = arm.forward(&middle) * tool;
    let length = random.log_within(0.05, 0.8);
    let turn = Rotation::from_scaled_axis(random.direction() * random.within(0.0, 0.5));
    let direction = random.direction();
    let share = random.within(0.3, 0.7);
    let displaced = |distance: f64, turned: f64| {
        let rotation = Rotation::default().slerp(&turn, turned.abs());
        let rotation = if turned < 0.0 { rotation.inverse() } else { rotation };
        Pose::from_parts((pose.translation.vector + direction * distance).into(), rotation * pose.rotation)
    };
    let (start, end) = (displaced(-share * length, -share), displaced((1.0 - share) * length, 1.0 - share));
    if kind != Kind::Arc {
        return ArmPath::try_new(Path::line(&start, &end), &tool, share * length, middle);
    }
    let normal = direction.cross(&random.direction()).normalize();
    let via = pose.translation.vector + normal * (length * random.log_within(0.05, 0.5));
    let via = Pose::from_parts(via.into(), pose.rotation);
    let path = Path::arc(&start, &via, &end).ok()?;
    let first = arm.inverse_nearest(&(start * tool.inverse()), &middle).ok()?;
    ArmPath::try_new(path, &tool, 0.0, first)
}

/// Joints whose wrist centre lies at this distance from axis 1.
fn above_axis_1(random: &mut Random, radius: f64, arm: &SphericalWristArm) -> Option<[f64; 6]> {
    let angle = random.within(-3.0, 3.0);
    let position = Vector3::new(radius * angle.cos(), radius * angle.sin(), random.within(0.6, 1.7));
    let rotation = Rotation::from_scaled_axis(random.direction() * random.within(0.0, 3.0));
    let wrist = Pose::from_parts(position.into(), rotation);
    let flange = wrist * arm.geometry().wrist_from_flange;
    let solutions = arm.inverse_within_limits(&flange, &[0.0; 6]).ok()?;
    let choice = (random.unit() * solutions.as_slice().len() as f64) as usize;
    solutions.as_slice().get(choice).map(|solution| solution.q)
}
