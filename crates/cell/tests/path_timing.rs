//! Path-true speed on arms and paths of the tests' own.

use seamline::kinematics::JointJet;
use seamline_cell::plan::timing::{JointPath, PathLimits, TimingLimits, time_path};

/// A planar arm of two links on a straight line; exact derivatives from its two absolute link angles.
struct Planar {
    links: [f64; 2],
    start: [f64; 2],
    direction: [f64; 2],
    length: f64,
}

impl JointPath<2> for Planar {
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
        let second = first + elbow;
        let (e, n) = (
            [[first.cos(), first.sin()], [second.cos(), second.sin()]],
            [[-first.sin(), first.cos()], [-second.sin(), second.cos()]],
        );
        // a φ₁ n₁ + b φ₂ n₂ = r
        let determinant = a * b * (n[0][0] * n[1][1] - n[0][1] * n[1][0]);
        let solve = |r: [f64; 2]| {
            [
                (r[0] * n[1][1] - r[1] * n[1][0]) * b / determinant,
                (r[1] * n[0][0] - r[0] * n[0][1]) * a / determinant,
            ]
        };
        let d1 = solve(self.direction);
        let d2 = solve(core::array::from_fn(|i| a * d1[0] * d1[0] * e[0][i] + b * d1[1] * d1[1] * e[1][i]));
        let d3 = solve(core::array::from_fn(|i| {
            let link = |k: usize, l: f64| l * (d1[k].powi(3) * n[k][i] + 3.0 * d1[k] * d2[k] * e[k][i]);
            link(0, a) + link(1, b)
        }));
        let relative = |d: [f64; 2]| [d[0], d[1] - d[0]];
        Ok(JointJet {
            position: relative([first, second]),
            velocity: relative(d1),
            acceleration: relative(d2),
            jerk: relative(d3),
        })
    }
}

#[test]
fn first() {
    let joints = TimingLimits { velocity: [3.0, 4.0], acceleration: [20.0, 25.0], jerk: [1000.0, 1250.0] };
    for offset in [0.3, 0.1, 0.03, 0.01, 0.003] {
        for speed in [0.25, 1.0] {
            let mut path = Planar {
                links: [0.5, 0.45],
                start: [-0.4, 0.1 + offset],
                direction: [1.0, 0.0],
                length: 0.8,
            };
            let limits = PathLimits { speed, acceleration: 10.0, jerk: 500.0 };
            let begun = std::time::Instant::now();
            let timing = time_path(&mut path, &joints, &limits).unwrap();
            println!(
                "offset {offset} speed {speed} {:?} {} in {:?}",
                timing.kind(),
                timing.duration(),
                begun.elapsed()
            );
            println!("{:?} pieces {}", timing.slowdowns(), timing.pieces().len());
        }
    }
}
