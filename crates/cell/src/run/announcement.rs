//! What a job says to the operator on its way.

use crate::job::{Action, Output};
use crate::record::{Event, EventKind};

/// Something to report when the program passes a marker.
#[derive(Debug, Clone)]
pub(super) struct Announcement {
    pub(super) marker: u32,
    pub(super) line: u32,
    pub(super) kind: EventKind,
    pub(super) text: String,
}

impl Announcement {
    pub(super) fn event(self, time: f64) -> Event {
        Event { time, line: self.line, kind: self.kind, text: self.text }
    }
}

/// What a step says to the operator when the program comes to it.
pub(super) fn announcement(action: &Action) -> Option<String> {
    match action {
        Action::Output(output) => Some(output_text(output)),
        Action::Message { text } => Some(format!("message: {text}")),
        Action::Alarm { code, text, subcode, stops } => {
            let end = if *stops { ": the job ends" } else { "" };
            Some(format!("alarm {code} [{subcode}] {text}{end}"))
        }
        Action::Pause => Some("PAUSE: no operator here, the run goes on at once".into()),
        Action::Accepted { text, note } => Some(format!("{text}: {note}")),
        _ => None,
    }
}

fn output_text(output: &Output) -> String {
    match output {
        Output::Digital { kind, number, value } => format!("{}#({number}) = {value}", kind.name()),
        Output::Pulse { kind, number, value, seconds } => {
            format!("{}#({number}) = {value} for {seconds:.2} s", kind.name())
        }
        Output::Analog { number, volts } => format!("AO#({number}) = {volts:.2} V"),
    }
}
