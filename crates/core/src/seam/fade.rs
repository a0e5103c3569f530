//! The way from where the lane is to where the seam is.
//!
//! The rest r = lane − seam goes to zero on the polynomial of degree five that has the last three control points' rests and ends at w with
//! zero value, slope and curvature: r(x) = (1 − x/w)³ p(x), p the parabola through pᵢ = rᵢ/(1 + iΔ/w)³ at x = 0, −Δ, −2Δ. One knot
//! on it is
//!
//! r₊ = (1 − Δ/w)³ (3p₀ − 3p₁ + p₂).
//!
//! Taken anew from the points that came out, with w shorter by Δ, it goes on along itself; and where the seam turns out to run elsewhere, it
//! bends to there.

use super::Offset;

/// Shortest fade, in metres.
pub(super) const SHORTEST: f64 = 8e-3;
/// Lengthenings tried, by a fifth each: to 80 times the shortest.
const LENGTHENINGS: usize = 24;

/// What is left to fade out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fade {
    /// Distance left from the last control point, in metres.
    pub(super) left: f64,
}

impl Fade {
    /// A fade over a length in metres, or longer.
    pub(super) fn over(length: f64) -> Self {
        Self { left: length.max(SHORTEST) }
    }

    /// Length in metres that a fade of these rests takes at least.
    pub(super) fn needed(rests: &[Offset; 3], spacing: f64, third: f64, step: f64) -> f64 {
        let mut fade = Self::over(SHORTEST);
        fade.lengthen(rests, spacing, third, step);
        fade.left
    }

    /// The rest at the next control point, from those at the last three (newest first); `None` where the fade ends there. Where third
    /// differences would pass `third` or first differences `step`, it becomes longer.
    pub(super) fn next(
        &mut self,
        rests: &[Offset; 3],
        spacing: f64,
        third: f64,
        step: f64,
    ) -> Option<Offset> {
        self.lengthen(rests, spacing, third, step);
        let w = self.left;
        self.left -= spacing;
        if self.left <= 0.0 {
            return None;
        }
        let [p0, p1, p2] = parabola(rests, spacing, w);
        Some((p0 * 3.0 - p1 * 3.0 + p2) * cube(1.0 - spacing / w))
    }

    fn lengthen(&mut self, rests: &[Offset; 3], spacing: f64, third: f64, step: f64) {
        for _ in 0..LENGTHENINGS {
            let (slope, jerk) = peaks(rests, spacing, self.left);
            if slope * spacing <= step && jerk * spacing * spacing * spacing <= third {
                break;
            }
            self.left *= 1.2;
        }
    }
}

fn parabola(rests: &[Offset; 3], spacing: f64, w: f64) -> [Offset; 3] {
    let [r0, r1, r2] = *rests;
    [r0, r1 / cube(1.0 + spacing / w), r2 / cube(1.0 + 2.0 * spacing / w)]
}

/// Greatest |r′| (from above) and |r‴| on the way.
fn peaks(rests: &[Offset; 3], spacing: f64, w: f64) -> (f64, f64) {
    let [p0, p1, p2] = parabola(rests, spacing, w);
    // r = (1 − u)³ (α + βu + γu²) with u = x/w.
    let scale = w / spacing;
    let alpha = p0;
    let beta = (p0 * 3.0 - p1 * 4.0 + p2) * (0.5 * scale);
    let gamma = (p0 - p1 * 2.0 + p2) * (0.5 * scale * scale);
    let c3 = beta * 3.0 - alpha - gamma * 3.0;
    let c4 = gamma * 3.0 - beta;
    let c5 = -gamma;
    let third = |u: f64| (c3 * 6.0 + (c4 * 24.0 + c5 * (60.0 * u)) * u).norm();
    let jerk = [0.0, 0.25, 0.5, 0.75, 1.0].map(third).into_iter().fold(0.0, f64::max);
    // |r′| = |(1 − u)²(−3p + (1 − u)p′)| with p, p′ by their greatest terms.
    let slope = [0.0, 0.2, 0.4, 0.6, 0.8].map(|u: f64| {
        let p = alpha + (beta + gamma * u) * u;
        let dp = beta + gamma * (2.0 * u);
        ((dp * (1.0 - u) - p * 3.0) * ((1.0 - u) * (1.0 - u))).norm()
    });
    (slope.into_iter().fold(0.0, f64::max) / w, jerk / (w * w * w))
}

fn cube(x: f64) -> f64 {
    x * x * x
}
