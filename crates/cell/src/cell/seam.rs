//! The seam of the simulated cell.

use seamline::seam::Offset;

use super::error::CellError;
use super::section::{Section, Unit};
use crate::sensor::SeamFeature;

/// Range of offsets in mm, of places and lengths in mm.
const OFFSET: std::ops::RangeInclusive<f64> = -100.0..=100.0;
const PLACE: std::ops::RangeInclusive<f64> = -1e5..=1e5;
const LENGTH: std::ops::RangeInclusive<f64> = 0.1..=1e5;

/// What a table adds to the seam.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Sine,
    Drift,
    Step,
    Kink,
    Tack,
    Gap,
}

/// The features by ascending number.
pub(super) fn read_all(section: &mut Section<'_>) -> Result<Vec<SeamFeature>, CellError> {
    section.numbered("seam", 1..=9999)?.into_iter().map(|(_, table)| read(table)).collect()
}

fn read(mut table: Section<'_>) -> Result<SeamFeature, CellError> {
    let kinds = [
        ("sine", Kind::Sine),
        ("drift", Kind::Drift),
        ("step", Kind::Step),
        ("kink", Kind::Kink),
        ("tack", Kind::Tack),
        ("gap", Kind::Gap),
    ];
    let kind = table.choice("kind", &kinds)?;
    let at = table.number("at_mm", Unit::Milli, PLACE)?;
    let length = |table: &mut Section<'_>| table.number("length_mm", Unit::Milli, LENGTH);
    let feature = match kind {
        Kind::Sine => SeamFeature::Sine { amplitude: offset(&mut table)?, length: length(&mut table)?, at },
        Kind::Drift => SeamFeature::Drift { offset: offset(&mut table)?, at, length: length(&mut table)? },
        Kind::Step => SeamFeature::Step { offset: offset(&mut table)?, at },
        Kind::Kink => SeamFeature::Kink { slope: slope(&mut table)?, at },
        Kind::Tack => {
            let height = table.number("height_mm", Unit::Milli, OFFSET)?;
            SeamFeature::Tack { height, at, length: length(&mut table)? }
        }
        Kind::Gap => SeamFeature::Gap { at, length: length(&mut table)? },
    };
    table.finish()?;
    Ok(feature)
}

/// To the left and up; what is not given is zero.
fn offset(table: &mut Section<'_>) -> Result<Offset, CellError> {
    let mut part = |key| if table.has(key) { table.number(key, Unit::Milli, OFFSET) } else { Ok(0.0) };
    Ok(Offset::new(part("lateral_mm")?, part("height_mm")?))
}

/// Likewise, as angles.
fn slope(table: &mut Section<'_>) -> Result<Offset, CellError> {
    let mut part = |key| if table.has(key) { table.number(key, Unit::Degree, -45.0..=45.0) } else { Ok(0.0) };
    Ok(Offset::new(part("lateral_deg")?.tan(), part("height_deg")?.tan()))
}
