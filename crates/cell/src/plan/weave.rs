//! Weaving in a job: from a condition to the weave of each part of a run.

use std::f64::consts::TAU;

use nalgebra::Complex;
use seamline::control::ActsOn;
use seamline::geometry::PoseJet;
use seamline::path::{Curve, Path, SeamFrame};
use seamline::vibration::Kernel;
use seamline::weave::{Pattern, Weave, WeaveShape};

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::planner::{Planned, Planner};
use super::run::Piece;
use super::workspace;
use crate::cell::{self, CartesianLimits, Cell, Vibration, WeavePattern, WeaveRate, WeaveSide};
use crate::job::WeaveCondition;

/// What would agree is said this much below the bound.
const ROOM: f64 = 0.99;
/// The search for a wavelength that agrees: how many times as long at most, and how many halvings.
const MOST_LONGER: f64 = 1e3;
const HALVINGS: usize = 40;
/// A weave goes over a corner whose radius is so many times (1/0.2) the weave's reach,
const MOST_BENT: f64 = 0.2;
/// and whose beginning and end ask for this share of the weave's jerk.
const JOLT: f64 = 0.05;
/// Places looked at along a piece.
const LOOKS: u32 = 16;
/// Of what prefilters do to a weave: what is worth a word, and what must be left.
const WORTH_A_WORD: f64 = 0.02;
const LEAST_LEFT: f64 = 0.5;
/// Samples and harmonics of a period for that; ramps of a weave in periods.
const SAMPLES: usize = 256;
const HARMONICS: usize = 32;
const RAMPS: f64 = 2.0;
/// A turn that is worth a word, in radians a metre.
const SLIGHT_TURN: f64 = 1.0;

/// A weave as ordered by WVON: it becomes a shape where the speed of travel is known.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WeaveOrder {
    /// As reports name it.
    name: String,
    pattern: Pattern,
    amplitude: f64,
    rate: WeaveRate,
    /// Seconds at the left edge, in the middle and at the right edge.
    dwells: [f64; 3],
    tilt: f64,
    elevation: f64,
    right_first: bool,
    /// How far it has come in its pattern, in periods.
    phase: f64,
    /// What was said last of what prefilters leave of it.
    damped: Option<String>,
}

impl WeaveOrder {
    /// The cell's condition with what is written in the line.
    ///
    /// # Errors
    /// The cell has no such condition, or neither it nor the line gives amplitude and frequency.
    pub(super) fn try_new(condition: &WeaveCondition, cell: &Cell) -> Result<Self, Problem> {
        let mut order = match condition.file {
            Some(number) => {
                let missing = Problem::UnknownCondition { kind: "WEV", number, table: "[[weave]]" };
                Self::of_cell(cell.weave(number).ok_or(missing)?)
            }
            None if condition.amplitude_mm.is_some() && condition.frequency_hz.is_some() => Self::plain(),
            None => {
                return Err(Problem::Weave(
                    "WVON has no condition: expected WEV#(n), or AMP= and FREQ=".into(),
                ));
            }
        };
        order.amplitude = condition.amplitude_mm.map_or(order.amplitude, |mm| mm / 1000.0);
        order.rate = condition.frequency_hz.map_or(order.rate, WeaveRate::Frequency);
        order.tilt = condition.angle_deg.map_or(order.tilt, f64::to_radians);
        order.right_first = condition.right_first.unwrap_or(order.right_first);
        Ok(order)
    }

    /// A sine whose size the line gives.
    fn plain() -> Self {
        Self {
            name: "the weave".into(),
            pattern: Pattern::Sine,
            amplitude: 0.0,
            rate: WeaveRate::Frequency(0.0),
            dwells: [0.0; 3],
            tilt: 0.0,
            elevation: 0.0,
            right_first: false,
            phase: 0.0,
            damped: None,
        }
    }

    fn of_cell(weave: &cell::Weave) -> Self {
        Self {
            name: format!("WEV#({})", weave.number),
            pattern: match weave.pattern {
                WeavePattern::Sine => Pattern::Sine,
                WeavePattern::Triangle => Pattern::Triangle,
                WeavePattern::FigureEight => Pattern::FigureEight,
                WeavePattern::Circular => Pattern::Circular,
            },
            amplitude: weave.amplitude,
            rate: weave.rate,
            dwells: [weave.dwell_left, weave.dwell_centre, weave.dwell_right],
            tilt: weave.angle,
            elevation: weave.elevation,
            right_first: weave.first_side == WeaveSide::Right,
            phase: 0.0,
            damped: None,
        }
    }

    fn frequency(&self, speed: f64) -> f64 {
        match self.rate {
            WeaveRate::Frequency(frequency) => frequency,
            WeaveRate::Wavelength(wavelength) => speed / wavelength,
        }
    }

    /// How it looks at a speed of travel.
    fn shape(&self, speed: f64) -> WeaveShape {
        let frequency = self.frequency(speed);
        let wavelength = match self.rate {
            WeaveRate::Frequency(frequency) => speed / frequency,
            WeaveRate::Wavelength(wavelength) => wavelength,
        };
        WeaveShape {
            pattern: self.pattern,
            amplitude: self.amplitude,
            wavelength,
            dwells: self.dwells.map(|seconds| seconds * frequency),
            tilt: self.tilt,
            elevation: self.elevation,
            right_first: self.right_first,
        }
    }

    /// Lays the weave over the moves of a run: over each part on which it looks the same and that does not bend too sharply. It swings in and
    /// out at the part's ends; its phase goes on behind them.
    ///
    /// # Errors
    /// The number of the piece that a part begins with, and why there is no weave on it.
    fn lay<const N: usize>(
        &mut self,
        pieces: &mut [Piece<N>],
        cell: &Cell,
        out: &mut Vec<Planned<N>>,
    ) -> Result<(), (usize, Problem)> {
        let (mut from, period) = (0, cell.cycle.period);
        while let Some(first) = pieces.get(from) {
            let shape = self.shape(first.limits.speed);
            let goes_on = |piece: &&Piece<N>| {
                self.shape(piece.limits.speed) == shape && self.goes_over(piece, &cell.cartesian, period)
            };
            let count = pieces[from..].iter().take_while(goes_on).count();
            let part = &mut pieces[from..from + count.max(1)];
            let travels = part.iter().filter(|piece| piece.link.travels());
            let length: f64 = travels.map(|piece| piece.path.length()).sum();
            if count > 0 {
                let fault = |problem| (from, problem);
                let speed = part.iter().map(|piece| piece.limits.speed).fold(0.0, f64::max);
                let weave = self.weave(part, speed, cell).map_err(fault)?;
                let damped = self.damped(speed, on_joints(&cell.vibration)).map_err(fault)?;
                if damped != self.damped {
                    let (at, notices) = (&part[0].link.step.at, damped.iter().cloned().collect());
                    out.push(Planned { notices, ..Planned::part(at) });
                    self.damped = damped;
                }
                let mut start = 0.0;
                for piece in part {
                    let length = piece.path.length();
                    piece.lay(&weave, start);
                    start += length;
                }
            }
            self.phase = (self.phase + length / shape.wavelength).fract();
            from += count.max(1);
        }
        Ok(())
    }

    /// A weave goes along a move, and over a corner that bends so little that neither its bend nor the jolt where the bend begins and ends
    /// matters to the torch: the more so, the wider the weave.
    fn goes_over<const N: usize>(&self, piece: &Piece<N>, limits: &CartesianLimits, period: f64) -> bool {
        if !piece.is_corner() {
            return piece.link.travels();
        }
        let (reach, speed) = (self.reach(), piece.limits.speed);
        let bend = |jet: &PoseJet| jet.linear[1].norm();
        // At the ends the bend's change steps; moves have none, but for a circle's own towards its middle.
        let change = |s: f64| {
            let [x, _, change] = piece.path.seam_jet(s).linear;
            (change - x * x.dot(&change)).norm()
        };
        let jolt = f64::max(change(0.0), change(piece.path.length())) * reach * speed * speed / period;
        looks(&piece.path).all(|jet| bend(&jet) * reach <= MOST_BENT) && jolt <= JOLT * limits.weave_jerk
    }

    /// The weave of a part with its greatest speed, that goes on with the phase.
    ///
    /// # Errors
    /// No such weave, or one that does not agree with the cell's limits, and what would.
    fn weave<const N: usize>(&self, part: &[Piece<N>], speed: f64, cell: &Cell) -> Result<Weave, Problem> {
        let (mut length, mut turn_rate) = (0.0, 0.0);
        for piece in part {
            if matches!(piece.path.curve(), Curve::Quintic(_)) && !piece.is_corner() {
                return Err(Problem::Weave("a weave goes along MOVL and MOVC".into()));
            }
            for jet in looks(&piece.path) {
                let along = || Problem::Weave(format!("{}: the seam goes along the wire here", self.name));
                turn_rate = f64::max(turn_rate, SeamFrame::turn_rate(&jet).ok_or_else(along)?);
            }
            workspace::check_path_with_room(&piece.path, self.reach(), &cell.safety)?;
            length += piece.path.length();
        }
        let shape = self.shape(speed);
        let weave = Weave::try_new(&shape, 0.0, length)
            .map_err(|error| Problem::Weave(format!("{}: {error}", self.name)))?;
        self.agree(&weave, speed, turn_rate, &cell.cartesian)?;
        Ok(weave.at_phase(self.phase))
    }

    /// What is to be said of what prefilters leave of a weave.
    ///
    /// # Errors
    /// It is less than [`LEAST_LEFT`] of the amplitude.
    fn damped(&self, speed: f64, kernels: &[Kernel]) -> Result<Option<String>, Problem> {
        if kernels.is_empty() {
            return Ok(None);
        }
        let frequency = self.frequency(speed);
        let left = left(&self.shape(speed), frequency, kernels);
        if left > 1.0 - WORTH_A_WORD {
            return Ok(None);
        }
        let amplitude = self.amplitude * 1e3;
        let text = format!(
            "the prefilter leaves {:.2} mm of the {amplitude:.2} mm of {} at {frequency:.2} Hz ({:.0} %)",
            amplitude * left,
            self.name,
            left * 100.0
        );
        if left < LEAST_LEFT {
            return Err(Problem::Weave(format!("{text}: expected at least {:.0} %", LEAST_LEFT * 100.0)));
        }
        Ok(Some(format!("{text}; {:.2} mm would leave it", amplitude / left)))
    }

    fn agree(
        &self,
        weave: &Weave,
        speed: f64,
        turn_rate: f64,
        limits: &CartesianLimits,
    ) -> Result<(), Problem> {
        let shares = |weave: &Weave| {
            let peaks = weave.peaks(speed, turn_rate);
            [
                limits.speed / peaks.velocity,
                limits.acceleration / peaks.acceleration,
                limits.weave_jerk / peaks.jerk,
            ]
        };
        let permitted = shares(weave);
        let Some(worst) = (0..permitted.len()).min_by(|&a, &b| permitted[a].total_cmp(&permitted[b])) else {
            return Ok(());
        };
        if permitted[worst] >= 1.0 {
            return Ok(());
        }
        let keeps = |wavelength: f64| {
            let frequency = speed / wavelength;
            let shape = WeaveShape {
                wavelength,
                dwells: self.dwells.map(|seconds| seconds * frequency),
                ..*weave.shape()
            };
            let weave = Weave::try_new(&shape, 0.0, weave.part().1);
            weave.is_ok_and(|weave| shares(&weave).iter().all(|share| *share >= 1.0))
        };
        let (limit, what, unit, key) = [
            (limits.speed, "a speed", "mm/s", "speed_mm_s"),
            (limits.acceleration, "an acceleration", "mm/s2", "acceleration_mm_s2"),
            (limits.weave_jerk, "a jerk", "mm/s3", "weave_jerk_mm_s3"),
        ][worst];
        let height = if self.elevation == 0.0 { "" } else { " with its elevation in proportion" };
        let bend = if turn_rate > SLIGHT_TURN {
            format!(" where seam and wire turn by {:.2} deg/mm", turn_rate.to_degrees() * 1e-3)
        } else {
            String::new()
        };
        let slower = match (longer(weave.shape().wavelength, keeps), self.rate) {
            (None, _) => String::new(),
            (Some(wavelength), WeaveRate::Frequency(_)) => {
                format!(", or with {:.2} Hz", speed / wavelength * ROOM)
            }
            (Some(wavelength), WeaveRate::Wavelength(_)) => {
                format!(", or with a wavelength of {:.2} mm", wavelength / ROOM * 1e3)
            }
        };
        Err(Problem::Weave(format!(
            "{} asks for {what} of {:.0} {unit} across the seam at {:.1} mm/s{bend}, the cell permits {:.0} (cartesian.{key}); it \
             works with an amplitude of {:.2} mm{height}{slower}",
            self.name,
            limit / permitted[worst] * 1e3,
            speed * 1e3,
            limit * 1e3,
            self.amplitude * permitted[worst] * ROOM * 1e3,
        )))
    }

    /// How far the torch may be from the seam, in metres.
    fn reach(&self) -> f64 {
        self.amplitude.hypot(self.elevation.abs())
    }
}

/// The least wavelength above one that keeps what is asked; `None` where a thousand times as much does not.
fn longer(wavelength: f64, keeps: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut short, mut long) = (wavelength, MOST_LONGER * wavelength);
    for _ in 0..HALVINGS {
        let middle = (short * long).sqrt();
        if keeps(middle) { long = middle } else { short = middle }
    }
    keeps(long).then_some(long)
}

/// The prefilters that damp a weave: on the feedrate they leave it as it is.
fn on_joints(vibration: &Vibration) -> &[Kernel] {
    if vibration.acts_on() == ActsOn::Joints { vibration.kernels() } else { &[] }
}

/// The share of a weave's amplitude that kernels one behind the other leave.
fn left(shape: &WeaveShape, frequency: f64, kernels: &[Kernel]) -> f64 {
    let plain = WeaveShape { amplitude: 1.0, tilt: 0.0, elevation: 0.0, ..*shape };
    // A period beyond the ramp.
    let period = |k: usize| (RAMPS + k as f64 / SAMPLES as f64) * shape.wavelength;
    let Ok(weave) = Weave::try_new(&plain, 0.0, 3.0 * RAMPS * shape.wavelength) else { return 1.0 };
    let across: Vec<f64> = (0..SAMPLES).map(|k| weave.offset(period(k))[1].value()).collect();
    let turned = |order: usize, k: usize| {
        Complex::from_polar(1.0, TAU * (order * k % SAMPLES) as f64 / SAMPLES as f64)
    };
    let parts: Vec<Complex<f64>> = (1..=HARMONICS)
        .map(|order| {
            let part: Complex<f64> = (0..SAMPLES).map(|k| turned(order, k).conj() * across[k]).sum();
            let through = Complex::new(0.0, TAU * frequency * order as f64);
            kernels.iter().fold(part * 2.0 / SAMPLES as f64, |part, kernel| part * kernel.transfer(through))
        })
        .collect();
    let mean = across.iter().sum::<f64>() / SAMPLES as f64;
    let out =
        |k: usize| mean + (1..=HARMONICS).map(|order| (parts[order - 1] * turned(order, k)).re).sum::<f64>();
    (0..SAMPLES).map(|k| out(k).abs()).fold(0.0, f64::max)
}

/// Places along the seam of a path.
fn looks(path: &Path) -> impl Iterator<Item = PoseJet> + '_ {
    (0..=LOOKS).map(|k| path.seam_jet(path.length() * f64::from(k) / f64::from(LOOKS)))
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// Lays the weave that is on over the run, which is known to its end.
    pub(super) fn weave_run(&mut self, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        let Some(order) = &mut self.weave else { return Ok(()) };
        let woven = order.lay(self.run.pieces(), self.cell, out);
        woven.map_err(|(index, problem)| self.give_up(index, problem))
    }
}
