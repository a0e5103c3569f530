//! Line charts in one page that opens anywhere, offline.
//!
//! Any subcommand with `--plot` fills a [`Page`]; a small script draws it from the data in the page itself. A content security policy keeps
//! the page from asking for anything else.

use std::io;
use std::path::Path;

use anyhow::Context as _;
use seamline_cell::record::write_whole;
use serde::Serialize;

const STYLE: &str = include_str!("plot.css");
const SCRIPT: &str = include_str!("plot.js");

/// A page of charts under a title and a line of facts.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Page {
    pub(crate) title: String,
    /// What was asked, and the main figures: label, value.
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) tables: Vec<Table>,
    pub(crate) charts: Vec<Chart>,
}

/// A table above the charts, in words as they are to be read.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Table {
    pub(crate) title: String,
    /// Headings carry the unit.
    pub(crate) columns: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// One chart. Axis labels carry their unit.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x: String,
    pub(crate) y: String,
    pub(crate) series: Vec<Series>,
    /// Upright lines with a label.
    pub(crate) marks: Vec<(f64, String)>,
    /// Level lines with a label.
    pub(crate) levels: Vec<(f64, String)>,
    /// One scale for both axes: a chart of places.
    pub(crate) equal: bool,
    /// Powers of ten upward.
    pub(crate) log: bool,
    /// The whole width of the page.
    pub(crate) wide: bool,
}

/// One line of a chart.
#[derive(Debug, Serialize)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

impl Series {
    pub(crate) fn new(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { name: name.into(), points: points.into_iter().collect() }
    }

    /// With the fewest points between which straight lines pass all others within a tolerance: a step keeps its edge.
    pub(crate) fn thinned(
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
        tolerance: f64,
    ) -> Self {
        Self { name: name.into(), points: thinned(points, tolerance) }
    }
}

/// A line goes on from the last point kept while some slope passes all points since within the tolerance.
fn thinned(points: impl IntoIterator<Item = (f64, f64)>, tolerance: f64) -> Vec<(f64, f64)> {
    let mut points = points.into_iter();
    let Some(mut last) = points.next() else { return Vec::new() };
    let mut kept = vec![last];
    let mut from = last;
    let mut slopes = (f64::NEG_INFINITY, f64::INFINITY);
    for point in points {
        let slope = |y: f64, from: (f64, f64)| (y - from.1) / (point.0 - from.0);
        if !(slopes.0..=slopes.1).contains(&slope(point.1, from)) {
            kept.push(last);
            from = last;
            slopes = (f64::NEG_INFINITY, f64::INFINITY);
        }
        slopes.0 = slopes.0.max(slope(point.1 - tolerance, from));
        slopes.1 = slopes.1.min(slope(point.1 + tolerance, from));
        last = point;
    }
    if from != last {
        kept.push(last);
    }
    kept
}

impl Page {
    /// Writes the page, whole or not at all.
    ///
    /// # Errors
    /// Those of the file system, with the file's name.
    pub(crate) fn write(&self, path: &Path) -> anyhow::Result<()> {
        let text = self.html().with_context(|| path.display().to_string())?;
        write_whole(path, text.as_bytes()).with_context(|| path.display().to_string())
    }

    fn html(&self) -> io::Result<String> {
        // Data must not end the script that holds them.
        let data = serde_json::to_string(self)?.replace('<', "\\u003c");
        Ok([
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">",
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">",
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ",
            "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">",
            "<title>Seamline</title><style>",
            STYLE,
            "</style></head><body><header><h1></h1><dl></dl></header><main></main>",
            "<noscript><p>The charts need JavaScript.</p></noscript>\n<script>const page = ",
            &data,
            ";\n",
            SCRIPT,
            "</script></body></html>\n",
        ]
        .concat())
    }
}

/// `count` + 1 numbers from `from` to `to`, evenly spaced.
pub(crate) fn spaced(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |n| from + (to - from) * f64::from(n) / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_cannot_leave_their_script() {
        let page = Page { title: "a </script><b>".to_owned(), ..Page::default() };
        let html = page.html().unwrap();
        assert_eq!(html.matches("</script>").count(), 1);
        assert!(
            html.contains("a \\u003c/script>") && !html.contains("http://") && !html.contains("https://")
        );
    }

    #[test]
    fn thinned_points_pass_near_all_others() {
        let curve = |k: u32| {
            let x = 0.001 * f64::from(k);
            (x, if x < 0.5 { (9.0 * x).sin() } else { 2.0 })
        };
        let points: Vec<_> = (0..1000).map(curve).collect();
        let kept = thinned(points.iter().copied(), 1e-3);
        assert!(kept.len() < 100 && kept.contains(&points[499]) && kept.contains(&points[500]), "{kept:?}");
        for point in &points {
            let after = kept.partition_point(|p| p.0 < point.0).max(1);
            let (a, b) = (kept[after - 1], kept[after]);
            let line = a.1 + (b.1 - a.1) * (point.0 - a.0) / (b.0 - a.0);
            assert!((line - point.1).abs() <= 1e-3 + 1e-12, "{point:?}");
        }
        assert_eq!(thinned([(1.0, 2.0)], 0.1), [(1.0, 2.0)]);
        assert!(thinned([], 0.1).is_empty());
    }

    #[test]
    fn spaced_numbers_have_both_ends() {
        assert_eq!(spaced(-1.0, 1.0, 4).collect::<Vec<_>>(), [-1.0, -0.5, 0.0, 0.5, 1.0]);
    }
}
