//! A signal from a CSV file.

use super::Signal;
use super::error::CsvError;

/// Reads `time_s, acceleration` rows, in any unit of acceleration.
///
/// A first line of words is a header. Empty lines and lines that begin with `#` are skipped.
///
/// # Errors
/// The first line that is not two finite numbers, or whose time does not rise.
pub fn read_signal(text: &str) -> Result<Signal, CsvError> {
    let mut signal = Signal { times: Vec::new(), values: Vec::new() };
    let mut header_may_come = true;
    for (index, content) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let (line, content) = (index + 1, content.trim());
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let may_be_header = std::mem::replace(&mut header_may_come, false);
        let Some((time, value)) = row(content) else {
            if may_be_header && content.split(',').all(|field| field.trim().parse::<f64>().is_err()) {
                continue;
            }
            return Err(CsvError::Line { line, text: content.chars().take(60).collect() });
        };
        if let Some(&last) = signal.times.last()
            && time <= last
        {
            return Err(CsvError::Time { line, time, last });
        }
        signal.times.push(time);
        signal.values.push(value);
    }
    if signal.times.is_empty() { Err(CsvError::Empty) } else { Ok(signal) }
}

/// Two finite numbers.
fn row(text: &str) -> Option<(f64, f64)> {
    let (time, value) = text.split_once(',')?;
    let number = |field: &str| field.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    Some((number(time)?, number(value)?))
}
