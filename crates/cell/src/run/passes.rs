//! Records of passes between runs: read before a job, written after it.

use std::fs;
use std::io::ErrorKind;

use seamline::seam::LaneMemory;

use super::error::RunError;
use crate::cell::Cell;
use crate::record::write_whole;
use crate::sensor::passes::{KeptLane, of_memory, read, write};

/// Records by the numbers of their files.
pub(super) type Records = Vec<(u32, Vec<KeptLane>)>;

/// What the cell's files hold; a file that is not there holds nothing yet.
///
/// # Errors
/// A file that cannot be read, or with a mistake; a correction beyond what the cell permits.
pub(super) fn load(cell: &Cell) -> Result<Records, RunError> {
    let mut records = Vec::new();
    for pass in &cell.passes {
        let Some(path) = &pass.file else { continue };
        let name = || path.display().to_string();
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => continue,
            Err(source) => return Err(RunError::File { path: name(), source }),
        };
        let lanes = read(&text).map_err(|mistake| RunError::Records { path: name(), mistake })?;
        let most = lanes.iter().map(|lane| lane.record().peaks().offset).fold(0.0, f64::max);
        if most > cell.sensor.correction_max {
            return Err(RunError::Correction {
                path: name(),
                most_mm: most * 1e3,
                permitted_mm: cell.sensor.correction_max * 1e3,
            });
        }
        records.push((pass.number, lanes));
    }
    Ok(records)
}

/// Writes what was recorded anew. Files appear whole or not at all.
///
/// # Errors
/// Those of the file system.
pub(super) fn save(cell: &Cell, before: &Records, memory: &Records) -> Result<(), RunError> {
    for pass in &cell.passes {
        let Some(path) = &pass.file else { continue };
        let of = |records: &Records| {
            let found = records.iter().find(|(number, _)| *number == pass.number);
            found.map(|(_, lanes)| lanes.clone()).unwrap_or_default()
        };
        let lanes = of(memory);
        if lanes.is_empty() || lanes == of(before) {
            continue;
        }
        write_whole(path, write(&lanes).as_bytes())
            .map_err(|source| RunError::File { path: path.display().to_string(), source })?;
    }
    Ok(())
}

/// What a memory holds of the cell's passes.
pub(super) fn records(cell: &Cell, memory: &LaneMemory) -> Records {
    cell.passes.iter().map(|pass| (pass.number, of_memory(memory, pass.number))).collect()
}
