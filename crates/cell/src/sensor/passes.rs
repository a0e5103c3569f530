//! Records of passes as a CSV file: what is kept of a weld from run to run.

use seamline::seam::{LaneKey, LaneMemory, LaneRecord, MEMORY_POINTS, MEMORY_WELDS, Offset, RecordedWeld};

use super::table::{Row, TableError, rows};
use crate::record::number::push_mm;

/// The columns, in this order. Those of the weld stand in each of its rows.
pub const HEADER: &str = "weld,start_mm,length_mm,travel_mm_s,spacing_mm,point,lateral_mm,height_mm";
const NAMES: [&str; 8] =
    ["weld", "start_mm", "length_mm", "travel_mm_s", "spacing_mm", "point", "lateral_mm", "height_mm"];
/// Lengths are up to this, in metres; offsets, and distances of control points.
const LENGTH: f64 = 100.0;
const OFFSET: f64 = 0.1;
const SPACING: [f64; 2] = [1e-4, 0.1];

/// The lane of one weld.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptLane {
    /// The weld that it was recorded of.
    pub weld: RecordedWeld,
    /// Distance of the control points, in metres.
    pub spacing: f64,
    /// Number of the first one.
    pub first: i64,
    /// The control points.
    pub points: Vec<Offset>,
}

impl KeptLane {
    /// As the cycle knows it.
    #[must_use]
    pub fn record(&self) -> LaneRecord<'_> {
        LaneRecord { spacing: self.spacing, first: self.first, weld: self.weld, points: &self.points }
    }
}

/// The records of a file's number in a memory, by the numbers of their welds, as far as they are whole.
#[must_use]
pub fn of_memory(memory: &LaneMemory, file: u32) -> Vec<KeptLane> {
    let record = |weld: u32| memory.record(LaneKey { file, weld }).filter(LaneRecord::is_whole);
    let kept = |record: LaneRecord<'_>| KeptLane {
        weld: record.weld,
        spacing: record.spacing,
        first: record.first,
        points: record.points.to_vec(),
    };
    (0..).map_while(record).map(kept).collect()
}

/// Writes records; [`read`] gives the same back, bit for bit.
#[must_use]
pub fn write(lanes: &[KeptLane]) -> String {
    let mut text = Vec::from(format!("{HEADER}\n"));
    for (number, lane) in lanes.iter().enumerate() {
        let RecordedWeld { start, length, speed } = lane.weld;
        for (point, offset) in (lane.first..).zip(&lane.points) {
            text.extend_from_slice(number.to_string().as_bytes());
            for value in [start, length, speed, lane.spacing] {
                text.push(b',');
                push_mm(&mut text, value);
            }
            text.extend_from_slice(format!(",{point}").as_bytes());
            for value in [offset.x, offset.y] {
                text.push(b',');
                push_mm(&mut text, value);
            }
            text.push(b'\n');
        }
    }
    // Digits, points and commas only: nothing is lost.
    String::from_utf8_lossy(&text).into_owned()
}

/// Reads a file of records. Empty lines and lines that begin with `#` are skipped. Welds count from 0 and stand one after the other, and so do the
/// control points of each.
///
/// # Errors
/// The first mistake, with line and column. Values beyond what the memory takes are mistakes too.
pub fn read(text: &str) -> Result<Vec<KeptLane>, TableError> {
    let mut lanes: Vec<KeptLane> = Vec::new();
    let rows = rows(text, &NAMES)?;
    if let Some(row) = rows.get(MEMORY_POINTS) {
        return Err(row.error(5, "no more control points than the memory holds (2048)"));
    }
    for (k, row) in rows.iter().enumerate() {
        take(row, &mut lanes)?;
        let goes_on = match rows.get(k + 1) {
            Some(next) => next.whole(0)? == row.whole(0)?,
            None => false,
        };
        if !goes_on && !lanes.last().is_some_and(|lane| lane.record().is_whole()) {
            return Err(row.error(5, "control points up to the weld's end"));
        }
    }
    Ok(lanes)
}

fn take(row: &Row<'_>, lanes: &mut Vec<KeptLane>) -> Result<(), TableError> {
    let within = |index: usize, [least, most]: [f64; 2], expected| {
        let value = row.length(index, expected)?;
        // Written so that NaN fails.
        if value >= least && value <= most { Ok(value) } else { Err(row.error(index, expected)) }
    };
    let start = within(1, [-LENGTH, LENGTH], "a place, in mm")?;
    let length = within(2, [0.0, LENGTH], "a length up to 100 m, in mm")?;
    let speed = within(3, [1e-5, 10.0], "a speed up to 10 m/s, in mm/s")?;
    let spacing = within(4, SPACING, "from 0.1 to 100 mm")?;
    let weld = RecordedWeld { start, length, speed };
    let (number, point) = (row.whole(0)?, row.whole(5)?);
    let offset = |index| within(index, [-OFFSET, OFFSET], "from -100 to 100 mm");
    let offset = Offset::new(offset(6)?, offset(7)?);
    let last = lanes.len() as i64 - 1;
    let count = lanes.len();
    match lanes.last_mut().filter(|_| number == last) {
        Some(lane) if lane.weld != weld || lane.spacing != spacing => {
            Err(row.error(0, "start, length, travel and spacing as in the weld's first row"))
        }
        Some(lane) if point != lane.first + lane.points.len() as i64 => {
            Err(row.error(5, "the number after that of the row before"))
        }
        Some(lane) => {
            lane.points.push(offset);
            Ok(())
        }
        None if number != last + 1 => Err(row.error(0, "the weld of the row before, or the next one")),
        None if count >= MEMORY_WELDS => Err(row.error(0, "no more welds than the memory holds (32)")),
        None => {
            lanes.push(KeptLane { weld, spacing, first: point, points: vec![offset] });
            Ok(())
        }
    }
}
