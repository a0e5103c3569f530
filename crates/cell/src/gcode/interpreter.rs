//! The program, one step at a time.

use nalgebra::Point3;
use seamline::geometry::{Pose, Vector3};

use super::arc::{Arc, Centre, Piece, Plane};
use super::codes::{Code, Group, of_letter};
use super::contour::{Contour, Line};
use super::lexer::Word;
use super::moves::{Holding, Manner};
use super::program::{Block, Program};
use crate::job::{Action, Configuration, Disposition, Fault, JobError, Location, Mistake, Speed, Step, Zone};

const MM_PER_INCH: f64 = 25.4;
/// Greatest coordinate in mm, and ranges of F in mm/min, of P in seconds and in mm, and of P as a number of turns.
const FARTHEST: f64 = 1e5;
const FEED: [f64; 2] = [0.01, 600_000.0];
const DWELL: [f64; 2] = [0.0, 3600.0];
const TOLERANCE: [f64; 2] = [0.0, 1000.0];
const TURNS: [f64; 2] = [1.0, 1000.0];
/// A move shorter than this, in mm, goes nowhere.
const NO_WAY: f64 = 1e-6;
const AXES: [u8; 3] = *b"XYZ";
const CENTRES: [u8; 3] = *b"IJK";
/// Letters whose words mean something in any line.
const FREE: &[u8] = b"GMNOFST";

/// What a program leaves to its cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The frames of G54 to G59 in the robot's base frame, where the cell has them.
    pub frames: [Option<Pose>; 6],
    /// Where the tool centre point is at the start, in the base frame.
    pub start: Pose,
    /// The arm's configuration, at the start and all along.
    pub configuration: Configuration,
    /// Speed of G0, in mm/s.
    pub rapid_mm_s: f64,
    /// Speed of the first move, which goes joint by joint, in percent of the joints' limits.
    pub joint_percent: f64,
    /// How far from the programmed path the tool may be without G64 P, in mm.
    pub tolerance_mm: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motion {
    Rapid,
    Feed,
    Arc { clockwise: bool },
}

/// What one line leaves for the next.
#[derive(Debug, Clone, Copy)]
struct Modal {
    motion: Option<Motion>,
    plane: Plane,
    /// Millimetres in one unit of length.
    unit: f64,
    incremental: bool,
    /// I, J and K count from the frame's origin, not from the arc's start.
    absolute_centres: bool,
    /// 0 for G54.
    frame: usize,
    zone: Zone,
    /// How much of the permitted distance curves in place of lines may take.
    merging_mm: f64,
    feed_mm_s: Option<f64>,
    /// T of the last M6.
    tool: Option<f64>,
}

/// Walks a program from its first line, and yields what is to be done. It has no clock, and does nothing between two calls.
#[derive(Debug)]
pub struct Interpreter<'a> {
    program: &'a Program,
    setup: Setup,
    /// The block that runs next.
    next: usize,
    modal: Modal,
    /// Where the program stands, in mm in its frame.
    at: Vector3,
    /// The tool has been brought to the work.
    placed: bool,
    /// Codes and letters that were reported once.
    reported: Vec<(u8, u32)>,
    contour: Contour,
}

/// The words of one line by their letters, and which of them have been used.
struct Words<'a> {
    all: &'a [Word],
    used: Vec<u8>,
}

impl Words<'_> {
    fn find(&self, letter: u8) -> Option<Word> {
        self.all.iter().find(|word| word.letter == letter).copied()
    }

    fn take(&mut self, letter: u8) -> Option<Word> {
        let word = self.find(letter)?;
        self.used.push(letter);
        Some(word)
    }

    fn has_any(&self, letters: &[u8]) -> bool {
        self.all.iter().any(|word| letters.contains(&word.letter))
    }

    /// The first word that no code of the line has used.
    fn left(&self) -> Option<&Word> {
        self.all.iter().find(|word| !FREE.contains(&word.letter) && !self.used.contains(&word.letter))
    }
}

type Run<T> = Result<T, Fault>;

impl<'a> Interpreter<'a> {
    /// At the first line, with G17 G21 G40 G49 G54 G64 G80 G90 G91.1 G94 and no feed.
    #[must_use]
    pub fn new(program: &'a Program, setup: Setup) -> Self {
        let modal = Modal {
            motion: None,
            plane: Plane::Xy,
            unit: 1.0,
            incremental: false,
            absolute_centres: false,
            frame: 0,
            zone: Zone::Tolerance { mm: setup.tolerance_mm },
            merging_mm: f64::INFINITY,
            feed_mm_s: None,
            tool: None,
        };
        let at = seen_from(&setup.frames[0], &setup.start.translation.vector);
        let contour = Contour::default();
        Self { program, setup, next: 0, modal, at, placed: false, reported: Vec::new(), contour }
    }

    /// The next thing to do, or `None` after [`Action::End`].
    ///
    /// # Errors
    /// What only the lines before show: an arc that does not fit its ends, a missing feed, a word that nothing uses. The
    /// next call goes on with the next line.
    pub fn next_step(&mut self) -> Result<Option<Step>, JobError> {
        loop {
            if let Some(step) = self.contour.pop() {
                return Ok(Some(step));
            }
            // Ends: every turn takes a block.
            let program = self.program;
            let Some(block) = program.blocks.get(self.next) else {
                if self.next > program.blocks.len() {
                    return Ok(None);
                }
                self.next += 1;
                self.contour.end(self.location(program.last_line()));
                continue;
            };
            self.next += 1;
            self.run(block).map_err(|fault| program.error(block.line, fault.column, fault.mistake))?;
        }
    }

    fn location(&self, line: u32) -> Location {
        Location { job: self.program.name.clone(), line }
    }

    fn push_action(&mut self, line: u32, action: Action) {
        let step = Step { at: self.location(line), action, notes: Vec::new() };
        self.contour.push(step);
    }

    /// One line, in the order of RS-274: settings, dwell, motion, stop.
    fn run(&mut self, block: &'a Block) -> Run<()> {
        let mut words = Words { all: self.program.words(block), used: Vec::new() };
        if let Some(text) = &block.message {
            self.push_action(block.line, Action::Message { text: text.clone() });
        }
        let codes: Vec<Code> = words.all.iter().filter_map(Code::of).collect();
        let has = |letter: u8, tenths: u32| codes.contains(&Code { letter, tenths });
        for code in &codes {
            self.set(*code);
        }
        self.set_feed(&mut words)?;
        if self.report(block, words.all) {
            // What follows goes on from where the line would have led.
            if !codes.iter().any(|code| code.group() == Group::Once) {
                self.at = self.end(&mut words)?;
            }
            return Ok(());
        }
        if has(b'M', 60) {
            self.change_tool(block, &words);
        }
        if has(b'G', 640) {
            self.set_tolerance(&mut words, has(b'G', 40))?;
        }
        if has(b'G', 40) {
            self.dwell(block, &mut words)?;
        }
        // Tool length belongs to the cell.
        if has(b'G', 430) {
            words.take(b'H');
        }
        self.motion(block, &mut words)?;
        if let Some(word) = words.left() {
            let found = format!("`{}`", self.program.text(block, word));
            let expected = "only words that a code in this line uses";
            return Err(Fault { column: word.column, mistake: Mistake::Unexpected { found, expected } });
        }
        if has(b'M', 0) || has(b'M', 600) {
            self.push_action(block.line, Action::Pause);
        }
        Ok(())
    }

    /// Reports what is accepted without effect, once each, and what is refused; true where something is.
    fn report(&mut self, block: &'a Block, words: &[Word]) -> bool {
        let mut refused = false;
        for word in words {
            let code = Code::of(word);
            let disposition = match code {
                Some(code) => code.disposition(),
                None => of_letter(word.letter),
            };
            let text = || self.program.text(block, word);
            let action = match disposition {
                Disposition::Executed => continue,
                Disposition::Refused(reason) => {
                    refused = true;
                    Action::Unsupported { text: text(), reason: reason.into_owned() }
                }
                Disposition::Accepted(note) => {
                    let key = code.map_or((word.letter, 0), |code| (code.letter, code.tenths));
                    if self.reported.contains(&key) {
                        continue;
                    }
                    let text = text();
                    self.reported.push(key);
                    Action::Accepted { text, note }
                }
            };
            self.push_action(block.line, action);
        }
        refused
    }

    /// Takes over the settings of a code.
    fn set(&mut self, code: Code) {
        let modal = &mut self.modal;
        match (code.letter, code.tenths) {
            (b'G', 0) => modal.motion = Some(Motion::Rapid),
            (b'G', 10) => modal.motion = Some(Motion::Feed),
            (b'G', 20) => modal.motion = Some(Motion::Arc { clockwise: true }),
            (b'G', 30) => modal.motion = Some(Motion::Arc { clockwise: false }),
            (b'G', 800) => modal.motion = None,
            (b'G', 170) => modal.plane = Plane::Xy,
            (b'G', 180) => modal.plane = Plane::Zx,
            (b'G', 190) => modal.plane = Plane::Yz,
            (b'G', 200) => modal.unit = MM_PER_INCH,
            (b'G', 210) => modal.unit = 1.0,
            (b'G', 610) => modal.zone = Zone::Tolerance { mm: 0.0 },
            (b'G', 611) => modal.zone = Zone::Exact,
            (b'G', 900) => modal.incremental = false,
            (b'G', 910) => modal.incremental = true,
            (b'G', 901) => modal.absolute_centres = true,
            (b'G', 911) => modal.absolute_centres = false,
            (b'G', tenths @ 540..=590) => self.set_frame((tenths as usize - 540) / 10),
            _ => {}
        }
    }

    /// The tool stays where it is, and has other coordinates.
    fn set_frame(&mut self, frame: usize) {
        let of = |index: usize| self.setup.frames.get(index).copied().flatten();
        if let (Some(old), Some(new)) = (of(self.modal.frame), of(frame)) {
            let in_base = old * Point3::from(self.at / 1000.0);
            self.at = seen_from(&Some(new), &in_base.coords);
        }
        self.modal.frame = frame;
    }

    /// F, in units of length a minute.
    fn set_feed(&mut self, words: &mut Words<'_>) -> Run<()> {
        if let Some(word) = words.take(b'F') {
            let mm_min = in_range(&word, "F (mm/min)", word.value * self.modal.unit, FEED)?;
            self.modal.feed_mm_s = Some(mm_min / 60.0);
        }
        Ok(())
    }

    /// G64 with P, how far from the programmed path the tool may be.
    fn set_tolerance(&mut self, words: &mut Words<'_>, dwells: bool) -> Run<()> {
        let mut mm = self.setup.tolerance_mm;
        let own = words.find(b'P').filter(|_| !dwells);
        if let Some(word) = own {
            words.take(b'P');
            mm = in_range(&word, "P (mm)", word.value * self.modal.unit, TOLERANCE)?;
        }
        self.modal.merging_mm = match words.take(b'Q') {
            Some(word) => in_range(&word, "Q (mm)", word.value * self.modal.unit, TOLERANCE)?,
            None => f64::INFINITY,
        };
        self.modal.zone = Zone::Tolerance { mm };
        Ok(())
    }

    fn dwell(&mut self, block: &Block, words: &mut Words<'_>) -> Run<()> {
        let Some(word) = words.take(b'P') else {
            let found = "no P".into();
            let column = words.all.first().map_or(1, |word| word.column);
            let expected = "P with the seconds of G4";
            return Err(Fault { column, mistake: Mistake::Unexpected { found, expected } });
        };
        let seconds = in_range(&word, "P (s)", word.value, DWELL)?;
        self.push_action(block.line, Action::Dwell { seconds });
        Ok(())
    }

    /// M6: the tool that the program calls by its number is the cell's tool; a second one would be another.
    fn change_tool(&mut self, block: &Block, words: &Words<'_>) {
        let asked = words.find(b'T').map(|word| word.value).or(self.modal.tool);
        let text = "M6".to_owned();
        let action = match self.modal.tool {
            Some(mounted) if asked != Some(mounted) => {
                let reason = "the cell has one tool for the whole program".to_owned();
                Action::Unsupported { text, reason }
            }
            Some(_) => return,
            None => Action::Accepted { text, note: "the tool is the cell's tool 0" },
        };
        self.modal.tool = asked;
        self.push_action(block.line, action);
    }

    fn motion(&mut self, block: &'a Block, words: &mut Words<'_>) -> Run<()> {
        let moves = words.has_any(&AXES);
        let turns = words.has_any(&CENTRES) || words.has_any(b"R");
        let arc = matches!(self.modal.motion, Some(Motion::Arc { .. }));
        if !(moves || arc && turns) {
            return Ok(());
        }
        let first = words.all.iter().find(|word| AXES.contains(&word.letter)).or(words.all.first());
        let (column, text) =
            first.map_or((1, String::new()), |word| (word.column, self.program.text(block, word)));
        let Some(motion) = self.modal.motion else {
            let mistake =
                Mistake::Unexpected { found: format!("`{text}`"), expected: "G0, G1, G2 or G3 before it" };
            return Err(Fault { column, mistake });
        };
        let end = self.end(words)?;
        let done = self.go(block.line, motion, end, words, column);
        // What follows goes on from there in any case.
        self.at = end;
        done
    }

    /// The move of a line; `column` is that of its first coordinate.
    fn go(&mut self, line: u32, motion: Motion, end: Vector3, words: &mut Words<'_>, column: u32) -> Run<()> {
        let fault = |mistake| Err(Fault { column, mistake });
        let speed = match (motion, self.modal.feed_mm_s) {
            (Motion::Rapid, _) => self.setup.rapid_mm_s,
            (_, Some(feed)) => feed,
            (_, None) => return fault(Mistake::NoFeed { word: word_of(motion).into() }),
        };
        let manner = Manner { speed: Speed::Linear { mm_s: speed }, zone: self.modal.zone };
        match motion {
            Motion::Rapid | Motion::Feed => self.line(line, end, motion == Motion::Rapid, &manner),
            Motion::Arc { clockwise } => {
                let arc = self.arc(words, end, clockwise, column)?;
                if !self.placed {
                    let found = format!("`{}`", word_of(motion));
                    let expected = "G0 or G1 as the first move, which brings the tool to the work";
                    return fault(Mistake::Unexpected { found, expected });
                }
                self.turn(line, &arc, end, &manner);
            }
        }
        Ok(())
    }

    /// Where the line's X, Y and Z lead.
    fn end(&self, words: &mut Words<'_>) -> Run<Vector3> {
        let mut end = self.at;
        for (axis, letter) in AXES.into_iter().enumerate() {
            if let Some(word) = words.take(letter) {
                let value = word.value * self.modal.unit;
                let from = if self.modal.incremental { self.at[axis] } else { 0.0 };
                let what = ["X (mm)", "Y (mm)", "Z (mm)"][axis];
                end[axis] = in_range(&word, what, from + value, [-FARTHEST, FARTHEST])?;
            }
        }
        Ok(end)
    }

    fn holding(&self) -> Holding {
        // Six frames: the cast is exact.
        Holding { frame: self.modal.frame as u32 + 1, configuration: self.setup.configuration }
    }

    fn line(&mut self, line: u32, end: Vector3, rapid: bool, manner: &Manner) {
        let at = self.location(line);
        if !self.placed {
            self.placed = true;
            let speed = Speed::JointPercent(self.setup.joint_percent);
            let manner = Manner { speed, zone: Zone::Exact };
            self.contour.push(self.holding().joint(at, &end, &manner));
        } else if (end - self.at).norm() > NO_WAY {
            // A rapid move is not on the work.
            let merging = if rapid { 0.0 } else { self.modal.merging_mm };
            let line = Line { start: self.at, end, merging };
            self.contour.line(at, &line, self.holding(), *manner);
        }
    }

    /// The arc that the line's words describe.
    fn arc(&self, words: &mut Words<'_>, end: Vector3, clockwise: bool, column: u32) -> Run<Arc> {
        let (plane, unit) = (self.modal.plane, self.modal.unit);
        let [u, v, _] = plane.axes();
        let centre = [u, v].map(|axis| words.take(CENTRES[axis]));
        let radius = words.take(b'R');
        let fault = |column: u32, mistake| Fault { column, mistake };
        let centre = match (centre, radius) {
            ([None, None], None) => {
                let expected = "R, or the centre by the letters of the arc's plane: I J for G17, I K for G18, J K for G19";
                return Err(fault(
                    column,
                    Mistake::Unexpected { found: "an arc without radius".into(), expected },
                ));
            }
            ([None, None], Some(word)) => Centre::Radius(word.value * unit),
            ([Some(word), _] | [_, Some(word)], Some(radius)) => {
                let name = |word: Word| char::from(word.letter).to_string();
                let column = radius.column.max(word.column);
                return Err(fault(column, Mistake::TagConflict { tag: name(radius), instead: name(word) }));
            }
            (words, None) => {
                let from = |axis: usize| if self.modal.absolute_centres { 0.0 } else { self.at[axis] };
                let place =
                    |axis: usize, word: Option<Word>| from(axis) + word.map_or(0.0, |word| word.value * unit);
                Centre::At([place(u, words[0]), place(v, words[1])])
            }
        };
        let turns = match words.take(b'P') {
            Some(word) => in_range(&word, "P (turns)", word.value, TURNS)?,
            None => 1.0,
        };
        // In range: the cast only drops a fraction.
        Arc::new(plane, [self.at, end], centre, clockwise, turns as u32)
            .map_err(|mistake| fault(column, mistake))
    }

    fn turn(&mut self, line: u32, arc: &Arc, end: Vector3, manner: &Manner) {
        let holding = self.holding();
        // Between its own pieces an arc does not stop.
        let passing = match manner.zone {
            Zone::Exact => Zone::Tolerance { mm: 0.0 },
            zone => zone,
        };
        let pieces = arc.pieces(end);
        let last = pieces.len().saturating_sub(1);
        let mut start = self.at;
        for (index, piece) in pieces.into_iter().enumerate() {
            let zone = if index == last { manner.zone } else { passing };
            let manner = Manner { zone, ..*manner };
            let at = self.location(line);
            let step = match piece {
                Piece::Circle { via, end } => {
                    let step = holding.circle(at, [&start, &via, &end], &manner);
                    start = end;
                    step
                }
                Piece::Curve(curve) => holding.curve(at, curve, &manner),
            };
            self.contour.push(step);
        }
    }
}

fn word_of(motion: Motion) -> &'static str {
    match motion {
        Motion::Rapid => "G0",
        Motion::Feed => "G1",
        Motion::Arc { clockwise: true } => "G2",
        Motion::Arc { clockwise: false } => "G3",
    }
}

/// A point of the base frame in a frame, in mm from metres.
fn seen_from(frame: &Option<Pose>, point: &Vector3) -> Vector3 {
    let base_from_frame = frame.unwrap_or_else(Pose::identity);
    (base_from_frame.inverse() * Point3::from(*point)).coords * 1000.0
}

fn in_range(word: &Word, what: &'static str, value: f64, [min, max]: [f64; 2]) -> Run<f64> {
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    Err(Fault { column: word.column, mistake: Mistake::OutOfRange { what, value, min, max } })
}
