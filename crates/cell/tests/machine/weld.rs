//! Welding interrupted: pauses at random instants, the arc lit again with the overlap asked for, misfires, loss, dry runs, backing up.

use nalgebra::Vector3;
use seamline::control::{ActsOn, Command, CycleOutput, Event, Mode};
use seamline::safety::Fault;
use seamline::vibration::Prefilter;
use seamline_cell::cell::{Cell, FlexibleMode, Vibration};
use seamline_cell::job::{Action, ArcCondition, Zone};
use seamline_cell::sim::ArcFault;

use crate::bench::{
    Ar2010, Bench, Random, commands, independent_forward, independent_torch, step, worst_shares,
};
use crate::chain::{HOME, Way};

/// Welding speed in mm/s.
const WELD: f64 = 10.0;

/// To the seam, along it past a corner and round an exact one, and away: 20 mm, 30 + 25 + 25 mm, 20 mm.
pub(crate) fn job(cell: &Cell) -> (Ar2010, Vec<Command<6>>) {
    let points = [
        ([20.0, 0.0], 0.0),
        ([50.0, 0.0], 10.0),
        ([50.0, 25.0], 20.0),
        ([75.0, 25.0], 20.0),
        ([75.0, 45.0], 0.0),
    ];
    let way = Way::in_cell(cell.clone(), &points);
    let zones = [Zone::Exact, Zone::Unspecified, Zone::Exact, Zone::Exact, Zone::Exact];
    let line = |(point, zone): (usize, &Zone)| way.lines(WELD, *zone).swap_remove(point);
    let mut steps: Vec<_> = zones.iter().enumerate().map(line).collect();
    let condition = ArcCondition { file: Some(1), ..ArcCondition::default() };
    steps.insert(4, step(14, Action::ArcOff(condition)));
    steps.insert(1, step(11, Action::ArcOn(condition)));
    let commands = commands(&way.plan(&steps));
    (way.arm, commands)
}

/// The job under way in a cell.
pub(crate) fn weld(cell: &Cell) -> Bench {
    let (arm, commands) = job(cell);
    let mut bench = Bench::welding(cell, &arm, commands);
    bench.cycle_with(Event::Start);
    bench
}

pub(crate) fn default_cell() -> Cell {
    Cell::default_cell().unwrap()
}

/// The way of the tool in a run that nothing interrupts, with the joints on it, and the part of it on which the arc burns.
pub(crate) struct Track {
    pub(crate) rows: Vec<[f64; 6]>,
    points: Vec<(f64, Vector3<f64>, [f64; 6])>,
    bead: (f64, f64),
    /// The torch is that near to it, in metres, and each joint to four times that in radians.
    on_path: f64,
}

fn tool(q: &[f64; 6]) -> Vector3<f64> {
    (independent_forward(q) * independent_torch()).translation.vector
}

impl Track {
    fn new(rows: Vec<[f64; 6]>) -> Self {
        let mut points = vec![(0.0, tool(&rows[0]), rows[0])];
        for (k, q) in rows.iter().enumerate() {
            let (way, last, _) = points[points.len() - 1];
            let (point, step) = (tool(q), (tool(q) - last).norm());
            // Points closer than that say nothing of a direction.
            if step > 1e-7 || k + 1 == rows.len() {
                points.push((way + step, point, *q));
            }
        }
        Self { rows, points, bead: (0.0, 0.0), on_path: 1e-6 }
    }

    /// Where the chord that begins at a point is nearest to the tool, 0 … 1, and how near.
    fn on_chord(&self, k: usize, tool: &Vector3<f64>) -> (f64, f64) {
        let ((_, start, _), (_, end, _)) = (&self.points[k], &self.points[k + 1]);
        let (along, offset) = (end - start, tool - start);
        let share = (offset.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (share, (offset - along * share).norm())
    }

    /// Distance of the tool from the path, in metres.
    pub(crate) fn off(&self, q: &[f64; 6]) -> f64 {
        let tool = tool(q);
        (0..self.points.len() - 1).map(|k| self.on_chord(k, &tool).1).fold(f64::INFINITY, f64::min)
    }

    /// Way of the tool; it is asserted to be on the path. `near` is the chord it was last on.
    fn place(&self, q: &[f64; 6], near: &mut usize) -> f64 {
        let tool = tool(q);
        let off = |k: usize| self.on_chord(k, &tool).1;
        // Along the path as long as that leads nearer.
        while *near + 2 < self.points.len() && off(*near + 1) <= off(*near) {
            *near += 1;
        }
        while *near > 0 && off(*near - 1) < off(*near) {
            *near -= 1;
        }
        let (share, off) = self.on_chord(*near, &tool);
        let ((from, _, joints), (to, _, next)) = (&self.points[*near], &self.points[*near + 1]);
        let way = from + share * (to - from);
        let expected = |axis: usize| joints[axis] + share * (next[axis] - joints[axis]);
        let turned = (0..6).map(|axis| (q[axis] - expected(axis)).abs()).fold(0.0, f64::max);
        assert!(
            off < self.on_path && turned < 4.0 * self.on_path,
            "at {way} m: {off} m, {turned} rad off the path"
        );
        way
    }
}

/// A weld under way, with what has been seen of it.
pub(crate) struct Ride {
    pub(crate) bench: Box<Bench>,
    near: usize,
    pub(crate) way: f64,
    pub(crate) rows: Vec<[f64; 6]>,
    /// Furthest place at which the arc has burned.
    burned: f64,
}

impl Ride {
    fn new(bench: Bench) -> Self {
        Self { bench: Box::new(bench), near: 0, way: 0.0, rows: vec![HOME], burned: 0.0 }
    }

    fn burns(&self) -> bool {
        self.bench.input.arc_burning == Some(true)
    }

    pub(crate) fn cycle(&mut self, track: Option<&Track>) -> CycleOutput<6> {
        let output = self.bench.cycle();
        self.rows.push(output.command.position);
        if let Some(track) = track {
            self.way = track.place(&output.command.position, &mut self.near);
        }
        let welds = matches!(output.status.mode, Mode::Running | Mode::Resuming);
        assert!(welds || !output.arc.on, "no arc in mode {:?}", output.status.mode);
        if self.burns() {
            self.burned = self.burned.max(self.way);
        }
        output
    }

    pub(crate) fn until(
        &mut self,
        track: &Track,
        cycles: usize,
        mut done: impl FnMut(&Self, &CycleOutput<6>) -> bool,
    ) -> usize {
        for cycle in 0..cycles {
            let output = self.cycle(Some(track));
            if done(self, &output) {
                return cycle;
            }
        }
        panic!("{cycles} cycles are not enough: {:?} at {} m", self.bench.cycle.mode(), self.way);
    }

    pub(crate) fn ask(&mut self, track: &Track, event: Event) -> CycleOutput<6> {
        self.bench.input.event = Some(event);
        let output = self.cycle(Some(track));
        assert_eq!(output.status.refused, None, "{event:?}");
        output
    }

    pub(crate) fn assert_within_limits(&self, arm: &Ar2010) {
        let shares = worst_shares(&self.rows, arm, self.bench.period);
        assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
    }
}

/// The run without interruption.
pub(crate) fn track(bench: &Bench) -> Track {
    let mut ride = Ride::new(bench.clone());
    let mut burning = Vec::new();
    for _ in 0..60_000 {
        let output = ride.cycle(None);
        assert_eq!(output.status.fault, None);
        if ride.burns() {
            burning.push(output.command.position);
        }
        if output.status.mode == Mode::Standstill {
            let mut track = Track::new(ride.rows);
            let mut near = 0;
            let ways: Vec<_> = burning.iter().map(|q| track.place(q, &mut near)).collect();
            track.bead = (ways[0], ways[ways.len() - 1]);
            return track;
        }
    }
    panic!("the job does not end");
}

/// The weld at instants from a seed, as many as asked for.
pub(crate) fn at_random_instants(
    bench: &Bench,
    track: &Track,
    random: &mut Random,
    count: usize,
    mut each: impl FnMut(usize, Ride, &mut Random),
) {
    let mut instants: Vec<_> =
        (0..count).map(|_| (random.unit() * track.rows.len() as f64) as usize).collect();
    instants.sort_unstable();
    let mut ride = Ride::new(bench.clone());
    for (k, instant) in instants.into_iter().enumerate() {
        while ride.rows.len() < instant {
            ride.cycle(Some(track));
        }
        // What a difference of the third order needs.
        let rows = ride.rows[ride.rows.len().saturating_sub(4)..].to_vec();
        each(k, Ride { rows, bench: ride.bench.clone(), ..ride }, random);
    }
}

/// From the rest of an interruption on: the word to go on, and so far that its place is behind. With the arc out in between, gives by how
/// much the new bead overlaps the old one.
pub(crate) fn go_on(ride: &mut Ride, track: &Track, event: Event) -> Option<f64> {
    let (burned, stopped) = (ride.burned, ride.way);
    ride.ask(track, event);
    let mut lit = None;
    ride.until(track, 20_000, |ride, output| {
        assert_eq!(output.status.fault, None);
        let moves = output.status.mode == Mode::Running;
        assert!(lit.is_none() || ride.burns() || !output.arc.on, "out again at {} m", ride.way);
        lit = lit.or(ride.burns().then_some(ride.way));
        output.status.mode == Mode::Standstill || moves && ride.way > stopped.max(burned) + 1e-3
    });
    lit.map(|lit| burned - lit)
}

/// A pause of the weld: rest, a while, and on. With how far the bead was where the arc burned, and the overlap.
fn pause(mut ride: Ride, track: &Track, random: &mut Random) -> (Ride, Option<f64>, Option<f64>) {
    let bead = ride.burns().then_some(ride.burned - track.bead.0);
    let hold = ride.ask(track, Event::Hold);
    assert!(!hold.arc.on, "the arc is out at once");
    ride.until(track, 1_000, |_, output| output.status.at_rest);
    (0..(random.unit() * 100.0) as usize).for_each(|_| {
        ride.cycle(Some(track));
    });
    let overlap = go_on(&mut ride, track, Event::Resume);
    (ride, bead, overlap)
}

/// Pauses at random instants: the arm keeps to the path and the limits, the arc is lit again where the overlap begins, and every
/// twentieth job is run to its end.
fn pauses(count: usize) {
    let cell = default_cell();
    let bench = weld(&cell);
    let (arm, track) = (job(&cell).0, track(&bench));
    let (mut welding, mut worst) = (0, 0.0_f64);
    at_random_instants(&bench, &track, &mut Random(6), count, |k, ride, random| {
        let (mut ride, bead, overlap) = pause(ride, &track, random);
        if let Some(bead) = bead {
            worst = worst.max((overlap.unwrap() - cell.arc.overlap.min(bead)).abs());
            welding += 1;
        }
        if k % 20 == 0 && ride.bench.cycle.mode() == Mode::Running {
            ride.until(&track, 30_000, |_, output| output.status.mode == Mode::Standstill);
            assert_eq!(ride.rows.last(), track.rows.last());
        }
        ride.assert_within_limits(&arm);
    });
    println!("{count} pauses, {welding} with the arc on; overlap off by {worst:.1e} m at most");
    assert!(welding > count / 2 && worst < 1.1e-5, "{welding} {worst}");
}

#[test]
fn a_paused_weld_goes_on_with_its_overlap() {
    pauses(100);
}

/// `cargo test --release -p seamline-cell --test machine a_thousand -- --ignored --nocapture`.
#[test]
#[ignore = "takes a minute"]
fn a_thousand_pauses_of_a_weld() {
    pauses(1_000);
}

/// Until a fault has brought the torch to rest, and the reset after it.
fn stop_and_reset(ride: &mut Ride, track: &Track) -> Fault {
    let mut fault = None;
    ride.until(track, 10_000, |_, output| {
        fault = fault.or(output.status.fault);
        output.status.mode == Mode::Fault && output.status.at_rest
    });
    ride.bench.input.event = Some(Event::Resume);
    let output = ride.cycle(Some(track));
    assert_eq!(
        (output.status.refused, output.arc.on),
        (Some(Event::Resume), false),
        "no restart without reset"
    );
    assert_eq!(ride.ask(track, Event::Reset).status.mode, Mode::Holding);
    fault.unwrap()
}

/// 60 losses of the arc at random instants: the fault is named, and the bead goes on with its overlap before the place where it went out.
#[test]
fn a_lost_arc_stops_the_torch_and_is_lit_again() {
    let cell = default_cell();
    let bench = weld(&cell);
    let (arm, track) = (job(&cell).0, track(&bench));
    let mut lost = 0;
    at_random_instants(&bench, &track, &mut Random(7), 60, |_, mut ride, _| {
        if !ride.burns() || ride.burned > track.bead.1 - 2e-3 {
            return;
        }
        ride.bench.arc.as_mut().unwrap().inject(ArcFault::Loss);
        let bead = ride.burned - track.bead.0;
        let fault = stop_and_reset(&mut ride, &track);
        assert!(matches!(fault, Fault::ArcLost { seconds } if seconds >= cell.arc.loss), "{fault:?}");
        assert!(ride.way > ride.burned || bead < 1e-9, "the torch goes on for a while");
        let overlap = go_on(&mut ride, &track, Event::Resume).unwrap();
        // What the last cycle with an arc added is not in the furthest place seen.
        assert!((overlap - cell.arc.overlap.min(bead)).abs() < 2.2e-5, "{overlap} {bead}");
        ride.assert_within_limits(&arm);
        lost += 1;
    });
    assert!(lost > 25, "{lost}");
}

/// A power source that lights one strike in so many; the rules are the cell's: three strikes of a second, half a second between them.
#[test]
fn a_misfire_is_struck_again_and_named_in_the_end() {
    let cell = default_cell();
    let bench = weld(&cell);
    let track = track(&bench);
    let mut ride = Ride::new(bench);
    ride.bench.arc.as_mut().unwrap().inject(ArcFault::NoIgnition);
    let (mut strikes, mut current, mut cycles) = (0, false, 0);
    ride.until(&track, 10_000, |_, output| {
        strikes += u32::from(output.arc.on && !current);
        cycles += u32::from(output.arc.on);
        current = output.arc.on;
        output.status.mode == Mode::Fault
    });
    assert_eq!(strikes, 3);
    assert!((cycles as i32 - 3_000).abs() <= 6, "{cycles} cycles with current");
    assert_eq!(stop_and_reset(&mut ride, &track), Fault::ArcNotLit { tries: 3 });
    assert!((ride.way - track.bead.0).abs() < 1e-6, "it never left the place");
    ride.bench.arc.as_mut().unwrap().clear_faults();
    ride.ask(&track, Event::Resume);
    ride.until(&track, 30_000, |_, output| output.status.mode == Mode::Standstill);
    assert_eq!(ride.rows.last(), track.rows.last());
    assert!(ride.burned > track.bead.1 - 2e-3, "{}", ride.burned);
}

/// With every second strike a misfire, jobs of 20 seeds are done or end with the fault, and both happen.
#[test]
fn misfires_at_random_are_borne_as_often_as_the_cell_says() {
    let (mut done, mut failed) = (0, 0);
    for seed in 0..20 {
        let mut cell = default_cell();
        (cell.simulation.arc_misfire, cell.simulation.seed) = (0.5, seed);
        let mut ride = Ride::new(weld(&cell));
        let end = (0..30_000)
            .map(|_| ride.cycle(None))
            .find(|output| output.status.mode == Mode::Standstill || output.status.fault.is_some());
        match end.unwrap().status.fault {
            None => done += 1,
            Some(fault) => {
                assert_eq!(fault, Fault::ArcNotLit { tries: 3 });
                failed += 1;
            }
        }
    }
    assert!(done > 10 && failed > 0, "{done} {failed}");
}

/// Dry, the torch goes the same way in no more time, and there is never a current.
#[test]
fn a_dry_run_lights_nothing() {
    let mut cell = default_cell();
    let wet = track(&weld(&cell));
    cell.arc.dry_run = true;
    let mut ride = Ride::new(weld(&cell));
    ride.bench.arc.as_mut().unwrap().inject(ArcFault::NoIgnition);
    let cycles = ride.until(&wet, 30_000, |_, output| {
        assert!(!output.arc.on && output.status.fault.is_none());
        output.status.mode == Mode::Standstill
    });
    assert!(cycles <= wet.rows.len(), "{cycles}");
    assert_eq!(ride.rows.last(), wet.rows.last());
}

/// Under prefilters for a flexible arm the torch comes back to the path and the overlap all the same. On the path means to what the cell lets
/// a prefilter do to it.
#[test]
fn a_paused_weld_goes_on_behind_a_prefilter() {
    let mut cell = default_cell();
    let mode = FlexibleMode { frequency_hz: 6.34, damping: 0.022 };
    cell.arc.refuse_slowdown = false;
    cell.vibration = Vibration::try_new(Prefilter::FirZvd, 0.5e-3, vec![mode]).unwrap();
    pauses_behind_a_prefilter(&cell, 1e-4);
    cell.vibration = cell.vibration.acting_on(ActsOn::Feedrate);
    pauses_behind_a_prefilter(&cell, 1e-6);
}

fn pauses_behind_a_prefilter(cell: &Cell, on_path: f64) {
    let bench = weld(cell);
    let (arm, track) = (job(cell).0, Track { on_path, ..track(&bench) });
    let (mut welding, mut worst) = (0, 0.0_f64);
    at_random_instants(&bench, &track, &mut Random(9), 60, |k, ride, random| {
        let burned = ride.burned;
        let (mut ride, bead, overlap) = pause(ride, &track, random);
        if let Some(bead) = bead {
            let off = (overlap.unwrap() - cell.arc.overlap.min(bead)).abs();
            welding += 1;
            // Round the corner that is passed, 50 mm on, the arm's way is shorter than the program's.
            let corner = (0.047..0.053 + cell.arc.overlap).contains(&burned);
            assert!(off < if corner { 0.5e-3 } else { 2e-5 }, "{off} m at {burned}");
            worst = worst.max(off);
        }
        if k % 10 == 0 && ride.bench.cycle.mode() == Mode::Running {
            ride.until(&track, 30_000, |_, output| output.status.mode == Mode::Standstill);
            assert_eq!(ride.rows.last(), track.rows.last());
        }
        ride.assert_within_limits(&arm);
    });
    println!("{welding} pauses with the arc on; overlap off by {worst:.1e} m at most");
    assert!(welding > 30, "{welding}");
}

/// Every event in every mode that a weld comes through, and in each phase of a resumption, at instants 13 cycles apart: the mode is the one of the
/// table, a refusal says so and changes nothing, limits are kept, and no arc burns but in running and resuming.
#[test]
fn every_event_at_every_stage_of_an_interrupted_weld() {
    let cell = default_cell();
    let bench = weld(&cell);
    let (arm, track) = (job(&cell).0, track(&bench));
    let mut ride = Ride::new(bench);
    ride.until(&track, 20_000, |ride, _| ride.way > track.bead.0 + 0.012);
    let mut seen = std::collections::BTreeMap::<&str, u32>::new();
    let script = [
        (0, Event::Hold),
        (120, Event::BackUp),
        (300, Event::Hold),
        (400, Event::Resume),
        (1_900, Event::Stop),
    ];
    for cycle in 0..1_920 {
        if let Some((_, event)) = script.iter().find(|(at, _)| *at == cycle) {
            ride.ask(&track, *event);
        }
        ride.cycle(Some(&track));
        if cycle % 13 > 0 && cycle < 1_900 {
            continue;
        }
        for event in Event::ALL {
            let from = ride.bench.cycle.mode();
            let mut trial =
                Ride { bench: ride.bench.clone(), rows: ride.rows[ride.rows.len() - 4..].to_vec(), ..ride };
            trial.bench.input.event = Some(event);
            // Without power the arm may be moved by hand: the command follows what is measured.
            let on_track = (event != Event::Disable).then_some(&track);
            let output = trial.cycle(on_track);
            let refused = output.status.refused == Some(event);
            let expected = from.after(event, true).filter(|_| event.is_operators());
            if refused {
                assert!(
                    expected.is_none() || matches!(event, Event::BackUp | Event::Disable),
                    "{from:?} {event:?}"
                );
                assert!(
                    output.status.mode == from || from == Mode::Stopping || from == Mode::Resuming,
                    "{from:?} {event:?}"
                );
            } else {
                // The motion itself may bring about the next event in the same cycle.
                let next = [Event::AtRest, Event::Ready]
                    .map(|then| expected.and_then(|mode| mode.after(then, true)));
                let found = Some(output.status.mode);
                assert!(
                    found == expected || next.contains(&found),
                    "{cycle}: {from:?} {event:?}: {found:?}, {:?}",
                    output.status.fault
                );
            }
            (0..150).for_each(|_| {
                trial.cycle(on_track);
            });
            if event != Event::Disable {
                trial.assert_within_limits(&arm);
            }
            *seen.entry(from.name()).or_default() += 1;
        }
    }
    println!("{seen:?}");
    assert!(
        ["holding", "backing", "resuming", "running", "stopping"].iter().all(|mode| seen.contains_key(mode)),
        "{seen:?}"
    );
}

/// 60 times at random instants back along the path, for a random time; then on to the end.
#[test]
fn backing_up_keeps_to_the_path_and_the_job_goes_on() {
    let cell = default_cell();
    let bench = weld(&cell);
    let (arm, track) = (job(&cell).0, track(&bench));
    let mut furthest = 0.0_f64;
    at_random_instants(&bench, &track, &mut Random(8), 60, |k, mut ride, random| {
        ride.ask(&track, Event::Hold);
        ride.until(&track, 1_000, |_, output| output.status.at_rest);
        let (stopped, welding) = (ride.way, ride.burned > 0.0 && ride.burned < track.bead.1 - 1e-3);
        ride.ask(&track, Event::BackUp);
        let burned = ride.burned;
        let cycles = (random.unit() * 3_000.0) as usize;
        for _ in 0..cycles {
            let output = ride.cycle(Some(&track));
            assert_eq!((output.arc.on, output.status.fault), (false, None));
        }
        furthest = furthest.max(stopped - ride.way);
        assert!(
            ride.way <= stopped + 1e-9 && (!welding || ride.way > track.bead.0 - 1.1e-5),
            "{} {stopped}",
            ride.way
        );
        if ride.bench.cycle.mode() == Mode::Backing {
            ride.ask(&track, Event::Hold);
        }
        ride.until(&track, 1_000, |_, output| output.status.at_rest);
        let backed = ride.way;
        let overlap = go_on(&mut ride, &track, Event::Resume);
        if welding {
            // Not further back than the operator has gone, unless the overlap asks for it.
            let least = (burned - backed).min(cell.arc.overlap);
            assert!(overlap.unwrap() >= least - 1.1e-5, "{overlap:?} {backed}");
        }
        if k % 10 == 0 && ride.bench.cycle.mode() == Mode::Running {
            ride.until(&track, 30_000, |_, output| output.status.mode == Mode::Standstill);
            assert_eq!(ride.rows.last(), track.rows.last());
        }
        ride.assert_within_limits(&arm);
    });
    assert!(furthest > 0.02, "{furthest}");
}
