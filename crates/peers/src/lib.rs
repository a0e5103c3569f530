//! The peers behind one face, for comparison: what they make of an input of ours.

#[path = "../../core/tests/otg_support/mod.rs"]
pub mod otg_support;

pub mod compare;

use rsruckig::prelude as rs;
use seamline::otg::{Control, Input, Synchronization};

/// A peer's trajectory, as far as the comparison needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// In seconds.
    pub duration: f64,
    /// How far it is from the target at its end, relative to the motion's own scale: the worst of position and velocity.
    pub miss: f64,
}

/// Ruckig, C++.
pub struct Ruckig {
    calculator: ruckig::Ruckig,
    input: ruckig::InputParameter,
    trajectory: ruckig::Trajectory,
    output: ruckig::OutputParameter,
}

impl Ruckig {
    pub fn new(axes: usize) -> Self {
        Self {
            calculator: ruckig::Ruckig::new_direct(axes, 0.001),
            input: ruckig::InputParameter::new(axes),
            trajectory: ruckig::Trajectory::new_direct(axes),
            output: ruckig::OutputParameter::new_direct(axes),
        }
    }

    /// Takes over an input; its lower limits must mirror the upper ones.
    pub fn set<const N: usize>(&mut self, input: &Input<N>) {
        let to = &mut self.input;
        to.control_interface = match input.control[0] {
            Control::Position => ruckig::ControlInterface::Position,
            Control::Velocity => ruckig::ControlInterface::Velocity,
        };
        to.synchronization = match input.synchronization[0] {
            Synchronization::None => ruckig::Synchronization::None,
            Synchronization::Time => ruckig::Synchronization::Time,
            Synchronization::TimeIfNecessary => ruckig::Synchronization::TimeIfNecessary,
            Synchronization::Phase | Synchronization::PhaseStrict => ruckig::Synchronization::Phase,
        };
        to.current_position.copy_from_slice(&input.current.position);
        to.current_velocity.copy_from_slice(&input.current.velocity);
        to.current_acceleration.copy_from_slice(&input.current.acceleration);
        to.target_position.copy_from_slice(&input.target.position);
        to.target_velocity.copy_from_slice(&input.target.velocity);
        to.target_acceleration.copy_from_slice(&input.target.acceleration);
        to.max_velocity.copy_from_slice(&input.limits.velocity_max);
        to.max_acceleration.copy_from_slice(&input.limits.acceleration_max);
        to.max_jerk.copy_from_slice(&input.limits.jerk_max);
    }

    /// Calculates the input taken over last.
    pub fn run(&mut self) -> bool {
        let result = self.calculator.calculate(&mut self.input, &mut self.trajectory);
        matches!(result, ruckig::Result::Working | ruckig::Result::Finished)
    }

    /// Nanoseconds of the calculation alone, by the peer's own clock.
    pub fn timed(&mut self) -> f64 {
        self.calculator.reset();
        self.calculator.update(&mut self.input, &mut self.output);
        1000.0 * self.output.calculation_duration
    }

    pub fn duration(&self) -> f64 {
        self.trajectory.get_duration()
    }

    pub fn at_time(&self, time: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        self.trajectory.at_time(time)
    }

    pub fn calculate<const N: usize>(&mut self, input: &Input<N>) -> Option<Answer> {
        self.set(input);
        if !self.run() {
            return None;
        }
        let duration = self.duration();
        // The peer's state at a time needs a duration.
        if duration.is_nan() || duration <= 0.0 {
            return Some(Answer { duration, miss: f64::INFINITY });
        }
        let (p, v, _) = self.at_time(duration * (1.0 - 1e-15));
        Some(Answer { duration, miss: miss(input, duration, &p, &v) })
    }
}

/// Ruckig's port to Rust.
pub struct RsRuckig<const N: usize> {
    calculator: rs::Ruckig<N, rs::IgnoreErrorHandler>,
    input: rs::InputParameter<N>,
    trajectory: rs::Trajectory<N>,
}

impl<const N: usize> Default for RsRuckig<N> {
    fn default() -> Self {
        Self {
            calculator: rs::Ruckig::new(None, 0.001),
            input: rs::InputParameter::new(None),
            trajectory: rs::Trajectory::new(None),
        }
    }
}

impl<const N: usize> RsRuckig<N> {
    pub fn at_time(&self, time: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let zero = || rs::DataArrayOrVec::Stack([0.0; N]);
        let (mut p, mut v, mut a) = (zero(), zero(), zero());
        let (p_at, v_at, a_at) = (&mut Some(&mut p), &mut Some(&mut v), &mut Some(&mut a));
        self.trajectory.at_time(time, p_at, v_at, a_at, &mut None, &mut None);
        let row = |from: &rs::DataArrayOrVec<f64, N>| (0..N).map(|axis| from[axis]).collect();
        (row(&p), row(&v), row(&a))
    }

    pub fn set(&mut self, input: &Input<N>) {
        let values = |from: &[f64; N]| rs::DataArrayOrVec::Stack(*from);
        let to = &mut self.input;
        to.control_interface = match input.control[0] {
            Control::Position => rs::ControlInterface::Position,
            Control::Velocity => rs::ControlInterface::Velocity,
        };
        to.synchronization = match input.synchronization[0] {
            Synchronization::None => rs::Synchronization::None,
            Synchronization::Time => rs::Synchronization::Time,
            Synchronization::TimeIfNecessary => rs::Synchronization::TimeIfNecessary,
            Synchronization::Phase | Synchronization::PhaseStrict => rs::Synchronization::Phase,
        };
        to.current_position = values(&input.current.position);
        to.current_velocity = values(&input.current.velocity);
        to.current_acceleration = values(&input.current.acceleration);
        to.target_position = values(&input.target.position);
        to.target_velocity = values(&input.target.velocity);
        to.target_acceleration = values(&input.target.acceleration);
        to.max_velocity = values(&input.limits.velocity_max);
        to.max_acceleration = values(&input.limits.acceleration_max);
        to.max_jerk = values(&input.limits.jerk_max);
        to.min_velocity = Some(values(&input.limits.velocity_min));
        to.min_acceleration = Some(values(&input.limits.acceleration_min));
    }

    pub fn run(&mut self) -> bool {
        matches!(
            self.calculator.calculate(&self.input, &mut self.trajectory),
            Ok(rs::RuckigResult::Working | rs::RuckigResult::Finished)
        )
    }

    pub fn calculate(&mut self, input: &Input<N>) -> Option<Answer> {
        self.set(input);
        let run = std::panic::AssertUnwindSafe(|| self.run());
        if !std::panic::catch_unwind(run).unwrap_or(false) {
            return None;
        }
        let duration = self.trajectory.get_duration();
        let (p, v, _) = self.at_time(duration * (1.0 - 1e-15));
        Some(Answer { duration, miss: miss(input, duration, &p, &v) })
    }
}

/// Distance from the target, relative to the speeds and the distance that the problem has.
fn miss<const N: usize>(input: &Input<N>, duration: f64, p: &[f64], v: &[f64]) -> f64 {
    let mut worst = 0.0_f64;
    for axis in 0..N {
        let (from, to) = (&input.current, &input.target);
        let displacement = (to.position[axis] - from.position[axis]).abs();
        let speed = (displacement / duration).max(from.velocity[axis].abs()).max(to.velocity[axis].abs());
        let off = |a: f64, b: f64, scale: f64| if a == b { 0.0 } else { (a - b).abs() / scale };
        if input.control[axis] == Control::Position {
            worst = worst.max(off(p[axis], to.position[axis], speed * duration));
        }
        worst = worst.max(off(v[axis], to.velocity[axis], speed));
    }
    worst
}

/// Whether a motion keeps its limits, at 2,000 samples: the jerk by the change of the acceleration, and the velocity once it is inside.
pub fn keeps_limits<const N: usize>(
    input: &Input<N>,
    duration: f64,
    at_time: impl Fn(f64) -> (Vec<f64>, Vec<f64>, Vec<f64>),
) -> bool {
    let step = duration / 2000.0;
    let mut before = at_time(0.0).2;
    let mut inside = [false; N];
    let limits = &input.limits;
    (1..2000).all(|k| {
        let (_, v, a) = at_time(step * f64::from(k));
        let kept = (0..N).all(|i| {
            let slack = 1e-6 * (limits.velocity_max[i] - limits.velocity_min[i]);
            let now = limits.velocity_min[i] - slack <= v[i] && v[i] <= limits.velocity_max[i] + slack;
            let left = inside[i] && !now;
            inside[i] |= now;
            !left && (a[i] - before[i]).abs() <= limits.jerk_max[i] * step * (1.0 + 1e-6)
        });
        before = a;
        kept
    })
}
