//! The moving frame of a seam, and a tool that is displaced in it.

use crate::geometry::{PoseJet, Vector3};
use crate::math::taylor::Taylor;

/// Least sine of the angle between travel and wire: 6°. Nearer to it the frame turns with every tremor of the wire.
const LEAST_SINE: f64 = 0.1;

/// Axes at one place of a seam, in the seam's parent frame: x along the travel, y = x × wire (to the left with the wire pointing
/// down), z = x × y (out of the workpiece).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamFrame {
    /// Along the travel.
    pub x: Vector3,
    /// To the left.
    pub y: Vector3,
    /// Out of the workpiece.
    pub z: Vector3,
}

impl SeamFrame {
    /// The frame of a motion along a seam with the wire along the tool's z axis. `None` where nothing travels, or within 6°
    /// of the wire.
    #[must_use]
    pub fn of(seam: &PoseJet) -> Option<Self> {
        let x = seam.linear[0].try_normalize(f64::MIN_POSITIVE)?;
        let y = x.cross(&(seam.pose.rotation * Vector3::z())).try_normalize(LEAST_SINE)?;
        Some(Self { x, y, z: x.cross(&y) })
    }

    /// How fast the frame of a motion along a seam turns, in radians per unit of the motion's parameter: with the seam's bend, and about the
    /// travel with the wire. `None` where there is no frame.
    #[must_use]
    pub fn turn_rate(seam: &PoseJet) -> Option<f64> {
        Self::of(seam)?;
        let turned = axes(seam).map(|axis| {
            let derivatives = axis.map(|part| part.derivatives());
            let of_order = |order: usize| Vector3::from_fn(|k, _| derivatives[k][order]);
            Vector3::from_fn(|k, _| axis[k].value()).cross(&of_order(0))
        });
        Some(0.5 * (turned[0] + turned[1] + turned[2]).norm())
    }

    /// A vector in the seam's parent frame by its parts.
    #[must_use]
    pub fn vector(&self, [x, y, z]: [f64; 3]) -> Vector3 {
        self.x * x + self.y * y + self.z * z
    }
}

/// The motion along a seam with the tool moved aside: by an offset in the seam's frame, both along the same parameter. The
/// orientation stays. Where there is no frame ([`SeamFrame::of`]), the seam itself.
///
/// Exact for lines and arcs; on blends and splines the third derivative leaves out the change of the curve's third, which acts in proportion
/// to the offset.
#[must_use]
pub fn displaced(seam: &PoseJet, offset: &[Taylor; 3]) -> PoseJet {
    if SeamFrame::of(seam).is_none() {
        return *seam;
    }
    let [p1, p2, p3] = seam.linear;
    let [x, y, z] = axes(seam);
    let part = |k: usize| x[k] * offset[0] + y[k] * offset[1] + z[k] * offset[2];
    let parts = [part(0), part(1), part(2)];
    let derivatives = parts.map(|part| part.derivatives());
    let of_order = |order: usize| Vector3::from_fn(|axis, _| derivatives[axis][order]);
    let mut jet = *seam;
    jet.pose.translation.vector += Vector3::from_fn(|axis, _| parts[axis].value());
    jet.linear = [p1 + of_order(0), p2 + of_order(1), p3 + of_order(2)];
    jet
}

/// The frame's axes with their derivatives.
fn axes(seam: &PoseJet) -> [[Taylor; 3]; 3] {
    let [p1, p2, p3] = seam.linear;
    // A circle's fourth derivative; along a line there is none.
    let p4 = p2 * (-p2.norm_squared());
    let x = unit(&series(&p1, &p2, &p3, &p4));
    let y = unit(&cross(&x, &turning(seam)));
    [x, y, cross(&x, &y)]
}

/// The tool's z axis as it turns.
fn turning(seam: &PoseJet) -> [Taylor; 3] {
    let [w, dw, ddw] = seam.angular;
    let z = seam.pose.rotation * Vector3::z();
    let d1 = w.cross(&z);
    let d2 = dw.cross(&z) + w.cross(&d1);
    let d3 = ddw.cross(&z) + dw.cross(&d1) * 2.0 + w.cross(&d2);
    series(&z, &d1, &d2, &d3)
}

fn series(value: &Vector3, d1: &Vector3, d2: &Vector3, d3: &Vector3) -> [Taylor; 3] {
    core::array::from_fn(|k| Taylor::from_derivatives(value[k], d1[k], d2[k], d3[k]))
}

fn cross(a: &[Taylor; 3], b: &[Taylor; 3]) -> [Taylor; 3] {
    core::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn unit(v: &[Taylor; 3]) -> [Taylor; 3] {
    let squared = v[0].squared() + v[1].squared() + v[2].squared();
    let inverse = squared.sqrt_from(crate::math::float::sqrt(squared.value())).reciprocal();
    v.map(|part| part * inverse)
}
