//! Faults on purpose, at the times that the cell gives.

use seamline::control::StageClock;
use seamline::safety::Fault;

use super::machine::Machine;
use crate::cell::{FaultKind, ScriptedFault};
use crate::plan::PlanningArm;
use crate::sensor::SensorFault;
use crate::sim::{ArcFault, InjectedFault, SimulatedArc, SimulatedDrive};

/// The code of an alarm on purpose.
const ALARM: u32 = 999;
/// How far an encoder jumps, in radians or metres.
const JUMP: f64 = 0.5;

/// What goes wrong in a run, by ascending time.
#[derive(Debug, Clone)]
pub struct FaultScript {
    faults: Vec<ScriptedFault>,
    next: usize,
    late: bool,
}

impl FaultScript {
    /// The faults of a cell.
    #[must_use]
    pub fn new(faults: &[ScriptedFault]) -> Self {
        let mut faults = faults.to_vec();
        faults.sort_by(|a, b| a.time.total_cmp(&b.time));
        Self { faults, next: 0, late: false }
    }

    /// Lets happen what is due before a machine's next cycle. Neither allocates nor locks.
    /// A fault at a joint that the arm has not is passed over.
    pub fn act<const N: usize, K: PlanningArm<N>, C: StageClock>(
        &mut self,
        machine: &mut Machine<N, K, SimulatedDrive<N>, SimulatedArc, C>,
    ) {
        while let Some(fault) = self.faults.get(self.next).filter(|fault| fault.time <= machine.time()) {
            self.next += 1;
            if let Some(fault) = of_drives(fault) {
                // The cell and the command line have checked the joint.
                let _ = machine.devices_mut().drive.inject(fault);
            }
            match fault.kind {
                FaultKind::EmergencyStop => machine.raise(Fault::EmergencyStop),
                FaultKind::LateCycles => self.late = true,
                FaultKind::PlannerSilent => machine.silence_planner(true),
                FaultKind::NoIgnition => machine.devices_mut().arc.inject(ArcFault::NoIgnition),
                FaultKind::ArcLoss => machine.devices_mut().arc.inject(ArcFault::Loss),
                FaultKind::SensorSilent => machine.devices_mut().seam.inject(SensorFault::Silent),
                FaultKind::SensorNan => machine.devices_mut().seam.inject(SensorFault::Nan),
                FaultKind::SensorJump => machine.devices_mut().seam.inject(SensorFault::Jump),
                _ => {}
            }
        }
        if self.late {
            machine.set_late(true);
        }
    }

    /// Ends all faults that have happened.
    pub fn clear<const N: usize, K: PlanningArm<N>, C: StageClock>(
        &mut self,
        machine: &mut Machine<N, K, SimulatedDrive<N>, SimulatedArc, C>,
    ) {
        self.late = false;
        machine.set_late(false);
        machine.silence_planner(false);
        let devices = machine.devices_mut();
        devices.drive.clear_faults();
        devices.arc.clear_faults();
        devices.seam.clear_faults();
    }
}

/// What happens to the drives.
fn of_drives(fault: &ScriptedFault) -> Option<InjectedFault> {
    let joint = fault.joint;
    match fault.kind {
        FaultKind::DriveSilent => Some(InjectedFault::Silent),
        FaultKind::DriveAlarm => Some(InjectedFault::Alarm { joint, code: ALARM }),
        FaultKind::JointStuck => Some(InjectedFault::Stuck { joint }),
        FaultKind::EncoderJump => Some(InjectedFault::EncoderJump { joint, offset: JUMP }),
        FaultKind::EncoderNan => Some(InjectedFault::EncoderJump { joint, offset: f64::NAN }),
        _ => None,
    }
}
