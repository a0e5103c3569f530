//! Where the motion is slower than programmed, and why.

use super::assemble::Task;
use super::motion::{Order, Slowdown, TimingPiece};
use super::s_curve::SCurve;
use super::{JointJet, JointPath, TimingError, TimingLimits};

/// Share of the programmed speed below which the motion counts as slowed down.
const HELD: f64 = 0.99;
/// Looks per piece.
const LOOKS: usize = 4;

/// The slowdowns of a motion, between the plain motion's ramps.
pub(super) fn slowdowns<const N: usize, P: JointPath<N>>(
    task: &mut Task<'_, N, P>,
    curve: &SCurve,
    pieces: &[TimingPiece],
) -> Result<Vec<Slowdown>, TimingError<P::Error>> {
    let mut found = Vec::new();
    let mut open: Option<(Slowdown, Cause)> = None;
    let (first, last) = (curve.ramp(), curve.length - curve.ramp());
    // A slowdown reaches from the last look before it to the first after it.
    let mut before = first;
    for look in 0..pieces.len() * LOOKS {
        let piece = &pieces[look / LOOKS];
        let state = piece.at(piece.duration * (look % LOOKS) as f64 / LOOKS as f64);
        let place = state.position;
        if !(first..=last).contains(&place) {
            continue;
        }
        if state.velocity >= HELD * curve.speed {
            found.extend(open.take().map(|(slowdown, cause)| closed(slowdown, place, &cause)));
            before = place;
            continue;
        }
        let jet = task.path.jet(place).map_err(|error| TimingError::Path { position: place, error })?;
        let cause = Cause::at(&jet, task.joints);
        match &mut open {
            None => {
                let slowdown = Slowdown {
                    from: before,
                    to: place,
                    place,
                    speed: state.velocity,
                    sustainable: curve.speed,
                    joint: 0,
                    order: Order::Acceleration,
                };
                open = Some((slowdown, cause));
            }
            Some((slowdown, worst)) => {
                if state.velocity < slowdown.speed {
                    (slowdown.place, slowdown.speed) = (place, state.velocity);
                }
                worst.tighten(&cause);
            }
        }
    }
    found.extend(open.take().map(|(slowdown, cause)| closed(slowdown, last, &cause)));
    Ok(found)
}

/// What the joints allow at a place, or at the tightest of several.
struct Cause {
    /// Highest constant speed, with the joint and the order of its limit.
    speed: (f64, usize, Order),
    /// Highest acceleration along the path, with the joint.
    acceleration: (f64, usize),
}

impl Cause {
    fn at<const N: usize>(jet: &JointJet<N>, joints: &TimingLimits<N>) -> Self {
        let mut cause = Self { speed: (f64::INFINITY, 0, Order::Velocity), acceleration: (f64::INFINITY, 0) };
        for i in 0..N {
            let velocity = joints.velocity[i] / jet.velocity[i].abs();
            let acceleration = (joints.acceleration[i] / jet.acceleration[i].abs()).sqrt();
            let jerk = (joints.jerk[i] / jet.jerk[i].abs()).cbrt();
            cause.tighten(&Self {
                speed: (velocity, i, Order::Velocity),
                acceleration: (joints.acceleration[i] / jet.velocity[i].abs(), i),
            });
            cause.tighten(&Self { speed: (acceleration, i, Order::Acceleration), ..cause });
            cause.tighten(&Self { speed: (jerk, i, Order::Jerk), ..cause });
        }
        cause
    }

    fn tighten(&mut self, other: &Self) {
        if other.speed.0 < self.speed.0 {
            self.speed = other.speed;
        }
        if other.acceleration.0 < self.acceleration.0 {
            self.acceleration = other.acceleration;
        }
    }
}

/// The finished entry. Where every place would allow the programmed speed, it is gaining or losing speed that
/// the joints cannot do fast enough.
fn closed(slowdown: Slowdown, to: f64, cause: &Cause) -> Slowdown {
    let (speed, joint, order) = cause.speed;
    if speed < slowdown.sustainable {
        Slowdown { to, sustainable: speed, joint, order, ..slowdown }
    } else {
        Slowdown { to, joint: cause.acceleration.1, order: Order::Acceleration, ..slowdown }
    }
}
