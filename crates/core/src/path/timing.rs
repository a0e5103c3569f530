//! Motion along a path in time: the path coordinate as polynomial pieces.

/// The motion along a path at one instant; the unit of length is the path coordinate's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathState {
    /// Path coordinate s.
    pub position: f64,
    /// ṡ, per second.
    pub velocity: f64,
    /// s̈, per second².
    pub acceleration: f64,
    /// s⃛, per second³.
    pub jerk: f64,
}

/// A stretch of motion along the path: a polynomial of degree five in time, given by its derivatives at the start.
///
/// A plain S-curve has pieces of constant jerk (`snap` and `crackle` are zero). From piece to piece position, velocity
/// and acceleration are continuous; the jerk may step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimingPiece {
    /// Duration in seconds.
    pub duration: f64,
    /// Path coordinate at the start.
    pub position: f64,
    /// First derivative at the start.
    pub velocity: f64,
    /// Second derivative at the start.
    pub acceleration: f64,
    /// Third derivative at the start.
    pub jerk: f64,
    /// Fourth derivative at the start.
    pub snap: f64,
    /// Fifth derivative, the same all along the piece.
    pub crackle: f64,
}

impl TimingPiece {
    /// The state `time` seconds after the piece's start.
    #[must_use]
    pub fn at(&self, time: f64) -> PathState {
        let t = time;
        let jerk = self.jerk + t * (self.snap + t * self.crackle / 2.0);
        let acceleration =
            self.acceleration + t * (self.jerk + t * (self.snap / 2.0 + t * self.crackle / 6.0));
        let velocity = self.velocity
            + t * (self.acceleration
                + t * (self.jerk / 2.0 + t * (self.snap / 6.0 + t * self.crackle / 24.0)));
        let position = self.position
            + t * (self.velocity
                + t * (self.acceleration / 2.0
                    + t * (self.jerk / 6.0 + t * (self.snap / 24.0 + t * self.crackle / 120.0))));
        PathState { position, velocity, acceleration, jerk }
    }

    /// The state at the piece's end.
    #[must_use]
    pub fn end(&self) -> PathState {
        self.at(self.duration)
    }
}
