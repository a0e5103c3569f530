//! Root-pass memory: the lanes of earlier passes, kept for passes that are welded over them.
//!
//! All records share one store of control points, one after the other in the order in which they were made. A weld that does not fit is forgotten
//! whole: half a record would be another path.

use super::Offset;
use super::lane::{Lane, LaneRecord, RecordedWeld};
use super::tracker::ControlPoint;

/// Control points of all records together: 4 m of weld with a point every 2 mm.
pub const MEMORY_POINTS: usize = 2048;
/// Welds of all records together.
pub const MEMORY_WELDS: usize = 32;

/// Which weld a record is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LaneKey {
    /// Number of the memory file, MPF.
    pub file: u32,
    /// Number of the weld in it, from 0 on, in the order of welding.
    pub weld: u32,
}

/// There is no room for another weld, or for one more control point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryFull;

impl core::fmt::Display for MemoryFull {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "the memory of passes is full: it holds {MEMORY_WELDS} welds and {MEMORY_POINTS} points")
    }
}

impl core::error::Error for MemoryFull {}

/// A weld's place in the store.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Kept {
    key: LaneKey,
    spacing: f64,
    first: i64,
    weld: RecordedWeld,
    at: usize,
    count: usize,
}

/// The memory. It is about 34 kB, lives where it is put, and allocates nothing.
#[derive(Debug, Clone)]
pub struct LaneMemory {
    points: [Offset; MEMORY_POINTS],
    used: usize,
    welds: [Kept; MEMORY_WELDS],
    count: usize,
    /// The last weld is being recorded.
    open: bool,
}

impl Default for LaneMemory {
    fn default() -> Self {
        Self::new()
    }
}

impl LaneMemory {
    /// Empty.
    #[must_use]
    pub fn new() -> Self {
        let (points, welds) = ([Offset::new(0.0, 0.0); MEMORY_POINTS], [Kept::default(); MEMORY_WELDS]);
        Self { points, used: 0, welds, count: 0, open: false }
    }

    /// Begins to record a weld: with the control points that are frozen there. An earlier record of it is
    /// forgotten.
    ///
    /// # Errors
    /// [`MemoryFull`]; then it is not recorded.
    ///
    /// Cost: where an earlier record is forgotten, up to 32 kB are moved.
    pub fn open(&mut self, key: LaneKey, lane: &Lane, weld: &RecordedWeld) -> Result<(), MemoryFull> {
        let numbers = || lane.oldest()..lane.next();
        self.add(key, (lane.spacing(), lane.oldest(), *weld))?;
        self.open = true;
        numbers().filter_map(|k| lane.point(k)).try_for_each(|point| self.push(point))
    }

    /// Keeps the next control point of the weld that is recorded, if there is one.
    ///
    /// # Errors
    /// [`MemoryFull`]; then the weld is forgotten.
    pub fn keep(&mut self, point: &ControlPoint) -> Result<(), MemoryFull> {
        let next = self.last().map(|kept| kept.first + kept.count as i64);
        if self.open && next == Some(point.number) { self.push(point.offset) } else { Ok(()) }
    }

    /// Ends the record.
    pub fn close(&mut self) {
        self.open = false;
    }

    /// Takes a record from elsewhere in. An earlier record of the weld is forgotten.
    ///
    /// # Errors
    /// [`MemoryFull`]; then it is not taken.
    pub fn insert(&mut self, key: LaneKey, record: &LaneRecord<'_>) -> Result<(), MemoryFull> {
        self.close();
        self.add(key, (record.spacing, record.first, record.weld))?;
        record.points.iter().try_for_each(|point| self.push(*point))
    }

    /// Forgets all welds of a file.
    pub fn forget(&mut self, file: u32) {
        self.forget_those(|key| key.file == file);
    }

    /// The record of a weld.
    #[must_use]
    pub fn record(&self, key: LaneKey) -> Option<LaneRecord<'_>> {
        self.records().find(|(of, _)| *of == key).map(|(_, record)| record)
    }

    /// All records, in the order in which they were made.
    pub fn records(&self) -> impl Iterator<Item = (LaneKey, LaneRecord<'_>)> {
        self.welds.iter().take(self.count).map(|kept| {
            let Kept { key, spacing, first, weld, at, count } = *kept;
            let points = self.points.get(at..at + count).unwrap_or_default();
            (key, LaneRecord { spacing, first, weld, points })
        })
    }

    fn add(
        &mut self,
        key: LaneKey,
        (spacing, first, weld): (f64, i64, RecordedWeld),
    ) -> Result<(), MemoryFull> {
        self.forget_those(|of| *of == key);
        let free = self.welds.get_mut(self.count).ok_or(MemoryFull)?;
        *free = Kept { key, spacing, first, weld, at: self.used, count: 0 };
        self.count += 1;
        Ok(())
    }

    fn push(&mut self, point: Offset) -> Result<(), MemoryFull> {
        let (free, kept) = (self.points.get_mut(self.used), self.count.checked_sub(1));
        let (Some(free), Some(kept)) = (free, kept.and_then(|last| self.welds.get_mut(last))) else {
            self.drop_last();
            return Err(MemoryFull);
        };
        *free = point;
        kept.count += 1;
        self.used += 1;
        Ok(())
    }

    fn last(&self) -> Option<&Kept> {
        self.count.checked_sub(1).and_then(|last| self.welds.get(last))
    }

    fn drop_last(&mut self) {
        if let Some(kept) = self.last().copied() {
            (self.count, self.used) = (self.count - 1, kept.at);
        }
        self.open = false;
    }

    fn forget_those(&mut self, forgotten: impl Fn(&LaneKey) -> bool) {
        let (mut count, mut used) = (0, 0);
        for k in 0..self.count {
            let Some(kept) = self.welds.get(k).copied().filter(|kept| !forgotten(&kept.key)) else {
                continue;
            };
            self.points.copy_within(kept.at..kept.at + kept.count, used);
            if let Some(place) = self.welds.get_mut(count) {
                *place = Kept { at: used, ..kept };
            }
            (count, used) = (count + 1, used + kept.count);
        }
        if count < self.count {
            self.open = false;
        }
        (self.count, self.used) = (count, used);
    }
}
