//! The answer to a question: a trajectory in numbers.

use seamline::otg::{self, Order, Phase, Synchronization, Trajectory};
use serde::Serialize;

use super::request::Request;
use crate::json_lines::Mistake;

/// A trajectory in numbers.
#[derive(Serialize)]
pub(super) struct Answer {
    ok: bool,
    duration: f64,
    duration_min_per_axis: Vec<f64>,
    synchronized: Vec<&'static str>,
    samples: Vec<Sample>,
    #[serde(skip_serializing_if = "Option::is_none")]
    profiles: Option<Vec<Vec<Piece>>>,
}

impl Answer {
    /// Refuses numbers that overflow, which JSON does not have.
    pub(super) fn of<const N: usize>(
        trajectory: &Trajectory<N>,
        request: &Request<N>,
    ) -> Result<Self, Mistake> {
        let duration = trajectory.duration();
        let at = |fraction| Sample::at(trajectory, fraction * duration);
        let answer = Self {
            ok: true,
            duration,
            duration_min_per_axis: trajectory.duration_min().to_vec(),
            synchronized: trajectory.synchronized().iter().map(mode).collect(),
            samples: request.sample.iter().map(at).collect(),
            profiles: request.profiles.then(|| trajectory.profiles().iter().map(pieces).collect()),
        };
        if answer.is_finite() { Ok(answer) } else { Err(Mistake::new(OUT_OF_RANGE)) }
    }

    fn is_finite(&self) -> bool {
        let durations = self.duration_min_per_axis.iter().chain([&self.duration]);
        let samples = self.samples.iter().flat_map(|s| [&s.position, &s.velocity, &s.acceleration]);
        let pieces = self.profiles.iter().flatten().flatten();
        durations.chain(samples.flatten()).all(|number| number.is_finite())
            && pieces.into_iter().all(Piece::is_finite)
    }
}

const OUT_OF_RANGE: &str = "the solution is beyond the range of 64-bit floats";

#[derive(Serialize)]
struct Sample {
    time: f64,
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Sample {
    fn at<const N: usize>(trajectory: &Trajectory<N>, time: f64) -> Self {
        let otg::Sample { position, velocity, acceleration, .. } = trajectory.at_time(time);
        Self {
            time,
            position: position.to_vec(),
            velocity: velocity.to_vec(),
            acceleration: acceleration.to_vec(),
        }
    }
}

/// A piece of motion at a constant value of the derivative that may jump.
#[derive(Serialize)]
#[serde(untagged)]
enum Piece {
    First { duration: f64, velocity: f64 },
    Second { duration: f64, acceleration: f64 },
    Third { duration: f64, jerk: f64 },
}

impl Piece {
    fn is_finite(&self) -> bool {
        let (Self::First { duration, velocity: control }
        | Self::Second { duration, acceleration: control }
        | Self::Third { duration, jerk: control }) = self;
        duration.is_finite() && control.is_finite()
    }
}

fn pieces(profile: &otg::Profile) -> Vec<Piece> {
    let piece = |&Phase { duration, velocity, acceleration, jerk, .. }: &Phase| match profile.order() {
        Order::First => Piece::First { duration, velocity },
        Order::Second => Piece::Second { duration, acceleration },
        Order::Third => Piece::Third { duration, jerk },
    };
    profile.phases().iter().map(piece).collect()
}

fn mode(mode: &Synchronization) -> &'static str {
    match mode {
        Synchronization::None => "none",
        Synchronization::Time | Synchronization::TimeIfNecessary => "time",
        Synchronization::Phase | Synchronization::PhaseStrict => "phase",
    }
}
