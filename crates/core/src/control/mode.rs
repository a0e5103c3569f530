//! The operating modes as one explicit state machine, in the words of CiA 402 and PLCopen.

/// What the controller is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Drives without power; the command follows the measured position.
    Disabled,
    /// Powered, at rest, no job.
    Standstill,
    /// Executing a job.
    Running,
    /// Paused, or on the way to the pause along the path; the job can go on.
    Holding,
    /// On the way from the pause to the motion of the job: to the path, back along the bead, and the arc is lit again.
    Resuming,
    /// Going back along the path, with the arc out.
    Backing,
    /// On the way to a stop that ends the job.
    Stopping,
    /// A fault is latched; the arm stops or has stopped. Only a reset leads out.
    Fault,
}

/// What can happen to the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// Operator: power the drives.
    Enable,
    /// Operator: take the power away.
    Disable,
    /// Operator: begin the job.
    Start,
    /// Operator: pause on the path.
    Hold,
    /// Operator: go on after a pause.
    Resume,
    /// Operator: go back along the path until told to hold.
    BackUp,
    /// Operator: stop on the path and end the job.
    Stop,
    /// Operator: acknowledge the latched fault.
    Reset,
    /// Cycle: a fault was found.
    Fault,
    /// Cycle: the arm has come to rest.
    AtRest,
    /// Cycle: the arm is where the job goes on, and the arc burns where it shall.
    Ready,
    /// Cycle: the job has no more commands.
    JobDone,
}

impl Mode {
    /// All modes, for tables.
    pub const ALL: [Self; 8] = [
        Self::Disabled,
        Self::Standstill,
        Self::Running,
        Self::Holding,
        Self::Resuming,
        Self::Backing,
        Self::Stopping,
        Self::Fault,
    ];

    /// The word for it in recordings.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Disabled => "disabled",
            Self::Standstill => "standstill",
            Self::Running => "running",
            Self::Holding => "holding",
            Self::Resuming => "resuming",
            Self::Backing => "backing",
            Self::Stopping => "stopping",
            Self::Fault => "fault",
        }
    }

    /// The mode with this word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }

    /// The mode after an event, or `None` where the event means nothing in this mode and is refused.
    ///
    /// `resumable` tells whether there is a job that can go on: then a reset leads to [`Mode::Holding`]; otherwise to
    /// [`Mode::Standstill`].
    #[must_use]
    pub fn after(self, event: Event, resumable: bool) -> Option<Self> {
        use Event as E;
        match (self, event) {
            (_, E::Fault) => Some(Self::Fault),
            (Self::Disabled, E::Enable) => Some(Self::Standstill),
            (Self::Standstill | Self::Holding, E::Disable) => Some(Self::Disabled),
            (Self::Standstill, E::Start) | (Self::Resuming, E::Ready) => Some(Self::Running),
            (Self::Holding, E::Resume) => Some(Self::Resuming),
            (Self::Holding, E::BackUp) => Some(Self::Backing),
            (Self::Running | Self::Resuming | Self::Backing, E::Hold) | (Self::Backing, E::AtRest) => {
                Some(Self::Holding)
            }
            (Self::Running | Self::Holding | Self::Resuming | Self::Backing, E::Stop) => Some(Self::Stopping),
            (Self::Running, E::JobDone) | (Self::Stopping, E::AtRest) => Some(Self::Standstill),
            (Self::Fault, E::Reset) => Some(if resumable { Self::Holding } else { Self::Standstill }),
            _ => None,
        }
    }
}

impl Event {
    /// All events, for tables.
    pub const ALL: [Self; 12] = [
        Self::Enable,
        Self::Disable,
        Self::Start,
        Self::Hold,
        Self::Resume,
        Self::BackUp,
        Self::Stop,
        Self::Reset,
        Self::Fault,
        Self::AtRest,
        Self::Ready,
        Self::JobDone,
    ];

    /// The operator causes it; the others the cycle itself.
    #[must_use]
    pub fn is_operators(self) -> bool {
        !matches!(self, Self::Fault | Self::AtRest | Self::Ready | Self::JobDone)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::String;

    #[test]
    fn every_pair_of_mode_and_event() {
        let mut table = String::new();
        for mode in Mode::ALL {
            for event in Event::ALL {
                for resumable in [false, true] {
                    if let Some(next) = mode.after(event, resumable) {
                        if resumable && mode.after(event, false) == Some(next) {
                            continue;
                        }
                        table += &std::format!("{mode:?} {event:?} -> {next:?}\n");
                    }
                }
            }
        }
        let expected = "\
Disabled Enable -> Standstill
Disabled Fault -> Fault
Standstill Disable -> Disabled
Standstill Start -> Running
Standstill Fault -> Fault
Running Hold -> Holding
Running Stop -> Stopping
Running Fault -> Fault
Running JobDone -> Standstill
Holding Disable -> Disabled
Holding Resume -> Resuming
Holding BackUp -> Backing
Holding Stop -> Stopping
Holding Fault -> Fault
Resuming Hold -> Holding
Resuming Stop -> Stopping
Resuming Fault -> Fault
Resuming Ready -> Running
Backing Hold -> Holding
Backing Stop -> Stopping
Backing Fault -> Fault
Backing AtRest -> Holding
Stopping Fault -> Fault
Stopping AtRest -> Standstill
Fault Reset -> Standstill
Fault Reset -> Holding
Fault Fault -> Fault
";
        assert_eq!(table, expected);
    }

    #[test]
    fn no_way_out_of_a_fault_but_the_reset() {
        for event in Event::ALL {
            let next = Mode::Fault.after(event, true);
            assert!(matches!(event, Event::Reset) || next.is_none_or(|m| m == Mode::Fault));
        }
    }
}
