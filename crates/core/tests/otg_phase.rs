//! Phase synchronization: the path is a straight line, also when the same target is sent again on every cycle.

mod otg_support;

use otg_support::cases::{Distribution, random_input};
use otg_support::judge::judge;
use otg_support::random::Random;
use seamline::otg::{
    Control, Error, Generator, Input, Limits, Output, State, Status, Synchronization, calculate,
};

const STRAIGHT: f64 = 1e-12;

/// Distance of a point from the line through start and target, relative to the larger of distance and coordinates.
fn off_line<const N: usize>(start: &[f64; N], target: &[f64; N], point: &[f64; N]) -> f64 {
    let dot = |a: &[f64; N], b: &[f64; N]| (0..N).map(|i| a[i] * b[i]).sum::<f64>();
    let minus = |a: &[f64; N], b: &[f64; N]| -> [f64; N] { std::array::from_fn(|i| a[i] - b[i]) };
    let (line, to) = (minus(target, start), minus(point, start));
    let length = dot(&line, &line).sqrt();
    if length == 0.0 {
        return 0.0;
    }
    let along = dot(&line, &to) / (length * length);
    let off: [f64; N] = std::array::from_fn(|i| to[i] - along * line[i]);
    let coordinates = start.iter().chain(target).fold(0.0_f64, |a, b| a.max(b.abs()));
    dot(&off, &off).sqrt() / length.max(coordinates)
}

fn phase<const N: usize>(input: &mut Input<N>) {
    input.synchronization = [Synchronization::PhaseStrict; N];
}

/// A rest-to-rest problem, or one that moves along its line.
fn collinear<const N: usize>(random: &mut Random, distribution: Distribution, moving: bool) -> Input<N> {
    let mut input: Input<N> = random_input(random, distribution);
    input.current = State::at_rest(input.current.position);
    input.target = State::at_rest(input.target.position);
    if moving {
        let line: [f64; N] = std::array::from_fn(|i| input.target.position[i] - input.current.position[i]);
        let room = |limits: &[f64; N], share: f64| {
            let least = (0..N).map(|i| limits[i] / line[i].abs()).fold(f64::INFINITY, f64::min);
            line.map(|d| share * least * d)
        };
        let (v0, vf) = (random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
        let a0 = random.uniform(-0.5, 0.5);
        let lowest = |max: [f64; N], min: [f64; N]| std::array::from_fn(|i| max[i].min(-min[i]));
        let v_limit = lowest(input.limits.velocity_max, input.limits.velocity_min);
        let a_limit = lowest(input.limits.acceleration_max, input.limits.acceleration_min);
        input.current.velocity = room(&v_limit, v0);
        input.target.velocity = room(&v_limit, vf);
        input.current.acceleration = room(&a_limit, a0);
    }
    phase(&mut input);
    input
}

/// 3 × 2 × 3,000 lines in six axes: straight at 50 samples each, and every axis within its own limits.
#[test]
fn lines_are_straight() {
    for distribution in [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres] {
        for moving in [false, true] {
            let mut random = Random(3);
            for case in 0..3_000 {
                let input: Input<6> = collinear(&mut random, distribution, moving);
                let trajectory = calculate(&input).unwrap();
                assert_eq!(trajectory.synchronized(), &[Synchronization::Phase; 6]);
                let verdict = judge(&input, &trajectory, true);
                assert!(verdict.is_good(), "{distribution:?} {case}: {verdict:?}\n{input:?}");
                for sample in 0..=50 {
                    let at = trajectory.at_time(trajectory.duration() * f64::from(sample) / 50.0);
                    let off = off_line(&input.current.position, &input.target.position, &at.position);
                    assert!(off <= STRAIGHT, "{distribution:?} {case}: {off:e}\n{input:?}");
                }
            }
        }
    }
}

/// 3 × 100 lines in six axes, planned anew on every one of their (up to 2,000) cycles from the state reached: still straight, still on
/// time.
#[test]
fn lines_stay_straight_when_planned_anew_on_every_cycle() {
    for distribution in [Distribution::PeerTest, Distribution::Robot, Distribution::Millimetres] {
        let mut random = Random(4);
        for case in 0..100 {
            let mut input: Input<6> = collinear(&mut random, distribution, case % 2 == 1);
            input.target = State::at_rest(input.target.position);
            phase(&mut input);
            let (start, target) = (input.current.position, input.target.position);
            let duration = calculate(&input).unwrap().duration();
            let cycle = duration / 999.5;
            let (mut generator, mut output) = (Generator::new(cycle), Output::default());
            let mut cycles = 0;
            let mut straight = 0.0_f64;
            loop {
                generator.reset();
                let status = generator.update(&input, &mut output).unwrap_or_else(|error| {
                    panic!("{distribution:?} {case} cycle {cycles}: {error}\n{input:?}");
                });
                straight = straight.max(off_line(&start, &target, &output.sample.position));
                cycles += 1;
                output.pass_to_input(&mut input);
                if status == Status::Finished || cycles > 2000 {
                    break;
                }
            }
            assert!(straight <= STRAIGHT, "{distribution:?} {case}: {straight:e}");
            assert!((1000..=1001).contains(&cycles), "{distribution:?} {case}: {cycles} cycles");
        }
    }
}

/// Where there is nothing to do, nothing is done, whatever the limits are.
#[test]
fn a_line_without_length_takes_no_time() {
    for jerk in [100.0, f64::INFINITY] {
        let here = State::at_rest([0.3, -1.2, 0.0]);
        let mut input = Input::new(here, here, Limits::symmetric([1.0; 3], [10.0; 3], [jerk; 3]));
        phase(&mut input);
        let trajectory = calculate(&input).unwrap();
        assert_eq!(trajectory.duration(), 0.0);
        assert_eq!(trajectory.at_time(0.1).position, here.position);
    }
}

/// A problem that is not collinear: time synchronization, which the output says, or an error if the line was demanded.
#[test]
fn what_is_no_line_is_said_to_be_none() {
    let mut random = Random(5);
    let mut input: Input<3> = collinear(&mut random, Distribution::Robot, false);
    input.current.velocity = [0.1, 0.0, 0.0];
    assert!(matches!(calculate(&input), Err(Error::NotCollinear { .. })));
    input.synchronization = [Synchronization::Phase; 3];
    let trajectory = calculate(&input).unwrap();
    assert_eq!(trajectory.synchronized(), &[Synchronization::Time; 3]);
    assert!(judge(&input, &trajectory, true).is_good());
}

/// A target acceleration that each axis can reach, but not the line, for which the first axis' jerk and the second's velocity count.
#[test]
fn a_line_whose_target_is_out_of_its_reach() {
    let state = |a: f64| State { position: [0.0; 2], velocity: [0.0; 2], acceleration: [a; 2] };
    let limits = Limits::symmetric([27.5, 19.5], [27.5, 27.5], [15.75, 27.5]);
    let mut input = Input::new(state(0.0), state(27.5), limits);
    phase(&mut input);
    assert!(matches!(calculate(&input), Err(Error::NotCollinear { .. })));
    input.synchronization = [Synchronization::Phase; 2];
    let trajectory = calculate(&input).unwrap();
    assert_eq!(trajectory.synchronized(), &[Synchronization::Time; 2]);
    assert!(judge(&input, &trajectory, true).is_good());
}

/// 2,000 problems with a line of three axes, two axes in time and one alone.
#[test]
fn a_line_beside_other_axes() {
    use Synchronization::{None, PhaseStrict, Time};
    let mut random = Random(6);
    for case in 0..2_000 {
        let mut input: Input<6> = random_input(&mut random, Distribution::Robot);
        for axis in 0..3 {
            input.current.velocity[axis] = 0.0;
            input.current.acceleration[axis] = 0.0;
            input.target.velocity[axis] = 0.0;
            input.target.acceleration[axis] = 0.0;
        }
        input.synchronization = [PhaseStrict, PhaseStrict, PhaseStrict, Time, Time, None];
        let trajectory = calculate(&input).unwrap();
        let verdict = judge(&input, &trajectory, false);
        assert!(verdict.is_good(), "{case}: {verdict:?}\n{input:?}");
        let ends: [f64; 6] = trajectory.profiles().map(|profile| profile.duration());
        for axis in 1..5 {
            assert!((ends[axis] - ends[0]).abs() <= 1e-12 * ends[0], "{case}: {ends:?}");
        }
        assert!((ends[5] - trajectory.duration_min()[5]).abs() <= 1e-12 * ends[5]);
    }
}

/// 1,000 problems of velocity control: the velocity vector changes along a line.
#[test]
fn velocities_change_along_a_line() {
    let mut random = Random(7);
    for case in 0..1_000 {
        let mut input: Input<4> = random_input(&mut random, Distribution::Robot);
        input.control = [Control::Velocity; 4];
        input.current.acceleration = [0.0; 4];
        input.target.acceleration = [0.0; 4];
        phase(&mut input);
        let trajectory = calculate(&input).unwrap();
        let verdict = judge(&input, &trajectory, true);
        assert!(verdict.is_good(), "{case}: {verdict:?}\n{input:?}");
        for sample in 0..=20 {
            let at = trajectory.at_time(trajectory.duration() * f64::from(sample) / 20.0);
            let off = off_line(&input.current.velocity, &input.target.velocity, &at.velocity);
            assert!(off <= STRAIGHT, "{case}: {off:e}\n{input:?}");
        }
    }
}
