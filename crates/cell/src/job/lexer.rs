//! Tokens of one line, each with its place.
//!
//! Lines are bytes: comments and strings may be Shift-JIS, whose second bytes overlap ASCII letters but never
//! quotes, blanks or slashes. Names of labels and jobs may hold `-` and begin with a digit, so that only the parser
//! knows where one stands: it asks for it with [`Lexer::name`].

use super::MAX_DEPTH;
use super::error::Mistake;

/// A mistake in a line, before file and line number are known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    /// Column in bytes, from 1.
    pub(crate) column: u32,
    pub(crate) mistake: Mistake,
}

/// One token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind<'a>,
    /// Offset of the first byte in the line.
    pub(super) start: usize,
    /// Offset behind the last byte.
    pub(super) end: usize,
}

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TokenKind<'a> {
    /// Letters, digits, `_`, `$`; does not begin with a digit.
    Word(&'a str),
    /// Begins with a digit, or a point and a digit; whether it is a number shows when it is read.
    Number(&'a str),
    /// A string in quotes, without them.
    Text(&'a [u8]),
    /// `=`, `<`, `>`, `<>`, `<=`, `>=`, or any other single byte.
    Symbol(&'a [u8]),
    /// Nothing more on this line.
    End,
}

/// Reads a line token by token.
#[derive(Debug, Clone)]
pub(super) struct Lexer<'a> {
    line: &'a [u8],
    at: usize,
    end: usize,
    depth: usize,
}

impl<'a> Lexer<'a> {
    /// Reads `line[start..end]`; columns count from the line's beginning.
    pub(super) fn new(line: &'a [u8], start: usize, end: usize) -> Self {
        Self { line, at: start, end: end.min(line.len()), depth: 0 }
    }

    /// The next token, left in place.
    pub(super) fn peek(&self) -> Token<'a> {
        let start = self.skip_blanks();
        let rest = self.line.get(start..self.end).unwrap_or_default();
        let Some(&first) = rest.first() else {
            return Token { kind: TokenKind::End, start, end: start };
        };
        let (kind, length) = match first {
            b'A'..=b'Z' | b'a'..=b'z' | b'_' | b'$' => {
                let length = length_of(rest, |b| b.is_ascii_alphanumeric() || b == b'_' || b == b'$');
                (TokenKind::Word(ascii(rest, length)), length)
            }
            b'0'..=b'9' => number(rest),
            b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => number(rest),
            b'"' => match rest.iter().skip(1).position(|b| *b == b'"') {
                Some(inner) => (TokenKind::Text(rest.get(1..=inner).unwrap_or_default()), inner + 2),
                None => (TokenKind::Symbol(rest.get(..1).unwrap_or_default()), 1),
            },
            _ => {
                let length = match (first, rest.get(1)) {
                    (b'<', Some(b'>' | b'=')) | (b'>', Some(b'=')) => 2,
                    _ => 1,
                };
                (TokenKind::Symbol(rest.get(..length).unwrap_or_default()), length)
            }
        };
        Token { kind, start, end: start + length }
    }

    /// The next token, taken.
    pub(super) fn next(&mut self) -> Token<'a> {
        let token = self.peek();
        self.at = token.end;
        token
    }

    /// The characters up to the next blank, taken.
    pub(super) fn name(&mut self) -> Token<'a> {
        let start = self.skip_blanks();
        let rest = self.line.get(start..self.end).unwrap_or_default();
        let length = length_of(rest, |b| b != b' ' && b != b'\t');
        self.at = start + length;
        let kind = if length == 0 {
            TokenKind::End
        } else {
            TokenKind::Text(rest.get(..length).unwrap_or_default())
        };
        Token { kind, start, end: self.at }
    }

    /// All that is left, without blanks at either end, taken.
    pub(super) fn rest(&mut self) -> &'a [u8] {
        let start = self.skip_blanks();
        self.at = self.end;
        self.line.get(start..self.end).unwrap_or_default().trim_ascii_end()
    }

    /// Goes back (or on) to an offset in the line.
    pub(super) fn move_to(&mut self, offset: usize) {
        self.at = offset.min(self.end);
    }

    /// One level deeper into parentheses; too deep is an error, so that no line can exhaust the stack.
    pub(super) fn enter(&mut self) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth <= MAX_DEPTH {
            return Ok(());
        }
        Err(Fault { column: self.column(), mistake: Mistake::TooDeep { limit: MAX_DEPTH } })
    }

    /// One level up again.
    pub(super) fn leave(&mut self) {
        self.depth = self.depth.saturating_sub(1);
    }

    /// The column of the next token, from 1.
    pub(super) fn column(&self) -> u32 {
        column(self.skip_blanks())
    }

    /// An error at the next token: it is not what was expected.
    pub(super) fn unexpected(&self, expected: &'static str) -> Fault {
        let token = self.peek();
        let mistake = match token.kind {
            TokenKind::Symbol(b"\"") => {
                Mistake::Unexpected { found: "an open quote".into(), expected: "a closing quote" }
            }
            _ => Mistake::Unexpected { found: self.describe(token), expected },
        };
        Fault { column: column(token.start), mistake }
    }

    /// An error at the next token: it should be a number.
    pub(super) fn bad_number(&self, expected: &'static str) -> Fault {
        let token = self.peek();
        if !matches!(token.kind, TokenKind::Number(_) | TokenKind::Symbol(b"-")) {
            return self.unexpected(expected);
        }
        let rest = self.line.get(token.start..self.end).unwrap_or_default();
        let length = length_of(rest, |b| !matches!(b, b' ' | b'\t' | b',' | b')' | b']'));
        let found = printable(rest.get(..length).unwrap_or_default());
        Fault { column: column(token.start), mistake: Mistake::BadNumber { found, expected } }
    }

    fn describe(&self, token: Token<'a>) -> String {
        match token.kind {
            TokenKind::End => "the end of the line".into(),
            _ => format!("`{}`", printable(self.line.get(token.start..token.end).unwrap_or_default())),
        }
    }

    fn skip_blanks(&self) -> usize {
        let rest = self.line.get(self.at..self.end).unwrap_or_default();
        self.at + length_of(rest, |b| b == b' ' || b == b'\t')
    }
}

/// The column of an offset: from 1, and never beyond `u32`.
pub(crate) fn column(offset: usize) -> u32 {
    u32::try_from(offset).map_or(u32::MAX, |o| o.saturating_add(1))
}

/// Bytes as text: as they are where they are UTF-8, escaped otherwise.
pub(crate) fn printable(bytes: &[u8]) -> String {
    std::str::from_utf8(bytes).map_or_else(|_| bytes.escape_ascii().to_string(), str::to_owned)
}

fn number(rest: &[u8]) -> (TokenKind<'_>, usize) {
    let length = length_of(rest, |b| b.is_ascii_alphanumeric() || b == b'.' || b == b'_');
    (TokenKind::Number(ascii(rest, length)), length)
}

fn length_of(bytes: &[u8], belongs: impl Fn(u8) -> bool) -> usize {
    bytes.iter().take_while(|b| belongs(**b)).count()
}

fn ascii(bytes: &[u8], length: usize) -> &str {
    bytes.get(..length).and_then(|b| std::str::from_utf8(b).ok()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_have_their_places() {
        let line = b"\tJUMP *1 IF B010<>-1.5 \"\x82\xa0\" @";
        let mut lexer = Lexer::new(line, 0, line.len());
        let mut seen = Vec::new();
        for _ in 0..20 {
            let token = lexer.next();
            if token.kind == TokenKind::End {
                break;
            }
            seen.push((column(token.start), printable(&line[token.start..token.end])));
        }
        let expected = [
            (2, "JUMP"),
            (7, "*"),
            (8, "1"),
            (10, "IF"),
            (13, "B010"),
            (17, "<>"),
            (19, "-"),
            (20, "1.5"),
            (24, "\\\"\\x82\\xa0\\\""),
            (29, "@"),
        ];
        assert_eq!(seen, expected.map(|(c, t)| (c, t.to_owned())));
    }

    #[test]
    fn names_run_to_the_next_blank() {
        let line = b"CALL JOB:1-weld_A ARGF1";
        let mut lexer = Lexer::new(line, 9, line.len());
        assert_eq!(lexer.name().kind, TokenKind::Text(b"1-weld_A"));
        assert_eq!(lexer.rest(), b"ARGF1");
        assert_eq!(lexer.name().kind, TokenKind::End);
    }
}
