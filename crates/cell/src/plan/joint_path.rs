//! A tool path as the joints see it: one branch from start to end.

use seamline::geometry::{Pose, PoseJet};
use seamline::kinematics::{InverseError, JointJet};
use seamline::path::{Measure, Path};

use super::arm::PlanningArm;
use super::route::Route;
use super::timing::JointPath;

/// Greatest change of a joint between two places of the table, rad or m: far below what separates two branches.
const STEP: f64 = 0.1;
/// Distance of the table's places, at most: metres, and radians of the tool's turn.
const SPACING: f64 = 5e-3;
const TURN_SPACING: f64 = 0.02;
/// Fewest and most places of one path.
const STEPS: [f64; 2] = [4.0, 20_000.0];
/// A step is halved this often before a change is called a jump: 5 mm become 5 nm.
const HALVINGS: u32 = 20;
/// At the last halving a branch goes on in another one if no joint changes by more than this, rad or m: the path crosses the
/// singularity itself, missing it by a hundredth of the smallest step at most, and the joints do not feel it.
const CROSSING: f64 = 1e-2;
/// A joint this near to its limit, in rad or m, is what made the branch end.
const AT_LIMIT: f64 = 1e-3;

/// Why the joints cannot follow a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FollowError {
    /// The arm does not reach the pose.
    Inverse(InverseError),
    /// A joint comes to its limit and cannot go on.
    JointLimit {
        /// The joint, counted from 0.
        joint: usize,
        /// The limit it comes to.
        limit: f64,
    },
    /// The joints would have to jump to another branch: the path crosses a singularity.
    Jump {
        /// The joint that would jump furthest, counted from 0.
        joint: usize,
    },
}

/// A path in space, its tool and its arm, with the joints along it.
#[derive(Debug, Clone)]
pub struct PathJoints<'a, const N: usize, K> {
    kinematics: &'a K,
    route: Route,
    tcp_from_flange: Pose,
    /// Joints at rising path coordinates, from 0 to the length.
    table: Vec<(f64, [f64; N])>,
}

impl<'a, const N: usize, K: PlanningArm<N>> PathJoints<'a, N, K> {
    /// Follows the path from joint positions `start` on.
    ///
    /// # Errors
    /// The path coordinate where the joints cannot follow any further, and why.
    pub fn follow(
        kinematics: &'a K,
        route: impl Into<Route>,
        flange_from_tcp: &Pose,
        start: &[f64; N],
    ) -> Result<Self, (f64, FollowError)> {
        let mut joints = Self {
            kinematics,
            route: route.into(),
            tcp_from_flange: flange_from_tcp.inverse(),
            table: vec![(0.0, *start)],
        };
        let mut at = 0.0;
        for index in 0..joints.route.paths().len() {
            let (from, end) = (joints.route.start_of(index), joints.route.ends()[index]);
            let steps = steps(&joints.route.paths()[index]);
            for step in 1..=steps {
                // The last place is the end itself, not the sum of steps.
                let to = if step == steps { end } else { from + (end - from) * step as f64 / steps as f64 };
                joints.follow_to(&mut at, to)?;
            }
        }
        Ok(joints)
    }

    /// The same joints, of a route that is the beginning of the one that was followed.
    #[must_use]
    pub fn over(self, route: Route) -> Self {
        Self { route, ..self }
    }

    fn follow_to(&mut self, at: &mut f64, to: f64) -> Result<(), (f64, FollowError)> {
        let whole = to - *at;
        let mut step = whole;
        while *at < to {
            let next = if *at + step >= to { to } else { *at + step };
            match self.solve(next) {
                Ok((q, change)) if change <= STEP => {
                    self.table.push((next, q));
                    *at = next;
                    step = (step * 2.0).min(whole);
                }
                result if step < whole * 0.5_f64.powi(HALVINGS as i32) => {
                    let Some(q) = self.crossing(next) else {
                        return Err((next, self.reason(result.map(|(q, _)| q))));
                    };
                    self.table.push((next, q));
                    *at = next;
                }
                _ => step /= 2.0,
            }
        }
        Ok(())
    }

    fn last(&self) -> &[f64; N] {
        // `follow` puts the start into the table before anything else.
        self.table.last().map_or(&[0.0; N], |(_, q)| q)
    }

    /// The joints at `s` on the last ones' branch, and the greatest change.
    fn solve(&self, s: f64) -> Result<([f64; N], f64), InverseError> {
        let q = self.kinematics.same_branch(&(self.route.pose(s) * self.tcp_from_flange), self.last())?;
        Ok((q, self.change(&q)))
    }

    /// The joints at `s` on whatever branch, if they hardly differ from the last ones.
    fn crossing(&self, s: f64) -> Option<[f64; N]> {
        let pose = self.route.pose(s) * self.tcp_from_flange;
        self.kinematics.inverse_nearest(&pose, self.last()).ok().filter(|q| self.change(q) < CROSSING)
    }

    fn change(&self, q: &[f64; N]) -> f64 {
        q.iter().zip(self.last()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    fn reason(&self, result: Result<[f64; N], InverseError>) -> FollowError {
        match result {
            Ok(_) | Err(InverseError::PositionLimit { .. }) => {}
            Err(error) => return FollowError::Inverse(error),
        }
        let last = self.last();
        let limits = self.kinematics.position_limits();
        for joint in 0..N {
            for limit in [limits[joint].0, limits[joint].1] {
                if (last[joint] - limit).abs() < AT_LIMIT {
                    return FollowError::JointLimit { joint, limit };
                }
            }
        }
        match result {
            Err(error) => FollowError::Inverse(error),
            Ok(q) => {
                let change = |joint: &usize| (q[*joint] - last[*joint]).abs();
                let joint = (0..N).max_by(|a, b| change(a).total_cmp(&change(b))).unwrap_or(0);
                FollowError::Jump { joint }
            }
        }
    }

    /// The joints at the path's end.
    #[must_use]
    pub fn end(&self) -> [f64; N] {
        *self.last()
    }

    /// The flange's motion along the path coordinate.
    fn flange(&self, s: f64) -> PoseJet {
        self.route.jet(s).attached(&self.tcp_from_flange)
    }

    /// Joints near `s`, between the table's places.
    fn seed(&self, s: f64) -> [f64; N] {
        let after = self.table.partition_point(|(at, _)| *at <= s).clamp(1, self.table.len() - 1);
        let ((s0, q0), (s1, q1)) = (self.table[after - 1], self.table[after]);
        let share = ((s - s0) / (s1 - s0)).clamp(0.0, 1.0);
        std::array::from_fn(|joint| q0[joint] + share * (q1[joint] - q0[joint]))
    }
}

/// How many places of a path the table has at least.
fn steps(path: &Path) -> usize {
    let length = path.length();
    let turn = path.pose(0.0).rotation.angle_to(&path.pose(length).rotation);
    let by_length = if path.measure() == Measure::Length { length / SPACING } else { 0.0 };
    // A path longer than 100 m gets a coarser table, which halving refines where needed.
    by_length.max(turn / TURN_SPACING).ceil().clamp(STEPS[0], STEPS[1]) as usize
}

impl<const N: usize, K: PlanningArm<N>> JointPath<N> for PathJoints<'_, N, K> {
    type Error = InverseError;

    fn length(&self) -> f64 {
        self.route.length()
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<N>, InverseError> {
        let flange = self.flange(s);
        let q = self.kinematics.inverse_nearest(&flange.pose, &self.seed(s))?;
        self.kinematics.joint_jet(&flange, &q)
    }
}

#[cfg(test)]
mod tests {
    use seamline::geometry::{Rotation, Vector3};
    use seamline::kinematics::{Kinematics, SixAxisArm, models};

    use super::*;

    /// Lines past the wrist's pole at distances from 0.1 rad to 1e-5 rad, and right through it: the joints change by
    /// less than a step from place to place, keep their branch beside the pole and change it only on it.
    #[test]
    fn a_line_past_the_wrist_pole_keeps_its_branch() {
        let arm = SixAxisArm::from(models::ar2010());
        for distance in [0.1, 1e-2, 1e-3, 1e-4, 1e-5, 0.0] {
            // The flange tilts by the path's own turning, so that q5 passes `distance` in the middle.
            let middle = arm.forward(&[0.1, 0.2, 0.1, 0.0, distance, 0.3]);
            let tilt = middle.rotation * Vector3::x();
            let turned = |angle: f64| {
                let turn = Rotation::from_scaled_axis(tilt * angle);
                Pose::from_parts(middle.translation, turn * middle.rotation)
            };
            let (start, end) = (turned(-0.4), turned(0.4));
            let path = Path::line(&start, &Pose::from_parts(end.translation, end.rotation));
            let seed = arm.inverse_nearest(&start, &[0.1, 0.2, 0.1, -1.5, 0.4, 1.8]).unwrap();
            let joints = PathJoints::follow(&arm, path, &Pose::identity(), &seed);
            let joints = joints.unwrap_or_else(|error| panic!("{distance}: {error:?}"));
            for pair in joints.table.windows(2) {
                let change = (0..6).map(|k| (pair[1].1[k] - pair[0].1[k]).abs()).fold(0.0, f64::max);
                assert!(change <= STEP, "{distance}: {change} at {}", pair[0].0);
            }
            let (first, last) = (joints.table[0].1[4], joints.end()[4]);
            assert_eq!(first * last > 0.0, distance > 0.0, "{distance}: q5 from {first} to {last}");
        }
    }
}
