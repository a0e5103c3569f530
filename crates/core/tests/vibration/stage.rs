//! The streaming stage against the convolution by its definition.

use seamline::vibration::{Kernel, Mode, Prefilter, PrefilterStage, StageError};

use crate::random::Random;

const PERIOD: f64 = 1e-3;

fn mode(omega: f64) -> Mode {
    Mode::try_new(omega, 0.022).expect("a mode")
}

/// The command at a time in cycles: linear between its samples, at rest before them.
fn command(samples: &[f64], cycles: f64) -> f64 {
    let at = cycles.max(0.0);
    let n = (at.floor() as usize).min(samples.len() - 1);
    let next = samples[(n + 1).min(samples.len() - 1)];
    samples[n] + (at - n as f64) * (next - samples[n])
}

/// The command averaged over `[end − duration, end]`, in cycles, piece by piece.
fn average(samples: &[f64], end: f64, duration: f64) -> f64 {
    let start = end - duration;
    let (mut at, mut sum) = (start, 0.0);
    while at < end {
        let next = (at.floor() + 1.0).min(end);
        sum += 0.5 * (command(samples, at) + command(samples, next)) * (next - at);
        at = next;
    }
    sum / duration
}

fn convolved(kernel: &Kernel, samples: &[f64], cycle: usize) -> f64 {
    let shares = kernel.impulses().iter().map(|impulse| {
        let at = cycle as f64 - impulse.time / PERIOD;
        let value = match kernel.rectangles() {
            [] => command(samples, at),
            [duration, ..] => average(samples, at, duration / PERIOD),
        };
        impulse.weight * value
    });
    shares.sum()
}

/// A move with corners in its rate, from `start`.
fn random_move(random: &mut Random, start: f64, cycles: usize) -> Vec<f64> {
    let mut rate = 0.0;
    let mut at = start;
    let mut samples = vec![start];
    for _ in 1..cycles {
        if random.chance(0.02) {
            rate = random.uniform(-1e-3, 1e-3);
        }
        at += rate;
        samples.push(at);
    }
    samples
}

#[test]
fn it_is_the_convolution_at_every_cycle() {
    let mut random = Random(5);
    for case in 0..40 {
        let prefilter = Prefilter::ALL[case % Prefilter::ALL.len()];
        let kernel = prefilter.kernel(&mode(random.log_uniform(35.0, 4000.0))).unwrap();
        let start = random.uniform(-2.0, 2.0);
        // More than four laps of the ring.
        let samples = random_move(&mut random, start, 2300);
        let mut stage = PrefilterStage::<1, 512>::try_new(&kernel, PERIOD, &[start]).unwrap();
        for (cycle, &sample) in samples.iter().enumerate() {
            let [output] = stage.update(&[sample]);
            if cycle % 7 == 0 {
                let expected = convolved(&kernel, &samples, cycle);
                assert!((output - expected).abs() < 2e-13, "{prefilter} {cycle}: {output} {expected}");
            }
        }
    }
}

#[test]
fn a_constant_rate_passes_and_what_is_inside_runs_out() {
    let kernel = Prefilter::FirZvd.kernel(&mode(39.84)).unwrap();
    let mut stage = PrefilterStage::<6, 512>::try_new(&kernel, PERIOD, &[1.0; 6]).unwrap();
    assert!(stage.is_drained());
    let rate = [1e-4, -2e-4, 3e-5, 0.0, 1e-6, -1e-3];
    let at = |n: usize| rate.map(|r| 1.0 + r * n as f64);
    let cycles = 100_000;
    let length = (kernel.length() / PERIOD).ceil() as usize;
    let mut last = [1.0; 6];
    for n in 0..cycles {
        let output = stage.update(&at(n));
        if n > length {
            for axis in 0..6 {
                let step = output[axis] - last[axis];
                assert!((step - rate[axis]).abs() < 2e-13 * at(n)[axis].abs().max(1.0), "{n} {axis} {step}");
            }
        }
        last = output;
    }
    assert_eq!(stage.remaining(), length);
    let end = *stage.command();
    let mut drained = 0;
    while !stage.is_drained() {
        let output = stage.update(&end);
        drained += 1;
        for axis in 0..6 {
            let forward = (output[axis] - last[axis]) * rate[axis].signum();
            assert!(forward > -1e-12, "never back");
            assert!(forward < rate[axis].abs() + 1e-12, "never faster");
        }
        last = output;
    }
    assert_eq!(drained, length);
    assert_eq!(last, end);
}

/// Ten million cycles to and fro: the output comes to rest where the command does, and does not wander before.
#[test]
#[ignore = "long"]
fn it_does_not_drift() {
    let kernel = Prefilter::FirZv.kernel(&mode(39.84)).unwrap();
    let mut stage = PrefilterStage::<1, 512>::try_new(&kernel, PERIOD, &[1.0]).unwrap();
    let mut greatest = 0.0_f64;
    for n in 0..10_000_000_u32 {
        let angle = f64::from(n) * 1e-3;
        let [output] = stage.update(&[1.0 + angle.sin()]);
        let gain = kernel.transfer(nalgebra::Complex::new(0.0, 1.0));
        let expected = 1.0 + gain.re * angle.sin() + gain.im * angle.cos();
        if n > 1000 {
            greatest = greatest.max((output - expected).abs());
        }
    }
    println!("greatest difference from the sine: {greatest:e}");
    assert!(greatest < 1e-6);
}

#[test]
fn stages_follow_each_other_for_several_modes() {
    let modes = [mode(40.0), mode(90.0)];
    let [first, second] = modes.map(|mode| Prefilter::FirZvd.kernel(&mode).unwrap());
    let mut a = PrefilterStage::<1, 512>::try_new(&first, PERIOD, &[0.0]).unwrap();
    let mut b = PrefilterStage::<1, 512>::try_new(&second, PERIOD, &[0.0]).unwrap();
    let both = first.convolve(&second).unwrap();
    let ramp = seamline::vibration::Ramp::from_kernel(&both).unwrap();
    let refused = PrefilterStage::<1, 512>::try_new(&both, PERIOD, &[0.0]);
    assert!(matches!(refused, Err(StageError::Rectangles { count: 2 })));
    for n in 0..1500_u32 {
        let time = f64::from(n) * PERIOD;
        let [output] = b.update(&a.update(&[time]));
        // The second stage takes the first one's output as linear within a cycle.
        assert!((output - ramp.integral(time)).abs() < 5e-7, "{n}: {output} {}", ramp.integral(time));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let kernel = Prefilter::FirZvd.kernel(&mode(10.0)).unwrap();
    let stage = PrefilterStage::<1, 256>::try_new(&kernel, PERIOD, &[0.0]);
    assert!(matches!(stage, Err(StageError::TooLong { room: 255, .. })));
    let stage = PrefilterStage::<1, 256>::try_new(&Kernel::IDENTITY, 0.0, &[0.0]);
    assert!(matches!(stage, Err(StageError::Period { .. })));
    let mut stage = PrefilterStage::<1, 2>::try_new(&Kernel::IDENTITY, PERIOD, &[0.0]).unwrap();
    for n in 0..9 {
        assert_eq!(stage.update(&[f64::from(n)]), [f64::from(n)]);
    }
}
