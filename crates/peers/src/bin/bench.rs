//! `bench [INPUTS] [PASSES]`: time per calculation, ours and the peers', same inputs, one process.
//! `bench worst [INPUTS] [PASSES]`: six axes, position control, ours and the C++ peer's, for as many inputs as one likes.
//!
//! Each input is timed on its own; of all passes the least counts, so that what other programs do to the machine does not. The C++ peer
//! is timed inside (its own clock around the calculation), without its binding.

use std::hint::black_box;
use std::time::Instant;

use seamline::otg::{
    Control, Generator, Input, Output, State, Synchronization, Trajectory, calculate, calculate_into,
};
use seamline_peers::otg_support::cases::{Distribution, random_input};
use seamline_peers::otg_support::random::Random;
use seamline_peers::{RsRuckig, Ruckig};

struct Times {
    mean: f64,
    p999: f64,
    worst: f64,
}

fn summary(mut least: Vec<f64>) -> Times {
    least.sort_by(f64::total_cmp);
    let mean = least.iter().sum::<f64>() / least.len() as f64;
    let at = |share: f64| least[((least.len() - 1) as f64 * share) as usize];
    Times { mean, p999: at(0.999), worst: at(1.0) }
}

/// Calculations before each pass that are not read: they would be those that find another side's program in the caches.
const WARMING: usize = 20;

/// Lowers the readings to those of one more pass, where they are less.
fn pass<T>(least: &mut [f64], inputs: &mut [T], mut run: impl FnMut(&mut T) -> f64) {
    for input in inputs.iter_mut().take(WARMING) {
        run(input);
    }
    for (least, input) in least.iter_mut().zip(inputs) {
        *least = least.min(run(input));
    }
}

fn clocked(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_nanos() as f64
}

/// The least of several readings of each input, ours, the C++ peer's and its port's. The passes take turns, so that all sides are read in the
/// same stretch of time.
fn readings<const N: usize>(inputs: &mut [Input<N>], passes: usize, with_port: bool) -> [Vec<f64>; 3] {
    let mut least = [(); 3].map(|()| vec![f64::INFINITY; inputs.len()]);
    let [ours, cpp, port] = &mut least;
    let (mut trajectory, mut peer, mut other) =
        (Trajectory::default(), Ruckig::new(N), RsRuckig::<N>::default());
    for _ in 0..passes {
        pass(ours, inputs, |input| {
            clocked(|| {
                let _ = black_box(calculate_into(black_box(input), &mut trajectory));
            })
        });
        pass(cpp, inputs, |input| {
            peer.set(input);
            peer.timed()
        });
        if with_port {
            pass(port, inputs, |input| {
                other.set(input);
                clocked(|| {
                    black_box(other.run());
                })
            });
        }
    }
    least
}

fn report(name: &str, axes: usize, peer: &str, ours: &Times, times: &Times) {
    println!(
        "{name:32} {axes} {peer:5} ours {:7.0} {:7.0} {:7.0} ns | peer {:7.0} {:7.0} {:7.0} ns | ratio {:.3} {:.3} {:.3}",
        ours.mean,
        ours.p999,
        ours.worst,
        times.mean,
        times.p999,
        times.worst,
        ours.mean / times.mean,
        ours.p999 / times.p999,
        ours.worst / times.worst
    );
}

fn bench<const N: usize>(name: &str, mut inputs: Vec<Input<N>>, passes: usize) {
    let [ours, cpp, port] = readings(&mut inputs, passes, true).map(summary);
    report(name, N, "C++", &ours, &cpp);
    report(name, N, "port", &ours, &port);
}

/// The worst single calculation of many, which are drawn in chunks.
fn worst(count: usize, passes: usize) {
    const CHUNK: usize = 2000;
    let mut random = Random(2027);
    let (mut own, mut peers) = (Vec::new(), Vec::new());
    while own.len() < count {
        let size = CHUNK.min(count - own.len());
        let mut inputs = draw(&mut random, size, Distribution::PeerTest, |_: &mut Input<6>| {});
        let [ours, cpp, _] = readings(&mut inputs, passes, false);
        own.extend(ours);
        peers.extend(cpp);
    }
    report("position", 6, "C++", &summary(own), &summary(peers));
}

fn symmetric<const N: usize>(
    count: usize,
    distribution: Distribution,
    change: impl Fn(&mut Input<N>),
) -> Vec<Input<N>> {
    draw(&mut Random(2026), count, distribution, change)
}

/// Random inputs whose limits are the same in both directions, as the C++ peer's binding has them.
fn draw<const N: usize>(
    random: &mut Random,
    count: usize,
    distribution: Distribution,
    change: impl Fn(&mut Input<N>),
) -> Vec<Input<N>> {
    let mut inputs = Vec::new();
    while inputs.len() < count {
        let mut input: Input<N> = random_input(random, distribution);
        if input.limits.velocity_min == input.limits.velocity_max.map(|v| -v)
            && input.limits.acceleration_min == input.limits.acceleration_max.map(|a| -a)
        {
            change(&mut input);
            inputs.push(input);
        }
    }
    inputs
}

/// Nanoseconds of an update on which nothing is planned anew, the least mean of 20 runs of 500.
fn update(input: &Input<6>) -> f64 {
    let mut input = *input;
    let duration = calculate(&input).map_or(1.0, |trajectory| trajectory.duration());
    let (mut generator, mut output) = (Generator::new(duration / 10_100.0), Output::default());
    let mut least = f64::INFINITY;
    for _ in 0..20 {
        let start = Instant::now();
        for _ in 0..500 {
            let _ = black_box(generator.update(black_box(&input), &mut output));
            output.pass_to_input(&mut input);
        }
        least = least.min(start.elapsed().as_nanos() as f64 / 500.0);
    }
    least
}

fn main() {
    let only_worst = std::env::args().nth(1).is_some_and(|argument| argument == "worst");
    let argument =
        |index: usize| std::env::args().nth(index + usize::from(only_worst)).and_then(|n| n.parse().ok());
    let count = argument(1).unwrap_or(5000);
    let passes = argument(2).unwrap_or(9);
    println!("mean, p99.9, worst of {count} inputs, each the least of {passes} readings");
    if only_worst {
        return worst(count, passes);
    }
    let same = |_: &mut _| {};
    bench::<1>("position", symmetric(count, Distribution::PeerTest, same), passes);
    bench::<3>("position", symmetric(count, Distribution::PeerTest, |_| {}), passes);
    bench::<6>("position", symmetric(count, Distribution::PeerTest, |_| {}), passes);
    bench::<7>("position", symmetric(count, Distribution::PeerTest, |_| {}), passes);
    bench::<7>(
        "position, none",
        symmetric(count, Distribution::PeerTest, |i: &mut Input<7>| {
            i.synchronization = [Synchronization::None; 7];
        }),
        passes,
    );
    bench::<6>("robot", symmetric(count, Distribution::Robot, |_| {}), passes);
    bench::<6>(
        "robot, rest to rest",
        symmetric(count, Distribution::Robot, |i: &mut Input<6>| {
            i.current = State::at_rest(i.current.position);
            i.target = State::at_rest(i.target.position);
        }),
        passes,
    );
    bench::<6>(
        "velocity control",
        symmetric(count, Distribution::PeerTest, |i: &mut Input<6>| {
            i.control = [Control::Velocity; 6];
        }),
        passes,
    );
    let updates = symmetric(20, Distribution::Robot, |_| {});
    let mean = updates.iter().map(update).sum::<f64>() / updates.len() as f64;
    println!("update and pass_to_input, nothing changed, 6 axes: {mean:.0} ns");
}
