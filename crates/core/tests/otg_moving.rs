//! Planned anew on every cycle: towards a target that moves, and towards a state that is passed at speed.
#![allow(clippy::unwrap_used, clippy::panic)] // what its tests share is test code too

mod otg_support;

use otg_support::cases::{self, Distribution, random_input};
use otg_support::judge::{is_smooth, is_within_limits};
use otg_support::random::Random;
use seamline::otg::{Input, State, Synchronization, Trajectory, calculate};

const DISTRIBUTIONS: [Distribution; 3] =
    [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres];

/// A target whose position is home + speed · way(time).
struct Target<const N: usize> {
    home: [f64; N],
    speed: [f64; N],
    /// Of its wave, in radians per second; none at constant speed.
    wave: Option<f64>,
}

impl<const N: usize> Target<N> {
    fn at(&self, time: f64) -> State<N> {
        let (way, share) = match self.wave {
            Some(w) => ((w * time).sin() / w, (w * time).cos()),
            None => (time, 1.0),
        };
        State {
            position: std::array::from_fn(|i| self.home[i] + self.speed[i] * way),
            velocity: self.speed.map(|v| v * share),
            acceleration: [0.0; N],
        }
    }
}

fn slowest<const N: usize>(max: &[f64; N], min: &[f64; N], way: &[f64; N]) -> f64 {
    (0..N).map(|i| max[i].min(-min[i]) / way[i].abs()).fold(f64::INFINITY, f64::min)
}

/// From rest to a target at up to 0.4 of the speed allowed, along the line to it if the axes keep to one.
fn chase<const N: usize>(
    random: &mut Random,
    distribution: Distribution,
    synchronization: Synchronization,
    wave: bool,
) -> (Input<N>, Target<N>) {
    let mut input: Input<N> = random_input(random, distribution);
    input.current = State::at_rest(input.current.position);
    input.synchronization = [synchronization; N];
    input.target_moves = [true; N];
    let (l, home) = (&input.limits, input.target.position);
    let mut speed: [f64; N] =
        std::array::from_fn(|i| random.uniform(-0.4, 0.4) * l.velocity_max[i].min(-l.velocity_min[i]));
    if synchronization == Synchronization::PhaseStrict {
        let line: [f64; N] = std::array::from_fn(|i| home[i] - input.current.position[i]);
        let share = random.uniform(-0.4, 0.4) * slowest(&l.velocity_max, &l.velocity_min, &line);
        speed = line.map(|d| share * d);
    }
    // A wave that takes 0.1 of the acceleration and the jerk allowed.
    let acceleration = 0.1 * slowest(&l.acceleration_max, &l.acceleration_min, &speed);
    let jerk = 0.1 * slowest(&l.jerk_max, &l.jerk_max.map(|j| -j), &speed);
    let mut target = Target { home, speed, wave: None };
    input.target = target.at(0.0);
    if wave {
        // No faster than once on the way there.
        let once = std::f64::consts::TAU / calculate(&input).unwrap().duration();
        target.wave = Some(acceleration.min(jerk.sqrt()).min(once));
    }
    (input, target)
}

/// One cycle on, from a plan made anew: continuous, and within the limits.
fn step<const N: usize>(input: &mut Input<N>, cycle: f64) -> Trajectory<N> {
    let plan = calculate(input).unwrap_or_else(|error| panic!("{error}\n{input:?}"));
    let after = plan.at_time(cycle).state();
    assert!(is_smooth(input, &input.current, &after, cycle), "{after:?}\n{input:?}");
    assert!(is_within_limits(input, &after), "{after:?}\n{input:?}");
    input.current = after;
    plan
}

/// How far the axes are behind the target, as a fraction of the coordinates and of the way that the target makes in a second.
fn behind<const N: usize>(now: &State<N>, target: &State<N>, seconds: f64) -> f64 {
    (0..N)
        .map(|i| {
            let (p, size) = (target.position[i], target.position[i].abs() + now.position[i].abs());
            (now.position[i] - p).abs() / (size + target.velocity[i].abs() * seconds)
        })
        .fold(0.0, f64::max)
}

fn meets<const N: usize>(distribution: Distribution, synchronization: Synchronization, cases: usize) {
    let mut random = Random(41);
    for case in 0..cases {
        let (mut input, target) = chase::<N>(&mut random, distribution, synchronization, false);
        let duration = calculate(&input).unwrap().duration();
        let cycle = duration / 300.5;
        for count in 0..350 {
            let time = f64::from(count) * cycle;
            input.target = target.at(time);
            let plan = step(&mut input, cycle);
            let arrival = time + plan.duration();
            // The first plan is kept to, and then the target: nobody comes round again.
            let limit = duration.max(time) + 2.0 * cycle;
            assert!(
                arrival <= limit,
                "{distribution:?} {case}: {arrival} of {duration} at {time}\n{input:?}"
            );
            if synchronization == Synchronization::PhaseStrict {
                assert_eq!(plan.synchronized(), &[Synchronization::Phase; N]);
            }
            if count > 302 {
                let off = behind(&input.current, &target.at(time + cycle), duration);
                assert!(off <= 1e-9, "{distribution:?} {case}: {off:e} at {time} of {duration}\n{input:?}");
            }
        }
    }
}

/// 3 × (60 + 20 + 20) targets at constant velocity, sent anew on each of 350 cycles, to one axis, to six in time and to six on a line: met when
/// the first plan says, two cycles more at most, and followed from there; continuous and within the limits throughout.
#[test]
fn a_target_at_constant_velocity_is_met_when_the_first_plan_says() {
    for distribution in DISTRIBUTIONS {
        meets::<1>(distribution, Synchronization::Time, 60);
        meets::<6>(distribution, Synchronization::Time, 20);
        meets::<6>(distribution, Synchronization::PhaseStrict, 20);
    }
}

fn follows<const N: usize>(distribution: Distribution, synchronization: Synchronization, cases: usize) {
    let mut random = Random(42);
    for case in 0..cases {
        let (mut input, target) = chase::<N>(&mut random, distribution, synchronization, true);
        let wave = target.wave.unwrap_or(1.0);
        // 500 cycles a wave; four waves, of which the first two are for the way there.
        let cycle = std::f64::consts::TAU / wave / 500.0;
        let mut worst = 0.0_f64;
        for count in 0..2000 {
            let time = f64::from(count) * cycle;
            input.target = target.at(time);
            step(&mut input, cycle);
            if count >= 1000 {
                let now = target.at(time + cycle);
                for axis in 0..N {
                    let off = (input.current.position[axis] - now.position[axis]).abs();
                    worst = worst.max(off / (target.speed[axis].abs() * cycle));
                }
            }
        }
        assert!(worst <= 1.0, "{distribution:?} {case}: {worst} cycles behind\n{input:?}");
    }
}

/// 3 × (30 + 10 + 10) targets that swing, sent anew on each of 2,000 cycles: in the second half they are never farther away than the way of one
/// cycle at their highest speed (docs/otg.md, section 13).
#[test]
fn a_target_that_swings_is_followed() {
    for distribution in DISTRIBUTIONS {
        follows::<1>(distribution, Synchronization::Time, 30);
        follows::<6>(distribution, Synchronization::Time, 10);
        follows::<6>(distribution, Synchronization::PhaseStrict, 10);
    }
}

/// How many of the motions to a state that is passed at speed, and with an acceleration, come round again if planned anew on each of their 400 cycles.
fn late<const N: usize>(distribution: Distribution, cases: usize) -> usize {
    let mut random = Random(43);
    let mut late = 0;
    for case in 0..cases {
        let mut input: Input<N> = random_input(&mut random, distribution);
        let duration = calculate(&input).unwrap().duration();
        let cycle = duration / 400.5;
        for count in 0..400 {
            let rest = calculate(&input)
                .unwrap_or_else(|error| panic!("{distribution:?} {case} {count}: {error}\n{input:?}"));
            if f64::from(count) * cycle + rest.duration() > duration * (1.0 + 1e-4) {
                late += 1;
                break;
            }
            input.current = rest.at_time(cycle).state();
        }
    }
    late
}

/// 9 × 200 motions of one axis to a state that is passed at speed: all on time. Of 8 × 50 of six axes two at most are not (of 27,000 it was 31, and of
/// the tiny moves, which are left out here, one in a hundred).
#[test]
fn a_state_passed_at_speed_is_reached_on_time() {
    let mut missed = 0;
    for distribution in cases::ALL {
        assert_eq!(late::<1>(distribution, 200), 0, "{distribution:?}");
        if distribution != Distribution::Tiny {
            missed += late::<6>(distribution, 50);
        }
    }
    assert!(missed <= 2, "{missed}");
}
