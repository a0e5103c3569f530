//! Rows of `recording.csv`, written and read.

use std::fmt::Write as _;

use nalgebra::{Quaternion, Unit};
use seamline::control::Mode;
use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::kinematics::JointKind;

use super::number;
use super::sample::{MAX_JOINTS, Sample};

/// What stands before the joints' columns.
const BEFORE_JOINTS: &str = "time_s,mode,line,segment,override";

/// The columns for a robot with these joints, separated by commas.
pub(super) fn header(joints: &[JointKind]) -> String {
    let mut header = BEFORE_JOINTS.to_owned();
    for what in ["", "_measured"] {
        for (index, kind) in joints.iter().enumerate() {
            // Writing into a string cannot fail.
            let _ = write!(header, ",q{}{what}_{}", index + 1, unit(*kind));
        }
    }
    header.push_str(",tcp_x_mm,tcp_y_mm,tcp_z_mm,tcp_qx,tcp_qy,tcp_qz,tcp_qw,tcp_speed_mm_s,arc");
    header.push_str(",seam_lateral_mm,seam_height_mm,seam_error_mm");
    header
}

/// Unit of a joint's columns.
fn unit(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "rad",
        JointKind::Prismatic => "m",
    }
}

/// Appends one row with its line end.
pub(super) fn push_row(text: &mut Vec<u8>, sample: &Sample, joints: usize) {
    number::push(text, sample.time);
    text.push(b',');
    text.extend_from_slice(sample.mode.name().as_bytes());
    text.push(b',');
    text.extend_from_slice(itoa(sample.line, &mut [0; 10]));
    text.push(b',');
    text.extend_from_slice(itoa(sample.segment, &mut [0; 10]));
    let pose = &sample.tcp;
    let position = &pose.translation.vector;
    let quaternion = &pose.rotation.coords;
    let numbers = |text: &mut Vec<u8>, values: &[f64], push: fn(&mut Vec<u8>, f64)| {
        for value in values {
            text.push(b',');
            push(text, *value);
        }
    };
    numbers(text, &[sample.override_rate], number::push);
    numbers(text, &sample.command[..joints], number::push);
    numbers(text, &sample.measured[..joints], number::push);
    numbers(text, position.as_slice(), number::push_mm);
    // nalgebra keeps a quaternion as x, y, z, w.
    numbers(text, quaternion.as_slice(), number::push);
    numbers(text, &[sample.tcp_speed], number::push_mm);
    text.extend_from_slice(if sample.arc { b",1" } else { b",0" });
    numbers(text, &[sample.seam_lateral, sample.seam_height, sample.seam_error], number::push_mm);
    text.push(b'\n');
}

/// The digits of `value` in `buffer`.
fn itoa(mut value: u32, buffer: &mut [u8; 10]) -> &[u8] {
    let mut start = buffer.len();
    loop {
        start -= 1;
        buffer[start] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 || start == 0 {
            return &buffer[start..];
        }
    }
}

/// The joints that a header announces, if it is one of ours.
pub(super) fn joints_of(found: &str) -> Option<Vec<JointKind>> {
    let columns = found.strip_prefix(BEFORE_JOINTS)?.split(',').skip(1).take(MAX_JOINTS);
    let kind = |(index, column): (usize, &str)| {
        let is = |kind| column == format!("q{}_{}", index + 1, unit(kind));
        [JointKind::Revolute, JointKind::Prismatic].into_iter().find(|kind| is(*kind))
    };
    let joints: Vec<_> = columns.enumerate().map_while(kind).collect();
    (!joints.is_empty() && header(&joints) == found).then_some(joints)
}

/// Reads one row without its line end; the error names the first column that does not fit.
pub(super) fn parse_row(row: &str, joints: usize) -> Result<Sample, usize> {
    let mut cells = Cells { cells: row.split(','), column: 0 };
    let mut sample = Sample::at_rest();
    sample.time = cells.next(number::parse)?;
    sample.mode = cells.next(Mode::from_name)?;
    sample.line = cells.next(|text| text.parse().ok())?;
    sample.segment = cells.next(|text| text.parse().ok())?;
    sample.override_rate = cells.next(number::parse)?;
    for joint in &mut sample.command[..joints] {
        *joint = cells.next(number::parse)?;
    }
    for joint in &mut sample.measured[..joints] {
        *joint = cells.next(number::parse)?;
    }
    let mut position = Vector3::zeros();
    for coordinate in position.as_mut_slice() {
        *coordinate = cells.next(number::parse_mm)?;
    }
    let mut quaternion = Quaternion::identity();
    for coordinate in quaternion.coords.as_mut_slice() {
        *coordinate = cells.next(number::parse)?;
    }
    // Not normalized again: the recording is read as it was written.
    let rotation: Rotation = Unit::new_unchecked(quaternion);
    sample.tcp = Pose::from_parts(position.into(), rotation);
    sample.tcp_speed = cells.next(number::parse_mm)?;
    sample.arc = cells.next(|text| match text {
        "0" => Some(false),
        "1" => Some(true),
        _ => None,
    })?;
    sample.seam_lateral = cells.next(number::parse_mm)?;
    sample.seam_height = cells.next(number::parse_mm)?;
    sample.seam_error = cells.next(number::parse_mm)?;
    match cells.cells.next() {
        None => Ok(sample),
        Some(_) => Err(cells.column + 1),
    }
}

/// The cells of a row, one after the other.
struct Cells<'a> {
    cells: std::str::Split<'a, char>,
    column: usize,
}

impl<'a> Cells<'a> {
    fn next<T>(&mut self, read: impl FnOnce(&'a str) -> Option<T>) -> Result<T, usize> {
        self.column += 1;
        self.cells.next().and_then(read).ok_or(self.column)
    }
}
