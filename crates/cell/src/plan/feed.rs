//! Limits along the path under prefilters on the feedrate.
//!
//! What comes out of the prefilters is a mean of the path coordinate s over the kernels' length L, so the tool is at a place s̄ with a mean of
//! the velocities ṡ, accelerations and jerks that the program had on the way around it. The joints there have
//!
//! ```text
//! q̇ = q′ṡ        q̈ = q″ṡ² + q′s̈        q⃛ = q‴ṡ³ + 3q″ṡs̈ + q′s⃛
//! ```
//!
//! with q′, q″ and q‴ of s̄ and the means of the others. So each place grants a speed, an acceleration and a jerk along the path, whatever
//! their sequence, and these hold as far as the program may be from the tool. With D the kernels' delay and v the speed granted, that is from
//! v (L − D) before the place to v D behind it; `docs/vibration.md` has the derivation. Neither a pause nor override changes anything about
//! that, if a change of the rate keeps the same limits along the path.

use seamline::control::{ActsOn, Command, RAIL_MOVES};
use seamline::kinematics::JointJet;
use seamline::path::Path;

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::joint_path::PathJoints;
use super::planner::{Planned, Planner};
use super::route::Route;
use super::run::Piece;
use super::smear::{Cap, Smear, places};
use super::timing::{JointPath as _, PathLimits, TimingLimits};

/// Of what a joint can: for the path's curvature in it, where the rest is for a change of the speed.
const CURVATURE_SHARE: f64 = 0.5;
/// Of a joint's jerk: for each of the terms that hang on the path's curvature and torsion.
const JERK_SHARE: f64 = 1.0 / 3.0;
/// What the joints may ask for between two places that are looked at, beyond the greater of both.
const BETWEEN: f64 = 1.03;
/// Between two places it is looked closer, this often by halves, where the middle asks for so many times more than both, or one for so many
/// times more than the other. Joints that ask for less than this share of another one do not matter for that.
const HALVINGS: u32 = 6;
const RISE: f64 = 1.02;
const STEEP: f64 = 1.5;
const NEGLIGIBLE: f64 = 0.1;
/// Places in each period of a weave that are looked at.
const LOOKS_A_PERIOD: f64 = 12.0;
/// Speeds, and accelerations and jerks, are rounded down to powers of these, so that they do not change from place to place.
const STEPS: [f64; 2] = [1.02, 1.1];
const STEPS_OF_CORNER: [f64; 2] = [1.2, 1.5];

/// The greatest derivatives of the joints along a path.
#[derive(Debug, Clone, Copy)]
struct Demand<const N: usize>([[f64; N]; 3]);

impl<const N: usize> Demand<N> {
    fn of(jet: &JointJet<N>) -> Self {
        Self([jet.velocity, jet.acceleration, jet.jerk].map(|order| order.map(|of| BETWEEN * of.abs())))
    }

    fn greater(&self, other: &Self) -> Self {
        let mut greater = *self;
        for (order, others) in greater.0.iter_mut().zip(&other.0) {
            for (of, other) in order.iter_mut().zip(others) {
                *of = of.max(*other);
            }
        }
        greater
    }

    /// A joint asks for so many times as much, of what is worth it.
    fn exceeds(&self, other: &Self, times: f64) -> bool {
        self.0.iter().zip(&other.0).any(|(order, others)| {
            let most = others.iter().fold(0.0_f64, |most, of| most.max(*of));
            order.iter().zip(others).any(|(of, other)| *of > times * other.max(NEGLIGIBLE * most))
        })
    }

    /// What the joints grant along the path, up to what the path grants.
    fn granted(&self, joints: &TimingLimits<N>, path: &PathLimits, steps: [f64; 2]) -> PathLimits {
        let Self([first, second, third]) = self;
        let mut granted = *path;
        for joint in 0..N {
            let [velocity, acceleration, jerk] =
                [joints.velocity[joint], joints.acceleration[joint], joints.jerk[joint]];
            let speed = (velocity / first[joint])
                .min((CURVATURE_SHARE * acceleration / second[joint]).sqrt())
                .min((JERK_SHARE * jerk / third[joint]).cbrt());
            granted.speed = granted.speed.min(speed);
        }
        granted.speed = stepped(granted.speed, path.speed, steps[0]);
        let v = granted.speed;
        for joint in 0..N {
            let [acceleration, jerk] = [joints.acceleration[joint], joints.jerk[joint]];
            let along = ((acceleration - second[joint] * v * v) / first[joint])
                .min(JERK_SHARE * jerk / (3.0 * second[joint] * v));
            granted.acceleration = granted.acceleration.min(along);
        }
        granted.acceleration = stepped(granted.acceleration, path.acceleration, steps[1]);
        let a = granted.acceleration;
        for joint in 0..N {
            let bent = third[joint] * v.powi(3) + 3.0 * second[joint] * v * a;
            granted.jerk = granted.jerk.min((joints.jerk[joint] - bent) / first[joint]);
        }
        granted.jerk = stepped(granted.jerk, path.jerk, steps[1]);
        granted
    }
}

/// The power of `step` below a limit, where that is less than `most`.
fn stepped(limit: f64, most: f64, step: f64) -> f64 {
    if limit < most { step.powf((limit.ln() / step.ln()).floor()) } else { most }
}

/// What is granted while the tool is somewhere between two places.
#[derive(Debug, Clone, Copy)]
struct Grant {
    from: f64,
    to: f64,
    limits: PathLimits,
}

impl Grant {
    /// As the program has to keep it.
    fn cap(&self, smear: &Smear) -> Cap {
        let Self { from, to, limits } = *self;
        let [before, behind] = [limits.speed * (smear.length - smear.delay), limits.speed * smear.delay];
        Cap { place: from, from: from - before, to: to + behind, limits }
    }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// The limits along the way ahead, as the program has to keep them for the tool to have them.
    pub(super) fn feed_caps(
        &mut self,
        ahead: &Route,
        joints: &mut PathJoints<'_, N, K>,
        smear: &Smear,
    ) -> Vec<Cap> {
        let mut caps = std::mem::take(&mut self.run.caps);
        for (from, piece) in self.run.placed() {
            let length = piece.path.length().min(ahead.length() - from);
            if length <= 0.0 {
                break;
            }
            caps.push(Grant { from, to: from + length, limits: piece.limits }.cap(smear));
            caps.extend(
                self.grants(piece, [from, from + length], joints).iter().map(|grant| grant.cap(smear)),
            );
        }
        caps
    }

    /// Takes note of moves handed out.
    ///
    /// # Errors
    /// [`Problem::ShortMoves`] where more of them lie within the kernels' length than the cycle remembers.
    pub(super) fn remember(&mut self, parts: &[Planned<N>]) -> Result<(), PlanError> {
        let Some(smear) = self.run.smear.filter(|_| self.run.acts_on == ActsOn::Feedrate) else {
            return Ok(());
        };
        for part in parts {
            for command in &part.commands {
                let Command::Move(block) = command else { continue };
                if block.starts_at_rest {
                    self.run.laid.clear();
                }
                self.run.laid.push_back(block.duration());
                if self.run.laid.len() > RAIL_MOVES {
                    self.run.laid.pop_front();
                    // The tool may still be on the move before the oldest of these.
                    if self.run.laid.iter().sum::<f64>() < smear.length {
                        let problem = Problem::ShortMoves { most: RAIL_MOVES, seconds: smear.length };
                        return Err(PlanError { at: part.at.clone(), problem });
                    }
                }
            }
        }
        Ok(())
    }

    /// What the joints grant on a piece between two places of the run, where that is less than its own limits.
    fn grants(
        &self,
        piece: &Piece<N>,
        [from, to]: [f64; 2],
        joints: &mut PathJoints<'_, N, K>,
    ) -> Vec<Grant> {
        let limits = self.timing_limits();
        let (path, offset, steps) = if piece.is_corner() {
            (&piece.path, 0.0, STEPS_OF_CORNER)
        } else {
            (&piece.link.path, piece.offset, STEPS)
        };
        let inside = looks(path, &piece.path, [offset, offset + to - from]);
        let inside = inside.into_iter().map(|s| from + s - offset);
        let mut grants: Vec<Grant> = Vec::new();
        let mut last: Option<(f64, Demand<N>)> = None;
        let mut demand = |place: f64| joints.jet(place).ok().map(|jet| Demand::of(&jet));
        for place in [from].into_iter().chain(inside).chain([to]) {
            let Some(here) = demand(place) else { continue };
            if let Some((before, there)) = last {
                let most = greatest(&mut demand, (before, there), (place, here), HALVINGS);
                let granted = most.granted(&limits, &piece.limits, steps);
                match grants.last_mut() {
                    Some(grant) if grant.limits == granted => grant.to = place,
                    // A weave is the same all along.
                    Some(grant) if piece.path.is_woven() => {
                        (grant.to, grant.limits) = (place, grant.limits.and(&granted));
                    }
                    _ => grants.push(Grant { from: before, to: place, limits: granted }),
                }
            }
            last = Some((place, here));
        }
        grants.retain(|grant| grant.limits != piece.limits);
        grants
    }
}

/// The places of a move's path that are looked at, between two coordinates; of a weave some in each period.
fn looks(whole: &Path, path: &Path, [from, to]: [f64; 2]) -> Vec<f64> {
    let Some(weave) = path.weave() else { return places(whole, from, to).collect() };
    let step = weave.shape().wavelength / LOOKS_A_PERIOD;
    let between = (from / step).ceil() as u64..=(to / step).floor() as u64;
    between.map(|k| step * k as f64).collect()
}

/// The greatest demand between two places: halved as long as the middle asks for clearly more than both ends, or they differ much.
fn greatest<const N: usize>(
    demand: &mut impl FnMut(f64) -> Option<Demand<N>>,
    (from, first): (f64, Demand<N>),
    (to, last): (f64, Demand<N>),
    halvings: u32,
) -> Demand<N> {
    let ends = first.greater(&last);
    let middle = 0.5 * (from + to);
    let Some(inside) = demand(middle) else { return ends };
    if halvings == 0
        || !inside.exceeds(&ends, RISE) && !first.exceeds(&last, STEEP) && !last.exceeds(&first, STEEP)
    {
        return ends.greater(&inside);
    }
    let left = greatest(demand, (from, first), (middle, inside), halvings - 1);
    left.greater(&greatest(demand, (middle, inside), (to, last), halvings - 1))
}
