//! How far prefilters on the joints take the tool off its path, and how slow it must be for that.
//!
//! What comes out of the prefilters is a mean of the joints q(s) over some of the way behind the program. About that mean of s,
//!
//! ```text
//! q̄ = q(s̄) + ½ q″ Var(s)        Var(s) ≤ σ² ṡ²
//! ```
//!
//! with σ² the variance of the kernels, and q″ and ṡ the greatest over the kernels' length. The tool is off by what its Jacobian makes of
//! it. So each place of the path has a speed that must not be passed within the kernels' length of it; how the speed changes does not
//! matter, and neither do override and pause. `docs/vibration.md` has the derivation.

use nalgebra::SVector;
use seamline::control::ActsOn;
use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::{JointJet, Kinematics};
use seamline::path::{Measure, Path};
use seamline::vibration::Kernel;

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::joint_path::PathJoints;
use super::planner::Planner;
use super::remark::{Remarks, units};
use super::route::Route;
use super::run::{Piece, Run};
use super::smeared_corner::Passing;
use super::timing::{JointPath as _, PathLimits, Stretch};
use crate::cell::Vibration;
use crate::record::{OnSeam, SegmentInfo, SegmentKind};

/// Places of a path that are looked at: this far apart, in metres and in radians of the tool's turn, and how many at least and at most.
const SPACING: [f64; 2] = [5e-3, 0.02];
const PLACES: [f64; 2] = [24.0, 2_000.0];
/// Speeds are rounded down to powers of this, so that they do not change from place to place.
const STEP: f64 = 1.02;
/// What a corner leaves of its permitted error for the joints' own curvature.
pub(super) const FOR_JOINTS: f64 = 0.05;
/// A weld that is this far off its path is worth a word, in metres.
const WORTH_A_WORD: f64 = 1e-5;
/// Cells that the kernels' length is divided into, and how many more there may be: as many as there may be kernels, and one.
const CELLS: usize = 64;
const MORE_CELLS: usize = 4;
/// Places on either side of a corner at which the joints' own curvature is looked at.
const AROUND: u32 = 4;
/// A slowdown within this share of the speed is rounding.
const SAME_SPEED: f64 = 1e-3;

/// What prefilters do to a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Smear {
    /// σ², in s².
    pub(super) variance: f64,
    /// How long a command takes to come out whole, and at a constant rate, in seconds.
    pub(super) length: f64,
    pub(super) delay: f64,
    /// How far the tool may be off a move's path, in metres.
    pub(super) path_error: f64,
    /// How much of a command comes out after a time that begins in each cell, and lasts for as many cells as there are kernels.
    shares: [f64; CELLS + MORE_CELLS],
    kernels: usize,
}

/// A stretch of the run with limits of its own, on account of a place in it; infinite for none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cap {
    pub(super) place: f64,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) limits: PathLimits,
}

/// The greatest curvature of a path as far as it comes from curved joints: of the tool's place and of its turning, per path².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Bend {
    pub(super) place: f64,
    pub(super) turn: f64,
}

impl Smear {
    /// What the prefilters of a cell do; `None` where there are none.
    pub(super) fn of(vibration: &Vibration) -> Option<Self> {
        let kernels = vibration.kernels();
        let sum = |of: fn(&Kernel) -> f64| kernels.iter().map(of).sum();
        (!kernels.is_empty()).then(|| Self {
            variance: sum(Kernel::variance),
            length: sum(Kernel::length),
            delay: sum(Kernel::delay),
            path_error: vibration.path_error(),
            shares: shares(kernels, sum(Kernel::length) / CELLS as f64),
            kernels: kernels.len(),
        })
    }

    /// How long a cell is, in seconds.
    pub(super) fn cell(&self) -> f64 {
        self.length / CELLS as f64
    }

    /// A bound of what comes out across the middle of a corner, where a bound of what goes in is `off` of the number of cells until or
    /// since the middle, and rises with it: at some instant, as much has come in on one side of the middle as on the other.
    pub(super) fn mean_off(&self, off: impl Fn(usize) -> f64) -> f64 {
        let off: Vec<f64> = (0..CELLS + 2 * MORE_CELLS).map(off).collect();
        let shares = || self.shares.iter().enumerate();
        let sides = |middle: usize| {
            let after = shares().take(middle).map(|(cell, share)| share * off[middle - cell]);
            let before = shares().skip((middle + 1).saturating_sub(self.kernels));
            let before = before.map(|(cell, share)| share * off[cell + self.kernels - middle]);
            (after.sum::<f64>(), before.sum::<f64>())
        };
        // The longer ago the middle, the more has come in after it, and the less before.
        let (mut low, mut high) = (0, CELLS);
        while high - low > 1 {
            let middle = (low + high) / 2;
            let (after, before) = sides(middle);
            if after < before { low = middle } else { high = middle }
        }
        let at = |middle: usize| {
            let (after, before) = sides(middle);
            2.0 * after.max(before)
        };
        at(low).min(at(high))
    }

    /// How far the tool is off at a speed.
    fn error(&self, bend: &Bend, speed: f64) -> f64 {
        0.5 * self.variance * bend.place * speed * speed
    }

    /// The speed at which the tool is off by `error` metres, or turned by [`Vibration::TURN_ERROR`].
    pub(super) fn speed(&self, bend: &Bend, error: f64) -> f64 {
        let square = (error / bend.place).min(Vibration::TURN_ERROR / bend.turn) * 2.0 / self.variance;
        if square.is_nan() { f64::INFINITY } else { square.sqrt() }
    }

    /// A cap on account of a place.
    fn cap(&self, place: f64, speed: f64) -> Cap {
        let reach = speed * self.length;
        Cap { place, from: place - reach, to: place + reach, limits: PathLimits::of_speed(speed) }
    }
}

/// How much of a command comes out of kernels one behind the other, by cells of a time.
fn shares(kernels: &[Kernel], cell: f64) -> [f64; CELLS + MORE_CELLS] {
    let mut shares = [0.0; CELLS + MORE_CELLS];
    shares[0] = 1.0;
    for kernel in kernels {
        let before = shares;
        let of = (0..shares.len()).map(|at| share(kernel, at, cell)).collect::<Vec<_>>();
        for (at, sum) in shares.iter_mut().enumerate() {
            *sum = (0..=at).map(|k| before[k] * of[at - k]).sum();
        }
    }
    shares
}

/// What comes out of a kernel within one cell of a time.
fn share(kernel: &Kernel, at: usize, cell: f64) -> f64 {
    let [from, to] = [at, at + 1].map(|k| k as f64 * cell);
    let of = |start: f64| match kernel.rectangles().first() {
        Some(length) => (to.min(start + length) - from.max(start)).max(0.0) / length,
        None => f64::from(u8::from((start / cell) as usize == at)),
    };
    kernel.impulses().iter().map(|impulse| impulse.weight * of(impulse.time)).sum()
}

impl Bend {
    fn greater(self, other: Self) -> Self {
        Self { place: self.place.max(other.place), turn: self.turn.max(other.turn) }
    }
}

/// The bend of a path where its joints are `jet`, their derivatives along the path; without the curvature that is accounted for
/// otherwise.
fn bend<const N: usize>(
    kinematics: &impl Kinematics<N>,
    jet: &JointJet<N>,
    flange_from_tcp: &Pose,
    accounted: &[Vector3; 2],
) -> Bend {
    let axes = kinematics.axes(&jet.position);
    let twist = axes.jacobian() * SVector::from(jet.acceleration);
    let (linear, angular) = (twist.fixed_rows::<3>(0), twist.fixed_rows::<3>(3));
    let lever = axes.base_from_flange.rotation * flange_from_tcp.translation.vector;
    Bend {
        place: (linear + angular.cross(&lever) - accounted[0]).norm(),
        turn: (angular - accounted[1]).norm(),
    }
}

/// The power of [`STEP`] below a speed.
fn stepped(speed: f64) -> f64 {
    STEP.powf((speed.ln() / STEP.ln()).floor())
}

/// The path's own second derivatives: of the tool's place and of its turning.
fn of_path(route: &Route, s: f64) -> [Vector3; 2] {
    let jet = route.jet(s);
    [jet.linear[1], jet.angular[1]]
}

/// The places of a move's path that are looked at, between two coordinates. They lie where they lie on the whole move, whatever part of it
/// is asked for.
pub(super) fn places(path: &Path, from: f64, to: f64) -> impl Iterator<Item = f64> {
    let length = path.length();
    let turn = path.pose(0.0).rotation.angle_to(&path.pose(length).rotation);
    let way = if path.measure() == Measure::Length { length / SPACING[0] } else { 0.0 };
    let count = way.max(turn / SPACING[1]).ceil().clamp(PLACES[0], PLACES[1]);
    (0..=count as u32).map(move |k| length * f64::from(k) / count).filter(move |s| (from..=to).contains(s))
}

/// Stretches with caps laid over them. No cap is below the speed `start` that the first stretch begins with.
pub(super) fn slowed(stretches: &[Stretch], caps: &[Cap], start: f64) -> Vec<Stretch> {
    let end = stretches.last().map_or(0.0, |stretch| stretch.to);
    let mut ends: Vec<f64> = stretches.iter().map(|stretch| stretch.to).collect();
    ends.extend(caps.iter().flat_map(|cap| [cap.from, cap.to]).filter(|s| *s > 0.0 && *s < end));
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut from = 0.0;
    let mut slowed: Vec<Stretch> = Vec::new();
    for to in ends {
        let Some(stretch) = stretches.iter().find(|stretch| stretch.to >= to) else { break };
        let mut limits = over(caps, from, to).fold(stretch.limits, |least, cap| least.and(&cap.limits));
        if from == 0.0 {
            limits.speed = limits.speed.max(start.min(stretch.limits.speed));
        }
        match slowed.last_mut() {
            Some(before) if before.limits == limits => before.to = to,
            _ => slowed.push(Stretch { to, limits }),
        }
        from = to;
    }
    slowed
}

/// The least cap between two coordinates.
pub(super) fn least(caps: &[Cap], from: f64, to: f64) -> f64 {
    over(caps, from, to).fold(f64::INFINITY, |least, cap| least.min(cap.limits.speed))
}

/// The least cap on account of a place between two coordinates.
fn least_within(caps: &[Cap], from: f64, to: f64) -> f64 {
    let of = caps.iter().filter(|cap| (from..to).contains(&cap.place));
    of.fold(f64::INFINITY, |least, cap| least.min(cap.limits.speed))
}

/// The caps that hold somewhere between two coordinates.
fn over(caps: &[Cap], from: f64, to: f64) -> impl Iterator<Item = &Cap> {
    caps.iter().filter(move |cap| cap.from < to && cap.to > from)
}

/// What is said of a weld that the prefilters take off its path.
pub(super) fn off_weld<const N: usize>(piece: &Piece<N>) -> Option<String> {
    let off = piece.off * 1e3;
    (piece.info.arc && piece.off > WORTH_A_WORD)
        .then(|| format!("the prefilter takes the tool up to {off:.3} mm off this path"))
}

/// What a motion is held against when it comes out of the prefilters: the programmed speed is there only once all that is inside has it. What
/// those on the joints leave of a weave is no longer a function of the path: a woven move has no figures, and past a woven corner the weave may lead as far aside
/// as it reaches.
pub(super) fn lagging<const N: usize>(info: &SegmentInfo, run: &Run<N>) -> SegmentInfo {
    let Some((smear, speed)) = run.smear.zip(info.speed) else { return *info };
    let woven = info.kind.path().and_then(|path| Some((path, path.weave()?)));
    if let Some((path, weave)) = woven.filter(|_| run.acts_on == ActsOn::Joints) {
        let rounded = [path.length(); 2];
        let kind = match info.kind {
            SegmentKind::Corner { corner, permitted, .. } => {
                SegmentKind::Corner { path: Some(path.seam()), corner, permitted: permitted + weave.reach() }
            }
            kind => kind,
        };
        return SegmentInfo { kind, rounded, constant_part: None, ..*info };
    }
    let (enter, leave) = (speed * (smear.length - smear.delay), speed * smear.delay);
    let constant_part = info.constant_part.map(|[from, to]| [from + enter, to - leave]);
    // What corrects the seam is told where the program is, ahead of the arm.
    let seam = if info.seam == OnSeam::Tracked { OnSeam::Leaves } else { info.seam };
    SegmentInfo { constant_part: constant_part.filter(|[from, to]| from < to), seam, ..*info }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// The speeds not to pass on account of what prefilters do to the way ahead. Takes note of how far they take the tool off what lies
    /// before `to`.
    pub(super) fn caps(&mut self, ahead: &Route, joints: &mut PathJoints<'_, N, K>, to: f64) -> Vec<Cap> {
        let Some(smear) = self.run.smear else { return Vec::new() };
        if self.run.acts_on == ActsOn::Feedrate {
            return self.feed_caps(ahead, joints, &smear);
        }
        let (fastest, reach, hardest) = (self.run.fastest(), self.run.reach(), self.run.hardest());
        let mut caps = std::mem::take(&mut self.run.caps);
        // A weave is damped, which is said where it is laid; it is no error of the seam's.
        let seam = &ahead.seam();
        let (mut bends, mut corners) = (Vec::new(), Vec::new());
        for (index, (from, piece)) in self.run.placed().enumerate() {
            let length = piece.path.length().min(ahead.length() - from);
            if length <= 0.0 {
                break;
            }
            let mut bend = |s: f64, accounted: &[Vector3; 2]| {
                let jet = joints.jet(s).ok()?;
                Some(bend(&self.arm.kinematics, &jet, &self.tool.flange_from_tcp, accounted))
            };
            if let SegmentKind::Corner { corner, permitted, .. } = piece.info.kind {
                let blend = [from, from + length];
                // What lies on either side of it must be in sight; then its cap stays.
                if piece.cap.is_none() && from < to + reach {
                    let passing = Passing { route: seam, blend, corner, permitted, limits: hardest, fastest };
                    let mut greatest = |places: &mut dyn Iterator<Item = f64>| {
                        let bends = places.filter_map(|s| bend(s, &of_path(ahead, s)));
                        bends.fold(Bend::default(), Bend::greater)
                    };
                    let inside = greatest(&mut places(&piece.path, 0.0, length).map(|s| from + s));
                    let around = (0..=2 * AROUND).map(|k| f64::from(k) / f64::from(AROUND) - 1.0);
                    let mut around = around.map(|share| (from + share * reach).clamp(0.0, ahead.length()));
                    let bends = [inside, inside.greater(greatest(&mut around))];
                    corners.push((index, passing.pass(&smear, &bends, piece.info.arc)));
                }
                caps.extend(piece.cap.map(|pass| pass.cap(blend)));
                continue;
            }
            for s in places(&piece.link.path, piece.offset, piece.offset + length) {
                let place = from + s - piece.offset;
                let [[woven, _], [straight, _]] = [ahead, seam].map(|route| of_path(route, place));
                let Some(bend) = bend(place, &[woven - straight, Vector3::zeros()]) else { continue };
                caps.push(smear.cap(place, stepped(smear.speed(&bend, smear.path_error))));
                if place < to {
                    bends.push((index, place, bend, piece.limits.speed));
                }
            }
        }
        for (index, pass) in corners {
            caps.extend(self.run.pass_corner(index, pass));
        }
        caps.retain(|cap| cap.limits.speed < fastest);
        for (index, place, bend, speed) in bends {
            self.run.note_off(index, smear.error(&bend, speed.min(least(&caps, place, place))));
        }
        caps
    }

    /// Remarks on the pieces that the caps slow down before `end`.
    pub(super) fn remark_caps(
        &mut self,
        remarks: &mut Remarks,
        caps: &[Cap],
        end: f64,
    ) -> Result<(), PlanError> {
        let mut refused = None;
        for (index, (from, piece)) in self.run.placed().take_while(|(from, _)| *from < end).enumerate() {
            let to = (from + piece.path.length()).min(end);
            let speed = match self.run.acts_on {
                ActsOn::Joints => least(caps, from, to),
                // What lies next to it only reaches into it.
                ActsOn::Feedrate => least_within(caps, from, to),
            };
            if speed >= piece.limits.speed * (1.0 - SAME_SPEED) || piece.is_slowed() {
                continue;
            }
            match self.cap_text(piece, speed) {
                Ok(text) => remarks.add(index, text),
                Err(problem) => {
                    refused = Some((index, problem));
                    break;
                }
            }
        }
        refused.map_or(Ok(()), |(index, problem)| Err(self.give_up(index, problem)))
    }

    /// A slowdown on account of prefilters in words. With the arc on it may be refused.
    fn cap_text(&self, piece: &Piece<N>, speed: f64) -> Result<String, Problem> {
        let (_, unit, factor) = units(&piece.path);
        let reason = match self.run.acts_on {
            ActsOn::Joints => {
                "the prefilter would take the tool farther off the path or a corner than permitted"
            }
            ActsOn::Feedrate => {
                "a joint could pass its limits, whatever speeds the prefilter on the feedrate mixes"
            }
        };
        let text = format!(
            "slows from {:.1} to {:.1} {unit}{}: faster, {reason}",
            piece.limits.speed * factor,
            speed * factor,
            if piece.info.arc { " with the arc on" } else { "" },
        );
        if self.refuses_slowdown(piece, speed) { Err(Problem::WeldSlowdown(text)) } else { Ok(text) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use seamline::vibration::{Mode, Prefilter};

    use super::*;
    use crate::cell::FlexibleMode;

    fn smear(prefilter: Prefilter, frequencies: &[f64]) -> Smear {
        let mode = |frequency_hz: &f64| FlexibleMode { frequency_hz: *frequency_hz, damping: 0.02 };
        let modes = frequencies.iter().map(mode).collect();
        Smear::of(&Vibration::try_new(prefilter, 5e-4, modes).unwrap()).unwrap()
    }

    /// Every command comes out; at constant speed the mean distance from the middle is that of the definition, and never less.
    #[test]
    fn means_are_those_of_the_kernels() {
        for prefilter in Prefilter::ALL.into_iter().skip(1) {
            for frequencies in [&[6.34][..], &[9.0, 23.0]] {
                let smear = smear(prefilter, frequencies);
                assert!((smear.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{prefilter}");
                let mean = smear.mean_off(|cells| smear.cell() * cells as f64);
                let exact = mean_distance(prefilter, frequencies);
                let margin = 2.0 * smear.kernels as f64 * smear.cell();
                assert!((exact..exact + margin).contains(&mean), "{prefilter}: {mean} {exact}");
            }
        }
    }

    /// Of the delay from its mean, by quadrature over a fine comb of delays.
    fn mean_distance(prefilter: Prefilter, frequencies: &[f64]) -> f64 {
        const TEETH: u32 = 200;
        let mut delays = vec![(0.0, 1.0)];
        for frequency in frequencies {
            let kernel = prefilter.kernel(&Mode::try_new(TAU * frequency, 0.02).unwrap()).unwrap();
            let mut comb: Vec<(f64, f64)> =
                kernel.impulses().iter().map(|impulse| (impulse.time, impulse.weight)).collect();
            for length in kernel.rectangles() {
                let tooth = |k: u32| length * (f64::from(k) + 0.5) / f64::from(TEETH);
                let spread =
                    |(t, w): (f64, f64)| (0..TEETH).map(move |k| (t + tooth(k), w / f64::from(TEETH)));
                comb = comb.into_iter().flat_map(spread).collect();
            }
            let all = |(t, w): (f64, f64)| comb.iter().map(move |(u, x)| (t + u, w * x)).collect::<Vec<_>>();
            delays = delays.into_iter().flat_map(all).collect();
        }
        let mean: f64 = delays.iter().map(|(t, w)| t * w).sum();
        delays.iter().map(|(t, w)| (t - mean).abs() * w).sum::<f64>() * (1.0 - 1e-4)
    }
}
