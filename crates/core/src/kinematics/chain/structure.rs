//! Finds the spherical-wrist arm in a six-joint chain, whatever the frames it was described in: from its axes at zero
//! alone.

use super::SerialChain;
use crate::geometry::{Pose, Rotation, Vector3};
use crate::kinematics::{JointAxes, JointAxis, Kinematics, SphericalWristArm, SphericalWristGeometry};
use crate::math::float::{atan2, hypot, sin_cos};

/// What a lateral frame choice is decided by: an offset of axis 2 from axis 1 below this (metres) has no direction.
const NO_OFFSET: f64 = 1e-6;

impl SerialChain<6> {
    /// The arm with parallel shoulder and elbow axes and spherical wrist that this chain is, if it is one to within
    /// `tolerance`: metres by which axes miss each other, radians by which they are not parallel or square. 1e-6 takes
    /// what rounded description files contain; a calibrated arm needs more, and [`super::super::SixAxisArm`] mends
    /// what the closed form then misses.
    #[must_use]
    pub fn spherical_wrist(&self, tolerance: f64) -> Option<SphericalWristArm> {
        let at_zero = self.axes(&[0.0; 6]);
        let [a1, a2, a3, a4, a5, a6] = &at_zero.axes;
        let d = at_zero.axes.map(|axis| axis.direction);
        let square = |a: usize, b: usize| d[a].dot(&d[b]).abs() <= tolerance;
        let structured = at_zero.axes.iter().all(|axis| !axis.prismatic)
            && square(0, 1)
            && d[1].cross(&d[2]).norm() <= tolerance
            && square(2, 3)
            && square(3, 4)
            && square(4, 5);
        if !structured {
            return None;
        }
        let (centre_45, miss_45) = meeting_point(a4, a5);
        let (centre_56, miss_56) = meeting_point(a5, a6);
        let miss = miss_45.max(miss_56).max((centre_45 - centre_56).norm());
        if miss > tolerance {
            return None;
        }
        let geometry = geometry(&at_zero, [a1, a2, a3], &centre_45);
        SphericalWristArm::try_new(geometry, *self.limits()).ok()
    }
}

/// The point half way between two lines where they are nearest, and their distance there. For lines that are not
/// parallel.
fn meeting_point(a: &JointAxis, b: &JointAxis) -> (Vector3, f64) {
    let between = b.point - a.point;
    let (u, v) = (a.direction, b.direction);
    let cosine = u.dot(&v);
    let square = 1.0 - cosine * cosine;
    let along_a = (between.dot(&u) - cosine * between.dot(&v)) / square;
    let along_b = (cosine * between.dot(&u) - between.dot(&v)) / square;
    let (on_a, on_b) = (a.point + u * along_a, b.point + v * along_b);
    ((on_a + on_b) / 2.0, (on_a - on_b).norm())
}

/// Dimensions and zeros of the arm with these axes, in the terms of [`SphericalWristGeometry`].
fn geometry(
    at_zero: &JointAxes<6>,
    [a1, a2, a3]: [&JointAxis; 3],
    centre: &Vector3,
) -> SphericalWristGeometry {
    // The shoulder frame: z on axis 1, y along axis 2, x to where axis 2 lies (or, without offset, the wrist).
    let z = a1.direction;
    let across = (a2.direction - z * a2.direction.dot(&z)).normalize();
    let out_of = |point: &Vector3| across.cross(&z).dot(&(point - a1.point));
    let offset = out_of(&a2.point);
    let towards = if offset.abs() > NO_OFFSET { offset } else { out_of(centre) };
    let side = 1.0_f64.copysign(towards);
    let y = across * side;
    let x = y.cross(&z);
    let origin = a1.point + z * z.dot(&(a2.point - a1.point));
    // Coordinates (out, up) in the arm's plane.
    let in_plane = |v: &Vector3| (x.dot(v), z.dot(v));
    let (upper_out, upper_up) = in_plane(&(a3.point - a2.point));
    let theta2 = atan2(upper_out, upper_up);
    // The forearm's frame: z along axis 4, in the direction in which axis 6 continues it.
    let d = at_zero.axes.map(|axis| axis.direction);
    let along = 1.0_f64.copysign(d[3].dot(&d[5]));
    let (fore_out, fore_up) = in_plane(&(d[3] * along));
    let theta23 = atan2(fore_out, fore_up);
    let scale = 1.0 / hypot(fore_out, fore_up);
    let (sin23, cos23) = (fore_out * scale, fore_up * scale);
    let (fore_x, fore_z) = (x * cos23 - z * sin23, x * sin23 + z * cos23);
    let (wrist_out, wrist_up) = in_plane(&(centre - a3.point));
    // The wrist's zero.
    let theta4 = atan2(-d[4].dot(&fore_x), d[4].dot(&y));
    let (sin4, cos4) = sin_cos(theta4);
    let wrist_x = fore_x * cos4 + y * sin4;
    let theta5 = atan2(d[5].dot(&wrist_x), d[5].dot(&fore_z));
    let arm = SphericalWristGeometry {
        shoulder_offset: offset * side,
        upper_arm: hypot(upper_out, upper_up),
        elbow_offset: wrist_out * cos23 - wrist_up * sin23,
        forearm: wrist_out * sin23 + wrist_up * cos23,
        lateral_offset: y.dot(&(centre - origin)),
        base_from_shoulder: Pose::from_parts(origin.into(), frame(&x, &y, &z)),
        wrist_from_flange: Pose::identity(),
        signs: [1.0, side, side * 1.0_f64.copysign(d[1].dot(&d[2])), along, 1.0, 1.0],
        zeros: [0.0, theta2, theta23 - theta2, theta4, theta5, 0.0],
    };
    // The wrist frame at zero: z along axis 6, y along axis 5.
    let last_y = (d[4] - d[5] * d[4].dot(&d[5])).normalize();
    let base_from_wrist = Pose::from_parts((*centre).into(), frame(&last_y.cross(&d[5]), &last_y, &d[5]));
    SphericalWristGeometry { wrist_from_flange: base_from_wrist.inverse() * at_zero.base_from_flange, ..arm }
}

/// The rotation whose columns these unit vectors are.
fn frame(x: &Vector3, y: &Vector3, z: &Vector3) -> Rotation {
    let matrix = nalgebra::Matrix3::from_columns(&[*x, *y, *z]);
    Rotation::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix))
}
