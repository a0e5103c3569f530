//! A question with its number of axes fixed, and its answer.

use std::hint::black_box;

use seamline::otg::{self, Input, Order, Phase, Synchronization, Trajectory};
use serde::Serialize;

use crate::json_lines::Mistake;

/// A question of any number of axes.
pub(super) trait Problem {
    /// How many axes.
    fn axes(&self) -> usize;

    /// The answer to it.
    fn answer(&self) -> Result<Answer, Mistake>;

    /// The bare calculation.
    fn calculate(&self);
}

/// A question of N axes.
pub(super) struct Case<const N: usize> {
    pub(super) input: Input<N>,
    /// Instants to sample at, as fractions of the duration.
    pub(super) sample: Vec<f64>,
    /// Whether the answer shows each axis's pieces.
    pub(super) profiles: bool,
}

impl<const N: usize> Problem for Case<N> {
    fn axes(&self) -> usize {
        N
    }

    fn answer(&self) -> Result<Answer, Mistake> {
        let trajectory = otg::calculate(&self.input).map_err(|error| Mistake::new(error.to_string()))?;
        let duration = trajectory.duration();
        Ok(Answer {
            ok: true,
            duration,
            duration_min_per_axis: trajectory.duration_min().to_vec(),
            synchronized: trajectory.synchronized().iter().map(mode).collect(),
            samples: self
                .sample
                .iter()
                .map(|fraction| Sample::at(&trajectory, fraction * duration))
                .collect(),
            profiles: self.profiles.then(|| trajectory.profiles().iter().map(pieces).collect()),
        })
    }

    fn calculate(&self) {
        // An input without solution takes its time too.
        let _ = black_box(otg::calculate(black_box(&self.input)));
    }
}

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
