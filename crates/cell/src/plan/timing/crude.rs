//! A first guess of the motion: fast, roughly right, and never trusted.
//!
//! Pointwise speed bounds, a backward and a forward pass with the joints' acceleration limits, and a filter
//! that takes the corners off. It only supplies the coordinate s(w); the optimizer finds the motion.

use super::coordinate::{Coordinate, End};
use super::course::Limits;
use super::window::Window;
use super::{JointJet, JointPath, TimingError, TimingLimits};

/// Share of the acceleration and jerk limits that the pointwise bound gives to a path's bending.
const BENDING_SHARE: f64 = 0.6;
/// Share of the acceleration limits that the passes use, and of the jerk limits behind a held end.
const PASS_SHARE: f64 = 0.8;
/// Neighbouring places differ by at most this in ln ν, in any joint (rad), and in time (s).
const SPEED_CHANGE: f64 = 0.15;
const JOINT_CHANGE: f64 = 0.03;
const TIME_CHANGE: f64 = 0.01;
/// Bounds on bisections and on places.
const DEPTH: usize = 48;
const PLACES: usize = 100_000;
/// The filter: moving averages over twice this many knots and one.
const AVERAGES: [usize; 2] = [2, 1];
/// Within so many knots of a rest end the filter fades out: rest is smooth by itself.
const FADE: usize = 8;

/// A place of the path, with what the passes need to know.
#[derive(Clone, Copy)]
struct Place<const N: usize> {
    s: f64,
    position: [f64; N],
    /// Highest speed.
    speed: f64,
    /// Highest change of speed, per second.
    acceleration: f64,
}

struct Survey<'a, const N: usize, P> {
    path: &'a mut P,
    joints: &'a TimingLimits<N>,
    limits: &'a Limits,
    window: &'a Window,
    /// Jerk with which the motion can leave either end.
    launch: [f64; 2],
}

/// The coordinate that follows a first guess of the motion, with knots about `step` seconds apart.
pub(super) fn coordinate<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    limits: &Limits,
    window: &Window,
    step: f64,
) -> Result<Coordinate, TimingError<P::Error>> {
    let mut survey = Survey { path, joints, limits, window, launch: [f64::INFINITY; 2] };
    let mut places = survey.places()?;
    limit_braking(&mut places);
    places.reverse();
    limit_braking(&mut places);
    places.reverse();
    for (end, jerk) in window.ends.into_iter().zip(survey.launch) {
        leave(&mut places, end, PASS_SHARE * jerk);
        places.reverse();
    }
    let times = times(&places, &window.ends);
    let duration = times[times.len() - 1];
    let knots = knots(duration, step);
    let step = duration / (knots - 1) as f64;
    let samples = sampled(&places, &times, knots, &window.ends);
    Ok(Coordinate::new(&smoothed(&samples, &window.ends), step, window.ends))
}

/// Number of knots for a duration: at least a few, and not more than memory is for.
pub(super) fn knots(duration: f64, step: f64) -> usize {
    let [least, most] = INTERVALS;
    (duration / step).ceil().clamp(least, most) as usize + 1
}

/// Fewest and most intervals between knots.
const INTERVALS: [f64; 2] = [12.0, 20_000.0];

impl<const N: usize, P: JointPath<N>> Survey<'_, N, P> {
    fn jet(&mut self, s: f64) -> Result<JointJet<N>, TimingError<P::Error>> {
        self.path.jet(s).map_err(|error| TimingError::Path { position: s, error })
    }

    fn place(&mut self, s: f64) -> Result<Place<N>, TimingError<P::Error>> {
        let jet = self.jet(s)?;
        let limits = self.limits.within(s, s);
        let (mut speed, mut acceleration) = (limits.speed, limits.acceleration);
        for i in 0..N {
            let bending = BENDING_SHARE * self.joints.acceleration[i] / jet.acceleration[i].abs();
            let twisting = BENDING_SHARE * self.joints.jerk[i] / jet.jerk[i].abs();
            let most =
                (self.joints.velocity[i] / jet.velocity[i].abs()).min(bending.sqrt()).min(twisting.cbrt());
            speed = speed.min(most);
            acceleration = acceleration.min(self.joints.acceleration[i] / jet.velocity[i].abs());
        }
        let distances = [s - self.window.from, self.window.to - s];
        for ((distance, launch), end) in distances.into_iter().zip(self.launch).zip(self.window.ends) {
            if end.rests() {
                // From rest at constant jerk: s = j t³/6, ṡ = j t²/2.
                speed = speed.min((4.5 * launch * distance * distance).cbrt());
            } else if distance == 0.0 {
                speed = end.speed();
            }
        }
        Ok(Place { s, position: jet.position, speed, acceleration: PASS_SHARE * acceleration })
    }

    fn places(&mut self) -> Result<Vec<Place<N>>, TimingError<P::Error>> {
        let (from, to) = (self.window.from, self.window.to);
        for (launch, s) in [from, to].into_iter().enumerate() {
            let jet = self.jet(s)?;
            self.launch[launch] = self.limits.within(s, s).jerk;
            for i in 0..N {
                self.launch[launch] = self.launch[launch].min(self.joints.jerk[i] / jet.velocity[i].abs());
            }
        }
        let mut places = vec![self.place(from)?];
        let mut waiting = vec![(self.place(to)?, 0)];
        while let Some(&(right, depth)) = waiting.last() {
            let left = places[places.len() - 1];
            if depth < DEPTH && places.len() < PLACES && self.coarse(&left, &right) {
                let middle = self.place((left.s + right.s) / 2.0)?;
                if let Some(last) = waiting.last_mut() {
                    last.1 = depth + 1;
                }
                waiting.push((middle, depth + 1));
            } else {
                places.push(right);
                waiting.pop();
            }
        }
        Ok(places)
    }

    fn coarse(&self, left: &Place<N>, right: &Place<N>) -> bool {
        let (slow, fast) = (left.speed.min(right.speed), left.speed.max(right.speed));
        let distance = right.s - left.s;
        let turns = (0..N).any(|i| (right.position[i] - left.position[i]).abs() > JOINT_CHANGE);
        if slow == 0.0 {
            // Next to rest: t = 3 s/ṡ on a cubic.
            return turns || 3.0 * distance > TIME_CHANGE * fast;
        }
        turns || fast > slow * SPEED_CHANGE.exp() || 2.0 * distance > TIME_CHANGE * (slow + fast)
    }
}

/// Lowers speeds so that each place can be left at the next one's speed.
fn limit_braking<const N: usize>(places: &mut [Place<N>]) {
    for i in (0..places.len() - 1).rev() {
        let next = places[i + 1];
        let acceleration = next.acceleration.min(places[i].acceleration);
        let distance = (next.s - places[i].s).abs();
        let most = (next.speed * next.speed + 2.0 * acceleration * distance).sqrt();
        places[i].speed = places[i].speed.min(most);
    }
}

/// Raises speeds behind a held end at the first place to what braking leaves of its speed, with a jerk from no acceleration on, where less
/// would be permitted.
fn leave<const N: usize>(places: &mut [Place<N>], end: End, jerk: f64) {
    let (mut least, mut braking) = (end.speed(), 0.0);
    for i in 0..places.len() - 1 {
        if least <= places[i].speed {
            break;
        }
        places[i].speed = least;
        let distance = (places[i + 1].s - places[i].s).abs();
        let most = places[i].acceleration.min(places[i + 1].acceleration);
        let more = (braking + jerk * distance / least).min(most);
        least = (least * least - (braking + more) * distance).max(0.0).sqrt();
        braking = more;
    }
}

fn times<const N: usize>(places: &[Place<N>], ends: &[End; 2]) -> Vec<f64> {
    let mut times = Vec::with_capacity(places.len());
    let mut time = 0.0;
    times.push(time);
    for (index, pair) in places.windows(2).enumerate() {
        let first = index == 0 && ends[0].rests();
        let last = index + 2 == places.len() && ends[1].rests();
        let factor = if first || last { 3.0 } else { 2.0 };
        time += factor * (pair[1].s - pair[0].s) / (pair[0].speed + pair[1].speed);
        times.push(time);
    }
    times
}

/// Places at even times.
fn sampled<const N: usize>(places: &[Place<N>], times: &[f64], knots: usize, ends: &[End; 2]) -> Vec<f64> {
    let duration = times[times.len() - 1];
    let last = places.len() - 1;
    let mut index = 0;
    (0..knots)
        .map(|knot| {
            let time = duration * knot as f64 / (knots - 1) as f64;
            while index + 2 < places.len() && times[index + 1] < time {
                index += 1;
            }
            let (left, right) = (&places[index], &places[index + 1]);
            let interval = times[index + 1] - times[index];
            let share = ((time - times[index]) / interval).clamp(0.0, 1.0);
            let distance = right.s - left.s;
            if index == 0 && ends[0].rests() {
                left.s + distance * share * share * share
            } else if index + 1 == last && ends[1].rests() {
                let rest = 1.0 - share;
                right.s - distance * rest * rest * rest
            } else {
                // Constant acceleration between the two speeds.
                let change = (right.speed - left.speed) / 2.0 * share;
                left.s + interval * share * (left.speed + change)
            }
        })
        .collect()
}

/// The samples after two moving averages, continued oddly beyond either end.
fn smoothed(samples: &[f64], ends: &[End; 2]) -> Vec<f64> {
    let last = samples.len() - 1;
    let mut smooth = samples.to_vec();
    for half in AVERAGES {
        let before = smooth.clone();
        let at = |index: isize| -> f64 {
            if index < 0 {
                2.0 * before[0] - before[index.unsigned_abs()]
            } else if index as usize > last {
                2.0 * before[last] - before[2 * last - index as usize]
            } else {
                before[index as usize]
            }
        };
        for (index, value) in smooth.iter_mut().enumerate() {
            let around = index as isize - half as isize..=index as isize + half as isize;
            *value = around.map(at).sum::<f64>() / (2 * half + 1) as f64;
        }
    }
    for (index, value) in smooth.iter_mut().enumerate() {
        let mut weight: f64 = 1.0;
        for (distance, end) in [index, last - index].into_iter().zip(ends) {
            if end.rests() {
                weight = weight.min(distance.saturating_sub(2) as f64 / FADE as f64);
            }
        }
        *value = weight * *value + (1.0 - weight) * samples[index];
    }
    smooth
}
