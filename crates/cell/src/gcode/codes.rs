//! What a run does with each code: one table for `check` and `run`. docs/gcode.md says the same to users.

use super::lexer::Word;
use crate::job::Disposition;

use Disposition::{Accepted, Executed};

/// Codes of one group exclude each other in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    /// Stands for itself.
    None,
    /// Not modal, and has its own use for X, Y, Z.
    Once,
    Motion,
    Plane,
    Distance,
    ArcDistance,
    FeedMode,
    Units,
    CutterRadius,
    ToolLength,
    Retract,
    WorkFrame,
    PathMode,
    SpindleMode,
    Stop,
    Spindle,
    Override,
}

/// A code: G or M with its number in tenths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Code {
    pub(super) letter: u8,
    pub(super) tenths: u32,
}

type Row = (u8, u32, Group, Disposition);

const fn refused(reason: &'static str) -> Disposition {
    Disposition::Refused(std::borrow::Cow::Borrowed(reason))
}

const CYCLE: Disposition = refused("drilling and turning cycles are not built");
const OFFSET: Disposition = refused("offsets come from the cell file and are not changed by programs");
const REFERENCE: Disposition = refused("there is no reference position");
const PROBE: Disposition = refused("probing is not built");
const CUTTER: Disposition = refused("cutter radius compensation is not built");
const SPINDLE: Disposition = Accepted("there is no spindle");
const COOLANT: Disposition = Accepted("there is no coolant");
const TIP: Disposition = Accepted("coordinates are always those of the tool centre point");
const CALL: Disposition = refused("subprograms are not built");
const OUTPUT: Disposition = refused("outputs and inputs of G-code are not built");

/// By letter and number.
const CODES: &[Row] = &[
    (b'G', 0, Group::Motion, Executed),
    (b'G', 10, Group::Motion, Executed),
    (b'G', 20, Group::Motion, Executed),
    (b'G', 30, Group::Motion, Executed),
    (b'G', 40, Group::Once, Executed),
    (b'G', 50, Group::Motion, refused("splines are not built")),
    (b'G', 51, Group::Motion, refused("splines are not built")),
    (b'G', 70, Group::None, refused("diameter mode is not built")),
    (b'G', 80, Group::None, Accepted("coordinates are no diameters")),
    (b'G', 100, Group::Once, OFFSET),
    (b'G', 170, Group::Plane, Executed),
    (b'G', 180, Group::Plane, Executed),
    (b'G', 190, Group::Plane, Executed),
    (b'G', 200, Group::Units, Executed),
    (b'G', 210, Group::Units, Executed),
    (b'G', 280, Group::Once, REFERENCE),
    (b'G', 281, Group::Once, REFERENCE),
    (b'G', 300, Group::Once, REFERENCE),
    (b'G', 301, Group::Once, REFERENCE),
    (b'G', 330, Group::Motion, refused("threads are not built")),
    (b'G', 382, Group::Motion, PROBE),
    (b'G', 383, Group::Motion, PROBE),
    (b'G', 384, Group::Motion, PROBE),
    (b'G', 385, Group::Motion, PROBE),
    (b'G', 400, Group::CutterRadius, Executed),
    (b'G', 410, Group::CutterRadius, CUTTER),
    (b'G', 420, Group::CutterRadius, CUTTER),
    (b'G', 430, Group::ToolLength, TIP),
    (b'G', 490, Group::ToolLength, TIP),
    (b'G', 530, Group::Once, refused("there are no machine coordinates")),
    (b'G', 540, Group::WorkFrame, Executed),
    (b'G', 550, Group::WorkFrame, Executed),
    (b'G', 560, Group::WorkFrame, Executed),
    (b'G', 570, Group::WorkFrame, Executed),
    (b'G', 580, Group::WorkFrame, Executed),
    (b'G', 590, Group::WorkFrame, Executed),
    (b'G', 610, Group::PathMode, Executed),
    (b'G', 611, Group::PathMode, Executed),
    (b'G', 640, Group::PathMode, Executed),
    (b'G', 730, Group::Motion, CYCLE),
    (b'G', 760, Group::Motion, CYCLE),
    (b'G', 800, Group::Motion, Executed),
    (b'G', 810, Group::Motion, CYCLE),
    (b'G', 820, Group::Motion, CYCLE),
    (b'G', 830, Group::Motion, CYCLE),
    (b'G', 840, Group::Motion, CYCLE),
    (b'G', 850, Group::Motion, CYCLE),
    (b'G', 860, Group::Motion, CYCLE),
    (b'G', 870, Group::Motion, CYCLE),
    (b'G', 880, Group::Motion, CYCLE),
    (b'G', 890, Group::Motion, CYCLE),
    (b'G', 900, Group::Distance, Executed),
    (b'G', 901, Group::ArcDistance, Executed),
    (b'G', 910, Group::Distance, Executed),
    (b'G', 911, Group::ArcDistance, Executed),
    (b'G', 920, Group::Once, OFFSET),
    (b'G', 921, Group::Once, Accepted("no offset is on")),
    (b'G', 922, Group::Once, Accepted("no offset is on")),
    (b'G', 923, Group::Once, OFFSET),
    (b'G', 930, Group::FeedMode, refused("feed as inverse time is not built")),
    (b'G', 940, Group::FeedMode, Executed),
    (b'G', 950, Group::FeedMode, refused("feed per revolution is not built")),
    (b'G', 960, Group::SpindleMode, SPINDLE),
    (b'G', 970, Group::SpindleMode, SPINDLE),
    (b'G', 980, Group::Retract, Accepted("there are no cycles")),
    (b'G', 990, Group::Retract, Accepted("there are no cycles")),
    (b'M', 0, Group::Stop, Executed),
    (b'M', 10, Group::Stop, Accepted("optional stops are off")),
    (b'M', 20, Group::Stop, Executed),
    (b'M', 30, Group::Spindle, SPINDLE),
    (b'M', 40, Group::Spindle, SPINDLE),
    (b'M', 50, Group::Spindle, SPINDLE),
    (b'M', 60, Group::None, Executed),
    (b'M', 70, Group::None, COOLANT),
    (b'M', 80, Group::None, COOLANT),
    (b'M', 90, Group::None, COOLANT),
    (b'M', 190, Group::Spindle, SPINDLE),
    (b'M', 300, Group::Stop, Executed),
    (b'M', 480, Group::Override, Accepted("the override is the operator's")),
    (b'M', 490, Group::Override, refused("the override is the operator's")),
    (b'M', 500, Group::None, refused("the override is the operator's")),
    (b'M', 510, Group::None, Accepted("there is no spindle")),
    (b'M', 530, Group::None, refused("the feed's stop is the operator's")),
    (b'M', 600, Group::Stop, Executed),
    (b'M', 610, Group::None, Accepted("the tool is the cell's tool 0")),
    (b'M', 620, Group::None, OUTPUT),
    (b'M', 630, Group::None, OUTPUT),
    (b'M', 640, Group::None, OUTPUT),
    (b'M', 650, Group::None, OUTPUT),
    (b'M', 660, Group::None, OUTPUT),
    (b'M', 670, Group::None, OUTPUT),
    (b'M', 680, Group::None, OUTPUT),
    (b'M', 970, Group::Stop, CALL),
    (b'M', 980, Group::Stop, CALL),
    (b'M', 990, Group::Stop, CALL),
];

impl Code {
    /// The code of a word; `None` where the word is no code, or its number has more than one decimal or a sign.
    pub(super) fn of(word: &Word) -> Option<Self> {
        let tenths = word.value * 10.0;
        let whole = tenths.round();
        let near = (tenths - whole).abs() < 1e-6 && (0.0..1e6).contains(&whole);
        // In range: the cast is exact.
        (near && is_code(word)).then_some(Self { letter: word.letter, tenths: whole as u32 })
    }

    fn row(self) -> Option<&'static Row> {
        let index = CODES.binary_search_by_key(&(self.letter, self.tenths), |row| (row.0, row.1)).ok()?;
        CODES.get(index)
    }

    pub(super) fn group(self) -> Group {
        self.row().map_or(Group::None, |row| row.2)
    }

    pub(super) fn disposition(self) -> Disposition {
        self.row().map_or(refused("this code is not known"), |row| row.3.clone())
    }
}

/// Whether the word is a code, by its letter.
pub(super) fn is_code(word: &Word) -> bool {
    matches!(word.letter, b'G' | b'M')
}

/// What a run does with a letter that is neither a code's nor a coordinate's.
pub(super) fn of_letter(letter: u8) -> Disposition {
    match letter {
        b'A' | b'B' | b'C' | b'U' | b'V' | b'W' => {
            refused("the robot holds its tool upright: there is no such axis")
        }
        b'E' => Accepted("there is no extruder"),
        b'S' => SPINDLE,
        b'T' => Accepted("the tool is the cell's tool 0"),
        _ => Executed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_sorted_and_each_code_stands_in_the_documentation() {
        assert!(CODES.is_sorted_by_key(|row| (row.0, row.1)));
        let text = include_str!("../../../../docs/gcode.md");
        for (letter, tenths, _, disposition) in CODES {
            let number = if tenths % 10 == 0 {
                (tenths / 10).to_string()
            } else {
                format!("{}.{}", tenths / 10, tenths % 10)
            };
            let name = format!("{}{number}", char::from(*letter));
            let heading = match disposition {
                Executed => "executed",
                Accepted(_) => "accepted",
                Disposition::Refused(_) => "refused",
            };
            let rows = text.lines().map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
            let same = |row: &Vec<&str>| matches!(row[..], [_, codes, said, ..] if said == heading && codes.split(", ").any(|code| code == name));
            assert_eq!(rows.filter(same).count(), 1, "{name} is {heading}");
        }
    }
}
