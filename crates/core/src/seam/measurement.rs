//! A sensor's readings, where the sensor sits, and every reason not to believe one.

use super::Offset;
use crate::geometry::{Pose, PoseJet, Rotation, Vector3};
use crate::path::SeamFrame;

/// What a seam sensor says at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Where the seam lies along the sensor's y axis, in metres.
    pub lateral: f64,
    /// Where it lies along the sensor's z axis, in metres.
    pub height: f64,
    /// Width of the joint's gap in metres, from sensors that measure it.
    pub gap: Option<f64>,
    /// When it was measured, in seconds on the cycle's clock: time of arrival less the age that the sensor states.
    pub exposure: f64,
    /// How sure the sensor is, 0 … 1; 1 from sensors that do not say.
    pub quality: f64,
}

/// A seam sensor on the torch, and which of its readings are believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// The sensor's frame: x along the travel, a reading is the point (0, lateral, height) in it. Its origin lies ahead
    /// of the tool centre point by the look-ahead distance.
    pub tcp_from_sensor: Pose,
    /// Greatest lateral and height reading of either sign, in metres.
    pub range: Offset,
    /// Readings per second.
    pub rate: f64,
    /// Age of a reading on arrival, in seconds, as a rule.
    pub latency: f64,
    /// Greatest age that is accepted, in seconds.
    pub age_max: f64,
    /// Least quality that is accepted.
    pub quality_min: f64,
}

impl Sensor {
    /// Where a sensor sits that looks at the path `look_ahead` metres ahead while the torch is posed on it as the jet
    /// says: its axes are the path frame's. `None` where the path has no frame.
    #[must_use]
    pub fn mounting(taught: &PoseJet, look_ahead: f64) -> Option<Pose> {
        let frame = SeamFrame::of(taught)?;
        let rotation = Rotation::from_basis_unchecked(&[frame.x, frame.y, frame.z]);
        let tcp_from_base = taught.pose.rotation.inverse();
        let ahead = tcp_from_base * (frame.x * look_ahead);
        Some(Pose::from_parts(ahead.into(), tcp_from_base * rotation))
    }

    /// How far it looks ahead of the torch, in metres, measured along its own x axis.
    #[must_use]
    pub fn look_ahead(&self) -> f64 {
        (self.tcp_from_sensor.rotation * Vector3::x()).dot(&self.tcp_from_sensor.translation.vector)
    }

    /// The point of the seam that a reading shows, in the base frame.
    pub(super) fn point(&self, reading: &Reading, base_from_tcp: &Pose) -> Vector3 {
        let seen = nalgebra::Point3::new(0.0, reading.lateral, reading.height);
        (base_from_tcp * (self.tcp_from_sensor * seen)).coords
    }

    /// Whether a reading can be believed by itself.
    pub(super) fn judge(&self, reading: &Reading) -> Result<(), Rejection> {
        let Reading { lateral, height, gap, exposure, quality } = *reading;
        if !(lateral + height + gap.unwrap_or(0.0) + exposure + quality).is_finite() {
            return Err(Rejection::NotFinite);
        }
        if lateral.abs() > self.range.x || height.abs() > self.range.y {
            return Err(Rejection::OutOfRange);
        }
        if quality < self.quality_min {
            return Err(Rejection::LowQuality);
        }
        Ok(())
    }
}

/// Why a reading was dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rejection {
    /// A NaN or an infinite number in it.
    NotFinite,
    /// Beyond what the sensor can see.
    OutOfRange,
    /// The sensor itself is not sure.
    LowQuality,
    /// Exposed longer ago than is accepted, or before the cycle's poses begin.
    TooOld,
    /// Exposed later than the newest pose: a wrong clock.
    InFuture,
    /// Exposed at the same instant as one before: a duplicate.
    Repeated,
    /// Older than readings that were already judged.
    OutOfOrder,
    /// Not across from the taught path, or beyond its ends.
    OffPath,
    /// Farther from the taught path than the correction may go.
    BeyondBound,
    /// It does not fit its neighbours on either side.
    Spike,
    /// Farther aside than a seam can have gone since the last good reading.
    Jump,
    /// On a tack weld.
    Tack,
}

impl Rejection {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::NotFinite,
        Self::OutOfRange,
        Self::LowQuality,
        Self::TooOld,
        Self::InFuture,
        Self::Repeated,
        Self::OutOfOrder,
        Self::OffPath,
        Self::BeyondBound,
        Self::Spike,
        Self::Jump,
        Self::Tack,
    ];

    /// In field words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NotFinite => "not a number",
            Self::OutOfRange => "out of the sensor's range",
            Self::LowQuality => "low quality",
            Self::TooOld => "too old",
            Self::InFuture => "from the future",
            Self::Repeated => "repeated",
            Self::OutOfOrder => "out of order",
            Self::OffPath => "off the path",
            Self::BeyondBound => "beyond the bound",
            Self::Spike => "spike",
            Self::Jump => "jumped aside",
            Self::Tack => "tack weld",
        }
    }
}

/// How many readings came, and what became of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// All that were handed over.
    pub taken: u64,
    dropped: [u64; Rejection::ALL.len()],
}

impl Counts {
    /// Readings dropped for a reason.
    #[must_use]
    pub fn of(&self, rejection: Rejection) -> u64 {
        self.dropped[rejection as usize]
    }

    /// Readings dropped for any reason.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.iter().sum()
    }

    pub(super) fn count(&mut self, rejection: Rejection) {
        self.dropped[rejection as usize] += 1;
    }
}
