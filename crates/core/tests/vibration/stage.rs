//! The streaming stage against the convolution by its definition.

use seamline::vibration::{Kernel, Mode, Prefilter, PrefilterStage, StageEntry, StageError, stage_entries};

use crate::random::Random;

const PERIOD: f64 = 1e-3;

type Stage<const N: usize> = PrefilterStage<[f64; N], Vec<StageEntry<[f64; N]>>>;

fn stage<const N: usize>(kernel: &Kernel, start: [f64; N]) -> Stage<N> {
    let ring = vec![StageEntry::ZERO; stage_entries(kernel, PERIOD)];
    PrefilterStage::try_new(ring, kernel, PERIOD, &start).expect("a ring that is long enough")
}

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
        let mut stage = stage(&kernel, [start]);
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
    let mut stage = stage(&kernel, [1.0; 6]);
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
    let mut stage = stage(&kernel, [1.0]);
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
    let mut a = stage(&first, [0.0]);
    let mut b = stage(&second, [0.0]);
    let both = first.convolve(&second).unwrap();
    let ramp = seamline::vibration::Ramp::from_kernel(&both).unwrap();
    let refused = PrefilterStage::try_new([StageEntry::ZERO; 512], &both, PERIOD, &[0.0]);
    assert!(matches!(refused, Err(StageError::Rectangles { count: 2 })));
    for n in 0..1500_u32 {
        let time = f64::from(n) * PERIOD;
        let [output] = b.update(&a.update(&[time]));
        // The second stage takes the first one's output as linear within a cycle.
        assert!((output - ramp.integral(time)).abs() < 5e-7, "{n}: {output} {}", ramp.integral(time));
    }
}

/// A reset in mid-motion, at any place of the ring: from there on the stage is as good as a new one.
#[test]
fn after_a_reset_nothing_of_before_comes_out() {
    let mut random = Random(9);
    for case in 0..60 {
        let kernel =
            Prefilter::ALL[case % Prefilter::ALL.len()].kernel(&mode(random.log_uniform(35.0, 400.0)));
        let kernel = kernel.unwrap();
        let mut used = stage(&kernel, [random.uniform(-2.0, 2.0)]);
        for sample in random_move(&mut random, 0.3, 100 + 37 * case) {
            let _ = used.update(&[sample]);
        }
        let start = random.uniform(-2.0, 2.0);
        used.reset(&[start]);
        assert!(used.is_drained());
        let mut new = stage(&kernel, [start]);
        for sample in random_move(&mut random, start, 1500) {
            assert_eq!(used.update(&[sample]), new.update(&[sample]));
        }
    }
}

/// The differences of a move, up to the third, bound those of what comes out of two stages.
#[test]
fn limits_of_the_command_hold_for_what_comes_out() {
    let mut random = Random(11);
    let differences = |samples: &[f64]| -> [f64; 4] {
        let third = |w: &[f64]| w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0];
        let greatest = |width: usize, of: &dyn Fn(&[f64]) -> f64| {
            samples.windows(width).map(|w| of(w).abs()).fold(0.0, f64::max)
        };
        let second = |w: &[f64]| w[2] - 2.0 * w[1] + w[0];
        [greatest(1, &|w| w[0]), greatest(2, &|w| w[1] - w[0]), greatest(3, &second), greatest(4, &third)]
    };
    for case in 0..60 {
        let of = |omega: f64| Prefilter::ALL[case % Prefilter::ALL.len()].kernel(&mode(omega)).unwrap();
        let kernels = [of(random.log_uniform(35.0, 400.0)), of(random.log_uniform(35.0, 400.0))];
        let [mut first, mut second] = kernels.each_ref().map(|kernel| stage(kernel, [0.7]));
        let mut samples = random_move(&mut random, 0.7, 2000);
        samples.splice(0..0, [0.7; 3]);
        let output: Vec<f64> = samples.iter().map(|&x| second.update(&first.update(&[x]))[0]).collect();
        let (before, after) = (differences(&samples), differences(&output));
        for order in 0..4 {
            assert!(after[order] <= before[order] + 1e-13, "case {case}: {after:?} of {before:?}");
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let kernel = Prefilter::FirZvd.kernel(&mode(10.0)).unwrap();
    let short =
        |kernel: &Kernel, period| PrefilterStage::try_new([StageEntry::ZERO; 300], kernel, period, &[0.0]);
    assert!(matches!(short(&kernel, PERIOD), Err(StageError::TooLong { room: 255, .. })));
    assert!(matches!(short(&Kernel::IDENTITY, 0.0), Err(StageError::Period { .. })));
    let none: &mut [StageEntry<[f64; 1]>] = &mut [];
    let refused = PrefilterStage::try_new(none, &Kernel::IDENTITY, PERIOD, &[0.0]);
    assert!(matches!(refused, Err(StageError::TooLong { room: 0, .. })));
    let mut least = stage(&Kernel::IDENTITY, [0.0]);
    for n in 0..9 {
        assert_eq!(least.update(&[f64::from(n)]), [f64::from(n)]);
    }
}
