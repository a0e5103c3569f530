//! The sensor that a cell asks for, and what may go wrong with it on purpose.

use seamline::seam::{Instant, Offset, Reading, SeamSensor, Sensor, TaughtPath};
use thiserror::Error;

use super::csv;
use super::egm::{EgmSensor, EgmSettings};
use super::laser::SimulatedLaser;
use super::replay::Replay;
use super::table::TableError;
use crate::cell::{Cell, SensorSource};

/// How far aside readings jump, in metres.
const JUMP: f64 = 8e-3;

/// What goes wrong with a sensor on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorFault {
    /// No readings.
    Silent,
    /// Readings that are no numbers.
    Nan,
    /// Readings that jump aside, as by another edge that is taken for the seam.
    Jump,
}

/// A seam sensor by the cell's `sensor.source`.
#[derive(Debug)]
pub struct CellSensor {
    source: Source,
    fault: Option<SensorFault>,
}

#[derive(Debug)]
enum Source {
    None,
    Simulated(Box<SimulatedLaser>),
    Replay(Replay),
    Egm(EgmSensor),
}

/// Why there is no such sensor.
#[derive(Debug, Error)]
pub enum SensorError {
    /// The recording cannot be read.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The recording has a mistake.
    #[error("{path}: {mistake}")]
    Readings {
        /// The file.
        path: String,
        /// Where, and what was expected.
        mistake: TableError,
    },
    /// The address cannot be bound, or the thread cannot be started.
    #[error("seam sensor: {0}")]
    Egm(std::io::Error),
}

impl CellSensor {
    /// No sensor.
    #[must_use]
    pub fn none() -> Self {
        Self { source: Source::None, fault: None }
    }

    /// The cell's: opens its file or its socket.
    ///
    /// # Errors
    /// [`SensorError`].
    pub fn from_cell(cell: &Cell) -> Result<Self, SensorError> {
        let source = match &cell.sensor.source {
            SensorSource::None => Source::None,
            SensorSource::Simulated => Source::Simulated(Box::new(SimulatedLaser::from_cell(cell))),
            SensorSource::Replay(path) => {
                let name = || path.display().to_string();
                let text = std::fs::read_to_string(path)
                    .map_err(|reason| SensorError::File { path: name(), reason })?;
                let arrivals =
                    csv::read(&text).map_err(|mistake| SensorError::Readings { path: name(), mistake })?;
                Source::Replay(Replay::new(arrivals))
            }
            SensorSource::Egm => {
                let (egm, age_max) = (cell.sensor.egm, cell.sensor.age_max);
                let settings = EgmSettings { listen: egm.listen, client: egm.client, age_max };
                Source::Egm(EgmSensor::open(&settings).map_err(SensorError::Egm)?)
            }
        };
        Ok(Self { source, fault: None })
    }

    /// Something goes wrong from now on.
    pub fn inject(&mut self, fault: SensorFault) {
        self.fault = Some(fault);
    }

    /// Nothing is wrong any more.
    pub fn clear_faults(&mut self) {
        self.fault = None;
    }

    /// The link to an EGM client, if that is the source: its address, and what became of its datagrams.
    #[must_use]
    pub fn egm(&self) -> Option<&EgmSensor> {
        match &self.source {
            Source::Egm(sensor) => Some(sensor),
            _ => None,
        }
    }

    /// Where the simulated seam really runs, from the taught path; `None` where nobody knows.
    #[must_use]
    pub fn true_seam(&self, s: f64) -> Option<Offset> {
        match &self.source {
            Source::Simulated(laser) => Some(laser.seam().offset(s)),
            _ => None,
        }
    }
}

impl SeamSensor for CellSensor {
    fn poll(&mut self, torch: &Instant, sensor: &Sensor, path: &impl TaughtPath) -> Option<Reading> {
        let mut reading = match &mut self.source {
            Source::None => None,
            Source::Simulated(laser) => laser.poll(torch, sensor, path),
            Source::Replay(replay) => replay.poll(torch, sensor, path),
            Source::Egm(egm) => egm.poll(torch, sensor, path),
        }?;
        match self.fault {
            None => {}
            Some(SensorFault::Silent) => return None,
            Some(SensorFault::Nan) => reading.lateral = f64::NAN,
            Some(SensorFault::Jump) => reading.lateral += JUMP,
        }
        Some(reading)
    }
}
