//! A planar arm of two links on a straight line: small enough to be checked by hand.

use seamline::kinematics::JointJet;
use seamline_cell::plan::timing::JointPath;

/// The line starts at `start` and goes along `direction` (a unit vector).
#[derive(Clone)]
pub(crate) struct Planar {
    pub(crate) links: [f64; 2],
    pub(crate) start: [f64; 2],
    pub(crate) direction: [f64; 2],
    pub(crate) length: f64,
}

impl JointPath<2> for Planar {
    /// Out of reach.
    type Error = ();

    fn length(&self) -> f64 {
        self.length
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<2>, ()> {
        let [a, b] = self.links;
        let (x, y) = (self.start[0] + self.direction[0] * s, self.start[1] + self.direction[1] * s);
        let cosine = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
        if cosine.abs() >= 1.0 {
            return Err(());
        }
        let elbow = cosine.acos();
        let first = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
        let absolute = [first, first + elbow];
        let along = absolute.map(|angle| [angle.cos(), angle.sin()]);
        let across = absolute.map(|angle| [-angle.sin(), angle.cos()]);
        // a φ₁ n₁ + b φ₂ n₂ = r for the rates φ of the links' absolute angles, n across the links.
        let determinant = a * b * (across[0][0] * across[1][1] - across[0][1] * across[1][0]);
        let solve = |r: [f64; 2]| {
            [
                (r[0] * across[1][1] - r[1] * across[1][0]) * b / determinant,
                (r[1] * across[0][0] - r[0] * across[0][1]) * a / determinant,
            ]
        };
        // Each link's end l e(φ) has the derivatives l φ′ n, l (φ″ n − φ′² e), l ((φ‴ − φ′³) n − 3 φ′ φ″ e).
        let d1 = solve(self.direction);
        let d2 = solve(core::array::from_fn(|i| {
            a * d1[0] * d1[0] * along[0][i] + b * d1[1] * d1[1] * along[1][i]
        }));
        let d3 = solve(core::array::from_fn(|i| {
            let link = |k: usize| d1[k].powi(3) * across[k][i] + 3.0 * d1[k] * d2[k] * along[k][i];
            a * link(0) + b * link(1)
        }));
        let relative = |d: [f64; 2]| [d[0], d[1] - d[0]];
        Ok(JointJet {
            position: relative(absolute),
            velocity: relative(d1),
            acceleration: relative(d2),
            jerk: relative(d3),
        })
    }
}
