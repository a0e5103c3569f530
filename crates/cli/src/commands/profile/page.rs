//! Curves over one common abscissa as a page of plain HTML and SVG: no script, and nothing to load.

/// One chart.
pub(super) struct Chart {
    pub(super) title: &'static str,
    pub(super) points: Vec<(f64, f64)>,
    /// An instant worth a line across, and what it is.
    pub(super) mark: Option<(f64, &'static str)>,
}

const STYLE: &str = "\
body{margin:20px auto;max-width:1000px;background:#f5f7fa;color:#1f2933;font:14px/1.4 system-ui,sans-serif}\
h1{font-size:20px;margin:0 0 4px}p{margin:0 0 12px;color:#5f6c7b}\
svg{display:block;width:100%;background:#fff;border:1px solid #dde3ea;border-radius:6px;margin-bottom:8px}\
text{font-size:11px;fill:#5f6c7b}.title{font-size:13px;font-weight:600;fill:#1f2933}\
.grid{stroke:#e6ebf0}.zero{stroke:#9aa7b4}.curve{fill:none;stroke:#2f6fb3;stroke-width:1.6;stroke-linejoin:round}\
.mark{stroke:#c0262d;stroke-dasharray:4 3}.note{fill:#c0262d}";

/// Size of a chart, and of the field in it that the curve is drawn in.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 210.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 984.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 184.0;

/// A page of charts, one below the other.
pub(super) fn page(title: &str, text: &str, abscissa: &str, charts: &[Chart]) -> String {
    let charts: String = charts.iter().map(|chart| chart.svg(abscissa)).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
        <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
        <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\
        <title>{title} – Seamline</title><style>{STYLE}</style></head><body>\
        <h1>{title}</h1><p>{text}</p>{charts}</body></html>\n"
    )
}

/// A linear scale from values to pixels.
struct Scale {
    low: f64,
    high: f64,
    first: f64,
    last: f64,
}

impl Scale {
    /// Values that are all the same get some room.
    fn new(values: impl Iterator<Item = f64>, margin: f64, first: f64, last: f64) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let room = if high > low { margin * (high - low) } else { low.abs().max(1.0) };
        Self { low: low - room, high: high + room, first, last }
    }

    fn pixel(&self, value: f64) -> f64 {
        self.first + (self.last - self.first) * (value - self.low) / (self.high - self.low)
    }

    /// Round values inside, some six of them, at 1, 2 or 5 times a power of ten.
    fn ticks(&self) -> Vec<f64> {
        let rough = (self.high - self.low) / 6.0;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|&s| s >= rough).unwrap_or(rough);
        let (from, to) = ((self.low / step).ceil(), (self.high / step).floor());
        // At most seven: the step is no less than a sixth of the range.
        (0..=((to - from) as u32).min(7)).map(|k| (from + f64::from(k)) * step).collect()
    }
}

impl Chart {
    fn svg(&self, abscissa: &str) -> String {
        let x = Scale::new(self.points.iter().map(|point| point.0), 0.0, LEFT, RIGHT);
        let y = Scale::new(self.points.iter().map(|point| point.1), 0.06, BOTTOM, TOP);
        let vertical = |tick: f64| {
            let at = x.pixel(tick);
            format!(
                "<line class=\"grid\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{BOTTOM}\"/>\
                <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                BOTTOM + 16.0,
                short(tick)
            )
        };
        let horizontal = |tick: f64| {
            let (at, class) = (y.pixel(tick), if tick == 0.0 { "zero" } else { "grid" });
            format!(
                "<line class=\"{class}\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 6.0,
                at + 4.0,
                short(tick)
            )
        };
        let mark = self.mark.map_or_else(String::new, |(time, note)| {
            let at = x.pixel(time);
            format!(
                "<line class=\"mark\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{BOTTOM}\"/>\
                <text class=\"note\" x=\"{:.1}\" y=\"{}\">{note}</text>",
                at + 4.0,
                TOP - 4.0
            )
        });
        let curve: String =
            self.points.iter().map(|&(a, b)| format!("{:.1},{:.1} ", x.pixel(a), y.pixel(b))).collect();
        let grid: String =
            x.ticks().into_iter().map(vertical).chain(y.ticks().into_iter().map(horizontal)).collect();
        format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\">{grid}{mark}\
            <polyline class=\"curve\" points=\"{curve}\"/><text class=\"title\" x=\"{LEFT}\" y=\"18\">{title}</text>\
            <text x=\"{RIGHT}\" y=\"18\" text-anchor=\"end\">{abscissa}</text></svg>",
            title = self.title
        )
    }
}

/// As many digits as a tick needs.
fn short(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks =
            |low: f64, high: f64| Scale { low, high, first: 0.0, last: 1.0 }.ticks().into_iter().map(short);
        let all = |low, high| ticks(low, high).collect::<Vec<_>>().join(" ");
        assert_eq!(all(-6.0, 106.0), "0 20 40 60 80 100");
        assert_eq!(all(0.0, 3.0), "0 0.5 1 1.5 2 2.5 3");
        assert_eq!(all(-252.0, 252.0), "-200 -100 0 100 200");
    }

    #[test]
    fn a_curve_without_height_is_drawn() {
        let chart = Chart { title: "t", points: vec![(0.0, 5.0), (1.0, 5.0)], mark: None };
        let svg = chart.svg("time, s");
        assert!(svg.contains("points=\"74.0,107.0 984.0,107.0 \""), "{svg}");
    }
}
