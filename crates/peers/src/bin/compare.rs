//! `compare [CASES] [SEED]`: durations against the peers', for every distribution. CASES are those of one axis; with three and six axes there are
//! a third and a sixth as many, in velocity control a tenth.

use seamline::otg::Control;
use seamline_peers::compare::{Tally, compare};
use seamline_peers::otg_support::cases::{ALL, Distribution};

fn row(distribution: Distribution, what: &str, tally: &Tally) {
    let t = tally;
    println!(
        "{:12} {what:12} {:>9} {:>9} {:>7} {:>8} {:>7} {:>7} {:>7} {:>8}",
        format!("{distribution:?}"),
        t.cases,
        t.peer_failed,
        t.ours_failed,
        t.invalid,
        t.longer,
        t.at_double_root,
        t.peer_misses,
        t.shorter
    );
    for example in &t.examples {
        println!("    {example}");
    }
}

fn main() {
    let number = |index| std::env::args().nth(index).and_then(|n| n.parse().ok());
    let cases: u64 = number(1).unwrap_or(100_000);
    let seed: u64 = number(2).unwrap_or(7);
    println!(
        "{:25} {:>9} {:>9} {:>7} {:>8} {:>7} {:>7} {:>7} {:>8}",
        "", "cases", "peer err", "err", "invalid", "longer", "ties", "misses", "shorter"
    );
    for distribution in ALL {
        row(distribution, "1 axis", &compare::<1>(distribution, Control::Position, seed, cases));
        row(distribution, "3 axes", &compare::<3>(distribution, Control::Position, seed, cases / 3));
        row(distribution, "6 axes", &compare::<6>(distribution, Control::Position, seed, cases / 6));
        row(distribution, "velocity, 3", &compare::<3>(distribution, Control::Velocity, seed, cases / 10));
    }
}
