//! Positions as job files hold them, and their way to SI.

use std::fmt;

use seamline::geometry::{EulerZyx, Pose, Vector3};

/// The six kinds of positions, in the order of `///NPOS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PositionKind {
    /// Robot step of this job.
    C,
    /// Base axis (track) step of this job.
    Bc,
    /// Station (external axis) step of this job.
    Ec,
    /// Robot position variable.
    P,
    /// Base axis position variable.
    Bp,
    /// Station position variable.
    Ex,
}

impl PositionKind {
    /// All kinds, in the order of `///NPOS`.
    pub const ALL: [Self; 6] = [Self::C, Self::Bc, Self::Ec, Self::P, Self::Bp, Self::Ex];

    /// The letters in the file.
    #[must_use]
    pub fn letters(self) -> &'static str {
        match self {
            Self::C => "C",
            Self::Bc => "BC",
            Self::Ec => "EC",
            Self::P => "P",
            Self::Bp => "BP",
            Self::Ex => "EX",
        }
    }
}

/// A position's name: kind and number. Numbers match as integers: `P1` is `P00001`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PositionName {
    /// Whether it is a local variable (`LP007`).
    pub local: bool,
    /// The kind.
    pub kind: PositionKind,
    /// The number.
    pub number: u32,
}

impl fmt::Display for PositionName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width =
            if matches!(self.kind, PositionKind::C | PositionKind::Bc | PositionKind::Ec) { 5 } else { 3 };
        let local = if self.local { "L" } else { "" };
        write!(f, "{local}{}{:0width$}", self.kind.letters(), self.number)
    }
}

/// The coordinate system that a position or an increment refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// The station's floor (with a track); the robot frame without.
    Base,
    /// The robot's own frame.
    Robot,
    /// The tool frame.
    Tool,
    /// A user frame of the cell.
    User(u32),
    /// The tool of the other robot.
    MasterTool,
}

/// The arm's configuration, from `///RCONF`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Configuration {
    /// d1 = 1: wrist not flipped.
    pub no_flip: bool,
    /// d2 = 1: lower arm.
    pub lower_arm: bool,
    /// d3 = 1: the S axis looks to the rear.
    pub rear: bool,
    /// d4 = 1: R axis at 180° or beyond.
    pub r_beyond_180: bool,
    /// d5 = 1: T axis at 180° or beyond.
    pub t_beyond_180: bool,
    /// d6 = 1: S axis at 180° or beyond.
    pub s_beyond_180: bool,
}

impl Configuration {
    /// From `///RCONF` values; those beyond the sixth have no meaning, missing ones are 0.
    #[must_use]
    pub fn from_flags(flags: &[bool]) -> Self {
        let flag = |i: usize| flags.get(i).copied().unwrap_or(false);
        Self {
            no_flip: flag(0),
            lower_arm: flag(1),
            rear: flag(2),
            r_beyond_180: flag(3),
            t_beyond_180: flag(4),
            s_beyond_180: flag(5),
        }
    }
}

/// A position in rectangular coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangular {
    /// x, y, z of the tool centre point in mm.
    pub position_mm: [f64; 3],
    /// Rx, Ry, Rz in degrees: R = Rz·Ry·Rx.
    pub rotation_deg: [f64; 3],
    /// Elbow angle of a seven-axis arm in degrees.
    pub elbow_deg: Option<f64>,
    /// The frame that the coordinates refer to.
    pub frame: Frame,
    /// Which of the arm's solutions is meant.
    pub configuration: Configuration,
}

impl Rectangular {
    /// The pose `frame_from_tcp` in metres.
    #[must_use]
    pub fn pose(&self) -> Pose {
        let [x, y, z] = self.position_mm.map(|mm| mm / 1000.0);
        let [rx, ry, rz] = self.rotation_deg.map(f64::to_radians);
        Pose::from_parts(Vector3::new(x, y, z).into(), EulerZyx { x: rx, y: ry, z: rz }.to_rotation())
    }

    /// The position of a pose `frame_from_tcp` in metres.
    #[must_use]
    pub fn from_pose(frame_from_tcp: &Pose, frame: Frame, configuration: Configuration) -> Self {
        let angles = EulerZyx::from_rotation(&frame_from_tcp.rotation);
        let p = frame_from_tcp.translation.vector;
        Self {
            position_mm: [p.x * 1000.0, p.y * 1000.0, p.z * 1000.0],
            rotation_deg: [angles.x.to_degrees(), angles.y.to_degrees(), angles.z.to_degrees()],
            elbow_deg: None,
            frame,
            configuration,
        }
    }
}

/// The coordinates of a position, in the form in which the file has them.
#[derive(Debug, Clone, PartialEq)]
pub enum Coordinates {
    /// Encoder pulses per axis, S L U R B T first.
    Pulses(Vec<i32>),
    /// Millimetres and degrees.
    Rectangular(Rectangular),
    /// Axis values: degrees of a station, millimetres of a track.
    Angles(Vec<f64>),
}

impl Coordinates {
    /// The form in words.
    #[must_use]
    pub fn form(&self) -> &'static str {
        match self {
            Self::Pulses(_) => "a position in pulses",
            Self::Rectangular(_) => "a rectangular position",
            Self::Angles(_) => "a position in axis values",
        }
    }
}

impl Coordinates {
    /// One element as SETE and GETE count it, from 1: pulses, 0.001 mm, 0.0001°. `None` where there is none.
    #[must_use]
    pub fn element(&self, number: usize) -> Option<f64> {
        let index = number.checked_sub(1)?;
        match self {
            Self::Pulses(pulses) => pulses.get(index).map(|p| f64::from(*p)),
            Self::Angles(angles) => angles.get(index).map(|a| (a * PER_DEGREE).round()),
            Self::Rectangular(r) => match index {
                0..=2 => r.position_mm.get(index).map(|mm| (mm * PER_MILLIMETRE).round()),
                3..=5 => r.rotation_deg.get(index - 3).map(|deg| (deg * PER_DEGREE).round()),
                6 => r.elbow_deg.map(|deg| (deg * PER_DEGREE).round()),
                _ => None,
            },
        }
    }

    /// Sets one element, in the counts of [`element`](Self::element). False where there is none, or pulses leave
    /// their 32 bits.
    pub fn set_element(&mut self, number: usize, count: f64) -> bool {
        let Some(index) = number.checked_sub(1) else { return false };
        let slot = match self {
            Self::Pulses(pulses) => {
                let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&count);
                let Some(slot) = pulses.get_mut(index).filter(|_| fits) else { return false };
                // In range: the cast only drops a fraction.
                *slot = count.round() as i32;
                return true;
            }
            Self::Angles(angles) => angles.get_mut(index).map(|slot| (slot, PER_DEGREE)),
            Self::Rectangular(r) => match index {
                0..=2 => r.position_mm.get_mut(index).map(|slot| (slot, PER_MILLIMETRE)),
                3..=5 => r.rotation_deg.get_mut(index - 3).map(|slot| (slot, PER_DEGREE)),
                6 => r.elbow_deg.as_mut().map(|slot| (slot, PER_DEGREE)),
                _ => None,
            },
        };
        let Some((slot, per_unit)) = slot else { return false };
        *slot = count / per_unit;
        true
    }

    /// How many elements there are.
    #[must_use]
    pub fn elements(&self) -> usize {
        match self {
            Self::Pulses(pulses) => pulses.len(),
            Self::Angles(angles) => angles.len(),
            Self::Rectangular(r) => 6 + usize::from(r.elbow_deg.is_some()),
        }
    }
}

/// Counts of SETE and GETE in a millimetre.
const PER_MILLIMETRE: f64 = 1000.0;
/// Counts of SETE and GETE in a degree (from the DX100 on).
const PER_DEGREE: f64 = 10_000.0;

/// One position of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct JobPosition {
    /// The coordinates.
    pub coordinates: Coordinates,
    /// Number of the tool that was active when the position was taught.
    pub tool: u32,
}

/// Joint positions in radians, or metres where a joint slides, from pulses.
///
/// `pulses_per_unit` is signed: a negative value turns the axis around. `None` where there are fewer pulses
/// than axes; further pulses belong to other axes and are left out.
#[must_use]
pub fn joints_from_pulses<const N: usize>(pulses: &[i32], pulses_per_unit: &[f64; N]) -> Option<[f64; N]> {
    let mut joints = [0.0; N];
    for (joint, (axis, per_unit)) in joints.iter_mut().zip(pulses_per_unit.iter().enumerate()) {
        *joint = f64::from(*pulses.get(axis)?) / per_unit;
    }
    Some(joints)
}

/// Pulses, to the nearest, from joint positions: the inverse of [`joints_from_pulses`].
#[must_use]
pub fn pulses_from_joints<const N: usize>(joints: &[f64; N], pulses_per_unit: &[f64; N]) -> Vec<i32> {
    // A cast from float to integer saturates at i32's ends.
    joints.iter().zip(pulses_per_unit).map(|(q, k)| (q * k).round() as i32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pulses_turn_to_radians_and_back() {
        let per_radian = [1341.380023, -1907.674052].map(f64::to_degrees);
        let joints = joints_from_pulses(&[-49_439, 115_900, 7], &per_radian).unwrap();
        assert!((joints[0].to_degrees() + 36.856_818).abs() < 1e-6);
        assert!((joints[1].to_degrees() + 60.754_614).abs() < 1e-6);
        assert_eq!(pulses_from_joints(&joints, &per_radian), [-49_439, 115_900]);
        assert_eq!(joints_from_pulses(&[1], &per_radian), None);
    }

    #[test]
    fn poses_survive_the_round_trip() {
        let written = Rectangular {
            position_mm: [812.345, -20.1, 455.0],
            rotation_deg: [180.0, -5.25, 0.0],
            elbow_deg: None,
            frame: Frame::Robot,
            configuration: Configuration::default(),
        };
        let back = Rectangular::from_pose(&written.pose(), Frame::Robot, Configuration::default());
        for i in 0..3 {
            assert!((back.position_mm[i] - written.position_mm[i]).abs() < 1e-9);
        }
        assert!(back.pose().rotation.angle_to(&written.pose().rotation) < 1e-12);
        assert!((written.pose().translation.z - 0.455).abs() < 1e-15);
    }
}
