//! The words of one line, each with its place.
//!
//! A word is a letter, in either case, and a number; blanks may stand between them. Comments in parentheses may stand
//! between words, one behind `;` ends the line.

use crate::job::{Fault, Mistake, column, printable};

/// A letter with its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Word {
    /// Upper case.
    pub(super) letter: u8,
    pub(super) value: f64,
    /// Column of the letter in bytes, from 1.
    pub(super) column: u32,
    /// Length in bytes, from the letter to the last digit.
    length: u32,
}

impl Word {
    /// The word as written in its line.
    pub(super) fn text(&self, line: &[u8]) -> String {
        let start = self.column as usize - 1;
        printable(line.get(start..start + self.length as usize).unwrap_or_default())
    }
}

/// No word of a machine's program needs a greater number.
const GREATEST: f64 = 1e9;
const PARAMETERS: &str = "parameters and expressions are not built";

/// Appends the line's words, and gives the text of its `(MSG, …)` comment where it has one.
pub(super) fn read_line(line: &[u8], words: &mut Vec<Word>) -> Result<Option<String>, Fault> {
    let mut message = None;
    let mut at = 0;
    // Ends: each turn takes at least one byte.
    while let Some(&byte) = line.get(at) {
        match byte {
            b' ' | b'\t' | b'\r' => at += 1,
            b';' => break,
            b'(' => {
                let end = comment_end(line, at)?;
                let text = line.get(at + 1..end).unwrap_or_default();
                message = message_in(text).or(message);
                at = end + 1;
            }
            b'A'..=b'Z' | b'a'..=b'z' => {
                let word = word(line, at)?;
                at += word.length as usize;
                words.push(word);
            }
            _ => return Err(foreign(line, at)),
        }
    }
    Ok(message)
}

/// A byte that begins no word.
fn foreign(line: &[u8], at: usize) -> Fault {
    let first = line.get(..at).unwrap_or_default().trim_ascii().is_empty();
    let refused =
        |reason| Mistake::Refused { text: printable(line.get(at..=at).unwrap_or_default()), reason };
    let mistake = match line.get(at) {
        Some(b'#' | b'[') => refused(PARAMETERS),
        Some(b'*') => refused("checksums are not built"),
        Some(b'/') if first => refused("whether this line runs depends on a switch that is not there"),
        _ => {
            let found = format!("`{}`", printable(line.get(at..=at).unwrap_or_default()));
            Mistake::Unexpected { found, expected: "a letter and its number, or a comment" }
        }
    };
    Fault { column: column(at), mistake }
}

/// Where the comment that begins at `at` is closed.
fn comment_end(line: &[u8], at: usize) -> Result<usize, Fault> {
    let rest = line.get(at + 1..).unwrap_or_default();
    match rest.iter().position(|byte| matches!(byte, b'(' | b')')) {
        Some(length) if rest.get(length) == Some(&b')') => Ok(at + 1 + length),
        Some(length) => {
            let mistake = Mistake::Unexpected { found: "`(`".into(), expected: "`)`: comments do not nest" };
            Err(Fault { column: column(at + 1 + length), mistake })
        }
        None => {
            let found = "an open parenthesis".into();
            let mistake = Mistake::Unexpected { found, expected: "`)` in the same line" };
            Err(Fault { column: column(at), mistake })
        }
    }
}

/// The text of a comment that is a message to the operator.
fn message_in(comment: &[u8]) -> Option<String> {
    let comment = comment.trim_ascii();
    let (mark, text) = comment.split_at_checked(4)?;
    mark.eq_ignore_ascii_case(b"MSG,").then(|| printable(text.trim_ascii()))
}

/// The word that begins at `at` with a letter.
fn word(line: &[u8], at: usize) -> Result<Word, Fault> {
    let rest = line.get(at..).unwrap_or_default();
    let letter = rest.first().map_or(0, u8::to_ascii_uppercase);
    let count = |from: usize, belongs: fn(&u8) -> bool| {
        rest.get(from..).unwrap_or_default().iter().take_while(|byte| belongs(byte)).count()
    };
    let start = 1 + count(1, |byte| matches!(byte, b' ' | b'\t'));
    let sign = count(start, |byte| matches!(byte, b'+' | b'-')).min(1);
    let end = start + sign + count(start + sign, |byte| byte.is_ascii_digit() || *byte == b'.');
    let number = rest.get(start..end).and_then(|bytes| std::str::from_utf8(bytes).ok()).unwrap_or_default();
    let fault = |mistake| Fault { column: column(at), mistake };
    if matches!(rest.get(start), Some(b'#' | b'[')) {
        let text = printable(rest.get(..=start).unwrap_or_default());
        return Err(fault(Mistake::Refused { text, reason: PARAMETERS }));
    }
    let Ok(value) = number.parse::<f64>() else {
        let found = printable(rest.get(..end.max(1)).unwrap_or_default().trim_ascii_end());
        return Err(fault(Mistake::BadNumber { found, expected: "a letter and its number, such as X12.5" }));
    };
    if value.abs() > GREATEST {
        let mistake = Mistake::OutOfRange { what: "the number", value, min: -GREATEST, max: GREATEST };
        return Err(fault(mistake));
    }
    // A line is shorter than 4 GiB, or its end is not found again.
    Ok(Word { letter, value, column: column(at), length: u32::try_from(end).unwrap_or(u32::MAX) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_their_places_and_numbers() {
        let line = b"  n10g1 X-.5(to the \x82 right)y +3. Z 0 ; g2";
        let mut words = Vec::new();
        assert_eq!(read_line(line, &mut words), Ok(None));
        let found: Vec<_> = words.iter().map(|w| (w.column, w.letter, w.value, w.text(line))).collect();
        let expected = [
            (3, b'N', 10.0, "n10"),
            (6, b'G', 1.0, "g1"),
            (9, b'X', -0.5, "X-.5"),
            (29, b'Y', 3.0, "y +3."),
            (35, b'Z', 0.0, "Z 0"),
        ];
        assert_eq!(found, expected.map(|(c, l, v, t)| (c, l, v, t.to_owned())));
    }

    #[test]
    fn messages_are_found() {
        let message = |line: &[u8]| read_line(line, &mut Vec::new()).unwrap();
        assert_eq!(message(b"(msg, Turn the part )M0"), Some("Turn the part".into()));
        assert_eq!(message(b"(a message)"), None);
    }
}
