//! Root-pass memory in a job: what is kept of tracked welds, and the passes that are welded from it.
//!
//! Between MEMON REC and MEMOF each weld of COMARCON … COMARCOF is kept, in its order; between MEMON PLY and MEMOF the same instructions follow what
//! was kept, in place of the sensor. What there will be by then is known from the steps before, and from files.

use std::collections::BTreeMap;

use seamline::control::Playing;
use seamline::geometry::Pose;
use seamline::seam::{LaneKey, MEMORY_POINTS, MEMORY_WELDS, Offset, Pass, RecordedWeld};

use super::arm::PlanningArm;
use super::error::Problem;
use super::planner::Planner;
use crate::cell::Cell;
use crate::sensor::passes::KeptLane;

/// A pass may be so much longer than its record, in metres: points are taught to some hundredths of a millimetre.
const SAME_LENGTH: f64 = 1e-3;
/// Control points stand at least so far apart, in metres, and some lie before and behind a weld.
const APART: f64 = 2e-3;
const BEYOND: usize = 8;

/// What is between MEMON and MEMOF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Memo {
    /// Number of the file that is written or read.
    file: u32,
    /// How far the pass lies from the record, where it is played.
    shift: Option<Offset>,
    /// Number of the next weld.
    weld: u32,
}

/// What is kept of a weld, as far as a plan knows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct KeptWeld {
    length: f64,
    /// Up to this speed its lane keeps the cell's limits of a correction, in m/s.
    fastest: f64,
}

/// What is kept, by the files' numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept(BTreeMap<u32, Vec<KeptWeld>>);

/// Where a weld's correction comes from, and where it goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Means {
    /// From the sensor, and into a record.
    Sensor(Option<LaneKey>),
    /// From a record, shifted.
    Record(LaneKey, Offset),
}

impl Memo {
    /// What the next weld is made by.
    pub(super) fn next(&mut self) -> Means {
        let key = LaneKey { file: self.file, weld: self.weld };
        self.weld += 1;
        self.shift.map_or(Means::Sensor(Some(key)), |shift| Means::Record(key, shift))
    }

    /// How far from what is taught a pass may lie beyond the correction, in metres.
    pub(super) fn shift(&self) -> Option<Offset> {
        self.shift
    }
}

impl Means {
    /// The pass that is welded by it; `None` where a sensor is followed.
    pub(super) fn playing(
        &self,
        start: f64,
        flange_from_tcp: &Pose,
        speed: f64,
        cell: &Cell,
    ) -> Option<Playing> {
        let Self::Record(key, shift) = *self else { return None };
        let pass = Pass::new(shift, speed, cell.cartesian.correction_jerk);
        Some(Playing { key, pass, start, flange_from_tcp: *flange_from_tcp })
    }

    /// Where what is tracked is kept.
    pub(super) fn record(&self, weld: RecordedWeld) -> Option<(LaneKey, RecordedWeld)> {
        match self {
            Self::Sensor(key) => key.map(|key| (key, weld)),
            Self::Record(..) => None,
        }
    }
}

impl Kept {
    /// A weld goes on to a length, at up to a speed: it will be kept, or it is held against what is.
    ///
    /// # Errors
    /// The memory has no room; a pass that is longer or faster than its record, or has none.
    pub(super) fn weld(&mut self, means: &Means, length: f64, speed: f64) -> Result<(), Problem> {
        match *means {
            Means::Sensor(None) => Ok(()),
            Means::Sensor(Some(key)) => self.keep(key, KeptWeld { length, fastest: speed }),
            Means::Record(key, _) => self.judge(key, length, speed),
        }
    }

    fn keep(&mut self, LaneKey { file, weld }: LaneKey, kept: KeptWeld) -> Result<(), Problem> {
        let welds = self.0.entry(file).or_default();
        welds.truncate(weld as usize);
        welds.push(kept);
        let all = || self.0.values().flatten();
        let points: usize = all().map(|weld| (weld.length / APART).ceil() as usize + BEYOND).sum();
        if all().count() > MEMORY_WELDS || points > MEMORY_POINTS {
            return Err(Problem::Track(format!(
                "the memory of passes is full: it holds {MEMORY_WELDS} welds and {:.1} m of them in all",
                MEMORY_POINTS as f64 * APART
            )));
        }
        Ok(())
    }

    fn judge(&self, LaneKey { file, weld }: LaneKey, length: f64, speed: f64) -> Result<(), Problem> {
        let welds = self.0.get(&file).map_or(&[][..], Vec::as_slice);
        let problem = |text: String| Err(Problem::Track(text));
        let number = weld + 1;
        let Some(kept) = welds.get(weld as usize) else {
            return problem(match welds.len() {
                0 => format!(
                    "MPF#({file}) has no record: expected MEMON REC MPF#({file}) before, or its file from an earlier run"
                ),
                count => format!("MPF#({file}) has the record of {count} welds: this is weld {number}"),
            });
        };
        if length > kept.length + SAME_LENGTH {
            return problem(format!(
                "weld {number} of MPF#({file}) was recorded over {:.1} mm: expected no more, found {:.1} mm",
                kept.length * 1e3,
                length * 1e3
            ));
        }
        if speed > kept.fastest * (1.0 + 1e-9) {
            return problem(format!(
                "the corrections of weld {number} of MPF#({file}) permit up to {:.1} mm/s: found {:.1} mm/s",
                kept.fastest * 1e3,
                speed * 1e3
            ));
        }
        Ok(())
    }
}

/// The speed up to which a lane keeps the cell's limits of a correction, in m/s.
fn fastest(lane: &KeptLane, cell: &Cell) -> f64 {
    let peaks = lane.record().peaks();
    let smooth = (cell.cartesian.correction_jerk / peaks.third).cbrt();
    let slow = cell.sensor.change_per_cycle / (cell.cycle.period * peaks.slope);
    // NaN is a lane that asks for nothing.
    f64::INFINITY.min(smooth).min(slow)
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// There are records from an earlier run.
    pub fn remember_passes(&mut self, file: u32, lanes: &[KeptLane]) {
        let kept = |lane: &KeptLane| KeptWeld {
            length: lane.weld.length,
            fastest: fastest(lane, self.cell).max(lane.weld.speed),
        };
        self.kept.0.insert(file, lanes.iter().map(kept).collect());
    }

    /// MEMON.
    pub(super) fn memory_on(&mut self, record: bool, file: u32) -> Result<(), Problem> {
        if self.tracks() {
            return Err(Problem::Track("MEMON within COMARCON: expected before it".into()));
        }
        if self.memo.is_some() {
            return Err(Problem::Track("MEMON within MEMON: expected MEMOF before it".into()));
        }
        let pass = self.cell.pass(file);
        self.memo = Some(if record {
            self.kept.0.remove(&file);
            Memo { file, shift: None, weld: 0 }
        } else {
            Memo { file: pass.of, shift: Some(pass.shift), weld: 0 }
        });
        Ok(())
    }

    /// MEMOF.
    pub(super) fn memory_off(&mut self) -> Result<(), Problem> {
        if self.tracks() {
            return Err(Problem::Track("MEMOF within COMARCON: expected behind COMARCOF".into()));
        }
        self.memo = None;
        Ok(())
    }
}
