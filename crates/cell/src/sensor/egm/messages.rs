//! The messages of ABB's externally guided motion, as far as path correction has them: names and numbers from the published `egm.proto`
//! (sensor interface 1.1). What stands there as required is optional here, so that a missing field can be told from a zero.

use prost::Message;

/// Sent by the controller.
pub(super) const DATA: i32 = 2;
/// Sent by a sensor for path correction.
pub(super) const PATH_CORRECTION: i32 = 4;
/// The controller's part of EGM is running.
pub(super) const RUNNING: i32 = 3;

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Header {
    /// Sequence number.
    #[prost(uint32, optional, tag = "1")]
    pub(super) seqno: Option<u32>,
    /// Time of sending in ms.
    #[prost(uint32, optional, tag = "2")]
    pub(super) tm: Option<u32>,
    /// Type of message. Plain, since an enumeration would hide numbers that it does not know.
    #[prost(int32, optional, tag = "3")]
    pub(super) mtype: Option<i32>,
}

/// In mm.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Cartesian {
    #[prost(double, optional, tag = "1")]
    pub(super) x: Option<f64>,
    #[prost(double, optional, tag = "2")]
    pub(super) y: Option<f64>,
    #[prost(double, optional, tag = "3")]
    pub(super) z: Option<f64>,
}

/// The real part first.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Quaternion {
    #[prost(double, optional, tag = "1")]
    pub(super) u0: Option<f64>,
    #[prost(double, optional, tag = "2")]
    pub(super) u1: Option<f64>,
    #[prost(double, optional, tag = "3")]
    pub(super) u2: Option<f64>,
    #[prost(double, optional, tag = "4")]
    pub(super) u3: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct PathCorr {
    /// In the sensor's frame.
    #[prost(message, optional, tag = "1")]
    pub(super) pos: Option<Cartesian>,
    /// Of the measurement, in ms.
    #[prost(uint32, optional, tag = "2")]
    pub(super) age: Option<u32>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct SensorPathCorr {
    #[prost(message, optional, tag = "1")]
    pub(super) header: Option<Header>,
    #[prost(message, optional, tag = "2")]
    pub(super) path_corr: Option<PathCorr>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct PoseMessage {
    #[prost(message, optional, tag = "1")]
    pub(super) pos: Option<Cartesian>,
    #[prost(message, optional, tag = "2")]
    pub(super) orient: Option<Quaternion>,
}

/// Since 1970.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Clock {
    #[prost(uint64, optional, tag = "1")]
    pub(super) sec: Option<u64>,
    #[prost(uint64, optional, tag = "2")]
    pub(super) usec: Option<u64>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct FeedBack {
    #[prost(message, optional, tag = "2")]
    pub(super) cartesian: Option<PoseMessage>,
    #[prost(message, optional, tag = "4")]
    pub(super) time: Option<Clock>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct MciState {
    #[prost(int32, optional, tag = "1")]
    pub(super) state: Option<i32>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Robot {
    #[prost(message, optional, tag = "1")]
    pub(super) header: Option<Header>,
    #[prost(message, optional, tag = "2")]
    pub(super) feed_back: Option<FeedBack>,
    #[prost(message, optional, tag = "5")]
    pub(super) mci_state: Option<MciState>,
}
