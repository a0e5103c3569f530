//! Random problems of every distribution, each trajectory judged by integration.

mod otg_support;

use otg_support::cases::{self, random_input};
use otg_support::judge::{Verdict, judge};
use otg_support::random::Random;
use seamline::otg::{Synchronization, calculate};

fn sweep<const N: usize>(cases: usize, synchronization: Synchronization) {
    for distribution in cases::ALL {
        let mut random = Random(1);
        let mut worst = Verdict::default();
        let mut bad = 0;
        for case in 0..cases {
            let before = random.clone();
            let mut input = random_input::<N>(&mut random, distribution);
            input.synchronization = [synchronization; N];
            let trajectory = match calculate(&input) {
                Ok(trajectory) => trajectory,
                Err(error) => {
                    bad += 1;
                    if bad < 4 {
                        println!("{distribution:?} {case} {before:?}: {error}\n{input:?}");
                    }
                    continue;
                }
            };
            let verdict = judge(&input, &trajectory, synchronization == Synchronization::Time);
            if !verdict.is_good() {
                bad += 1;
                if bad < 3 {
                    println!("{distribution:?} {case} {before:?}: {verdict:?}");
                }
            }
            worst.worst(&verdict);
        }
        assert_eq!(bad, 0, "{distribution:?}: {worst:?}");
    }
}

#[test]
fn single_axis() {
    sweep::<1>(20_000, Synchronization::None);
}

#[test]
fn six_axes() {
    sweep::<6>(5_000, Synchronization::Time);
}
