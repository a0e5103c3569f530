use std::vec::Vec;

use super::super::lookahead::{AlongPath, JointMotion};
use super::*;

const PERIOD: f64 = 1e-3;
const ACCELERATION: [f64; 3] = [15.0, 20.0, 40.0];
const JERK: [f64; 3] = [750.0, 1_000.0, 2_000.0];

/// Rest-to-rest S-curve at full jerk and acceleration, as switch times: jerk +J 0 −J, cruise, −J 0 +J.
#[derive(Clone, Copy)]
struct SCurve {
    begin: f64,
    jerk: f64,
    rise: f64,
    hold: f64,
    cruise: f64,
}

impl SCurve {
    fn duration(&self) -> f64 {
        4.0 * self.rise + 2.0 * self.hold + self.cruise
    }

    /// Position and its three derivatives.
    fn at(&self, time: f64) -> [f64; 4] {
        let jerks = [self.jerk, 0.0, -self.jerk, 0.0, -self.jerk, 0.0, self.jerk];
        let times = [self.rise, self.hold, self.rise, self.cruise, self.rise, self.hold, self.rise];
        let (mut p, mut v, mut a, mut left) = (0.0, 0.0, 0.0, time - self.begin);
        for (j, whole) in jerks.into_iter().zip(times) {
            let t = left.clamp(0.0, whole);
            (p, v, a) = (p + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j);
            if left < whole {
                return [p, v, a, if left > 0.0 { j } else { 0.0 }];
            }
            left -= whole;
        }
        [p, 0.0, 0.0, 0.0]
    }
}

/// Three axes, each a sequence of S-curves that use its limits fully, out of step with one another.
struct Plan(Vec<Vec<SCurve>>);

impl Plan {
    /// Axes in step, as in a synchronized move, or each on its own.
    fn random(in_step: bool, seed: &mut u64) -> Self {
        let start = *seed;
        let axes = (0..3).map(|axis| {
            if in_step {
                *seed = start;
            }
            Self::axis(axis, seed)
        });
        Self(axes.collect())
    }

    fn axis(axis: usize, seed: &mut u64) -> Vec<SCurve> {
        let mut begin = 0.3 * uniform(seed);
        let mut curves = Vec::new();
        while begin < 3.0 {
            let rise = ACCELERATION[axis] / JERK[axis];
            let sign = if uniform(seed) < 0.5 { -1.0 } else { 1.0 };
            let (hold, cruise) = (0.15 * uniform(seed), 0.3 * uniform(seed));
            let curve = SCurve { begin, jerk: sign * JERK[axis], rise, hold, cruise };
            begin += curve.duration() + 0.1 * uniform(seed);
            curves.push(curve);
        }
        curves
    }

    fn at(&self, time: f64) -> [[f64; 4]; 3] {
        std::array::from_fn(|axis| {
            let curves = &self.0[axis];
            let mut sum = [0.0; 4];
            for curve in curves {
                let value = curve.at(time);
                (0..4).for_each(|k| sum[k] += value[k]);
            }
            sum
        })
    }

    fn motion(&self, time: f64) -> JointMotion<3> {
        let all = self.at(time);
        let pick = |k: usize| std::array::from_fn(|axis| all[axis][k]);
        JointMotion { velocity: pick(1), acceleration: pick(2), jerk: pick(3), path: AlongPath::NONE }
    }

    /// Time of the fastest stop under the acceleration limits alone, by small steps.
    fn second_order_stop(&self, mut now: f64) -> f64 {
        let (mut rate, mut time, step) = (1.0_f64, 0.0, 1e-5);
        while rate > 0.0 && time < 5.0 {
            let motion = self.motion(now);
            let mut slope = -1e3_f64;
            for (axis, limit) in ACCELERATION.into_iter().enumerate() {
                let (v, a) = (motion.velocity[axis], motion.acceleration[axis] * rate * rate);
                if v != 0.0 {
                    slope = slope.max((-limit - a * v.signum()) / v.abs());
                }
            }
            now += rate * step;
            rate += slope * step;
            time += step;
        }
        time
    }
}

fn uniform(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

struct Simulation<'a> {
    plan: &'a Plan,
    ahead: Lookahead<3>,
    rate: Rate,
    now: f64,
    commands: Vec<[f64; 3]>,
}

impl<'a> Simulation<'a> {
    fn new(plan: &'a Plan) -> Self {
        Self {
            plan,
            ahead: Lookahead::new(PERIOD),
            rate: Rate::constant(1.0),
            now: 0.0,
            commands: Vec::new(),
        }
    }

    fn cycle(&mut self, goal: f64) {
        self.ahead.forget_before(self.now);
        while let Some(time) = self.ahead.wanted() {
            self.ahead.push(self.plan.motion(time));
        }
        let limits = RateLimits { velocity: [f64::INFINITY; 3], acceleration: ACCELERATION, jerk: JERK };
        self.now += self.rate.advance(goal, self.now, &self.ahead, &limits, PERIOD);
        assert!((-1e-8..=1.0 + 1e-8).contains(&self.rate.value), "rate {}", self.rate.value);
        self.commands.push(self.plan.at(self.now).map(|axis| axis[0]));
    }

    /// Largest second and third difference of the commands, as shares of the limits.
    fn worst(&self) -> (f64, f64) {
        let mut worst = (0.0_f64, 0.0_f64);
        for q in self.commands.windows(4) {
            for axis in 0..3 {
                let d = |k: usize| (q[k + 1][axis] - q[k][axis]) / PERIOD;
                let a = (d(1) - d(0)) / PERIOD;
                let j = (d(2) - 2.0 * d(1) + d(0)) / PERIOD.powi(2);
                worst.0 = worst.0.max(a.abs() / ACCELERATION[axis]);
                worst.1 = worst.1.max(j.abs() / JERK[axis]);
            }
        }
        worst
    }
}

/// 300 plans: override changed at random instants, then a pause, then on: limits in every 1 ms difference.
#[test]
fn override_and_pause_keep_the_joint_limits() {
    let mut seed = 7;
    for case in 0..300 {
        let plan = Plan::random(case % 2 == 0, &mut seed);
        let mut simulation = Simulation::new(&plan);
        let mut goal = 1.0;
        for _ in 0..2_500 {
            if uniform(&mut seed) < 0.01 {
                goal = [0.0, 0.1, 0.3, 0.7, 1.0][(uniform(&mut seed) * 5.0) as usize];
            }
            simulation.cycle(goal);
        }
        let (acceleration, jerk) = simulation.worst();
        assert!(acceleration < 1.000_001, "case {case}: acceleration {acceleration}");
        assert!(jerk < 1.005, "case {case}: jerk {jerk}");
    }
}

/// Stops at 300 random instants: each is complete. Returns the sorted times beyond the second-order minimum.
fn stops(in_step: bool) -> Vec<f64> {
    let mut seed = 11;
    let mut excess = Vec::new();
    for _ in 0..300 {
        let plan = Plan::random(in_step, &mut seed);
        let mut simulation = Simulation::new(&plan);
        let before = (1_500.0 * uniform(&mut seed)) as usize;
        (0..before).for_each(|_| simulation.cycle(1.0));
        let least = plan.second_order_stop(simulation.now);
        let mut cycles = 0;
        while !simulation.rate.is_stopped() {
            simulation.cycle(0.0);
            cycles += 1;
            assert!(cycles < 2_000, "it must stop");
        }
        excess.push(f64::from(cycles) * PERIOD - least);
        (0..50).for_each(|_| simulation.cycle(0.0));
        let q = &simulation.commands;
        assert_eq!(q[q.len() - 1], q[q.len() - 40], "at rest");
    }
    excess.sort_by(f64::total_cmp);
    std::println!("beyond the second-order stop: {:?}", [excess[150], excess[270], excess[299]]);
    excess
}

/// Every axis reaches its acceleration in 20 ms. A stop from constant speed needs that time beyond the second-order
/// one, and a stop from full acceleration 50 ms; a cycle and the share kept back come on top.
#[test]
fn a_pause_stops_soon() {
    let excess = stops(true);
    assert!(excess[150] < 0.022 && excess[299] < 0.06);
    // Out of step the axes hinder one another: jerks that all are used up leave the rate no choice.
    let excess = stops(false);
    assert!(excess[150] < 0.06 && excess[299] < 0.4);
}

#[test]
fn the_rate_returns_exactly_to_full_speed() {
    let mut seed = 3;
    let plan = Plan::random(true, &mut seed);
    let mut simulation = Simulation::new(&plan);
    (0..200).for_each(|_| simulation.cycle(1.0));
    (0..300).for_each(|_| simulation.cycle(0.4));
    assert_eq!(simulation.rate, Rate::constant(0.4));
    (0..500).for_each(|_| simulation.cycle(1.0));
    assert_eq!(simulation.rate, Rate::constant(1.0));
}
