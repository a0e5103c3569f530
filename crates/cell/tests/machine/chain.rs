//! Moves that run on into each other: planned as a run, executed by the cycle, judged by an independent arm model.

use std::collections::HashMap;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use seamline::control::ActsOn;
use seamline::kinematics::Kinematics;
use seamline_cell::cell::Cell;
use seamline_cell::job::{
    Action, MovePath, Speed, SplinePiece, Step, Zone, joints_from_pulses, pulses_from_joints,
};
use seamline_cell::plan::{Arm, Planned, Planner};

use crate::bench::{
    Ar2010, Bench, Random, commands, independent_forward, independent_torch, move_to, planned, with_zone,
};

/// Joints in which the tool is at home in front of the robot.
pub(crate) const HOME: [f64; 6] = [0.0, 0.2, -0.2, 0.1, -1.2, 0.3];

#[derive(Clone)]
pub(crate) struct Way {
    pub(crate) cell: Cell,
    pub(crate) arm: Ar2010,
    /// The taught poses, the start first.
    pub(crate) poses: Vec<Isometry3<f64>>,
    pub(crate) joints: Vec<[f64; 6]>,
}

impl Way {
    /// Points by their distance from the start, in mm in a plane that lies askew, and a turn of the tool in degrees about its z axis.
    fn new(points: &[([f64; 2], f64)]) -> Self {
        Self::in_cell(Cell::default_cell().unwrap(), points)
    }

    pub(crate) fn in_cell(cell: Cell, points: &[([f64; 2], f64)]) -> Self {
        let mut arm: Ar2010 = Arm::from_cell(&cell).unwrap();
        arm.home = HOME;
        let torch = independent_torch();
        let start = independent_forward(&HOME) * torch;
        let (u, v) = (Vector3::new(0.6, 0.8, 0.0), Vector3::new(-0.48, 0.36, 0.8));
        let (mut poses, mut joints) = (vec![start], vec![HOME]);
        for ([x, y], degrees) in points {
            let mut pose = start;
            pose.translation.vector += (u * *x + v * *y) / 1000.0;
            pose.rotation *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), degrees.to_radians());
            let q = arm.kinematics.inverse_nearest(&(pose * torch.inverse()), &HOME).unwrap();
            // The point is where the pulses say, some micrometres off.
            let pulses = pulses_from_joints(&q, &arm.pulses_per_unit);
            let q: [f64; 6] = joints_from_pulses(&pulses, &arm.pulses_per_unit).unwrap();
            poses.push(independent_forward(&q) * torch);
            joints.push(q);
        }
        Self { cell, arm, poses, joints }
    }

    pub(crate) fn step(&self, point: usize, path: MovePath, mm_s: f64, zone: Zone) -> Step {
        let speed = Speed::Linear { mm_s };
        with_zone(move_to(point as u32, path, speed, &self.arm, &self.joints[point]), zone)
    }

    pub(crate) fn lines(&self, mm_s: f64, zone: Zone) -> Vec<Step> {
        (1..self.poses.len()).map(|point| self.step(point, MovePath::Linear, mm_s, zone)).collect()
    }

    pub(crate) fn plan(&self, steps: &[Step]) -> Vec<Planned<6>> {
        planned(&self.cell, &self.arm, steps).unwrap()
    }

    pub(crate) fn run(&self, parts: &[Planned<6>]) -> Trace {
        let mut bench = Bench::new(&self.cell, &self.arm, commands(parts));
        let (joints, segments) = bench.run_to_end(&self.arm);
        let tool = |q: &[f64; 6]| independent_forward(q) * independent_torch();
        Trace { tools: joints.iter().map(tool).collect(), segments }
    }
}

pub(crate) struct Trace {
    pub(crate) tools: Vec<Isometry3<f64>>,
    pub(crate) segments: Vec<u32>,
}

impl Trace {
    /// Least distance of the way from a point, in mm.
    pub(crate) fn distance(&self, point: &Isometry3<f64>) -> f64 {
        let p = point.translation.vector;
        let between = |pair: &[Isometry3<f64>]| {
            let (from, to) = (pair[0].translation.vector, pair[1].translation.vector);
            let way = to - from;
            let share = if way.norm() > 0.0 { (p - from).dot(&way) / way.norm_squared() } else { 0.0 };
            (p - from - way * share.clamp(0.0, 1.0)).norm()
        };
        self.tools.windows(2).map(between).fold(f64::INFINITY, f64::min) * 1000.0
    }

    /// Speed of the tool centre point in each cycle, in mm/s.
    pub(crate) fn speeds(&self) -> Vec<f64> {
        let speed =
            |pair: &[Isometry3<f64>]| (pair[1].translation.vector - pair[0].translation.vector).norm() * 1e6;
        self.tools.windows(2).map(speed).collect()
    }

    /// The speeds between the first and the last instant at which `programmed` was reached.
    fn travelling(&self, programmed: f64) -> Vec<f64> {
        let speeds = self.speeds();
        let reached = |speed: &f64| *speed >= programmed * 0.999;
        let first = speeds.iter().position(reached).unwrap();
        let last = speeds.iter().rposition(reached).unwrap();
        speeds[first..=last].to_vec()
    }
}

/// A zigzag with corners from 20 to 150 degrees at weld speed: no stop, the programmed speed all along, and each corner
/// passed at the error of the cell file.
#[test]
fn corners_are_passed_at_speed_within_their_error() {
    let way = Way::new(&[
        ([40.0, 0.0], 0.0),
        ([75.0, 13.0], 3.0),
        ([75.0, 60.0], 0.0),
        ([45.0, 25.0], -4.0),
        ([80.0, 22.0], 0.0),
    ]);
    let trace = way.run(&way.plan(&way.lines(10.0, Zone::Unspecified)));
    let speeds = trace.travelling(10.0);
    let (least, greatest) = speeds.iter().fold((f64::INFINITY, 0.0_f64), |(l, g), s| (l.min(*s), g.max(*s)));
    assert!(least > 9.9 && greatest < 10.01, "{least} … {greatest}");
    // The slight bend is rounded near its point only.
    let slight = trace.distance(&way.poses[1]);
    assert!((0.05..=0.5).contains(&slight), "{slight}");
    for pose in &way.poses[2..5] {
        let error = trace.distance(pose);
        assert!((0.49..=0.5 + 1e-3).contains(&error), "{error}");
    }
    assert!(trace.distance(&way.poses[5]) < 1e-3);
}

/// The corner that was measured on a real robot of this class (legs of 57.7 mm, 10 mm/s): there it cost either 11.77 s at 0.1 mm of
/// error, or an error of 7.65 mm at up to 12.9 mm/s. A turn by 60 degrees and, sharper, one by 120, which leaves an angle of 60.
#[test]
fn the_corner_of_a_real_robot_costs_neither_time_nor_error() {
    for degrees in [60.0_f64, 120.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let way = Way::new(&[([57.7, 0.0], 0.0), ([57.7 * (1.0 + cos), 57.7 * sin], 0.0)]);
        let trace = way.run(&way.plan(&way.lines(10.0, Zone::Unspecified)));
        let speeds = trace.speeds();
        let moving = |speed: &f64| *speed > 1e-6;
        let (first, last) =
            (speeds.iter().position(moving).unwrap(), speeds.iter().rposition(moving).unwrap());
        let time = (last + 1 - first) as f64 * way.cell.cycle.period;
        let error = trace.distance(&way.poses[1]);
        let greatest = speeds.iter().copied().fold(0.0, f64::max);
        println!("{degrees} degrees: {error:.4} mm, {time:.3} s, at most {greatest:.4} mm/s");
        assert!(error <= 0.5 && time <= 11.6 && greatest <= 10.05, "{error} mm, {time} s, {greatest} mm/s");
    }
}

/// Position levels, a corner radius and exact stops in one chain, at several speeds.
#[test]
fn each_zone_has_its_own_error() {
    let way = Way::new(&[
        ([60.0, 0.0], 0.0),
        ([60.0, 60.0], 0.0),
        ([0.0, 60.0], 0.0),
        ([0.0, 120.0], 0.0),
        ([60.0, 120.0], 0.0),
    ]);
    let zones = [Zone::Level(1), Zone::Level(4), Zone::CornerRadius { mm: 5.0 }, Zone::Exact, Zone::Exact];
    let speeds = [100.0, 20.0, 300.0, 50.0, 50.0];
    let steps: Vec<Step> = (0..5).map(|k| way.step(k + 1, MovePath::Linear, speeds[k], zones[k])).collect();
    let trace = way.run(&way.plan(&steps));
    for (k, permitted) in [0.5, 3.0, 5.0 * (2_f64.sqrt() - 1.0), 0.0, 0.0].into_iter().enumerate() {
        let error = trace.distance(&way.poses[k + 1]);
        let reached = error <= permitted * 1.001 + 1e-3 && error >= permitted * 0.98 - 1e-3;
        assert!(reached, "point {}: {error} mm of {permitted}", k + 1);
    }
    let stops = trace.speeds().windows(2).filter(|pair| pair[0] > 0.1 && pair[1] <= 0.1).count();
    assert_eq!(stops, 2, "at the two exact points only");
}

/// Lines that continue each other are one line: the speed is kept over the points between, on the line.
#[test]
fn collinear_moves_are_one_line() {
    let way = Way::new(&[([10.0, 0.0], 0.0), ([30.0, 0.0], 0.0), ([33.0, 0.0], 0.0), ([80.0, 0.0], 0.0)]);
    let parts = way.plan(&way.lines(20.0, Zone::Unspecified));
    let trace = way.run(&parts);
    let speeds = trace.travelling(20.0);
    assert!(speeds.iter().all(|speed| (speed - 20.0).abs() < 0.02), "{speeds:?}");
    let (from, to) = (way.poses[0].translation.vector, way.poses[4].translation.vector);
    let direction = (to - from).normalize();
    for tool in &trace.tools {
        let offset = tool.translation.vector - from;
        let off = (offset - direction * offset.dot(&direction)).norm();
        // As far as the points are, by their pulses.
        assert!(off < 1e-5, "{off}");
    }
    let times: f64 = parts.iter().map(|part| part.duration).sum();
    assert!((times - (80.0 / 20.0 + 0.03)).abs() < 0.005, "{times}");
    let numbers: Vec<u32> = trace.segments.chunk_by(|a, b| a == b).map(|chunk| chunk[0]).collect();
    assert!(numbers.is_sorted(), "{numbers:?}");
}

/// A long chain is handed out bit by bit, and comes to the same as what is known at once.
#[test]
fn a_run_is_handed_out_as_it_becomes_known() {
    let points: Vec<([f64; 2], f64)> =
        (1..=30).map(|k| ([f64::from(k) * 4.0, if k % 2 == 0 { 0.0 } else { 6.0 }], 0.0)).collect();
    let way = Way::new(&points);
    let mut planner = Planner::new(&way.arm, &way.cell, HOME).unwrap();
    let (mut parts, mut handed_out) = (Vec::new(), Vec::new());
    for step in way.lines(20.0, Zone::Unspecified) {
        planner.take(&step, &mut parts).unwrap();
        handed_out.push(parts.len());
    }
    assert!(handed_out[12] > 0 && handed_out[29] > handed_out[12], "{handed_out:?}");
    planner.finish(&mut parts).unwrap();
    let trace = way.run(&parts);
    let speeds = trace.travelling(20.0);
    assert!(speeds.iter().all(|speed| (19.8..20.02).contains(speed)), "{speeds:?}");
    for pose in &way.poses[1..30] {
        assert!(trace.distance(pose) <= 0.5 + 1e-3);
    }
}

/// A spline passes its points exactly and without a stop.
#[test]
fn a_spline_passes_its_points() {
    let way = Way::new(&[
        ([10.0, 0.0], 0.0),
        ([25.0, 12.0], 5.0),
        ([45.0, 10.0], 0.0),
        ([60.0, -5.0], -5.0),
        ([80.0, 0.0], 0.0),
    ]);
    let mut steps = way.lines(15.0, Zone::Unspecified);
    let target = |step: &Step| match &step.action {
        Action::Move(r#move) => r#move.target.clone(),
        _ => unreachable!(),
    };
    let points: std::sync::Arc<[_]> = steps.iter().map(target).collect();
    for (end, step) in steps.iter_mut().enumerate().skip(1) {
        if let Action::Move(r#move) = &mut step.action {
            r#move.path = MovePath::Spline(SplinePiece { points: points.clone(), end });
        }
    }
    let trace = way.run(&way.plan(&steps));
    // The line before leads into it with a corner; from there on it is exact.
    for pose in &way.poses[2..] {
        let error = trace.distance(pose);
        assert!(error < 1e-3, "{error}");
    }
    let speeds = trace.travelling(15.0);
    assert!(speeds.iter().all(|speed| (14.85..15.02).contains(speed)), "{speeds:?}");
}

/// A random run: points 3 to 120 mm apart at any angle, 5 to 500 mm/s, every kind of zone, the tool turning by up to 10 degrees.
pub(crate) struct RandomRun {
    way: Way,
    zones: Vec<Zone>,
    steps: Vec<Step>,
}

impl RandomRun {
    pub(crate) fn new(random: &mut Random, cell: &Cell) -> Self {
        let (mut at, mut points) = ([0.0, 0.0], Vec::new());
        for _ in 0..6 {
            let (length, angle) = (3.0 * 40_f64.powf(random.unit()), random.within(-3.1, 3.1));
            at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
            // Back towards the middle, where the arm has room.
            at = at.map(|x: f64| if x.abs() > 120.0 { x * 0.5 } else { x });
            points.push((at, random.within(-10.0, 10.0)));
        }
        let way = Way::in_cell(cell.clone(), &points);
        let zone = |_| match random.within(0.0, 4.0) as u8 {
            0 => Zone::Exact,
            1 => Zone::Level(random.within(1.0, 8.99) as u8),
            2 => Zone::CornerRadius { mm: random.within(1.0, 10.0) },
            _ => Zone::Unspecified,
        };
        let zones: Vec<Zone> = (0..6).map(zone).collect();
        let speeds: Vec<f64> = (0..6).map(|_| 5.0 * 100_f64.powf(random.unit())).collect();
        let step = |k: usize| way.step(k + 1, MovePath::Linear, speeds[k], zones[k]);
        let steps = (0..6).map(step).collect();
        Self { way, zones, steps }
    }

    /// Executes it: the joints' limits hold, no corner is missed by more than is permitted, and no move is faster than programmed.
    pub(crate) fn judge(&self, case: usize) {
        let Self { way, zones, steps } = self;
        let parts = way.plan(steps);
        let trace = way.run(&parts);
        for (k, zone) in zones.iter().enumerate() {
            let permitted = match zone {
                Zone::Exact => 0.0,
                Zone::Level(level) => way.cell.job.position_levels[usize::from(*level)] * 1000.0,
                Zone::CornerRadius { mm } => mm * (2_f64.sqrt() - 1.0),
                Zone::Tolerance { mm } => *mm,
                Zone::Unspecified => way.cell.job.corner_error * 1000.0,
            };
            let error = trace.distance(&way.poses[k + 1]);
            assert!(error <= permitted * 1.001 + 2e-3, "case {case}, point {k}: {error} of {permitted} mm");
        }
        let programmed: HashMap<u32, f64> = parts
            .iter()
            .filter_map(|part| part.segment)
            .filter_map(|s| Some((s.segment, s.speed?)))
            .collect();
        let prefiltered = !way.cell.vibration.kernels().is_empty();
        for (k, speed) in trace.speeds().iter().enumerate() {
            let pair = [trace.segments[k], trace.segments[k + 1]];
            // Behind a prefilter on the joints the speed changes before and after the place where it is programmed to.
            let blurred = prefiltered && way.cell.vibration.acts_on() == ActsOn::Joints;
            let here = programmed.iter().filter(|(segment, _)| pair.contains(segment) || blurred);
            let most = here.fold(0.0, |a: f64, (_, b)| a.max(*b));
            assert!(*speed <= most * 1001.0 + 1e-3, "case {case}, cycle {k}: {speed} mm/s of {most} m/s");
        }
    }
}

/// Random runs, judged one by one.
pub(crate) fn random_runs(seed: u64, cases: usize, cell: &Cell) {
    let mut random = Random(seed);
    let prefiltered = !cell.vibration.kernels().is_empty();
    let mut out_of_reach = 0;
    for case in 0..cases {
        let run = RandomRun::new(&mut random, cell);
        if prefiltered && planned(&Cell::default_cell().unwrap(), &run.way.arm, &run.steps).is_err() {
            // The arm cannot go there, with or without prefilter.
            out_of_reach += 1;
            continue;
        }
        run.judge(case);
    }
    assert!(out_of_reach * 20 <= cases, "{out_of_reach} of {cases} are no runs");
}

#[test]
fn random_runs_keep_limits_errors_and_speeds() {
    random_runs(7, 25, &Cell::default_cell().unwrap());
}

/// As above, many: `cargo test --release -p seamline-cell --test machine many_random -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn many_random_runs() {
    random_runs(8, 2_000, &Cell::default_cell().unwrap());
}
