//! One number of axes: where a question meets the generator's const generic.

use std::hint::black_box;

use seamline::otg::{Input, Trajectory, calculate_into};
use serde::Serialize;

use super::answer::Answer;
use super::request::{AXES_MAX, Request};
use crate::json_lines::bench::Times;
use crate::json_lines::{Mistake, Object};

/// The generator for a number of axes.
pub(super) trait Axes {
    /// Answers a question.
    fn answer(&mut self, line: &Object<'_>) -> Result<Answer, Mistake>;

    /// Keeps a question to be measured.
    fn keep(&mut self, line: &Object<'_>) -> Result<(), Mistake>;

    /// Measures the questions kept; nothing if there are none.
    fn measure(&mut self) -> Option<Measured>;
}

/// All numbers of axes, from one.
pub(super) fn all() -> [Box<dyn Axes>; AXES_MAX] {
    [
        of::<1>(),
        of::<2>(),
        of::<3>(),
        of::<4>(),
        of::<5>(),
        of::<6>(),
        of::<7>(),
        of::<8>(),
        of::<9>(),
        of::<10>(),
        of::<11>(),
        of::<12>(),
        of::<13>(),
        of::<14>(),
        of::<15>(),
        of::<16>(),
    ]
}

fn of<const N: usize>() -> Box<dyn Axes> {
    Box::new(Generator::<N> { trajectory: Trajectory::default(), kept: Vec::new() })
}

struct Generator<const N: usize> {
    trajectory: Trajectory<N>,
    kept: Vec<Input<N>>,
}

/// What `--bench` prints.
#[derive(Serialize)]
pub(super) struct Measured {
    cases: usize,
    dofs: usize,
    #[serde(flatten)]
    times: Times,
}

impl<const N: usize> Axes for Generator<N> {
    fn answer(&mut self, line: &Object<'_>) -> Result<Answer, Mistake> {
        let request = Request::read(line)?;
        calculate_into(&request.input, &mut self.trajectory)
            .map_err(|error| Mistake::new(error.to_string()))?;
        Answer::of(&self.trajectory, &request)
    }

    fn keep(&mut self, line: &Object<'_>) -> Result<(), Mistake> {
        self.kept.push(Request::read(line)?.input);
        Ok(())
    }

    fn measure(&mut self) -> Option<Measured> {
        let Self { trajectory, kept } = self;
        let calculate = |input: &Input<N>| {
            // An input without solution takes its time too.
            let _ = calculate_into(black_box(input), black_box(trajectory));
        };
        let cases = kept.len();
        (cases > 0).then(|| Measured { cases, dofs: N, times: Times::measure(kept, calculate) })
    }
}
