//! Numbers as text, without loss: the shortest decimal text that reads back as the same number.
//!
//! Lengths are metres inside and millimetres in the file. Multiplying by 1000 would round, so the decimal point of
//! the text moves instead, and moves back on reading.

/// Appends `value`; nothing for NaN, so that the cell of a table stays empty.
pub(crate) fn push(text: &mut Vec<u8>, value: f64) {
    if !value.is_nan() {
        text.extend_from_slice(zmij::Buffer::new().format(value).as_bytes());
    }
}

/// Appends a length given in metres as millimetres: exactly the decimal number, times 1000.
pub(crate) fn push_mm(text: &mut Vec<u8>, metres: f64) {
    if metres.is_nan() {
        return;
    }
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(metres);
    if let Some((mantissa, exponent)) = digits.split_once('e') {
        let exponent = exponent.parse::<i32>().unwrap_or(0) + 3;
        text.extend_from_slice(format!("{mantissa}e{exponent}").as_bytes());
        return;
    }
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits), |rest| ("-", rest));
    text.extend_from_slice(sign.as_bytes());
    // Infinity has no point and no digits to move.
    let Some((whole, fraction)) = digits.split_once('.') else {
        text.extend_from_slice(digits.as_bytes());
        return;
    };
    let (moved, rest) = fraction.split_at(fraction.len().min(3));
    let start = text.len();
    text.extend_from_slice(whole.as_bytes());
    text.extend_from_slice(moved.as_bytes());
    text.extend_from_slice(&b"000"[moved.len()..]);
    let zeros = text[start..].iter().take_while(|digit| **digit == b'0').count();
    let superfluous = zeros.min(text.len() - start - 1);
    text.copy_within(start + superfluous.., start);
    text.truncate(text.len() - superfluous);
    text.push(b'.');
    text.extend_from_slice(if rest.is_empty() { b"0" } else { rest.as_bytes() });
}

/// Reads what [`push`] wrote.
pub(crate) fn parse(text: &str) -> Option<f64> {
    if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() }
}

/// Reads what [`push_mm`] wrote, in metres.
pub(crate) fn parse_mm(text: &str) -> Option<f64> {
    if text.is_empty() {
        return Some(f64::NAN);
    }
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    // Infinity takes no exponent.
    if mantissa.ends_with(|c: char| c.is_ascii_digit() || c == '.') {
        format!("{mantissa}e{}", exponent - 3).parse().ok()
    } else {
        mantissa.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::testing::Random;

    fn text(value: f64, write: fn(&mut Vec<u8>, f64)) -> String {
        let mut text = Vec::new();
        write(&mut text, value);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn millimetres_move_the_point() {
        for (metres, mm) in [
            (0.0, "0.0"),
            (-0.0, "-0.0"),
            (1.0, "1000.0"),
            (0.8123456, "812.3456"),
            (-0.02, "-20.0"),
            (0.001, "1.0"),
            (0.0001, "0.1"),
            (12.345, "12345.0"),
            (1e-9, "1e-6"),
            (f64::INFINITY, "inf"),
            (f64::NAN, ""),
        ] {
            assert_eq!(text(metres, push_mm), mm);
        }
    }

    /// 200,000 numbers of any exponent, and as many of everyday size, come back with the same bits.
    #[test]
    fn numbers_come_back_bit_for_bit() {
        let mut random = Random::new(7);
        for case in 0..400_000 {
            let value = if case % 2 == 0 {
                f64::from_bits(random.bits())
            } else {
                random.within(-3.0, 3.0) * 10f64.powi(-(case % 9))
            };
            if value.is_nan() {
                continue;
            }
            assert_eq!(parse(&text(value, push)).unwrap().to_bits(), value.to_bits());
            // A length near the greatest number has no room for a factor of 1000.
            if value.abs() < 1e300 {
                assert_eq!(parse_mm(&text(value, push_mm)).unwrap().to_bits(), value.to_bits(), "{value:e}");
            }
        }
    }
}
