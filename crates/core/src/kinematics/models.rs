//! Built-in arms.

use core::f64::consts::{FRAC_PI_2, PI};

use super::chain::description::from_dh;
use super::{
    DhConvention, DhRow, JointKind, JointLimits, OpwParameters, ScaraArm, ScaraGeometry, SerialChain,
    SphericalWristArm, SphericalWristGeometry,
};
use crate::geometry::{Pose, Rotation, Vector3};

/// A Yaskawa AR2010/MA2010-class arc-welding arm: reach 2.01 m, joints S, L, U, R, B, T.
///
/// The base frame's origin lies on axis 1 at the height of axis 2, 505 mm above the floor. At zero the upper arm
/// stands up and the forearm points along +x: flange at (1.332, 0, 0.960) m, its z axis along +x and its x axis along
/// +z. Joint axes at zero: z, y, −y, −x, −y, −x.
#[must_use]
pub fn ar2010() -> SphericalWristArm {
    let geometry = SphericalWristGeometry {
        shoulder_offset: 0.150,
        upper_arm: 0.760,
        elbow_offset: -0.200,
        forearm: 1.082,
        lateral_offset: 0.0,
        base_from_shoulder: Pose::identity(),
        // Half a turn about z: the maker's flange x axis points up where the forearm lies level.
        wrist_from_flange: Pose::from_parts([0.0, 0.0, 0.100].into(), half_turn(2)),
        signs: [1.0, 1.0, -1.0, -1.0, -1.0, -1.0],
        zeros: [0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0],
    };
    let limits = limits_from_degrees(
        [(-180.0, 180.0), (-105.0, 155.0), (-86.0, 160.0), (-150.0, 150.0), (-135.0, 90.0), (-210.0, 210.0)],
        [210.0, 210.0, 220.0, 435.0, 435.0, 700.0],
    );
    SphericalWristArm::of_valid(geometry, limits)
}

/// The ABB IRB 2400/10 arm, 1.55 m: the usual yardstick for closed-form inverse kinematics.
#[must_use]
pub fn irb2400() -> SphericalWristArm {
    let parameters = OpwParameters {
        a1: 0.100,
        a2: -0.135,
        b: 0.0,
        c1: 0.615,
        c2: 0.705,
        c3: 0.755,
        c4: 0.085,
        offsets: [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, 0.0],
        signs: [1.0; 6],
    };
    let limits = limits_from_degrees(
        [(-180.0, 180.0), (-100.0, 110.0), (-60.0, 65.0), (-200.0, 200.0), (-120.0, 120.0), (-400.0, 400.0)],
        [150.0, 150.0, 150.0, 360.0, 360.0, 450.0],
    );
    SphericalWristArm::of_valid(parameters.geometry(), limits)
}

/// A Universal Robots UR5e: no spherical wrist; DH parameters as the maker publishes them.
#[must_use]
pub fn ur5e() -> SerialChain<6> {
    let row = |a, alpha, d| DhRow { a, alpha, d, theta: 0.0, kind: JointKind::Revolute };
    let rows = [
        row(0.0, FRAC_PI_2, 0.1625),
        row(-0.425, 0.0, 0.0),
        row(-0.3922, 0.0, 0.0),
        row(0.0, FRAC_PI_2, 0.1333),
        row(0.0, -FRAC_PI_2, 0.0997),
        row(0.0, 0.0, 0.0996),
    ];
    let limits = limits_from_degrees([(-360.0, 360.0); 6], [180.0; 6]);
    let (joints, flange) = from_dh(&rows, DhConvention::Standard);
    SerialChain::of_z_joints(&joints, &flange, limits)
}

/// A SCARA arm of 600 mm: links of 325 and 275 mm, flange looking down, joint 3 zero at the top.
///
/// At zero the arm is stretched along +x: flange at (0.6, 0, 0) m, its z axis along −z.
#[must_use]
pub fn scara600() -> ScaraArm {
    let geometry = ScaraGeometry {
        upper_arm: 0.325,
        forearm: 0.275,
        base_from_shoulder: Pose::identity(),
        last_from_flange: Pose::from_parts(Vector3::zeros().into(), half_turn(0)),
    };
    let (degree, turn) = (PI / 180.0, 2.0 * PI);
    let position =
        [(-132.0 * degree, 132.0 * degree), (-160.0 * degree, 160.0 * degree), (-0.200, 0.0), (-turn, turn)];
    let velocity = [240.0 * degree, 360.0 * degree, 1.0, 5.0 * turn];
    ScaraArm::of_valid(geometry, JointLimits::of_valid(position, velocity))
}

/// Half a turn about an axis of the frame, without rounding.
fn half_turn(axis: usize) -> Rotation {
    let mut imaginary = Vector3::zeros();
    imaginary[axis] = 1.0;
    Rotation::new_unchecked(nalgebra::Quaternion::from_imag(imaginary))
}

fn limits_from_degrees<const N: usize>(
    position_deg: [(f64, f64); N],
    velocity_deg: [f64; N],
) -> JointLimits<N> {
    let position = position_deg.map(|(min, max)| (min.to_radians(), max.to_radians()));
    JointLimits::of_valid(position, velocity_deg.map(f64::to_radians))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_valid() {
        for arm in [ar2010(), irb2400()] {
            let limits = JointLimits::try_new(*arm.limits().position(), *arm.limits().velocity());
            assert_eq!(limits, Ok(*arm.limits()));
            assert_eq!(SphericalWristArm::try_new(*arm.geometry(), *arm.limits()), Ok(arm));
        }
    }
}
