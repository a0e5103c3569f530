//! `seamline fk`: forward kinematics.

use std::hint::black_box;
use std::path::PathBuf;

use seamline::kinematics::{JointKind, Kinematics};
use seamline_cell::robot::{ArmDescription, ArmTask, Inverse, Joint};
use serde::Serialize;

use crate::json_lines::bench::{Times, read_all};
use crate::json_lines::{Mistake, Numbers, Object, answer_each, print_line};
use crate::robot::RobotArguments;

const HELP: &str = "\
Each line is one question; q in radians (metres for a sliding joint), base to flange:
  {\"id\": any, \"q\": [..]}
The answer, on one line: the flange in the base frame, and its Jacobian there, rows vx, vy, vz, wx, wy, wz
and a column a joint:
  {\"id\", \"position_m\": [x, y, z], \"quaternion_xyzw\": [x, y, z, w], \"jacobian\": [[..], ..]}
A question without answer gets {\"id\", \"ok\": false, \"error\": \"..\"}.

Example:
  echo '{\"id\": 1, \"q\": [0, 0.3, -0.2, 0, 0.5, 0]}' | seamline fk --robot ar2010";

/// Joint positions and other numbers whose squares stay far from overflow.
pub(super) const MODERATE: Numbers =
    Numbers { min: -1e6, max: 1e6, null: None, expected: "a number from -1e6 to 1e6" };

/// Calculate flange poses and Jacobians from joint positions: JSON lines in, JSON lines out.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Questions; the standard input if there is no file.
    file: Option<PathBuf>,
    /// Print the robot's joints and limits as JSON (radians or metres, seconds; no limit is null), and stop.
    #[arg(long, conflicts_with_all = ["bench", "file"])]
    info: bool,
    /// Measure the bare calculation of the pose, and of the Jacobian with it.
    ///
    /// Reads all questions first, then calculates them all nine times over. What counts for each is the least of its
    /// nine readings, less the time of reading the clock. Prints {"cases", "dofs", "mean_ns", "p99_ns", "max_ns",
    /// "jacobian": {"mean_ns", "p99_ns", "max_ns"}}.
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

    fn run<const N: usize>(self, arm: &impl Kinematics<N>, inverse: Inverse) -> anyhow::Result<()> {
        let input = self.arguments.file.as_deref();
        if self.arguments.info {
            print_line(&Info::of(self.description, inverse))
        } else if self.arguments.bench {
            let cases = read_all(input, read::<N>)?;
            let times = Times::measure(&cases, |q| {
                black_box(arm.forward(black_box(q)));
            });
            let jacobian = Times::measure(&cases, |q| {
                black_box(arm.axes(black_box(q)).jacobian());
            });
            print_line(&Measured { cases: cases.len(), dofs: N, times, jacobian })
        } else {
            answer_each(input, |line| Ok(Answer::of(arm, &read(line)?)))
        }
    }
}

fn read<const N: usize>(line: &Object<'_>) -> Result<[f64; N], Mistake> {
    let mut q = [0.0; N];
    line.fill_required("q", &MODERATE, &mut q)?;
    Ok(q)
}

#[derive(Serialize)]
struct Answer {
    position_m: [f64; 3],
    quaternion_xyzw: [f64; 4],
    jacobian: Vec<Vec<f64>>,
}

impl Answer {
    fn of<const N: usize>(arm: &impl Kinematics<N>, q: &[f64; N]) -> Self {
        let base_from_flange = arm.forward(q);
        let jacobian = arm.axes(q).jacobian();
        Self {
            position_m: base_from_flange.translation.vector.into(),
            quaternion_xyzw: base_from_flange.rotation.coords.into(),
            jacobian: jacobian.row_iter().map(|row| row.iter().copied().collect()).collect(),
        }
    }
}

#[derive(Serialize)]
struct Measured {
    cases: usize,
    dofs: usize,
    #[serde(flatten)]
    times: Times,
    jacobian: Times,
}

#[derive(Serialize)]
struct Info<'a> {
    robot: &'a str,
    inverse: &'static str,
    joints: Vec<JointInfo<'a>>,
}

#[derive(Serialize)]
struct JointInfo<'a> {
    name: &'a str,
    kind: &'static str,
    position_min: f64,
    position_max: f64,
    velocity_max: f64,
}

impl<'a> Info<'a> {
    fn of(description: &'a ArmDescription, inverse: Inverse) -> Self {
        let joint = |joint: &'a Joint| JointInfo {
            name: &joint.name,
            kind: match joint.kind {
                JointKind::Revolute => "revolute",
                JointKind::Prismatic => "prismatic",
            },
            position_min: joint.position_min,
            position_max: joint.position_max,
            velocity_max: joint.velocity_max,
        };
        let inverse = match inverse {
            Inverse::ClosedForm => "closed form",
            Inverse::Polished => "closed form and numeric",
            Inverse::Numeric => "numeric",
        };
        Self { robot: &description.name, inverse, joints: description.joints.iter().map(joint).collect() }
    }
}
