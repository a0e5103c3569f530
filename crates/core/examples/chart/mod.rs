//! Charts as SVG, for the figures of the documentation.
#![allow(dead_code, reason = "each program draws with a part of it")]

use std::fmt::Write as _;
use std::path::Path;

/// A chart in its own coordinates, drawn as SVG.
pub(crate) struct Chart {
    x: (f64, f64),
    y: (f64, f64),
    body: String,
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 360.0;
const MARGIN: f64 = 44.0;

impl Chart {
    pub(crate) fn new(x: (f64, f64), y: (f64, f64)) -> Self {
        Self { x, y, body: String::new() }
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let along = |v: f64, (low, high): (f64, f64)| (v - low) / (high - low);
        (
            MARGIN + along(x, self.x) * (WIDTH - 2.0 * MARGIN),
            HEIGHT - MARGIN - along(y, self.y) * (HEIGHT - 2.0 * MARGIN),
        )
    }

    fn points(&self, points: &[(f64, f64)]) -> String {
        points.iter().map(|p| self.place(*p)).map(|(x, y)| format!("{x:.1},{y:.1} ")).collect()
    }

    pub(crate) fn line(&mut self, points: &[(f64, f64)], style: &str) {
        let points = self.points(points);
        let _ = writeln!(self.body, r#"<polyline points="{points}" fill="none" {style}/>"#);
    }

    pub(crate) fn area(&mut self, points: &[(f64, f64)], style: &str) {
        let points = self.points(points);
        let _ = writeln!(self.body, r#"<polygon points="{points}" {style}/>"#);
    }

    pub(crate) fn text(&mut self, at: (f64, f64), text: &str) {
        let (x, y) = self.place(at);
        let _ = writeln!(self.body, r#"<text x="{x:.1}" y="{y:.1}">{text}</text>"#);
    }

    pub(crate) fn axes(&mut self, x: &str, y: &str) {
        let (left, right) = self.x;
        let (low, high) = self.y;
        let zero = 0.0_f64.clamp(low, high);
        self.line(&[(left, zero), (right, zero)], THIN);
        self.line(&[(left, low), (left, high)], THIN);
        self.text((right - 0.12 * (right - left), zero - 0.06 * (high - low)), x);
        self.text((left + 0.01 * (right - left), high), y);
    }

    pub(crate) fn write(&self, path: &Path) -> std::io::Result<()> {
        let head = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="14">"#
        );
        let paper = format!(r#"<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>"#);
        std::fs::write(path, format!("{head}\n{paper}\n{}</svg>\n", self.body))
    }
}

pub(crate) const THIN: &str = r#"stroke="black" stroke-width="1""#;
pub(crate) const DASHED: &str = r##"stroke="#777" stroke-width="1.5" stroke-dasharray="5 4""##;
pub(crate) const BOLD: &str = r##"stroke="#1f4e8c" stroke-width="2.5""##;
pub(crate) const RED: &str = r##"stroke="#b22222" stroke-width="2""##;
pub(crate) const GREY: &str = r##"fill="#dde6f0" stroke="none""##;
