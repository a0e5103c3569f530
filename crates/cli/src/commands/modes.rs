//! Arguments that prefilters share: their names, and the modes they are made for.

use std::f64::consts::TAU;

use anyhow::bail;
use seamline::vibration::{Mode, Prefilter};

/// One flexible mode or several.
#[derive(Debug, clap::Args)]
pub(super) struct ModeArguments {
    /// Undamped natural frequency of the mode, in Hz; several with commas.
    #[arg(long, value_name = "HZ", required = true, value_delimiter = ',', value_parser = positive)]
    pub(super) frequency_hz: Vec<f64>,
    /// Damping ratio of the mode, 0 to below 0.95; one for each frequency.
    #[arg(long, value_name = "RATIO", required = true, value_delimiter = ',', value_parser = damping)]
    pub(super) damping: Vec<f64>,
}

impl ModeArguments {
    pub(super) fn modes(&self) -> anyhow::Result<Vec<Mode>> {
        let (frequencies, dampings) = (self.frequency_hz.len(), self.damping.len());
        if frequencies != dampings {
            bail!("{frequencies} frequencies and {dampings} damping ratios: expected one for each");
        }
        let pairs = self.frequency_hz.iter().zip(&self.damping);
        Ok(pairs
            .map(|(frequency, damping)| Mode::try_new(TAU * frequency, *damping))
            .collect::<Result<_, _>>()?)
    }

    /// For a page's head.
    pub(super) fn facts(&self) -> Vec<(String, String)> {
        let pairs = self.frequency_hz.iter().zip(&self.damping);
        pairs
            .map(|(frequency, damping)| ("mode".to_owned(), format!("{frequency} Hz, ζ {damping}")))
            .collect()
    }
}

/// A prefilter by its name.
pub(super) fn prefilter(text: &str) -> Result<Prefilter, String> {
    Prefilter::from_name(text).ok_or_else(|| {
        if text == "auto" {
            return "auto plans a whole path at once, in `seamline experiment scara` alone; expected the name of a prefilter".to_owned();
        }
        let names: Vec<_> = Prefilter::ALL.iter().map(|prefilter| prefilter.name().to_lowercase()).collect();
        format!("expected one of {}", names.join(", "))
    })
}

/// A finite number above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0 && x.is_finite(), "a number above 0")
}

/// A finite number from 0.
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0 && x.is_finite(), "a number from 0")
}

fn damping(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..0.95).contains(&x), "a number from 0 to below 0.95")
}

/// A number that passes a test.
pub(super) fn number(text: &str, good: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|x| good(*x)).ok_or_else(|| format!("expected {expected}"))
}
