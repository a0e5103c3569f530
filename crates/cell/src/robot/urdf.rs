//! A chain from a URDF file.

use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::kinematics::{JointAxis, JointKind};
use urdf_rs::JointType;

use super::{ArmDescription, ArmError, Chain, Joint, Structure, UrdfError, UrdfProblem};
use crate::cell::{JOINTS_MAX, UrdfSource};

/// The flange without tool, by the ROS-Industrial convention: the tip where nothing else is said.
const USUAL_TIP: &str = "tool0";

impl ArmDescription {
    /// The chain of a URDF file from its base to its tip link.
    ///
    /// Without names the base is the file's root, and the tip its only end, `tool0`, or the one end that has the most
    /// moving joints before it. Fixed joints are multiplied into the chain. A speed of 0 is none given.
    ///
    /// # Errors
    /// [`ArmError::Urdf`] with file and place.
    pub fn from_urdf(source: &UrdfSource) -> Result<Self, ArmError> {
        let file = source.path.display().to_string();
        let located = |problem| ArmError::Urdf(UrdfError { file: file.clone(), problem });
        let text = std::fs::read_to_string(&source.path)
            .map_err(|reason| located(UrdfProblem::Unreadable(reason.to_string())))?;
        Self::parse_urdf(&text, source.base_link.as_deref(), source.tip_link.as_deref()).map_err(located)
    }

    fn parse_urdf(text: &str, base: Option<&str>, tip: Option<&str>) -> Result<Self, UrdfProblem> {
        let robot = urdf_rs::read_from_string(text)
            .map_err(|reason| UrdfProblem::Syntax(reason.to_string().trim().replace('\n', " ")))?;
        let tree = Tree::new(&robot)?;
        let base = match base {
            Some(name) => tree.link(name)?,
            None => tree.root()?,
        };
        let tip = match tip {
            Some(name) => tree.link(name)?,
            None => tree.usual_tip(base)?,
        };
        let path = tree
            .path(base, tip)
            .ok_or_else(|| UrdfProblem::NoChain { base: base.to_owned(), tip: tip.to_owned() })?;
        let mut joints = Vec::new();
        let mut axes = Vec::new();
        let mut base_from_link = Pose::identity();
        for joint in path {
            base_from_link *= origin(joint)?;
            if let Some(kind) = kind(joint)? {
                axes.push(axis(joint, kind, &base_from_link)?);
                joints.push(described(joint, kind)?);
            }
        }
        if !(1..=JOINTS_MAX).contains(&joints.len()) {
            let (base, tip) = (base.to_owned(), tip.to_owned());
            return Err(UrdfProblem::JointCount { base, tip, found: joints.len() });
        }
        let structure = Structure::Chain(Chain::Axes { axes, base_from_flange: base_from_link });
        Ok(Self { name: robot.name, joints, structure })
    }
}

/// The links and joints of a file.
struct Tree<'a> {
    robot: &'a urdf_rs::Robot,
}

impl<'a> Tree<'a> {
    fn new(robot: &'a urdf_rs::Robot) -> Result<Self, UrdfProblem> {
        let tree = Self { robot };
        for joint in &robot.joints {
            tree.link(&joint.parent.link)?;
            let link = tree.link(&joint.child.link)?;
            if let Some(other) = tree.joint_above(link).filter(|other| !std::ptr::eq(*other, joint)) {
                let (first, second) = (other.name.clone(), joint.name.clone());
                return Err(UrdfProblem::TwoParents { link: link.to_owned(), first, second });
            }
        }
        Ok(tree)
    }

    fn links(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.robot.links.iter().map(|link| link.name.as_str())
    }

    fn link(&self, name: &str) -> Result<&'a str, UrdfProblem> {
        self.links().find(|link| *link == name).ok_or_else(|| UrdfProblem::UnknownLink {
            link: name.to_owned(),
            known: self.links().map(str::to_owned).collect(),
        })
    }

    /// The joint that moves a link.
    fn joint_above(&self, link: &str) -> Option<&'a urdf_rs::Joint> {
        self.robot.joints.iter().find(|joint| joint.child.link == link)
    }

    fn root(&self) -> Result<&'a str, UrdfProblem> {
        let roots: Vec<&str> = self.links().filter(|link| self.joint_above(link).is_none()).collect();
        match roots[..] {
            [root] => Ok(root),
            _ => Err(UrdfProblem::Roots { found: roots.into_iter().map(str::to_owned).collect() }),
        }
    }

    fn usual_tip(&self, base: &str) -> Result<&'a str, UrdfProblem> {
        let is_end = |link: &&str| self.robot.joints.iter().all(|joint| joint.parent.link != *link);
        let moving = |end: &str| {
            let path = self.path(base, end)?;
            Some(path.iter().filter(|joint| joint.joint_type != JointType::Fixed).count())
        };
        let ends: Vec<(&str, usize)> =
            self.links().filter(is_end).filter_map(|end| Some((end, moving(end)?))).collect();
        if let Some((end, _)) = ends.iter().find(|(end, _)| *end == USUAL_TIP) {
            return Ok(end);
        }
        let most = ends.iter().map(|(_, moving)| *moving).max().unwrap_or(0);
        let longest: Vec<&str> =
            ends.into_iter().filter(|(_, moving)| *moving == most).map(|(end, _)| end).collect();
        match longest[..] {
            [tip] => Ok(tip),
            _ => Err(UrdfProblem::Tips { found: longest.into_iter().map(str::to_owned).collect() }),
        }
    }

    /// The joints from one link to another that hangs on it.
    fn path(&self, base: &str, tip: &str) -> Option<Vec<&'a urdf_rs::Joint>> {
        let mut path = Vec::new();
        let mut link = tip;
        while link != base {
            // Longer than all joints together: the links hang on each other in a ring.
            if path.len() == self.robot.joints.len() {
                return None;
            }
            let joint = self.joint_above(link)?;
            path.push(joint);
            link = &joint.parent.link;
        }
        path.reverse();
        Some(path)
    }
}

fn wrong(joint: &urdf_rs::Joint, found: String, expected: &'static str) -> UrdfProblem {
    UrdfProblem::Joint { joint: joint.name.clone(), found, expected }
}

/// Roll, pitch and yaw turn about the parent's fixed axes x, y, z: R = Rz·Ry·Rx.
fn origin(joint: &urdf_rs::Joint) -> Result<Pose, UrdfProblem> {
    let (xyz, rpy) = (*joint.origin.xyz, *joint.origin.rpy);
    if xyz.iter().chain(&rpy).any(|number| !number.is_finite()) {
        return Err(wrong(joint, format!("origin {xyz:?} {rpy:?}"), "finite numbers"));
    }
    let [roll, pitch, yaw] = rpy;
    Ok(Pose::from_parts(xyz.into(), Rotation::from_euler_angles(roll, pitch, yaw)))
}

/// What the joint does; nothing if it is fixed.
fn kind(joint: &urdf_rs::Joint) -> Result<Option<JointKind>, UrdfProblem> {
    let kind = match joint.joint_type {
        JointType::Fixed => return Ok(None),
        JointType::Revolute | JointType::Continuous => JointKind::Revolute,
        JointType::Prismatic => JointKind::Prismatic,
        JointType::Floating | JointType::Planar | JointType::Spherical => {
            let found = format!("type {:?}", joint.joint_type).to_lowercase();
            return Err(wrong(joint, found, "revolute, continuous, prismatic or fixed"));
        }
    };
    match &joint.mimic {
        Some(mimic) => {
            Err(wrong(joint, format!("mimics joint {}", mimic.joint), "joints that move independently"))
        }
        None => Ok(Some(kind)),
    }
}

fn axis(joint: &urdf_rs::Joint, kind: JointKind, base_from_joint: &Pose) -> Result<JointAxis, UrdfProblem> {
    let xyz = *joint.axis.xyz;
    let direction = Vector3::from(xyz)
        .try_normalize(0.0)
        .filter(|direction| direction.sum().is_finite())
        .ok_or_else(|| wrong(joint, format!("axis {xyz:?}"), "a direction"))?;
    Ok(JointAxis {
        direction: base_from_joint.rotation * direction,
        point: base_from_joint.translation.vector,
        kind,
    })
}

fn described(joint: &urdf_rs::Joint, kind: JointKind) -> Result<Joint, UrdfProblem> {
    let endless = joint.joint_type == JointType::Continuous;
    let (min, max) = (joint.limit.lower, joint.limit.upper);
    let (position_min, position_max) = if endless { (f64::NEG_INFINITY, f64::INFINITY) } else { (min, max) };
    // Written so that NaN fails.
    let ordered = position_min < position_max;
    if !ordered {
        return Err(wrong(joint, format!("limits from {min} to {max}"), "lower before upper"));
    }
    let velocity_max = match joint.limit.velocity {
        0.0 => f64::INFINITY,
        given if given > 0.0 => given,
        given => {
            return Err(wrong(joint, format!("velocity limit {given}"), "a positive one, or 0 for none"));
        }
    };
    Ok(Joint { name: joint.name.clone(), kind, position_min, position_max, velocity_max })
}
