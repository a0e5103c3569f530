//! Identification against signals whose modes are known.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a failing test says where")]

use std::f64::consts::TAU;

#[path = "../../core/tests/otg_support/random.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the generator's tests, which use all of it")]
mod random;

use random::Random;
use seamline_cell::identify::{CsvError, IdentifyError, Signal, identify, read_signal};

/// Frequency in Hz, damping ratio, amplitude, phase.
type Truth = (f64, f64, f64, f64);

/// The sum of decaying vibrations, sampled at 1 kHz for 3 s.
fn clean(modes: &[Truth]) -> Signal {
    let times: Vec<f64> = (0..3000_u32).map(|n| f64::from(n) * 1e-3).collect();
    let value = |t: &f64| {
        let part = |&(frequency, damping, amplitude, phase): &Truth| {
            let omega = TAU * frequency;
            let damped = omega * (1.0 - damping * damping).sqrt();
            amplitude * (-damping * omega * t).exp() * (damped * t + phase).cos()
        };
        modes.iter().map(part).sum()
    };
    let values = times.iter().map(value).collect();
    Signal { times, values }
}

fn power(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64
}

/// White noise, so that the mean power of the whole signal stands `decibel` above it.
fn noisy(mut signal: Signal, decibel: f64, random: &mut Random) -> Signal {
    let sigma = (power(&signal.values) / 10_f64.powf(0.1 * decibel)).sqrt();
    for value in &mut signal.values {
        *value += random.normal(sigma);
    }
    signal
}

#[test]
fn random_signals_within_the_figures_asked_for() {
    const SIGNALS: u32 = 200;
    let mut random = Random(7);
    let (mut good, mut alone, mut frequency_worst, mut damping_worst) = (0, 0, 0.0_f64, 0.0_f64);
    let mut squares = [0.0; 2];
    for _ in 0..SIGNALS {
        let (frequency, damping) = (random.uniform(2.0, 60.0), random.uniform(0.005, 0.1));
        let truth = (frequency, damping, random.log_uniform(0.01, 100.0), random.uniform(0.0, TAU));
        let found = identify(&noisy(clean(&[truth]), 20.0, &mut random)).unwrap();
        alone += u32::from(found.modes.len() == 1);
        let mode = found.modes[0];
        let (f, d) = ((mode.frequency_hz / frequency - 1.0).abs(), (mode.damping / damping - 1.0).abs());
        good += u32::from(f <= 2e-3 && d <= 0.05);
        frequency_worst = frequency_worst.max(f);
        damping_worst = damping_worst.max(d);
        squares[0] += ((mode.frequency_hz - frequency) / mode.frequency_std_hz).powi(2);
        squares[1] += ((mode.damping - damping) / mode.damping_std).powi(2);
    }
    println!("{good} of {SIGNALS} within; one mode in {alone}; worst {frequency_worst:e}, {damping_worst:e}");
    assert!(f64::from(good) >= 0.95 * f64::from(SIGNALS), "{good}");
    assert!(alone >= SIGNALS - 2, "{alone}");
    // Errors are as large as they are said to be.
    for square in squares {
        let ratio = (square / f64::from(SIGNALS)).sqrt();
        println!("error over its standard deviation: {ratio}");
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }
}

#[test]
fn the_documents_mode() {
    let mut random = Random(1);
    let signal = noisy(clean(&[(6.34, 0.022, 0.7, 0.4)]), 20.0, &mut random);
    let mode = identify(&signal).unwrap().modes[0];
    assert!((mode.frequency_hz / 6.34 - 1.0).abs() < 2e-3 && (mode.damping / 0.022 - 1.0).abs() < 0.05);
    assert!((mode.amplitude / 0.7 - 1.0).abs() < 0.05);
}

#[test]
fn several_modes_strongest_first() {
    let mut random = Random(9);
    for _ in 0..10 {
        let truths = [
            (random.uniform(4.0, 8.0), random.uniform(0.01, 0.04), 1.0, random.uniform(0.0, TAU)),
            (random.uniform(11.0, 16.0), random.uniform(0.01, 0.04), 0.5, random.uniform(0.0, TAU)),
            (random.uniform(25.0, 50.0), random.uniform(0.005, 0.02), 0.25, random.uniform(0.0, TAU)),
        ];
        let found = identify(&noisy(clean(&truths), 30.0, &mut random)).unwrap();
        assert_eq!(found.modes.len(), 3, "{truths:?} {found:?}");
        for (mode, (frequency, damping, amplitude, _)) in found.modes.iter().zip(truths) {
            assert!((mode.frequency_hz / frequency - 1.0).abs() < 2e-3, "{mode:?} {frequency}");
            assert!((mode.damping / damping - 1.0).abs() < 0.1, "{mode:?} {damping}");
            // The amplitude is that where the fit begins.
            let there = amplitude * (-damping * TAU * frequency * found.start).exp();
            assert!((mode.amplitude / there - 1.0).abs() < 0.1, "{mode:?} {there}");
        }
    }
}

/// Two modes closer than a bin of the spectrum (1/3 Hz) are still two.
#[test]
fn modes_within_one_bin() {
    let mut random = Random(4);
    let truths = [(10.0, 0.004, 1.0, 0.3), (10.3, 0.004, 0.8, 1.9)];
    let found = identify(&noisy(clean(&truths), 40.0, &mut random)).unwrap();
    assert_eq!(found.modes.len(), 2, "{found:?}");
    let mut frequencies: Vec<_> = found.modes.iter().map(|mode| mode.frequency_hz).collect();
    frequencies.sort_by(f64::total_cmp);
    assert!((frequencies[0] - 10.0).abs() < 0.02 && (frequencies[1] - 10.3).abs() < 0.02, "{frequencies:?}");
}

#[test]
fn an_offset_and_a_silent_beginning_do_not_matter() {
    let mut random = Random(2);
    let mut signal = clean(&[(8.0, 0.03, 1.0, 0.0)]);
    signal.values.rotate_right(700);
    signal.values[..700].fill(0.0);
    let mut signal = noisy(signal, 20.0, &mut random);
    for value in &mut signal.values {
        *value += 9.81;
    }
    let found = identify(&signal).unwrap();
    assert!((found.start - 0.7).abs() < 0.02, "{}", found.start);
    let mode = found.modes[0];
    assert!(
        (mode.frequency_hz / 8.0 - 1.0).abs() < 2e-3 && (mode.damping / 0.03 - 1.0).abs() < 0.05,
        "{mode:?}"
    );
    assert_eq!(found.fitted.len(), signal.times.iter().filter(|t| **t >= found.start).count());
}

#[test]
fn noise_alone_has_no_mode() {
    let mut random = Random(3);
    for _ in 0..50 {
        let times: Vec<f64> = (0..1000_u32).map(|n| f64::from(n) * 1e-3).collect();
        let values = times.iter().map(|_| random.normal(1.0)).collect();
        assert_eq!(identify(&Signal { times, values }), Err(IdentifyError::NoVibration));
    }
    let silent = Signal { times: (0..100).map(f64::from).collect(), values: vec![0.0; 100] };
    assert_eq!(identify(&silent), Err(IdentifyError::NoVibration));
}

#[test]
fn bad_signals_are_refused() {
    let signal = clean(&[(8.0, 0.03, 1.0, 0.0)]);
    let short = Signal { times: signal.times[..5].to_vec(), values: signal.values[..5].to_vec() };
    assert_eq!(identify(&short), Err(IdentifyError::TooShort { samples: 5 }));
    let mut gap = signal.clone();
    for time in &mut gap.times[100..] {
        *time += 0.1;
    }
    assert!(matches!(identify(&gap), Err(IdentifyError::Uneven { sample: 100, .. })));
    let mut hole = signal;
    hole.values[17] = f64::NAN;
    assert_eq!(identify(&hole), Err(IdentifyError::NotFinite { sample: 17 }));
}

#[test]
fn csv_is_read_and_mistakes_are_named_with_their_line() {
    let signal = read_signal("time_s, acceleration\n# a remark\n0.0, 1.5\n\n0.001, -2e-3\n").unwrap();
    assert_eq!(signal, Signal { times: vec![0.0, 0.001], values: vec![1.5, -2e-3] });
    assert_eq!(read_signal("0,1\n1,2").unwrap().times.len(), 2);
    let line = |text: &str| match read_signal(text) {
        Err(CsvError::Line { line, .. } | CsvError::Time { line, .. }) => line,
        other => panic!("{other:?}"),
    };
    assert_eq!(line("time_s, acceleration\n0, 1\n0.1, x\n"), 3);
    assert_eq!(line("0, 1\ntime_s, acceleration\n"), 2);
    assert_eq!(line("time, a\nother, words\n"), 2);
    assert_eq!(line("0, 1\n0.1, 2, 3\n"), 2);
    assert_eq!(line("0, 1\n0.1\n"), 2);
    assert_eq!(line("0, 1\n0.1, inf\n"), 2);
    assert_eq!(line("0, 1\n0.1, 2\n0.1, 3\n"), 3);
    assert_eq!(read_signal("time_s, acceleration\n"), Err(CsvError::Empty));
}
