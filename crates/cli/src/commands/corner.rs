//! `seamline corner`: two segments that overlap for a permitted corner error.

use std::path::PathBuf;

use seamline::vibration::{Corner, Overlap, Prefilter, Ramp};
use serde::Serialize;

use super::modes::{ModeArguments, not_negative, number, positive, prefilter};
use crate::json_lines::print_line;
use crate::plot::{Chart, Page, Series, spaced};

const HELP: &str = "\
Times count from where the first segment begins to decelerate: t_dec1_s how long it does, t_d_s when the second segment
starts, t_c_s how long both move, t_m_s when the path is nearest to the corner. error_mm is the distance there.

Example:
  seamline corner --prefilter fir-zvd --frequency-hz 6.34 --damping 0.022 --feedrate-mm-min 9600 --error-mm 0.5 \\
    --angle-deg 66.038 --plot corner.html";

/// Plan a corner in time: how far two segments may overlap for a permitted corner error.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// The prefilter that shapes both feedrates: none, zv, zvd, fir, fir-zv, fir-zvd, mzv, ei, 2hump-ei or 3hump-ei.
    #[arg(long, value_name = "NAME", value_parser = prefilter)]
    prefilter: Prefilter,
    #[command(flatten)]
    modes: ModeArguments,
    /// Feedrate before the corner, in mm/min.
    #[arg(long, value_name = "F", value_parser = positive)]
    feedrate_mm_min: f64,
    /// Feedrate after the corner, in mm/min [default: the same].
    #[arg(long, value_name = "F", value_parser = positive)]
    second_feedrate_mm_min: Option<f64>,
    /// Permitted corner error, in mm.
    #[arg(long, value_name = "E", value_parser = not_negative)]
    error_mm: f64,
    /// Change of direction in degrees: 0 is straight on, 180 is back.
    #[arg(long, value_name = "DEG", value_parser = angle)]
    angle_deg: f64,
    /// Draw feedrates and path on a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
}

fn angle(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=180.0).contains(&x), "a number from 0 to 180")
}

#[derive(Serialize)]
struct Answer {
    t_dec1_s: f64,
    t_m_s: f64,
    t_c_s: f64,
    t_d_s: f64,
    error_mm: f64,
}

/// mm/min in m/s.
const MM_PER_MINUTE: f64 = 1e-3 / 60.0;
const POINTS: u32 = 500;

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let ramp = Ramp::from_kernel(&arguments.prefilter.for_modes(&arguments.modes.modes()?)?)?;
    let second = arguments.second_feedrate_mm_min.unwrap_or(arguments.feedrate_mm_min);
    let corner = Corner {
        deceleration: &ramp,
        acceleration: &ramp,
        first_feedrate: arguments.feedrate_mm_min * MM_PER_MINUTE,
        second_feedrate: second * MM_PER_MINUTE,
        angle: arguments.angle_deg.to_radians(),
        longest: f64::INFINITY,
    };
    let found = corner.overlap(1e-3 * arguments.error_mm);
    if let Some(path) = &arguments.plot {
        page(arguments, &corner, &found).write(path)?;
    }
    print_line(&Answer {
        t_dec1_s: found.deceleration,
        t_m_s: found.nearest,
        t_c_s: found.overlap,
        t_d_s: found.delay,
        error_mm: 1e3 * found.error,
    })
}

fn page(arguments: &Arguments, corner: &Corner<'_>, found: &Overlap) -> Page {
    let mut facts = vec![("prefilter".to_owned(), arguments.prefilter.to_string())];
    facts.extend(arguments.modes.facts());
    facts.push(("angle".to_owned(), format!("{} °", arguments.angle_deg)));
    facts.push(("permitted".to_owned(), format!("{} mm", arguments.error_mm)));
    facts.push(("reached".to_owned(), format!("{:.4} mm", 1e3 * found.error)));
    facts.push(("overlap".to_owned(), format!("{:.1} ms", 1e3 * found.overlap)));
    Page {
        title: "Corner in time".to_owned(),
        facts,
        charts: vec![feedrates(corner, found), path(corner, found)],
        ..Page::default()
    }
}

fn feedrates(corner: &Corner<'_>, found: &Overlap) -> Chart {
    const MM_S: f64 = 1e3;
    let end = found.delay + corner.acceleration.duration();
    let first = |t: f64| MM_S * corner.first_feedrate * (1.0 - corner.deceleration.value(t));
    let second = |t: f64| MM_S * corner.second_feedrate * corner.acceleration.value(t - found.delay);
    let cos = corner.angle.cos();
    let speed = |t: f64| {
        let (a, b) = (first(t), second(t));
        (a * a + b * b + 2.0 * a * b * cos).max(0.0).sqrt()
    };
    let series = |name: &str, f: &dyn Fn(f64) -> f64| {
        Series::new(name, spaced(-0.1 * end, 1.1 * end, POINTS).map(|t| (t, f(t))))
    };
    Chart {
        title: "Feedrates".to_owned(),
        x: "time, s".to_owned(),
        y: "mm/s".to_owned(),
        series: vec![
            series("first segment", &first),
            series("second segment", &second),
            series("speed of the tool", &speed),
        ],
        marks: vec![
            (found.delay, "t_d".to_owned()),
            (found.nearest, "t_m".to_owned()),
            (found.deceleration, "t_DEC1".to_owned()),
        ],
        ..Chart::default()
    }
}

/// The path around the corner, which lies at the origin; the first segment comes along +x.
fn path(corner: &Corner<'_>, found: &Overlap) -> Chart {
    const MM: f64 = 1e3;
    let (sin, cos) = corner.angle.sin_cos();
    let left = |t: f64| MM * corner.first_feedrate * corner.deceleration.remaining(t);
    let done = |t: f64| MM * corner.second_feedrate * corner.acceleration.integral(t - found.delay);
    let at = |t: f64| {
        let (a, b) = (left(t), done(t));
        (b * cos - a, b * sin)
    };
    // Some errors to either side of the corner, or of the overlap where that is longer.
    let margin = 0.15 * found.overlap;
    let (from, to) = (found.delay - margin, found.deceleration + margin);
    let (a, b) = (left(from), done(to));
    Chart {
        title: "Path".to_owned(),
        x: "x, mm".to_owned(),
        y: "y, mm".to_owned(),
        series: vec![
            Series::new("tool", spaced(from, to, POINTS).map(at)),
            Series::new("programmed", [(-a, 0.0), (0.0, 0.0), (b * cos, b * sin)]),
            Series::new("nearest to the corner", [(0.0, 0.0), at(found.nearest)]),
        ],
        equal: true,
        ..Chart::default()
    }
}
