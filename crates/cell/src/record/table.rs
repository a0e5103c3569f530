//! The summary as a table for a terminal.

use std::fmt;

use super::summary::{Summary, Verdict};
use super::times::TimeFigures;

/// Moves shown; the rest stands in `summary.json`.
const MOVES: usize = 30;

impl Verdict {
    /// A word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::OutOfBounds => "out of bounds",
            Self::Fault => "fault",
        }
    }
}

/// A number with about four significant digits; with an exponent only where it is very small.
#[must_use]
pub fn rounded(value: f64) -> String {
    // What rounds up to the next power of ten is shown like it.
    let magnitude = value.abs() * (1.0 + 5e-5);
    if magnitude > 0.0 && magnitude < 1e-3 {
        return format!("{value:.1e}");
    }
    let digits = match magnitude {
        0.0 => 0,
        m if m >= 1000.0 => 0,
        m if m >= 100.0 => 1,
        m if m >= 10.0 => 2,
        m if m >= 1.0 => 3,
        _ => 4,
    };
    format!("{value:.digits$}")
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), rounded)
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} on {}: {}; ", self.job, self.robot, self.verdict.name())?;
        write!(f, "{:.3} s in {} cycles of {} ms", self.duration_s, self.cycles, self.period_ms)?;
        if let (Some(wall), Some(factor)) = (self.wall_time_s, self.real_time_factor) {
            write!(f, ", run in {wall:.3} s ({} × real time)", rounded(factor))?;
        }
        writeln!(f, "\n")?;
        write_checks(f, self)?;
        write_moves(f, self)?;
        write_seam(f, self)?;
        write_times(f, self)?;
        for (word, incidents) in [("notice", &self.notices), ("fault", &self.faults)] {
            for incident in incidents {
                writeln!(f, "{word} at {:.3} s, line {}: {}", incident.time_s, incident.line, incident.text)?;
            }
        }
        Ok(())
    }
}

fn write_checks(f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
    let rows = summary.checks.iter().map(|check| {
        vec![
            if check.ok { "✓" } else { "✗" }.to_owned(),
            check.name.to_owned(),
            rounded(check.value),
            format!("≤ {}", check.bound),
            check.unit.to_owned(),
            check.place.clone(),
        ]
    });
    write_table(f, &["<", "<figure", ">worst", ">bound", "<", "<where"], rows)
}

/// One line, where a seam was tracked.
fn write_seam(f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
    let Some(seam) = &summary.seam else { return Ok(()) };
    let [lateral, height] = [seam.lateral_max_mm, seam.height_max_mm].map(rounded);
    write!(f, "seam: corrected by up to {lateral} mm to the side and {height} mm in height")?;
    if let (Some(rms), Some(greatest)) = (seam.error_rms_mm, seam.error_max_mm) {
        write!(f, "; off by {} mm RMS, {} mm at most", rounded(rms), rounded(greatest))?;
    }
    writeln!(f, "\n")
}

fn write_moves(f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
    let rows = summary.moves.iter().take(MOVES).map(|of| {
        let um = of.path_deviation_max_mm().or(of.corner_error_mm).map(|mm| mm * 1e3);
        let speed = match (of.speed_min_mm_s, of.speed_max_mm_s) {
            (Some(least), Some(greatest)) => format!("{} … {}", rounded(least), rounded(greatest)),
            _ => "–".to_owned(),
        };
        vec![
            of.line.to_string(),
            of.kind.to_owned(),
            if of.arc { "on" } else { "" }.to_owned(),
            format!("{:.3}", of.end_s - of.start_s),
            optional(of.length_mm),
            optional(of.speed_programmed_mm_s),
            speed,
            optional(um),
        ]
    });
    let titles = [
        ">line",
        "<move",
        "<arc",
        ">time s",
        ">length mm",
        ">programmed mm/s",
        ">held mm/s",
        ">deviation µm",
    ];
    write_table(f, &titles, rows)?;
    match summary.moves.len().saturating_sub(MOVES) {
        0 => Ok(()),
        more => writeln!(f, "… and {more} moves more, in summary.json\n"),
    }
}

fn write_times(f: &mut fmt::Formatter<'_>, summary: &Summary) -> fmt::Result {
    let row = |times: &TimeFigures| {
        let figures = [times.p50, times.p99, times.p99_9, times.max].map(rounded);
        [vec![times.name.to_owned()], figures.to_vec()].concat()
    };
    let rows = summary.stage_times_us.iter().chain(&summary.lateness_us).map(row);
    write_table(f, &["<computing time µs", ">p50", ">p99", ">p99.9", ">max"], rows)?;
    if summary.overruns > 0 {
        writeln!(f, "{} of {} cycles were late by a period or more\n", summary.overruns, summary.cycles)?;
    }
    Ok(())
}

/// Writes rows under titles, each column as wide as its widest cell; a title's first character says to which side its
/// column is set. No rows, no table.
fn write_table(
    f: &mut fmt::Formatter<'_>,
    titles: &[&str],
    rows: impl Iterator<Item = Vec<String>>,
) -> fmt::Result {
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return Ok(());
    }
    let head = titles.iter().map(|title| title[1..].to_owned()).collect();
    let rows = [vec![head], rows].concat();
    let widest = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<_> = (0..titles.len()).map(widest).collect();
    for row in &rows {
        let mut line = String::new();
        for ((cell, title), width) in row.iter().zip(titles).zip(&widths) {
            line += &if title.starts_with('<') {
                format!("  {cell:<width$}")
            } else {
                format!("  {cell:>width$}")
            };
        }
        writeln!(f, "{}", line.trim_end())?;
    }
    writeln!(f)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (12345.6, "12346"),
            (123.456, "123.5"),
            (99.99999, "100.0"),
            (-9.87654, "-9.877"),
            (0.012345, "0.0123"),
            (2.34e-7, "2.3e-7"),
        ] {
            assert_eq!(rounded(value), text);
        }
    }
}
