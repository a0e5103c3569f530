//! Joint moves that run on into each other, on a welding arm and on a SCARA, judged by independent models of both.

use nalgebra::Vector3;
use seamline::control::{Command, Event, Mode, Motion};
use seamline::kinematics::ScaraArm;
use seamline::vibration::Prefilter;
use seamline_cell::cell::{Cell, FlexibleMode, Vibration};
use seamline_cell::job::{
    Action, ArcCondition, MovePath, Speed, Step, Zone, joints_from_pulses, pulses_from_joints,
};
use seamline_cell::plan::{Arm, Planned, PlanningArm};
use seamline_cell::record::SegmentKind;

use crate::bench::{
    Ar2010, Bench, Random, commands, independent_forward, independent_torch, move_to, planned, step,
    with_zone, worst_shares,
};

/// Spacing of the instants at which a plan is looked at: that of the cycles.
const PERIOD: f64 = 1e-3;
/// Places on a straight way of the joints at which the tool is looked at.
const PLACES: usize = 500;

/// An arm with what a test asks of it.
struct Subject<const N: usize, K> {
    cell: Cell,
    arm: Arm<N, K>,
    /// The tool's place, by a model of the arm that is not ours.
    tool: fn(&[f64; N]) -> Vector3<f64>,
    /// How far from home the joints go, at size 1.
    span: [f64; N],
}

fn welding_arm() -> Subject<6, seamline::kinematics::SixAxisArm> {
    let cell = Cell::default_cell().unwrap();
    let arm: Ar2010 = Arm::from_cell(&cell).unwrap();
    let tool = |q: &[f64; 6]| (independent_forward(q) * independent_torch()).translation.vector;
    Subject { cell, arm, tool, span: [0.8, 0.4, 0.4, 0.8, 0.5, 1.0] }
}

fn scara() -> Subject<4, ScaraArm> {
    let cell = Cell::built_in("scara").unwrap().unwrap();
    let arm = Arm::from_cell(&cell).unwrap();
    // Links of 325 and 275 mm; the pen stands on joint 4's axis, 80 mm below the flange.
    let tool = |q: &[f64; 4]| {
        let [one, both] = [q[0], q[0] + q[1]];
        Vector3::new(
            0.325 * one.cos() + 0.275 * both.cos(),
            0.325 * one.sin() + 0.275 * both.sin(),
            q[2] - 0.080,
        )
    };
    Subject { cell, arm, tool, span: [0.7, 0.6, 0.018, 2.0] }
}

#[derive(Clone, Copy)]
struct Point<const N: usize> {
    joints: [f64; N],
    percent: f64,
    zone: Zone,
}

/// The instants of a plan.
struct Trace<const N: usize> {
    joints: Vec<[f64; N]>,
    /// Whether the instant lies in a corner.
    corner: Vec<bool>,
    duration: f64,
    corners: usize,
    notices: Vec<String>,
}

impl<const N: usize, K: PlanningArm<N>> Subject<N, K> {
    /// Three to six points around home; the robot stops at the last.
    fn chain(&self, random: &mut Random, zones: &[Zone]) -> Vec<Point<N>> {
        let count = 3 + (random.unit() * 4.0) as usize;
        let size = 10_f64.powf(random.within(-1.3, 0.0));
        let mut chain: Vec<_> = (0..count)
            .map(|_| {
                let away = |k: usize| self.arm.home[k] + size * self.span[k] * random.within(-1.0, 1.0);
                let joints: [f64; N] = std::array::from_fn(away);
                let pulses = pulses_from_joints(&joints, &self.arm.pulses_per_unit);
                Point {
                    joints: joints_from_pulses(&pulses, &self.arm.pulses_per_unit).unwrap(),
                    percent: 100_f64.powf(random.within(0.3, 1.0)),
                    zone: zones[(random.unit() * zones.len() as f64) as usize],
                }
            })
            .collect();
        chain.last_mut().unwrap().zone = Zone::Exact;
        chain
    }

    fn steps(&self, chain: &[Point<N>]) -> Vec<Step> {
        let step = |(k, point): (usize, &Point<N>)| {
            let speed = Speed::JointPercent(point.percent);
            with_zone(move_to(k as u32 + 1, MovePath::Joint, speed, &self.arm, &point.joints), point.zone)
        };
        chain.iter().enumerate().map(step).collect()
    }

    fn plan(&self, steps: &[Step]) -> Vec<Planned<N>> {
        planned(&self.cell, &self.arm, steps).unwrap()
    }

    fn trace(&self, chain: &[Point<N>]) -> Trace<N> {
        trace(&self.plan(&self.steps(chain)), PERIOD)
    }

    /// The same with a stop at every point.
    fn stopping(&self, chain: &[Point<N>]) -> Trace<N> {
        let stops: Vec<_> = chain.iter().map(|point| Point { zone: Zone::Exact, ..*point }).collect();
        self.trace(&stops)
    }

    fn permitted(&self, zone: Zone) -> f64 {
        match zone {
            Zone::Level(level) => self.cell.job.position_levels[usize::from(level)],
            Zone::Unspecified => self.cell.job.corner_error,
            _ => 0.0,
        }
    }

    /// The tool on the straight ways of the joints from point to point.
    fn taught(&self, chain: &[Point<N>]) -> Vec<Vec<Vector3<f64>>> {
        let mut from = self.arm.home;
        let way = |point: &Point<N>| {
            let start = std::mem::replace(&mut from, point.joints);
            let at = |k: usize| {
                let share = k as f64 / PLACES as f64;
                let between = |i: usize| start[i] + share * (point.joints[i] - start[i]);
                (self.tool)(&std::array::from_fn(between))
            };
            (0..=PLACES).map(at).collect()
        };
        chain.iter().map(way).collect()
    }

    /// Holds a plan of a chain against the chain: how near the tool comes to each point, how far it is off the taught ways, and that no
    /// joint turns where it does not turn between the points.
    fn judge(&self, chain: &[Point<N>], trace: &Trace<N>, case: usize) {
        let [velocity, acceleration, jerk] = worst_shares(&trace.joints, &self.arm, PERIOD);
        assert!(
            velocity <= 1.0 + 1e-9 && acceleration <= 1.0 + 1e-6 && jerk <= 1.0 + 1e-4,
            "chain {case}: {velocity} {acceleration} {jerk}"
        );
        assert_eq!(trace.joints[trace.joints.len() - 1], chain[chain.len() - 1].joints, "chain {case}");
        let tools: Vec<_> = trace.joints.iter().map(self.tool).collect();
        for (k, point) in chain.iter().enumerate() {
            let error = distance(&(self.tool)(&point.joints), &tools);
            let permitted = self.permitted(point.zone);
            assert!(error <= permitted + 1e-6, "chain {case}, point {k}: {error} m of {permitted} m");
        }
        let taught = self.taught(chain);
        let most = chain.iter().map(|point| self.permitted(point.zone)).fold(0.0, f64::max);
        for (tool, _) in tools.iter().zip(&trace.corner).filter(|(_, corner)| **corner).step_by(3) {
            let off = taught.iter().map(|way| distance(tool, way)).fold(f64::INFINITY, f64::min);
            assert!(off <= most + 2e-6, "chain {case}: {off} m off the taught ways, permitted {most} m");
        }
        for joint in 0..N {
            let still = 1e-9 * self.arm.limits.velocity[joint] * PERIOD;
            let moved = trace.joints.windows(2).map(|pair| pair[1][joint] - pair[0][joint]);
            let starts = std::iter::once(&self.arm.home).chain(chain.iter().map(|point| &point.joints));
            let ways = starts.zip(chain).map(|(from, to)| to.joints[joint] - from[joint]);
            assert!(turns(moved, still) <= turns(ways, 0.0), "chain {case}: joint {joint} goes to and fro");
        }
    }
}

/// A plan at instants.
fn trace<const N: usize>(parts: &[Planned<N>], spacing: f64) -> Trace<N> {
    let (mut joints, mut corner, mut corners, mut start) = (Vec::new(), Vec::new(), 0, 0.0);
    for part in parts {
        let is_corner =
            part.segment.is_some_and(|segment| matches!(segment.kind, SegmentKind::Corner { .. }));
        corners += usize::from(is_corner);
        for command in &part.commands {
            let Command::Move(block) = command else { panic!("only moves") };
            let Motion::Joint(motion) = &block.motion else { panic!("only joint moves") };
            while joints.len() as f64 * spacing < start + motion.duration() {
                joints.push(motion.at_time(joints.len() as f64 * spacing - start).position);
                corner.push(is_corner);
            }
            start += motion.duration();
            if block.ends_at_rest {
                // As the cycle does: the next move begins with a cycle of its own.
                joints.push(motion.at_time(motion.duration()).position);
                corner.push(false);
                start = joints.len() as f64 * spacing;
            }
        }
    }
    let notices = parts.iter().flat_map(|part| part.notices.clone()).collect();
    let duration = parts.iter().map(|part| part.duration).sum();
    Trace { joints, corner, duration, corners, notices }
}

/// How often the direction changes.
fn turns(steps: impl Iterator<Item = f64>, still: f64) -> usize {
    let mut direction = 0.0;
    let turn = |step: &f64| {
        let turns = direction != 0.0 && direction != step.signum();
        direction = step.signum();
        turns
    };
    steps.filter(|step| step.abs() > still).filter(turn).count()
}

fn distance(point: &Vector3<f64>, places: &[Vector3<f64>]) -> f64 {
    let between = |pair: &[Vector3<f64>]| {
        let way = pair[1] - pair[0];
        let share = if way.norm() > 0.0 { (point - pair[0]).dot(&way) / way.norm_squared() } else { 0.0 };
        (point - pair[0] - way * share.clamp(0.0, 1.0)).norm()
    };
    places.windows(2).map(between).fold(f64::INFINITY, f64::min)
}

const ZONES: [Zone; 5] =
    [Zone::Unspecified, Zone::Unspecified, Zone::Level(1), Zone::Level(4), Zone::Level(8)];

/// Random chains: within the limits of the joints and the errors of the zones, no joint to and fro, sooner than with stops, and hardly a
/// point at which it stops; in no corner does the arm come to rest.
fn random_chains<const N: usize, K: PlanningArm<N>>(subject: &Subject<N, K>, seed: u64) {
    const CHAINS: usize = 200;
    let mut random = Random(seed);
    let (mut passed, mut points, mut least) = (0, 0, f64::INFINITY);
    let mut durations = [0.0; 2];
    for case in 0..CHAINS {
        let chain = subject.chain(&mut random, &ZONES);
        let (trace, stopping) = (subject.trace(&chain), subject.stopping(&chain));
        subject.judge(&chain, &trace, case);
        passed += trace.corners;
        points += chain.len() - 1;
        assert_eq!(trace.corners + trace.notices.len(), chain.len() - 1, "chain {case}: {:?}", trace.notices);
        assert!(trace.corners == 0 || trace.duration < stopping.duration, "chain {case}");
        for (k, pair) in trace.joints.windows(2).enumerate().filter(|(k, _)| trace.corner[*k]) {
            let speed = |i: usize| (pair[1][i] - pair[0][i]).abs() / PERIOD / subject.arm.limits.velocity[i];
            let fastest = (0..N).map(speed).fold(0.0, f64::max);
            assert!(fastest > 1e-4, "chain {case}: at rest in a corner, at {k}");
            least = least.min(fastest);
        }
        durations[0] += trace.duration;
        durations[1] += stopping.duration;
    }
    let [passing, stopping] = durations;
    println!(
        "{}: {passed} of {points} points passed, {passing:.1} s instead of {stopping:.1} s, {:.1} ms a point; least speed {least:.5}",
        subject.arm.name,
        (stopping - passing) / points as f64 * 1e3,
    );
    assert!(passed as f64 >= 0.96 * points as f64, "{passed} of {points} points passed");
}

#[test]
fn a_welding_arm_runs_on_through_random_chains() {
    random_chains(&welding_arm(), 1);
}

#[test]
fn a_scara_runs_on_through_random_chains() {
    random_chains(&scara(), 2);
}

/// 60 random chains behind prefilters, executed: within the limits of the joints, each point within its error and the tool never farther off the
/// taught ways, by the commands that come out.
fn prefiltered_chains<const N: usize, K: PlanningArm<N>>(subject: &mut Subject<N, K>, seed: u64, least: f64) {
    let mut random = Random(seed);
    let (mut passed, mut points, mut durations) = (0, 0, [0.0; 2]);
    for case in 0..60 {
        let name = [Prefilter::Zv, Prefilter::Zvd, Prefilter::FirZvd, Prefilter::Ei][case % 4];
        let mode = FlexibleMode { frequency_hz: random.within(8.0, 30.0), damping: 0.03 };
        subject.cell.vibration = Vibration::try_new(name, 5e-4, vec![mode]).unwrap();
        let chain = subject.chain(&mut random, &ZONES);
        let parts = subject.plan(&subject.steps(&chain));
        let corner = |part: &Planned<N>| {
            part.segment.is_some_and(|info| matches!(info.kind, SegmentKind::Corner { .. }))
        };
        passed += parts.iter().filter(|part| corner(part)).count();
        points += chain.len() - 1;
        let mut bench = Bench::new(&subject.cell, &subject.arm, commands(&parts));
        let (rows, _) = bench.run_to_end(&subject.arm);
        assert_eq!(rows[rows.len() - 1], chain[chain.len() - 1].joints, "chain {case}");
        durations[0] += rows.len() as f64 * PERIOD;
        let stops: Vec<_> = chain.iter().map(|point| Point { zone: Zone::Exact, ..*point }).collect();
        let stopping = commands(&subject.plan(&subject.steps(&stops)));
        let mut bench = Bench::new(&subject.cell, &subject.arm, stopping);
        durations[1] += bench.run_to_end(&subject.arm).0.len() as f64 * PERIOD;
        let tools: Vec<_> = rows.iter().map(subject.tool).collect();
        for (k, point) in chain.iter().enumerate() {
            let (error, permitted) =
                (distance(&(subject.tool)(&point.joints), &tools), subject.permitted(point.zone));
            assert!(error <= permitted + 2e-6, "chain {case}, point {k}: {error} m of {permitted} m");
        }
        let taught = subject.taught(&chain);
        let most = chain.iter().map(|point| subject.permitted(point.zone)).fold(0.0, f64::max);
        for tool in tools.iter().step_by(5) {
            let off = taught.iter().map(|way| distance(tool, way)).fold(f64::INFINITY, f64::min);
            assert!(off <= most + 2e-6, "chain {case}: {off} m off the taught ways, permitted {most} m");
        }
    }
    let [passing, stopping] = durations;
    println!(
        "{}: {passed} of {points} points passed, {passing:.1} s instead of {stopping:.1} s, {:.1} ms a point",
        subject.arm.name,
        (stopping - passing) / points as f64 * 1e3,
    );
    assert!(passed as f64 >= least * points as f64, "{passed} of {points} points passed");
}

#[test]
fn a_welding_arm_runs_on_behind_a_prefilter() {
    prefiltered_chains(&mut welding_arm(), 5, 0.85);
}

#[test]
fn a_scara_runs_on_behind_a_prefilter() {
    prefiltered_chains(&mut scara(), 6, 0.85);
}

/// Pauses and override at random instants, in corners too: on the planned way of the joints, within their limits, to its end.
fn operated<const N: usize, K: PlanningArm<N>>(subject: &Subject<N, K>, seed: u64) {
    let mut random = Random(seed);
    let mut pauses = 0;
    for case in 0..20 {
        let chain = subject.chain(&mut random, &ZONES);
        let parts = subject.plan(&subject.steps(&chain));
        let corner = |segment: u32| {
            let kinds = parts.iter().filter_map(|part| part.segment).filter(|info| info.segment == segment);
            kinds.into_iter().any(|info| matches!(info.kind, SegmentKind::Corner { .. }))
        };
        let mut bench = Bench::new(&subject.cell, &subject.arm, commands(&parts));
        let first = bench.cycle_with(Event::Start).command.position;
        let (mut rows, mut in_corner) =
            (vec![subject.arm.home, subject.arm.home, subject.arm.home, first], false);
        for cycle in 0.. {
            assert!(cycle < 100_000, "chain {case} does not end");
            if random.unit() < 0.01 {
                bench.input.speed_override = random.within(0.1, 1.0);
            }
            match bench.cycle.mode() {
                Mode::Running if random.unit() < if in_corner { 0.05 } else { 0.003 } => {
                    bench.input.event = Some(Event::Hold);
                    pauses += usize::from(in_corner);
                }
                Mode::Holding if random.unit() < 0.01 => bench.input.event = Some(Event::Resume),
                _ => {}
            }
            let output = bench.cycle();
            assert_eq!(output.status.fault, None, "chain {case}");
            rows.push(output.command.position);
            in_corner = corner(output.status.segment);
            if output.status.mode == Mode::Standstill {
                break;
            }
        }
        let [velocity, acceleration, jerk] = worst_shares(&rows, &subject.arm, PERIOD);
        assert!(
            velocity <= 1.0 + 1e-6 && acceleration <= 1.001 && jerk <= 1.01,
            "chain {case}: {velocity} {acceleration} {jerk}"
        );
        assert_eq!(rows[rows.len() - 1], chain[chain.len() - 1].joints, "chain {case}");
        follows(&rows, &trace(&parts, 0.1 * PERIOD).joints, &subject.arm.limits.velocity, case);
    }
    println!("{}: {pauses} pauses in corners", subject.arm.name);
    assert!(pauses > 20, "{pauses} pauses in corners");
}

/// The rows lie on the planned way, in order.
fn follows<const N: usize>(rows: &[[f64; N]], way: &[[f64; N]], velocity: &[f64; N], case: usize) {
    // Joints in seconds at full speed, so that all count alike.
    let off = |row: &[f64; N], k: usize| {
        let (from, to) = (&way[k], &way[(k + 1).min(way.len() - 1)]);
        let scaled = |i: usize, a: &[f64; N], b: &[f64; N]| (b[i] - a[i]) / velocity[i];
        let square = (0..N).map(|i| scaled(i, from, to).powi(2)).sum::<f64>();
        let along = (0..N).map(|i| scaled(i, from, to) * scaled(i, from, row)).sum::<f64>();
        let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
        (0..N).map(|i| (scaled(i, from, row) - share * scaled(i, from, to)).abs()).fold(0.0, f64::max)
    };
    let mut at = 0;
    for (cycle, row) in rows.iter().enumerate() {
        let near = (at..way.len().min(at + 40)).min_by(|a, b| off(row, *a).total_cmp(&off(row, *b)));
        at = near.unwrap_or(at);
        assert!(off(row, at) < 1e-7, "chain {case}, cycle {cycle}: {} s off the planned way", off(row, at));
    }
}

#[test]
fn pause_and_override_keep_to_the_corners_of_a_welding_arm() {
    operated(&welding_arm(), 3);
}

#[test]
fn pause_and_override_keep_to_the_corners_of_a_scara() {
    operated(&scara(), 4);
}

/// Points of the welding arm that are passed well.
fn bend() -> Vec<Point<6>> {
    let arm = welding_arm().arm;
    let shifts =
        [[0.3, 0.1, 0.0, 0.0, 0.1, 0.0], [0.5, 0.3, 0.1, 0.0, 0.1, 0.2], [0.4, 0.4, 0.3, 0.1, 0.0, 0.2]];
    let point = |shift: [f64; 6]| {
        let joints: [f64; 6] = std::array::from_fn(|k| arm.home[k] + shift[k]);
        let pulses = pulses_from_joints(&joints, &arm.pulses_per_unit);
        let joints = joints_from_pulses(&pulses, &arm.pulses_per_unit).unwrap();
        Point { joints, percent: 50.0, zone: Zone::Unspecified }
    };
    shifts.map(point).to_vec()
}

/// PL=0 goes exactly to the point and stops; so does a zone of nothing, and each says what else is why.
#[test]
fn the_robot_stops_where_it_must_and_says_why() {
    let subject = welding_arm();
    let exact: Vec<_> = bend().into_iter().map(|point| Point { zone: Zone::Exact, ..point }).collect();
    let trace = subject.trace(&exact);
    assert_eq!((trace.corners, trace.notices.len()), (0, 0));
    for point in &exact {
        assert!(trace.joints.contains(&point.joints), "exactly on the point");
    }
    let stops = |subject: &Subject<6, _>, steps: &[Step]| -> Vec<String> {
        let parts = subject.plan(steps);
        parts.iter().flat_map(|part| part.notices.clone()).collect()
    };
    let said = |why: &str| format!("the robot stops exactly on this point (no PL): {why}");
    let mut nothing = welding_arm();
    nothing.cell.job.corner_error = 0.0;
    let steps = subject.steps(&bend());
    assert_eq!(stops(&nothing, &steps[..2]), [said("the cell permits no corner error here")]);
    let mut filtered = welding_arm();
    let mode = FlexibleMode { frequency_hz: 1.0, damping: 0.05 };
    filtered.cell.vibration = Vibration::try_new(Prefilter::Zvd, 5e-4, vec![mode]).unwrap();
    let long = "a move is shorter than what is in the prefilter at once";
    assert_eq!(stops(&filtered, &steps[..2]), [said(long)]);
    let speed = Speed::Linear { mm_s: 100.0 };
    let line = move_to(2, MovePath::Linear, speed, &subject.arm, &bend()[1].joints);
    assert_eq!(stops(&subject, &[steps[0].clone(), line]), [said("a move of the tool follows")]);
    let dwell = step(2, Action::Dwell { seconds: 0.1 });
    assert!(stops(&subject, &[steps[0].clone(), dwell, steps[1].clone()]).is_empty(), "the job asks for it");
}

/// Messages and settings of the arc between two joint moves come after the corner, and a point that is taught twice is one.
#[test]
fn what_takes_no_time_does_not_stop_the_robot() {
    let subject = welding_arm();
    let mut steps = subject.steps(&bend());
    let current = ArcCondition { current: Some(180.0), ..ArcCondition::default() };
    steps.insert(1, step(9, Action::Message { text: "here".into() }));
    steps.insert(2, step(10, Action::ArcSet(current)));
    steps.insert(3, steps[0].clone());
    let does = |part: &Planned<6>| match (part.segment, part.commands.first()) {
        (Some(info), _) => info.kind.name(),
        (None, Some(Command::ArcSetting(setting))) if setting.current == 180.0 => "180 A",
        (None, first) => first.map_or("no command", |_| "another command"),
    };
    let done: Vec<_> = subject.plan(&steps).iter().map(does).collect();
    assert_eq!(done, ["MOVJ", "corner", "no command", "180 A", "no command", "MOVJ", "corner", "MOVJ"]);
}
