//! Passes over a root pass: recorded while it is tracked, welded again beside it without a sensor; judged by an independent arm model.

use std::path::Path;

use nalgebra::Vector3;
use seamline::control::{Command, Event, Mode};
use seamline::safety::Fault;
use seamline_cell::cell::Cell;
use seamline_cell::plan::Arm;
use seamline_cell::run::{Program, RunOptions, RunReport, run};
use seamline_cell::sensor::SensorFault;
use seamline_cell::sensor::passes;

use crate::bench::{Ar2010, Random, planned, worst_shares};
use crate::seam::{RUN_IN, SeamMachine, Taught, Weld, cell, steps, tool};

const MM_S: f64 = 20.0;
const MM: f64 = 1e-3;
/// How the second pass lies from the first, in mm.
const SHIFT: [f64; 2] = [3.0, 2.0];
/// Behind this, the shift has come in; in metres.
const LEAD: f64 = 15.0 * MM;
const PASS: &str = "[[pass]]\nnumber = 2\nof = 1\nlateral_mm = 3.0\nheight_mm = 2.0\n";

/// The job of a weld with its tracked part twice: after `first` and, from the start again, after `second`; `inside` stands in both.
fn twice(taught: Taught, mm_s: [f64; 2], inside: [&str; 2], [first, second]: [&str; 2]) -> String {
    let whole = |mm_s| taught.job(mm_s, inside[0], inside[1]);
    let tracked = |mm_s| {
        let whole: String = whole(mm_s);
        let (from, to) = (whole.find("COMARCON").unwrap(), whole.find("COMARCOF\n").unwrap() + 9);
        whole[from..to].to_owned()
    };
    let again = "MOVL C00006 V=100.0 PL=0\nMOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\n";
    let both = format!("{first}{}MEMOF\n{again}{second}{}MEMOF\n", tracked(mm_s[0]), tracked(mm_s[1]));
    whole(mm_s[0]).replace(&tracked(mm_s[0]), &both)
}

fn two_passes(taught: Taught) -> String {
    twice(taught, [MM_S; 2], ["", ""], ["MEMON REC MPF#(1)\n", "MEMON PLY MPF#(2)\n"])
}

/// A tracked cycle: coordinate of the weld, the tool, and whether it comes from the record.
#[derive(Debug, Clone, Copy)]
struct Row {
    joints: [f64; 6],
    tool: Vector3<f64>,
    s: f64,
    played: bool,
    on_seam: bool,
}

fn cycle(machine: &mut SeamMachine, rows: &mut Vec<Row>) -> (Mode, Option<Fault>, bool) {
    let (output, _) = machine.cycle();
    let joints = output.command.position;
    let seam = output.status.seam;
    rows.push(Row {
        joints,
        tool: tool(&joints).translation.vector,
        s: seam.map_or(f64::NAN, |seam| seam.s),
        played: seam.is_some_and(|seam| seam.from_record),
        on_seam: seam.is_some_and(|seam| seam.on_seam),
    });
    (output.status.mode, output.status.fault, output.status.at_rest)
}

fn assert_within_limits(rows: &[Row], weld: &Weld) {
    let joints: Vec<_> = rows.iter().map(|row| row.joints).collect();
    let shares = worst_shares(&joints, &weld.arm, weld.cell.cycle.period);
    assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
}

/// To the end; from the end of the first pass on the sensor is silent.
fn ridden(weld: &Weld) -> Vec<Row> {
    let mut machine = weld.machine();
    let (mut rows, mut seen) = (Vec::new(), false);
    for _ in 0..200_000 {
        let (mode, fault, _) = cycle(&mut machine, &mut rows);
        assert_eq!(fault, None, "{:?}", rows.last());
        let on = rows[rows.len() - 1].s.is_finite();
        if seen && !on {
            machine.devices_mut().seam.inject(SensorFault::Silent);
        }
        seen |= on;
        if mode == Mode::Standstill {
            assert_within_limits(&rows, weld);
            return rows;
        }
    }
    panic!("the run does not end");
}

/// Offsets from the taught path by the way, of one pass.
fn offsets(taught: Taught, rows: &[Row], played: bool) -> Vec<(f64, [f64; 2])> {
    let of = rows.iter().filter(|row| row.on_seam && row.played == played);
    of.map(|row| (taught.coordinate(&row.tool), taught.offset(&row.tool))).collect()
}

/// How far a second pass lies from where the first one puts it, at the most, in metres; beyond `from`.
fn off(first: &[(f64, [f64; 2])], second: &[(f64, [f64; 2])], from: f64) -> f64 {
    let ahead: Vec<&(f64, [f64; 2])> = first
        .iter()
        .scan(f64::NEG_INFINITY, |s, at| Some((at.0 > std::mem::replace(s, s.max(at.0))).then_some(at)))
        .flatten()
        .collect();
    let (begin, end) = (ahead[0].0.max(from), ahead[ahead.len() - 1].0);
    let mut worst = 0.0_f64;
    for (s, offset) in second.iter().filter(|(s, _)| (begin..end).contains(s)) {
        let k = ahead.partition_point(|at| at.0 < *s).clamp(1, ahead.len() - 1);
        let (before, after) = (ahead[k - 1], ahead[k]);
        let share = (s - before.0) / (after.0 - before.0);
        for axis in 0..2 {
            let there = before.1[axis] + share * (after.1[axis] - before.1[axis]);
            worst = worst.max((offset[axis] - there - SHIFT[axis] * MM).abs());
        }
    }
    worst
}

/// On a line and on an arc, two seeds each: the second pass is the first one shifted, within a micrometre, without readings, at its speed, and
/// the jerk of its correction is within the cell's.
#[test]
fn a_pass_follows_the_recorded_one() {
    for (taught, seed) in [(Taught::Line, 0), (Taught::Line, 1), (Taught::Arc, 0), (Taught::Arc, 1)] {
        let weld = Weld::with(taught, &two_passes(taught), cell(seed, PASS));
        let rows = ridden(&weld);
        let (first, second) = (offsets(taught, &rows, false), offsets(taught, &rows, true));
        assert!(first.len() > 15_000 && second.len() > 15_000, "{} {}", first.len(), second.len());
        let off = off(&first, &second, LEAD);
        let corrected = first.iter().map(|(_, [left, up])| left.hypot(*up)).fold(0.0, f64::max);
        println!("{taught:?}: corrected by up to {:.2} mm, off by {:.2e} mm", corrected / MM, off / MM);
        assert!(corrected > 4.0 * MM && off < 1e-6, "{corrected} {off}");
        let period = weld.cell.cycle.period;
        let middle = |row: &&Row| row.played && row.on_seam && (RUN_IN + 10.0 * MM..0.33).contains(&row.s);
        let bead: Vec<&Row> = rows.iter().filter(middle).collect();
        for pair in bead.windows(2) {
            let speed = (pair[1].tool - pair[0].tool).norm() / period / MM;
            assert!((speed / MM_S - 1.0).abs() < 0.005, "{speed} mm/s at {}", pair[0].s);
        }
        let aside = |row: &Row| {
            let [left, up] = taught.offset(&row.tool);
            Vector3::new(left, up, 0.0)
        };
        // Over 4 cycles: the rounding of differences over one is of the order of what is looked for.
        for k in (12..bead.len()).step_by(4) {
            let at = |back: usize| aside(bead[k - back]);
            let jerk = (at(0) - at(4) * 3.0 + at(8) * 3.0 - at(12)).norm() / (4.0 * period).powi(3);
            assert!(jerk < 20.0 * 1.02, "{jerk} m/s³ at {}", bead[k].s);
        }
    }
}

/// Behind a prefilter on the feedrate the tool is on the shifted lane all the same.
#[test]
fn a_pass_follows_behind_a_prefilter_on_the_feedrate() {
    let prefilter = "[vibration]\nprefilter = \"fir\"\non = \"feedrate\"\n[[flexible_mode]]\nnumber = 1\nfrequency_hz = 9.0\n\
                     damping = 0.02\n";
    for taught in [Taught::Line, Taught::Arc] {
        let weld = Weld::with(taught, &two_passes(taught), cell(3, &format!("{PASS}{prefilter}")));
        let rows = ridden(&weld);
        let (first, second) = (offsets(taught, &rows, false), offsets(taught, &rows, true));
        let off = off(&first, &second, LEAD);
        println!("{taught:?}: off by {:.2e} mm", off / MM);
        assert!(first.len() > 15_000 && second.len() > 15_000 && off < 1e-6, "{off}");
    }
}

/// With a weave of 2 mm the second pass swings about the shifted first one.
#[test]
fn a_pass_weaves_about_the_recorded_one() {
    let (on, off) = ("WVON WEV#(1)\n", "WVOF\n");
    let first = "MEMON REC MPF#(1)\n";
    let job = twice(Taught::Line, [10.0; 2], [on, off], [first, "MEMON PLY MPF#(2)\n"]);
    let weld = Weld::with(Taught::Line, &job, cell(2, PASS));
    let machine_rows = ridden(&weld);
    let plain = Weld::with(
        Taught::Line,
        &twice(Taught::Line, [10.0; 2], ["", ""], [first, "MEMON PLY MPF#(2)\n"]),
        cell(2, PASS),
    );
    let seam = offsets(Taught::Line, &ridden(&plain), true);
    let woven: Vec<_> = machine_rows.iter().filter(|row| row.played && row.on_seam).collect();
    let mut edges = [0.0_f64; 2];
    for row in woven.iter().filter(|row| (0.08..0.32).contains(&row.s)) {
        let k = seam.partition_point(|at| at.0 < row.s).min(seam.len() - 1);
        let aside = Taught::Line.offset(&row.tool)[0] - seam[k].1[0];
        edges = [edges[0].max(aside), edges[1].max(-aside)];
    }
    // The records of two runs differ by what the sensor's noise makes of a torch that weaves.
    assert!(edges.iter().all(|edge| (edge / MM - 2.0).abs() < 0.1), "{edges:?}");
}

/// 120 interruptions of a second pass at random instants: pause, back for a random time, on, beyond where it stopped. It keeps to its way (1 µm) and
/// to the limits.
#[test]
fn an_interrupted_pass_keeps_to_its_way() {
    let weld = Weld::with(Taught::Arc, &two_passes(Taught::Arc), cell(4, PASS));
    let whole = ridden(&weld);
    let first = offsets(Taught::Arc, &whole, false);
    let from = whole.iter().position(|row| row.played && row.on_seam).unwrap();
    let to = whole.iter().rposition(|row| row.played && row.on_seam).unwrap();
    let mut random = Random(9);
    let mut instants: Vec<usize> = (0..120).map(|_| random.within(from as f64, to as f64) as usize).collect();
    instants.sort_unstable();
    let mut machine = weld.machine();
    let (mut rows, mut next, mut backed) = (Vec::new(), 0, 0.0_f64);
    while next < instants.len() {
        let (mode, fault, _) = cycle(&mut machine, &mut rows);
        assert_eq!(fault, None);
        // Each time the arm has come so far as an instant of the whole run.
        let here = rows[rows.len() - 1];
        if mode == Mode::Running && here.played && here.on_seam && here.s >= whole[instants[next]].s {
            next += 1;
            machine.request(Event::Hold);
            while !cycle(&mut machine, &mut rows).2 {}
            let stopped = rows[rows.len() - 1].s;
            if next.is_multiple_of(2) {
                machine.request(Event::BackUp);
                (0..(random.unit() * 1_500.0) as usize).for_each(|_| {
                    cycle(&mut machine, &mut rows);
                });
                backed = backed.max(stopped - rows[rows.len() - 1].s);
                machine.request(Event::Hold);
                while !cycle(&mut machine, &mut rows).2 {}
            }
            machine.request(Event::Resume);
            cycle(&mut machine, &mut rows);
        }
        assert!(mode != Mode::Standstill, "{next} of {}", instants.len());
    }
    let second = offsets(Taught::Arc, &rows, true);
    let off = off(&first, &second, LEAD);
    println!("back by up to {:.1} mm, off by {:.2e} mm", backed / MM, off / MM);
    assert!(off < 1e-6 && backed > 10.0 * MM, "{off} {backed}");
    assert_within_limits(&rows, &weld);
}

/// What cannot be played is refused before anything moves.
#[test]
fn a_pass_without_its_record_is_refused() {
    let arm: Ar2010 = Arm::from_cell(&Cell::default_cell().unwrap()).unwrap();
    let plain = |second: &str| twice(Taught::Line, [MM_S; 2], ["", ""], ["MEMON REC MPF#(1)\n", second]);
    let fast = twice(Taught::Line, [MM_S, 30.0], ["", ""], ["MEMON REC MPF#(1)\n", "MEMON PLY MPF#(2)\n"]);
    let job = two_passes(Taught::Line);
    for (job, message) in [
        (plain("MEMON PLY MPF#(3)\n"), "MPF#(3) has no record: expected MEMON REC MPF#(3) before"),
        (fast, "the corrections of weld 1 of MPF#(1) permit up to 20.0 mm/s: found 30.0 mm/s"),
        (
            job.replacen("MOVL C00005", "MOVL C00004", 1),
            "weld 1 of MPF#(1) was recorded over 195.0 mm: expected no more, found 345.0 mm",
        ),
        (job.replace("MEMON PLY MPF#(2)\n", "MEMON PLY MPF#(2)\nMEMON PLY MPF#(2)\n"), "MEMON within MEMON"),
        (job.replace("COMARCON\n", "COMARCON\nMEMOF\n"), "MEMOF within COMARCON"),
        (
            job.replacen("MEMON REC MPF#(1)\nCOMARCON\n", "COMARCON\nMEMON REC MPF#(1)\n", 1),
            "MEMON within COMARCON",
        ),
    ] {
        let error = planned(&cell(0, PASS), &arm, &steps(&job)).unwrap_err().to_string();
        assert!(error.contains(message), "{error}: expected {message}");
    }
}

/// A record that the cycle does not have: the fault names it, and the arm stays where it is.
#[test]
fn a_missing_record_is_a_fault_before_the_pass() {
    let mut weld = Weld::with(Taught::Line, &two_passes(Taught::Line), cell(0, PASS));
    for command in &mut weld.commands {
        if let Command::TrackOn(tracking) = command {
            tracking.record = None;
        }
    }
    let (mut machine, mut rows) = (weld.machine(), Vec::new());
    let fault = (0..100_000).find_map(|_| cycle(&mut machine, &mut rows).1);
    assert_eq!(fault, Some(Fault::NoRecord { file: 1, weld: 0 }));
    let here = rows[rows.len() - 1].tool;
    (0..1_000).for_each(|_| {
        cycle(&mut machine, &mut rows);
    });
    assert_eq!(rows[rows.len() - 1].tool, here);
    assert_within_limits(&rows, &weld);
}

fn run_in(cell: &Cell, job: &str, name: &str) -> Result<RunReport, seamline_cell::run::RunError> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("passes");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.JBI"));
    std::fs::write(&path, job).unwrap();
    let arm: Ar2010 = Arm::from_cell(cell).unwrap();
    let options = RunOptions { out: folder.join(name), speed_override: 1.0, realtime: false };
    run(&Program::load(&path).unwrap(), cell, &arm, &options, |_| {})
}

/// A record goes from one run into another by its file; a file with a mistake, or with a correction that is too great, is refused with its place.
#[test]
fn a_record_is_kept_from_run_to_run() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("root-pass.csv");
    let _ = std::fs::remove_file(&file);
    let more = format!("[[pass]]\nnumber = 1\nfile = {:?}\n{PASS}", file.to_str().unwrap());
    let cell = cell(6, &more);
    let only = |memo: &str| {
        let job = Taught::Line.job(MM_S, "", "");
        job.replace("COMARCON\n", &format!("{memo}COMARCON\n")).replace("COMARCOF\n", "COMARCOF\nMEMOF\n")
    };
    let refused = run_in(&cell, &only("MEMON PLY MPF#(2)\n"), "before").unwrap_err().to_string();
    assert!(refused.contains("MPF#(1) has no record"), "{refused}");
    run_in(&cell, &only("MEMON REC MPF#(1)\n"), "record").unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let lanes = passes::read(&text).unwrap();
    assert!(lanes.len() == 1 && lanes[0].points.len() > 150, "{}", lanes.len());
    let report = run_in(&cell, &only("MEMON PLY MPF#(2)\n"), "play").unwrap();
    let seam = report.summary.seam.unwrap();
    assert!(seam.error_rms_mm.is_none() && seam.lateral_max_mm > 5.0, "{seam:?}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "playing leaves the record as it is");
    for (wrong, message) in [
        (text.replacen("\n0,", "\n1,", 1), "root-pass.csv: line 2, column 1 (weld): `1`: expected"),
        (format!("{text}0,0,1,1,1,1,1\n"), "7 columns: expected 8"),
    ] {
        std::fs::write(&file, wrong).unwrap();
        let refused = run_in(&cell, &only("MEMON PLY MPF#(2)\n"), "wrong").unwrap_err().to_string();
        assert!(refused.contains(message), "{refused}");
    }
}
