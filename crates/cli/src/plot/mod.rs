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
    pub(crate) charts: Vec<Chart>,
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
    fn spaced_numbers_have_both_ends() {
        assert_eq!(spaced(-1.0, 1.0, 4).collect::<Vec<_>>(), [-1.0, -0.5, 0.0, 0.5, 1.0]);
    }
}
