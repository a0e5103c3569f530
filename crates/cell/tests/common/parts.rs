//! G-code parts of many short lines as CAM writes them, made by formula, and an independent judge of the way that a tool took over them.

#![allow(dead_code, reason = "tests and the example each use a part")]

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::Point3;
use seamline::geometry::Pose;

/// A program, and the way that it describes.
pub(crate) struct Part {
    pub(crate) name: &'static str,
    pub(crate) text: String,
    /// Points of the work frame in mm, joined by lines; arcs in steps of a hundredth of a radian.
    pub(crate) way: Vec<[f64; 3]>,
    /// G64 P in mm.
    pub(crate) tolerance: f64,
    /// Lines of the program that move.
    pub(crate) segments: usize,
    /// Time at programmed feeds and rapid speed, without any acceleration.
    pub(crate) nominal_seconds: f64,
}

/// Where the middle of each part lies: in reach of the scara cell, and the default arm's with a frame 700 mm ahead.
const CENTRE: [f64; 2] = [340.0, 0.0];
const RAPID_MM_S: f64 = 1500.0;

struct Pen {
    part: Part,
    at: [f64; 3],
    feed_mm_min: f64,
}

impl Pen {
    fn new(name: &'static str, tolerance: f64, feed_mm_min: f64, start: [f64; 2]) -> Self {
        let at = [thousandths(start[0]), thousandths(start[1]), 2.0];
        let mut text = String::new();
        let _ = writeln!(text, "%\n({name})\nG21 G90 G17 G54\nG64 P{tolerance}");
        let _ = writeln!(text, "G0 X{:.3} Y{:.3} Z{:.3}\nF{feed_mm_min}", at[0], at[1], at[2]);
        let part = Part { name, text, way: vec![at], tolerance, segments: 1, nominal_seconds: 0.0 };
        Self { part, at, feed_mm_min }
    }

    fn go(&mut self, code: &str, to: [f64; 3], mm_s: f64) {
        let to = to.map(thousandths);
        let mut words = String::new();
        for (axis, letter) in ["X", "Y", "Z"].iter().enumerate() {
            if to[axis] != self.at[axis] {
                let _ = write!(words, " {letter}{:.3}", to[axis]);
            }
        }
        if words.is_empty() {
            return;
        }
        let _ = writeln!(self.part.text, "{code}{words}");
        self.part.nominal_seconds += distance(&self.at, &to) / mm_s;
        self.part.segments += 1;
        self.part.way.push(to);
        self.at = to;
    }

    fn rapid(&mut self, to: [f64; 3]) {
        self.go("G0", to, RAPID_MM_S);
    }

    fn line(&mut self, [x, y]: [f64; 2]) {
        self.go("G1", [x, y, self.at[2]], self.feed_mm_min / 60.0);
    }

    fn down(&mut self, z: f64) {
        self.go("G1", [self.at[0], self.at[1], z], self.feed_mm_min / 60.0);
    }

    /// An arc against the clock by its centre, through `angle` radians.
    fn arc(&mut self, centre: [f64; 2], angle: f64) {
        let (x, y) = (self.at[0] - centre[0], self.at[1] - centre[1]);
        let place = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos, self.at[2]]
        };
        let end = place(angle).map(thousandths);
        let _ = writeln!(self.part.text, "G3 X{:.3} Y{:.3} I{:.4} J{:.4}", end[0], end[1], -x, -y);
        let steps = (angle * 100.0).ceil();
        for step in 1..steps as usize {
            self.part.way.push(place(angle * step as f64 / steps));
        }
        self.part.way.push(end);
        self.part.nominal_seconds += angle * x.hypot(y) / (self.feed_mm_min / 60.0);
        self.part.segments += 1;
        self.at = end;
    }

    fn end(mut self) -> Part {
        self.rapid([self.at[0], self.at[1], 2.0]);
        self.part.text += "M30\n%\n";
        self.part
    }
}

fn thousandths(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// Points of a curve about `chord` mm apart, `count` of them and the first.
fn chords(curve: impl Fn(f64) -> [f64; 2], chord: f64, count: usize) -> Vec<[f64; 2]> {
    const NEAR: f64 = 1e-6;
    let mut u = 0.0;
    let next = |_| {
        let [here, beside] = [curve(u), curve(u + NEAR)];
        u += chord * NEAR / (beside[0] - here[0]).hypot(beside[1] - here[1]);
        here
    };
    (0..=count).map(next).collect()
}

fn contour(name: &'static str, tolerance: f64, feed: f64, points: &[[f64; 2]]) -> Part {
    let mut pen = Pen::new(name, tolerance, feed, points[0]);
    pen.down(-1.0);
    for point in &points[1..] {
        pen.line(*point);
    }
    pen.end()
}

/// An Archimedean spiral inwards from a radius of 40 mm, chords of 0.2 mm.
pub(crate) fn spiral(segments: usize) -> Part {
    let turns = segments as f64 * 0.2 / (TAU * 21.0);
    let curve = |u: f64| {
        let radius = 40.0 - 38.0 * u / (turns * TAU);
        [CENTRE[0] + radius * u.cos(), CENTRE[1] + radius * u.sin()]
    };
    contour("spiral", 0.02, 3000.0, &chords(curve, 0.2, segments))
}

/// A Lissajous figure that drifts, chords of 0.3 mm.
pub(crate) fn lissajous(segments: usize) -> Part {
    let curve =
        |u: f64| [CENTRE[0] + 40.0 * (3.0 * u).sin(), CENTRE[1] + 40.0 * (4.0 * u + 0.01 * u + 0.5).sin()];
    contour("lissajous", 0.02, 6000.0, &chords(curve, 0.3, segments))
}

/// Trochoidal milling: loops of 3 mm radius that advance by 0.6 mm along a wide circle, chords of 0.1 mm.
pub(crate) fn trochoid(segments: usize) -> Part {
    let curve = |u: f64| {
        let along = 0.6 / 35.0 * u / TAU;
        let (sin, cos) = along.sin_cos();
        [CENTRE[0] + 35.0 * cos + 3.0 * (u + along).cos(), CENTRE[1] + 35.0 * sin + 3.0 * (u + along).sin()]
    };
    contour("trochoid", 0.02, 3000.0, &chords(curve, 0.1, segments))
}

/// Engraved marks: each with a lead-in arc, straight strokes, sharp corners of several angles, a wave of short chords and a round eye;
/// from one to the next with the tool lifted.
pub(crate) fn engraving(segments: usize) -> Part {
    let mut pen = Pen::new("engraving", 0.02, 2400.0, [CENTRE[0] - 38.0, CENTRE[1] - 38.0]);
    let mut mark = 0;
    while pen.part.segments < segments {
        let (column, row) = (mark % 8, (mark / 8) % 8);
        let [x, y] = [CENTRE[0] - 38.0 + 9.5 * f64::from(column), CENTRE[1] - 38.0 + 9.5 * f64::from(row)];
        pen.rapid([x + 1.0, y, 2.0]);
        pen.down(-0.5);
        // The lead-in.
        pen.arc([x + 1.0, y + 1.0], TAU / 4.0);
        pen.line([x + 2.0, y + 4.0]);
        pen.line([x + 5.0, y + 4.0]);
        pen.line([x + 3.0, y + 2.0]);
        let wave = |u: f64| [x + 3.0 + u, y + 2.0 + 0.6 * (2.0 * u).sin()];
        for point in chords(wave, 0.15, 30) {
            pen.line(point);
        }
        let end = [pen.at[0], pen.at[1]];
        pen.line([end[0] + 0.3, end[1] - 2.0]);
        let eye = |u: f64| [end[0] - 0.7 + u.cos(), end[1] - 2.0 + u.sin()];
        for point in chords(eye, 0.12, 50) {
            pen.line(point);
        }
        pen.rapid([pen.at[0], pen.at[1], 2.0]);
        mark += 1;
    }
    pen.end()
}

/// All of them.
pub(crate) fn parts(segments: usize) -> Vec<Part> {
    vec![spiral(segments), lissajous(segments), trochoid(segments), engraving(segments)]
}

/// The commanded tool's places in the work frame, in mm, from where it first comes to the work: of a recording's text.
pub(crate) fn places(recording: &str, base_from_work: &Pose) -> Vec<[f64; 3]> {
    let mut lines = recording.lines().filter(|line| !line.starts_with('#'));
    let heading: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| heading.iter().position(|other| *other == name).unwrap_or(usize::MAX);
    let columns = ["tcp_x_mm", "tcp_y_mm", "tcp_z_mm"].map(column);
    let segment = column("segment");
    let work_from_base = base_from_work.inverse();
    let place = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap_or(f64::NAN)).collect();
        let value = |column: usize| values.get(column).copied().unwrap_or(f64::NAN);
        let [x, y, z] = columns.map(value);
        let point = work_from_base * Point3::new(x / 1000.0, y / 1000.0, z / 1000.0);
        (value(segment) >= 2.0).then(|| (point.coords * 1000.0).into())
    };
    lines.filter_map(place).collect()
}

/// How far from the last nearest place the next is sought, in mm along the way beyond what was travelled: less than between two passes
/// of a crossing.
const SLACK: f64 = 1.0;

/// The greatest distance of the tool's places, in mm in the work frame and in order, from the way; and the greatest distance of a
/// point of the way from the tool's way, places joined by lines.
pub(crate) fn distances(way: &[[f64; 3]], places: &[[f64; 3]]) -> [f64; 2] {
    [farthest(places, way), farthest(way, places)]
}

/// The greatest distance of points from a way that they follow.
fn farthest(points: &[[f64; 3]], way: &[[f64; 3]]) -> f64 {
    let mut ends = vec![0.0];
    for pair in way.windows(2) {
        ends.push(ends[ends.len() - 1] + distance(&pair[0], &pair[1]));
    }
    let (mut at, mut greatest): (f64, f64) = (0.0, 0.0);
    for (index, point) in points.iter().enumerate() {
        let travelled = if index == 0 { 0.0 } else { distance(&points[index - 1], point) };
        let first = ends.partition_point(|end| *end < at - SLACK).saturating_sub(1);
        let last = ends.partition_point(|end| *end <= at + travelled + SLACK).clamp(1, way.len() - 1);
        let near = |index: &usize| distance_to_line(point, &way[*index], &way[index + 1]).0;
        let Some(nearest) = (first..last).min_by(|a, b| near(a).total_cmp(&near(b))) else { continue };
        let (off, share) = distance_to_line(point, &way[nearest], &way[nearest + 1]);
        // Never back: beside a sharp corner both lines are near.
        at = at.max(ends[nearest] + share * (ends[nearest + 1] - ends[nearest]));
        greatest = greatest.max(off);
    }
    greatest
}

/// The distance, and the share of the line at which it is nearest.
fn distance_to_line(point: &[f64; 3], from: &[f64; 3], to: &[f64; 3]) -> (f64, f64) {
    let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let offset: [f64; 3] = std::array::from_fn(|axis| point[axis] - from[axis]);
    let square: f64 = way.iter().map(|x| x * x).sum();
    let along: f64 = way.iter().zip(&offset).map(|(a, b)| a * b).sum();
    let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
    ((0..3).map(|axis| (offset[axis] - share * way[axis]).powi(2)).sum::<f64>().sqrt(), share)
}
