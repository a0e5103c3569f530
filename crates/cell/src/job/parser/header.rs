//! Header lines and the list of positions.

use std::collections::BTreeMap;

use super::super::error::Mistake;
use super::super::lexer::{Fault, Lexer, TokenKind, column, printable};
use super::super::position::{
    Configuration, Coordinates, Frame, JobPosition, PositionKind, PositionName, Rectangular,
};
use super::super::program::Header;
use super::operand;

type Parsed<T> = Result<T, Fault>;

/// Values of a position of the smallest robot.
const FOUR_AXES: usize = 4;
/// Longest list of values on one header line.
const MAX_VALUES: usize = 64;

/// A line of the header outside `//POS`, behind its slashes and word. Words that are not known are kept unread.
pub(super) fn header_line(header: &mut Header, lexer: &mut Lexer<'_>, word: &str) -> Parsed<()> {
    match word {
        "FOLDERNAME" => header.folder = Some(printable(lexer.rest())),
        "DATE" => header.date = Some(printable(lexer.rest())),
        "COMM" => header.comment = lexer.rest().to_vec(),
        "ATTR" => header.attributes = comma_list(lexer.rest()),
        "ARGTYPE" => header.argument_types = comma_list(lexer.rest()),
        "FRAME" => header.frame = Some(frame(lexer)?),
        "LVARS" => {
            let place = lexer.column();
            let counts = integers(lexer, "a count of local variables")?;
            let found = counts.len();
            let counts = <[u32; 8]>::try_from(counts).map_err(|_| Fault {
                column: place,
                mistake: Mistake::WrongCount {
                    what: "///LVARS",
                    found,
                    unit: "values",
                    expected: "8: B, I, D, R, S, P, BP, EX",
                },
            })?;
            header.locals = Some(counts);
        }
        _ if word.starts_with("GROUP") => header.groups.push(comma_list(lexer.rest())),
        _ => {}
    }
    Ok(())
}

/// `BASE`, `ROBOT`, `USER 14` …
fn frame(lexer: &mut Lexer<'_>) -> Parsed<Frame> {
    const EXPECTED: &str = "BASE, ROBOT, TOOL, USER n or MTOOL";
    let place = lexer.clone();
    let TokenKind::Word(word) = lexer.next().kind else { return Err(place.unexpected(EXPECTED)) };
    Ok(match word {
        "BASE" => Frame::Base,
        "ROBOT" => Frame::Robot,
        "TOOL" => Frame::Tool,
        "MTOOL" => Frame::MasterTool,
        "USER" => Frame::User(operand::integer(lexer, "the number of a user frame")?),
        _ => return Err(place.unexpected(EXPECTED)),
    })
}

fn comma_list(text: &[u8]) -> Vec<String> {
    text.split(|b| *b == b',').take(MAX_VALUES).map(|item| printable(item.trim_ascii())).collect()
}

/// Whole numbers without sign, separated by commas, to the end of the line.
fn integers(lexer: &mut Lexer<'_>, expected: &'static str) -> Parsed<Vec<u32>> {
    comma_separated(lexer, |lexer| operand::integer(lexer, expected))
}

fn comma_separated<'a, T>(
    lexer: &mut Lexer<'a>,
    mut value: impl FnMut(&mut Lexer<'a>) -> Parsed<T>,
) -> Parsed<Vec<T>> {
    let mut values = vec![value(lexer)?];
    while values.len() < MAX_VALUES && operand::eat(lexer, b",") {
        values.push(value(lexer)?);
    }
    operand::expect_end(lexer, "`,` or the end of the line")?;
    Ok(values)
}

/// The form of the position lines that follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Pulses,
    Rectangular,
    Angles,
}

/// What `///POSTYPE` refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PositionType {
    /// PULSE or ANGLE: axes, no frame.
    Axes,
    /// A frame that needs no number.
    Frame(Frame),
    /// USER: the frame of the last `///USER`.
    User,
}

/// `//POS`: the positions, and the tags that hold for the lines after them.
#[derive(Debug)]
pub(super) struct PositionList {
    announced: Option<(Vec<u32>, u32)>,
    form: Form,
    kind: PositionType,
    user: Option<u32>,
    tool: u32,
    configuration: Configuration,
    positions: BTreeMap<PositionName, (JobPosition, u32)>,
    /// A line was wrong: the count is then wrong too, and not worth a second error.
    damaged: bool,
}

impl Default for PositionList {
    fn default() -> Self {
        Self {
            announced: None,
            form: Form::Pulses,
            kind: PositionType::Axes,
            user: None,
            tool: 0,
            configuration: Configuration::default(),
            positions: BTreeMap::new(),
            damaged: false,
        }
    }
}

impl PositionList {
    /// A tag line, behind its slashes and word. Words that are not known are kept unread.
    pub(super) fn directive(&mut self, lexer: &mut Lexer<'_>, word: &str, number: u32) -> Parsed<()> {
        match word {
            "NPOS" => {
                let place = lexer.column();
                let counts = integers(lexer, "a count of positions")?;
                if !matches!(counts.len(), 4 | 6) {
                    let mistake = Mistake::WrongCount {
                        what: "///NPOS",
                        found: counts.len(),
                        unit: "values",
                        expected: "6: C, BC, EC, P, BP, EX (or 4, in old files)",
                    };
                    return Err(Fault { column: place, mistake });
                }
                self.announced = Some((counts, number));
                return Ok(());
            }
            "USER" => self.user = Some(operand::integer(lexer, "the number of a user frame")?),
            "TOOL" => self.tool = operand::integer(lexer, "the number of a tool")?,
            "POSTYPE" => self.set_type(lexer)?,
            "PULSE" => self.form = Form::Pulses,
            "RECTAN" => self.form = Form::Rectangular,
            "ANGLE" => self.form = Form::Angles,
            "RCONF" => self.configuration = configuration(lexer)?,
            _ => return Ok(()),
        }
        // `///TOOL 0,1` and the like hold further groups' values.
        Ok(())
    }

    fn set_type(&mut self, lexer: &mut Lexer<'_>) -> Parsed<()> {
        const EXPECTED: &str = "PULSE, BASE, ROBOT, TOOL, USER, MTOOL or ANGLE";
        let place = lexer.clone();
        let TokenKind::Word(word) = lexer.next().kind else { return Err(place.unexpected(EXPECTED)) };
        (self.kind, self.form) = match word {
            "PULSE" => (PositionType::Axes, Form::Pulses),
            "ANGLE" => (PositionType::Axes, Form::Angles),
            "BASE" => (PositionType::Frame(Frame::Base), Form::Rectangular),
            "ROBOT" => (PositionType::Frame(Frame::Robot), Form::Rectangular),
            "TOOL" => (PositionType::Frame(Frame::Tool), Form::Rectangular),
            "MTOOL" => (PositionType::Frame(Frame::MasterTool), Form::Rectangular),
            "USER" if self.user.is_some() => (PositionType::User, Form::Rectangular),
            "USER" => {
                let mistake = Mistake::MissingHeader { what: "///USER", before: "///POSTYPE USER" };
                return Err(Fault { column: place.column(), mistake });
            }
            _ => return Err(place.unexpected(EXPECTED)),
        };
        Ok(())
    }

    /// Whether a line looks like a position at all: it has an `=`, or begins with a position's name.
    pub(super) fn may_hold(line: &[u8]) -> bool {
        let first = Lexer::new(line, 0, line.len()).peek();
        line.contains(&b'=') || matches!(first.kind, TokenKind::Word(word) if position_name(word).is_some())
    }

    /// `C00001=…`.
    pub(super) fn line(&mut self, line: &[u8], number: u32) -> Parsed<()> {
        let parsed = self.position(line);
        self.damaged |= parsed.is_err();
        let (name, place, position) = parsed?;
        if let Some((_, first)) = self.positions.get(&name) {
            self.damaged = true;
            let mistake = Mistake::Duplicate { what: "position", name: name.to_string(), first: *first };
            return Err(Fault { column: place, mistake });
        }
        self.positions.insert(name, (position, number));
        Ok(())
    }

    fn position(&self, line: &[u8]) -> Parsed<(PositionName, u32, JobPosition)> {
        let mut lexer = Lexer::new(line, 0, line.len());
        let token = lexer.peek();
        let name = match token.kind {
            TokenKind::Word(word) => position_name(word),
            _ => None,
        };
        let name = name.ok_or_else(|| lexer.unexpected("a position such as C00001= or P001="))?;
        lexer.next();
        operand::expect(&mut lexer, b"=", "`=` and the position's values")?;
        let robot = matches!(name.kind, PositionKind::C | PositionKind::P);
        let coordinates = match self.form {
            Form::Pulses => Coordinates::Pulses(pulses(&mut lexer, robot)?),
            Form::Rectangular if robot => Coordinates::Rectangular(self.rectangular(&mut lexer)?),
            Form::Rectangular | Form::Angles => {
                Coordinates::Angles(numbers(&mut lexer, "the position", 1..=8)?)
            }
        };
        Ok((name, column(token.start), JobPosition { coordinates, tool: self.tool }))
    }

    fn rectangular(&self, lexer: &mut Lexer<'_>) -> Parsed<Rectangular> {
        let values = numbers(lexer, "the position", 6..=7)?;
        let value = |i: usize| values.get(i).copied().unwrap_or(0.0);
        let frame = match self.kind {
            PositionType::Frame(frame) => frame,
            PositionType::User => Frame::User(self.user.unwrap_or(0)),
            // `///RECTAN` under `///POSTYPE PULSE`: the controller's own default.
            PositionType::Axes => Frame::Robot,
        };
        Ok(Rectangular {
            position_mm: [value(0), value(1), value(2)],
            rotation_deg: [value(3), value(4), value(5)],
            elbow_deg: values.get(6).copied(),
            frame,
            configuration: self.configuration,
        })
    }

    /// Whether every line was read.
    pub(super) fn is_whole(&self) -> bool {
        !self.damaged
    }

    /// The counts of `///NPOS` against the list: line and mistake.
    pub(super) fn check(&self) -> Option<(u32, Mistake)> {
        let (announced, line) = self.announced.as_ref().filter(|_| !self.damaged)?;
        // Old files count C, BC, EC and P only.
        PositionKind::ALL.iter().zip(announced).find_map(|(kind, announced)| {
            let found = self.positions.keys().filter(|name| name.kind == *kind).count();
            let announced = *announced as usize;
            (found != announced)
                .then(|| (*line, Mistake::PositionCount { kind: kind.letters(), announced, found }))
        })
    }

    pub(super) fn into_positions(self) -> BTreeMap<PositionName, JobPosition> {
        self.positions.into_iter().map(|(name, (position, _))| (name, position)).collect()
    }
}

fn position_name(word: &str) -> Option<PositionName> {
    // Longer names first: `BC1` is no `C`.
    let kinds = [
        PositionKind::Bc,
        PositionKind::Ec,
        PositionKind::Bp,
        PositionKind::Ex,
        PositionKind::C,
        PositionKind::P,
    ];
    kinds.into_iter().find_map(|kind| {
        let digits = word.strip_prefix(kind.letters())?;
        let plain = digits.bytes().all(|b| b.is_ascii_digit());
        let number = if plain { digits.parse().ok()? } else { return None };
        Some(PositionName { local: false, kind, number })
    })
}

fn pulses(lexer: &mut Lexer<'_>, robot: bool) -> Parsed<Vec<i32>> {
    let place = lexer.column();
    let values = comma_separated(lexer, |lexer| {
        let at = lexer.clone();
        let (value, whole) = operand::decimal(lexer, "a whole number of pulses")?;
        let fits = whole && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&value);
        // In range and whole: the cast is exact.
        if fits { Ok(value as i32) } else { Err(at.bad_number("a whole number of pulses")) }
    })?;
    if !(robot && values.len() == FOUR_AXES) {
        check_count(place, values.len(), "the position", if robot { 6..=8 } else { 1..=8 })?;
    }
    Ok(values)
}

fn numbers(
    lexer: &mut Lexer<'_>,
    what: &'static str,
    count: std::ops::RangeInclusive<usize>,
) -> Parsed<Vec<f64>> {
    let place = lexer.column();
    let values = comma_separated(lexer, |lexer| operand::decimal(lexer, "a number").map(|(v, _)| v))?;
    check_count(place, values.len(), what, count)?;
    Ok(values)
}

fn check_count(
    column: u32,
    found: usize,
    what: &'static str,
    count: std::ops::RangeInclusive<usize>,
) -> Parsed<()> {
    if count.contains(&found) {
        return Ok(());
    }
    let expected = match (*count.start(), *count.end()) {
        (6, 7) => "6 (x, y, z, Rx, Ry, Rz), or 7 on an arm of seven axes",
        (6, 8) => "6 (S, L, U, R, B, T), up to 8 with further axes, or 4 on an arm of four axes",
        _ => "1 to 8",
    };
    Err(Fault { column, mistake: Mistake::WrongCount { what, found, unit: "values", expected } })
}

fn configuration(lexer: &mut Lexer<'_>) -> Parsed<Configuration> {
    let place = lexer.column();
    let flags = comma_separated(lexer, |lexer| {
        let at = lexer.clone();
        match operand::integer(lexer, "0 or 1")? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(at.unexpected("0 or 1")),
        }
    })?;
    if !(5..=24).contains(&flags.len()) {
        let mistake =
            Mistake::WrongCount { what: "///RCONF", found: flags.len(), unit: "values", expected: "5 to 24" };
        return Err(Fault { column: place, mistake });
    }
    Ok(Configuration::from_flags(&flags))
}
