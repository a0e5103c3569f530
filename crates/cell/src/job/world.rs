//! What a job asks of the world around it.

use super::expression::SignalKind;
use super::position::{Frame, JobPosition};
use super::step::{ArcCondition, Speed};

/// The cell as a job sees it.
///
/// A program runs ahead of the robot: the interpreter is asked for the next step while earlier moves may still
/// be under way. A world that wants inputs read at the instant of the motion asks for the next step only when the
/// robot has arrived.
pub trait World {
    /// The value of a signal: 0 or 1, or a group's bits. Outputs that the job itself set are not asked for.
    fn input(&mut self, kind: SignalKind, number: u32) -> u32;

    /// The robot's position at this point of the program, in pulses. `None` where there is none to give.
    fn current_position(&mut self) -> Option<JobPosition>;

    /// The position in another frame and with another tool, in rectangular form. `None` where it cannot be had.
    fn convert(&mut self, position: &JobPosition, frame: Frame, tool: u32) -> Option<JobPosition>;

    /// The speed in mm/s that an arc condition of the cell asks for. `None` where it has none.
    fn arc_speed_mm_s(&mut self, condition: &ArcCondition) -> Option<f64>;

    /// The speed of a move that no rule of the job gives one: of a joint move, or of one along a path. `None` where such
    /// a move is a mistake.
    fn default_speed(&mut self, _joint: bool) -> Option<Speed> {
        None
    }
}
