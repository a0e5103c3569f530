//! Against Pinocchio: `tests/data/kinematics.csv`, made by `tests/data/make_kinematics.py`.

use nalgebra::{Quaternion, UnitQuaternion};
use seamline::geometry::Pose;
use seamline::kinematics::{JointJet, Kinematics, SerialChain, models};

use crate::support::pose_error;

const DATA: &str = include_str!("../data/kinematics.csv");

/// Reads numbers off the front of a row.
struct Numbers<'a>(std::str::Split<'a, char>);

impl Numbers<'_> {
    fn take<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.0.next().unwrap().parse().unwrap())
    }
}

/// Every row of one arm: forward 1e-12, Jacobian and acceleration 1e-12.
fn check<const N: usize>(name: &str, arm: &impl Kinematics<N>) {
    let mut rows = 0;
    for line in DATA.lines().filter(|line| line.split(',').next() == Some(name)) {
        let mut numbers = Numbers(line.split(','));
        numbers.0.next();
        assert_eq!(numbers.take::<1>()[0], N as f64);
        let q: [f64; N] = numbers.take();
        let position = numbers.take::<3>();
        let [x, y, z, w] = numbers.take();
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let axes = arm.axes(&q);
        for pose in [arm.forward(&q), axes.base_from_flange] {
            let (distance, angle) = pose_error(&pose, &Pose::from_parts(position.into(), rotation));
            assert!(distance < 1e-14 && angle < 1e-14, "{name} {q:?}: {distance:e} {angle:e}");
        }
        let jacobian = axes.jacobian();
        for row in 0..6 {
            for (column, expected) in numbers.take::<N>().into_iter().enumerate() {
                assert!((jacobian[(row, column)] - expected).abs() < 1e-14, "{name} {row} {column}");
            }
        }
        let (velocity, acceleration) = (numbers.take(), numbers.take());
        let joints = JointJet { velocity, acceleration, ..JointJet::at_rest(q) };
        let motion = axes.forward_jet(&joints);
        let bias = axes.jacobian_derivative(&velocity) * nalgebra::SVector::<f64, N>::from(velocity);
        let by_jacobian = jacobian * nalgebra::SVector::<f64, N>::from(acceleration) + bias;
        for (row, expected) in numbers.take::<6>().into_iter().enumerate() {
            let forward = if row < 3 { motion.linear[1][row] } else { motion.angular[1][row - 3] };
            assert!((forward - expected).abs() < 1e-13, "{name} {row}: {forward} {expected}");
            assert!((by_jacobian[row] - expected).abs() < 1e-13, "{name} {row}");
        }
        assert_eq!(numbers.0.next(), None);
        rows += 1;
    }
    assert_eq!(rows, 25, "{name}");
}

#[test]
fn built_in_arms_agree_with_pinocchio() {
    check("ar2010", &models::ar2010());
    check("irb2400", &models::irb2400());
    check("ur5e", &models::ur5e());
    check("scara600", &models::scara600());
}

#[test]
fn chains_of_the_arms_agree_with_pinocchio() {
    let arm = models::ar2010();
    check("ar2010", &SerialChain::from_axes(&arm.axes(&[0.0; 6]), *arm.limits()).unwrap());
    let arm = models::scara600();
    check("scara600", &SerialChain::from_axes(&arm.axes(&[0.0; 4]), *arm.limits()).unwrap());
}
