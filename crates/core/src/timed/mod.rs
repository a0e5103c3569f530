//! Motion of third order in a given time: seven phases of constant jerk, chosen by one number.
//!
//! The profile is that of X. Yang and S. Wang (*Design of third-order uniform acceleration and deceleration trajectory
//! based on Simulink StateFlow*). It is given by start S, target G, duration T and time-scale factor n, 0 < n ≤ 1/2, and
//! nothing else:
//!
//! ```text
//! V = (G − S) / (T (1 − n))      A = V / (T (n − n²))      J = A / (T n²)                 (4) (5) (6)
//! jerk  +J until n²T, 0 until (n − n²)T, −J until nT, 0 until (1 − n)T,
//!       −J until (1 − n + n²)T, 0 until (1 − n²)T, +J until T
//! ```
//!
//! A small n is a short, hard ramp and a long cruise; n = 1/2 has neither constant acceleration nor cruise. The paper's
//! equation (11) lacks the factor A on its last term; its equations (1) to (3) are one cubic and its derivatives.
//!
//! | room | holds |
//! |---|---|
//! | `shape` | the profile of displacement 1 in the time 1 |
//! | `profile` | [`TimedProfile`]: the profile itself |
//! | `activity` | the paper's state chart as a table: start, moving, holding |
//! | `takeover` | what a new target does to an axis in motion |
//! | `motion` | [`TimedMotion`]: the state chart at work |
//! | `error` | why there is no such motion |
//!
//! All axes share T and n, so that a profile of several axes is a straight line. Units: any of length or angle, as long
//! as all of one axis agree; seconds.

mod activity;
mod error;
mod motion;
mod profile;
mod shape;
mod takeover;

pub use activity::{Activity, Event};
pub use error::{Error, Quantity};
pub use motion::{Command, Planned, TimedMotion};
pub use profile::TimedProfile;
pub(crate) use shape::Shape;
pub use takeover::Takeover;
