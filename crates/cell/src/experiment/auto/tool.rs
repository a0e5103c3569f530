//! How the tool accelerates while the command's acceleration stays the same for a step.

use seamline::vibration::Mode;

/// The tool's acceleration a and b = ȧ/ω follow the command's acceleration U: ä + 2ζω ȧ + ω² a = ω² U. With U constant over a step
/// (a, b) goes on as U·(1, 0) + Φ·(a − U, b).
#[derive(Debug, Clone, Copy)]
pub(super) struct ToolStep {
    phi: [[f64; 2]; 2],
}

impl ToolStep {
    pub(super) fn new(mode: &Mode, step: f64) -> Self {
        let (zeta, ratio) = (mode.damping(), mode.damped_ratio());
        let decay = (-zeta * mode.omega() * step).exp();
        let (sin, cos) = (ratio * mode.omega() * step).sin_cos();
        let (same, other) = (decay * zeta / ratio * sin, decay / ratio * sin);
        Self { phi: [[decay * cos + same, other], [-other, decay * cos - same]] }
    }

    /// Φ, row by row.
    pub(super) fn phi(&self) -> [[f64; 2]; 2] {
        self.phi
    }

    /// What a unit of acceleration during one step adds to (a, b) at the end of it.
    pub(super) fn input(&self) -> [f64; 2] {
        [1.0 - self.phi[0][0], -self.phi[1][0]]
    }

    /// (a, b) one step on, without acceleration of the command.
    pub(super) fn free(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let [[aa, ab], [ba, bb]] = self.phi;
        [aa * a + ab * b, ba * a + bb * b]
    }
}
