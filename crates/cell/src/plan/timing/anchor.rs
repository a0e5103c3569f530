//! Where a long window is split: places at which the motion is made to run without acceleration, at a speed that
//! the joints can hold, so that what lies before does not depend on what comes after.
//!
//! A fast motion has such places by itself: those of its highest and lowest speed. The rough solution of the whole
//! window shows them; of those that are neither too near nor too far, the one is taken that costs least speed.

use super::coordinate::End;
use super::course::Limits;
use super::motion::{TimingPiece, duration, paced, starts};
use super::{JointJet, JointPath, TimingError, TimingLimits};

/// The longest time between anchors that is looked for, and where the next one is sought, in seconds from the last.
const LONGEST: f64 = 1.25;
const RANGE: [f64; 2] = [0.4, 0.9];
/// No anchor is nearer to an end of its window than this, in seconds.
const NEAREST: f64 = 0.1;
/// Share of the highest constant speed that the joints could hold which an anchor may take.
const SHARE: f64 = 0.95;
/// Joints that could hold this many times the path's own speed can hold that.
const SPARE: f64 = 1.01;
/// Share of the path's own speed limit.
const PATH_SHARE: f64 = 0.998;
/// From this share on, a rough motion has the path's own speed.
const ROUGHLY: f64 = 0.96;
/// An anchor that costs more than this share of the speed is only made where a window is too long.
const COSTLY: f64 = 0.1;
/// Time in which a motion is bent towards an anchor, on either side, and the slowest pace that this may give.
const BENDING: f64 = 0.06;
const SLOWEST: f64 = 0.2;

/// A place where the motion is held without acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Anchor {
    /// The piece of the rough motion that starts there.
    pub(super) piece: usize,
    pub(super) place: f64,
    pub(super) speed: f64,
}

/// Anchors for a rough motion through a window. `braking`: the path will go on, and for so long before the motion's
/// end it may be on its way to rest.
pub(super) fn anchors<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    limits: &Limits,
    rough: &[TimingPiece],
    braking: Option<f64>,
) -> Result<Vec<Anchor>, TimingError<P::Error>> {
    let starts = starts(rough);
    let whole = duration(rough);
    let mut anchors = Vec::new();
    let mut last = 0.0;
    loop {
        let left = whole - last;
        let room = left - braking.map_or(NEAREST, |braking| braking.max(NEAREST));
        let long = left > LONGEST;
        if room < NEAREST || !(long || braking.is_some()) {
            return Ok(anchors);
        }
        let [from, to] = if long { RANGE.map(|time| time.min(room)) } else { [NEAREST, room] };
        let from = from.min(room / 2.0).max(NEAREST);
        let mut best: Option<(f64, usize, Anchor)> = None;
        for index in starts.partition_point(|&start| start < last + from)..rough.len() {
            if starts[index] > last + to {
                break;
            }
            let piece = &rough[index];
            let place = piece.position;
            let jet = path.jet(place).map_err(|error| TimingError::Path { position: place, error })?;
            let speed = held(&jet, joints, limits, piece);
            let cost = 1.0 - speed / piece.velocity;
            if speed > 0.0 && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, index, Anchor { piece: index, place, speed }));
            }
        }
        match best {
            Some((cost, index, anchor)) if long || cost < COSTLY => {
                last = starts[index];
                anchors.push(anchor);
            }
            _ => return Ok(anchors),
        }
    }
}

/// The speed without acceleration that a motion can have where it has this state: what the joints could hold, and
/// less than the motion has by what it takes to lose its acceleration. A rough motion that nearly has the path's speed
/// would have it if it were exact.
fn held<const N: usize>(
    jet: &JointJet<N>,
    joints: &TimingLimits<N>,
    limits: &Limits,
    state: &TimingPiece,
) -> f64 {
    let path = limits.within(state.position, state.position);
    let (mut speed, mut jerk) = (PATH_SHARE * path.speed, path.jerk);
    for i in 0..N {
        let bending = (joints.acceleration[i] / jet.acceleration[i].abs()).sqrt();
        let twisting = (joints.jerk[i] / jet.jerk[i].abs()).cbrt();
        let most = (joints.velocity[i] / jet.velocity[i].abs()).min(bending).min(twisting);
        if most < SPARE * path.speed {
            speed = speed.min(SHARE * most);
        }
        jerk = jerk.min(joints.jerk[i] / jet.velocity[i].abs());
    }
    let bent = state.velocity - state.acceleration * state.acceleration / jerk;
    if bent > ROUGHLY * path.speed { speed } else { speed.min(bent) }
}

/// A rough motion, bent so that it has the speeds of its ends and no acceleration there, or nearly so: good enough
/// to make a coordinate of.
pub(super) fn bent(rough: &[TimingPiece], ends: [End; 2]) -> Vec<TimingPiece> {
    let (Some(first), Some(last)) = (rough.first(), rough.last()) else { return Vec::new() };
    let whole = duration(rough);
    let (start, end) = (first.at(0.0), last.end());
    // Factor of speed, and its change over the bending time that cancels the acceleration.
    let bend = |end: End, velocity: f64, acceleration: f64| match end {
        End::Rest => [0.0, 0.0],
        End::Cruise(speed) => {
            let factor = speed / velocity;
            [factor - 1.0, -factor * acceleration * BENDING / velocity]
        }
    };
    let bends =
        [bend(ends[0], start.velocity, start.acceleration), bend(ends[1], end.velocity, -end.acceleration)];
    paced(rough, |time| {
        // Both ends by their own time, which for the second runs backwards.
        let [near, far] = [(bends[0], time), (bends[1], whole - time)].map(|([level, slope], time)| {
            let x = (time / BENDING).min(1.0);
            let bell = 1.0 - x * x;
            let value = (level + slope * x) * bell * bell * bell;
            let change = slope * bell * bell * bell - 6.0 * x * (level + slope * x) * bell * bell;
            [value, change / BENDING]
        });
        let pace = 1.0 + near[0] + far[0];
        if pace < SLOWEST { [SLOWEST, 0.0] } else { [pace, near[1] - far[1]] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::timing::motion::{PathState, joining};
    use crate::plan::timing::{PathLimits, Stretch};

    /// A joint that could follow 2 % faster than programmed, and a rough motion 2.5 % slower: the anchor is no dip in the speed.
    #[test]
    fn an_anchor_where_the_joints_can_follow_is_no_dip() {
        struct Bend;
        impl JointPath<1> for Bend {
            type Error = ();
            fn length(&self) -> f64 {
                1.0
            }
            fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
                let acceleration = [10.0 / (0.204 * 0.204)];
                Ok(JointJet { position: [s], velocity: [1.0], acceleration, jerk: [0.0] })
            }
        }
        let joints = TimingLimits { velocity: [1.0], acceleration: [10.0], jerk: [500.0] };
        let limits = PathLimits { speed: 0.2, acceleration: 10.0, jerk: 500.0 };
        let limits = Limits::new::<()>(&[Stretch { to: 1.0, limits }], 1.0).unwrap();
        let state = PathState { velocity: 0.195, ..PathState::default() };
        let cruise = joining(&state, &PathState { position: 0.00195, ..state }, 0.01);
        let rough: Vec<_> =
            (0..100).map(|k| TimingPiece { position: 0.00195 * f64::from(k), ..cruise }).collect();
        let anchors = anchors(&mut Bend, &joints, &limits, &rough, Some(0.3)).unwrap();
        let held = |anchor: &Anchor| anchor.speed > 0.99 * 0.2 && anchor.speed <= 0.2;
        assert!(!anchors.is_empty() && anchors.iter().all(held), "{anchors:?}");
    }
}
