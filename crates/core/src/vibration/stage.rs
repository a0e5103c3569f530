//! A prefilter as a stage of the cycle.
//!
//! In: one command a cycle, taken as piecewise linear in between. Out: that command through the kernel, at the cycle's
//! instants, exact in the kernel's times: none is rounded to whole cycles.
//!
//! A kernel Σ wⱼ δ(t − tⱼ) ∗ rect(T) turns the command x into Σ wⱼ/T · [P(t − tⱼ) − P(t − tⱼ − T)] with P = ∫x. So a moving average of any
//! length costs two looks into a ring of x and P (*taps*), and impulses that lie T apart share them.
//!
//! | | |
//! |---|---|
//! | gain | 1 at zero frequency: the way of the output is the way of the input |
//! | delay | [`Kernel::delay`] for a constant rate, [`Kernel::length`] until the last of it has come out |
//! | a constant | passes, bit by bit once it has stood for the kernel's length |
//!
//! **No drift.** P starts anew each time the ring is full (a *lap*), and a look into the lap before subtracts that lap's whole. So P never
//! exceeds R · |x| with R the ring's length, and rounding stays below R · 2⁻⁵³ · |x| however long the stage runs.
//!
//! **Limits pass.** What comes out is Σ cₘ xₙ₋ₘ over past commands, with cₘ > 0 and Σ cₘ = 1, since a kernel's weights are positive. Any
//! differences of the output are the same mean of those of the input: what bounds the position, velocity, acceleration and jerk of
//! the commands that go in bounds what comes out.

use core::fmt;

use super::kernel::{Kernel, MAX_IMPULSES, same_time};
use crate::math::float;

/// Two ends of the rectangle under each impulse.
const MAX_TAPS: usize = 2 * MAX_IMPULSES;

/// What a stage filters: numbers that can be weighted and added.
pub trait Signal: Copy + PartialEq {
    /// Nothing.
    const ZERO: Self;

    /// Adds a share of another one.
    fn add(&mut self, share: f64, other: &Self);
}

impl<const N: usize> Signal for [f64; N] {
    const ZERO: Self = [0.0; N];

    #[inline]
    fn add(&mut self, share: f64, other: &Self) {
        for axis in 0..N {
            self[axis] += share * other[axis];
        }
    }
}

/// A prefilter on a signal, for example on the positions of `N` axes: `[f64; N]`.
///
/// `M` is the ring's memory, as long as [`stage_entries`] says or longer: an array, a slice, or what an allocator gave. The kernel has one
/// rectangle at most; several modes with FIR take one stage each, one after the other. Commands are finite numbers: another one would stay
/// inside until [`PrefilterStage::reset`].
#[derive(Debug, Clone)]
pub struct PrefilterStage<S, M> {
    ring: M,
    /// Length of the ring's part in use, a power of two, less one.
    mask: usize,
    /// Where the newest command lies.
    now: usize,
    /// Cycles since the reset, up to one more than `length`: before it there was only the origin.
    age: usize,
    /// Where the stage was reset. The ring holds differences from it.
    origin: S,
    last: S,
    /// ∫ of the lap before, in cycles.
    lap: S,
    taps: [Tap; MAX_TAPS],
    tap_count: usize,
    /// Cycles until a command has come out whole.
    length: usize,
    /// Cycles since the command last changed, up to `length`.
    constant: usize,
}

/// One cycle in a stage's memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageEntry<S> {
    command: S,
    /// ∫ of the command since the lap's start, in cycles.
    integral: S,
}

impl<S: Signal> StageEntry<S> {
    /// What the memory of a stage may hold at first; it need not.
    pub const ZERO: Self = Self { command: S::ZERO, integral: S::ZERO };
}

/// How many entries the memory of a stage needs: a power of two, and one more than the cycles that the kernel takes.
#[must_use]
pub fn stage_entries(kernel: &Kernel, period: f64) -> usize {
    ((cycles(kernel, period) as usize).saturating_add(1)).next_power_of_two().max(2)
}

/// Cycles until a command has come out whole.
fn cycles(kernel: &Kernel, period: f64) -> f64 {
    float::ceil(kernel.length() / period)
}

/// A look into the past: `back` cycles, then a fraction on. What it adds is a weighted sum of the ring's entry there and the next command.
#[derive(Debug, Clone, Copy, Default)]
struct Tap {
    back: usize,
    integral: f64,
    here: f64,
    next: f64,
}

/// Why there is no such stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StageError {
    /// The period is not positive and finite.
    Period {
        /// As given, in seconds.
        period: f64,
    },
    /// The kernel does not fit into the ring.
    TooLong {
        /// Cycles that the kernel takes.
        cycles: f64,
        /// Cycles that the ring has room for.
        room: usize,
    },
    /// More than one rectangle: take one stage a rectangle.
    Rectangles {
        /// How many the kernel has.
        count: usize,
    },
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period { period } => write!(f, "period {period} s: expected a number above 0"),
            Self::TooLong { cycles, room } => {
                write!(f, "the prefilter takes {cycles:.0} cycles: the stage has room for {room}")
            }
            Self::Rectangles { count } => {
                write!(f, "{count} moving averages in one stage: take one stage for each")
            }
        }
    }
}

impl core::error::Error for StageError {}

impl<S: Signal, M: AsRef<[StageEntry<S>]> + AsMut<[StageEntry<S>]>> PrefilterStage<S, M> {
    /// A stage at rest at a command, for commands every `period` seconds.
    ///
    /// # Errors
    /// A bad period, a kernel too long for the memory or with more than one rectangle.
    pub fn try_new(ring: M, kernel: &Kernel, period: f64, command: &S) -> Result<Self, StageError> {
        if !(period > 0.0 && period.is_finite()) {
            return Err(StageError::Period { period });
        }
        let count = kernel.rectangles().len();
        if count > 1 {
            return Err(StageError::Rectangles { count });
        }
        let cycles = cycles(kernel, period);
        // The longest part that is a power of two; the tap of the longest delay looks at its entry and the next.
        let mask = (ring.as_ref().len() / 2 + 1).next_power_of_two() - 1;
        let room = if ring.as_ref().len() > mask { mask } else { 0 };
        if cycles > room as f64 || room == 0 {
            return Err(StageError::TooLong { cycles, room });
        }
        let mut stage = Self {
            ring,
            mask,
            now: 0,
            age: 0,
            origin: *command,
            last: *command,
            lap: S::ZERO,
            taps: [Tap::default(); MAX_TAPS],
            tap_count: 0,
            length: cycles as usize,
            constant: 0,
        };
        stage.lay_taps(kernel, period);
        stage.reset(command);
        Ok(stage)
    }

    /// At rest at a command from now on: what was still inside is dropped. Costs no more than an update.
    pub fn reset(&mut self, command: &S) {
        (self.origin, self.last, self.lap) = (*command, *command, S::ZERO);
        (self.now, self.age, self.constant) = (0, 0, self.length);
        self.put(StageEntry::ZERO);
    }

    /// One cycle: takes the command of this instant, gives the prefiltered one.
    #[inline]
    #[must_use]
    pub fn update(&mut self, command: &S) -> S {
        self.take(command);
        if self.is_drained() {
            // What the sum below gives but for rounding; from here on the differences in the ring are small again.
            self.reset(command);
            return *command;
        }
        let mut output = self.origin;
        for tap in self.taps.get(..self.tap_count).unwrap_or_default() {
            if tap.back > self.age {
                // Nothing but the origin.
                continue;
            }
            let entry = self.back(tap.back);
            if tap.integral != 0.0 {
                output.add(tap.integral, &entry.integral);
                if tap.back > self.now {
                    output.add(-tap.integral, &self.lap);
                }
            }
            output.add(tap.here, &entry.command);
            if tap.next != 0.0 {
                output.add(tap.next, &self.back(tap.back.wrapping_sub(1)).command);
            }
        }
        output
    }

    /// Cycles until the output stands where the command stands, if that does not change any more.
    #[must_use]
    pub fn remaining(&self) -> usize {
        self.length - self.constant
    }

    /// Whether all that went in has come out.
    #[must_use]
    pub fn is_drained(&self) -> bool {
        self.constant >= self.length
    }

    /// The command that went in last: where the output will come to rest.
    #[must_use]
    pub fn command(&self) -> &S {
        &self.last
    }

    fn take(&mut self, command: &S) {
        let StageEntry { command: before, mut integral } = *self.back(0);
        let mut difference = *command;
        difference.add(-1.0, &self.origin);
        integral.add(0.5, &before);
        integral.add(0.5, &difference);
        self.now = (self.now + 1) & self.mask;
        if self.now == 0 {
            self.lap = core::mem::replace(&mut integral, S::ZERO);
        }
        self.put(StageEntry { command: difference, integral });
        self.age = (self.age + 1).min(self.length + 1);
        self.constant = if self.last == *command { (self.constant + 1).min(self.length) } else { 0 };
        self.last = *command;
    }

    /// The entry so many cycles ago.
    fn back(&self, cycles: usize) -> &StageEntry<S> {
        &self.ring.as_ref()[self.now.wrapping_sub(cycles) & self.mask]
    }

    fn put(&mut self, entry: StageEntry<S>) {
        self.ring.as_mut()[self.now & self.mask] = entry;
    }

    fn lay_taps(&mut self, kernel: &Kernel, period: f64) {
        let rectangle = kernel.rectangles().first().map(|duration| duration / period);
        let mut ends = [(0.0, 0.0); MAX_TAPS];
        let mut count = 0;
        let mut add = |delay: f64, weight: f64| {
            let used = ends.get_mut(..count).unwrap_or_default();
            if let Some(there) = used.iter_mut().find(|there| same_time(there.0, delay)) {
                there.1 += weight;
            } else if let Some(free) = ends.get_mut(count) {
                *free = (delay, weight);
                count += 1;
            }
        };
        for impulse in kernel.impulses() {
            let delay = impulse.time / period;
            match rectangle {
                None => add(delay, impulse.weight),
                Some(duration) => {
                    add(delay, impulse.weight / duration);
                    add(delay + duration, -impulse.weight / duration);
                }
            }
        }
        for (tap, (delay, weight)) in self.taps.iter_mut().zip(ends.get(..count).unwrap_or_default()) {
            *tap = Tap::at(*delay, *weight, rectangle.is_some());
        }
        self.tap_count = count;
    }
}

impl Tap {
    /// Looks at the command, or at its integral, `delay` cycles ago.
    ///
    /// A fraction f after an entry the command is (1−f)·x + f·x₊, and its integral P + f(1 − f/2)·x + f²/2·x₊.
    fn at(delay: f64, weight: f64, of_integral: bool) -> Self {
        let back = float::ceil(delay);
        let f = back - delay;
        let (integral, here, next) =
            if of_integral { (1.0, f * (1.0 - 0.5 * f), 0.5 * f * f) } else { (0.0, 1.0 - f, f) };
        Self { back: back as usize, integral: weight * integral, here: weight * here, next: weight * next }
    }
}
