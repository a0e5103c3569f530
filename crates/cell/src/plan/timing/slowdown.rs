//! Where the motion is slower than programmed, and why.

use super::assemble::Task;
use super::motion::{Order, PathState, Slowdown, TimingPiece};
use super::plain::{Hold, Plain};
use super::{JointJet, JointPath, TimingError, TimingLimits};

/// Share of the programmed speed below which the motion counts as slowed down.
const HELD: f64 = 0.99;
/// Looks per piece.
const LOOKS: usize = 4;

/// The slowdowns of a motion: where the plain motion would cruise, cruise by cruise.
pub(super) fn slowdowns<const N: usize, P: JointPath<N>>(
    task: &mut Task<'_, N, P>,
    plain: &Plain,
    pieces: &[TimingPiece],
) -> Result<Vec<Slowdown>, TimingError<P::Error>> {
    let mut found = Vec::new();
    let mut open: Option<(Slowdown, Cause)> = None;
    let mut cruises = plain.holds.iter().filter(|hold| hold.to > hold.from).copied().peekable();
    // A slowdown reaches from the last look before it to the first after it.
    let mut before = 0.0;
    let close = |open: &mut Option<(Slowdown, Cause)>, place: f64| {
        open.take().map(|(slowdown, cause)| closed(slowdown, place, &cause))
    };
    for look in 0..pieces.len() * LOOKS {
        let piece = &pieces[look / LOOKS];
        let state = piece.at(piece.duration * (look % LOOKS) as f64 / LOOKS as f64);
        let place = state.position;
        while let Some(cruise) = cruises.next_if(|cruise| cruise.end() < place) {
            found.extend(close(&mut open, cruise.end()));
        }
        let Some(cruise) = cruises.peek().filter(|cruise| cruise.place <= place) else { continue };
        if state.velocity >= HELD * cruise.speed {
            found.extend(close(&mut open, place));
            before = place;
            continue;
        }
        let jet = task.path.jet(place).map_err(|error| TimingError::Path { position: place, error })?;
        let cause = Cause::at(&jet, task.joints);
        match &mut open {
            None => open = Some((Slowdown::begun(cruise, before, &state), cause)),
            Some((slowdown, worst)) => {
                if state.velocity < slowdown.speed {
                    (slowdown.place, slowdown.speed) = (place, state.velocity);
                }
                worst.tighten(&cause);
            }
        }
    }
    if let Some(cruise) = cruises.next() {
        found.extend(close(&mut open, cruise.end()));
    }
    Ok(found)
}

impl Slowdown {
    /// What is known of a slowdown at its first look.
    fn begun(cruise: &Hold, before: f64, state: &PathState) -> Self {
        Self {
            from: before.max(cruise.place),
            to: state.position,
            place: state.position,
            speed: state.velocity,
            sustainable: cruise.speed,
            joint: 0,
            order: Order::Acceleration,
        }
    }
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
