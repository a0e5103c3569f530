//! Figures of a run, taken from its samples as they come.

mod corner;
mod deviation;
mod joints;
mod moves;

pub use joints::{JointFigures, Peak, Travel};
pub use moves::MoveFigures;

use serde::Serialize;

use self::joints::{Differences, JointWatch, ORDERS, middle};
use self::moves::MoveWatch;
use super::info::{Event, RunInfo, SegmentInfo};
use super::plot::{Derived, PlotCollector, PlotData};
use super::sample::Sample;

/// Seam corrections and errors over the run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SeamFigures {
    /// Greatest correction across the seam.
    pub lateral_max_mm: f64,
    /// Greatest correction in height.
    pub height_max_mm: f64,
    /// Root mean square of the distance from the true seam, where it is known: while the arc is lit, or in a run without arc all along.
    pub error_rms_mm: Option<f64>,
    /// Greatest distance from the true seam, likewise.
    pub error_max_mm: Option<f64>,
}

/// Turns the stream of samples into figures and plot data. Takes memory for the segments and events of the run, and
/// a bounded amount beside them.
#[derive(Debug, Clone)]
pub struct Analysis {
    period: f64,
    differences: Differences,
    joints: JointWatch,
    moves: MoveWatch,
    seam: SeamWatch,
    plot: PlotCollector,
    cycles: u64,
    not_finite: u64,
    duration: f64,
}

/// All that an [`Analysis`] found.
#[derive(Debug, Clone)]
pub struct Findings {
    /// Cycles seen.
    pub cycles: u64,
    /// Samples in which a command or the tool's pose is no finite number: none, in a controller that works.
    pub not_finite: u64,
    /// Time of the last sample, in seconds.
    pub duration: f64,
    /// Figures of each joint; none where there was no sample.
    pub joints: Vec<JointFigures>,
    /// The segments that were executed, in order.
    pub segments: Vec<SegmentInfo>,
    /// The figures of these segments.
    pub moves: Vec<MoveFigures>,
    /// Seam figures, where there was a correction or a known error.
    pub seam: Option<SeamFigures>,
    /// Data for plots.
    pub plot: PlotData,
}

impl Analysis {
    /// An analysis of a run that is about to begin.
    #[must_use]
    pub fn new(run: &RunInfo) -> Self {
        Self {
            period: run.period,
            differences: Differences::new(run.period),
            joints: JointWatch::new(&run.joints, run.period),
            moves: MoveWatch::new(run.period),
            seam: SeamWatch::default(),
            plot: PlotCollector::new(run.joints.len()),
            cycles: 0,
            not_finite: 0,
            duration: 0.0,
        }
    }

    /// Announces a segment, at the latest before its first sample.
    pub fn segment(&mut self, segment: SegmentInfo) {
        self.moves.announce(segment);
    }

    /// Reports an event, at the latest before the first sample after its time.
    pub fn event(&mut self, event: Event) {
        self.plot.announce(event);
    }

    /// Takes the next cycle.
    pub fn sample(&mut self, sample: &Sample) {
        self.cycles += 1;
        self.duration = sample.time;
        let pose = &sample.tcp;
        let numbers = sample.command.iter().chain(&pose.translation.vector).chain(&pose.rotation.coords);
        self.not_finite += u64::from(!numbers.copied().all(f64::is_finite));
        let derivatives = self.differences.push(sample);
        self.joints.push(sample, &derivatives);
        let moment = self.moves.push(sample);
        self.seam.push(sample);
        let timed: [_; ORDERS] = std::array::from_fn(|order| {
            (middle(sample.time, order + 1, self.period), derivatives.values[order])
        });
        let derived = Derived {
            derivatives: &timed[..derivatives.orders],
            speed: (middle(sample.time, 1, self.period), moment.speed),
            deviation: moment.deviation,
            entered: moment.entered.as_ref(),
        };
        self.plot.push(sample, &derived);
    }

    /// The end of the run.
    #[must_use]
    pub fn finish(self) -> Findings {
        let (segments, moves) = self.moves.finish();
        Findings {
            cycles: self.cycles,
            not_finite: self.not_finite,
            duration: self.duration,
            joints: if self.cycles > 0 { self.joints.finish() } else { Vec::new() },
            segments,
            moves,
            seam: self.seam.finish(),
            plot: self.plot.finish(),
        }
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct SeamWatch {
    lateral: f64,
    height: f64,
    all: Errors,
    lit: Errors,
}

/// Distances from the true seam.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    greatest: f64,
    squares: f64,
    count: u64,
}

impl Errors {
    fn push(&mut self, error: f64) {
        self.count += 1;
        self.squares += error * error;
        self.greatest = self.greatest.max(error.abs());
    }
}

impl SeamWatch {
    fn push(&mut self, sample: &Sample) {
        self.lateral = self.lateral.max(sample.seam_lateral.abs());
        self.height = self.height.max(sample.seam_height.abs());
        if !sample.seam_error.is_nan() {
            self.all.push(sample.seam_error);
            if sample.arc {
                self.lit.push(sample.seam_error);
            }
        }
    }

    fn finish(self) -> Option<SeamFigures> {
        let errors = if self.lit.count > 0 { self.lit } else { self.all };
        let known = errors.count > 0;
        (known || self.lateral > 0.0 || self.height > 0.0).then(|| SeamFigures {
            lateral_max_mm: self.lateral * 1e3,
            height_max_mm: self.height * 1e3,
            error_rms_mm: known.then(|| (errors.squares / errors.count as f64).sqrt() * 1e3),
            error_max_mm: known.then_some(errors.greatest * 1e3),
        })
    }
}

#[cfg(test)]
mod tests;
