//! The cell: everything about a robot and its surroundings that a job leaves open, read from a TOML file.
//!
//! A file gives only what differs from the [default cell](DEFAULT_CELL_TOML): it is laid over it key by key, and
//! arrays of tables (`[[tool]]`, `[[robot.joint]]` …) table by table, by their `number`. A file with another robot
//! than the default's brings its own joints.
//!
//! Units stand in the keys (`velocity_deg_s`); the types here are SI. Every value is checked once, when the file
//! is read: an unknown key, a wrong type, a value out of range or two that contradict each other is one
//! [`CellError`] with file, line, column, key, what was found and what was expected.

mod document;
mod error;
mod fault;
mod frames;
mod io;
mod job_rules;
mod motion;
mod nearest;
mod pass;
mod robot;
mod seam;
mod section;
mod sensor;
mod simulation;
#[cfg(test)]
mod tests;
mod vibration;
mod welding;

use std::path::Path;

pub use error::{CellError, Problem, Suggestion};
pub use fault::{FaultKind, ScriptedFault};
pub use frames::{Tool, UserFrame};
pub use io::{Io, ScriptedInput, UnmetWait, UnscriptedInput};
pub use job_rules::{JobRules, SpeedUnit, WeldSpeedRule};
pub use motion::{CartesianLimits, Cycle, DriveBackend, Safety};
pub use nearest::nearest;
pub use pass::Pass;
pub use robot::{
    BuiltInRobot, DhConvention, DhRow, DhTable, JOINTS_MAX, Joint, JointKind, OpwParameters, Robot,
    RobotModel, UrdfSource,
};
pub use sensor::{EgmAddresses, LostSeam, SeamFilter, Sensor, SensorSource, Tack};
pub use simulation::{LaserErrors, Simulation};
pub use vibration::{FlexibleMode, Vibration, VibrationError};
pub use welding::{ArcEnd, ArcPolicy, ArcStart, Weave, WeavePattern, WeaveRate, WeaveSide};

use document::Document;
use section::Section;

/// The embedded default cell: a complete, commented file to copy from.
pub const DEFAULT_CELL_TOML: &str = include_str!("default.toml");

/// The cells that come with the program, by name. The first is the default; the others are laid over it.
pub const BUILT_IN_CELLS: [(&str, &str); 2] =
    [("default", DEFAULT_CELL_TOML), ("scara", include_str!("scara.toml"))];

/// A robot and its surroundings, checked. SI throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// The arm.
    pub robot: Robot,
    /// Limits of the tool's motion.
    pub cartesian: CartesianLimits,
    /// Tools by ascending number.
    pub tools: Vec<Tool>,
    /// User frames by ascending number.
    pub user_frames: Vec<UserFrame>,
    /// How jobs are read.
    pub job: JobRules,
    /// Arc start conditions by ascending number.
    pub arc_starts: Vec<ArcStart>,
    /// Arc end conditions by ascending number.
    pub arc_ends: Vec<ArcEnd>,
    /// Weave conditions by ascending number.
    pub weaves: Vec<Weave>,
    /// Passes of welds by ascending number.
    pub passes: Vec<Pass>,
    /// What is allowed while the arc is on.
    pub arc: ArcPolicy,
    /// The seam sensor.
    pub sensor: Sensor,
    /// Vibrations of the arm, and the prefilters that take them out; none by default.
    pub vibration: Vibration,
    /// Inputs.
    pub io: Io,
    /// The control cycle.
    pub cycle: Cycle,
    /// Where the tool may be.
    pub safety: Safety,
    /// What takes the joint commands.
    pub drive: DriveBackend,
    /// Imperfections of the simulated drives and sensor.
    pub simulation: Simulation,
}

impl Cell {
    /// The embedded default cell.
    ///
    /// # Errors
    /// Only if [`DEFAULT_CELL_TOML`] were wrong, which a test excludes.
    pub fn default_cell() -> Result<Self, CellError> {
        Self::parse("", "default cell")
    }

    /// A cell that comes with the program; `None` where none has this name.
    ///
    /// # Errors
    /// Only if a cell of [`BUILT_IN_CELLS`] were wrong, which a test excludes.
    pub fn built_in(name: &str) -> Option<Result<Self, CellError>> {
        let (name, text) = BUILT_IN_CELLS.iter().find(|(known, _)| *known == name)?;
        Some(Self::parse(text, &format!("cell {name}")))
    }

    /// Reads a cell file.
    ///
    /// # Errors
    /// The first mistake, with its place.
    pub fn load(path: &Path) -> Result<Self, CellError> {
        let name = path.display().to_string();
        let error = |place, problem| CellError { file: name.clone(), place, key: String::new(), problem };
        let bytes =
            std::fs::read(path).map_err(|reason| error(None, Problem::Unreadable(reason.to_string())))?;
        let text = String::from_utf8(bytes).map_err(|reason| {
            let right = String::from_utf8_lossy(&reason.as_bytes()[..reason.utf8_error().valid_up_to()]);
            let place = document::line_and_column(&right, right.len());
            error(Some(place), Problem::Syntax("a byte that is not UTF-8".to_owned()))
        })?;
        Self::parse(&text, &name)
    }

    /// Reads the text of a cell file; `name` is the file's path, for messages and for relative paths in it.
    ///
    /// # Errors
    /// The first mistake, with its place.
    pub fn parse(text: &str, name: &str) -> Result<Self, CellError> {
        let document = Document::parse(name, text, DEFAULT_CELL_TOML)?;
        let folder = Path::new(name).parent().unwrap_or_else(|| Path::new(""));
        Self::read(Section::root(&document)?, folder)
    }

    fn read(mut root: Section<'_>, folder: &Path) -> Result<Self, CellError> {
        let robot = Robot::read(&mut root.section("robot")?, folder)?;
        let joints = robot.joints.len();
        let cell = Self {
            robot,
            cartesian: CartesianLimits::read(root.section("cartesian")?)?,
            tools: numbered(&mut root, "tool", 0..=63, Tool::read)?,
            user_frames: numbered(&mut root, "user_frame", 1..=63, UserFrame::read)?,
            job: JobRules::read(root.section("job")?)?,
            arc_starts: numbered(&mut root, "arc_start", 1..=9999, ArcStart::read)?,
            arc_ends: numbered(&mut root, "arc_end", 1..=9999, ArcEnd::read)?,
            weaves: numbered(&mut root, "weave", 1..=9999, Weave::read)?,
            passes: numbered(&mut root, "pass", 1..=9999, |number, table| Pass::read(number, table, folder))?,
            arc: ArcPolicy::read(root.section("arc")?)?,
            sensor: Sensor::read(root.section("sensor")?, folder)?,
            vibration: Vibration::read(
                numbered(&mut root, "flexible_mode", 1..=9, |_, table| FlexibleMode::read(table))?,
                root.section("vibration")?,
            )?,
            io: Io::read(root.section("io")?)?,
            cycle: Cycle::read(root.section("cycle")?)?,
            safety: Safety::read(root.section("safety")?)?,
            drive: DriveBackend::read(root.section("drive")?)?,
            simulation: Simulation::read(root.section("simulation")?, joints)?,
        };
        root.finish()?;
        Ok(cell)
    }

    /// The tool with this number.
    #[must_use]
    pub fn tool(&self, number: u32) -> Option<&Tool> {
        self.tools.iter().find(|tool| tool.number == number)
    }

    /// The user frame with this number.
    #[must_use]
    pub fn user_frame(&self, number: u32) -> Option<&UserFrame> {
        self.user_frames.iter().find(|frame| frame.number == number)
    }

    /// The arc start condition ASF#(number).
    #[must_use]
    pub fn arc_start(&self, number: u32) -> Option<&ArcStart> {
        self.arc_starts.iter().find(|condition| condition.number == number)
    }

    /// The arc end condition AEF#(number).
    #[must_use]
    pub fn arc_end(&self, number: u32) -> Option<&ArcEnd> {
        self.arc_ends.iter().find(|condition| condition.number == number)
    }

    /// What MPF#(number) stands for.
    #[must_use]
    pub fn pass(&self, number: u32) -> Pass {
        let pass = self.passes.iter().find(|pass| pass.number == number);
        pass.cloned().unwrap_or_else(|| Pass::plain(number))
    }

    /// The weave condition WEV#(number).
    #[must_use]
    pub fn weave(&self, number: u32) -> Option<&Weave> {
        self.weaves.iter().find(|condition| condition.number == number)
    }
}

fn numbered<'a, T>(
    root: &mut Section<'a>,
    key: &'static str,
    range: std::ops::RangeInclusive<u32>,
    read: impl Fn(u32, Section<'a>) -> Result<T, CellError>,
) -> Result<Vec<T>, CellError> {
    root.numbered(key, range)?.into_iter().map(|(number, table)| read(number, table)).collect()
}
