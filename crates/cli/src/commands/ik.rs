//! `seamline ik`: inverse kinematics.

use std::hint::black_box;
use std::path::PathBuf;

use seamline::geometry::{Pose, Rotation};
use seamline::kinematics::{InverseError, JointKind, Kinematics};
use seamline_cell::robot::{ArmDescription, ArmTask, Inverse};
use serde::Serialize;

use super::fk::MODERATE;
use crate::json_lines::bench::{Times, read_all};
use crate::json_lines::{Mistake, Object, answer_each, print_line};
use crate::robot::RobotArguments;

const HELP: &str = "\
Each line is one question, a pose of the flange in the base frame; the seed in radians (metres for a
sliding joint), all zero if it is missing:
  {\"id\": any, \"position_m\": [x, y, z], \"quaternion_xyzw\": [x, y, z, w], \"seed\": [..]}
The answer, on one line: every branch within the joint limits, each joint in the turn nearest to the seed,
and the nearest of all. (A numeric inverse knows the one solution that the seed leads to.)
  {\"id\", \"ok\": true, \"solutions\": [[..], ..], \"nearest\": [..]}
A question without answer gets {\"id\", \"ok\": false, \"error\": \"..\"}. Other members, such as the Jacobian
in an answer of `seamline fk`, do not matter.

Example:
  echo '{\"id\": 1, \"q\": [0, 0.3, -0.2, 0, 0.5, 0]}' | seamline fk | seamline ik --robot ar2010";

/// A quaternion is taken for a unit one, and made one, if its length is within this of 1: it was printed with few
/// digits.
const NEARLY_UNIT: f64 = 1e-3;

/// Calculate joint positions from flange poses: JSON lines in, JSON lines out.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Questions; the standard input if there is no file.
    file: Option<PathBuf>,
    /// Measure the bare calculation of all solutions, and of the nearest alone.
    ///
    /// Reads all questions first, then calculates them all nine times over. What counts for each is the least of its
    /// nine readings, less the time of reading the clock. Prints {"cases", "dofs", "mean_ns", "p99_ns", "max_ns",
    /// "nearest": {"mean_ns", "p99_ns", "max_ns"}}.
    #[arg(long)]
    bench: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let description = arguments.robot.describe()?;
    description.with_arm(Task { arguments, description: &description })?
}

struct Task<'a> {
    arguments: &'a Arguments,
    description: &'a ArmDescription,
}

impl ArmTask for Task<'_> {
    type Output = anyhow::Result<()>;

    fn run<const N: usize>(self, arm: &impl Kinematics<N>, _: Inverse) -> anyhow::Result<()> {
        let input = self.arguments.file.as_deref();
        if self.arguments.bench {
            let cases = read_all(input, Case::<N>::read)?;
            let times = Times::measure(&cases, |Case { base_from_flange, seed }| {
                // A pose out of reach takes its time too.
                let _ = black_box(arm.inverse_branches(black_box(base_from_flange), seed));
            });
            let nearest = Times::measure(&cases, |Case { base_from_flange, seed }| {
                let _ = black_box(arm.inverse_nearest(black_box(base_from_flange), seed));
            });
            return print_line(&Measured { cases: cases.len(), dofs: N, times, nearest });
        }
        answer_each(input, |line| {
            let case = Case::read(line)?;
            Answer::of(arm, &case).map_err(|error| Mistake::new(in_words(&error, self.description)))
        })
    }
}

/// A pose, and where the joints shall be near.
struct Case<const N: usize> {
    base_from_flange: Pose,
    seed: [f64; N],
}

impl<const N: usize> Case<N> {
    fn read(line: &Object<'_>) -> Result<Self, Mistake> {
        line.check_spelling(&["id", "position_m", "quaternion_xyzw", "seed"])?;
        let (mut position, mut quaternion, mut seed) = ([0.0; 3], [0.0; 4], [0.0; N]);
        line.fill_required("position_m", &MODERATE, &mut position)?;
        line.fill_required("quaternion_xyzw", &MODERATE, &mut quaternion)?;
        line.fill("seed", &MODERATE, &mut seed)?;
        let length = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() > NEARLY_UNIT {
            let message = format!("quaternion_xyzw: found one of length {length}, expected length 1");
            return Err(Mistake::new(message));
        }
        let rotation = Rotation::new_normalize(quaternion.into());
        Ok(Self { base_from_flange: Pose::from_parts(position.into(), rotation), seed })
    }
}

#[derive(Serialize)]
struct Answer {
    ok: bool,
    solutions: Vec<Vec<f64>>,
    nearest: Vec<f64>,
}

impl Answer {
    fn of<const N: usize>(arm: &impl Kinematics<N>, case: &Case<N>) -> Result<Self, InverseError> {
        let Case { base_from_flange, seed } = case;
        let branches = arm.inverse_branches(base_from_flange, seed)?;
        let nearest = arm.inverse_nearest(base_from_flange, seed)?;
        let solutions = branches.as_slice().iter().map(|q| q.to_vec()).collect();
        Ok(Self { ok: true, solutions, nearest: nearest.to_vec() })
    }
}

#[derive(Serialize)]
struct Measured {
    cases: usize,
    dofs: usize,
    #[serde(flatten)]
    times: Times,
    nearest: Times,
}

/// Why there is no solution, in SI units and with the joint's own name.
fn in_words(error: &InverseError, description: &ArmDescription) -> String {
    match *error {
        InverseError::NotFinite => "a coordinate is not a finite number".to_owned(),
        InverseError::OutOfReach { distance, least, greatest } => format!(
            "out of reach: the links would span {distance:.6} m, expected {least:.6} to {greatest:.6} m"
        ),
        InverseError::InsideLateralOffset { radius, offset } => format!(
            "out of reach: the wrist centre is {radius:.6} m from axis 1, expected {offset:.6} m or more"
        ),
        InverseError::OutOfOrientation { angle } => {
            format!("the orientation is {angle:.6} rad from the nearest that the arm can take")
        }
        InverseError::NotConverged { iterations, position_residual, rotation_residual } => format!(
            "no solution found: {position_residual:.3e} m and {rotation_residual:.3e} rad are left after \
             {iterations} iterations"
        ),
        InverseError::PositionLimit { axis, value, min, max } => {
            let joint = &description.joints[axis];
            let unit = match joint.kind {
                JointKind::Revolute => "rad",
                JointKind::Prismatic => "m",
            };
            format!(
                "joint {} would be at {value:.6} {unit}, expected {min:.6} to {max:.6} {unit}",
                joint.name
            )
        }
        InverseError::NotFollowed { .. } | InverseError::Singular { .. } => {
            "the arm is singular there".to_owned()
        }
    }
}
