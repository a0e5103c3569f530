//! The path frame, and the motion of a path with an offset in it.

use super::Offset;
use super::lane::LaneJet;
use crate::geometry::{PoseJet, Vector3};
use crate::math::float::sqrt;
use crate::math::taylor::Taylor;

/// Least sine of the angle between tangent and wire: 6°. Nearer to it the frame turns with every tremor of the wire.
const LEAST_SINE: f64 = 0.1;

/// The path frame at one place, in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// x: the path's tangent.
    pub tangent: Vector3,
    /// y: to the left of the travel, with the wire pointing down.
    pub left: Vector3,
    /// z: off the plate; against the wire, where that stands upright on the path.
    pub up: Vector3,
}

impl Frame {
    /// The frame of a path (jet along arc length) at a place. `None` where the wire lies within 6° of the tangent.
    #[must_use]
    pub fn of(jet: &PoseJet) -> Option<Self> {
        let tangent = jet.linear[0];
        let across = tangent.cross(&wire(jet));
        let sine = across.norm();
        if sine.is_nan() || sine < LEAST_SINE {
            return None;
        }
        let left = across / sine;
        Some(Self { tangent, left, up: tangent.cross(&left) })
    }

    /// A vector's components across the path.
    #[must_use]
    pub fn offset(&self, vector: &Vector3) -> Offset {
        Offset::new(vector.dot(&self.left), vector.dot(&self.up))
    }
}

fn wire(jet: &PoseJet) -> Vector3 {
    jet.pose.rotation * Vector3::z()
}

/// The motion along a taught path with the lane's offset added: P(s) + y·c_y + z·c_z, the orientation as taught. Both
/// jets are along the path coordinate s, and so is the answer (of which s is not the arc length any more).
/// `None` where the path has no frame.
///
/// Exact on lines and arcs. Elsewhere the third derivative leaves out what the change of the curvature's change
/// does to the frame, times the offset: it is not in the path's jet.
///
/// Cost: about 0.15 µs.
#[must_use]
pub fn corrected(taught: &PoseJet, lane: &LaneJet) -> Option<PoseJet> {
    let [left, up] = moving_frame(taught)?;
    let [d1, d2, d3] = lane.derivatives;
    let along = |axis: usize| Taylor::from_derivatives(lane.offset[axis], d1[axis], d2[axis], d3[axis]);
    let (lateral, height) = (along(0), along(1));
    let mut jet = *taught;
    for axis in 0..3 {
        let offset = left[axis] * lateral + up[axis] * height;
        jet.pose.translation.vector[axis] += offset.value();
        for (linear, derivative) in jet.linear.iter_mut().zip(offset.derivatives()) {
            linear[axis] += derivative;
        }
    }
    Some(jet)
}

/// g = |d/ds (P + c)| and g′ from a [`corrected`] jet: the path coordinate must run at ṡ = v/g for the torch to travel
/// at v along the tracked seam, and then s̈ = −v² g′/g³.
#[must_use]
pub fn speed_factor(corrected: &PoseJet) -> (f64, f64) {
    let [d1, d2, _] = corrected.linear;
    let factor = d1.norm();
    (factor, d1.dot(&d2) / factor)
}

type Series = [Taylor; 3];

/// The frame's y and z as functions of s. The tangent's third derivative is taken as on a circle, −κ²T′.
fn moving_frame(jet: &PoseJet) -> Option<[Series; 2]> {
    Frame::of(jet)?;
    let [t, dt, ddt] = jet.linear;
    let dddt = dt * -dt.norm_squared();
    let [w, dw, ddw] = jet.angular;
    // The wire turns with the tool: r′ = ω×r, r″ = ω′×r + ω×r′, r‴ = ω″×r + 2ω′×r′ + ω×r″.
    let r = wire(jet);
    let r1 = w.cross(&r);
    let r2 = dw.cross(&r) + w.cross(&r1);
    let r3 = ddw.cross(&r) + dw.cross(&r1) * 2.0 + w.cross(&r2);
    let tangent = series(t, dt, ddt, dddt);
    let across = cross(&tangent, &series(r, r1, r2, r3));
    let square = across[0].squared() + across[1].squared() + across[2].squared();
    let shrink = square.sqrt_from(sqrt(square.value())).reciprocal();
    let left = across.map(|component| component * shrink);
    Some([left, cross(&tangent, &left)])
}

fn series(value: Vector3, d1: Vector3, d2: Vector3, d3: Vector3) -> Series {
    core::array::from_fn(|axis| Taylor::from_derivatives(value[axis], d1[axis], d2[axis], d3[axis]))
}

fn cross(a: &Series, b: &Series) -> Series {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
