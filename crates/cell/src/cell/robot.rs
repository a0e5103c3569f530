//! The arm: which model, and the limits and encoders of its joints.

use std::path::{Path, PathBuf};

pub use seamline::kinematics::{DhConvention, JointKind, OpwParameters};

use super::error::CellError;
use super::section::{Section, Unit};

/// Most joints an arm can have.
pub const JOINTS_MAX: usize = 7;

/// The robot of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// The name that reports show.
    pub name: String,
    /// Where the kinematic model comes from.
    pub model: RobotModel,
    /// The joints from base to flange, 1 to [`JOINTS_MAX`] of them.
    pub joints: Vec<Joint>,
}

/// The data of a kinematic model.
#[derive(Debug, Clone, PartialEq)]
pub enum RobotModel {
    /// One of the arms that come with the program.
    BuiltIn(BuiltInRobot),
    /// A six-axis arm with spherical wrist, by its dimensions after Brandstötter, Angerer & Hofbaur, *An analytical
    /// solution of the inverse kinematics problem of industrial serial manipulators with an ortho-parallel basis and a
    /// spherical wrist* (2014).
    Opw(OpwParameters),
    /// A serial chain by its Denavit–Hartenberg table.
    Dh(DhTable),
    /// A URDF file.
    Urdf(UrdfSource),
}

/// An arm that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuiltInRobot {
    /// Yaskawa AR2010/MA2010-class arc-welding arm.
    Ar2010,
    /// ABB IRB 2400/10.
    Irb2400,
    /// Universal Robots UR5e.
    Ur5e,
    /// Four-axis SCARA with 325 mm and 275 mm links.
    Scara600,
}

impl BuiltInRobot {
    /// How many joints the arm has.
    #[must_use]
    pub fn joint_count(self) -> usize {
        match self {
            Self::Ar2010 | Self::Irb2400 | Self::Ur5e => 6,
            Self::Scara600 => 4,
        }
    }
}

/// A Denavit–Hartenberg table.
#[derive(Debug, Clone, PartialEq)]
pub struct DhTable {
    /// Which of the two usual conventions the rows follow.
    pub convention: DhConvention,
    /// One row a joint, from the base. The joint's own coordinate adds to `theta` (revolute) or `d` (prismatic).
    pub rows: Vec<DhRow>,
}

/// One row of a Denavit–Hartenberg table. Metres, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DhRow {
    /// Link length along x.
    pub a: f64,
    /// Link twist about x.
    pub alpha: f64,
    /// Offset along z.
    pub d: f64,
    /// Angle about z.
    pub theta: f64,
}

/// A chain in a URDF file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UrdfSource {
    /// The file; a relative path in the cell file starts at the cell file's own folder.
    pub path: PathBuf,
    /// First link of the chain; none: the file's root.
    pub base_link: Option<String>,
    /// Last link of the chain; none: the file's only leaf.
    pub tip_link: Option<String>,
}

/// One joint. Radians or metres by its kind, and seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The maker's letter or name, such as `S`.
    pub name: String,
    /// Turning (coordinate in radians) or sliding (in metres).
    pub kind: JointKind,
    /// Lower end of the mechanical range.
    pub position_min: f64,
    /// Upper end of the mechanical range.
    pub position_max: f64,
    /// How far before either end the soft limit lies.
    pub soft_margin: f64,
    /// Greatest speed.
    pub velocity: f64,
    /// Greatest acceleration.
    pub acceleration: f64,
    /// Greatest jerk.
    pub jerk: f64,
    /// Encoder pulses per radian or metre, negative where the encoder counts against the joint.
    pub pulses_per_unit: f64,
    /// Greatest distance between command and measurement.
    pub following_error: f64,
    /// Where the simulated arm stands at the start.
    pub home: f64,
}

impl Joint {
    /// The joint's coordinate at an encoder reading.
    #[must_use]
    pub fn position_from_pulses(&self, pulses: f64) -> f64 {
        pulses / self.pulses_per_unit
    }

    /// The encoder reading at a coordinate, not rounded.
    #[must_use]
    pub fn pulses_from_position(&self, position: f64) -> f64 {
        position * self.pulses_per_unit
    }

    /// Lower and upper soft limit.
    #[must_use]
    pub fn soft_limits(&self) -> (f64, f64) {
        (self.position_min + self.soft_margin, self.position_max - self.soft_margin)
    }
}

impl Robot {
    /// One value of each joint as an array; none if the robot has not `N` joints.
    pub fn joint_array<const N: usize>(&self, value: impl Fn(&Joint) -> f64) -> Option<[f64; N]> {
        let values: Vec<f64> = self.joints.iter().map(value).collect();
        values.try_into().ok()
    }

    pub(super) fn read(section: &mut Section<'_>, folder: &Path) -> Result<Self, CellError> {
        let (model, own_table) = match section.choice("model", &MODELS)? {
            ModelKind::BuiltIn(robot) => (RobotModel::BuiltIn(robot), ""),
            ModelKind::Opw => (RobotModel::Opw(read_opw(section.section("opw")?)?), "opw"),
            ModelKind::Dh => (RobotModel::Dh(read_dh(section.section("dh")?)?), "dh"),
            ModelKind::Urdf => (RobotModel::Urdf(read_urdf(section.section("urdf")?, folder)?), "urdf"),
        };
        for table in ["opw", "dh", "urdf"] {
            if table != own_table && section.has(table) {
                return Err(section.unexpected(table, &format!("model = \"{table}\" with this table")));
            }
        }
        let name = match section.optional_text("name")? {
            Some(name) => name,
            None => section.text("model")?,
        };
        let joints = read_joints(section, &model)?;
        section.finish()?;
        Ok(Self { name, model, joints })
    }
}

#[derive(Clone, Copy)]
enum ModelKind {
    BuiltIn(BuiltInRobot),
    Opw,
    Dh,
    Urdf,
}

const MODELS: [(&str, ModelKind); 7] = [
    ("ar2010", ModelKind::BuiltIn(BuiltInRobot::Ar2010)),
    ("irb2400", ModelKind::BuiltIn(BuiltInRobot::Irb2400)),
    ("ur5e", ModelKind::BuiltIn(BuiltInRobot::Ur5e)),
    ("scara600", ModelKind::BuiltIn(BuiltInRobot::Scara600)),
    ("opw", ModelKind::Opw),
    ("dh", ModelKind::Dh),
    ("urdf", ModelKind::Urdf),
];

fn read_opw(mut section: Section<'_>) -> Result<OpwParameters, CellError> {
    let mut dimension = |key| section.number(key, Unit::Milli, -10_000.0..=10_000.0);
    let (a1, a2, b) = (dimension("a1_mm")?, dimension("a2_mm")?, dimension("b_mm")?);
    let c1 = dimension("c1_mm")?;
    let mut length = |key| section.number(key, Unit::Milli, 1.0..=10_000.0);
    let (c2, c3) = (length("c2_mm")?, length("c3_mm")?);
    let c4 = section.number("c4_mm", Unit::Milli, 0.0..=10_000.0)?;
    let offsets = section.array("offsets_deg", Unit::Degree, -360.0..=360.0)?;
    let signs: [f64; 6] = section.array("signs", Unit::Plain, -1.0..=1.0)?;
    if signs.iter().any(|sign| sign.abs() != 1.0) {
        return Err(section.unexpected("signs", "a list of 6 numbers, each 1 or -1"));
    }
    section.finish()?;
    Ok(OpwParameters { a1, a2, b, c1, c2, c3, c4, offsets, signs })
}

fn read_dh(mut section: Section<'_>) -> Result<DhTable, CellError> {
    let conventions = [("standard", DhConvention::Standard), ("modified", DhConvention::Modified)];
    let convention = section.choice("convention", &conventions)?;
    let mut rows = Vec::new();
    for (number, mut row) in section.numbered("row", JOINT_NUMBERS)? {
        consecutive(&row, number, rows.len())?;
        rows.push(DhRow {
            a: row.number("a_mm", Unit::Milli, -10_000.0..=10_000.0)?,
            alpha: row.number("alpha_deg", Unit::Degree, -360.0..=360.0)?,
            d: row.number("d_mm", Unit::Milli, -10_000.0..=10_000.0)?,
            theta: row.number("theta_deg", Unit::Degree, -360.0..=360.0)?,
        });
        row.finish()?;
    }
    section.finish()?;
    Ok(DhTable { convention, rows })
}

fn read_urdf(mut section: Section<'_>, folder: &Path) -> Result<UrdfSource, CellError> {
    let source = UrdfSource {
        path: folder.join(section.text("path")?),
        base_link: section.optional_text("base_link")?,
        tip_link: section.optional_text("tip_link")?,
    };
    section.finish()?;
    Ok(source)
}

const JOINT_NUMBERS: std::ops::RangeInclusive<u32> = 1..=JOINTS_MAX as u32;

/// The tables of joints and rows are numbered 1, 2, 3 … without a gap.
fn consecutive(table: &Section<'_>, number: u32, before: usize) -> Result<(), CellError> {
    if number as usize == before + 1 {
        return Ok(());
    }
    Err(table.unexpected("number", &format!("{}: numbers run from 1 without a gap", before + 1)))
}

fn read_joints(section: &mut Section<'_>, model: &RobotModel) -> Result<Vec<Joint>, CellError> {
    let mut joints = Vec::new();
    for (number, table) in section.numbered("joint", JOINT_NUMBERS)? {
        consecutive(&table, number, joints.len())?;
        joints.push(read_joint(table)?);
    }
    let count = match model {
        RobotModel::BuiltIn(robot) => robot.joint_count(),
        RobotModel::Opw(_) => 6,
        RobotModel::Dh(table) => table.rows.len().max(1),
        RobotModel::Urdf(_) => joints.len().max(1),
    };
    if joints.is_empty() {
        let expected = format!(
            "{} tables [[robot.joint]] (those of the default cell belong to its own robot)",
            if matches!(model, RobotModel::Urdf(_)) { "1 to 7".to_owned() } else { count.to_string() }
        );
        return Err(section.missing("joint", &expected));
    }
    if joints.len() != count {
        let expected = format!("{count} tables [[robot.joint]] for this model, not {}", joints.len());
        return Err(section.unexpected("joint", &expected));
    }
    Ok(joints)
}

/// The keys of a joint's table, by its kind: the suffix says the unit.
struct JointKeys {
    length: Unit,
    per_length: Unit,
    range: f64,
    position_min: &'static str,
    position_max: &'static str,
    soft_margin: &'static str,
    velocity: &'static str,
    acceleration: &'static str,
    jerk: &'static str,
    pulses: &'static str,
    following_error: &'static str,
    home: &'static str,
}

const REVOLUTE_KEYS: JointKeys = JointKeys {
    length: Unit::Degree,
    per_length: Unit::PerDegree,
    range: 3600.0,
    position_min: "position_min_deg",
    position_max: "position_max_deg",
    soft_margin: "soft_margin_deg",
    velocity: "velocity_deg_s",
    acceleration: "acceleration_deg_s2",
    jerk: "jerk_deg_s3",
    pulses: "pulses_per_deg",
    following_error: "following_error_deg",
    home: "home_deg",
};

const PRISMATIC_KEYS: JointKeys = JointKeys {
    length: Unit::Milli,
    per_length: Unit::PerMilli,
    range: 100_000.0,
    position_min: "position_min_mm",
    position_max: "position_max_mm",
    soft_margin: "soft_margin_mm",
    velocity: "velocity_mm_s",
    acceleration: "acceleration_mm_s2",
    jerk: "jerk_mm_s3",
    pulses: "pulses_per_mm",
    following_error: "following_error_mm",
    home: "home_mm",
};

fn read_joint(mut table: Section<'_>) -> Result<Joint, CellError> {
    let name = table.text("name")?;
    let kinds = [("revolute", JointKind::Revolute), ("prismatic", JointKind::Prismatic)];
    let kind = if table.has("kind") { table.choice("kind", &kinds)? } else { JointKind::Revolute };
    let keys = match kind {
        JointKind::Revolute => REVOLUTE_KEYS,
        JointKind::Prismatic => PRISMATIC_KEYS,
    };
    let position = -keys.range..=keys.range;
    let position_min = table.number(keys.position_min, keys.length, position.clone())?;
    let position_max = table.number(keys.position_max, keys.length, position.clone())?;
    table.ordered((keys.position_min, position_min), (keys.position_max, position_max))?;
    let soft_margin = table.number(keys.soft_margin, keys.length, 0.0..=keys.range)?;
    if 2.0 * soft_margin >= position_max - position_min {
        let expected =
            format!("{} ({}) less than half the range", keys.soft_margin, table.written(keys.soft_margin));
        let keys = [keys.soft_margin, keys.position_min, keys.position_max];
        return Err(table.contradiction(&keys, &expected));
    }
    let velocity = table.number(keys.velocity, keys.length, 0.001..=1e5)?;
    let acceleration = table.number(keys.acceleration, keys.length, 0.001..=1e6)?;
    let jerk = table.number(keys.jerk, keys.length, 0.001..=1e8)?;
    let pulses = table.number(keys.pulses, keys.per_length, 1e-3..=1e9)?;
    let sign = table.choice("pulse_direction", &[("positive", 1.0), ("negative", -1.0)])?;
    let following_error = table.number(keys.following_error, keys.length, 1e-3..=keys.range)?;
    let home = table.number(keys.home, keys.length, position)?;
    let joint = Joint {
        name,
        kind,
        position_min,
        position_max,
        soft_margin,
        velocity,
        acceleration,
        jerk,
        pulses_per_unit: sign * pulses,
        following_error,
        home,
    };
    let (low, high) = joint.soft_limits();
    if !(low..=high).contains(&home) {
        let expected = format!("{} ({}) within the soft limits", keys.home, table.written(keys.home));
        let keys = [keys.home, keys.position_min, keys.position_max, keys.soft_margin];
        return Err(table.contradiction(&keys, &expected));
    }
    table.finish()?;
    Ok(joint)
}
