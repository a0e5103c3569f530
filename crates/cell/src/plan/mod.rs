//! Planning: everything that is decided before a motion starts.
//!
//! ```text
//! Step ─▶ Planner ─▶ goal (resolve) ─▶ Path ─▶ PathJoints (one branch) ─▶ timing ─▶ Block, Block, …
//!                              └─▶ otg (MOVJ, and the corner into the next MOVJ) ──────▶ Block, Block, …
//! ```

mod arm;
mod corner;
mod cut;
mod error;
mod feed;
mod hand_out;
mod joint_corner;
mod joint_move;
mod joint_path;
mod pass;
mod planner;
mod reach;
mod remark;
mod resolve;
mod route;
mod run;
mod smear;
mod smeared_corner;
mod speed;
mod suggest;
pub mod timing;
mod tool_path;
mod track;
mod weave;
mod workspace;

pub use arm::{Arm, CellArm, PlanningArm};
pub use error::{Place, PlanError, Problem};
pub use joint_path::{FollowError, PathJoints};
pub use planner::{Planned, Planner};
pub use route::Route;
