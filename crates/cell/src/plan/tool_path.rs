//! Moves of the tool centre point: geometry, timing, blocks.

use seamline::control::{BLOCK_PIECES, Block, Command, Motion, PathMotion};
use seamline::geometry::Pose;
use seamline::kinematics::InverseError;
use seamline::path::{Measure, Path, TimingPiece};

use super::arm::PlanningArm;
use super::error::{Place, Problem, Reach};
use super::joint_path::{FollowError, PathJoints};
use super::planner::{Planned, Planner};
use super::resolve::Goal;
use super::speed;
use super::suggest::Trouble;
use super::timing::{
    Course, Order, PathLimits, Slowdown, Stretch, Timing, TimingError, TimingKind, TimingLimits, time_path,
};
use super::workspace;
use crate::cell::Cell;
use crate::job::{ArcPart, Coordinates, Frame, Location, Move, Target};
use crate::record::{SegmentInfo, SegmentKind};

/// A joint that ends this far from where it was taught stands in another turn or configuration. Radians.
const SAME_JOINT: f64 = 0.02;

pub(super) fn line(start: &Pose, end: &Pose) -> Path {
    Path::line(start, end)
}

/// The piece of the circle through three poses that is run from `start`, and whether it had to be straight.
pub(super) fn arc(start: &Pose, poses: &[Pose; 3], part: ArcPart) -> (Path, bool) {
    let [first, second, third] = poses;
    let (path, end) = match part {
        ArcPart::Whole => (Path::arc(start, second, third), third),
        ArcPart::First => (Path::arc_between(first, second, third, start, second), second),
        ArcPart::Second => (Path::arc_between(first, second, third, start, third), third),
    };
    path.map_or_else(|_| (Path::line(start, end), true), |path| (path, false))
}

/// The pose after an increment in a frame.
pub(super) fn increment(from: &Pose, target: &Target, frame: Frame, cell: &Cell) -> Result<Pose, Problem> {
    let name = || target.name.to_string();
    let Coordinates::Rectangular(increment) = &target.position.coordinates else {
        return Err(Problem::StationPosition { name: name() });
    };
    let step = increment.pose();
    let in_base = |base_from_frame: &Pose| {
        let shift = base_from_frame.rotation * step.translation.vector;
        let turn = base_from_frame.rotation * step.rotation * base_from_frame.rotation.inverse();
        Pose::from_parts((from.translation.vector + shift).into(), turn * from.rotation)
    };
    match frame {
        Frame::Base | Frame::Robot => Ok(in_base(&Pose::identity())),
        Frame::Tool => Ok(from * step),
        Frame::User(number) => {
            let frame = cell.user_frame(number).ok_or(Problem::UnknownFrame { number })?;
            Ok(in_base(&frame.base_from_user))
        }
        Frame::MasterTool => Err(Problem::UnsupportedFrame { name: name(), frame }),
    }
}

/// A move that is stretched by more than this is refused.
const STRETCH_MAX: f64 = 50.0;
const NO_USEFUL_SPEED: &str = "the path passes so near to a singularity that no useful speed is left";

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// A move of the tool centre point along a path, from rest to rest.
    pub(super) fn path_move(
        &mut self,
        at: &Location,
        r#move: &Move,
        path: &Path,
        goal: Option<&Goal<N>>,
    ) -> Result<Planned<N>, Problem> {
        let segment = self.number_segment();
        let limits = speed::path_limits(path, r#move, &self.cell.cartesian)?;
        let kind = SegmentKind::Path(*path);
        let mut info = SegmentInfo {
            segment,
            line: at.line,
            kind,
            speed: Some(limits.speed),
            arc: self.arc,
            constant_part: None,
        };
        if path.length() == 0.0 {
            return Ok(Planned { segment: Some(info), ..Planned::default() });
        }
        workspace::check_path(path, &self.cell.safety)?;
        let trouble = Trouble {
            kinematics: &self.arm.kinematics,
            path,
            flange_from_tcp: &self.tool.flange_from_tcp,
            start: &self.joints,
            speed: limits.speed,
        };
        let follow = PathJoints::follow(&self.arm.kinematics, path, &self.tool.flange_from_tcp, &self.joints);
        let mut joints =
            follow.map_err(|(s, error)| path_problem(path, s, &self.follow_reason(&error), &trouble))?;
        let stretches = [Stretch { to: path.length(), limits }];
        let timing = time_path(&mut joints, &self.timing_limits(), &Course::whole(&stretches))
            .map_err(|error| self.timing_problem(path, &error, &trouble))?;
        info.constant_part = constant_part(&timing, limits.speed);
        let end = joints.end();
        let mut notices = self.slowdowns(path, &timing, &limits, &trouble)?;
        notices.extend(stretch(path, &timing, &limits, &trouble)?);
        notices.extend(goal.and_then(|goal| self.other_configuration(goal, &end)));
        let commands = self.blocks(at, segment, path, &timing, &limits);
        self.joints = end;
        Ok(Planned { commands, segment: Some(info), notices, duration: timing.duration() })
    }

    fn timing_limits(&self) -> TimingLimits<N> {
        let limits = &self.arm.limits;
        TimingLimits { velocity: limits.velocity, acceleration: limits.acceleration, jerk: limits.jerk }
    }

    fn blocks(
        &self,
        at: &Location,
        segment: u32,
        path: &Path,
        timing: &Timing,
        limits: &PathLimits,
    ) -> Vec<Command<N>> {
        let along = (limits.acceleration, limits.jerk);
        let chunks = timing.pieces().chunks(BLOCK_PIECES);
        let last = chunks.len().saturating_sub(1);
        let block = |(k, pieces): (usize, &[TimingPiece])| {
            let motion = PathMotion::new(*path, &self.tool.flange_from_tcp, along, pieces)?;
            Some(Command::Move(Block {
                line: at.line,
                segment,
                flange_from_tcp: self.tool.flange_from_tcp,
                starts_at_rest: k == 0,
                ends_at_rest: k == last,
                motion: Motion::Path(motion),
            }))
        };
        chunks.enumerate().filter_map(block).collect()
    }

    /// What the operator should know about each slowdown; with the arc on it may be refused.
    fn slowdowns(
        &self,
        path: &Path,
        timing: &Timing,
        limits: &PathLimits,
        trouble: &Trouble<'_, N, K>,
    ) -> Result<Vec<String>, Problem> {
        let mut notices = Vec::new();
        let mut suggestion = None;
        for slowdown in timing.slowdowns() {
            let remedy = if slowdown.sustainable < limits.speed {
                let suggestion = suggestion.get_or_insert_with(|| trouble.suggestion());
                remedy(path, slowdown, suggestion.as_deref())
            } else {
                String::new()
            };
            let text = self.slowdown_text(path, slowdown, limits) + &remedy;
            let policy = &self.cell.arc;
            let matters = slowdown.speed < limits.speed * (1.0 - policy.speed_tolerance);
            if self.arc && policy.refuse_slowdown && matters {
                return Err(Problem::WeldSlowdown(text));
            }
            notices.push(text);
        }
        Ok(notices)
    }

    fn slowdown_text(&self, path: &Path, slowdown: &Slowdown, limits: &PathLimits) -> String {
        let (unit, speed_unit, factor) = units(path);
        let order = match slowdown.order {
            Order::Velocity => "speed",
            Order::Acceleration => "acceleration",
            Order::Jerk => "jerk",
        };
        format!(
            "slows from {:.1} to {:.1} {speed_unit} between {:.1} and {:.1} {unit} (least at {:.1} {unit}){}: \
             joint {} is at its {order} limit",
            limits.speed * factor,
            slowdown.speed * factor,
            slowdown.from * factor,
            slowdown.to * factor,
            slowdown.place * factor,
            if self.arc { " with the arc on" } else { "" },
            self.arm.joint_names[slowdown.joint],
        )
    }

    fn timing_problem(
        &self,
        path: &Path,
        error: &TimingError<InverseError>,
        trouble: &Trouble<'_, N, K>,
    ) -> Problem {
        match *error {
            TimingError::Path { position, error } => {
                path_problem(path, position, &Reach(&error).to_string(), trouble)
            }
            TimingError::Discontinuous { position, joint } => {
                path_problem(path, position, &self.follow_reason(&FollowError::Jump { joint }), trouble)
            }
            TimingError::NoSpeed => path_problem(path, 0.0, NO_USEFUL_SPEED, trouble),
            TimingError::Length(_)
            | TimingError::PathLimit { .. }
            | TimingError::JointLimit { .. }
            | TimingError::Stretch { .. }
            | TimingError::Start { .. } => {
                path_problem(path, 0.0, &format!("its limits give no motion: {error:?}"), trouble)
            }
        }
    }

    /// The move ends in another turn or configuration than the point was taught in.
    fn other_configuration(&self, goal: &Goal<N>, end: &[f64; N]) -> Option<String> {
        let taught = goal.joints.ok()?;
        let joint = (0..N).find(|&joint| (taught[joint] - end[joint]).abs() > SAME_JOINT)?;
        Some(format!(
            "ends with joint {} at {:.1} deg, taught at {:.1} deg: the straight way leads to another configuration",
            self.arm.joint_names[joint],
            end[joint].to_degrees(),
            taught[joint].to_degrees()
        ))
    }

    fn follow_reason(&self, error: &FollowError) -> String {
        let name = |joint: usize| &self.arm.joint_names[joint];
        match error {
            FollowError::Inverse(error) => Reach(error).to_string(),
            FollowError::JointLimit { joint, limit } => {
                format!("joint {} is at its limit of {:.1} deg", name(*joint), limit.to_degrees())
            }
            FollowError::Jump { joint } => {
                format!("joint {} would have to jump: the path crosses a singularity", name(*joint))
            }
        }
    }
}

/// No optimum was found: the whole move takes longer. Bearable up to a point, and then a problem.
fn stretch<const N: usize, K: PlanningArm<N>>(
    path: &Path,
    timing: &Timing,
    limits: &PathLimits,
    trouble: &Trouble<'_, N, K>,
) -> Result<Option<String>, Problem> {
    if timing.kind() != TimingKind::Stretched {
        return Ok(None);
    }
    let ramps = limits.speed / limits.acceleration + limits.acceleration / limits.jerk;
    let times = timing.duration() / (path.length() / limits.speed + ramps);
    if times > STRETCH_MAX {
        let at = timing.slowdowns().first().map_or(0.0, |slowdown| slowdown.place);
        return Err(path_problem(path, at, NO_USEFUL_SPEED, trouble));
    }
    Ok(Some(format!(
        "the whole move takes {times:.1} times as long as programmed: its joints leave no better speed"
    )))
}

/// A problem at a place of the path, with what would solve it.
fn path_problem<const N: usize, K: PlanningArm<N>>(
    path: &Path,
    s: f64,
    reason: &str,
    trouble: &Trouble<'_, N, K>,
) -> Problem {
    let remedy = trouble.suggestion().map_or_else(String::new, |suggestion| format!("; {suggestion}"));
    Problem::Path { place: place(path, s), reason: format!("{reason}{remedy}") }
}

/// What would keep the speed constant.
fn remedy(path: &Path, slowdown: &Slowdown, suggestion: Option<&str>) -> String {
    let (_, speed_unit, factor) = units(path);
    let held = slowdown.sustainable * factor;
    let or = suggestion.map_or_else(String::new, |suggestion| format!("; {suggestion}"));
    format!("; {held:.1} {speed_unit} could be held all along{or}")
}

/// Unit of length, unit of speed, and the factor from SI to them.
fn units(path: &Path) -> (&'static str, &'static str, f64) {
    match path.measure() {
        Measure::Length => ("mm", "mm/s", 1000.0),
        Measure::Angle => ("deg", "deg/s", 1_f64.to_degrees()),
    }
}

fn place(path: &Path, s: f64) -> Place {
    let (unit, _, factor) = units(path);
    Place { at: s * factor, of: path.length() * factor, unit }
}

/// From where to where the plan holds the programmed speed.
fn constant_part(timing: &Timing, speed: f64) -> Option<[f64; 2]> {
    if timing.kind() != TimingKind::Plain {
        return None;
    }
    // The cruise of the plain S-curve: the piece without acceleration and jerk, at the programmed speed.
    let cruises = |piece: &&TimingPiece| {
        piece.acceleration == 0.0 && piece.jerk == 0.0 && piece.velocity >= speed * (1.0 - 1e-9)
    };
    let piece = timing.pieces().iter().find(cruises)?;
    Some([piece.position, piece.end().position])
}
