//! Seamline's kinematics against its peers: the same IRB 2400, the same 20,000 random reachable poses, the same run.
//!
//! `cargo run --release` prints, for each kind of call, the thread's CPU time a call (least of nine passes, peers and
//! ours by turns), heap allocations a call, and the ratio; before that it checks that all agree.

mod allocations;
mod peers;

use std::hint::black_box;

use cpu_time::ThreadTime;
use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::{JointJet, Kinematics, SerialChain, SolverSettings, SphericalWristArm, models};

use peers::{General, Opw};

const CASES: usize = 20_000;
const PASSES: usize = 9;

/// The cases that everyone gets.
struct Cases {
    q: Vec<[f64; 6]>,
    poses: Vec<Pose>,
    near: Vec<[f64; 6]>,
    random: Vec<[f64; 6]>,
}

impl Cases {
    fn new(arm: &impl Kinematics<6>) -> Self {
        let mut random = Random(2400);
        let limits = arm.position_limits();
        let mut joints = || limits.map(|(min, max)| min + (max - min) * random.unit());
        let q: Vec<_> = (0..CASES).map(|_| joints()).collect();
        let seeds: Vec<_> = (0..CASES).map(|_| joints()).collect();
        let poses = q.iter().map(|q| arm.forward(q)).collect();
        let near = q.iter().map(|q| q.map(|angle| angle + 0.05 * (2.0 * random.unit() - 1.0))).collect();
        Self { q, poses, near, random: seeds }
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A named call, given the index of a case.
type Call<'a> = (&'a str, &'a dyn Fn(usize));

/// Prints time and allocations a call: ours first, and how many of ours the others take.
fn compare(what: &str, calls: &[Call]) {
    let mut least = vec![f64::INFINITY; calls.len()];
    let mut allocated = vec![0; calls.len()];
    for _ in 0..PASSES {
        for (index, (_, call)) in calls.iter().enumerate() {
            let (start, before) = (ThreadTime::now(), allocations::count());
            (0..CASES).for_each(call);
            least[index] = least[index].min(start.elapsed().as_secs_f64() * 1e9 / CASES as f64);
            allocated[index] = (allocations::count() - before) / CASES;
        }
    }
    for (index, (name, _)) in calls.iter().enumerate() {
        let (time, ratio) = (least[index], least[index] / least[0]);
        println!("{what:<24} {name:<20} {time:>9.0} ns {:>5} allocations {ratio:>7.2} x", allocated[index]);
    }
}

fn agreement(arm: &SphericalWristArm, opw: &Opw, general: &General, cases: &Cases) {
    let (mut position, mut jacobian, mut residual) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut ours, mut theirs, mut missed) = (0, 0, 0);
    for (q, pose) in cases.q.iter().zip(&cases.poses) {
        let [x, y, z] = opw.forward(q);
        position = position.max((Vector3::new(x, y, z) - pose.translation.vector).norm());
        for (a, b) in arm.axes(q).jacobian().iter().zip(general.jacobian(q).iter()) {
            jacobian = jacobian.max((a - b).abs());
        }
        let solutions = arm.inverse(pose, q).unwrap();
        for solution in solutions.as_slice() {
            let reached = arm.forward(&solution.q).translation.vector;
            residual = residual.max((reached - pose.translation.vector).norm());
        }
        let peer = opw.inverse(pose);
        ours += solutions.as_slice().len();
        theirs += peer.len();
        missed += peer.iter().filter(|q| !solutions.as_slice().iter().any(|s| same(&s.q, q))).count();
    }
    println!("forward, rs-opw against ours: {position:.1e} m");
    println!("Jacobian, k against ours: {jacobian:.1e}");
    println!(
        "branches: ours {ours} (worst residual {residual:.1e} m), rs-opw {theirs}; {missed} of theirs not ours"
    );
}

/// Equal modulo full turns.
fn same(a: &[f64; 6], b: &[f64; 6]) -> bool {
    a.iter().zip(b).all(|(a, b)| {
        ((a - b) / std::f64::consts::TAU - ((a - b) / std::f64::consts::TAU).round()).abs() < 1e-5
    })
}

fn numeric(name: &str, chain: &SerialChain<6>) {
    let cases = Cases::new(chain);
    let tight =
        SolverSettings { position_tolerance: 1e-9, rotation_tolerance: 1e-9, ..SolverSettings::default() };
    let runs = [
        ("near seed, 1e-9", &cases.near, &tight),
        ("random seed, 1e-6", &cases.random, &SolverSettings::default()),
    ];
    for (kind, seeds, settings) in runs {
        let solve = |i: usize| chain.solve(&cases.poses[i], &seeds[i], settings);
        let mut times: Vec<f64> = (0..CASES)
            .map(|i| {
                let start = ThreadTime::now();
                let _ = black_box(solve(black_box(i)));
                start.elapsed().as_secs_f64() * 1e6
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let found: Vec<_> = (0..CASES).filter_map(|i| solve(i).ok()).collect();
        let (mean, p99) = (times.iter().sum::<f64>() / CASES as f64, times[CASES * 99 / 100]);
        let rate = 100.0 * found.len() as f64 / CASES as f64;
        let iterations = found.iter().map(|f| f.iterations).sum::<usize>() as f64 / found.len() as f64;
        let most = found.iter().map(|f| f.iterations).max().unwrap_or(0);
        println!(
            "{name:<8} {kind:<18} mean {mean:6.1} us, p99 {p99:6.1} us, found {rate:.2} %, \
             iterations mean {iterations:.1}, most {most}"
        );
    }
}

fn main() {
    let arm = models::irb2400();
    let chain = SerialChain::from_axes(&arm.axes(&[0.0; 6]), *arm.limits()).unwrap();
    let (opw, general) = (Opw::irb2400(arm.position_limits()), General::irb2400());
    let cases = Cases::new(&arm);
    agreement(&arm, &opw, &general, &cases);

    let Cases { q, poses, near, random } = &cases;
    fn sink<T>(value: T) {
        black_box(value);
    }
    compare(
        "forward",
        &[
            ("seamline", &|i| sink(arm.forward(black_box(&q[i])))),
            ("seamline, chain", &|i| sink(chain.forward(black_box(&q[i])))),
            ("rs-opw-kinematics", &|i| sink(opw.forward(black_box(&q[i])))),
            ("k", &|i| sink(general.forward(black_box(&q[i])))),
        ],
    );
    compare(
        "Jacobian",
        &[
            ("seamline", &|i| sink(arm.axes(black_box(&q[i])).jacobian())),
            ("seamline, chain", &|i| sink(chain.axes(black_box(&q[i])).jacobian())),
            ("k", &|i| sink(general.jacobian(black_box(&q[i])))),
            ("rs-opw-kinematics", &|i| sink(opw.jacobian(black_box(&q[i])))),
        ],
    );
    compare(
        "all branches",
        &[
            ("seamline", &|i| sink(arm.inverse(black_box(&poses[i]), &q[i]))),
            ("rs-opw-kinematics", &|i| sink(opw.inverse(black_box(&poses[i])))),
        ],
    );
    compare(
        "nearest, with limits",
        &[
            ("seamline", &|i| sink(arm.inverse_nearest(black_box(&poses[i]), &random[i]))),
            ("rs-opw-kinematics", &|i| sink(opw.inverse_nearest(black_box(&poses[i]), &random[i]))),
        ],
    );
    let tight =
        SolverSettings { position_tolerance: 1e-9, rotation_tolerance: 1e-9, ..SolverSettings::default() };
    compare(
        "numeric, near seed",
        &[
            ("seamline, to 1e-9", &|i| sink(chain.solve(black_box(&poses[i]), &near[i], &tight))),
            ("k, to 1e-4", &|i| sink(general.solve(black_box(&poses[i]), &near[i]))),
        ],
    );
    let found = |seeds: &[[f64; 6]]| (0..CASES).filter(|&i| general.solve(&poses[i], &seeds[i])).count();
    let rate = |count: usize| 100.0 * count as f64 / CASES as f64;
    println!("k finds {:.2} % from near, {:.2} % from random seeds", rate(found(near)), rate(found(random)));
    let motion = JointJet { velocity: [1.0; 6], ..JointJet::at_rest([0.0; 6]) };
    let motions: Vec<_> = q.iter().map(|q| arm.axes(q).forward_jet(&motion)).collect();
    compare(
        "joint derivatives",
        &[
            ("seamline", &|i| sink(arm.joint_jet(black_box(&motions[i]), &q[i]))),
            ("seamline, chain", &|i| sink(chain.joint_jet(black_box(&motions[i]), &q[i]))),
        ],
    );
    println!();
    numeric("irb2400", &chain);
    numeric("ur5e", &models::ur5e());
}
