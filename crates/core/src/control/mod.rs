//! The control cycle: modes, blocks of motion, the rate of programme time, and the four tiers that make a command.
//!
//! A planner fills a queue with [`Command`]s; [`Cycle::step`] takes them from there, once per period, and answers
//! with a joint command. Time has two clocks: a block says where the arm is at each instant of *programme time* τ, and
//! the cycle chooses the rate τ̇ in [0, 1]. Override, pause and controlled stop change the rate and never the path.
//!
//! | tier | does | fault |
//! |---|---|---|
//! | 1 feedback | holds the measured joints against the drives' model, filters them | following error, drive |
//! | 2 target | lets programme time run on, within what the joints bear | queue ran empty |
//! | 3 kinematics | joints and their derivatives at that instant | no inverse |
//! | | [prefilters](CommandPrefilter), where the cell has them: the joint commands, or a feedrate, that do not make the arm ring | |
//! | 4 safety | judges the command by its differences; stops the arm instead where it would leave the envelope | limits |

mod arc;
mod block;
mod cycle;
mod feedback;
mod history;
mod instant;
mod lookahead;
mod mode;
mod off_path;
mod on_seam;
mod prefilter;
mod program;
mod rails;
mod rate;
mod resume;
mod retreat;
mod seam;
mod telemetry;
mod trail;

pub use arc::ArcRules;
pub use block::{BLOCK_PIECES, Block, Command, Motion, PathMotion, TrajectoryMotion};
pub use cycle::{Cycle, CycleConfig, CycleInput};
pub use feedback::ServoModel;
pub use mode::{Event, Mode};
pub use prefilter::{ActsOn, CommandPrefilter, CommandSignal, MODES_MAX, PrefilterEntry};
pub use program::CommandSource;
pub use rails::RAIL_MOVES;
pub use seam::{Playing, SeamStatus, TAUGHT_PATHS, Tracked, Tracking};
pub use telemetry::{CycleOutput, NoClock, STAGES, StageClock, Status};
