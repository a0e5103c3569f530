//! Around a tracked weld: corners, moves away from it, a second weld, backing up, override, stops off the path, and seams that lead too far.

use nalgebra::Vector3;
use seamline::control::{CycleOutput, Event, Mode};
use seamline::safety::Fault;
use seamline_cell::cell::Cell;
use seamline_cell::sensor::SimulatedSeam;

use crate::bench::{Random, worst_shares};
use crate::seam::{RUN_IN, SeamMachine, Taught, Weld, cell, tool};

const MM: f64 = 1e-3;

/// A job with positions in mm (x, y, z and the turn about z in degrees) and a program that refers to them.
fn job(positions: &[[f64; 4]], program: &str) -> String {
    let lines: String = positions
        .iter()
        .enumerate()
        .map(|(k, [x, y, z, turn])| format!("C{k:05}={x:.3},{y:.3},{z:.3},180.0000,0.0000,{turn:.4}\n"))
        .collect();
    format!(
        "/JOB\n//NAME SEAM\n//POS\n///NPOS {},0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n///RCONF 1,0,0,0,0,0,0,0\n{lines}\
         //INST\n///DATE 2026/01/01 00:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n{program}END\n",
        positions.len()
    )
}

/// A run whose commands are kept.
struct Run {
    machine: Box<SeamMachine>,
    joints: Vec<[f64; 6]>,
    /// Coordinate of the weld and correction, where the torch moves on it.
    seam: Vec<Option<(f64, [f64; 2])>>,
}

impl Run {
    fn new(weld: &Weld) -> Self {
        Self { machine: Box::new(weld.machine()), joints: Vec::new(), seam: Vec::new() }
    }

    fn cycle(&mut self) -> CycleOutput<6> {
        let (output, _) = self.machine.cycle();
        self.joints.push(output.command.position);
        let seam = output.status.seam.filter(|seam| seam.on_seam);
        self.seam.push(seam.map(|seam| (seam.s, [seam.offset.x, seam.offset.y])));
        output
    }

    fn until(&mut self, done: impl Fn(&CycleOutput<6>) -> bool) -> CycleOutput<6> {
        for _ in 0..100_000 {
            let output = self.cycle();
            if done(&output) {
                return output;
            }
        }
        panic!("it does not come to that: {:?}", self.seam.last());
    }

    fn finish(&mut self) {
        let end =
            self.until(|output| output.status.mode == Mode::Standstill || output.status.fault.is_some());
        assert_eq!(end.status.fault, None);
    }

    /// To rest, and back for so many cycles, without a fault: the cycles at which the arm stood.
    fn pause_and_back_up(&mut self, cycles: f64) -> [usize; 2] {
        let stand = |run: &mut Self| {
            run.machine.request(Event::Hold);
            run.until(|output| output.status.at_rest);
            run.joints.len() - 1
        };
        let rest = stand(self);
        self.machine.request(Event::BackUp);
        for _ in 0..cycles as usize {
            assert_eq!(self.cycle().status.fault, None);
        }
        [rest, stand(self)]
    }

    fn assert_within_limits(&self, weld: &Weld) {
        let shares = worst_shares(&self.joints, &weld.arm, weld.cell.cycle.period);
        assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{shares:?}");
    }

    fn tool(&self, cycle: usize) -> Vector3<f64> {
        tool(&self.joints[cycle]).translation.vector
    }

    /// From where to where along the weld the torch was, in one piece each.
    fn pieces(&self) -> Vec<[f64; 2]> {
        let mut pieces: Vec<[f64; 2]> = Vec::new();
        let mut on = false;
        for seam in &self.seam {
            match (seam, pieces.last_mut()) {
                (Some((s, _)), Some(piece)) if on => piece[1] = *s,
                (Some((s, _)), _) => pieces.push([*s, *s]),
                (None, _) => {}
            }
            on = seam.is_some();
        }
        pieces
    }
}

/// An L of 120 mm each with the seam 3 mm beside it and 2 mm above: the robot stops at the corner, and behind it the torch is on the seam again after
/// a run-in. In between the height stays, and away from the seam the joints' limits hold at full speed.
#[test]
fn a_corner_ends_a_weld_and_begins_another() {
    let points = [
        [1100.0, -100.0, -250.0, 0.0],
        [1100.0, -100.0, -300.0, 0.0],
        [1100.0, 20.0, -300.0, 0.0],
        [1000.0, 20.0, -300.0, 0.0],
        [880.0, 20.0, -300.0, 0.0],
    ];
    let program = "MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\nCOMARCON\nMOVL C00002 V=20.0\nMOVL C00003 V=20.0\nMOVL C00004 V=20.0\n\
                   COMARCOF\nMOVJ C00000 VJ=100.00\nMOVJ C00001 VJ=100.00 PL=0\n";
    let features = "[simulation]\nlaser_noise_mm = 0.0\n[[simulation.seam]]\nnumber = 1\nkind = \"drift\"\nat_mm = -10.0\nlength_mm = 1.0\nlateral_mm = 3.0\nheight_mm = 2.0\n";
    let text = format!("{features}[sensor]\nsource = \"simulated\"\n");
    let weld = Weld::with(Taught::Line, &job(&points, program), Cell::parse(&text, "cell.toml").unwrap());
    let mut run = Run::new(&weld);
    run.finish();
    run.assert_within_limits(&weld);
    let seam = SimulatedSeam { features: weld.cell.simulation.seam.clone() };
    let on_seam = |range: [f64; 2]| {
        let within = run.seam.iter().flatten().filter(|(s, _)| range[0] < *s && *s < range[1]);
        within.map(|(s, c)| (c[0] - seam.offset(*s).x).hypot(c[1] - seam.offset(*s).y)).fold(0.0, f64::max)
    };
    assert!(on_seam([RUN_IN, 0.12]) < 0.05 * MM && on_seam([0.12 + RUN_IN, 0.34]) < 0.05 * MM);
    let heights = run.seam.iter().flatten().filter(|(s, _)| *s > RUN_IN).map(|(_, c)| c[1]);
    assert!(heights.fold(f64::INFINITY, f64::min) > 1.9 * MM);
    // It really stands at the corner.
    let slowest = (1..run.joints.len())
        .filter(|&k| run.seam[k].is_some_and(|(s, _)| (0.1..0.14).contains(&s)))
        .map(|k| (run.tool(k) - run.tool(k - 1)).norm())
        .fold(f64::INFINITY, f64::min);
    assert!(slowest < 1e-7, "{slowest}");
}

/// Two welds with COMARCON each, a joint move at full speed between them, and a turn on the spot in the second: each is tracked by itself, the
/// coordinate counts anew, and the limits hold.
#[test]
fn welds_follow_each_other() {
    let points = [
        [1100.0, -100.0, -250.0, 0.0],
        [1100.0, -100.0, -300.0, 0.0],
        [1100.0, 0.0, -300.0, 0.0],
        [1000.0, -100.0, -300.0, 0.0],
        [1000.0, 0.0, -300.0, 0.0],
        [1000.0, 0.0, -300.0, 10.0],
        [1000.0, 100.0, -300.0, 10.0],
    ];
    let program = "MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\nCOMARCON\nMOVL C00002 V=30.0 PL=0\nCOMARCOF\nMOVJ C00003 VJ=100.00 PL=0\n\
                   COMARCON\nMOVL C00004 V=30.0 PL=0\nMOVL C00005 VR=20.0 PL=0\nMOVL C00006 V=30.0 PL=0\nCOMARCOF\nMOVJ C00000 VJ=100.00\n";
    let weld = Weld::with(Taught::Line, &job(&points, program), cell(4, ""));
    let mut run = Run::new(&weld);
    run.finish();
    run.assert_within_limits(&weld);
    let pieces = run.pieces();
    let near =
        |piece: [f64; 2], from: f64, to: f64| (piece[0] - from).abs() < 1e-3 && (piece[1] - to).abs() < 1e-3;
    let [first, second, third] = pieces[..] else { panic!("{pieces:?}") };
    assert!(near(first, 0.0, 0.1) && near(second, 0.0, 0.1) && near(third, 0.1, 0.2), "{pieces:?}");
    let corrected = run.seam.iter().flatten().filter(|(s, _)| *s > RUN_IN).map(|(_, c)| c[0].hypot(c[1]));
    assert!(corrected.fold(0.0, f64::max) > 3.0 * MM);
}

/// Backing up at random instants of a tracked weld and of the moves behind it, override up and down: on the same path to a micrometre, within the limits.
#[test]
fn backing_up_and_override_keep_the_path() {
    let weld = Weld::new(Taught::Arc, 40.0, cell(6, "[arc]\nlock_override = false\n"));
    let mut whole = Run::new(&weld);
    whole.finish();
    let mut random = Random(8);
    let (mut backed, mut beside) = (0, 0.0_f64);
    for _ in 0..10 {
        let mut run = Run::new(&weld);
        let stop = random.within(2_000.0, whole.joints.len() as f64 - 50.0) as usize;
        let change = stop - random.within(10.0, 1_500.0) as usize;
        for k in 0..stop {
            if k == change {
                run.machine.set_override(random.within(0.1, 0.9));
            }
            run.cycle();
        }
        let [rest, back] = run.pause_and_back_up(random.within(50.0, 3_000.0));
        backed += usize::from((run.tool(back) - run.tool(rest)).norm() > 2.0 * MM);
        run.machine.set_override(1.0);
        run.machine.request(Event::Resume);
        run.finish();
        run.assert_within_limits(&weld);
        // On the way back, and forward again: on the way there.
        let there: Vec<Vector3<f64>> = (0..=rest).map(|k| run.tool(k)).collect();
        let off = |p: &Vector3<f64>| {
            let chord = |w: &[Vector3<f64>]| {
                let (way, off) = (w[1] - w[0], p - w[0]);
                let share =
                    if way.norm() > 0.0 { (off.dot(&way) / way.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
                (off - way * share).norm()
            };
            there.windows(2).map(chord).fold(f64::INFINITY, f64::min)
        };
        for k in (rest..back).step_by(25) {
            beside = beside.max(off(&run.tool(k)));
        }
    }
    println!("{backed} of 10 backed, {beside:.1e} m beside at most");
    assert!(backed >= 6 && beside <= 1e-6, "{backed} {beside}");
}

/// A seam that leads out of the workspace: a fault with its name and the arc out, and a stop within the limits.
#[test]
fn a_seam_that_leads_too_far_stops_the_arm() {
    let down = "[[simulation.seam]]\nnumber = 1\nkind = \"drift\"\nat_mm = 100.0\nlength_mm = 100.0\nheight_mm = -9.0\n";
    let text = format!(
        "{down}[sensor]\nsource = \"simulated\"\n[safety]\nworkspace_min_mm = [-2500.0, -2500.0, -305.0]\n"
    );
    let weld = Weld::lit(Taught::Line, 20.0, Cell::parse(&text, "cell.toml").unwrap());
    let mut run = Run::new(&weld);
    let fault = run.until(|output| output.status.fault.is_some());
    assert!(matches!(fault.status.fault, Some(Fault::Workspace { .. })), "{:?}", fault.status.fault);
    assert!(!fault.arc.on);
    run.until(|output| output.status.at_rest);
    let lowest = run.tool(run.joints.len() - 1).z;
    assert!((-0.3055..-0.3045).contains(&lowest), "{lowest}");
    run.assert_within_limits(&weld);
}

/// A stop off the path at random instants of a tracked weld: after the reset the torch comes back to the corrected path and goes on.
#[test]
fn after_a_stop_off_the_path_the_torch_comes_back_to_the_seam() {
    let weld = Weld::lit(Taught::Arc, 40.0, cell(9, ""));
    let mut random = Random(12);
    for _ in 0..6 {
        let mut run = Run::new(&weld);
        run.until(|output| output.status.seam.is_some_and(|seam| seam.on_seam && seam.s > RUN_IN));
        (0..random.within(400.0, 5_000.0) as usize).for_each(|_| {
            run.cycle();
        });
        let left = run.joints.len() - 1;
        run.machine.raise(Fault::Starved);
        let stop = run.until(|output| output.status.mode == Mode::Fault && output.status.at_rest);
        assert!(!stop.arc.on);
        assert!((run.tool(run.joints.len() - 1) - run.tool(left)).norm() > 0.01 * MM);
        run.machine.request(Event::Reset);
        run.cycle();
        run.machine.request(Event::Resume);
        run.until(|output| output.status.mode == Mode::Running);
        // With its overlap behind the place where it was left.
        let here = run.tool(run.joints.len() - 1);
        let near = (0..left).map(|k| (run.tool(k) - here).norm()).fold(f64::INFINITY, f64::min);
        assert!(near < 0.03 * MM && (here - run.tool(left)).norm() > 5.0 * MM, "{near}");
        run.finish();
        run.assert_within_limits(&weld);
    }
}

/// A weld of 1.1 m: backing up ends where the lane's memory does, half a metre back, and the weld goes on from there.
#[test]
fn backing_up_ends_with_what_the_lane_remembers() {
    let points = [[900.0, -550.0, -250.0, 0.0], [900.0, -550.0, -300.0, 0.0], [900.0, 550.0, -300.0, 0.0]];
    let program =
        "MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\nCOMARCON\nMOVL C00002 V=50.0 PL=0\nCOMARCOF\n";
    let weld = Weld::with(Taught::Line, &job(&points, program), cell(2, ""));
    let mut run = Run::new(&weld);
    run.until(|output| output.status.seam.is_some_and(|seam| seam.s > 0.9));
    run.machine.request(Event::Hold);
    run.until(|output| output.status.at_rest);
    run.machine.request(Event::BackUp);
    run.cycle();
    let back = run.until(|output| output.status.at_rest && output.status.mode == Mode::Holding);
    let s = back.status.seam.unwrap().s;
    assert!(back.status.fault.is_none() && (0.4..0.45).contains(&s), "{s}");
    run.machine.request(Event::Resume);
    run.finish();
    run.assert_within_limits(&weld);
}

/// A seam taught by five lines that bend by 6° each: passed without a stop, on the seam and at the programmed speed along it.
#[test]
fn slight_bends_are_passed() {
    let mut points = vec![[1050.0, -150.0, -250.0, 0.0], [1050.0, -150.0, -300.0, 0.0]];
    for k in 0..5 {
        let ([x, y, ..], heading) = (points[points.len() - 1], (84.0 + 6.0 * f64::from(k)).to_radians());
        points.push([x + 60.0 * heading.cos(), y + 60.0 * heading.sin(), -300.0, 6.0 * f64::from(k)]);
    }
    let program = "MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\nCOMARCON\nMOVL C00002 V=20.0\nMOVL C00003 V=20.0\nMOVL C00004 V=20.0\n\
                   MOVL C00005 V=20.0\nMOVL C00006 V=20.0 PL=0\nCOMARCOF\n";
    let weld = Weld::with(Taught::Line, &job(&points, program), cell(5, ""));
    let mut run = Run::new(&weld);
    run.finish();
    run.assert_within_limits(&weld);
    let seam = SimulatedSeam { features: weld.cell.simulation.seam.clone() };
    let (mut off, mut fast) = (0.0_f64, 0.0_f64);
    for k in 1..run.joints.len() {
        let Some((s, c)) = run.seam[k].filter(|(s, _)| (RUN_IN..0.29).contains(s)) else { continue };
        let truth = seam.offset(s);
        off = off.max((c[0] - truth.x).abs().max((c[1] - truth.y).abs()));
        let speed = (run.tool(k) - run.tool(k - 1)).norm() / weld.cell.cycle.period;
        fast = fast.max((speed / 0.02 - 1.0).abs());
    }
    println!("{:.3} mm off at most, speed off by {:.3} %", off / MM, fast * 100.0);
    assert_eq!(run.pieces().len(), 1);
    assert!(off < 0.1 * MM && fast < 0.005, "{off} {fast}");
}

/// A weave of 2 mm about the tracked seam: the torch swings by just that about it, and the travel along it is the programmed one.
#[test]
fn a_weave_goes_about_the_tracked_seam() {
    for taught in [Taught::Line, Taught::Arc] {
        let weld = Weld::with(taught, &taught.job(10.0, "WVON WEV#(1)\n", "WVOF\n"), cell(1, ""));
        let mut run = Run::new(&weld);
        run.finish();
        run.assert_within_limits(&weld);
        let (mut swing, mut off, mut before) = (0.0_f64, 0.0_f64, None);
        for k in 0..run.joints.len() {
            // Away from the weave's ramps and the weld's ends.
            let seam = run.seam[k].filter(|(s, _)| (0.06..0.33).contains(s));
            let Some(seam) = seam.map(|(s, c)| taught.beside(s, c)) else { continue };
            swing = swing.max((run.tool(k) - seam).norm());
            if let Some(before) = before.replace(seam) {
                let travel = (seam - before).norm() / weld.cell.cycle.period;
                off = off.max((travel / 0.01 - 1.0).abs());
            }
        }
        println!("{taught:?}: swings by {:.4} mm, travel off by {:.4} %", swing / MM, off * 100.0);
        assert!((swing / MM - 2.0).abs() < 0.01 && off < 0.005, "{taught:?}: {swing} {off}");
    }
}

/// Programs in which COMARCON and COMARCOF stand where they need not, each run to its end within the limits.
#[test]
fn programs_of_every_kind_run_to_their_end() {
    let points = [
        [1100.0, -100.0, -250.0, 0.0],
        [1100.0, -100.0, -300.0, 0.0],
        [1100.0, -20.0, -300.0, 0.0],
        [1100.0, 60.0, -300.0, 0.0],
        [1080.0, 130.0, -300.0, 0.0],
        [1040.0, 180.0, -300.0, 0.0],
        [1100.0, 60.0, -299.0, 0.0],
    ];
    let (first, second) = ("MOVL C00002 V=40.0 PL=0\n", "MOVL C00003 V=40.0 PL=0\n");
    for program in [
        format!("COMARCON\nCOMARCON\n{first}COMARCON\n{second}COMARCOF\nCOMARCOF\n"),
        format!("COMARCOF\n{first}COMARCOF\nCOMARCON\nCOMARCOF\n{second}"),
        format!("{first}COMARCON\n"),
        format!("COMARCON\n{first}"),
        format!("COMARCON\n{first}MOVJ C00003 VJ=50.00\nMOVL C00004 V=40.0\nMOVL C00005 V=40.0\n"),
        format!("COMARCON\nMOVL C00001 V=40.0\n{first}MOVL C00002 V=40.0\n{second}COMARCOF\n"),
        "COMARCON\nMOVL C00002 V=40.0 CR=2.0\nDOUT OT#(1) ON\nMOVL C00003 V=20.0\nTIMER T=0.20\nMOVL C00004 V=60.0\nMOVL C00005 V=60.0\n\
         COMARCOF\n".into(),
        "COMARCON\nMOVS C00001 V=40.0\nMOVS C00002 V=40.0\nMOVS C00003 V=40.0\nMOVS C00004 V=40.0\nMOVS C00005 V=40.0\nCOMARCOF\n".into(),
        // Moves behind it that are over before the way off the seam could fade.
        format!("COMARCON\n{first}{second}COMARCOF\nTIMER T=0.20\nMOVL C00006 V=100.0 PL=0\nTIMER T=0.20\nMOVL C00003 V=100.0 PL=0\nMOVJ C00000 VJ=100.00\n"),
        format!("WVON WEV#(1)\nCOMARCON\n{first}WVOF\n{second}COMARCOF\nMOVJ C00000 VJ=100.00\nCOMARCON\nMOVJ C00001 VJ=100.00\nCOMARCOF\n"),
    ] {
        let whole = format!("MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\n{program}");
        let weld = Weld::with(Taught::Line, &job(&points, &whole), cell(7, "[sensor]\nlost_seam = \"taught_path\"\n"));
        let mut run = Run::new(&weld);
        run.finish();
        run.assert_within_limits(&weld);
    }
}

/// Behind each prefilter on the feedrate the arm leaves the seam, on a line and on an arc, by up to 7 mm to the next move: within the limits, also with a
/// pause, a way back for a random time and on again around the place where it leaves, and to the same end.
#[test]
fn a_seam_is_left_behind_every_prefilter_on_the_feedrate() {
    let (mut random, mut backed) = (Random(12), 0);
    let names = ["zv", "zvd", "fir", "fir-zv", "fir-zvd", "mzv", "ei", "2hump-ei", "3hump-ei"];
    for (k, prefilter) in names.into_iter().enumerate() {
        let vibration = format!(
            "[vibration]\nprefilter = \"{prefilter}\"\non = \"feedrate\"\n[[flexible_mode]]\nnumber = 1\nfrequency_hz = 9.0\n\
             damping = 0.02\n"
        );
        let taught = [Taught::Line, Taught::Arc][k % 2];
        let weld = Weld::new(taught, 50.0, cell(3, &vibration));
        let mut whole = Run::new(&weld);
        whole.finish();
        whole.assert_within_limits(&weld);
        let leaves = whole.seam.iter().rposition(Option::is_some).unwrap() as f64;
        for _ in 0..4 {
            let mut run = Run::new(&weld);
            (0..random.within(leaves - 300.0, leaves + 700.0) as usize).for_each(|_| {
                run.cycle();
            });
            let [rest, back] = run.pause_and_back_up(random.within(50.0, 1_500.0));
            backed += usize::from((run.tool(back) - run.tool(rest)).norm() > 2.0 * MM);
            run.machine.request(Event::Resume);
            run.finish();
            run.assert_within_limits(&weld);
            assert_eq!(run.joints.last(), whole.joints.last(), "{prefilter}");
        }
    }
    assert!(backed >= 12, "{backed}");
}

/// A random program: moves of several kinds between points about the seam, with stops, weaves, the arc and tracking switched on and off anywhere.
fn random_program(random: &mut Random) -> String {
    let mut points = vec![[1100.0, -100.0, -250.0, 0.0], [1100.0, -100.0, -300.0, 0.0]];
    let mut program = String::from("MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 PL=0\n");
    let (mut heading, mut lit, mut woven) = (90.0_f64, false, false);
    for _ in 0..10 {
        let [x, y, ..] = points[points.len() - 1];
        heading += if random.unit() < 0.3 { random.within(-120.0, 120.0) } else { random.within(-6.0, 6.0) };
        let length = if random.unit() < 0.3 { random.within(0.3, 6.0) } else { random.within(10.0, 80.0) };
        let (sin, cos) = heading.to_radians().sin_cos();
        let (x, y) = ((x + length * cos).clamp(950.0, 1250.0), (y + length * sin).clamp(-250.0, 250.0));
        points.push([x, y, -300.0, 0.0]);
        let (number, mm_s) = (points.len() - 1, random.within(8.0, 60.0));
        match (random.unit() * 9.0) as u32 {
            0 | 1 => program += "COMARCON\n",
            2 => program += "COMARCOF\n",
            3 => program += "TIMER T=0.10\n",
            4 => {
                program += if lit { "ARCOF AEF#(1)\n" } else { "ARCON ASF#(1)\n" };
                lit = !lit;
            }
            5 => {
                program += if woven { "WVOF\n" } else { "WVON WEV#(1)\n" };
                woven = !woven;
            }
            _ => {}
        }
        program += &match (random.unit() * 8.0) as u32 {
            0 if !lit => format!("MOVJ C{number:05} VJ={:.2}\n", random.within(5.0, 100.0)),
            1 | 2 => format!("MOVL C{number:05} V={mm_s:.1} PL=0\n"),
            _ => format!("MOVL C{number:05} V={mm_s:.1}\n"),
        };
    }
    job(&points, &program)
}

/// Random programs with random pauses, back-ups and overrides: no fault, all limits kept, the end reached.
fn random_programs(seeds: std::ops::Range<u64>) {
    let (mut run_whole, mut tracked) = (0, 0);
    for seed in seeds {
        let mut random = Random(seed);
        let text = random_program(&mut random);
        let more =
            "[sensor]\nlost_seam = \"taught_path\"\n[arc]\nlock_override = false\nrefuse_slowdown = false\n";
        let Some(weld) = Weld::where_possible(Taught::Line, &text, cell(seed as u32, more)) else { continue };
        let mut run = Run::new(&weld);
        let mut events = Random(seed + 7);
        let mut end = None;
        for cycle in 0..150_000 {
            let output = run.cycle();
            assert_eq!(output.status.fault, None, "{seed}\n{text}");
            // In the end nobody interferes any more.
            if cycle > 60_000 {
                run.machine.set_override(1.0);
            }
            let mode = output.status.mode;
            match mode {
                Mode::Standstill => {
                    end = Some(());
                    break;
                }
                Mode::Running if cycle < 60_000 && events.unit() < 5e-4 => run.machine.request(Event::Hold),
                Mode::Running if cycle < 60_000 && events.unit() < 5e-4 => {
                    run.machine.set_override(events.within(0.1, 1.0))
                }
                Mode::Holding if output.status.at_rest && events.unit() < 0.01 => {
                    run.machine.request(if cycle < 60_000 && events.unit() < 0.4 {
                        Event::BackUp
                    } else {
                        Event::Resume
                    });
                }
                Mode::Backing if events.unit() < 2e-3 => run.machine.request(Event::Hold),
                _ => {}
            }
        }
        assert!(end.is_some(), "{seed} does not end\n{text}");
        run.assert_within_limits(&weld);
        run_whole += 1;
        tracked += usize::from(run.seam.iter().flatten().count() > 1_000);
    }
    println!("{run_whole} programs, {tracked} with a tracked seam");
    assert!(run_whole > 0 && tracked > 0);
}

#[test]
fn random_programs_run_to_their_end() {
    random_programs(0..12);
}

/// The same with 400 seeds.
#[test]
#[ignore = "takes minutes"]
fn many_random_programs_run_to_their_end() {
    random_programs(100..500);
}
