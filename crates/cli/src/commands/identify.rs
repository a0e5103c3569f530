//! `seamline identify`: modes from a measured vibration.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use seamline_cell::identify::{
    Identification, IdentifiedMode, Signal, amplitude_spectrum, identify, read_signal,
};
use serde::Serialize;

use crate::json_lines::print_line;
use crate::plot::{Chart, Page, Series};

const HELP: &str = "\
The file has rows of time_s, acceleration in any unit, evenly sampled; a first line of words is a header. It may begin
before the vibration does; nothing may push the arm after that. Prints the modes, strongest first: undamped natural
frequency and damping ratio with their standard deviations, and the amplitude where the vibration begins.

Example:
  seamline identify vibration.csv --plot vibration.html";

/// Find frequency and damping of flexible modes in a measured, decaying vibration.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Rows of time_s, acceleration.
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// Draw signal, fit and spectrum on a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
}

#[derive(Serialize)]
struct Answer {
    modes: Vec<Mode>,
}

#[derive(Serialize)]
struct Mode {
    frequency_hz: f64,
    frequency_std_hz: f64,
    damping: f64,
    damping_std: f64,
    amplitude: f64,
}

impl From<&IdentifiedMode> for Mode {
    fn from(mode: &IdentifiedMode) -> Self {
        let &IdentifiedMode { frequency_hz, frequency_std_hz, damping, damping_std, amplitude } = mode;
        Self { frequency_hz, frequency_std_hz, damping, damping_std, amplitude }
    }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = || arguments.file.display().to_string();
    let text = std::fs::read_to_string(&arguments.file).with_context(name)?;
    let signal = read_signal(&text).with_context(name)?;
    let found = identify(&signal).with_context(name)?;
    if let Some(path) = &arguments.plot {
        page(&arguments.file, &signal, &found).write(path)?;
    }
    print_line(&Answer { modes: found.modes.iter().map(Mode::from).collect() })
}

fn page(file: &Path, signal: &Signal, found: &Identification) -> Page {
    let mut facts = vec![("file".to_owned(), file.display().to_string())];
    for mode in &found.modes {
        let text = format!(
            "{:.4} ± {:.4} Hz, ζ {:.5} ± {:.5}",
            mode.frequency_hz, mode.frequency_std_hz, mode.damping, mode.damping_std
        );
        facts.push(("mode".to_owned(), text));
    }
    facts.push(("left by the fit".to_owned(), format!("{:.3e} RMS", found.residual_rms)));
    Page {
        title: "Identified modes".to_owned(),
        facts,
        charts: vec![record(signal, found), residual(signal, found), spectrum(signal, found)],
        ..Page::default()
    }
}

fn record(signal: &Signal, found: &Identification) -> Chart {
    let measured = signal.times.iter().copied().zip(signal.values.iter().copied());
    Chart {
        title: "Vibration".to_owned(),
        x: "time, s".to_owned(),
        y: "acceleration, unit of the file".to_owned(),
        series: vec![
            Series::new("measured", measured),
            Series::new("fitted", fitted(signal, found).map(|(t, _, fit)| (t, fit))),
        ],
        wide: true,
        ..Chart::default()
    }
}

fn residual(signal: &Signal, found: &Identification) -> Chart {
    Chart {
        title: "What the fit leaves".to_owned(),
        x: "time, s".to_owned(),
        y: "acceleration, unit of the file".to_owned(),
        series: vec![Series::new(
            "measured less fitted",
            fitted(signal, found).map(|(t, value, fit)| (t, value - fit)),
        )],
        ..Chart::default()
    }
}

/// Time, measured and fitted value from the start of the fit on.
fn fitted<'a>(signal: &'a Signal, found: &'a Identification) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
    let skipped = signal.times.len() - found.fitted.len();
    let measured = signal.times.iter().zip(&signal.values).skip(skipped);
    measured.zip(&found.fitted).map(|((t, value), fit)| (*t, *value, *fit))
}

fn spectrum(signal: &Signal, found: &Identification) -> Chart {
    // The modes, and as much again above them.
    let highest = found.modes.iter().map(|mode| mode.frequency_hz).fold(0.0, f64::max);
    let shown = amplitude_spectrum(signal).into_iter().take_while(|(f, _)| *f <= 2.0 * highest + 5.0);
    Chart {
        title: "Spectrum".to_owned(),
        x: "frequency, Hz".to_owned(),
        y: "amplitude, unit of the file".to_owned(),
        series: vec![Series::new("measured", shown)],
        marks: found
            .modes
            .iter()
            .map(|mode| (mode.frequency_hz, format!("{:.3} Hz", mode.frequency_hz)))
            .collect(),
        ..Chart::default()
    }
}
