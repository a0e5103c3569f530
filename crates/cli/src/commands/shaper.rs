//! `seamline shaper`: what prefilters do.

use std::f64::consts::TAU;
use std::path::PathBuf;

use seamline::vibration::{Kernel, Mode, Prefilter, Ramp};
use serde::Serialize;

use super::modes::{ModeArguments, prefilter};
use crate::json_lines::print_line;
use crate::plot::{Chart, Page, Series, spaced};

const HELP: &str = "\
Prints, for each prefilter: its impulses and rectangles, length and delay; the step through it and the mode's answer;
its gain over frequency; and the residual vibration, relative to that after a bare step, where the actual frequency or
damping is 0.5 to 1.5 times the modelled one. With several modes each prefilter is made for all of them; answers and
sensitivities are those of the first.

Example:
  seamline shaper --frequency-hz 6.34 --damping 0.022 --prefilter zv,zvd,fir-zvd --plot shaper.html";

/// Show prefilters for a flexible mode: impulses, step, frequency and sensitivity as JSON.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Prefilters, with commas between them: none, zv, zvd, fir, fir-zv, fir-zvd, mzv, ei, 2hump-ei, 3hump-ei.
    #[arg(
        long, value_name = "NAMES", value_delimiter = ',', value_parser = prefilter,
        default_value = "zv,zvd,fir,fir-zv,fir-zvd"
    )]
    prefilter: Vec<Prefilter>,
    #[command(flatten)]
    modes: ModeArguments,
    /// Draw the curves on a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
}

/// Points of a curve, less one.
const POINTS: u32 = 400;

#[derive(Serialize)]
struct Answer {
    frequency_hz: Vec<f64>,
    damping: Vec<f64>,
    prefilters: Vec<Shown>,
}

#[derive(Serialize)]
struct Shown {
    prefilter: &'static str,
    length_s: f64,
    delay_s: f64,
    impulses: Vec<ShownImpulse>,
    rectangles_s: Vec<f64>,
    step: Step,
    frequency: Frequency,
    sensitivity: Sensitivity,
}

#[derive(Serialize)]
struct ShownImpulse {
    time_s: f64,
    weight: f64,
}

#[derive(Serialize)]
struct Step {
    time_s: Vec<f64>,
    command: Vec<f64>,
    answer: Vec<f64>,
}

#[derive(Serialize)]
struct Frequency {
    frequency_hz: Vec<f64>,
    gain: Vec<f64>,
}

#[derive(Serialize)]
struct Sensitivity {
    /// Actual over modelled.
    ratio: Vec<f64>,
    vibration_over_frequency: Vec<f64>,
    vibration_over_damping: Vec<f64>,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let modes = arguments.modes.modes()?;
    let [first, ..] = modes.as_slice() else { return Ok(()) };
    let kernels: Vec<(Prefilter, Kernel)> = arguments
        .prefilter
        .iter()
        .map(|prefilter| Ok((*prefilter, prefilter.for_modes(&modes)?)))
        .collect::<anyhow::Result<_>>()?;
    // The same time for all, so that they compare: the longest, and two periods to see what is left.
    let longest = kernels.iter().map(|(_, kernel)| kernel.length()).fold(0.0, f64::max);
    let end = longest + 2.0 * first.period();
    let shown = |(prefilter, kernel): &(Prefilter, Kernel)| show(*prefilter, kernel, first, end);
    let answer = Answer {
        frequency_hz: arguments.modes.frequency_hz.clone(),
        damping: arguments.modes.damping.clone(),
        prefilters: kernels.iter().map(shown).collect::<anyhow::Result<_>>()?,
    };
    if let Some(path) = &arguments.plot {
        page(&answer, arguments.modes.facts()).write(path)?;
    }
    print_line(&answer)
}

fn show(prefilter: Prefilter, kernel: &Kernel, mode: &Mode, end: f64) -> anyhow::Result<Shown> {
    let ramp = Ramp::from_kernel(kernel)?;
    let time_s: Vec<f64> = spaced(0.0, end, POINTS).collect();
    let step = Step {
        command: time_s.iter().map(|t| ramp.value(*t)).collect(),
        answer: time_s.iter().map(|t| kernel.mode_response(mode, *t)).collect(),
        time_s,
    };
    let frequency_hz: Vec<f64> = spaced(0.0, 5.0 * mode.omega() / TAU, POINTS).collect();
    let gain = frequency_hz.iter().map(|f| kernel.gain(TAU * f)).collect();
    Ok(Shown {
        prefilter: prefilter.name(),
        length_s: kernel.length(),
        delay_s: kernel.delay(),
        impulses: kernel
            .impulses()
            .iter()
            .map(|i| ShownImpulse { time_s: i.time, weight: i.weight })
            .collect(),
        rectangles_s: kernel.rectangles().to_vec(),
        step,
        frequency: Frequency { frequency_hz, gain },
        sensitivity: sensitivity(kernel, mode)?,
    })
}

fn sensitivity(kernel: &Kernel, mode: &Mode) -> anyhow::Result<Sensitivity> {
    let ratio: Vec<f64> = spaced(0.5, 1.5, 200).collect();
    let vibration = |frequency: f64, damping: f64| {
        // A damping ratio may come near 1 at one and a half times the modelled one.
        let actual = Mode::try_new(mode.omega() * frequency, (mode.damping() * damping).min(0.94))?;
        anyhow::Ok(kernel.residual_vibration(&actual))
    };
    Ok(Sensitivity {
        vibration_over_frequency: ratio.iter().map(|r| vibration(*r, 1.0)).collect::<anyhow::Result<_>>()?,
        vibration_over_damping: ratio.iter().map(|r| vibration(1.0, *r)).collect::<anyhow::Result<_>>()?,
        ratio,
    })
}

fn page(answer: &Answer, mut facts: Vec<(String, String)>) -> Page {
    for shown in &answer.prefilters {
        facts.push((shown.prefilter.to_owned(), format!("{:.1} ms", 1e3 * shown.length_s)));
    }
    let chart = |title: &str, x: &str, y: &str, points: &dyn Fn(&Shown) -> Vec<(f64, f64)>| Chart {
        title: title.to_owned(),
        x: x.to_owned(),
        y: y.to_owned(),
        series: answer.prefilters.iter().map(|shown| Series::new(shown.prefilter, points(shown))).collect(),
        ..Chart::default()
    };
    let pairs = |x: &[f64], y: &[f64]| x.iter().copied().zip(y.iter().copied()).collect::<Vec<_>>();
    let tolerance = vec![(5.0, "5 %".to_owned())];
    // A prefilter that changes nothing leaves 100 %, and would only flatten the others.
    let percent = |shown: &Shown, y: &[f64]| -> Vec<f64> {
        let changes = shown.length_s > 0.0;
        y.iter().filter(|_| changes).map(|v| 100.0 * v).collect()
    };
    let charts = vec![
        chart("A step through the prefilter", "time, s", "command", &|s| {
            pairs(&s.step.time_s, &s.step.command)
        }),
        chart("The mode's answer to it", "time, s", "position", &|s| pairs(&s.step.time_s, &s.step.answer)),
        Chart {
            marks: answer.frequency_hz.iter().map(|f| (*f, format!("{f} Hz"))).collect(),
            ..chart("Gain", "frequency, Hz", "gain", &|s| pairs(&s.frequency.frequency_hz, &s.frequency.gain))
        },
        Chart {
            levels: tolerance.clone(),
            ..chart(
                "Residual vibration, wrong frequency",
                "actual over modelled frequency",
                "vibration, %",
                &|s| pairs(&s.sensitivity.ratio, &percent(s, &s.sensitivity.vibration_over_frequency)),
            )
        },
        Chart {
            wide: true,
            ..chart(
                "Residual vibration, wrong damping",
                "actual over modelled damping",
                "vibration, %",
                &|s| pairs(&s.sensitivity.ratio, &percent(s, &s.sensitivity.vibration_over_damping)),
            )
        },
    ];
    Page { title: "Prefilters".to_owned(), facts, charts, ..Page::default() }
}
