//! What the generator is asked.

/// Position, velocity and acceleration of every axis at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<const N: usize> {
    /// Positions.
    pub position: [f64; N],
    /// Velocities.
    pub velocity: [f64; N],
    /// Accelerations.
    pub acceleration: [f64; N],
}

impl<const N: usize> State<N> {
    /// At rest in the given position.
    #[must_use]
    pub const fn at_rest(position: [f64; N]) -> Self {
        Self { position, velocity: [0.0; N], acceleration: [0.0; N] }
    }
}

impl<const N: usize> Default for State<N> {
    fn default() -> Self {
        Self::at_rest([0.0; N])
    }
}

/// What each axis may do. Every limit may be infinite; the lower ones are zero or negative.
///
/// An infinite jerk gives profiles of second order (the acceleration jumps, and those of the current and the target
/// state do not matter), an infinite acceleration too profiles of first order (the velocity jumps).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits<const N: usize> {
    /// Highest velocity, ≥ 0.
    pub velocity_max: [f64; N],
    /// Lowest velocity, ≤ 0.
    pub velocity_min: [f64; N],
    /// Highest acceleration, ≥ 0.
    pub acceleration_max: [f64; N],
    /// Lowest acceleration, ≤ 0.
    pub acceleration_min: [f64; N],
    /// Largest magnitude of the jerk, ≥ 0.
    pub jerk_max: [f64; N],
    /// Highest position; infinite if there is none.
    pub position_max: [f64; N],
    /// Lowest position; minus infinity if there is none.
    pub position_min: [f64; N],
}

impl<const N: usize> Limits<N> {
    /// Limits that are the same in both directions, and no position limits.
    #[must_use]
    pub fn symmetric(velocity: [f64; N], acceleration: [f64; N], jerk: [f64; N]) -> Self {
        Self {
            velocity_max: velocity,
            velocity_min: velocity.map(|v| -v),
            acceleration_max: acceleration,
            acceleration_min: acceleration.map(|a| -a),
            jerk_max: jerk,
            position_max: [f64::INFINITY; N],
            position_min: [f64::NEG_INFINITY; N],
        }
    }
}

/// What an axis is to reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Control {
    /// Target position, velocity and acceleration.
    #[default]
    Position,
    /// Target velocity and acceleration; the position is free, and only acceleration and jerk are limited on the way.
    Velocity,
}

/// How the axes' durations, and their paths, hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Synchronization {
    /// The axis takes its own minimum time.
    None,
    /// The axis ends together with all others that are synchronized, at the first instant that all of them can meet.
    #[default]
    Time,
    /// As `Time` if the axis' target velocity or acceleration is not zero; otherwise the axis may arrive earlier.
    TimeIfNecessary,
    /// All axes of this kind keep to the straight line p₀ + s(t) (p_f − p₀); as `Time` if the problem is not collinear.
    Phase,
    /// As `Phase`, and an error if the problem is not collinear.
    PhaseStrict,
}

/// One problem for the generator: from the current to the target state within limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input<const N: usize> {
    /// What each axis is to reach.
    pub control: [Control; N],
    /// How each axis is synchronized.
    pub synchronization: [Synchronization; N],
    /// Axes that are not enabled are not planned: they go on from their current state at constant acceleration.
    pub enabled: [bool; N],
    /// Where the motion starts. It may be outside the limits: a brake phase then comes first.
    pub current: State<N>,
    /// Where it ends. Positions do not matter in velocity control.
    pub target: State<N>,
    /// Whether the target goes on at its velocity from now on, so that the axis has to meet it where it will be then. For targets
    /// that move and are sent anew on every cycle: the plan then stays the same as long as the target keeps its velocity. In velocity
    /// control it does not matter. See `docs/otg.md`, section 13.
    pub target_moves: [bool; N],
    /// The limits.
    pub limits: Limits<N>,
    /// The motion shall take at least this long, in seconds.
    pub duration_min: Option<f64>,
    /// The motion shall take a whole number of these, in seconds.
    pub duration_step: Option<f64>,
}

impl<const N: usize> Input<N> {
    /// Position control, synchronized in time, all axes enabled.
    #[must_use]
    pub fn new(current: State<N>, target: State<N>, limits: Limits<N>) -> Self {
        Self {
            control: [Control::Position; N],
            synchronization: [Synchronization::Time; N],
            enabled: [true; N],
            current,
            target,
            target_moves: [false; N],
            limits,
            duration_min: None,
            duration_step: None,
        }
    }
}
