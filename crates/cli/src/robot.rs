//! The robot that a subcommand is about.

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Context as _, bail};
use seamline_cell::cell::{BuiltInRobot, Cell, UrdfSource};
use seamline_cell::robot::{ArmDescription, BUILT_IN};

/// Which robot.
#[derive(Debug, clap::Args)]
pub(crate) struct RobotArguments {
    /// A built-in robot (ar2010, irb2400, ur5e, scara600), a URDF file (.urdf) or a cell file (.toml).
    ///
    /// A cell file's robot keeps to the cell's soft limits.
    #[arg(long, default_value = "ar2010", value_name = "NAME|F.urdf|F.toml")]
    robot: RobotSource,
    /// First link of a URDF file's chain; otherwise its root.
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// Last link of a URDF file's chain; otherwise its only end, `tool0`, or the end with most joints before it.
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
}

#[derive(Debug, Clone)]
enum RobotSource {
    BuiltIn(BuiltInRobot),
    Urdf(PathBuf),
    Cell(PathBuf),
}

impl FromStr for RobotSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some((_, robot)) = BUILT_IN.iter().find(|(name, _)| *name == text) {
            return Ok(Self::BuiltIn(*robot));
        }
        let path = PathBuf::from(text);
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        match extension.as_ref().and_then(|extension| extension.to_str()) {
            Some("urdf") => Ok(Self::Urdf(path)),
            Some("toml") => Ok(Self::Cell(path)),
            _ => {
                let names: Vec<&str> = BUILT_IN.iter().map(|(name, _)| *name).collect();
                Err(format!("expected {}, or a file .urdf or .toml", names.join(", ")))
            }
        }
    }
}

impl RobotArguments {
    /// Reads the robot.
    pub(crate) fn describe(&self) -> anyhow::Result<ArmDescription> {
        let (base_link, tip_link) = (self.base.clone(), self.tip.clone());
        let named = base_link.is_some() || tip_link.is_some();
        match &self.robot {
            RobotSource::Urdf(path) => {
                Ok(ArmDescription::from_urdf(&UrdfSource { path: path.clone(), base_link, tip_link })?)
            }
            _ if named => bail!("--base and --tip name links of a URDF file, and --robot is none"),
            RobotSource::BuiltIn(robot) => Ok(ArmDescription::built_in(*robot)),
            RobotSource::Cell(path) => ArmDescription::from_cell(&Cell::load(path)?.robot)
                .with_context(|| format!("{}: robot", path.display())),
        }
    }
}
