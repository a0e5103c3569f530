//! From input to output, line by line.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::Path;

use anyhow::Context as _;
use serde::Serialize;
use serde_json::Value;

use super::{Mistake, Object};

/// An answer with the question's own `id` before it.
#[derive(Serialize)]
struct Answered<'a, A> {
    id: &'a Value,
    #[serde(flatten)]
    answer: A,
}

/// The answer to a question that has none.
#[derive(Serialize)]
struct Refused {
    ok: bool,
    error: String,
}

/// A line of the input.
pub(crate) struct Question {
    /// Counted from 1.
    line: usize,
    /// What the line says, or why it says nothing.
    content: Result<Value, Mistake>,
}

impl Question {
    fn of(line: usize, text: &[u8]) -> Self {
        let content = serde_json::from_slice(text.trim_ascii_end()).map_err(|error| {
            // The parser counts lines too, from the only one it sees.
            let reason = error.to_string();
            let reason = reason.split(" at line ").next().unwrap_or(&reason);
            let hint = [&b"NaN"[..], b"Infinity"].into_iter().any(|word| contains(text, word));
            let hint = if hint { "; JSON has no NaN or Infinity, no limit is null" } else { "" };
            Mistake::new(format!("not JSON at column {}: {reason}{hint}", error.column()))
        });
        Self { line, content }
    }

    /// The question's name: any JSON value, null if it has none.
    pub(crate) fn id(&self) -> &Value {
        let id = self.content.as_ref().ok().and_then(|content| content.get("id"));
        id.unwrap_or(&Value::Null)
    }

    /// What `answer` makes of the question.
    pub(crate) fn ask<A>(
        &self,
        answer: impl FnOnce(&Object<'_>) -> Result<A, Mistake>,
    ) -> Result<A, Mistake> {
        match &self.content {
            Ok(Value::Object(members)) => answer(&Object::of_line(members)),
            Ok(other) => Err(Mistake::value("the line", other, "an object")),
            Err(mistake) => Err(mistake.clone()),
        }
    }

    /// A mistake in the question, with its line.
    pub(crate) fn located(&self, mistake: &Mistake) -> String {
        format!("line {}: {mistake}", self.line)
    }
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

/// Answers the questions of a file, or of the standard input, on the standard output.
///
/// Answers leave as soon as the input has nothing more to read at once, so that a program may wait for each before it
/// asks the next.
pub(crate) fn answer_each<A: Serialize>(
    input: Option<&Path>,
    mut answer: impl FnMut(&Object<'_>) -> Result<A, Mistake>,
) -> anyhow::Result<()> {
    let mut output = BufWriter::new(io::stdout().lock());
    let written = questions(input, |question, more| {
        let id = question.id();
        match question.ask(&mut answer) {
            Ok(answer) => write_line(&mut output, &Answered { id, answer })?,
            Err(mistake) => {
                let error = if id.is_null() { question.located(&mistake) } else { mistake.to_string() };
                write_line(&mut output, &Answered { id, answer: Refused { ok: false, error } })?;
            }
        }
        if more { Ok(()) } else { output.flush() }
    })?;
    gone_is_fine(written.and_then(|()| output.flush()))
}

/// Hands each question of a file, or of the standard input, to `take`, and whether more can be read at once. Blank
/// lines are none. The outer error is the input's, the inner one is that of `take`.
pub(crate) fn questions(
    input: Option<&Path>,
    mut take: impl FnMut(&Question, bool) -> io::Result<()>,
) -> anyhow::Result<io::Result<()>> {
    let unreadable =
        || format!("{} cannot be read", input.map_or(Path::new("the standard input"), |path| path).display());
    let source: Box<dyn Read> = match input {
        None => Box::new(io::stdin().lock()),
        Some(path) => Box::new(File::open(path).with_context(unreadable)?),
    };
    let mut reader = BufReader::new(source);
    let mut text = Vec::new();
    let mut line = 0;
    loop {
        text.clear();
        let read = reader.read_until(b'\n', &mut text).with_context(unreadable)?;
        if read == 0 {
            return Ok(Ok(()));
        }
        line += 1;
        if text.trim_ascii().is_empty() {
            continue;
        }
        let more = reader.buffer().contains(&b'\n');
        let taken = take(&Question::of(line, &text), more);
        if taken.is_err() {
            return Ok(taken);
        }
    }
}

/// Writes one value as the only line of the standard output.
pub(crate) fn print_line(value: &impl Serialize) -> anyhow::Result<()> {
    let mut output = io::stdout().lock();
    gone_is_fine(write_line(&mut output, value).and_then(|()| output.flush()))
}

fn write_line(output: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *output, value)?;
    output.write_all(b"\n")
}

/// A reader that has gone away (`seamline otg | head -1`) has what it wanted.
fn gone_is_fine(written: io::Result<()>) -> anyhow::Result<()> {
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.context("the answers cannot be written"),
    }
}
