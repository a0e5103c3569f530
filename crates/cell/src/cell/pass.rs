//! Passes of a weld: what MEMON's files mean.

use std::path::{Path, PathBuf};

use seamline::seam::Offset;

use super::error::CellError;
use super::section::{Section, Unit};

/// What `MPF#(n)` stands for. Where the cell has none, the file is recorded and played back as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// The MPF number.
    pub number: u32,
    /// Number of the file whose record is played.
    pub of: u32,
    /// How far the pass lies from the recorded one: to the left and up, in metres.
    pub shift: Offset,
    /// Where the record is kept between runs.
    pub file: Option<PathBuf>,
}

impl Pass {
    /// What a number without a table stands for.
    #[must_use]
    pub fn plain(number: u32) -> Self {
        Self { number, of: number, shift: Offset::zeros(), file: None }
    }

    pub(super) fn read(number: u32, mut table: Section<'_>, folder: &Path) -> Result<Self, CellError> {
        let of = if table.has("of") { table.integer("of", 1..=9999)? } else { number };
        let mut part =
            |key| if table.has(key) { table.number(key, Unit::Milli, -50.0..=50.0) } else { Ok(0.0) };
        let shift = Offset::new(part("lateral_mm")?, part("height_mm")?);
        let file = table.optional_text("file")?.map(|name| folder.join(name));
        table.finish()?;
        Ok(Self { number, of, shift, file })
    }
}
