//! A flexible tool: each direction is a damped oscillator that follows the command.

use nalgebra::Vector3;
use seamline::vibration::Mode;

/// Steps of the integration in one cycle: at 60 Hz and 1 ms, relative errors of 1e-9 a period.
const STEPS: u32 = 8;

/// ÿ + 2ζω ẏ + ω² y = ω² x in each direction, where x is the commanded position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plant {
    mode: Mode,
    command: Vector3<f64>,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
}

impl Plant {
    /// At rest where the command stands.
    #[must_use]
    pub fn at_rest(mode: Mode, position: Vector3<f64>) -> Self {
        Self { mode, command: position, position, velocity: Vector3::zeros() }
    }

    /// One cycle on, with the command straight from its last value to this one; gives the acceleration there, in m/s².
    pub fn step(&mut self, command: Vector3<f64>, period: f64) -> Vector3<f64> {
        let from = self.command;
        let at = |share: f64| from + share * (command - from);
        let h = period / f64::from(STEPS);
        for n in 0..STEPS {
            let [start, middle, end] =
                [0.0, 0.5, 1.0].map(|part| at((f64::from(n) + part) / f64::from(STEPS)));
            self.runge_kutta(&start, &middle, &end, h);
        }
        self.command = command;
        self.acceleration(&self.position, &self.velocity, &command)
    }

    fn runge_kutta(&mut self, start: &Vector3<f64>, middle: &Vector3<f64>, end: &Vector3<f64>, h: f64) {
        let (x, v) = (self.position, self.velocity);
        let a1 = self.acceleration(&x, &v, start);
        let v2 = v + 0.5 * h * a1;
        let a2 = self.acceleration(&(x + 0.5 * h * v), &v2, middle);
        let v3 = v + 0.5 * h * a2;
        let a3 = self.acceleration(&(x + 0.5 * h * v2), &v3, middle);
        let v4 = v + h * a3;
        let a4 = self.acceleration(&(x + h * v3), &v4, end);
        self.position += h / 6.0 * (v + 2.0 * (v2 + v3) + v4);
        self.velocity += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    }

    fn acceleration(&self, x: &Vector3<f64>, v: &Vector3<f64>, command: &Vector3<f64>) -> Vector3<f64> {
        let omega = self.mode.omega();
        omega * omega * (command - x) - 2.0 * self.mode.damping() * omega * v
    }
}
