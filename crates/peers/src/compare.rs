//! Durations against the peers', case by case: against the C++ one where the limits are symmetric, otherwise against its port.

use crate::otg_support::cases::{Distribution, random_input};
use crate::otg_support::judge::judge;
use crate::otg_support::random::Random;
use crate::{RsRuckig, Ruckig, keeps_limits};
use seamline::otg::{Control, Input, Synchronization, calculate};

/// What came out of a comparison.
#[derive(Debug, Default)]
pub struct Tally {
    pub cases: u64,
    /// The peer has no trajectory.
    pub peer_failed: u64,
    /// We have none.
    pub ours_failed: u64,
    /// Ours does not satisfy the judge.
    pub invalid: u64,
    /// Ours takes longer, by more than 1e-9.
    pub longer: u64,
    /// As `longer`, but by less than 1e-7 in a problem of whole numbers: at an exact double root, the peer's tolerance takes it a little early.
    pub at_double_root: u64,
    /// The peer is shorter, but not at the target when it says so, or it passes its jerk or velocity limits on the way.
    pub peer_misses: u64,
    /// Ours is shorter, by more than 1e-9 (and valid).
    pub shorter: u64,
    /// The first few bad cases.
    pub examples: Vec<String>,
}

impl Tally {
    fn note(&mut self, what: String) {
        if self.examples.len() < 5 {
            self.examples.push(what);
        }
    }

    pub fn is_good(&self) -> bool {
        self.ours_failed == 0 && self.invalid == 0 && self.longer == 0
    }
}

/// Compares random problems of one distribution, synchronized in time.
pub fn compare<const N: usize>(distribution: Distribution, control: Control, seed: u64, cases: u64) -> Tally {
    let mut cpp = Ruckig::new(N);
    let mut port = RsRuckig::<N>::default();
    let mut random = Random(seed);
    let mut tally = Tally::default();
    for _ in 0..cases {
        let mut input: Input<N> = random_input(&mut random, distribution);
        input.control = [control; N];
        // On ties the C++ peer writes beyond its list of profiles and crashes; its port is safe.
        let symmetric = distribution != Distribution::Whole
            && input.limits.velocity_min == input.limits.velocity_max.map(|v| -v)
            && input.limits.acceleration_min == input.limits.acceleration_max.map(|a| -a);
        tally.cases += 1;
        let ours = match calculate(&input) {
            Ok(ours) => ours,
            Err(error) => {
                tally.ours_failed += 1;
                tally.note(format!("{error}\n{input:?}"));
                continue;
            }
        };
        let verdict = judge(&input, &ours, input.synchronization[0] == Synchronization::Time);
        if !verdict.is_good() {
            tally.invalid += 1;
            tally.note(format!("{verdict:?}\n{input:?}"));
        }
        let peer = if symmetric { cpp.calculate(&input) } else { port.calculate(&input) };
        let peer_keeps_limits = |input: &Input<N>, duration| {
            if symmetric {
                keeps_limits(input, duration, |time| cpp.at_time(time))
            } else {
                keeps_limits(input, duration, |time| port.at_time(time))
            }
        };
        let Some(peer) = peer else {
            tally.peer_failed += 1;
            continue;
        };
        let ratio = ours.duration() / peer.duration;
        if ratio < 1.0 - 1e-9 {
            tally.shorter += 1;
        } else if ratio > 1.0 + 1e-9 && (peer.miss > 1e-8 || !peer_keeps_limits(&input, peer.duration)) {
            tally.peer_misses += 1;
        } else if ratio > 1.0 + 1e-9 && ratio < 1.0 + 1e-7 && distribution == Distribution::Whole {
            tally.at_double_root += 1;
        } else if ratio > 1.0 + 1e-9 {
            tally.longer += 1;
            tally.note(format!("{} s, peer {peer:?}\n{input:?}", ours.duration()));
        }
    }
    tally
}
