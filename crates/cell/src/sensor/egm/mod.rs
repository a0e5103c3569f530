//! Seam readings over UDP: ABB's externally guided motion (EGM), path correction.
//!
//! | module | holds |
//! |---|---|
//! | `messages` | the protobuf messages |
//! | `gate` | which datagrams are believed |
//! | `link` | the thread between the socket and the cycle |

mod gate;
mod link;
mod messages;

pub use gate::{Correction, DropReason, EgmGate};
pub use link::{EgmCounts, EgmSensor, EgmSettings};
