//! What can go wrong, with its evidence.

/// A posture in which the flange loses a direction of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Singularity {
    /// Axes 4 and 6 in one line.
    Wrist,
    /// Arm stretched or folded: the two links in one line.
    Elbow,
    /// The wrist centre on axis 1 (or, with a lateral offset, as near to it as it can come).
    Shoulder,
    /// A general chain's Jacobian has lost rank.
    Rank,
}

/// Why there are no joint positions, or no joint derivatives, for a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InverseError {
    /// A coordinate of the pose or of the seed is not a finite number.
    NotFinite,
    /// The arm cannot stretch or fold so far: the distance that its two links would have to bridge, and the least
    /// and greatest they can, in metres.
    OutOfReach {
        /// Distance to bridge.
        distance: f64,
        /// Least distance, links folded.
        least: f64,
        /// Greatest distance, links stretched.
        greatest: f64,
    },
    /// The wrist centre lies nearer to axis 1 than the lateral offset between axis 1 and the arm's plane, in metres.
    InsideLateralOffset {
        /// The wrist centre's distance from axis 1.
        radius: f64,
        /// The arm's lateral offset.
        offset: f64,
    },
    /// The flange would have to turn in a direction that the arm does not have; radians.
    OutOfOrientation {
        /// Angle by which the nearest orientation misses.
        angle: f64,
    },
    /// The flange would have to move in a direction that fewer than six joints do not have.
    NotFollowed {
        /// Length of the twist (metres and radians per unit of the parameter, or its derivative) left over.
        missing: f64,
    },
    /// The numeric solver came no nearer.
    NotConverged {
        /// Iterations taken, over all starts.
        iterations: usize,
        /// Distance left from the best start, in metres.
        position_residual: f64,
        /// Angle left from it, in radians.
        rotation_residual: f64,
    },
    /// Every branch passes a joint's limit. Evidence is of the branch nearest to the seed.
    PositionLimit {
        /// Index of the joint that passes its limit furthest.
        axis: usize,
        /// Position it would need, in the turn nearest to its range.
        value: f64,
        /// Least position.
        min: f64,
        /// Greatest position.
        max: f64,
    },
    /// Exactly singular: joint derivatives do not exist.
    Singular {
        /// Which singularity.
        singularity: Singularity,
        /// Its distance measure: |sin θ5| at the wrist, |sin| of the angle between the links at the elbow, metres
        /// at the shoulder; for a general chain what is left of a Jacobian's column outside the others' span.
        distance: f64,
    },
}

/// Why a set of numbers is not an arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModelError {
    /// A dimension, offset or frame is not a finite number.
    NotFinite,
    /// A joint's axis has no direction.
    Axis {
        /// Index of the joint.
        axis: usize,
    },
    /// A length that must be positive.
    Length {
        /// The length in metres.
        value: f64,
    },
    /// A direction sign that is neither +1 nor −1.
    Sign {
        /// Index of the joint.
        axis: usize,
        /// The sign.
        value: f64,
    },
    /// Position limits that enclose nothing.
    PositionLimits {
        /// Index of the joint.
        axis: usize,
        /// Least position.
        min: f64,
        /// Greatest position.
        max: f64,
    },
    /// A velocity limit that is not positive.
    VelocityLimit {
        /// Index of the joint.
        axis: usize,
        /// The limit.
        value: f64,
    },
}
