//! Which datagrams are believed.

use prost::Message;

use super::messages::{PATH_CORRECTION, SensorPathCorr};

/// Longest datagram that is looked at, in bytes: a path correction has about 60.
pub(super) const LENGTH_MAX: usize = 512;
/// Seconds without an accepted datagram after which a client may begin to count anew.
const SESSION: f64 = 1.0;

/// What a believed datagram says. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correction {
    /// Sequence number.
    pub number: u32,
    /// Along the sensor's y axis.
    pub lateral: f64,
    /// Along its z axis.
    pub height: f64,
    /// Of the measurement, when it was sent.
    pub age: f64,
}

/// Why a datagram was dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DropReason {
    /// From another address than the client's.
    Foreign,
    /// Too long, no protobuf, or without one of the fields that it must have.
    Malformed,
    /// Another message than a path correction.
    OtherType,
    /// A NaN or an infinite number in it.
    NotFinite,
    /// Measured longer ago than is accepted.
    Stale,
    /// A sequence number that is not above the last one's.
    Replayed,
    /// The cycle did not fetch the ones before.
    RingFull,
}

impl DropReason {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Foreign,
        Self::Malformed,
        Self::OtherType,
        Self::NotFinite,
        Self::Stale,
        Self::Replayed,
        Self::RingFull,
    ];

    /// In field words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Foreign => "from elsewhere",
            Self::Malformed => "malformed",
            Self::OtherType => "no path correction",
            Self::NotFinite => "not a number",
            Self::Stale => "too old",
            Self::Replayed => "repeated or out of order",
            Self::RingFull => "not fetched in time",
        }
    }
}

/// The judge of one client's datagrams. It knows no clock and no socket.
///
/// Sequence numbers rise within a session; gaps are datagrams that were lost. After a second without an accepted datagram a new session
/// begins, so that a client may start again, and a forged number cannot lock it out for longer.
#[derive(Debug, Clone)]
pub struct EgmGate {
    age_max: f64,
    /// Number and time of the last datagram that was accepted.
    last: Option<(u32, f64)>,
}

impl EgmGate {
    /// Accepts measurements up to an age in seconds.
    #[must_use]
    pub fn new(age_max: f64) -> Self {
        Self { age_max, last: None }
    }

    /// Judges a datagram that arrived at `time`, in seconds on any clock that does not go back.
    ///
    /// # Errors
    /// Why it is dropped.
    pub fn judge(&mut self, datagram: &[u8], time: f64) -> Result<Correction, DropReason> {
        let correction = decode(datagram)?;
        if correction.age > self.age_max {
            return Err(DropReason::Stale);
        }
        let replayed =
            |(number, accepted): (u32, f64)| correction.number <= number && time - accepted <= SESSION;
        if self.last.is_some_and(replayed) {
            return Err(DropReason::Replayed);
        }
        self.last = Some((correction.number, time));
        Ok(correction)
    }
}

fn decode(datagram: &[u8]) -> Result<Correction, DropReason> {
    if datagram.len() > LENGTH_MAX {
        return Err(DropReason::Malformed);
    }
    let message = SensorPathCorr::decode(datagram).map_err(|_| DropReason::Malformed)?;
    let header = message.header.ok_or(DropReason::Malformed)?;
    if header.mtype != Some(PATH_CORRECTION) {
        return Err(DropReason::OtherType);
    }
    let fields = || {
        let correction = message.path_corr?;
        let position = correction.pos?;
        Some((header.seqno?, [position.x?, position.y?, position.z?], correction.age?))
    };
    let (number, position, age_ms) = fields().ok_or(DropReason::Malformed)?;
    if !position.iter().all(|x| x.is_finite()) {
        return Err(DropReason::NotFinite);
    }
    let [_, lateral, height] = position.map(|millimetres| millimetres * 1e-3);
    Ok(Correction { number, lateral, height, age: f64::from(age_ms) * 1e-3 })
}
