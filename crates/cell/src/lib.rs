//! Jobs, cells, planning and simulation around the motion core.
//!
//! | module | holds |
//! |---|---|
//! | [`cell`] | the cell file: robot, limits, tools, conditions, simulation |
//! | [`experiment`] | the SCARA experiment: a flexible tool on a path with corners |
//! | [`gcode`] | G-code programs: reader, interpreter, contours |
//! | [`identify`] | flexible modes from a measured vibration |
//! | [`job`] | INFORM job files: reader, checks, interpreter |
//! | [`plan`] | from steps to blocks; the speed along a path that keeps every joint limit |
//! | [`record`] | what a run leaves behind: recording, figures, data for plots |
//! | [`run`] | one job in one cell: check, run, real time |
//! | [`robot`] | arms whose number of joints is known only at run time: built in, from a cell file, from URDF |
//! | [`sensor`] | seam sensors: replay of a recording, simulated laser, EGM over UDP |
//! | [`sim`] | simulated servo drives and power source |

pub mod cell;
pub mod experiment;
pub mod gcode;
pub mod identify;
pub mod job;
mod least;
pub mod plan;
pub mod record;
pub mod robot;
pub mod run;
pub mod sensor;
pub mod sim;
