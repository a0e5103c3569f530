//! What must hold whatever the problem: symmetries, units, optimality, demanded durations, and the error on bad input.
#![allow(clippy::panic)] // what its tests share is test code too

mod otg_support;

use otg_support::cases::{self, Distribution, mirrored, random_input, reversed};
use otg_support::judge::judge;
use otg_support::random::Random;
use seamline::otg::{Control, Error, Input, Limits, Quantity, State, Synchronization, calculate};

fn duration<const N: usize>(input: &Input<N>) -> f64 {
    calculate(input).unwrap_or_else(|error| panic!("{error}\n{input:?}")).duration()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs())
}

/// Distributions whose starts may also be targets.
fn viable() -> impl Iterator<Item = Distribution> {
    cases::ALL.into_iter().filter(|d| !matches!(d, Distribution::Brake | Distribution::Whole))
}

/// The problem in a unit of length 1/`length`, and of time 1/`time`.
fn in_units(input: &Input<1>, length: f64, time: f64) -> Input<1> {
    let scale = |x: &[f64; 1], factor: f64| x.map(|x| x * factor);
    let (p, v, a, j) = (length, length / time, length / time / time, length / time / time / time);
    let state = |s: &State<1>| State {
        position: scale(&s.position, p),
        velocity: scale(&s.velocity, v),
        acceleration: scale(&s.acceleration, a),
    };
    let l = &input.limits;
    let limits = Limits {
        velocity_max: scale(&l.velocity_max, v),
        velocity_min: scale(&l.velocity_min, v),
        acceleration_max: scale(&l.acceleration_max, a),
        acceleration_min: scale(&l.acceleration_min, a),
        jerk_max: scale(&l.jerk_max, j),
        ..*l
    };
    Input { current: state(&input.current), target: state(&input.target), limits, ..*input }
}

/// 9 × 20,000 problems: the mirror image takes as long, exactly.
#[test]
fn mirror() {
    for distribution in cases::ALL {
        let mut random = Random(11);
        for _ in 0..20_000 {
            let input: Input<1> = random_input(&mut random, distribution);
            let (own, other) = (duration(&input), duration(&mirrored(&input)));
            assert!(close(own, other, 1e-9), "{distribution:?}: {own} {other}\n{input:?}");
        }
    }
}

/// 7 × 20,000 problems: backwards in time takes as long, which a solution that is not the shortest hardly does.
#[test]
fn time_reversal() {
    for distribution in viable() {
        let mut random = Random(12);
        for _ in 0..20_000 {
            let input: Input<1> = random_input(&mut random, distribution);
            let back = reversed(&input);
            // Starts that force a brake are no targets.
            let Ok(other) = calculate(&back) else { continue };
            let own = calculate(&input).unwrap();
            if own.profiles()[0].brake().is_empty() && other.profiles()[0].brake().is_empty() {
                let (own, other) = (own.duration(), other.duration());
                assert!(close(own, other, 1e-9), "{distribution:?}: {own} {other}\n{input:?}");
            }
        }
    }
}

/// 9 × 4 × 5,000 problems in units 1000 and 1,000,000 times larger and smaller.
#[test]
fn units() {
    for distribution in cases::ALL {
        let mut random = Random(13);
        for _ in 0..5_000 {
            let mut input: Input<1> = random_input(&mut random, distribution);
            // From zero: otherwise the conversion rounds a tiny displacement between large coordinates.
            input.target.position[0] -= input.current.position[0];
            input.current.position[0] = 0.0;
            let own = duration(&input);
            for (length, time) in [(1e3, 1.0), (1e-6, 1.0), (1.0, 1e3), (1e6, 1e-3)] {
                let other = duration(&in_units(&input, length, time)) / time;
                assert!(
                    close(own, other, 1e-9),
                    "{distribution:?} {length} {time}: {own} {other}\n{input:?}"
                );
            }
        }
    }
}

/// 9 × 5,000 motions chosen at random, and the generator asked for the state where they end: it is never later.
#[test]
fn no_other_motion_is_shorter() {
    for distribution in cases::ALL.into_iter().filter(|d| *d != Distribution::Brake) {
        let mut random = Random(14);
        for _ in 0..5_000 {
            let mut input: Input<1> = random_input(&mut random, distribution);
            let limits = input.limits;
            let (mut v, mut a) = (input.current.velocity[0], input.current.acceleration[0]);
            let (mut p, mut time) = (0.0, 0.0);
            input.current.position = [0.0];
            // Pieces of random jerk, as long as they keep the limits with a reserve for what comes after.
            for _ in 0..8 {
                let j = random.uniform(-1.0, 1.0) * limits.jerk_max[0];
                let t = random.unit() * 2.0 * limits.acceleration_max[0] / limits.jerk_max[0];
                let next = (p + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j);
                let reserve = next.2 * next.2 / (2.0 * limits.jerk_max[0]);
                let turn = v - a * a / (2.0 * j);
                let inside =
                    |v: f64| limits.velocity_min[0] <= v - reserve && v + reserve <= limits.velocity_max[0];
                if inside(next.1)
                    && inside(turn)
                    && limits.acceleration_min[0] <= next.2
                    && next.2 <= limits.acceleration_max[0]
                {
                    (p, v, a) = next;
                    time += t;
                }
            }
            input.target = State { position: [p], velocity: [v], acceleration: [a] };
            // The start itself, where no piece fitted, may be no target.
            let trajectory = match calculate(&input) {
                Ok(trajectory) => trajectory,
                Err(error) => {
                    assert_eq!(time, 0.0, "{error}\n{input:?}");
                    continue;
                }
            };
            if trajectory.profiles()[0].brake().is_empty() {
                let own = trajectory.duration();
                assert!(own <= time * (1.0 + 1e-9), "{distribution:?}: {own} against {time}\n{input:?}");
            }
        }
    }
}

/// 9 × 3,000 problems of three axes with a minimum duration up to twice the least: met exactly or, where some axis cannot
/// arrive then, at a later time than that at which all can, and never earlier than without it.
#[test]
fn minimum_durations() {
    let mut late = 0;
    for distribution in cases::ALL {
        let mut random = Random(15);
        for _ in 0..3_000 {
            let mut input: Input<3> = random_input(&mut random, distribution);
            let least = duration(&input);
            let asked = least * random.uniform(0.5, 2.0);
            input.duration_min = Some(asked);
            let trajectory = calculate(&input).unwrap();
            let verdict = judge(&input, &trajectory, true);
            assert!(verdict.is_good(), "{distribution:?}: {verdict:?}\n{input:?}");
            assert!(trajectory.duration() >= asked.max(least) * (1.0 - 1e-12));
            late += usize::from(trajectory.duration() > asked.max(least) * (1.0 + 1e-12));
        }
    }
    assert!(late > 0 && late < 3_000, "{late} of 27,000 were blocked");
}

/// 9 × 3,000 problems whose duration shall be a whole number of cycles.
#[test]
fn discrete_durations() {
    for distribution in cases::ALL {
        let mut random = Random(16);
        for _ in 0..3_000 {
            let mut input: Input<2> = random_input(&mut random, distribution);
            let least = duration(&input);
            let step = least / random.uniform(0.5, 500.0);
            input.duration_step = Some(step);
            let trajectory = calculate(&input).unwrap();
            let verdict = judge(&input, &trajectory, true);
            assert!(verdict.is_good(), "{distribution:?}: {verdict:?}\n{input:?}");
            let steps = trajectory.duration() / step;
            // Asked again for a step that is the duration, the duration stays.
            input.duration_step = Some(trajectory.duration());
            let again = calculate(&input).unwrap().duration();
            assert!(close(again, trajectory.duration(), 1e-12), "{distribution:?}: {again}\n{input:?}");
            assert!(
                (steps - steps.round()).abs() <= 1e-9 * steps,
                "{distribution:?}: {steps} steps\n{input:?}"
            );
            assert!(trajectory.duration() >= least * (1.0 - 1e-12));
        }
    }
}

/// 4,000 trajectories: the extrema hold at 200 samples, and first passages are passages, with none before.
#[test]
fn extrema_and_passages() {
    for distribution in [Distribution::PeerTest, Distribution::Millimetres] {
        let mut random = Random(17);
        for _ in 0..2_000 {
            let input: Input<1> = random_input(&mut random, distribution);
            let trajectory = calculate(&input).unwrap();
            let extrema = trajectory.position_extrema()[0];
            let slack = 1e-12 * (extrema.max.abs() + extrema.min.abs());
            let mut reached = (f64::INFINITY, f64::NEG_INFINITY);
            let asked = random.uniform(extrema.min, extrema.max);
            let passage = trajectory.first_time_at_position(0, asked).unwrap();
            let side = trajectory.at_time(0.0).position[0] > asked;
            for sample in 0..=200 {
                let time = trajectory.duration() * f64::from(sample) / 200.0;
                let p = trajectory.at_time(time).position[0];
                reached = (reached.0.min(p), reached.1.max(p));
                let other_side = (p - asked).abs() > slack && (p > asked) != side;
                assert!(
                    !(other_side && time < passage * (1.0 - 1e-9)),
                    "{asked} passed before {passage}\n{input:?}"
                );
            }
            assert!(reached.0 >= extrema.min - slack && reached.1 <= extrema.max + slack, "{input:?}");
            let at = |time: f64| trajectory.at_time(time).position[0];
            assert!((at(extrema.time_max) - extrema.max).abs() <= slack);
            assert!((at(extrema.time_min) - extrema.min).abs() <= slack);
            let way = extrema.max - extrema.min + extrema.max.abs();
            assert!((at(passage) - asked).abs() <= 1e-9 * way, "{} {asked}\n{input:?}", at(passage));
        }
    }
}

#[test]
fn position_limits_are_kept_or_the_excess_is_named() {
    let limits = Limits { position_max: [0.25], ..Limits::symmetric([1.0], [1.0], [1.0]) };
    let mut input = Input::new(
        State { position: [0.0], velocity: [0.9], acceleration: [0.0] },
        State::at_rest([0.2]),
        limits,
    );
    let error = calculate(&input).unwrap_err();
    let Error::PositionLimit { axis: 0, position, time, limit } = error else { panic!("{error}") };
    assert_eq!(limit, 0.25);
    input.limits.position_max = [f64::INFINITY];
    let free = calculate(&input).unwrap();
    assert_eq!(free.at_time(time).position[0], position);
    assert!(position > 0.25);
    input.limits.position_max = [position];
    assert!(calculate(&input).is_ok());
}

/// Axes that are not enabled do not count, and go on as they were.
#[test]
fn disabled_axes_coast() {
    let limits = Limits::symmetric([1.0; 2], [1.0; 2], [1.0; 2]);
    let current = State { position: [0.0, f64::MAX], velocity: [0.0, f64::NAN], acceleration: [0.0, 0.0] };
    let mut input = Input::new(current, State::at_rest([1.0, 1.0]), limits);
    assert!(calculate(&input).is_err());
    input.enabled[1] = false;
    let trajectory = calculate(&input).unwrap();
    assert_eq!(trajectory.at_time(100.0).position[0], 1.0);
    input.current = State { position: [0.0, 1.0], velocity: [0.0, 2.0], acceleration: [0.0, 3.0] };
    let trajectory = calculate(&input).unwrap();
    assert_eq!(trajectory.at_time(2.0).position[1], 1.0 + 4.0 + 6.0);
}

#[test]
fn bad_input_is_named() {
    let good = || {
        Input::new(
            State::at_rest([0.0; 2]),
            State::at_rest([1.0; 2]),
            Limits::symmetric([1.0; 2], [1.0; 2], [1.0; 2]),
        )
    };
    let error = |change: &dyn Fn(&mut Input<2>)| {
        let mut input = good();
        change(&mut input);
        calculate(&input).unwrap_err()
    };
    let is_nan = |error: Error, wanted: Quantity| matches!(error, Error::NotFinite { axis: 1, quantity, value } if quantity == wanted && value.is_nan());
    assert!(is_nan(error(&|i| i.current.position[1] = f64::NAN), Quantity::CurrentPosition));
    assert!(is_nan(error(&|i| i.target.acceleration[1] = f64::NAN), Quantity::TargetAcceleration));
    let limit = error(&|i| i.limits.velocity_max[1] = -1.0);
    assert_eq!(limit, Error::BadLimit { axis: 1, quantity: Quantity::VelocityMax, value: -1.0 });
    let beyond = error(&|i| i.target.velocity[0] = 1.5);
    let quantity = Quantity::TargetVelocity;
    assert_eq!(beyond, Error::TargetBeyondLimit { axis: 0, quantity, value: 1.5, limit: 1.0 });
    // At the limit, but to be reached with falling acceleration: it was faster before.
    let beyond = error(&|i| (i.target.velocity[0], i.target.acceleration[0]) = (1.0, -1.0));
    assert_eq!(beyond, Error::TargetBeyondLimit { axis: 0, quantity, value: 1.5, limit: 1.0 });
    assert_eq!(error(&|i| i.duration_min = Some(-1.0)), Error::BadDuration { value: -1.0 });
    assert_eq!(error(&|i| i.duration_step = Some(0.0)), Error::BadDuration { value: 0.0 });
    assert_eq!(error(&|i| i.limits.velocity_max[1] = 0.0), Error::Unreachable { axis: 1 });
    assert_eq!(error(&|i| i.limits.jerk_max[1] = 0.0), Error::Unreachable { axis: 1 });
}

/// 200,000 inputs made of the extremes of 64-bit floats: a finite answer or an error, never a panic.
#[test]
fn extreme_numbers() {
    let values = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-300,
        -1e-300,
        1e300,
        -1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        1e-160,
        1e160,
    ];
    let mut random = Random(18);
    let mut answers = 0;
    for _ in 0..200_000 {
        let mut any = || {
            let value = values[(random.bits() % values.len() as u64) as usize];
            if random.chance(0.5) { value } else { random.normal(1.0) }
        };
        let mut state =
            || State { position: [any(), any()], velocity: [any(), 0.0], acceleration: [any(), 0.0] };
        let (current, target) = (state(), state());
        let mut limit = || [any().abs(), any().abs()];
        let mut input = Input::new(current, target, Limits::symmetric(limit(), limit(), limit()));
        if random.chance(0.3) {
            input.limits.jerk_max[0] = f64::INFINITY;
        }
        if random.chance(0.3) {
            input.limits.velocity_max[0] = f64::INFINITY;
        }
        if random.chance(0.2) {
            input.control[0] = Control::Velocity;
        }
        if random.chance(0.3) {
            input.synchronization = [Synchronization::Phase; 2];
        }
        if let Ok(trajectory) = calculate(&input) {
            answers += 1;
            assert!(trajectory.duration().is_finite(), "{input:?}");
            for share in [0.0, 0.3, 1.0] {
                let at = trajectory.at_time(share * trajectory.duration());
                let all = at.position.iter().chain(&at.velocity).chain(&at.acceleration);
                assert!(all.clone().all(|x| x.is_finite()), "{share} {at:?}\n{input:?}");
            }
        }
    }
    assert!(answers > 10_000, "{answers}");
}

/// A number of up to 10^±span; half of the signed ones are negative.
fn magnitude(random: &mut Random, span: f64, signed: bool) -> f64 {
    let size = 10.0_f64.powf(random.uniform(-span, span));
    if signed && random.chance(0.5) { -size } else { size }
}

/// A target that the limits allow, and everything else of any size.
fn any_size(random: &mut Random, span: f64) -> Input<2> {
    let mut row =
        |signed: bool| -> [f64; 2] {
            std::array::from_fn(|_| {
                if signed && random.chance(0.3) { 0.0 } else { magnitude(random, span, signed) }
            })
        };
    let mut state = || State { position: row(true), velocity: row(true), acceleration: row(true) };
    let (current, mut target) = (state(), state());
    let limits = Limits::symmetric(row(false), row(false), row(false));
    for axis in 0..2 {
        let (v, a) = (limits.velocity_max[axis], limits.acceleration_max[axis]);
        let held = target.acceleration[axis].clamp(-a, a);
        let room = v - 0.5 * (held * (held / limits.jerk_max[axis])).abs();
        target.acceleration[axis] = if room > 0.0 { held } else { 0.0 };
        let room = if room > 0.0 { room } else { v };
        target.velocity[axis] = target.velocity[axis].clamp(-room, room);
    }
    let mut input = Input::new(current, target, limits);
    input.synchronization = [[Synchronization::None, Synchronization::Time, Synchronization::Phase]
        [(random.bits() % 3) as usize]; 2];
    if random.chance(0.2) {
        input.control = [Control::Velocity; 2];
    }
    input
}

/// 3 × 200,000 inputs whose numbers span 1e±20, 1e±100 and 1e±150: an answer whose samples are all finite or an error that says what is out of
/// range; up to 1e±20 all but one in a thousand have an answer.
#[test]
fn numbers_of_any_size() {
    for (span, least) in [(20.0, 199_800), (100.0, 120_000), (150.0, 80_000)] {
        let mut random = Random(19);
        let mut answers = 0;
        for _ in 0..200_000 {
            let input = any_size(&mut random, span);
            match calculate(&input) {
                Ok(trajectory) => {
                    answers += 1;
                    for share in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
                        let at = trajectory.at_time(share * trajectory.duration());
                        let mut all = at.position.iter().chain(&at.velocity).chain(&at.acceleration);
                        assert!(all.all(|x| x.is_finite()), "{share} {at:?}\n{input:?}");
                    }
                }
                Err(Error::OutOfRange { axis, quantity, value }) => {
                    // The number named is the axis' own, and an extreme one.
                    assert!(axis < 2 && value.abs().log10().abs() > 5.0, "{quantity} {value}\n{input:?}");
                }
                Err(other) => panic!("{other}\n{input:?}"),
            }
        }
        assert!(answers >= least, "1e±{span}: {answers}");
    }
}

/// Problems that sweeps and fuzzing have found. One: the displacement rises throughout, but so little in between that Newton's method leads from
/// there to the start of the bracket and back. Two: beside another axis, the start of the main arc beyond the turn of a brake is no way round the brake.
#[test]
fn found_once() {
    let current = State {
        position: [-1.7388394384432249],
        velocity: [16.644254872131725],
        acceleration: [-5.074612831277814],
    };
    let target = State {
        position: [-2.294092610390382],
        velocity: [-8.591695179555726],
        acceleration: [2.0586504317503636],
    };
    let limits = Limits::symmetric([10.883142476128496], [7.970710804394044], [3.0663020957418663]);
    let one = Input::new(current, target, limits);
    assert!(judge(&one, &calculate(&one).unwrap(), true).is_good());

    let state = State { position: [12.25; 2], velocity: [12.25; 2], acceleration: [12.25; 2] };
    let mut limits = Limits::symmetric([16.0, 12.25], [12.25; 2], [12.25; 2]);
    limits.velocity_min[0] = -12.25;
    let mut two = Input::new(state, state, limits);
    (two.target_moves, two.duration_min) = ([true; 2], Some(0.25));
    assert!(judge(&two, &calculate(&two).unwrap(), true).is_good());
}
