//! `compare [CASES]`: durations against the peers, for every distribution, symmetric limits against C++, asymmetric ones against the port.

use seamline::otg::{Input, Synchronization, calculate};
use seamline_peers::otg_support::cases::{ALL, Distribution, random_input};
use seamline_peers::otg_support::judge::judge;
use seamline_peers::otg_support::random::Random;
use seamline_peers::{Answer, RsRuckig, Ruckig};

#[derive(Default)]
struct Tally {
    cases: u64,
    peer_failed: u64,
    ours_failed: u64,
    invalid: u64,
    longer: u64,
    peer_short_but_missed: u64,
    shorter: u64,
}

fn compare<const N: usize>(
    distribution: Distribution,
    cases: u64,
    synchronization: Synchronization,
    show: &mut u32,
) -> Tally {
    let mut cpp = Ruckig::new(N);
    let mut port = RsRuckig::<N>::default();
    let mut random = Random(7 + N as u64);
    let mut tally = Tally::default();
    for _ in 0..cases {
        let mut input: Input<N> = random_input(&mut random, distribution);
        input.synchronization = [synchronization; N];
        // On ties the C++ peer writes beyond its list of profiles and crashes; its port is safe.
        let symmetric = distribution != Distribution::Whole
            && (0..N).all(|i| {
                input.limits.velocity_min[i] == -input.limits.velocity_max[i]
                    && input.limits.acceleration_min[i] == -input.limits.acceleration_max[i]
            });
        let peer: Option<Answer> = if symmetric { cpp.calculate(&input) } else { port.calculate(&input) };
        tally.cases += 1;
        let ours = match calculate(&input) {
            Ok(ours) => ours,
            Err(error) => {
                tally.ours_failed += 1;
                if *show > 0 {
                    *show -= 1;
                    println!("{error}: {input:?}");
                }
                continue;
            }
        };
        let verdict = judge(&input, &ours, synchronization == Synchronization::Time);
        if !verdict.is_good() {
            tally.invalid += 1;
            if *show > 0 {
                *show -= 1;
                println!("{distribution:?} {N} invalid: {verdict:?} {input:?}");
            }
        }
        let Some(peer) = peer else {
            tally.peer_failed += 1;
            continue;
        };
        let ratio = ours.duration() / peer.duration;
        if ratio > 1.0 + 1e-9 {
            if peer.miss > 1e-8 {
                tally.peer_short_but_missed += 1;
            } else {
                tally.longer += 1;
                if *show > 0 {
                    *show -= 1;
                    println!(
                        "{distribution:?} {N} longer: ours {} peer {peer:?} own {:?} {input:?}",
                        ours.duration(),
                        ours.duration_min()
                    );
                }
            }
        } else if ratio < 1.0 - 1e-9 {
            tally.shorter += 1;
        }
    }
    tally
}

fn main() {
    let cases: u64 = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(100_000);
    let mut show: u32 = std::env::args().nth(2).and_then(|n| n.parse().ok()).unwrap_or(0);
    println!(
        "distribution, axes: cases, peer failed, ours failed, invalid, longer, peer shorter but off target, shorter"
    );
    let only = std::env::args().nth(3).and_then(|n| n.parse::<usize>().ok());
    for (index, distribution) in ALL.into_iter().enumerate() {
        if only.is_some_and(|only| only != index) {
            continue;
        }
        for (axes, tally) in [
            (1, compare::<1>(distribution, cases, Synchronization::Time, &mut show)),
            (3, compare::<3>(distribution, cases / 3, Synchronization::Time, &mut show)),
            (6, compare::<6>(distribution, cases / 6, Synchronization::Time, &mut show)),
        ] {
            let Tally { cases, peer_failed, ours_failed, invalid, longer, peer_short_but_missed, shorter } =
                tally;
            println!(
                "{distribution:?}, {axes}: {cases}, {peer_failed}, {ours_failed}, {invalid}, {longer}, {peer_short_but_missed}, {shorter}"
            );
        }
    }
}
