//! Readings as a CSV file.

use seamline::seam::Reading;
use thiserror::Error;

use crate::record::number::{parse, parse_mm, push, push_mm};

/// The columns, in this order.
pub const HEADER: &str = "arrival_s,exposure_s,lateral_mm,height_mm,gap_mm,quality";
const NAMES: [&str; 6] = ["arrival_s", "exposure_s", "lateral_mm", "height_mm", "gap_mm", "quality"];

/// A reading with the time at which the cycle got it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// In seconds on the cycle's clock.
    pub time: f64,
    /// What arrived.
    pub reading: Reading,
}

/// What is wrong with a file of readings, and where. Lines and columns count from 1, columns in fields.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReadingsError {
    /// Another first line.
    #[error("line 1: `{found}`: expected the columns {HEADER}")]
    Header {
        /// What stands there, cut to a readable length.
        found: String,
    },
    /// Too few fields, or too many.
    #[error("line {line}: {found} columns: expected {}, {HEADER}", NAMES.len())]
    Columns {
        /// Which line.
        line: usize,
        /// How many fields it has.
        found: usize,
    },
    /// A field that is not as its column wants it.
    #[error("line {line}, column {column} ({}): `{found}`: expected {expected}", NAMES[column - 1])]
    Field {
        /// Which line.
        line: usize,
        /// Which field.
        column: usize,
        /// What stands there, cut to a readable length.
        found: String,
        /// What could stand there.
        expected: &'static str,
    },
}

/// Writes readings; [`read`] gives the same back, bit for bit. What is no number stays an empty field.
#[must_use]
pub fn write(arrivals: &[Arrival]) -> String {
    let mut text = Vec::from(format!("{HEADER}\n"));
    for Arrival { time, reading } in arrivals {
        push(&mut text, *time);
        text.push(b',');
        push(&mut text, reading.exposure);
        for length in [reading.lateral, reading.height, reading.gap.unwrap_or(f64::NAN)] {
            text.push(b',');
            push_mm(&mut text, length);
        }
        text.push(b',');
        push(&mut text, reading.quality);
        text.push(b'\n');
    }
    // Digits, points and commas only: nothing is lost.
    String::from_utf8_lossy(&text).into_owned()
}

/// Reads a file of readings. Empty lines and lines that begin with `#` are skipped.
///
/// An empty `gap_mm` is a sensor that does not measure the gap; an empty `lateral_mm`, `height_mm` or `quality` is a reading that is no number.
/// Rows stand in the order of arrival.
///
/// # Errors
/// The first mistake, with line and column.
pub fn read(text: &str) -> Result<Vec<Arrival>, ReadingsError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let header = lines.next().map_or("", |(_, line)| line);
    if !header.split(',').map(str::trim).eq(NAMES) {
        return Err(ReadingsError::Header { found: cut(header) });
    }
    let mut arrivals: Vec<Arrival> = Vec::new();
    for (line, content) in lines {
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let before = arrivals.last().map_or(f64::NEG_INFINITY, |arrival| arrival.time);
        arrivals.push(row(line, content, before)?);
    }
    Ok(arrivals)
}

fn row(line: usize, content: &str, before: f64) -> Result<Arrival, ReadingsError> {
    let fields: Vec<&str> = content.split(',').map(str::trim).collect();
    let Ok(fields) = <[&str; NAMES.len()]>::try_from(fields.as_slice()) else {
        return Err(ReadingsError::Columns { line, found: fields.len() });
    };
    let error = |index: usize, expected| ReadingsError::Field {
        line,
        column: index + 1,
        found: cut(fields[index]),
        expected,
    };
    let seconds = |index: usize| {
        parse(fields[index]).filter(|time| time.is_finite()).ok_or_else(|| error(index, "seconds"))
    };
    let length =
        |index: usize| parse_mm(fields[index]).ok_or_else(|| error(index, "millimetres, or nothing"));
    let time = seconds(0)?;
    if time < before {
        return Err(error(0, "no earlier arrival than in the row before"));
    }
    let exposure = seconds(1)?;
    if exposure > time {
        return Err(error(1, "an exposure before the arrival"));
    }
    let gap = Some(length(4)?).filter(|gap| !gap.is_nan());
    let quality = parse(fields[5]).ok_or_else(|| error(5, "a number, or nothing"))?;
    let reading = Reading { lateral: length(2)?, height: length(3)?, gap, exposure, quality };
    Ok(Arrival { time, reading })
}

fn cut(text: &str) -> String {
    text.chars().take(60).collect()
}
