//! Fuzzes the trajectory generator: whatever the numbers, no panic and no NaN; with numbers of a size that machines have, every answer
//! must satisfy the judge.
#![no_main]

#[path = "../../core/tests/otg_support/mod.rs"]
mod otg_support;

use libfuzzer_sys::fuzz_target;
use otg_support::judge::judge;
use seamline::otg::{Control, Input, Limits, State, Synchronization, calculate};

/// Reads numbers from bytes; zeros when there are none left.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const K: usize>(&mut self) -> [u8; K] {
        let mut bytes = [0; K];
        for byte in &mut bytes {
            if let Some((first, rest)) = self.0.split_first() {
                (*byte, self.0) = (*first, rest);
            }
        }
        bytes
    }

    /// Any number at all, or one of a grid: quarters up to ±32, where ties are frequent.
    fn number(&mut self, wild: bool) -> f64 {
        if wild { f64::from_le_bytes(self.take()) } else { f64::from(self.take::<1>()[0] as i8) / 4.0 }
    }
}

const N: usize = 2;

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let [flags, modes] = bytes.take();
    let wild = flags & 1 != 0;
    let mut row = || -> [f64; N] { std::array::from_fn(|_| bytes.number(wild)) };
    let mut state = || State { position: row(), velocity: row(), acceleration: row() };
    let (current, target) = (state(), state());
    let mut limits = Limits::symmetric(row().map(f64::abs), row().map(f64::abs), row().map(f64::abs));
    if flags & 2 != 0 {
        limits.velocity_min = row().map(|x| -x.abs());
        limits.acceleration_min = row().map(|x| -x.abs());
    }
    if flags & 4 != 0 {
        limits.jerk_max[0] = f64::INFINITY;
    }
    let mut input = Input::new(current, target, limits);
    let modes_of = [
        Synchronization::Time,
        Synchronization::None,
        Synchronization::TimeIfNecessary,
        Synchronization::Phase,
    ];
    input.synchronization = [modes_of[(modes & 3) as usize]; N];
    input.control =
        std::array::from_fn(
            |i| if modes >> (2 + i) & 1 != 0 { Control::Velocity } else { Control::Position },
        );
    input.target_moves = [flags & 32 != 0; N];
    if flags & 8 != 0 {
        input.duration_min = Some(row()[0].abs());
    }
    if flags & 16 != 0 {
        input.duration_step = Some(row()[0].abs());
    }
    let Ok(trajectory) = calculate(&input) else { return };
    assert!(trajectory.duration().is_finite() && trajectory.duration() >= 0.0);
    for share in [0.0, 0.25, 0.7, 1.0] {
        let sample = trajectory.at_time(share * trajectory.duration());
        let mut all = sample.position.iter().chain(&sample.velocity).chain(&sample.acceleration);
        assert!(all.all(|x| !x.is_nan()), "{input:?}");
    }
    let _ = trajectory.position_extrema();
    let _ = trajectory.first_time_at_position(0, input.target.position[0] / 2.0);
    if !wild {
        let verdict = judge(&input, &trajectory, false);
        assert!(verdict.is_good(), "{verdict:?}\n{input:?}");
    }
});
