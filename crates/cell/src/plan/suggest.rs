//! What would make a move possible: another torch angle, or another configuration.

use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::path::Path;

use super::arm::PlanningArm;
use super::joint_path::PathJoints;
use super::timing::JointPath as _;

/// Torch tilts that are tried, in degrees, the smallest first.
const TILTS_DEG: [f64; 4] = [3.0, 6.0, 10.0, 15.0];
/// Places along the path at which the speed is asked for.
const PLACES: u32 = 200;

/// A move that does not work, or not at its speed.
#[derive(Debug)]
pub(super) struct Trouble<'a, const N: usize, K> {
    pub(super) kinematics: &'a K,
    pub(super) path: Path,
    pub(super) flange_from_tcp: &'a Pose,
    /// Joints at the start.
    pub(super) start: [f64; N],
    /// Programmed speed along the path.
    pub(super) speed: f64,
}

impl<const N: usize, K: PlanningArm<N>> Trouble<'_, N, K> {
    /// The mildest change with which the whole move holds its speed, in words.
    pub(super) fn suggestion(&self) -> Option<String> {
        self.tilt().or_else(|| self.configuration())
    }

    /// The suggestion as the end of a sentence; empty where there is none.
    pub(super) fn remedy(&self) -> String {
        self.suggestion().map_or_else(String::new, |suggestion| format!("; {suggestion}"))
    }

    fn tilt(&self) -> Option<String> {
        let axes = [("x", Vector3::x()), ("y", Vector3::y())];
        for degrees in TILTS_DEG {
            for (name, axis) in axes {
                for degrees in [degrees, -degrees] {
                    let path = self.path.tilted(&Rotation::from_scaled_axis(axis * degrees.to_radians()));
                    let start = path.pose(0.0) * self.flange_from_tcp.inverse();
                    let found = self.kinematics.inverse_nearest(&start, &self.start).ok();
                    if found.is_some_and(|start| self.holds(&path, &start)) {
                        return Some(format!(
                            "it works with the torch tilted by {degrees:.0} deg about its {name} axis"
                        ));
                    }
                }
            }
        }
        None
    }

    fn configuration(&self) -> Option<String> {
        let start = self.path.pose(0.0) * self.flange_from_tcp.inverse();
        let branches = self.kinematics.inverse_branches(&start, &self.start).ok()?;
        let own = self.kinematics.configuration(&self.start);
        let other = |q: &&[f64; N]| self.kinematics.configuration(q) != own;
        let works = branches.as_slice().iter().filter(other).find(|q| self.holds(&self.path, q))?;
        let c = self.kinematics.configuration(works);
        let flags = [c.no_flip, c.lower_arm, c.rear, c.r_beyond_180, c.t_beyond_180, c.s_beyond_180];
        let digits: Vec<_> = flags.map(|flag| if flag { "1" } else { "0" }).into();
        Some(format!("it works if the move starts in the configuration RCONF {}", digits.join(",")))
    }

    /// The joints can follow the whole path at its speed.
    fn holds(&self, path: &Path, start: &[f64; N]) -> bool {
        let Ok(mut joints) = PathJoints::follow(self.kinematics, path, self.flange_from_tcp, start) else {
            return false;
        };
        let limits = self.kinematics.velocity_limits();
        (0..=PLACES).all(|k| {
            let jet = joints.jet(path.length() * f64::from(k) / f64::from(PLACES));
            jet.is_ok_and(|jet| (0..N).all(|joint| jet.velocity[joint].abs() * self.speed <= limits[joint]))
        })
    }
}

#[cfg(test)]
mod tests {
    use seamline::kinematics::{Kinematics as _, SixAxisArm, models};

    use super::*;

    /// A 300 mm line whose middle passes the wrist's pole at `distance` rad.
    fn line(arm: &SixAxisArm, distance: f64) -> (Path, [f64; 6]) {
        let middle = arm.forward(&[0.1, 0.3, 0.2, 1.2, distance, 0.3]);
        let shift = Vector3::new(0.0, 0.15, 0.0);
        let at =
            |sign: f64| Pose::from_parts((middle.translation.vector + shift * sign).into(), middle.rotation);
        let start = arm.inverse_nearest(&at(-1.0), &[0.1, 0.3, 0.2, 1.2, distance, 0.3]).unwrap();
        (Path::line(&at(-1.0), &at(1.0)), start)
    }

    #[test]
    fn the_suggested_tilt_keeps_the_speed() {
        let arm = SixAxisArm::from(models::ar2010());
        let flange_from_tcp = Pose::identity();
        let (path, start) = line(&arm, 0.003);
        let trouble = |path: &Path, start: &[f64; 6], speed| Trouble {
            kinematics: &arm,
            path: *path,
            flange_from_tcp: &flange_from_tcp,
            start: *start,
            speed,
        };
        let near = trouble(&path, &start, 0.15);
        assert!(!near.holds(&path, &start), "too near to the pole for 150 mm/s");
        let words = near.suggestion().unwrap();
        let degrees: f64 = words.split(' ').find_map(|word| word.parse().ok()).unwrap();
        let axis = if words.contains("its x axis") { Vector3::x() } else { Vector3::y() };
        let tilted = path.tilted(&Rotation::from_scaled_axis(axis * degrees.to_radians()));
        let start = arm.inverse_nearest(&tilted.pose(0.0), &start).unwrap();
        assert!(near.holds(&tilted, &start), "{words}");
    }

    #[test]
    fn where_nothing_helps_nothing_is_suggested() {
        let arm = SixAxisArm::from(models::ar2010());
        let flange_from_tcp = Pose::identity();
        let (path, start) = line(&arm, 0.5);
        let speed = 1e3;
        let trouble = Trouble { kinematics: &arm, path, flange_from_tcp: &flange_from_tcp, start, speed };
        assert_eq!(trouble.suggestion(), None);
    }
}
