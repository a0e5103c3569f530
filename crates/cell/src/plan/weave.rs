//! Weaving in a job: from a condition to the weave of each part of a run.

use seamline::path::Curve;
use seamline::weave::{Pattern, Weave, WeaveShape};

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::planner::Planner;
use super::run::Piece;
use super::workspace;
use crate::cell::{self, CartesianLimits, WeavePattern, WeaveRate, WeaveSide};
use crate::job::WeaveCondition;

/// What would agree is said this much below the bound.
const ROOM: f64 = 0.99;

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
}

impl WeaveOrder {
    /// The cell's condition with what is written in the line.
    ///
    /// # Errors
    /// The cell has no such condition, or neither it nor the line gives amplitude and frequency.
    pub(super) fn try_new(condition: &WeaveCondition, cell: &cell::Cell) -> Result<Self, Problem> {
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
        }
    }

    /// The weave at a speed of travel from one place of the seam to another.
    ///
    /// # Errors
    /// No such weave, or one that does not agree with the cell's limits, and what would.
    fn weave(&self, speed: f64, length: f64, limits: &CartesianLimits) -> Result<Weave, Problem> {
        let frequency = match self.rate {
            WeaveRate::Frequency(frequency) => frequency,
            WeaveRate::Wavelength(wavelength) => speed / wavelength,
        };
        let shape = WeaveShape {
            pattern: self.pattern,
            amplitude: self.amplitude,
            wavelength: speed / frequency,
            dwells: self.dwells.map(|seconds| seconds * frequency),
            tilt: self.tilt,
            elevation: self.elevation,
            right_first: self.right_first,
        };
        let weave = Weave::try_new(&shape, 0.0, length)
            .map_err(|error| Problem::Weave(format!("{}: {error}", self.name)))?;
        self.agree(&weave, speed, frequency, limits)?;
        Ok(weave)
    }

    fn agree(
        &self,
        weave: &Weave,
        speed: f64,
        frequency: f64,
        limits: &CartesianLimits,
    ) -> Result<(), Problem> {
        let peaks = weave.peaks(speed);
        let asked = [
            (peaks.velocity, limits.speed, "a speed", "mm/s", "speed_mm_s"),
            (peaks.acceleration, limits.acceleration, "an acceleration", "mm/s2", "acceleration_mm_s2"),
            (peaks.jerk, limits.weave_jerk, "a jerk", "mm/s3", "weave_jerk_mm_s3"),
        ];
        // Along the order of the derivatives each permits so much of the amplitude, and its root of the frequency.
        let shares = asked.map(|(asked, permitted, ..)| permitted / asked);
        let Some(worst) =
            (0..asked.len()).filter(|&k| shares[k] < 1.0).min_by(|&a, &b| shares[a].total_cmp(&shares[b]))
        else {
            return Ok(());
        };
        let slower = [shares[0], shares[1].sqrt(), shares[2].cbrt()].into_iter().fold(1.0, f64::min);
        let (asked, permitted, what, unit, key) = asked[worst];
        let height = if self.elevation == 0.0 { "" } else { " with its elevation in proportion" };
        Err(Problem::Weave(format!(
            "{} asks for {what} of {:.0} {unit} across the seam at {:.1} mm/s, the cell permits {:.0} (cartesian.{key}); it \
             works with an amplitude of {:.2} mm{height}, or with {:.2} Hz",
            self.name,
            asked * 1e3,
            speed * 1e3,
            permitted * 1e3,
            self.amplitude * shares[worst] * ROOM * 1e3,
            frequency * slower * ROOM,
        )))
    }

    /// How far the torch may be from the seam, in metres.
    fn reach(&self) -> f64 {
        self.amplitude.hypot(self.elevation.abs())
    }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// Lays the weave that is on over the run, which is known to its end: over each part that goes on straight or round at one speed. It swings in
    /// and out at the part's ends, so that corners are passed on the seam.
    pub(super) fn weave_run(&mut self) -> Result<(), PlanError> {
        let Some(order) = self.weave.clone() else { return Ok(()) };
        let (limits, safety) = (&self.cell.cartesian, &self.cell.safety);
        let woven = self.run.weave(|parts| {
            let spline = |piece: &&Piece<N>| matches!(piece.path.curve(), Curve::Quintic(_));
            if parts.iter().find(spline).is_some() {
                return Err(Problem::Weave("a weave goes along MOVL and MOVC".into()));
            }
            let length = parts.iter().map(|piece| piece.path.length()).sum();
            for piece in parts {
                workspace::check_path_with_room(&piece.path, order.reach(), safety)?;
            }
            order.weave(parts[0].limits.speed, length, limits)
        });
        woven.map_err(|(index, problem)| self.give_up(index, problem))
    }
}
