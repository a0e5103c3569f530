//! Readings as a CSV file.

use seamline::seam::Reading;

use super::table::{Row, TableError, rows};
use crate::record::number::{push, push_mm};

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
pub fn read(text: &str) -> Result<Vec<Arrival>, TableError> {
    let mut arrivals: Vec<Arrival> = Vec::new();
    for row in rows(text, &NAMES)? {
        let before = arrivals.last().map_or(f64::NEG_INFINITY, |arrival| arrival.time);
        arrivals.push(arrival(&row, before)?);
    }
    Ok(arrivals)
}

fn arrival(row: &Row<'_>, before: f64) -> Result<Arrival, TableError> {
    let seconds = |index: usize| {
        let time = row.number(index, "seconds")?;
        if time.is_finite() { Ok(time) } else { Err(row.error(index, "seconds")) }
    };
    let length = |index: usize| row.length(index, "millimetres, or nothing");
    let time = seconds(0)?;
    if time < before {
        return Err(row.error(0, "no earlier arrival than in the row before"));
    }
    let exposure = seconds(1)?;
    if exposure > time {
        return Err(row.error(1, "an exposure before the arrival"));
    }
    let gap = Some(length(4)?).filter(|gap| !gap.is_nan());
    let quality = row.number(5, "a number, or nothing")?;
    let reading = Reading { lateral: length(2)?, height: length(3)?, gap, exposure, quality };
    Ok(Arrival { time, reading })
}
