//! The judge: how much of each limit a motion along a path takes, between the samples too.
//!
//! A piece is sampled with exact derivatives in time and bisected until
//! - the samples of an interval predict each other (Hermite's formulae for position and velocity, Simpson's
//!   for the acceleration), so that nothing hides in between: a needle-sharp turn of a wrist shows as a
//!   displacement that nothing at the ends foretells;
//! - the middle lies near the chord wherever the limit is near, so that the parabola through the three
//!   samples tells what happens between them.

use super::course::Limits;
use super::motion::{PathState, TimingPiece};
use super::{JointJet, JointPath, PathLimits, TimingError, TimingLimits};

/// First intervals: this long at most, in seconds, but not more of them than `FIRST_INTERVALS` a piece.
const FIRST_INTERVAL: f64 = 2.5e-3;
const FIRST_INTERVALS: f64 = 64.0;
/// Bound on bisections: an interval of 100 s comes down to 1e-10 s.
const DEPTH: usize = 40;
/// Bound on bisections that only sharpen a peak.
const SHARPENING_DEPTH: usize = 8;
/// From this share of a limit on, samples are made to tell it sharply: by the second difference that they may
/// have, and by the mean jerk between two of them that they may leave unexplained, as shares.
const NEAR: f64 = 0.95;
const BEND: f64 = 0.005;
const UNEXPLAINED: f64 = 0.001;
/// What may stay unseen in an interval of at most `SHARP` seconds: a turn, as a share of what the jerk limit
/// could make of it, and a mean jerk, as a share of the limit.
const UNSEEN_TURN: f64 = 0.02;
const UNSEEN_JERK: f64 = 0.002;
const SHARP: f64 = 5e-3;
/// Halvings that find where the speed along the path is greatest: there it hardly changes.
const PEAK_HALVINGS: usize = 10;
/// Rounding: of the place, as a share of the path's length; of joint positions in radians; of velocities and
/// accelerations as a share of the limit or the load.
const PLACE_NOISE: f64 = 1e-14;
const POSITION_NOISE: f64 = 1e-9;
const RATE_NOISE: f64 = 1e-6;
/// Bound on the splits of one first interval. A needle takes about a hundred; only a path that is not smooth at any
/// scale takes more than this.
const SPLITS: usize = 4000;
/// Where a limit is passed so far that time would have to be stretched by this, it does not matter how far
/// exactly.
const CLEAR: f64 = 1.5;
/// A jump between places that rounding can hardly tell apart: in position, by so many times the rounding; in
/// velocity and acceleration, as a share of the limit or the load.
const JUMP_NOISE: f64 = 1e3;
const JUMPS: [f64; 2] = [1e-6, 1e-2];

/// Highest share of each limit that a stretch of motion takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Load<const N: usize> {
    /// Per order (velocity, acceleration, jerk) and joint.
    pub(super) joints: [[f64; N]; 3],
    /// Per order, of the path's own limits.
    pub(super) path: [f64; 3],
}

impl<const N: usize> Load<N> {
    pub(super) const NONE: Self = Self { joints: [[0.0; N]; 3], path: [0.0; 3] };

    /// The higher of two loads, share by share.
    pub(super) fn raised(&self, other: &Self) -> Self {
        Self {
            joints: core::array::from_fn(|order| {
                core::array::from_fn(|i| self.joints[order][i].max(other.joints[order][i]))
            }),
            path: core::array::from_fn(|order| self.path[order].max(other.path[order])),
        }
    }

    /// Highest share of each order.
    pub(super) fn orders(&self) -> [f64; 3] {
        core::array::from_fn(|order| self.joints[order].iter().fold(self.path[order], |most, &x| most.max(x)))
    }

    /// Factor on time that brings every share down to 1.
    pub(super) fn stretch(&self) -> f64 {
        let [velocity, acceleration, jerk] = self.orders();
        velocity.max(acceleration.sqrt()).max(jerk.cbrt())
    }
}

/// The joints in motion at one instant.
#[derive(Clone, Copy)]
struct Sample<const N: usize> {
    time: f64,
    place: f64,
    position: [f64; N],
    /// Velocity, acceleration and jerk as signed shares of their limits.
    shares: [[f64; N]; 3],
    /// Speed, acceleration and jerk along the path.
    path: [f64; 3],
    /// What rounding does to position, velocity and acceleration.
    noise: [[f64; N]; 3],
}

/// The joints' derivatives in time on a path.
fn in_time<const N: usize>(jet: &JointJet<N>, state: &PathState) -> [[f64; N]; 3] {
    let PathState { velocity: v, acceleration: a, jerk: j, .. } = *state;
    [
        jet.velocity.map(|d1| d1 * v),
        core::array::from_fn(|i| jet.acceleration[i] * v * v + jet.velocity[i] * a),
        core::array::from_fn(|i| {
            jet.jerk[i] * v * v * v + 3.0 * jet.acceleration[i] * v * a + jet.velocity[i] * j
        }),
    ]
}

/// Judges motions along one path under one set of limits.
pub(super) struct Check<'a, const N: usize, P> {
    path: &'a mut P,
    length: f64,
    joints: &'a TimingLimits<N>,
    limits: &'a Limits,
    /// The path's limits under which the samples at hand are judged.
    valid: PathLimits,
    /// Right ends of intervals still to be judged, the nearest last, and how often each was split.
    waiting: Vec<(Sample<N>, usize)>,
}

impl<'a, const N: usize, P: JointPath<N>> Check<'a, N, P> {
    pub(super) fn new(path: &'a mut P, joints: &'a TimingLimits<N>, limits: &'a Limits) -> Self {
        let length = path.length();
        let valid = limits.within(0.0, length);
        Self { path, length, joints, limits, valid, waiting: Vec::with_capacity(DEPTH + 1) }
    }

    /// The load of a whole motion.
    pub(super) fn pieces(&mut self, pieces: &[TimingPiece]) -> Result<Load<N>, TimingError<P::Error>> {
        let mut load = Load::NONE;
        for piece in pieces {
            load = load.raised(&self.piece(piece, |_, _, _| {})?);
        }
        Ok(load)
    }

    /// The load of one piece; `each` is told every interval's times in the piece (from, to) and load.
    pub(super) fn piece(
        &mut self,
        piece: &TimingPiece,
        mut each: impl FnMut(f64, f64, &Load<N>),
    ) -> Result<Load<N>, TimingError<P::Error>> {
        let intervals = (piece.duration / FIRST_INTERVAL).ceil().clamp(1.0, FIRST_INTERVALS);
        let mut load = Load::NONE;
        self.valid = self.limits.within(piece.position, piece.end().position);
        let mut start = self.sample(piece, 0.0)?;
        for index in 1..=intervals as usize {
            let end = self.sample(piece, piece.duration * index as f64 / intervals)?;
            load = load.raised(&self.interval(piece, &start, &end, &mut each)?);
            start = end;
        }
        Ok(load)
    }

    /// The loads of a piece's two halves.
    pub(super) fn halves(&mut self, piece: &TimingPiece) -> Result<[Load<N>; 2], TimingError<P::Error>> {
        let start = self.sample(piece, 0.0)?;
        let middle = self.sample(piece, piece.duration / 2.0)?;
        let end = self.sample(piece, piece.duration)?;
        let mut half = |from: &Sample<N>, to: &Sample<N>| {
            self.valid = self.limits.within(from.place, to.place);
            self.interval(piece, from, to, &mut |_, _, _| {})
        };
        Ok([half(&start, &middle)?, half(&middle, &end)?])
    }

    fn sample(&mut self, piece: &TimingPiece, time: f64) -> Result<Sample<N>, TimingError<P::Error>> {
        let state = piece.at(time);
        let place = state.position.clamp(0.0, self.length);
        let jet = self.path.jet(place).map_err(|error| TimingError::Path { position: place, error })?;
        let [velocity, acceleration, jerk] = in_time(&jet, &state);
        let shares = [
            core::array::from_fn(|i| velocity[i] / self.joints.velocity[i]),
            core::array::from_fn(|i| acceleration[i] / self.joints.acceleration[i]),
            core::array::from_fn(|i| jerk[i] / self.joints.jerk[i]),
        ];
        let finite = |joint: &usize| !shares.iter().all(|order| order[*joint].is_finite());
        if let Some(joint) = (0..N).find(finite) {
            return Err(TimingError::Discontinuous { position: place, joint });
        }
        let path = [state.velocity, state.acceleration, state.jerk];
        let noise = self.noise(&jet, &state, &shares);
        Ok(Sample { time, place, position: jet.position, shares, path, noise })
    }

    fn noise(&self, jet: &JointJet<N>, state: &PathState, shares: &[[f64; N]; 3]) -> [[f64; N]; 3] {
        let PathState { velocity: v, acceleration: a, .. } = *state;
        let blur = PLACE_NOISE * self.length;
        let rounding = |limit: f64, share: f64| RATE_NOISE * limit * share.abs().max(1.0);
        [
            jet.velocity.map(|d1| POSITION_NOISE + blur * d1.abs()),
            core::array::from_fn(|i| {
                rounding(self.joints.velocity[i], shares[0][i]) + blur * (jet.acceleration[i] * v).abs()
            }),
            core::array::from_fn(|i| {
                let change = jet.jerk[i] * v * v + jet.acceleration[i] * a;
                rounding(self.joints.acceleration[i], shares[1][i]) + blur * change.abs()
            }),
        ]
    }

    /// Bisects one interval until every part can be vouched for.
    fn interval(
        &mut self,
        piece: &TimingPiece,
        start: &Sample<N>,
        end: &Sample<N>,
        each: &mut impl FnMut(f64, f64, &Load<N>),
    ) -> Result<Load<N>, TimingError<P::Error>> {
        let mut load = Load::NONE;
        let mut left = *start;
        self.waiting.clear();
        self.waiting.push((*end, 0));
        let mut splits = 0;
        // Each turn either finishes an interval or splits one, and there are at most SPLITS of these.
        while let Some((right, depth)) = self.waiting.pop() {
            let middle = self.sample(piece, (left.time + right.time) / 2.0)?;
            let mut part = highest(&left, &middle, &right, &self.valid);
            let peak =
                peak_speed(piece, left.time, middle.time).max(peak_speed(piece, middle.time, right.time));
            part.path[0] = part.path[0].max(peak / self.valid.speed);
            let foretold = self.foretold(&left, &middle, &right, &part);
            if !foretold && depth == DEPTH {
                self.refuse_jump(&left, &right)?;
            }
            let sharp = depth >= SHARPENING_DEPTH || self.sharp(&left, &middle, &right, &part);
            let clear = part.stretch() > CLEAR;
            if depth < DEPTH && !clear && !(foretold && sharp) {
                splits += 1;
                if splits > SPLITS {
                    let joint = self.fastest(&left, &right);
                    return Err(TimingError::Discontinuous { position: right.place, joint });
                }
                self.waiting.push((right, depth + 1));
                self.waiting.push((middle, depth + 1));
                continue;
            }
            each(left.time, right.time, &part);
            load = load.raised(&part);
            left = right;
        }
        Ok(load)
    }

    /// Whether the samples tell what happens between them to a small part of the limit, wherever that is
    /// near.
    fn sharp(&self, start: &Sample<N>, middle: &Sample<N>, end: &Sample<N>, load: &Load<N>) -> bool {
        let half = (end.time - start.time) / 2.0;
        let bend = |order: usize, i: usize| {
            let at = |sample: &Sample<N>| sample.shares[order][i];
            (at(start) - 2.0 * at(middle) + at(end)).abs()
        };
        // Mean jerk of half an interval, as its limit's share: by the change of acceleration, and by the
        // samples.
        let unexplained = |a: &Sample<N>, b: &Sample<N>, i: usize| {
            let change = self.joints.acceleration[i] * (b.shares[1][i] - a.shares[1][i]);
            let mean = self.joints.jerk[i] * half * (a.shares[2][i] + b.shares[2][i]) / 2.0;
            let noise = a.noise[2][i] + b.noise[2][i];
            ((change - mean).abs() - noise) / (self.joints.jerk[i] * half)
        };
        (0..N).all(|i| {
            let bends = (0..3).any(|order| {
                let share = load.joints[order][i];
                share > NEAR && bend(order, i) > BEND * share
            });
            let share = load.joints[2][i];
            let hides = share > NEAR
                && unexplained(start, middle, i).max(unexplained(middle, end, i)) > UNEXPLAINED * share;
            !bends && !hides
        })
    }

    /// Whether the samples of an interval predict each other.
    fn foretold(&self, start: &Sample<N>, middle: &Sample<N>, end: &Sample<N>, load: &Load<N>) -> bool {
        let t = end.time - start.time;
        let sharp = t.min(SHARP);
        (0..N).all(|i| {
            let change = |order: usize| end.shares[order][i] - start.shares[order][i];
            let sum = |order: usize| end.shares[order][i] + start.shares[order][i];
            let limit = [self.joints.velocity[i], self.joints.acceleration[i], self.joints.jerk[i]];
            let jerk = limit[2] * load.joints[2][i].max(1.0);
            // q₁ − q₀ = h/2 (q̇₀+q̇₁) − h²/10 (q̈₁−q̈₀) + h³/120 (q⃛₀+q⃛₁) + O(h⁷)
            let position = end.position[i] - start.position[i] - t / 2.0 * limit[0] * sum(0)
                + t * t / 10.0 * limit[1] * change(1)
                - t * t * t / 120.0 * limit[2] * sum(2);
            // q̇₁ − q̇₀ = h/2 (q̈₀+q̈₁) − h²/12 (q⃛₁−q⃛₀) + O(h⁵)
            let velocity =
                limit[0] * change(0) - t / 2.0 * limit[1] * sum(1) + t * t / 12.0 * limit[2] * change(2);
            // q̈₁ − q̈₀ = h/6 (q⃛₀ + 4 q⃛ₘ + q⃛₁) + O(h⁵)
            let mean = (sum(2) + 4.0 * middle.shares[2][i]) / 6.0;
            let acceleration = limit[1] * change(1) - t * limit[2] * mean;
            let noise = |order: usize| start.noise[order][i] + end.noise[order][i];
            position.abs() <= UNSEEN_TURN * jerk * sharp * sharp * sharp + noise(0)
                && velocity.abs() <= UNSEEN_TURN * jerk * sharp * sharp + noise(1)
                && acceleration.abs() <= UNSEEN_JERK * jerk * sharp + noise(2)
        })
    }

    /// The joint that turns most between two places, in terms of its velocity limit.
    fn fastest(&self, start: &Sample<N>, end: &Sample<N>) -> usize {
        let turn = |i: &usize| (end.position[*i] - start.position[*i]).abs() / self.joints.velocity[*i];
        (0..N).max_by(|a, b| turn(a).total_cmp(&turn(b))).unwrap_or(0)
    }

    /// At the end of all bisection: an error where a joint's position, velocity or acceleration jumps.
    fn refuse_jump(&self, start: &Sample<N>, end: &Sample<N>) -> Result<(), TimingError<P::Error>> {
        let jumps = |i: &usize| {
            let position = (end.position[*i] - start.position[*i]).abs();
            let noise = start.noise[0][*i] + end.noise[0][*i];
            let steps = |order: usize| {
                let (before, after) = (start.shares[order][*i], end.shares[order][*i]);
                (after - before).abs() > JUMPS[order] * before.abs().max(1.0)
            };
            position > JUMP_NOISE * noise || steps(0) || steps(1)
        };
        match (0..N).find(jumps) {
            Some(joint) => Err(TimingError::Discontinuous { position: end.place, joint }),
            None => Ok(()),
        }
    }
}

/// The greatest speed of a piece between two times, at one of them or where the acceleration falls through zero.
fn peak_speed(piece: &TimingPiece, from: f64, to: f64) -> f64 {
    let [start, end] = [from, to].map(|time| piece.at(time));
    if start.acceleration <= 0.0 || end.acceleration >= 0.0 {
        return start.velocity.max(end.velocity);
    }
    let (mut low, mut high) = (from, to);
    for _ in 0..PEAK_HALVINGS {
        let middle = (low + high) / 2.0;
        if piece.at(middle).acceleration > 0.0 { low = middle } else { high = middle }
    }
    piece.at((low + high) / 2.0).velocity
}

/// The highest shares on three evenly spaced samples and on the parabola through them.
fn highest<const N: usize>(
    start: &Sample<N>,
    middle: &Sample<N>,
    end: &Sample<N>,
    limits: &PathLimits,
) -> Load<N> {
    let path = [limits.speed, limits.acceleration, limits.jerk];
    let highest = |a: f64, m: f64, b: f64| {
        let (slope, bend) = ((b - a) / 2.0, a - 2.0 * m + b);
        let vertex = if slope.abs() < bend.abs() { (m - slope * slope / (2.0 * bend)).abs() } else { 0.0 };
        a.abs().max(m.abs()).max(b.abs()).max(vertex)
    };
    Load {
        joints: core::array::from_fn(|order| {
            core::array::from_fn(|i| {
                highest(start.shares[order][i], middle.shares[order][i], end.shares[order][i])
            })
        }),
        path: core::array::from_fn(|order| {
            highest(start.path[order], middle.path[order], end.path[order]) / path[order]
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::timing::course::Stretch;
    use crate::plan::timing::motion::stretched;
    use crate::plan::timing::plain::Plain;

    /// A joint that turns by nearly π about the middle of a path of length 1: q = atan((s − ½)/δ).
    struct Needle(f64);

    impl JointPath<1> for Needle {
        type Error = ();

        fn length(&self) -> f64 {
            1.0
        }

        fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
            let width = self.0;
            let x = (s - 0.5) / width;
            let one = 1.0 + x * x;
            Ok(JointJet {
                position: [x.atan()],
                velocity: [1.0 / (width * one)],
                acceleration: [-2.0 * x / (width * one).powi(2)],
                jerk: [(6.0 * x * x - 2.0) / (width * one).powi(3)],
            })
        }
    }

    const JOINT: TimingLimits<1> = TimingLimits { velocity: [1.0], acceleration: [10.0], jerk: [500.0] };
    const PATH: PathLimits = PathLimits { speed: 0.1, acceleration: 2.0, jerk: 100.0 };

    fn limits() -> Limits {
        Limits::new::<()>(&[Stretch { to: 1.0, limits: PATH }], 1.0).unwrap()
    }

    fn plain() -> Vec<TimingPiece> {
        Plain::new::<()>(&limits(), 0.0).unwrap().pieces
    }

    /// Needles from 1 cm down to 1 nm, much narrower than the first samples' distance, are all seen; the
    /// widest is measured to one per cent.
    #[test]
    fn no_needle_slips_through() {
        let pieces = plain();
        for decade in 2..10 {
            let width = 10f64.powi(-decade);
            let load = Check::new(&mut Needle(width), &JOINT, &limits()).pieces(&pieces).unwrap();
            assert!(load.stretch() > CLEAR, "{width}");
        }
        let slow: Vec<TimingPiece> = pieces.iter().map(|piece| stretched(piece, 10.0)).collect();
        let load = Check::new(&mut Needle(0.01), &JOINT, &limits()).pieces(&slow).unwrap();
        let v = PATH.speed / 10.0;
        // Highest q′, q″ and q‴ of the arctangent.
        let highest = [v / 0.01, 0.649_519 * (v / 0.01).powi(2), 2.0 * (v / 0.01).powi(3)];
        for (order, limit) in [1.0, 10.0, 500.0].into_iter().enumerate() {
            let wanted = highest[order] / limit;
            assert!((load.joints[order][0] / wanted - 1.0).abs() < 1e-2, "{order}: {load:?}");
        }
    }

    /// A path that is noise at every scale ends in an error, not in endless bisection.
    #[test]
    fn noise_is_given_up() {
        struct Noise;
        impl JointPath<1> for Noise {
            type Error = ();
            fn length(&self) -> f64 {
                1.0
            }
            fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
                let noise = (s * 1e17).sin() * 1e-4;
                Ok(JointJet { position: [noise], velocity: [0.1], acceleration: [0.0], jerk: [0.0] })
            }
        }
        let pieces = plain();
        let found = Check::new(&mut Noise, &JOINT, &limits()).pieces(&pieces);
        assert!(matches!(found, Err(TimingError::Discontinuous { joint: 0, .. })));
    }
}
