//! A tool path as the joints see it: one branch from start to end.

use seamline::geometry::{Pose, PoseJet};
use seamline::kinematics::{InverseError, JointJet, Kinematics};
use seamline::path::{Measure, Path};

use super::timing::JointPath;

/// Greatest change of a joint between two places of the table, rad: far below what separates two branches.
const STEP: f64 = 0.1;
/// Distance of the table's places, at most: metres, and radians of the tool's turn.
const SPACING: f64 = 5e-3;
const TURN_SPACING: f64 = 0.02;
/// A step is halved this often before a change is called a jump: 5 mm become 5 nm.
const HALVINGS: u32 = 20;
/// A joint this near to its limit, in rad, is what made the branch end.
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
    path: Path,
    tcp_from_flange: Pose,
    /// Joints at rising path coordinates, from 0 to the length.
    table: Vec<(f64, [f64; N])>,
}

impl<'a, const N: usize, K: Kinematics<N>> PathJoints<'a, N, K> {
    /// Follows the path from joint positions `start` on.
    ///
    /// # Errors
    /// The path coordinate where the joints cannot follow any further, and why.
    pub fn follow(
        kinematics: &'a K,
        path: &Path,
        flange_from_tcp: &Pose,
        start: &[f64; N],
    ) -> Result<Self, (f64, FollowError)> {
        let mut joints = Self {
            kinematics,
            path: *path,
            tcp_from_flange: flange_from_tcp.inverse(),
            table: vec![(0.0, *start)],
        };
        let length = path.length();
        let steps = joints.steps();
        let mut at = 0.0;
        for step in 1..=steps {
            // The last place is the end itself, not the sum of steps.
            let to = if step == steps { length } else { length * step as f64 / steps as f64 };
            joints.follow_to(&mut at, to)?;
        }
        Ok(joints)
    }

    /// How many places the table has at least.
    fn steps(&self) -> usize {
        let length = self.path.length();
        let turn = self.path.pose(0.0).rotation.angle_to(&self.path.pose(length).rotation);
        let by_length = if self.path.measure() == Measure::Length { length / SPACING } else { 0.0 };
        // A path longer than 100 m gets a coarser table, which halving refines where needed.
        by_length.max(turn / TURN_SPACING).ceil().clamp(32.0, 20_000.0) as usize
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
                    return Err((next, self.reason(result.map(|(q, _)| q))));
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

    /// The joints at `s` nearest to the last ones, and the greatest change.
    fn solve(&self, s: f64) -> Result<([f64; N], f64), InverseError> {
        let q = self.kinematics.inverse_nearest(&(self.path.pose(s) * self.tcp_from_flange), self.last())?;
        let change = q.iter().zip(self.last()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        Ok((q, change))
    }

    fn reason(&self, result: Result<[f64; N], InverseError>) -> FollowError {
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
        self.path.jet(s).attached(&self.tcp_from_flange)
    }

    /// Joints near `s`, between the table's places.
    fn seed(&self, s: f64) -> [f64; N] {
        let after = self.table.partition_point(|(at, _)| *at <= s).clamp(1, self.table.len() - 1);
        let ((s0, q0), (s1, q1)) = (self.table[after - 1], self.table[after]);
        let share = ((s - s0) / (s1 - s0)).clamp(0.0, 1.0);
        std::array::from_fn(|joint| q0[joint] + share * (q1[joint] - q0[joint]))
    }
}

impl<const N: usize, K: Kinematics<N>> JointPath<N> for PathJoints<'_, N, K> {
    type Error = InverseError;

    fn length(&self) -> f64 {
        self.path.length()
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<N>, InverseError> {
        let flange = self.flange(s);
        let q = self.kinematics.inverse_nearest(&flange.pose, &self.seed(s))?;
        self.kinematics.joint_jet(&flange, &q)
    }
}
