//! Unlimited jerk and acceleration, zero limits, mixed controls, and targets that move.
#![allow(clippy::unwrap_used, clippy::panic)] // what its tests share is test code too

mod otg_support;

use otg_support::cases::{self, Distribution, random_input};
use otg_support::judge::{is_smooth, is_within_limits, judge};
use otg_support::random::Random;
use seamline::otg::{
    Control, Error, Generator, Input, Limits, Order, Output, State, Status, Synchronization, calculate,
};

/// 9 × 3 × 5,000 problems of three axes with unlimited jerk, or acceleration and jerk, or unlimited velocity.
#[test]
fn unlimited() {
    for distribution in cases::ALL {
        for kind in 0..3 {
            let mut random = Random(21);
            for case in 0..5_000 {
                let mut input: Input<3> = random_input(&mut random, distribution);
                let l = &mut input.limits;
                match kind {
                    0 => l.jerk_max = [f64::INFINITY; 3],
                    1 => {
                        l.jerk_max = [f64::INFINITY; 3];
                        l.acceleration_max = [f64::INFINITY; 3];
                        l.acceleration_min = [f64::NEG_INFINITY; 3];
                    }
                    _ => {
                        l.velocity_max = [f64::INFINITY; 3];
                        l.velocity_min = [f64::NEG_INFINITY; 3];
                        l.acceleration_max[1] = f64::INFINITY;
                        l.acceleration_min[2] = f64::NEG_INFINITY;
                    }
                }
                let trajectory = calculate(&input)
                    .unwrap_or_else(|e| panic!("{distribution:?} {kind} {case}: {e}\n{input:?}"));
                let order = [Order::Second, Order::First, Order::Third][kind];
                assert!(trajectory.profiles().iter().all(|profile| profile.order() == order));
                let verdict = judge(&input, &trajectory, true);
                assert!(verdict.is_good(), "{distribution:?} {kind} {case}: {verdict:?}\n{input:?}");
            }
        }
    }
}

/// 5 × 10,000 problems of second order take the limit of those of third order as the jerk grows.
#[test]
fn second_order_is_the_limit_of_third_order() {
    for distribution in [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres] {
        let mut random = Random(22);
        for _ in 0..10_000 {
            let mut input: Input<1> = random_input(&mut random, distribution);
            input.current.acceleration = [0.0];
            input.target.acceleration = [0.0];
            // A brake over the limit takes its own way.
            let v0 = &mut input.current.velocity[0];
            *v0 = v0.clamp(input.limits.velocity_min[0], input.limits.velocity_max[0]);
            let size = (input.limits.acceleration_max[0] - input.limits.acceleration_min[0])
                / input.limits.velocity_max[0].min(-input.limits.velocity_min[0]);
            input.limits.jerk_max[0] = 1e7 * size * input.limits.acceleration_max[0];
            let third = calculate(&input).unwrap().duration();
            input.limits.jerk_max[0] = f64::INFINITY;
            let second = calculate(&input).unwrap().duration();
            assert!(
                second <= third * (1.0 + 1e-12) && third - second <= 1e-3 * third,
                "{second} {third}\n{input:?}"
            );
        }
    }
}

#[test]
fn zero_limits() {
    let state = |p, v, a| State { position: [p], velocity: [v], acceleration: [a] };
    let limits = |v, a, j| Limits::symmetric([v], [a], [j]);
    // No acceleration, or no jerk: the only motion there is.
    let input = Input::new(state(0.0, 2.0, 0.0), state(3.0, 2.0, 0.0), limits(5.0, 0.0, 1.0));
    assert_eq!(calculate(&input).unwrap().duration(), 1.5);
    let input = Input::new(state(0.0, 0.0, 2.0), state(4.0, 4.0, 2.0), limits(5.0, 3.0, 0.0));
    assert_eq!(calculate(&input).unwrap().duration(), 2.0);
    let input = Input::new(state(0.0, 0.0, 2.0), state(5.0, 4.0, 2.0), limits(5.0, 3.0, 0.0));
    assert_eq!(calculate(&input), Err(Error::Unreachable { axis: 0 }));
    // No velocity: only where it is.
    let input = Input::new(state(1.0, 0.0, 0.0), state(1.0, 0.0, 0.0), limits(0.0, 1.0, 1.0));
    assert_eq!(calculate(&input).unwrap().duration(), 0.0);
    let input = Input::new(state(1.0, 0.0, 0.0), state(2.0, 0.0, 0.0), limits(0.0, 1.0, 1.0));
    assert_eq!(calculate(&input), Err(Error::Unreachable { axis: 0 }));
    // One way only.
    let mut input = Input::new(state(1.0, 0.0, 0.0), state(2.0, 0.0, 0.0), limits(1.0, 1.0, 1.0));
    input.limits.velocity_min = [0.0];
    assert!(calculate(&input).is_ok());
    input.target = state(0.0, 0.0, 0.0);
    assert_eq!(calculate(&input), Err(Error::Unreachable { axis: 0 }));
    // Nothing limited.
    let mut input = Input::new(
        state(0.0, 0.0, 0.0),
        state(1.0, 0.0, 0.0),
        limits(f64::INFINITY, f64::INFINITY, f64::INFINITY),
    );
    assert_eq!(calculate(&input), Err(Error::Unlimited { axis: 0 }));
    input.control = [Control::Velocity];
    input.target = state(0.0, 3.0, 0.0);
    let trajectory = calculate(&input).unwrap();
    assert_eq!((trajectory.duration(), trajectory.at_time(2.0).position), (0.0, [6.0]));
}

/// 20,000 problems in which each axis has its own control, order and synchronization, and a target that moves on or does not.
#[test]
fn mixed_axes() {
    let mut random = Random(23);
    for case in 0..20_000 {
        // Not the tiny moves: what a line may leave over is reckoned by the limits, not by the move.
        let distribution = cases::ALL[case % cases::ALL.len()];
        if distribution == Distribution::Tiny {
            continue;
        }
        let mut input: Input<5> = random_input(&mut random, distribution);
        for axis in 0..5 {
            if random.chance(0.4) {
                input.control[axis] = Control::Velocity;
            }
            if random.chance(0.3) {
                input.limits.jerk_max[axis] = f64::INFINITY;
            }
            input.synchronization[axis] = match random.bits() % 4 {
                0 => Synchronization::None,
                1 => Synchronization::TimeIfNecessary,
                2 => Synchronization::Phase,
                _ => Synchronization::Time,
            };
            input.enabled[axis] = random.chance(0.9);
            // Not a target as fast as the axis may be, which nobody catches.
            let (v, l) = (input.target.velocity[axis], &input.limits);
            let slower = 0.95 * l.velocity_min[axis] < v && v < 0.95 * l.velocity_max[axis];
            input.target_moves[axis] = slower && random.chance(0.3);
        }
        let trajectory =
            calculate(&input).unwrap_or_else(|e| panic!("{distribution:?} {case}: {e}\n{input:?}"));
        let verdict = judge(&input, &trajectory, false);
        assert!(verdict.is_good(), "{distribution:?} {case}: {verdict:?}\n{input:?}");
    }
}

/// A ten-hour creep and its cycles.
#[test]
fn there_is_no_longest_duration() {
    let limits = Limits::symmetric([1e-6], [1.0], [10.0]);
    let input = Input::new(State::at_rest([0.0]), State::at_rest([0.36]), limits);
    let trajectory = calculate(&input).unwrap();
    assert!((trajectory.duration() - 360_000.0).abs() < 1.0);
    let at = trajectory.at_time(180_000.0);
    assert!((at.position[0] - 0.18).abs() < 1e-6 && (at.velocity[0] - 1e-6).abs() < 1e-18);
    assert!(judge(&input, &trajectory, true).is_good());
}

const RETARGETED: [Distribution; 4] =
    [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres, Distribution::Tiny];

/// So many cycles of three axes with a new random target at random instants: no error, no jump, limits kept.
fn retarget(distribution: Distribution, seed: u64, cycles: usize) {
    let mut random = Random(seed);
    let mut input: Input<3> = random_input(&mut random, distribution);
    (input.current.velocity, input.current.acceleration) = ([0.0; 3], [0.0; 3]);
    let cycle = calculate(&input).unwrap().duration() / 300.0;
    let (mut generator, mut output) = (Generator::new(cycle), Output::default());
    let mut changes = 0;
    for _ in 0..cycles {
        if random.chance(0.02) {
            changes += 1;
            let other: Input<3> = random_input(&mut random, distribution);
            let share = if random.chance(0.5) { 0.0 } else { 0.5 };
            input.target.position = other.target.position;
            let l = &input.limits;
            for axis in 0..3 {
                let velocity = l.velocity_max[axis].min(-l.velocity_min[axis]);
                let acceleration = l.acceleration_max[axis].min(-l.acceleration_min[axis]);
                // So that half the velocity allowed is left to change the other half in.
                let acceleration = acceleration.min((l.jerk_max[axis] * velocity).sqrt());
                input.target.velocity[axis] = share * random.uniform(-1.0, 1.0) * velocity;
                input.target.acceleration[axis] = share * random.uniform(-1.0, 1.0) * acceleration;
            }
        }
        let before = input.current;
        let status = generator.update(&input, &mut output).unwrap_or_else(|e| panic!("{e}\n{input:?}"));
        let after = output.sample.state();
        assert!(is_smooth(&input, &before, &after, cycle), "{distribution:?}\n{input:?}\n{after:?}");
        assert!(is_within_limits(&input, &after), "{distribution:?}\n{input:?}\n{after:?}");
        output.pass_to_input(&mut input);
        // A target that is passed at speed is followed on.
        if status == Status::Finished {
            input.target = State::at_rest(input.current.position);
            input.target.position[0] += input.limits.velocity_max[0] * cycle * 50.0;
        }
    }
    assert!(changes > cycles / 100);
}

/// 4 × 100,000 cycles.
#[test]
fn retargeting() {
    RETARGETED.into_iter().for_each(|distribution| retarget(distribution, 24, 100_000));
}

/// 4 × 25 sets of limits × 100,000 cycles: ten million.
#[test]
#[ignore = "takes half a minute in a release build"]
fn retargeting_for_ten_million_cycles() {
    for seed in 100..125 {
        RETARGETED.into_iter().for_each(|distribution| retarget(distribution, seed, 100_000));
    }
}

/// 3 × 30,000 cycles of three axes whose target, with its velocity, wanders on every cycle: planned anew each time, no error, no jump.
#[test]
fn a_wandering_target() {
    for distribution in [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres] {
        let mut random = Random(26);
        let mut input: Input<3> = random_input(&mut random, distribution);
        (input.current.velocity, input.current.acceleration) = ([0.0; 3], [0.0; 3]);
        let whole = calculate(&input).unwrap().duration();
        let (cycle, home) = (whole / 300.0, input.target.position);
        let (mut generator, mut output) = (Generator::new(cycle), Output::default());
        for step in 0..30_000 {
            for (axis, home) in home.iter().enumerate() {
                let l = &input.limits;
                let speed = 0.2 * l.velocity_max[axis].min(-l.velocity_min[axis]);
                // Three slow waves and noise.
                let phase = f64::from(step) / 300.0 + axis as f64;
                input.target.position[axis] =
                    home + speed * whole * phase.sin() + speed * cycle * random.normal(0.1);
                input.target.velocity[axis] = speed * phase.cos();
                input.target.acceleration[axis] = 0.0;
            }
            let before = input.current;
            generator.update(&input, &mut output).unwrap_or_else(|e| panic!("{e}\n{input:?}"));
            let after = output.sample.state();
            assert!(
                output.is_new && is_smooth(&input, &before, &after, cycle),
                "{distribution:?}\n{input:?}\n{after:?}"
            );
            output.pass_to_input(&mut input);
        }
    }
}

/// 3 × (100 + 100) motions to rest of one and six axes, planned anew on each of their 400 cycles: always on time.
#[test]
fn motions_planned_anew_on_every_cycle_arrive_on_time() {
    fn sweep<const N: usize>(distribution: Distribution) {
        let mut random = Random(27);
        for case in 0..100 {
            let mut input: Input<N> = random_input(&mut random, distribution);
            input.target = State::at_rest(input.target.position);
            let duration = calculate(&input).unwrap().duration();
            let cycle = duration / 400.5;
            for step in 0..400 {
                let rest = calculate(&input).unwrap_or_else(|e| panic!("{case} {step}: {e}\n{input:?}"));
                let total = f64::from(step) * cycle + rest.duration();
                assert!(
                    (total - duration).abs() <= 1e-4 * duration,
                    "{case} {step}: {total} {duration}\n{input:?}"
                );
                input.current = rest.at_time(cycle).state();
            }
        }
    }
    for distribution in [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres] {
        sweep::<1>(distribution);
        sweep::<6>(distribution);
    }
}

/// A target that moves on at constant speed, sent anew on every cycle as a state to be reached: the axis stays within the way of a few
/// cycles behind it, at its speed, without a jump.
#[test]
fn a_moving_target_is_followed() {
    let limits = Limits::symmetric([1.0], [4.0], [40.0]);
    let (speed, cycle) = (0.3, 0.001);
    let target = |time: f64| State { position: [0.2 + speed * time], velocity: [speed], acceleration: [0.0] };
    let mut input = Input::new(State::at_rest([0.0]), target(0.0), limits);
    let (mut generator, mut output) = (Generator::new(cycle), Output::default());
    let mut worst = 0.0_f64;
    for step in 0..20_000 {
        let time = f64::from(step) * cycle;
        input.target = target(time);
        let before = input.current;
        generator.update(&input, &mut output).unwrap();
        let after = output.sample.state();
        assert!(after.velocity[0] <= 1.0 + 1e-12);
        assert!((after.acceleration[0] - before.acceleration[0]).abs() <= 40.0 * cycle * (1.0 + 1e-9));
        output.pass_to_input(&mut input);
        if time > 3.0 {
            worst = worst.max((output.sample.position[0] - target(time + cycle).position[0]).abs());
        }
    }
    assert!(worst <= 20.0 * speed * cycle, "{worst:e}");
}

/// The same trajectory, sampled cycle by cycle, as long as nothing changes.
#[test]
fn nothing_is_planned_anew_without_a_change() {
    let mut random = Random(25);
    let mut input: Input<6> = random_input(&mut random, Distribution::Robot);
    let trajectory = calculate(&input).unwrap();
    let cycle = trajectory.duration() / 100.5;
    let (mut generator, mut output) = (Generator::new(cycle), Output::default());
    for step in 1..=101 {
        let status = generator.update(&input, &mut output).unwrap();
        assert_eq!(output.is_new, step == 1);
        assert_eq!(output.sample, trajectory.at_time(f64::from(step) * cycle));
        assert_eq!(status == Status::Finished, step == 101);
        output.pass_to_input(&mut input);
    }
    input.target.position[0] += 0.1;
    generator.update(&input, &mut output).unwrap();
    assert!(output.is_new);
}
