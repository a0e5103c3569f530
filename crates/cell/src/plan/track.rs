//! Seam tracking in a job: what lies between COMARCON and COMARCOF is handed out together, with the taught path ahead of the motion.
//!
//! Runs in it that go on from each other without a kink are one **weld**. The laser sees the next run while the torch is still in this one, so
//! that the taught path must be known ahead; a corner, a turn on the spot or a joint move ends the weld, and behind it the tracking begins anew.

use seamline::control::{Block, Command, Motion, Playing, TAUGHT_PATHS, Tracked, Tracking};
use seamline::geometry::Pose;
use seamline::path::{Measure, Path};
use seamline::seam::{Filter, LostLane, Offset, PathChain, RecordedWeld, Sensor, Settings, TackMask};

use super::arm::PlanningArm;
use super::error::{PlanError, Problem};
use super::pass::{Means, Memo};
use super::planner::{Planned, Planner};
use crate::cell::{self, Cell, LostSeam, SeamFilter, SensorSource};

/// The taught path is known so far beyond what the sensor sees, in metres.
const BEYOND: f64 = 0.05;
/// It is kept so far behind the torch, in metres.
const BEHIND: f64 = 0.05;
/// The first readings are met so far behind the place that was seen first, in metres: what lies before is welded blind.
const MET: f64 = 15e-3;
/// Places of a path at which its curvature is looked at.
const LOOKS: u32 = 32;
/// Of the radius of a bend: how far the seam may lie on its inner side.
const MOST_BENT: f64 = 0.5;
/// Room that the planned speed leaves to rates below 1.
const ROOM: f64 = 1.02;
/// Coordinates nearer to each other than this are one, in metres.
const SAME: f64 = 1e-9;
/// Beside a tack its flanks are masked, in metres; and time without readings after which a seam is lost, in seconds.
const FLANK: f64 = 2e-3;
const SILENT: f64 = 2.0;

/// What is between COMARCON and COMARCOF.
#[derive(Debug, Clone)]
pub(super) struct Section<const N: usize> {
    /// COMARCOF has come.
    closed: bool,
    /// Coordinate at which the next path begins.
    s: f64,
    welds: Vec<Weld>,
    held: Vec<Planned<N>>,
    /// What comes next is another weld.
    breaks: bool,
    /// The weld that is tracked after all that was handed out, and how much of its path is known to the cycle.
    on: Option<(usize, usize)>,
}

/// Runs along one seam.
#[derive(Debug, Clone)]
struct Weld {
    /// The paths in order, each with the coordinate at which it begins.
    taught: Vec<(Path, f64)>,
    settings: Settings,
    flange_from_tcp: Pose,
    stop_after: Option<f64>,
    means: Means,
    /// Where it is welded from a record, how.
    playing: Option<Playing>,
    /// It has been handed out, and its settings are fixed.
    begun: bool,
}

impl<const N: usize> Section<N> {
    fn new() -> Self {
        Self { closed: false, s: 0.0, welds: Vec::new(), held: Vec::new(), breaks: false, on: None }
    }

    pub(super) fn holds_back(&self) -> bool {
        !self.held.is_empty()
    }

    /// Hands out all that is held, with what the cycle must know for it.
    fn hand_out(&mut self, out: &mut Vec<Planned<N>>) {
        if !self.closed {
            // What is to come may bend as much as can be tracked.
            let open = self.welds.last_mut().filter(|weld| !weld.begun);
            open.into_iter().for_each(|weld| weld.settings.curvature = MOST_BENT / weld.settings.bound);
        }
        let mut held = std::mem::take(&mut self.held);
        for planned in &mut held {
            let commands = std::mem::take(&mut planned.commands);
            for command in commands {
                match &command {
                    Command::Move(block) => self.prepare(block, &mut planned.commands),
                    Command::TrackOff if self.on.take().is_none() => continue,
                    _ => {}
                }
                planned.commands.push(command);
            }
        }
        out.append(&mut held);
    }

    /// What must come before a block.
    fn prepare(&mut self, block: &Block<N>, commands: &mut Vec<Command<N>>) {
        let Some((from, to)) = tracked(block) else {
            if self.on.take().is_some() {
                commands.push(Command::TrackOff);
            }
            return;
        };
        let number = self.weld_at(from);
        let Some(weld) = self.welds.get_mut(number) else { return };
        let goes_on = self.on.filter(|(on, _)| *on == number);
        if self.on.is_some() && goes_on.is_none() {
            commands.push(Command::TrackOff);
        }
        let first = weld.taught.partition_point(|(_, start)| *start <= from + SAME).saturating_sub(1);
        let mut known = goes_on.map_or(first, |(_, known)| known);
        let seen = to + weld.settings.sensor.look_ahead() + BEYOND;
        while let Some((path, start)) = weld.taught.get(known).filter(|(_, start)| *start < seen) {
            commands.push(Command::Taught { path: *path, start: *start });
            known += 1;
        }
        if goes_on.is_none() {
            let Weld { settings, flange_from_tcp, stop_after, means, playing, .. } = *weld;
            let length = weld.length();
            let record = means.record(RecordedWeld { start: from, length, speed: settings.speed });
            let tracking = Tracking { settings, start: from, flange_from_tcp, stop_after, record };
            commands.push(playing.map_or(Command::TrackOn(tracking), Command::PlayOn));
        } else if block.starts_at_rest {
            commands.push(Command::TrackOver);
        }
        weld.begun = true;
        self.on = Some((number, known));
    }

    /// The weld that a coordinate lies in, by its number.
    fn weld_at(&self, s: f64) -> usize {
        let begins = |weld: &Weld| weld.taught.first().is_some_and(|(_, start)| *start <= s + SAME);
        self.welds.partition_point(begins).saturating_sub(1)
    }
}

/// From where to where along the weld a block leads, where it is tracked.
fn tracked<const N: usize>(block: &Block<N>) -> Option<(f64, f64)> {
    let Motion::Path(motion) = &block.motion else { return None };
    let start = motion.tracked?.start;
    let at = |time: f64| start + motion.state(time).position;
    Some((at(0.0), at(motion.duration())))
}

impl Weld {
    /// Whether a path goes on from it, and the cycle may still be told what that asks for.
    fn takes(&self, path: &Path, settings: &Settings, tool: &Pose) -> bool {
        let Some((last, _)) = self.taught.last() else { return false };
        let mut chain = PathChain::<2>::new(0.0);
        let smooth = chain.push(last).is_ok() && chain.push(path).is_ok();
        let known = settings.speed <= self.settings.speed && settings.curvature <= self.settings.curvature;
        smooth && *tool == self.flange_from_tcp && (known || !self.begun)
    }

    /// Length of the taught path.
    fn length(&self) -> f64 {
        self.taught.iter().map(|(path, _)| path.length()).sum()
    }

    /// The most paths that the cycle must know at a time.
    fn most_paths(&self) -> usize {
        let reach = self.settings.sensor.look_ahead() + BEYOND;
        let end = |(path, start): &(Path, f64)| start + path.length();
        let seen = |of: &(Path, f64)| {
            let (from, to) = (of.1 - BEHIND, end(of) + reach);
            self.taught.iter().filter(|other| end(other) >= from && other.1 <= to).count()
        };
        self.taught.iter().map(seen).max().unwrap_or(0)
    }
}

/// Greatest curvature of a path's seam, in 1/m.
fn curvature(path: &Path) -> f64 {
    let at = |look: u32| path.seam_jet(path.length() * f64::from(look) / f64::from(LOOKS)).linear[1].norm();
    (0..=LOOKS).map(at).fold(0.0, f64::max)
}

/// What the cell says of tracking at a speed along paths of a curvature, in metres per second and 1/m.
fn settings(cell: &Cell, sensor: Sensor, speed: f64, curvature: f64) -> Settings {
    let cell::Sensor { filter, change_per_cycle, correction_max, lost, tack, .. } = cell.sensor;
    let or_never = |value: f64| if value > 0.0 { value } else { f64::INFINITY };
    Settings {
        period: cell.cycle.period,
        filter: match filter {
            SeamFilter::Regression => Filter::Regression,
            SeamFilter::Mean { readings } => Filter::Mean { readings: readings as usize },
        },
        bound: correction_max,
        saturation: change_per_cycle,
        jerk: cell.cartesian.correction_jerk,
        curvature,
        lost: match lost {
            LostSeam::Stop => LostLane::Hold,
            LostSeam::TaughtPath => LostLane::Taught,
        },
        lost_time: SILENT,
        tacks: Some(TackMask {
            rise: or_never(tack.rise),
            gap_below: tack.gap,
            quality_below: tack.quality,
            margin: FLANK,
            longest: tack.longest,
        }),
        ..Settings::new(sensor, speed)
    }
}

/// The cell's sensor on a torch that stands where a path begins.
fn mounted(cell: &Cell, path: &Path) -> Result<Sensor, Problem> {
    let sensor = &cell.sensor;
    let mounting = Sensor::mounting(&path.seam_jet(0.0), sensor.look_ahead);
    let along = "a seam cannot be tracked within 6° of the wire's direction";
    Ok(Sensor {
        tcp_from_sensor: mounting.ok_or_else(|| Problem::Track(along.into()))?,
        range: Offset::repeat(sensor.range),
        rate: sensor.rate_hz,
        latency: sensor.latency,
        age_max: sensor.age_max,
        quality_min: sensor.quality_min,
    })
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// COMARCON: what follows is tracked.
    pub(super) fn track_on(&mut self) -> Result<(), Problem> {
        if self.cell.sensor.source == SensorSource::None && self.plays().is_none() {
            return Err(Problem::Track(
                "the cell has no seam sensor: expected sensor.source \"simulated\", \"replay\" or \"egm\""
                    .into(),
            ));
        }
        self.section.get_or_insert_with(Section::new);
        Ok(())
    }

    /// The shift of the pass that is welded from a record here.
    fn plays(&self) -> Option<Offset> {
        self.memo.and_then(|memo| memo.shift())
    }

    /// COMARCOF.
    pub(super) fn track_off(&mut self, planned: &mut Planned<N>) {
        if let Some(section) = &mut self.section {
            section.closed = true;
            self.beside = true;
            planned.commands.push(Command::TrackOff);
        }
    }

    /// Whether a seam is tracked after all steps taken: what leads along it is held until it is known to its end.
    #[must_use]
    pub fn tracks(&self) -> bool {
        self.section.as_ref().is_some_and(|section| !section.closed)
    }

    /// Passes on what has been handed out, or keeps it until the tracking ends.
    pub(super) fn pass_on(&mut self, parts: Vec<Planned<N>>, finish: bool, out: &mut Vec<Planned<N>>) {
        let Some(section) = &mut self.section else { return out.extend(parts) };
        section.held.extend(parts);
        if finish || section.closed {
            section.hand_out(out);
        }
        if section.closed {
            self.section = None;
        }
    }

    /// How much a corner may bend that is passed, in 1/m: where a seam is tracked, it must leave room on its inner side.
    pub(super) fn most_bent(&self) -> f64 {
        if self.tracks() { MOST_BENT / self.cell.sensor.correction_max } else { f64::INFINITY }
    }

    /// Has the run, which is known to its end, follow the seam.
    pub(super) fn track_run(&mut self, out: &mut Vec<Planned<N>>) -> Result<(), PlanError> {
        if !self.tracks() || self.run.is_empty() {
            return Ok(());
        }
        let mut section = self.section.take();
        let result = section.as_mut().map_or(Ok(()), |section| self.track_in(section, out));
        self.section = section;
        result.map_err(|(index, problem)| self.give_up(index, problem))
    }

    /// A weld that begins at a coordinate.
    fn weld_from(&mut self, s: f64, settings: Settings) -> Weld {
        let (taught, flange_from_tcp) = (Vec::new(), self.tool.flange_from_tcp);
        let stop_after = (self.cell.sensor.lost == LostSeam::Stop).then_some(self.cell.sensor.trend);
        let means = self.memo.as_mut().map_or(Means::Sensor(None), Memo::next);
        let playing = means.playing(s, &flange_from_tcp, settings.speed, self.cell);
        Weld { taught, settings, flange_from_tcp, stop_after, means, playing, begun: false }
    }

    fn track_in(
        &mut self,
        section: &mut Section<N>,
        out: &mut Vec<Planned<N>>,
    ) -> Result<(), (usize, Problem)> {
        let first = |problem| (0, problem);
        let pieces: Vec<(Path, f64)> =
            self.run.placed().map(|(_, piece)| (piece.path.seam(), piece.limits.speed)).collect();
        if pieces.iter().any(|(path, _)| path.measure() != Measure::Length) {
            section.breaks = true;
            return Ok(());
        }
        let speed = pieces.iter().map(|(_, speed)| *speed).fold(0.0, f64::max);
        let bend = pieces.iter().map(|(path, _)| curvature(path)).fold(0.0, f64::max);
        let Some((path, _)) = pieces.first() else { return Ok(()) };
        let plays = self.plays();
        let bound = self.cell.sensor.correction_max + plays.map_or(0.0, |shift| shift.norm());
        if bend * bound > MOST_BENT * (1.0 + SAME) {
            let text = format!(
                "the tracked path bends with a radius of {:.1} mm: expected more than {:.1} mm (sensor.correction_max_mm is {:.1})",
                1e3 / bend,
                bound / MOST_BENT * 1e3,
                self.cell.sensor.correction_max * 1e3
            );
            return Err(first(Problem::Track(text)));
        }
        let settings = settings(self.cell, mounted(self.cell, path).map_err(first)?, speed, bend);
        let suffices = |settings: &Settings| match plays {
            Some(_) => Ok(()),
            None => settings.check().map(|_| ()).map_err(|error| first(Problem::Track(error.to_string()))),
        };
        suffices(&settings)?;
        let tool = self.tool.flange_from_tcp;
        let breaks = std::mem::take(&mut section.breaks);
        if breaks || !section.welds.last().is_some_and(|weld| weld.takes(path, &settings, &tool)) {
            self.beside = !section.welds.is_empty();
            section.welds.push(self.weld_from(section.s, settings));
        }
        let Some(weld) = section.welds.last_mut() else { return Ok(()) };
        if !weld.begun {
            weld.settings.speed = weld.settings.speed.max(speed);
            weld.settings.curvature = weld.settings.curvature.max(bend);
            suffices(&weld.settings)?;
        }
        // On the inner side of a bend the torch travels less than the taught path is long.
        let headroom = ROOM / (1.0 - bend * bound);
        let mut s = section.s;
        let mut starts = Vec::with_capacity(pieces.len());
        for (path, _) in &pieces {
            weld.taught.push((*path, s));
            starts.push(Tracked { start: s, headroom });
            s += path.length();
        }
        let begins = weld.taught.first().map_or(section.s, |(_, start)| *start);
        let blind = settings.sensor.look_ahead() + MET - (section.s - begins);
        let sees = plays.is_none();
        if let Some(piece) = self.run.piece(0).filter(|piece| sees && piece.info.arc && blind > 0.0) {
            let text = format!(
                "the arc is on for {:.0} mm before the seam is seen: a run-in without arc would be as long",
                blind * 1e3
            );
            out.push(Planned { notices: vec![text], ..Planned::part(piece.link.at()) });
        }
        section.s = s;
        self.kept.weld(&weld.means, weld.length(), weld.settings.speed).map_err(first)?;
        if weld.most_paths() > TAUGHT_PATHS {
            let text = format!(
                "the tracked seam has more than {TAUGHT_PATHS} moves in the {:.0} mm that are known ahead",
                (settings.sensor.look_ahead() + BEYOND) * 1e3
            );
            return Err(first(Problem::Track(text)));
        }
        self.run.track(&starts);
        Ok(())
    }
}
