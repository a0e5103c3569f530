//! The coordinate in which the optimizer works: a smooth, monotone s(w).
//!
//! w is close to the time that the motion will take, so that even knots in w are even in time, and rest is an
//! ordinary point: there s = s_w = s_ww = 0 and s_www is not. s(w) is a uniform quintic B-spline, hence C⁴,
//! and it is monotone where its control points are.

use super::motion::{PathState, TimingPiece, duration};

/// What the motion does at an end of a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// It rests.
    Rest,
    /// It runs at this speed, without acceleration.
    Cruise(f64),
}

impl End {
    /// An end without acceleration at a speed.
    pub(super) fn at(speed: f64) -> Self {
        if speed == 0.0 { Self::Rest } else { Self::Cruise(speed) }
    }

    pub(super) fn speed(self) -> f64 {
        match self {
            Self::Rest => 0.0,
            Self::Cruise(speed) => speed,
        }
    }

    pub(super) fn rests(self) -> bool {
        self == Self::Rest
    }
}

/// s and its derivatives with respect to w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CoordinateJet {
    pub(super) s: f64,
    pub(super) d1: f64,
    pub(super) d2: f64,
    pub(super) d3: f64,
}

/// Controls at either end that continue the motion beyond it.
const PAD: usize = 2;

/// s(w) on knots w = 0, h, 2h, …
#[derive(Debug, Clone)]
pub(super) struct Coordinate {
    pub(super) step: f64,
    /// One control a knot, and [`PAD`] more at either end.
    controls: Vec<f64>,
}

impl Coordinate {
    /// Number of sites: knots and the middles between them.
    pub(super) fn sites(&self) -> usize {
        2 * self.knots() - 1
    }

    /// Number of knots.
    pub(super) fn knots(&self) -> usize {
        self.controls.len() - 2 * PAD
    }

    /// Through samples `s` of the motion at even times `step`, one a knot, which it follows as a spline of
    /// controls does: smoothly, not exactly. The ends are met exactly.
    pub(super) fn new(samples: &[f64], step: f64, ends: [End; 2]) -> Self {
        let mut controls = vec![0.0; samples.len() + 2 * PAD];
        controls[PAD..PAD + samples.len()].copy_from_slice(samples);
        let (start, end) = (samples[0], samples[samples.len() - 1]);
        close(&mut controls, start, step, ends[0]);
        controls.reverse();
        close(&mut controls, end, -step, ends[1]);
        controls.reverse();
        Self { step, controls }
    }

    /// From a motion in time: nearly the motion itself, unless that would turn back between two knots.
    pub(super) fn following(pieces: &[TimingPiece], knots: usize, ends: [End; 2]) -> Self {
        let step = duration(pieces) / (knots - 1) as f64;
        let mut states = Vec::with_capacity(knots);
        let (mut index, mut begun) = (0, 0.0);
        for knot in 0..knots {
            let time = knot as f64 * step;
            while index + 1 < pieces.len() && time > begun + pieces[index].duration {
                begun += pieces[index].duration;
                index += 1;
            }
            states.push(pieces[index].at((time - begun).min(pieces[index].duration)));
        }
        let mut samples: Vec<f64> = states.iter().map(|state| quasi_interpolant(state, step)).collect();
        // At rest the first control lies before the end: see `close`.
        if samples[1..knots - 1].windows(2).any(|pair| pair[1] <= pair[0]) {
            samples = states.iter().map(|state| state.position).collect();
        }
        samples[0] = pieces[0].position;
        samples[knots - 1] = pieces[pieces.len() - 1].end().position;
        Self::new(&samples, step, ends)
    }

    /// s and its derivatives at a site: knot k is site 2k, the middle between two knots lies between.
    pub(super) fn at(&self, site: usize) -> CoordinateJet {
        let h = self.step;
        let c = &self.controls[site / 2..];
        // Differences first: near a singularity neighbours differ in the last digits only.
        let first: [f64; 4] = core::array::from_fn(|i| c[i + 1] - c[i]);
        let second: [f64; 3] = core::array::from_fn(|i| first[i + 1] - first[i]);
        let third: [f64; 2] = core::array::from_fn(|i| second[i + 1] - second[i]);
        if site.is_multiple_of(2) {
            return CoordinateJet {
                s: c[2] + (first[3] - first[0] + 27.0 * (first[2] - first[1])) / 120.0,
                d1: (first[0] + 11.0 * (first[1] + first[2]) + first[3]) / (24.0 * h),
                d2: (second[0] + 4.0 * second[1] + second[2]) / (6.0 * h * h),
                d3: (third[0] + third[1]) / (2.0 * h * h * h),
            };
        }
        let first4 = c[5] - c[4];
        let second3 = first4 - first[3];
        let third2 = second3 - second[2];
        CoordinateJet {
            s: c[2] + first[2] / 2.0 + (first4 - first[0] + 238.0 * (first[3] - first[1])) / 3840.0,
            d1: (first[0] + first4 + 76.0 * (first[1] + first[3]) + 230.0 * first[2]) / (384.0 * h),
            d2: (second[0] + second3 + 23.0 * (second[1] + second[2])) / (48.0 * h * h),
            d3: (third[0] + 6.0 * third[1] + third2) / (8.0 * h * h * h),
        }
    }
}

/// The control that lets a quintic B-spline reproduce cubics: f − h²/4 f″.
fn quasi_interpolant(state: &PathState, step: f64) -> f64 {
    state.position - step * step / 4.0 * state.acceleration
}

/// Sets the controls at the first end: `place` is the coordinate there, `step` the time from knot to knot, negative
/// at the other end.
fn close(controls: &mut [f64], place: f64, step: f64, end: End) {
    match end {
        End::Rest => {
            // Odd about the end, so that s = place and s_ww = 0; s_w = 0 asks for the first neighbour. A
            // cubic t³ has these very controls, k³ − 3k/2.
            let second = controls[PAD + 2] - place;
            controls[PAD] = place;
            controls[PAD + 1] = place - second / 10.0;
            controls[PAD - 1] = place + second / 10.0;
            controls[PAD - 2] = place - second;
        }
        End::Cruise(speed) => {
            for (index, control) in controls[..=2 * PAD].iter_mut().enumerate() {
                *control = place + speed * step * (index as f64 - PAD as f64);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From rest a cubic t³ is reproduced to rounding, derivatives and half knots included.
    #[test]
    fn a_cubic_from_rest_is_reproduced() {
        let step = 0.004;
        let cubic = |t: f64| PathState {
            position: 2.0 * t.powi(3),
            velocity: 6.0 * t * t,
            acceleration: 12.0 * t,
            jerk: 12.0,
        };
        let samples: Vec<f64> =
            (0..30).map(|knot| quasi_interpolant(&cubic(f64::from(knot) * step), step)).collect();
        let coordinate = Coordinate::new(&samples, step, [End::Rest; 2]);
        // The last eight sites feel that the motion is to stop there.
        for site in 0..coordinate.sites() - 8 {
            let (found, wanted) = (coordinate.at(site), cubic(site as f64 * step / 2.0));
            assert!((found.s - wanted.position).abs() < 1e-16, "{site}");
            assert!((found.d1 - wanted.velocity).abs() < 1e-13, "{site}");
            assert!((found.d2 - wanted.acceleration).abs() < 1e-10, "{site}");
            assert!((found.d3 - wanted.jerk).abs() < 1e-7, "{site}");
        }
        let end = coordinate.at(coordinate.sites() - 1);
        assert_eq!(end.s, samples[29]);
        assert!(end.d1.abs() < 1e-13 && end.d2.abs() < 1e-10);
    }

    #[test]
    fn a_cruise_is_met_exactly() {
        let (step, speed) = (0.005, 0.3);
        let samples: Vec<f64> = (0..20).map(|knot| 1.0 + f64::from(knot) * step * speed).collect();
        let coordinate = Coordinate::new(&samples, step, [End::Cruise(speed); 2]);
        for site in 0..coordinate.sites() {
            let jet = coordinate.at(site);
            assert!((jet.s - 1.0 - site as f64 * step * speed / 2.0).abs() < 1e-14);
            assert!((jet.d1 - speed).abs() < 1e-12 && jet.d2.abs() < 1e-9 && jet.d3.abs() < 1e-6);
        }
    }
}
