//! G-code: programs as CAM writes them (RS-274 as LinuxCNC reads it), walked line by line into the same steps as INFORM jobs.
//!
//! ```text
//! bytes ─▶ lexer ─▶ Program (blocks of words) ─▶ Interpreter (modal state) ─▶ Contour (chords to curves) ─▶ Step
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`Program`] | a file as it stands: nothing is lost; what is wrong with a line by itself |
//! | `codes` | what a run does with each code: executed, accepted, refused |
//! | [`Interpreter`] | the program, one [`Step`](crate::job::Step) at a time |
//! | `arc` | arcs, spirals and helices |
//! | `contour` | rows of short lines as smooth curves within the tolerance |
//!
//! Units are those of the machine, mm and mm/s, from the first reading of a word on: inches end in the interpreter.
//!
//! G54 to G59 are the cell's user frames 1 to 6. The tool is the cell's tool 0, its z axis against the frame's: it points
//! down on the work. Which subset is executed, and what becomes of the rest, stands in docs/gcode.md.

mod arc;
mod codes;
mod contour;
mod interpreter;
mod lexer;
mod moves;
mod program;

pub use interpreter::{Interpreter, Setup};
pub use program::Program;
