//! Jobs that track a seam, run by the machine with the simulated laser, and judged from the commands by an independent arm model.

use nalgebra::{Isometry3, Vector3};
use rtrb::RingBuffer;
use seamline::control::{Command, Event, Mode};
use seamline::kinematics::SixAxisArm;
use seamline_cell::cell::Cell;
use seamline_cell::job::{
    Interpreter, JobFile, JobPosition, JobSet, LinearSpeedUnit, SignalKind, Step, World,
};
use seamline_cell::plan::Arm;
use seamline_cell::record::Sample;
use seamline_cell::run::{Devices, Machine, MonotonicClock};
use seamline_cell::sensor::{CellSensor, SimulatedSeam};
use seamline_cell::sim::{SimulatedArc, SimulatedDrive};

use crate::bench::{
    Ar2010, Random, commands, independent_forward, independent_torch, on_feedrate, planned, worst_shares,
};

const MM: f64 = 1e-3;
/// Look-ahead and 15 mm: what lies before is not seen in time.
pub(crate) const RUN_IN: f64 = 45.0 * MM;
const RADIUS: f64 = 100.0 * MM;
const SEEDS: u32 = 30;

pub(crate) type SeamMachine = Machine<6, SixAxisArm, SimulatedDrive<6>, SimulatedArc, MonotonicClock>;

/// The taught path of a weld: 345 mm along y, or round an arc to the left of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Taught {
    Line,
    Arc,
}

impl Taught {
    /// Where the weld is taught, and the travel there.
    fn at(self, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        match self {
            Self::Line => (Vector3::new(1.1, -0.2 + s, -0.3), Vector3::y()),
            Self::Arc => {
                let (sin, cos) = (s / RADIUS - 1.2).sin_cos();
                (Vector3::new(1.1 + RADIUS * cos, RADIUS * sin, -0.3), Vector3::new(-sin, cos, 0.0))
            }
        }
    }

    /// The coordinate straight across from a tool: of the turn, the one nearest to `near`.
    pub(crate) fn coordinate(self, tool: &Vector3<f64>) -> f64 {
        match self {
            Self::Line => tool.y + 0.2,
            Self::Arc => RADIUS * (tool.y.atan2(tool.x - 1.1) + 1.2),
        }
    }

    /// To the left of the travel and up, with the wire down; in metres.
    pub(crate) fn offset(self, tool: &Vector3<f64>) -> [f64; 2] {
        let (point, travel) = self.at(self.coordinate(tool));
        let left = Vector3::new(-travel.y, travel.x, 0.0);
        [(tool - point).dot(&left), (tool - point).z]
    }

    /// A place beside the taught path, to the left and up.
    pub(crate) fn beside(self, s: f64, [left, up]: [f64; 2]) -> Vector3<f64> {
        let (point, travel) = self.at(s);
        point + Vector3::new(-travel.y, travel.x, 0.0) * left + Vector3::new(0.0, 0.0, up)
    }

    /// A position of the job: the tool turns with the travel.
    fn position(self, s: f64, lift: f64) -> String {
        let (point, travel) = self.at(s);
        let mm = (point + Vector3::new(0.0, 0.0, lift)) * 1e3;
        // So that the wrist stands in the middle of its range on the way.
        let turn = travel.y.atan2(travel.x).to_degrees() - 90.0;
        format!("{:.3},{:.3},{:.3},180.0000,0.0000,{turn:.4}", mm.x, mm.y, mm.z)
    }

    /// A job that welds 300 mm after a run-in; `weld` stands before its move, `after` behind it.
    pub(crate) fn job(self, mm_s: f64, weld: &str, after: &str) -> String {
        let places =
            [(0.0, 0.05), (0.0, 0.0), (0.0225, 0.0), (0.045, 0.0), (0.195, 0.0), (0.345, 0.0), (0.345, 0.05)];
        let positions: Vec<String> = (0..places.len())
            .map(|k| format!("C{k:05}={}\n", self.position(places[k].0, places[k].1)))
            .collect();
        let v = format!("V={mm_s:.1}");
        let moves = |via: u32, end: u32| match self {
            Self::Line => format!("MOVL C{end:05} {v} PL=0\n"),
            Self::Arc => format!("MOVC C{:05} {v}\nMOVC C{via:05} {v}\nMOVC C{end:05} {v} PL=0\n", via - 1),
        };
        let (run_in, bead) = (moves(2, 3), moves(4, 5));
        format!(
            "/JOB\n//NAME SEAM\n//POS\n///NPOS 7,0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n///RCONF 1,0,0,0,0,0,0,0\n{}\
             //INST\n///DATE 2026/01/01 00:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\nMOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\n\
             COMARCON\n{run_in}{weld}{bead}{after}COMARCOF\nMOVL C00006 V=100.0 PL=0\nMOVJ C00000 VJ=20.00\nEND\n",
            positions.concat()
        )
    }
}

/// Inputs are off, and nothing is asked of the robot.
struct Quiet;

impl World for Quiet {
    fn input(&mut self, _: SignalKind, _: u32) -> u32 {
        0
    }

    fn current_position(&mut self) -> Option<JobPosition> {
        None
    }

    fn convert(&mut self, _: &JobPosition, _: seamline_cell::job::Frame, _: u32) -> Option<JobPosition> {
        None
    }

    fn arc_speed_mm_s(&mut self, _: &seamline_cell::job::ArcCondition) -> Option<f64> {
        None
    }
}

pub(crate) fn steps(text: &str) -> Vec<Step> {
    let file = JobFile::parse("seam.JBI", text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let set = JobSet::from_files(vec![file]).unwrap();
    let mut interpreter = Interpreter::new(&set, LinearSpeedUnit::default());
    std::iter::from_fn(|| interpreter.next(&mut Quiet).unwrap()).collect()
}

/// A cell with the simulated laser on a seam: ±5 mm over 200 mm to the side and in height, at random phases; `more` is added.
pub(crate) fn cell(seed: u32, more: &str) -> Cell {
    let mut random = Random(u64::from(seed) + 1000);
    let waves = ["lateral_mm", "height_mm"].map(|axis| {
        let at = random.within(-200.0, 0.0);
        let number = if axis == "height_mm" { 2 } else { 1 };
        format!(
            "[[simulation.seam]]\nnumber = {number}\nkind = \"sine\"\nat_mm = {at:?}\nlength_mm = 200.0\n{axis} = 5.0\n"
        )
    });
    // On the arc the seam runs 4.5 mm aside within the look-ahead, and wanders 5 mm farther: the laser sees it within 20 mm.
    let laser = "[sensor]\nsource = \"simulated\"\nrange_mm = 20.0\n";
    let more = match more.contains("[sensor]\n") {
        true => more.replace("[sensor]\n", laser),
        false => format!("{more}{laser}"),
    };
    let text = format!("[simulation]\nseed = {seed}\n{}{more}", waves.concat());
    Cell::parse(&text, "cell.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A job in its cell, ready to run.
pub(crate) struct Weld {
    pub(crate) taught: Taught,
    pub(crate) cell: Cell,
    pub(crate) arm: Ar2010,
    pub(crate) commands: Vec<Command<6>>,
}

/// What was commanded in each cycle.
pub(crate) struct Trace {
    pub(crate) joints: Vec<[f64; 6]>,
    pub(crate) samples: Vec<Sample>,
}

impl Weld {
    pub(crate) fn new(taught: Taught, mm_s: f64, cell: Cell) -> Self {
        Self::with(taught, &taught.job(mm_s, "", ""), cell)
    }

    pub(crate) fn with(taught: Taught, job: &str, cell: Cell) -> Self {
        let arm: Ar2010 = Arm::from_cell(&cell).unwrap();
        let parts = planned(&cell, &arm, &steps(job)).unwrap_or_else(|error| panic!("{error}\n{job}"));
        Self { taught, commands: commands(&parts), cell, arm }
    }

    /// With an arc over the 300 mm.
    pub(crate) fn lit(taught: Taught, mm_s: f64, cell: Cell) -> Self {
        Self::with(taught, &taught.job(mm_s, "ARCON ASF#(1)\n", "ARCOF AEF#(1)\n"), cell)
    }

    /// A job, or `None` where it is refused.
    pub(crate) fn where_possible(taught: Taught, job: &str, cell: Cell) -> Option<Self> {
        let arm: Ar2010 = Arm::from_cell(&cell).unwrap();
        let parts = planned(&cell, &arm, &steps(job)).ok()?;
        Some(Self { taught, commands: commands(&parts), cell, arm })
    }

    /// Why a job is refused.
    pub(crate) fn refused(job: &str, cell: &Cell) -> String {
        let arm: Ar2010 = Arm::from_cell(cell).unwrap();
        planned(cell, &arm, &steps(job)).unwrap_err().to_string()
    }

    pub(crate) fn machine(&self) -> SeamMachine {
        let (mut producer, consumer) = RingBuffer::new(self.commands.len());
        self.commands.iter().for_each(|command| producer.push(*command).unwrap());
        let devices = Devices {
            drive: SimulatedDrive::from_cell(&self.cell).unwrap(),
            arc: SimulatedArc::from_cell(&self.cell),
            seam: CellSensor::from_cell(&self.cell).unwrap(),
        };
        let mut machine =
            Machine::new(&self.cell, &self.arm, devices, MonotonicClock::default(), consumer).unwrap();
        machine.request(Event::Enable);
        machine.cycle();
        machine.request(Event::Start);
        machine
    }

    /// To the end, without a fault and within the joints' limits.
    pub(crate) fn run(&self) -> Trace {
        let mut machine = self.machine();
        let mut trace = Trace { joints: Vec::new(), samples: Vec::new() };
        for _ in 0..200_000 {
            let (output, sample) = machine.cycle();
            assert_eq!(output.status.fault, None, "at {} s", sample.time);
            trace.joints.push(output.command.position);
            trace.samples.push(sample);
            if output.status.mode == Mode::Standstill {
                let shares = worst_shares(&trace.joints, &self.arm, self.cell.cycle.period);
                assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
                return trace;
            }
        }
        panic!("the run does not end");
    }

    /// The lines of the job at which the seam is tracked after the run-in, with an arc or without.
    fn bead_line(&self, trace: &Trace) -> u32 {
        trace.samples.iter().rfind(|sample| sample.seam_error.is_finite()).map_or(0, |sample| sample.line)
    }
}

pub(crate) fn tool(q: &[f64; 6]) -> Isometry3<f64> {
    independent_forward(q) * independent_torch()
}

/// The worst of several runs.
#[derive(Debug, Clone, Copy, Default)]
struct Figures {
    /// Of the worse axis, in mm.
    rms: f64,
    max: f64,
    /// Of the travel speed, as a share.
    speed: f64,
    /// Of the correction across the seam, in m/s³.
    jerk: f64,
}

/// Along the bead: the distance of the torch from the seam and the travel along it.
fn figures(weld: &Weld, trace: &Trace, mm_s: f64) -> Figures {
    let line = weld.bead_line(trace);
    let seam = SimulatedSeam { features: weld.cell.simulation.seam.clone() };
    let tools: Vec<Vector3<f64>> = trace.joints.iter().map(|q| tool(q).translation.vector).collect();
    let bead: Vec<usize> = (0..tools.len()).filter(|&k| trace.samples[k].line == line).collect();
    let mut worst = Figures::default();
    let (mut squares, mut count) = ([0.0; 2], 0.0);
    for &k in &bead {
        let s = weld.taught.coordinate(&tools[k]);
        if s < RUN_IN {
            continue;
        }
        let (offset, truth) = (weld.taught.offset(&tools[k]), seam.offset(s));
        let errors = [offset[0] - truth.x, offset[1] - truth.y];
        worst.max = worst.max.max(errors[0].abs().max(errors[1].abs()) / MM);
        squares = [0, 1].map(|axis| squares[axis] + errors[axis] * errors[axis]);
        count += 1.0;
    }
    assert!(count > 2_000.0, "{count} cycles");
    worst.rms = (squares[0].max(squares[1]) / count).sqrt() / MM;
    let period = weld.cell.cycle.period;
    // Without what the torch takes to gain and to lose its speed.
    let ramp = (0.15 / period) as usize;
    for &k in &bead[ramp..bead.len() - ramp] {
        let speed = (tools[k] - tools[k - 1]).norm() / period / MM;
        worst.speed = worst.speed.max((speed / mm_s - 1.0).abs());
    }
    let offsets: Vec<Vector3<f64>> = bead[ramp..bead.len() - ramp]
        .iter()
        .map(|&k| {
            let [left, up] = weld.taught.offset(&tools[k]);
            Vector3::new(left, up, 0.0)
        })
        .collect();
    // Over 4 cycles: the rounding of differences over one is of the order of what is looked for.
    for k in (12..offsets.len()).step_by(4) {
        let third = offsets[k] - offsets[k - 4] * 3.0 + offsets[k - 8] * 3.0 - offsets[k - 12];
        worst.jerk = worst.jerk.max(third.norm() / (4.0 * period).powi(3));
    }
    worst
}

fn worst_of(taught: Taught, mm_s: f64, seeds: std::ops::Range<u32>, more: &str) -> Figures {
    let mut worst = Figures::default();
    for seed in seeds {
        let weld = Weld::new(taught, mm_s, cell(seed, more));
        let of = figures(&weld, &weld.run(), mm_s);
        worst = Figures {
            rms: worst.rms.max(of.rms),
            max: worst.max.max(of.max),
            speed: worst.speed.max(of.speed),
            jerk: worst.jerk.max(of.jerk),
        };
    }
    println!(
        "{taught:?} at {mm_s} mm/s: RMS {:.4} mm, max {:.3} mm, speed off {:.4} %, jerk across {:.0} mm/s3",
        worst.rms,
        worst.max,
        worst.speed * 100.0,
        worst.jerk / MM
    );
    worst
}

fn meets_spec(mm_s: f64, rms: f64, max: f64, seeds: u32) {
    for taught in [Taught::Line, Taught::Arc] {
        let worst = worst_of(taught, mm_s, 0..seeds, "");
        assert!(worst.rms <= rms && worst.max <= max, "{taught:?} at {mm_s}: {worst:?}");
        assert!(worst.speed <= 0.005 && worst.jerk <= 20.0 * 1.02, "{taught:?} at {mm_s}: {worst:?}");
    }
}

/// SPEC 6.6 with one seed a speed: errors, travel and jerk.
#[test]
fn the_seam_is_kept_at_every_speed() {
    for (mm_s, rms, max) in [(10.0, 0.015, 0.08), (20.0, 0.015, 0.08), (50.0, 0.02, 0.15), (100.0, 0.04, 0.2)]
    {
        meets_spec(mm_s, rms, max, 1);
    }
}

/// The same with 30 seeds.
#[test]
#[ignore = "240 welds"]
fn the_seam_is_kept_with_thirty_seeds() {
    for (mm_s, rms, max) in [(10.0, 0.015, 0.08), (20.0, 0.015, 0.08), (50.0, 0.02, 0.15), (100.0, 0.04, 0.2)]
    {
        meets_spec(mm_s, rms, max, SEEDS);
    }
}

/// A feature at 150 mm; greatest error over the seeds in mm, on both paths, at 20 mm/s.
fn eventful(seeds: u32, feature: &str, more: &str) -> f64 {
    let more = format!("[[simulation.seam]]\nnumber = 3\nat_mm = 150.0\n{feature}{more}");
    let of = |taught| worst_of(taught, 20.0, 0..seeds, &more);
    let worst = [of(Taught::Line), of(Taught::Arc)];
    assert!(worst.iter().all(|of| of.speed <= 0.005 && of.jerk <= 20.0 * 1.02), "{worst:?}");
    println!("{feature:?}: {:.3} mm at most", worst[0].max.max(worst[1].max));
    worst[0].max.max(worst[1].max)
}

const TACK: &str = "kind = \"tack\"\nheight_mm = 2.0\nlength_mm = 10.0\n";

fn events(seeds: u32) {
    assert!(eventful(seeds, "kind = \"gap\"\nlength_mm = 10.0\n", "") <= 0.1);
    assert!(eventful(seeds, "kind = \"gap\"\nlength_mm = 20.0\n", "") <= 0.1);
    assert!(eventful(seeds, "kind = \"step\"\nlateral_mm = 0.5\n", "") <= 0.3);
    // Over the 195 mm behind it 5° lead 17 mm away.
    let wide = "[sensor]\ncorrection_max_mm = 22.0\n";
    assert!(eventful(seeds, "kind = \"kink\"\nlateral_deg = 5.0\n", wide) <= 0.1);
    assert!(eventful(seeds, TACK, "") <= 0.1);
}

#[test]
fn gaps_are_bridged_steps_met_half_way_and_tacks_not_climbed() {
    events(1);
}

/// The same with 30 seeds.
#[test]
#[ignore = "300 welds"]
fn events_with_thirty_seeds() {
    events(SEEDS);
}

/// By its height, its gap or the laser's quality, each alone; and what comes of following it.
#[test]
fn a_tack_weld_is_told_by_what_the_cell_says() {
    assert!(eventful(1, TACK, "[sensor]\ntack_rise_mm = 0.0\n") > 1.0);
    assert!(eventful(1, TACK, "[sensor]\ntack_rise_mm = 0.0\ntack_gap_mm = 0.5\n") <= 0.1);
    assert!(eventful(1, TACK, "[sensor]\ntack_rise_mm = 0.0\ntack_quality = 0.7\n") <= 0.1);
}

/// Behind a prefilter on the feedrate the torch is on its seam as well, with a weave the joints keep their limits too, and the way off the seam
/// fades on paths and moves of the joints.
#[test]
fn the_seam_is_kept_behind_a_prefilter_on_the_feedrate() {
    for taught in [Taught::Line, Taught::Arc] {
        let mut cell = cell(3, "");
        cell.vibration = on_feedrate("fir-zvd", &[8.0]).vibration;
        let weld = Weld::new(taught, 20.0, cell.clone());
        let of = figures(&weld, &weld.run(), 20.0);
        println!("{taught:?}: {of:?}");
        assert!(of.rms <= 0.015 && of.max <= 0.08, "{taught:?}: {of:?}");
        Weld::with(taught, &taught.job(20.0, "WVON WEV#(1)\n", "WVOF\n"), cell).run();
    }
}

/// With cycles of 4 ms and of 0.25 ms as with those of 1 ms.
#[test]
fn the_seam_is_kept_in_cycles_of_any_length() {
    for period_ms in ["4.0", "0.25"] {
        let worst = worst_of(Taught::Arc, 20.0, 0..1, &format!("[cycle]\nperiod_ms = {period_ms}\n"));
        assert!(worst.rms <= 0.015 && worst.max <= 0.08 && worst.speed <= 0.005, "{period_ms}: {worst:?}");
    }
}

/// The mean of the last 15 readings follows as well, not as closely: what it may be off is the regression's bound for a faster weld.
#[test]
fn the_mean_of_the_last_readings_follows_too() {
    for taught in [Taught::Line, Taught::Arc] {
        let worst = worst_of(taught, 20.0, 0..2, "[sensor]\nfilter = \"mean\"\n");
        assert!(worst.rms <= 0.05 && worst.max <= 0.4 && worst.speed <= 0.005, "{taught:?}: {worst:?}");
    }
}
