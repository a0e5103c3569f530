//! Each prefilter against a simulated mode: the oscillator is integrated, the step through the kernel averaged numerically.

use seamline::otg::{Control, Input, Limits, State, calculate};
use seamline::vibration::{
    Impulse, Kernel, KernelError, MAX_IMPULSES, MAX_RECTANGLES, Mode, Prefilter, Ramp, RampError, RampPiece,
};
use std::f64::consts::TAU;

fn mode(frequency: f64, damping: f64) -> Mode {
    Mode::try_new(TAU * frequency, damping).expect("a mode")
}

/// The step through the kernel, by its definition: rectangles are averaged numerically, one after the other.
fn step(kernel: &Kernel, rectangles: &[f64], time: f64) -> f64 {
    const PARTS: u32 = 200;
    let Some((duration, rest)) = rectangles.split_first() else {
        return kernel.impulses().iter().filter(|i| i.time <= time).map(|i| i.weight).sum();
    };
    let part = duration / f64::from(PARTS);
    let sum: f64 = (0..PARTS).map(|n| step(kernel, rest, time - (f64::from(n) + 0.5) * part)).sum();
    sum / f64::from(PARTS)
}

/// The mode's motion under a command, by Runge's and Kutta's method: samples of (time, position), and the amplitude at the end.
fn simulate(mode: &Mode, command: impl Fn(f64) -> f64, end: f64) -> (Vec<(f64, f64)>, f64) {
    const STEPS: u32 = 20_000;
    let (w, z) = (mode.omega(), mode.damping());
    let h = end / f64::from(STEPS);
    let acceleration = |x: f64, v: f64, u: f64| w * w * (u - x) - 2.0 * z * w * v;
    let (mut x, mut v) = (0.0, 0.0);
    let mut samples = Vec::new();
    for n in 0..STEPS {
        let t = h * f64::from(n);
        // Inside the step: a command that jumps does so between two steps.
        let (u1, u2, u3) = (command(t + 1e-9 * h), command(t + 0.5 * h), command(t + h - 1e-9 * h));
        let (k1x, k1v) = (v, acceleration(x, v, u1));
        let (k2x, k2v) = (v + 0.5 * h * k1v, acceleration(x + 0.5 * h * k1x, v + 0.5 * h * k1v, u2));
        let (k3x, k3v) = (v + 0.5 * h * k2v, acceleration(x + 0.5 * h * k2x, v + 0.5 * h * k2v, u2));
        let (k4x, k4v) = (v + h * k3v, acceleration(x + h * k3x, v + h * k3v, u3));
        x += h / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
        v += h / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
        samples.push((t + h, x));
    }
    let damped = w * (1.0 - z * z).sqrt();
    let quadrature = (v + z * w * (x - 1.0)) / damped;
    (samples, (x - 1.0).hypot(quadrature))
}

#[test]
fn a_ramp_is_the_kernel_averaged_numerically() {
    let fir_zvd = Prefilter::FirZvd.kernel(&mode(6.34, 0.022)).unwrap();
    let two = Prefilter::FirZv.for_modes(&[mode(6.34, 0.022), mode(11.0, 0.05)]).unwrap();
    for kernel in [fir_zvd, two, Prefilter::ThreeHumpEi.kernel(&mode(3.0, 0.1)).unwrap()] {
        let ramp = Ramp::from_kernel(&kernel).unwrap();
        assert!((ramp.duration() - kernel.length()).abs() < 1e-14);
        let (mut area, parts) = (0.0, 500_u32);
        let part = kernel.length() / f64::from(parts);
        for n in 0..parts {
            let time = (f64::from(n) + 0.5) * part;
            let expected = step(&kernel, kernel.rectangles(), time);
            let tolerance = if kernel.rectangles().is_empty() { 1e-14 } else { 4e-3 };
            assert!((ramp.value(time) - expected).abs() < tolerance, "{time}");
            area += part * ramp.value(time);
        }
        assert!((ramp.integral(kernel.length()) - area).abs() < 1e-3 * area);
        // A constant rate lags by the kernel's centre.
        assert!((kernel.length() - ramp.integral(kernel.length()) - kernel.delay()).abs() < 1e-14);
        assert!((ramp.remaining(0.0) - kernel.delay()).abs() < 1e-14);
    }
}

#[test]
fn the_response_of_a_mode_is_that_of_the_simulated_oscillator() {
    let model = mode(1.0, 0.1);
    for prefilter in Prefilter::ALL {
        let kernel = prefilter.kernel(&model).unwrap();
        for actual in [mode(1.0, 0.1), mode(1.23, 0.04)] {
            // The simulation ends with the kernel, on a step of its own.
            let end = kernel.length().max(1.0);
            let ramp = Ramp::from_kernel(&kernel).unwrap();
            let (samples, amplitude) = simulate(&actual, |t| ramp.value(t), end);
            // Impulses fall inside the integrator's steps: an error of the order of a step.
            for (time, x) in samples.iter().step_by(500) {
                let ours = kernel.mode_response(&actual, *time);
                assert!((ours - x).abs() < 2e-3, "{prefilter} at {time}: {ours} {x}");
            }
            let (_, bare) = simulate(&actual, |_| 1.0, 1e-6);
            let decay = (actual.pole().re * (end - kernel.length())).exp();
            let residual = amplitude / bare / decay;
            let ours = kernel.residual_vibration(&actual);
            assert!((ours - residual).abs() < 2e-3, "{prefilter}: {ours} {residual}");
        }
    }
}

#[test]
fn an_s_curve_is_the_generators() {
    for (feedrate, acceleration, jerk) in [(0.2, 1.0, 10.0), (0.2, 1.0, 3.0), (0.3, 2.0, f64::INFINITY)] {
        let ramp = Ramp::s_curve(feedrate, acceleration, jerk).unwrap();
        let limits = Limits::symmetric([1.0], [acceleration], [jerk]);
        let target = State { velocity: [feedrate], ..State::default() };
        let mut input = Input::new(State::default(), target, limits);
        input.control = [Control::Velocity];
        let generated = calculate(&input).unwrap();
        assert!((ramp.duration() - generated.duration()).abs() < 1e-12);
        for n in 0..=40 {
            let time = f64::from(n) / 40.0 * ramp.duration();
            let sample = generated.at_time(time);
            assert!((feedrate * ramp.value(time) - sample.velocity[0]).abs() < 1e-12, "{time}");
            assert!((feedrate * ramp.integral(time) - sample.position[0]).abs() < 1e-12, "{time}");
        }
    }
    assert!(Ramp::s_curve(0.0, 1.0, 1.0).is_err());
}

#[test]
fn what_each_prefilter_promises_at_its_own_mode() {
    for damping in [0.0, 0.022, 0.1] {
        let model = mode(6.34, damping);
        let left = |prefilter: Prefilter| prefilter.kernel(&model).unwrap().residual_vibration(&model);
        let silent = [
            Prefilter::Zv,
            Prefilter::Zvd,
            Prefilter::FirZv,
            Prefilter::FirZvd,
            Prefilter::Mzv,
            // Between its two humps.
            Prefilter::TwoHumpEi,
        ];
        for exact in silent {
            assert!(left(exact) < 1e-12, "{exact} {}", left(exact));
        }
        // An odd number of humps has one in the middle: it touches the tolerance, less what damping takes.
        for humped in [Prefilter::Ei, Prefilter::ThreeHumpEi] {
            assert!(left(humped) < 0.0502 && left(humped) > 0.01, "{humped} {}", left(humped));
        }
        assert!((left(Prefilter::None) - 1.0).abs() < 1e-12);
    }
    assert!(Prefilter::Fir.kernel(&mode(6.34, 0.0)).unwrap().residual_vibration(&mode(6.34, 0.0)) < 1e-12);
}

/// Widths in frequency ratio where an undamped mode keeps 95 % quiet, as the literature gives them: ZV 0.06, ZVD 0.29, EI 0.40, 2HUMP-EI 0.73,
/// 3HUMP-EI 0.95.
#[test]
fn insensitivity_is_that_of_the_literature() {
    let widths = [
        (Prefilter::Zv, 0.06),
        (Prefilter::Zvd, 0.29),
        (Prefilter::Ei, 0.40),
        (Prefilter::TwoHumpEi, 0.73),
        (Prefilter::ThreeHumpEi, 0.95),
    ];
    for (prefilter, width) in widths {
        let kernel = prefilter.kernel(&mode(1.0, 0.0)).unwrap();
        let quiet = |ratio: f64| kernel.residual_vibration(&mode(ratio, 0.0)) < 0.0501;
        let ours = (4000..16_000).filter(|n| quiet(f64::from(*n) * 1e-4)).count() as f64 * 1e-4;
        assert!((ours - width).abs() < 0.016, "{prefilter}: {ours}, expected {width}");
    }
}

/// What the document says about figures 4 and 5.
#[test]
fn the_frequency_response_has_its_crests_and_troughs_where_the_document_says() {
    let model = mode(1.0, 0.0);
    let gain = |prefilter: Prefilter, ratio: f64| prefilter.kernel(&model).unwrap().gain(TAU * ratio);
    for harmonic in [2.0, 4.0, 6.0] {
        assert!((gain(Prefilter::Zv, harmonic) - 1.0).abs() < 1e-12);
        assert!((gain(Prefilter::Zvd, harmonic) - 1.0).abs() < 1e-12);
        assert!(gain(Prefilter::Zvd, harmonic - 1.0) < 1e-12);
        assert!(gain(Prefilter::FirZvd, harmonic) < 1e-12);
    }
    assert!(gain(Prefilter::Fir, 1.5) < 0.22 && gain(Prefilter::Fir, 2.5) < 0.13);
    for prefilter in Prefilter::ALL {
        assert!((gain(prefilter, 0.0) - 1.0).abs() < 1e-12, "{prefilter}");
        // Across the place where the series of a rectangle takes over.
        let (below, above) = (gain(prefilter, 1.591e-4), gain(prefilter, 1.592e-4));
        assert!((below - above).abs() < 1e-9, "{prefilter}");
    }
}

#[test]
fn two_modes_are_both_silent() {
    let modes = [mode(6.34, 0.022), mode(14.2, 0.01)];
    for prefilter in [Prefilter::Zv, Prefilter::Zvd, Prefilter::FirZv, Prefilter::FirZvd, Prefilter::Mzv] {
        let kernel = prefilter.for_modes(&modes).unwrap();
        for mode in &modes {
            assert!(kernel.residual_vibration(mode) < 1e-12, "{prefilter}");
        }
        let length: f64 = modes.iter().map(|mode| prefilter.kernel(mode).unwrap().length()).sum();
        assert!((kernel.length() - length).abs() < 1e-14);
        assert!(Ramp::from_kernel(&kernel).is_ok(), "{prefilter}");
    }
}

#[test]
fn names_go_both_ways() {
    for prefilter in Prefilter::ALL {
        assert_eq!(Prefilter::from_name(&prefilter.name().to_lowercase()), Some(prefilter));
    }
    assert_eq!(Prefilter::from_name("boxcar"), None);
}

#[test]
fn bad_kernels_and_ramps_are_refused() {
    assert!(Mode::try_new(0.0, 0.1).is_err());
    assert!(Mode::try_new(f64::NAN, 0.1).is_err());
    assert!(Mode::try_new(1.0, -0.1).is_err());
    assert!(Mode::try_new(1.0, 1.0).is_err());
    assert!(matches!(Kernel::rectangle(-1.0), Err(KernelError::Rectangle { .. })));
    assert!(matches!(Kernel::from_impulses(&[]), Err(KernelError::ImpulseCount { count: 0 })));
    let bad = Impulse { time: -1.0, weight: 1.0 };
    assert!(matches!(Kernel::from_impulses(&[bad]), Err(KernelError::Impulse { .. })));
    let many: Vec<_> = (0..=MAX_IMPULSES).map(|n| Impulse { time: n as f64, weight: 1.0 }).collect();
    assert!(matches!(Kernel::from_impulses(&many), Err(KernelError::ImpulseCount { .. })));
    let modes = [mode(1.0, 0.1); MAX_RECTANGLES + 1];
    assert!(matches!(Prefilter::Fir.for_modes(&modes), Err(KernelError::RectangleCount { .. })));

    let piece = |coefficients| RampPiece { duration: 1.0, coefficients };
    let falling = [piece([1.0, -0.5, 0.0, 0.0])];
    assert!(matches!(Ramp::from_pieces(&falling), Err(RampError::Piece { index: 0 })));
    let short = [piece([0.0, 0.5, 0.0, 0.0])];
    assert!(matches!(Ramp::from_pieces(&short), Err(RampError::End { .. })));
    assert!(Ramp::from_pieces(&[piece([0.0, 1.0, 0.0, 0.0])]).is_ok());
}
