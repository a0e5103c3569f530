//! How one joint move runs on into the next: the end of the one and the beginning of the other are left out, and the generator leads
//! from the state of motion where the first is left to the one where the second is joined.
//!
//! What is left out would itself be such a motion, with a stop at the point. So the generator always finds one that takes no longer, within
//! the same limits. The more is left out, the more time is saved, and the farther from the point the tool passes.
//!
//! Behind prefilters the tool is where a mean of that motion is. So it is that which is held against the permitted error, by the stages of the
//! cycle themselves. A move alone is straight in the joints, and a mean of it lies on it.

use seamline::control::TrajectoryMotion;
use seamline::geometry::{Pose, Vector3};
use seamline::otg::{Input, Limits, Profile, Trajectory, calculate};
use seamline::vibration::{Kernel, PrefilterStage, StageEntry, stage_entries};

use super::arm::PlanningArm;
use super::corner::NOTHING_PERMITTED;
use super::joint_move::JointMove;
use super::planner::Planner;
use super::run::Stops;
use super::workspace;
use crate::cell::Vibration;

/// Of either move a corner leaves out at most this many times what the joints speed up or slow down in, and at most half of it.
const RAMPS: f64 = 2.0;
const HALF: f64 = 0.5;
/// Lengths that are tried from the longest down, each this many times the one before; then halvings between the first that will do and
/// the one before it.
const LENGTHS: i32 = 24;
const SHORTER: f64 = 0.8;
const HALVINGS: u32 = 5;
/// A corner may give up these shares of the time that it could save, and then comes nearer to the point. The least that will do counts.
const GIVEN_UP: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 0.9];
/// A corner that could save less than this share of what it takes the place of is a stop but in name.
const WORTHWHILE: f64 = 0.01;
/// Instants at which the tool is looked at: on each of the pieces left out, and on the way that takes their place.
const LEFT_OUT: u32 = 32;
const INSTEAD: u32 = 48;
/// Instants of each taught piece, and of what is in prefilters with it.
const SEEN: u32 = 256;
/// What the tool may be off between these instants, as a share of the error that is permitted.
const BETWEEN: f64 = 0.01;
/// A joint that is slower than this share of its limit stands still.
const STILL: f64 = 1e-9;
/// A joint has its greatest speed of a move where it has this share of it.
const AT_SPEED: f64 = 1.0 - 1e-9;
/// States of a planned motion are within their limits but for rounding.
const ROUNDING: f64 = 1e-12;

/// The way from one joint move into the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointCorner<const N: usize> {
    pub(super) trajectory: Trajectory<N>,
    /// What it leaves out at the first move's end and at the second one's beginning, in seconds.
    pub(super) left_out: [f64; 2],
    /// How long a stop waits until all has come out of the prefilters, in seconds.
    run_out: f64,
}

impl<const N: usize> JointCorner<N> {
    /// How much sooner the second move ends than after a stop, in seconds.
    fn saves(&self) -> f64 {
        self.with_stop() - self.trajectory.duration()
    }

    /// How long the same would take with a stop, in seconds.
    fn with_stop(&self) -> f64 {
        self.left_out[0] + self.left_out[1] + self.run_out
    }

    fn is_worthwhile(&self) -> bool {
        self.saves() > WORTHWHILE * self.with_stop()
    }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// A corner between two joint moves. It leaves out as much as the permitted error allows, which is that of the tool's distance from the
    /// point between them, and of its distance from the way that it would take with a stop.
    ///
    /// Cost: mostly 10 to 30 corners looked at, and 149 at most, each with one or two calls of the generator and 115 of forward kinematics;
    /// behind a prefilter a thousand, and as many cycles of it.
    ///
    /// # Errors
    /// Why the robot must stop between.
    pub(super) fn joint_corner(
        &self,
        before: &JointMove<N>,
        after: &JointMove<N>,
    ) -> Result<JointCorner<N>, Stops> {
        let permitted = before.pass.filter(|error| *error > 0.0).ok_or(Stops(NOTHING_PERMITTED))?;
        if before.tool != after.tool {
            return Err(Stops("the next move has another tool"));
        }
        let run_out = self.run_out();
        let [first, second] = [before, after].map(|of| of.motion.trajectory());
        let [[_, slowing], [speeding, _]] = [ramps(first), ramps(second)];
        let most = [(slowing, first), (speeding, second)];
        // Between two corners as much is left as is in the prefilters at once: none sees both.
        let most = most.map(|(ramp, of)| (RAMPS * ramp).min(HALF * (of.duration() - run_out)));
        if most.iter().any(|most| *most <= 0.0) {
            return Err(Stops("a move is shorter than what is in the prefilter at once"));
        }
        let longest = most[0].max(most[1]);
        let corner = |length: f64, given_up: f64| {
            self.corner_of([before, after], most.map(|most| most.min(length)), given_up, permitted)
        };
        let mut tried = GIVEN_UP
            .iter()
            .flat_map(|given_up| (0..LENGTHS).map(move |k| (longest * SHORTER.powi(k), *given_up)));
        let found = tried
            .find_map(|(length, given_up)| corner(length, given_up).map(|corner| (length, given_up, corner)));
        let (mut length, given_up, mut best) =
            found.ok_or(Stops("the joints find no way round it within the corner error"))?;
        let mut step = length * (1.0 / SHORTER - 1.0);
        for _ in 0..HALVINGS {
            step *= 0.5;
            if length + step < longest
                && let Some(longer) = corner(length + step, given_up)
            {
                length += step;
                best = if longer.saves() > best.saves() { longer } else { best };
            }
        }
        Ok(best)
    }

    /// The corner that leaves out so many seconds of both moves; nothing where a joint would go to and fro or the tool farther off than
    /// permitted.
    fn corner_of(
        &self,
        [before, after]: [&JointMove<N>; 2],
        left_out: [f64; 2],
        given_up: f64,
        permitted: f64,
    ) -> Option<JointCorner<N>> {
        let leave = before.motion.duration() - left_out[0];
        let [first, second] = [before.motion.at_time(leave), after.motion.at_time(left_out[1])];
        let mut input = Input::new(first.state(), second.state(), wider(&before.limits, &after.limits));
        let trajectory = calculate(&input).ok()?;
        let mut corner = JointCorner { trajectory, left_out, run_out: self.run_out() };
        if given_up > 0.0 && corner.is_worthwhile() {
            input.duration_min = Some(corner.trajectory.duration() + given_up * corner.saves());
            corner.trajectory = calculate(&input).ok()?;
        }
        let turns = |joint: usize| {
            let profile = &corner.trajectory.profiles()[joint];
            let places = [first.position[joint], before.target[joint], second.position[joint]];
            goes_by(profile, places, STILL * self.arm.limits.velocity[joint])
        };
        if !corner.is_worthwhile() || !(0..N).all(turns) {
            return None;
        }
        let tool = &before.tool.flange_from_tcp;
        workspace::check_joint_move(&corner.trajectory, &self.arm.kinematics, tool, &self.cell.safety)
            .ok()?;
        let error = self.tool_error([before, after], &corner)?;
        (error <= (1.0 - BETWEEN) * permitted).then_some(corner)
    }

    /// How far a corner takes the tool off: as it is, and behind prefilters. The slower time runs, the nearer is the one to the other.
    fn tool_error(&self, [before, after]: [&JointMove<N>; 2], corner: &JointCorner<N>) -> Option<f64> {
        let tool = &before.tool.flange_from_tcp;
        let (first, second) = (&before.motion, &after.motion);
        let (leave, join) = (first.duration() - corner.left_out[0], corner.left_out[1]);
        let taught = |more: f64| {
            let end = (join + more).min(second.duration());
            [first.part((leave - more).max(0.0), first.duration()), second.part(0.0, end)]
        };
        let instead = TrajectoryMotion::whole(corner.trajectory);
        let at = |k: u32| instead.at_time(instead.duration() * f64::from(k) / f64::from(INSTEAD)).position;
        let bare = self.corner_error(tool, &taught(0.0), LEFT_OUT, (0..=INSTEAD).map(at));
        let Some(smear) = self.run.smear else { return Some(bare) };
        let from = (leave - smear.length).max(0.0);
        let passed = [first.part(from, leave), instead, second.part(join, second.duration())];
        let joints = shaped(&self.cell.vibration, self.cell.cycle.period, &passed)?;
        Some(bare.max(self.corner_error(tool, &taught(smear.length), SEEN, joints.into_iter())))
    }

    /// The greater of two distances: of the point from the tool's way, and of a place on it from the way that it takes the place of.
    fn corner_error(
        &self,
        flange_from_tcp: &Pose,
        taught: &[TrajectoryMotion<N>; 2],
        places: u32,
        instead: impl Iterator<Item = [f64; N]>,
    ) -> f64 {
        let tool =
            |joints: [f64; N]| (self.arm.kinematics.forward(&joints) * flange_from_tcp).translation.vector;
        let of = |motion: &TrajectoryMotion<N>| -> Vec<Vector3> {
            let at = |k: u32| motion.at_time(motion.duration() * f64::from(k) / f64::from(places)).position;
            (0..=places).map(|k| tool(at(k))).collect()
        };
        let mut old = of(&taught[0]);
        let corner = old.last().copied().unwrap_or_default();
        old.extend(of(&taught[1]));
        let new: Vec<Vector3> = instead.map(tool).collect();
        let off = new.iter().map(|place| distance(place, &old)).fold(0.0, f64::max);
        off.max(distance(&corner, &new))
    }
}

/// The joints behind prefilters from the beginning of the second of three motions, one after the other, until all of it has come out; what
/// lies before the first is rest. Nothing where a kernel does not suit the period.
fn shaped<const N: usize>(
    vibration: &Vibration,
    period: f64,
    motions: &[TrajectoryMotion<N>; 3],
) -> Option<Vec<[f64; N]>> {
    let start = motions[0].at_time(0.0).position;
    let stage = |kernel: &Kernel| {
        let memory = vec![StageEntry::ZERO; stage_entries(kernel, period)];
        PrefilterStage::try_new(memory, kernel, period, &start).ok()
    };
    let mut stages = vibration.kernels().iter().map(stage).collect::<Option<Vec<_>>>()?;
    let length: f64 = vibration.kernels().iter().map(Kernel::length).sum();
    let [before, instead, _] = motions.each_ref().map(TrajectoryMotion::duration);
    let at = |time: f64| match time {
        time if time < 0.0 => motions[0].at_time(before + time),
        time if time < instead => motions[1].at_time(time),
        time => motions[2].at_time(time - instead),
    };
    let cycles = |time: f64| (time / period).ceil() as i32;
    let mut came = |cycle: i32| {
        let joints = at(f64::from(cycle) * period).position;
        stages.iter_mut().fold(joints, |joints, stage| stage.update(&joints))
    };
    let all = (-cycles(before)..=cycles(instead + length)).map(|cycle| (cycle, came(cycle)));
    Some(all.filter(|(cycle, _)| *cycle >= 0).map(|(_, joints)| joints).collect())
}

/// The distance of a point from places joined by straight lines.
fn distance(point: &Vector3, places: &[Vector3]) -> f64 {
    let from_line = |pair: &[Vector3]| {
        let way = pair[1] - pair[0];
        let square = way.norm_squared();
        let share = if square > 0.0 { (point - pair[0]).dot(&way) / square } else { 0.0 };
        (point - pair[0] - way * share.clamp(0.0, 1.0)).norm_squared()
    };
    places.windows(2).map(from_line).fold(f64::INFINITY, f64::min).sqrt()
}

/// Limits that both moves keep.
fn wider<const N: usize>(one: &Limits<N>, other: &Limits<N>) -> Limits<N> {
    let wide = |one: &[f64; N], other: &[f64; N]| {
        std::array::from_fn(
            |k| if one[k].abs() > other[k].abs() { one[k] } else { other[k] } * (1.0 + ROUNDING),
        )
    };
    Limits {
        velocity_max: wide(&one.velocity_max, &other.velocity_max),
        velocity_min: wide(&one.velocity_min, &other.velocity_min),
        acceleration_max: wide(&one.acceleration_max, &other.acceleration_max),
        acceleration_min: wide(&one.acceleration_min, &other.acceleration_min),
        ..*one
    }
}

/// How long it takes until all joints of a move have reached their greatest speed, and from when the first one leaves it until the end.
fn ramps<const N: usize>(trajectory: &Trajectory<N>) -> [f64; 2] {
    let duration = trajectory.duration();
    let of_joints = trajectory.profiles().iter().filter_map(at_speed);
    of_joints.fold([0.0; 2], |[up, down], [first, last]| [up.max(first), down.max(duration - last)])
}

/// The first and the last of the instants between the phases at which a joint has its greatest speed; nothing where it stands still.
fn at_speed(profile: &Profile) -> Option<[f64; 2]> {
    let greatest = profile.phases().iter().map(|phase| phase.velocity.abs()).fold(0.0, f64::max);
    let (mut elapsed, mut found) = (0.0, None);
    for phase in profile.phases() {
        if greatest > 0.0 && phase.velocity.abs() >= AT_SPEED * greatest {
            found = Some([found.map_or(elapsed, |[first, _]: [f64; 2]| first), elapsed]);
        }
        elapsed += phase.duration;
    }
    found
}

/// Whether a joint goes between three places as it would with a stop at the second: never beyond one of them, and never back on either way.
fn goes_by(profile: &Profile, places: [f64; 3], still: f64) -> bool {
    let (low, high) =
        places.iter().fold((places[0], places[0]), |(low, high), x| (low.min(*x), high.max(*x)));
    let (extrema, room) = (profile.position_extrema(), still * profile.duration());
    if extrema.min < low - room || extrema.max > high + room {
        return false;
    }
    let ways = [places[1] - places[0], places[2] - places[1]];
    let mut directions = ways.into_iter().filter(|way| *way != 0.0).map(f64::signum);
    let mut direction = directions.next();
    let mut goes = |velocity: f64| {
        while velocity.abs() > still && direction.is_some_and(|sign| sign != velocity.signum()) {
            direction = directions.next();
        }
        velocity.abs() <= still || direction.is_some()
    };
    profile.phases().iter().all(|phase| {
        // Where the acceleration passes zero the velocity turns.
        let turn = (-phase.acceleration / phase.jerk).clamp(0.0, phase.duration);
        let turn = if turn.is_nan() { 0.0 } else { turn };
        [0.0, turn, phase.duration].into_iter().all(|time| goes(phase.at(time).velocity))
    })
}
