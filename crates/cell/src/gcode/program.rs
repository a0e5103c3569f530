//! A G-code file in memory: the bytes as they were, and the words of each line.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::codes::{Code, Group, is_code};
use super::lexer::{Word, read_line};
use crate::job::{Fault, JobError, JobErrors, LoadError, Mistake};

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A program: the lines of a file up to M2, M30 or the closing `%`.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// The file as its caller named it; error messages begin with it.
    pub file: Arc<str>,
    /// The file's name without folder and extension.
    pub name: Arc<str>,
    bytes: Vec<u8>,
    pub(super) blocks: Vec<Block>,
    words: Vec<Word>,
}

/// A line with words.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// From 1.
    pub(super) line: u32,
    /// Its bytes in the file.
    bytes: Range<usize>,
    words: Range<usize>,
    /// The text of `(MSG, …)`.
    pub(super) message: Option<String>,
}

impl Program {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, or is wrong: all its mistakes that show without running it.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|reason| LoadError::Read { path: name.clone(), reason })?;
        Ok(Self::parse(&name, bytes)?)
    }

    /// The program in the bytes of a file; `file` is its path, for messages.
    ///
    /// # Errors
    /// Every mistake that shows without running it; a line gives at most one.
    pub fn parse(file: &str, bytes: Vec<u8>) -> Result<Self, JobErrors> {
        let name = Path::new(file).file_stem().map_or_else(|| file.into(), |stem| stem.to_string_lossy());
        let (file, name) = (Arc::from(file), Arc::from(&*name));
        let mut program = Self { file, name, bytes, blocks: Vec::new(), words: Vec::new() };
        let mut errors = Vec::new();
        let (mut start, mut line, mut ends) = (0, 0, false);
        while start < program.bytes.len() && !ends {
            let rest = program.bytes.get(start..).unwrap_or_default();
            let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            line += 1;
            match program.read(line, start..start + length) {
                Ok(last) => ends = last,
                Err(Fault { column, mistake }) => errors.push(program.error(line, column, mistake)),
            }
            start += length + 1;
        }
        if !ends {
            errors.push(program.error(line.max(1), 1, Mistake::MissingProgramEnd));
        }
        JobErrors::check(errors)?;
        Ok(program)
    }

    /// The file as it was read, byte for byte.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Column of the first word in a line, from 1.
    #[must_use]
    pub fn column(&self, line: u32) -> u32 {
        let index = self.blocks.binary_search_by_key(&line, |block| block.line);
        let first = index.ok().and_then(|index| self.words(self.blocks.get(index)?).first());
        first.map_or(1, |word| word.column)
    }

    /// The line that it ends with.
    pub(super) fn last_line(&self) -> u32 {
        self.blocks.last().map_or(1, |block| block.line)
    }

    pub(super) fn error(&self, line: u32, column: u32, mistake: Mistake) -> JobError {
        JobError { file: Arc::clone(&self.file), line, column, mistake }
    }

    pub(super) fn words(&self, block: &Block) -> &[Word] {
        self.words.get(block.words.clone()).unwrap_or_default()
    }

    /// A word of a block as written.
    pub(super) fn text(&self, block: &Block, word: &Word) -> String {
        word.text(self.bytes.get(block.bytes.clone()).unwrap_or_default())
    }

    /// Reads a line; true where the program ends with it.
    fn read(&mut self, line: u32, mut bytes: Range<usize>) -> Result<bool, Fault> {
        let text = self.bytes.get(bytes.clone()).unwrap_or_default();
        if line == 1 && text.starts_with(BYTE_ORDER_MARK) {
            bytes.start += BYTE_ORDER_MARK.len();
        }
        let text = self.bytes.get(bytes.clone()).unwrap_or_default();
        if text.trim_ascii() == b"%" {
            // The first one opens the program.
            return Ok(!self.blocks.is_empty());
        }
        let first = self.words.len();
        let message = read_line(text, &mut self.words).inspect_err(|_| self.words.truncate(first))?;
        let block = Block { line, bytes, words: first..self.words.len(), message };
        let words = self.words(&block);
        if words.is_empty() && block.message.is_none() {
            return Ok(false);
        }
        self.check(&block)?;
        let ends = words.iter().any(|word| word.letter == b'M' && matches!(word.value, 2.0 | 30.0));
        self.blocks.push(block);
        Ok(ends)
    }

    /// What is wrong with a line whatever stands before it.
    fn check(&self, block: &Block) -> Result<(), Fault> {
        let words = self.words(block);
        let mut groups: Vec<(Group, &Word)> = Vec::new();
        let conflict = |word: &Word, instead: &Word| {
            let [tag, instead] = [word, instead].map(|word| self.text(block, word));
            Err(Fault { column: word.column, mistake: Mistake::TagConflict { tag, instead } })
        };
        for (index, word) in words.iter().enumerate() {
            let unexpected = |expected: &'static str| {
                let found = format!("`{}`", self.text(block, word));
                Err(Fault { column: word.column, mistake: Mistake::Unexpected { found, expected } })
            };
            match word.letter {
                _ if is_code(word) => {
                    let Some(code) = Code::of(word) else {
                        return unexpected("a code such as G1, G61.1 or M30");
                    };
                    let group = code.group();
                    match groups.iter().find(|(other, _)| *other == group && group != Group::None) {
                        Some((_, instead)) => return conflict(word, instead),
                        None => groups.push((group, word)),
                    }
                }
                b'N' if index > 0 => return unexpected("N at the beginning of the line only"),
                // A program's number, alone in its line.
                b'O' if words.len() > 1 => {
                    let text = self.text(block, word);
                    let reason = "subprograms, branches and loops are not built";
                    return Err(Fault { column: word.column, mistake: Mistake::Refused { text, reason } });
                }
                letter => {
                    let earlier = words.iter().take(index).find(|other| other.letter == letter);
                    if let Some(earlier) = earlier {
                        return conflict(word, earlier);
                    }
                }
            }
        }
        Ok(())
    }
}
