//! Finds the closed form in a six-joint chain, whatever the frames it was described in: from its axes at zero alone.

use super::SerialChain;
use crate::geometry::{Pose, Rotation, Vector3};
use crate::kinematics::closed_form::TwoLink;
use crate::kinematics::three_parallel::ThreeParallelGeometry;
use crate::kinematics::{
    JointAxes, JointAxis, JointKind, Kinematics, SphericalWristArm, SphericalWristGeometry, ThreeParallelArm,
};
use crate::math::float::{atan2, hypot, sin_cos};

/// An offset of axis 2 from axis 1 below this (metres) does not say where the arm's front is.
const NO_OFFSET: f64 = 1e-6;

impl SerialChain<6> {
    /// The arm with parallel shoulder and elbow axes and spherical wrist that this chain is, if it is one to within
    /// `tolerance`: metres by which axes miss each other, radians by which they are not parallel or square.
    ///
    /// 1e-10 makes the closed form exact. A calibrated arm, or a description with rounded angles, needs more, and
    /// [`crate::kinematics::SixAxisArm`] mends what the closed form then misses.
    #[must_use]
    pub fn spherical_wrist(&self, tolerance: f64) -> Option<SphericalWristArm> {
        let at_zero = self.axes(&[0.0; 6]);
        let lines = Lines { axes: &at_zero.axes, tolerance };
        let structured = lines.all_turn()
            && lines.square(0, 1)
            && lines.parallel(1, 2)
            && lines.square(2, 3)
            && lines.square(3, 4)
            && lines.square(4, 5);
        if !structured {
            return None;
        }
        let (centre, on_axis_6) = (lines.meeting_point(3, 4)?, lines.meeting_point(4, 5)?);
        if (centre - on_axis_6).norm() > tolerance {
            return None;
        }
        SphericalWristArm::try_new(spherical_wrist(&at_zero, &centre), *self.limits()).ok()
    }

    /// The arm with axes 2, 3 and 4 parallel that this chain is, if it is one to within `tolerance` (metres and
    /// radians, as for [`SerialChain::spherical_wrist`]).
    #[must_use]
    pub fn three_parallel(&self, tolerance: f64) -> Option<ThreeParallelArm> {
        let at_zero = self.axes(&[0.0; 6]);
        let lines = Lines { axes: &at_zero.axes, tolerance };
        let structured = lines.all_turn()
            && lines.square(0, 1)
            && lines.parallel(1, 2)
            && lines.parallel(2, 3)
            && lines.square(3, 4)
            && lines.square(4, 5);
        if !structured {
            return None;
        }
        let (on_axis_4, on_axis_6) = (lines.meeting_point(3, 4)?, lines.meeting_point(4, 5)?);
        let geometry = three_parallel(&at_zero, &on_axis_4, &on_axis_6);
        let TwoLink { upper, fore } = geometry.links;
        (upper > tolerance && fore > tolerance).then(|| ThreeParallelArm::new(*self, geometry))
    }
}

/// Axes at zero, and how much they may miss of a property that they are asked for.
struct Lines<'a> {
    axes: &'a [JointAxis; 6],
    tolerance: f64,
}

impl Lines<'_> {
    fn all_turn(&self) -> bool {
        self.axes.iter().all(|axis| axis.kind == JointKind::Revolute)
    }

    fn square(&self, a: usize, b: usize) -> bool {
        self.axes[a].direction.dot(&self.axes[b].direction).abs() <= self.tolerance
    }

    fn parallel(&self, a: usize, b: usize) -> bool {
        self.axes[a].direction.cross(&self.axes[b].direction).norm() <= self.tolerance
    }

    /// The point half way between two lines, not parallel, where they are nearest.
    fn meeting_point(&self, a: usize, b: usize) -> Option<Vector3> {
        let (a, b) = (&self.axes[a], &self.axes[b]);
        let between = b.point - a.point;
        let (u, v) = (a.direction, b.direction);
        let cosine = u.dot(&v);
        let square = 1.0 - cosine * cosine;
        let along_a = (between.dot(&u) - cosine * between.dot(&v)) / square;
        let along_b = (cosine * between.dot(&u) - between.dot(&v)) / square;
        let (on_a, on_b) = (a.point + u * along_a, b.point + v * along_b);
        ((on_a - on_b).norm() <= self.tolerance).then(|| (on_a + on_b) / 2.0)
    }
}

/// The shoulder frame: z on axis 1, y along axis 2 (or against it), origin at the height of axis 2.
struct ShoulderFrame {
    x: Vector3,
    y: Vector3,
    z: Vector3,
    origin: Vector3,
}

impl ShoulderFrame {
    fn of(axis_1: &JointAxis, axis_2: &JointAxis, side: f64) -> Self {
        let z = axis_1.direction;
        let y = (axis_2.direction - z * axis_2.direction.dot(&z)).normalize() * side;
        let origin = axis_1.point + z * z.dot(&(axis_2.point - axis_1.point));
        Self { x: y.cross(&z), y, z, origin }
    }

    /// Coordinates (out, up) in the arm's plane.
    fn in_plane(&self, v: &Vector3) -> [f64; 2] {
        [self.x.dot(v), self.z.dot(v)]
    }

    /// The vector that points at this angle in the arm's plane, and the one a right angle further.
    fn pointing(&self, angle: f64) -> [Vector3; 2] {
        let (sin, cos) = sin_cos(angle);
        [self.x * sin + self.z * cos, self.x * cos - self.z * sin]
    }

    fn base_from_shoulder(&self) -> Pose {
        Pose::from_parts(self.origin.into(), frame(&self.x, &self.y, &self.z))
    }
}

/// The angle at which (out, up) points.
fn direction([out, up]: [f64; 2]) -> f64 {
    atan2(out, up)
}

/// Dimensions and zeros of the arm with these axes, in the terms of [`SphericalWristGeometry`].
fn spherical_wrist(at_zero: &JointAxes<6>, centre: &Vector3) -> SphericalWristGeometry {
    let [a1, a2, a3, a4, a5, a6] = &at_zero.axes;
    // The front is where axis 2 lies or, if it crosses axis 1, where the wrist is at zero.
    let unsided = ShoulderFrame::of(a1, a2, 1.0);
    let out_of = |point: &Vector3| unsided.x.dot(&(point - unsided.origin));
    let offset = out_of(&a2.point);
    let side = 1.0_f64.copysign(if offset.abs() > NO_OFFSET { offset } else { out_of(centre) });
    let shoulder = ShoulderFrame::of(a1, a2, side);
    let upper_arm = shoulder.in_plane(&(a3.point - a2.point));
    let theta2 = direction(upper_arm);
    // The forearm's z axis is axis 4, in the direction in which axis 6 continues it.
    let along = 1.0_f64.copysign(a4.direction.dot(&a6.direction));
    let theta23 = direction(shoulder.in_plane(&(a4.direction * along)));
    let [fore_z, fore_x] = shoulder.pointing(theta23);
    let elbow_to_wrist = centre - a3.point;
    let theta4 = atan2(-a5.direction.dot(&fore_x), a5.direction.dot(&shoulder.y));
    let (sin4, cos4) = sin_cos(theta4);
    let wrist_x = fore_x * cos4 + shoulder.y * sin4;
    let theta5 = atan2(a6.direction.dot(&wrist_x), a6.direction.dot(&fore_z));
    let last_y = square_to(&a5.direction, &a6.direction);
    let last = frame(&last_y.cross(&a6.direction), &last_y, &a6.direction);
    let base_from_wrist = Pose::from_parts((*centre).into(), last);
    SphericalWristGeometry {
        shoulder_offset: offset * side,
        upper_arm: hypot(upper_arm[0], upper_arm[1]),
        elbow_offset: fore_x.dot(&elbow_to_wrist),
        forearm: fore_z.dot(&elbow_to_wrist),
        lateral_offset: shoulder.y.dot(&(centre - shoulder.origin)),
        base_from_shoulder: shoulder.base_from_shoulder(),
        wrist_from_flange: base_from_wrist.inverse() * at_zero.base_from_flange,
        signs: [1.0, side, side * 1.0_f64.copysign(a2.direction.dot(&a3.direction)), along, 1.0, 1.0],
        zeros: [0.0, theta2, theta23 - theta2, theta4, theta5, 0.0],
    }
}

/// Dimensions and zeros of the arm with these axes, in the terms of [`ThreeParallelGeometry`].
fn three_parallel(at_zero: &JointAxes<6>, on_axis_4: &Vector3, on_axis_6: &Vector3) -> ThreeParallelGeometry {
    let [a1, a2, a3, a4, a5, a6] = &at_zero.axes;
    let shoulder = ShoulderFrame::of(a1, a2, 1.0);
    let upper = shoulder.in_plane(&(a3.point - a2.point));
    let fore = shoulder.in_plane(&(on_axis_4 - a3.point));
    let (theta2, theta23) = (direction(upper), direction(fore));
    let alpha = direction(shoulder.in_plane(&a5.direction));
    let [wrist_z, wrist_x] = shoulder.pointing(alpha);
    let theta5 = atan2(-a6.direction.dot(&wrist_x), a6.direction.dot(&shoulder.y));
    let last_z = square_to(&a5.direction, &a6.direction);
    let last = frame(&a6.direction.cross(&last_z), &a6.direction, &last_z);
    let base_from_wrist = Pose::from_parts((*on_axis_6).into(), last);
    let turns_like_2 = |axis: &JointAxis| 1.0_f64.copysign(axis.direction.dot(&a2.direction));
    ThreeParallelGeometry {
        shoulder_offset: shoulder.x.dot(&(a2.point - shoulder.origin)),
        links: TwoLink { upper: hypot(upper[0], upper[1]), fore: hypot(fore[0], fore[1]) },
        lateral_offset: shoulder.y.dot(&(on_axis_4 - shoulder.origin)),
        wrist_offset: wrist_z.dot(&(on_axis_6 - on_axis_4)),
        shoulder_from_base: shoulder.base_from_shoulder().inverse(),
        flange_from_wrist: at_zero.base_from_flange.inverse() * base_from_wrist,
        signs: [1.0, 1.0, turns_like_2(a3), turns_like_2(a4), 1.0, 1.0],
        zeros: [0.0, theta2, theta23 - theta2, alpha - theta23, theta5, 0.0],
    }
}

/// The part of a vector that is square to a unit vector, of length one.
fn square_to(v: &Vector3, unit: &Vector3) -> Vector3 {
    (v - unit * v.dot(unit)).normalize()
}

/// The rotation whose columns these unit vectors are.
fn frame(x: &Vector3, y: &Vector3, z: &Vector3) -> Rotation {
    let matrix = nalgebra::Matrix3::from_columns(&[*x, *y, *z]);
    Rotation::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix))
}
