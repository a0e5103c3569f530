//! Joint motion from finite differences of the recorded commands, against the joints' limits.

use seamline::kinematics::JointKind;
use serde::Serialize;

use crate::record::info::JointInfo;
use crate::record::sample::{MAX_JOINTS, Sample};
use crate::robot::JointUnit;

/// Orders of derivative that are looked at: velocity, acceleration, jerk.
pub(super) const ORDERS: usize = 3;

/// Backward differences of the commanded joints, up to the third order.
#[derive(Debug, Clone)]
pub(super) struct Differences {
    period: f64,
    last_time: f64,
    /// Position, velocity and acceleration as of the last sample; the first `known` of them hold.
    last: [[f64; MAX_JOINTS]; ORDERS],
    known: usize,
}

/// The derivatives that one sample brings: [velocity, acceleration, jerk], of which the first `orders` hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Derivatives {
    pub(super) orders: usize,
    pub(super) values: [[f64; MAX_JOINTS]; ORDERS],
}

impl Differences {
    pub(super) fn new(period: f64) -> Self {
        Self { period, last_time: f64::NAN, last: [[0.0; MAX_JOINTS]; ORDERS], known: 0 }
    }

    /// Takes the next sample. After a gap in time the differences start anew.
    pub(super) fn push(&mut self, sample: &Sample) -> Derivatives {
        if !follows(self.last_time, sample.time, self.period) {
            self.known = 0;
        }
        let rate = 1.0 / self.period;
        let mut level = sample.command;
        let mut values = [[0.0; MAX_JOINTS]; ORDERS];
        for (value, last) in values.iter_mut().zip(&mut self.last).take(self.known) {
            for joint in 0..MAX_JOINTS {
                value[joint] = (level[joint] - last[joint]) * rate;
            }
            *last = level;
            level = *value;
        }
        let orders = self.known;
        if self.known < ORDERS {
            self.last[self.known] = level;
            self.known += 1;
        }
        self.last_time = sample.time;
        Derivatives { orders, values }
    }
}

/// One sample is the next cycle after another.
pub(super) fn follows(before: f64, after: f64, period: f64) -> bool {
    (after - before - period).abs() < 0.5 * period
}

/// When a difference of the given order, complete at `time`, was in effect: at the middle of the samples it is made of.
pub(super) fn middle(time: f64, order: usize, period: f64) -> f64 {
    time - 0.5 * order as f64 * period
}

/// The greatest of a joint's derivative.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Peak {
    /// Magnitude as a fraction of the limit.
    pub fraction: f64,
    /// When, in seconds.
    pub time_s: f64,
    /// Line of the job under way.
    pub line: u32,
}

/// One joint's motion over the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointFigures {
    /// Name of the joint.
    pub name: String,
    /// Where it was, and how far off.
    #[serde(flatten)]
    pub travel: Travel,
    /// How much of the range is used: 0 at its middle, 1 at either limit.
    pub position: f64,
    /// Greatest velocity.
    pub velocity: Peak,
    /// Greatest acceleration.
    pub acceleration: Peak,
    /// Greatest jerk.
    pub jerk: Peak,
}

/// Least and greatest commanded position, and the greatest distance between command and measurement, in the unit of the joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
#[allow(missing_docs, reason = "the names say it, and they are those of `summary.json`")]
pub enum Travel {
    /// Of a joint that turns.
    Turning { position_min_deg: f64, position_max_deg: f64, following_error_max_deg: f64 },
    /// Of a joint that slides.
    Sliding { position_min_mm: f64, position_max_mm: f64, following_error_max_mm: f64 },
}

impl Travel {
    fn new(kind: JointKind, [low, high]: [f64; 2], following: f64) -> Self {
        let [low, high, off] = [low, high, following].map(|si| si * JointUnit::of(kind).per_si);
        match kind {
            JointKind::Revolute => {
                Self::Turning { position_min_deg: low, position_max_deg: high, following_error_max_deg: off }
            }
            JointKind::Prismatic => {
                Self::Sliding { position_min_mm: low, position_max_mm: high, following_error_max_mm: off }
            }
        }
    }
}

/// Collects the figures of all joints.
#[derive(Debug, Clone)]
pub(super) struct JointWatch {
    joints: Vec<JointInfo>,
    period: f64,
    range: [[f64; 2]; MAX_JOINTS],
    following: [f64; MAX_JOINTS],
    /// Greatest magnitudes, with time and line, for each order and joint.
    peaks: [[(f64, f64, u32); MAX_JOINTS]; ORDERS],
}

impl JointWatch {
    pub(super) fn new(joints: &[JointInfo], period: f64) -> Self {
        Self {
            joints: joints.iter().take(MAX_JOINTS).cloned().collect(),
            period,
            range: [[f64::INFINITY, f64::NEG_INFINITY]; MAX_JOINTS],
            following: [0.0; MAX_JOINTS],
            peaks: [[(0.0, 0.0, 0); MAX_JOINTS]; ORDERS],
        }
    }

    pub(super) fn push(&mut self, sample: &Sample, derivatives: &Derivatives) {
        for joint in 0..self.joints.len() {
            let position = sample.command[joint];
            let [low, high] = &mut self.range[joint];
            *low = low.min(position);
            *high = high.max(position);
            self.following[joint] = self.following[joint].max((position - sample.measured[joint]).abs());
        }
        for order in 0..derivatives.orders {
            let time = middle(sample.time, order + 1, self.period);
            for joint in 0..self.joints.len() {
                let magnitude = derivatives.values[order][joint].abs();
                if magnitude > self.peaks[order][joint].0 {
                    self.peaks[order][joint] = (magnitude, time, sample.line);
                }
            }
        }
    }

    pub(super) fn finish(self) -> Vec<JointFigures> {
        let figures = |(index, joint): (usize, &JointInfo)| {
            let limits = [joint.velocity, joint.acceleration, joint.jerk];
            let peak = |order: usize| {
                let (magnitude, time_s, line) = self.peaks[order][index];
                Peak { fraction: magnitude / limits[order], time_s, line }
            };
            let [low, high] = self.range[index];
            let [least, greatest] = joint.position;
            let (middle, half) = (0.5 * (least + greatest), 0.5 * (greatest - least));
            JointFigures {
                name: joint.name.clone(),
                travel: Travel::new(joint.kind, self.range[index], self.following[index]),
                position: (low - middle).abs().max((high - middle).abs()) / half,
                velocity: peak(0),
                acceleration: peak(1),
                jerk: peak(2),
            }
        };
        self.joints.iter().enumerate().map(figures).collect()
    }
}
