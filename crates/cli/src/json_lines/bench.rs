//! How long the bare calculation takes, question by question.

use std::io::{Write as _, stderr};
use std::path::Path;
use std::time::Instant;

use anyhow::bail;
use serde::Serialize;

use super::{Mistake, Object, questions};

/// Readings of each case; the least counts, which is the one that nothing disturbed.
pub(crate) const READINGS: usize = 9;

/// All questions of a file, or of the standard input. Those that cannot be read are left out, which is said on
/// the standard error.
///
/// # Errors
/// The input cannot be read, or has no question.
pub(crate) fn read_all<Q>(
    input: Option<&Path>,
    mut read: impl FnMut(&Object<'_>) -> Result<Q, Mistake>,
) -> anyhow::Result<Vec<Q>> {
    let (mut cases, mut left_out, mut first) = (Vec::new(), 0, None);
    questions(input, |question, _| {
        match question.ask(&mut read) {
            Ok(case) => cases.push(case),
            Err(mistake) => {
                left_out += 1;
                first.get_or_insert_with(|| question.located(&mistake));
            }
        }
        Ok(())
    })??;
    match first {
        Some(mistake) if cases.is_empty() => bail!("no question can be measured: {mistake}"),
        None if cases.is_empty() => bail!("no question can be measured: the input is empty"),
        Some(mistake) => {
            let count = cases.len() + left_out;
            writeln!(stderr(), "seamline: {left_out} of {count} questions left out, the first: {mistake}")?;
        }
        None => {}
    }
    Ok(cases)
}

/// Computing times over many cases, in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Times {
    mean_ns: f64,
    p99_ns: f64,
    max_ns: f64,
}

impl Times {
    /// Calls `calculate` for each case, all of them [`READINGS`] times over. A reading is the time of one call less
    /// that of reading the clock. At least one case.
    pub(crate) fn measure<C>(cases: &[C], mut calculate: impl FnMut(&C)) -> Self {
        let clock = least_reading(|| ());
        let mut least = vec![f64::INFINITY; cases.len()];
        for _ in 0..READINGS {
            for (least, case) in least.iter_mut().zip(cases) {
                *least = least.min(reading(|| calculate(case)));
            }
        }
        for time in &mut least {
            *time = (*time - clock).max(0.0);
        }
        Self::of(least)
    }

    fn of(mut times: Vec<f64>) -> Self {
        times.sort_unstable_by(f64::total_cmp);
        let count = times.len();
        let at = |rank: usize| times.get(rank.saturating_sub(1)).copied().unwrap_or(0.0);
        Self {
            mean_ns: times.iter().sum::<f64>() / count.max(1) as f64,
            // The least time that 99 % of the cases do not pass.
            p99_ns: at((count * 99).div_ceil(100)),
            max_ns: at(count),
        }
    }
}

/// The clock's own cost.
fn least_reading(mut nothing: impl FnMut()) -> f64 {
    (0..1000).map(|_| reading(&mut nothing)).fold(f64::INFINITY, f64::min)
}

fn reading(call: impl FnOnce()) -> f64 {
    let start = Instant::now();
    call();
    start.elapsed().as_nanos() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_ranks() {
        let times = Times::of((1..=200).rev().map(f64::from).collect());
        assert_eq!(times, Times { mean_ns: 100.5, p99_ns: 198.0, max_ns: 200.0 });
        assert_eq!(Times::of(vec![7.0]), Times { mean_ns: 7.0, p99_ns: 7.0, max_ns: 7.0 });
    }

    #[test]
    fn every_case_is_called_as_often_as_said() {
        let mut calls = [0; 3];
        Times::measure(&[0, 1, 2], |&case: &usize| calls[case] += 1);
        assert_eq!(calls, [READINGS; 3]);
    }
}
