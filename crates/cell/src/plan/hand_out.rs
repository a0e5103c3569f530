//! From the run to blocks: followed, timed, and handed out as far as it is settled.

use seamline::control::{ActsOn, BLOCK_PIECES, Block, Command, Motion, PathMotion};
use seamline::kinematics::InverseError;
use seamline::path::TimingPiece;

use super::arm::PlanningArm;
use super::cut;
use super::error::{PlanError, Problem};
use super::joint_path::{FollowError, PathJoints};
use super::planner::{Planned, Planner};
use super::remark::{Remarks, path_problem};
use super::route::Route;
use super::run::{Link, Piece, Sight, Stops};
use super::smear;
use super::suggest::Trouble;
use super::timing::{Course, JointPath as _, PathLimits, Stretch, TimingError, TimingLimits, time_path};
use crate::job::{Action, Location, Step};
use crate::record::{OnSeam, SegmentKind};

/// A look ahead that settles nothing is repeated with one this many times as far.
const WIDER: f64 = 2.0;
/// A joint that ends this far from where it was taught stands in another turn or configuration; radians. Where the point is passed in
/// a corner, the joint may be a little off anyway.
const SAME_JOINT: f64 = 0.02;
const SAME_JOINT_PASSING: f64 = 0.5;

/// What of a path of the run is handed out.
#[derive(Debug, Clone, Copy)]
struct Part<'a, const N: usize> {
    timing: &'a [TimingPiece],
    /// The limits along it, up to places of the path.
    zones: &'a [Stretch],
    /// The robot is at rest afterwards.
    rests: bool,
    /// Where the joints are afterwards.
    joints: [f64; N],
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// Hands out all that is held back; `stop` says why it ends where the job does not ask for it.
    pub(super) fn end_run(
        &mut self,
        stop: Option<Stops>,
        out: &mut Vec<Planned<N>>,
    ) -> Result<(), PlanError> {
        let of_run = self.run.last().map(|link| (&link.step, link.pass));
        let last = self.held.as_ref().map(|held| (&held.step, held.pass)).or(of_run);
        let passed = last.filter(|(_, pass)| pass.is_some()).map(|(step, _)| step.clone());
        self.end_joint_move(out);
        self.weave_run(out)?;
        self.track_run(out)?;
        self.advance(true, out)?;
        if let (Some(Stops(why)), Some(Step { at, action: Action::Move(r#move), .. })) = (stop, passed) {
            let text = format!("the robot stops exactly on this point ({}): {why}", r#move.zone);
            out.push(Planned { notices: vec![text], ..Planned::part(&at) });
        }
        Ok(())
    }

    /// Hands out what is settled of the run: all of it where it is closed.
    pub(super) fn advance(&mut self, closed: bool, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        while let Some(sight) = self.run.sight(closed) {
            let settled = self.hand_out(&sight, out)?;
            self.run.farther = if settled { 1.0 } else { self.run.farther * WIDER };
        }
        Ok(())
    }

    /// Times the run as far as it is in sight, and hands out what is settled; false where that is nothing.
    fn hand_out(&mut self, sight: &Sight, out: &mut Vec<Planned<N>>) -> Result<bool, PlanError> {
        let (route, stretches) = self.run.route(sight.to);
        let (arm, tool, start) = (self.arm, self.tool.flange_from_tcp, self.joints);
        let (ahead, _) = self.run.route(self.run.past_corner(sight.to + 2.0 * self.run.reach()));
        let mut joints = match PathJoints::follow(&arm.kinematics, ahead.clone(), &tool, &start) {
            Ok(joints) => joints,
            Err((s, error)) => return Err(self.fault(&ahead, s, &self.follow_reason(&error))),
        };
        let caps = self.caps(&ahead, &mut joints, sight.to);
        let mut stretches = smear::slowed(&stretches, &caps, self.run.speed);
        let zones = if self.run.acts_on == ActsOn::Feedrate { stretches.clone() } else { Vec::new() };
        stretches.iter_mut().for_each(|stretch| stretch.limits = stretch.limits.with_room());
        let mut joints = joints.over(route.clone());
        let course = Course { stretches: &stretches, start: self.run.speed, open: sight.open };
        let before = out.len();
        let timing = match time_path(&mut joints, &self.timing_limits(), &course) {
            Ok(timing) => timing,
            Err(TimingError::Start { .. } | TimingError::NoSpeed) if !self.run.way_to_rest.is_empty() => {
                self.come_to_rest(&zones, &mut joints, out);
                self.remember(&out[before..])?;
                return Ok(true);
            }
            Err(error) => return Err(self.timing_fault(&route, &error)),
        };
        let (settled, rest) = timing.pieces().split_at(timing.settled());
        let Some(last) = settled.last().map(TimingPiece::end) else {
            // Looking farther helps only where there is more to see.
            return if sight.open {
                Ok(false)
            } else {
                Err(self.timing_fault(&route, &TimingError::NoSpeed))
            };
        };
        let end = if sight.open { last.position } else { route.length() };
        let mut remarks = Remarks::new(self, &route, &timing, &caps, end)
            .map_err(|(index, problem)| self.give_up(index, problem))?;
        self.remark_caps(&mut remarks, &caps, end)?;
        let at = self.run.piece(0).map(|piece| piece.link.step.at.clone());
        self.hand_out_up_to((end, !sight.open), (settled, &zones), &mut joints, &remarks, out);
        self.remember(&out[before..])?;
        self.run.way_to_rest = cut::moved_back(rest, end);
        self.run.keep_caps(&caps, end);
        if !sight.open && !self.run.is_empty() {
            out.extend(at.map(stops_on_the_way));
        }
        Ok(true)
    }

    /// The way that was planned to rest where the run was known to end: for a run that does not go on in motion.
    fn come_to_rest(
        &mut self,
        zones: &[Stretch],
        joints: &mut PathJoints<'_, N, K>,
        out: &mut Vec<Planned<N>>,
    ) {
        let way = std::mem::take(&mut self.run.way_to_rest);
        let end = way.last().map_or(0.0, |piece| piece.end().position);
        let first = self.run.piece(0).map(|piece| piece.link.step.at.clone());
        self.hand_out_up_to((end, true), (&way, zones), joints, &Remarks::default(), out);
        out.extend(first.map(stops_on_the_way));
    }

    /// Hands out the motion up to a place of the run; there it `rests`, or goes on.
    fn hand_out_up_to(
        &mut self,
        (end, rests): (f64, bool),
        (timing, zones): (&[TimingPiece], &[Stretch]),
        joints: &mut PathJoints<'_, N, K>,
        remarks: &Remarks,
        out: &mut Vec<Planned<N>>,
    ) {
        let ends = self.run.ends_up_to(end);
        let parts = cut::by_path(timing, &ends);
        let mut from = 0.0;
        for (index, (timing, &to)) in parts.iter().zip(&ends).enumerate() {
            let last = index + 1 == ends.len();
            let joints = joints.jet(to).map_or(self.joints, |jet| jet.position);
            let zones = zones_between(zones, from, to);
            let part = Part { timing, zones: &zones, rests: rests && last, joints };
            self.hand_out_part(&part, remarks.of(index), out);
            from = to;
        }
    }

    fn hand_out_part(&mut self, part: &Part<'_, N>, notices: &[String], out: &mut Vec<Planned<N>>) {
        let from_rest = self.run.speed == 0.0;
        let Some((piece, whole)) = self.run.take_first(part.timing, !notices.is_empty()) else { return };
        let begins = !piece.begun && matches!(piece.info.kind, SegmentKind::Path(_));
        let at = &piece.link.step.at;
        let mut planned = if begins { Planned::begin(&piece.link) } else { Planned::part(at) };
        planned.notices.extend(notices.iter().cloned());
        if whole && matches!(piece.info.kind, SegmentKind::Path(_)) {
            planned.notices.extend(self.other_configuration(&piece.link, &part.joints));
            planned.notices.extend(smear::off_weld(&piece));
        }
        planned.commands = self.blocks(&piece, part, from_rest);
        let mut info = smear::lagging(&piece.info, &self.run);
        if self.beside {
            info.seam = OnSeam::Leaves;
            self.beside = !whole;
        }
        planned.segment = Some(info);
        planned.duration = part.timing.iter().map(|piece| piece.duration).sum();
        if part.rests {
            planned.duration += self.run_out();
        }
        out.push(planned);
        out.extend(piece.after.iter().map(|step| self.aside(step)));
        self.joints = part.joints;
        let end = part.timing.last().map_or(self.run.speed, |piece| piece.end().velocity);
        self.run.speed = if part.rests { 0.0 } else { end };
    }

    pub(super) fn timing_limits(&self) -> TimingLimits<N> {
        let limits = &self.arm.limits;
        let (velocity, acceleration, jerk) = (limits.velocity, limits.acceleration, limits.jerk);
        TimingLimits { velocity, acceleration, jerk }.with_room()
    }

    fn blocks(&self, piece: &Piece<N>, part: &Part<'_, N>, from_rest: bool) -> Vec<Command<N>> {
        let whole = [Stretch { to: piece.path.length(), limits: piece.limits }];
        let zones = if part.zones.is_empty() { &whole } else { part.zones };
        let ends: Vec<f64> = zones.iter().map(|zone| zone.to).collect();
        let timings = cut::by_path(part.timing, &ends);
        let starts = [0.0].iter().chain(&ends);
        let chunks: Vec<(PathLimits, Vec<TimingPiece>)> = timings
            .iter()
            .zip(starts)
            .zip(zones)
            .flat_map(|((timing, start), zone)| {
                let timing = cut::moved_back(timing, -start);
                timing.chunks(BLOCK_PIECES).map(|chunk| (zone.limits, chunk.to_vec())).collect::<Vec<_>>()
            })
            .collect();
        let last = chunks.len().saturating_sub(1);
        let block = |(k, (limits, pieces)): (usize, &(PathLimits, Vec<TimingPiece>))| {
            let along = (limits.acceleration, limits.jerk);
            let motion = PathMotion::new(piece.path, &self.tool.flange_from_tcp, along, pieces)?;
            let motion = piece.tracked.map_or(motion, |tracked| motion.on_seam(tracked));
            Some(Command::Move(Block {
                line: piece.info.line,
                segment: piece.info.segment,
                flange_from_tcp: self.tool.flange_from_tcp,
                starts_at_rest: from_rest && k == 0,
                ends_at_rest: part.rests && k == last,
                motion: Motion::Path(motion),
            }))
        };
        chunks.iter().enumerate().filter_map(block).collect()
    }

    /// The move ends in another turn or configuration than the point was taught in.
    fn other_configuration(&self, link: &Link<N>, end: &[f64; N]) -> Option<String> {
        let taught = link.goal?.joints.ok()?;
        let same = if link.pass.is_some() { SAME_JOINT_PASSING } else { SAME_JOINT };
        let joint = (0..N).find(|&joint| (taught[joint] - end[joint]).abs() > same)?;
        let (name, unit) = (&self.arm.joint_names[joint], self.arm.unit(joint));
        let [end, taught] = [end[joint], taught[joint]].map(|si| si * unit.per_si);
        let unit = unit.name;
        Some(format!(
            "ends with joint {name} at {end:.1} {unit}, taught at {taught:.1} {unit}: the straight way leads to another \
             configuration"
        ))
    }

    fn timing_fault(&mut self, route: &Route, error: &TimingError<InverseError>) -> PlanError {
        let (s, reason) = match error {
            TimingError::Path { position, error } => (*position, self.arm.in_words(error)),
            TimingError::Discontinuous { position, joint } => {
                (*position, self.follow_reason(&FollowError::Jump { joint: *joint }))
            }
            TimingError::NoSpeed => (0.0, super::remark::NO_USEFUL_SPEED.into()),
            error => (0.0, format!("its limits give no motion: {error:?}")),
        };
        self.fault(route, s, &reason)
    }

    /// The move at this place of the run is at fault.
    fn fault(&mut self, route: &Route, s: f64, reason: &str) -> PlanError {
        let (index, local) = route.locate(s);
        let problem = self.run.piece(index).map(|piece| {
            let at = piece.offset + local;
            path_problem(&piece.link.path, at, reason, &self.trouble(piece))
        });
        let unknown = || Problem::Refused { text: "the move".into(), reason: reason.into() };
        self.give_up(index, problem.unwrap_or_else(unknown))
    }

    /// The move of a piece, for which something better is sought.
    pub(super) fn trouble<'b>(&'b self, piece: &'b Piece<N>) -> Trouble<'b, N, K> {
        let link = &piece.link;
        let tool = &self.tool.flange_from_tcp;
        let kinematics = &self.arm.kinematics;
        let flange = link.path.pose(0.0) * tool.inverse();
        let start = kinematics.inverse_nearest(&flange, &self.joints).unwrap_or(self.joints);
        Trouble { kinematics, path: link.path, flange_from_tcp: tool, start, speed: link.limits.speed }
    }

    fn follow_reason(&self, error: &FollowError) -> String {
        let name = |joint: usize| &self.arm.joint_names[joint];
        match error {
            FollowError::Inverse(error) => self.arm.in_words(error),
            FollowError::JointLimit { joint, limit } => {
                let unit = self.arm.unit(*joint);
                format!("joint {} is at its limit of {:.1} {}", name(*joint), limit * unit.per_si, unit.name)
            }
            FollowError::Jump { joint } => {
                format!("joint {} would have to jump: the path crosses a singularity", name(*joint))
            }
        }
    }
}

/// The limits between two places of a route, up to places counted from the first one.
fn zones_between(zones: &[Stretch], from: f64, to: f64) -> Vec<Stretch> {
    let mut start = 0.0;
    let mut between = Vec::new();
    for zone in zones {
        if start < to && zone.to > from {
            between.push(Stretch { to: zone.to.min(to) - from, limits: zone.limits });
        }
        start = zone.to;
    }
    between
}

fn stops_on_the_way<const N: usize>(at: Location) -> Planned<N> {
    let text = "the robot stops on the way: its joints leave no motion that goes on at speed";
    Planned { notices: vec![text.into()], ..Planned::part(&at) }
}
