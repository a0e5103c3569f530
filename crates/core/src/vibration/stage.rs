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
//! exceeds RING · |x|, and rounding stays below RING · 2⁻⁵³ · |x| however long the stage runs.

use core::fmt;

use super::kernel::{Kernel, MAX_IMPULSES, same_time};
use crate::math::float;

/// Two ends of the rectangle under each impulse.
const MAX_TAPS: usize = 2 * MAX_IMPULSES;

/// A prefilter on `N` axes, with room for kernels of up to `RING − 1` cycles; `RING` is a power of two.
///
/// The kernel has one rectangle at most; several modes with FIR take one stage each, one after the other. Commands are finite numbers: another
/// one would stay inside until [`PrefilterStage::reset`].
#[derive(Debug, Clone)]
pub struct PrefilterStage<const N: usize, const RING: usize> {
    ring: [Entry<N>; RING],
    /// Where the newest command lies.
    now: usize,
    /// ∫ of the lap before, in cycles.
    lap: [f64; N],
    taps: [Tap; MAX_TAPS],
    tap_count: usize,
    /// Cycles until a command has come out whole.
    length: usize,
    /// Cycles since the command last changed, up to `length`.
    constant: usize,
}

#[derive(Debug, Clone, Copy)]
struct Entry<const N: usize> {
    command: [f64; N],
    /// ∫ of the command since the lap's start, in cycles.
    integral: [f64; N],
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

impl<const N: usize, const RING: usize> PrefilterStage<N, RING> {
    const MASK: usize = {
        assert!(RING.is_power_of_two() && RING >= 2);
        RING - 1
    };

    /// A stage at rest at a position, for commands every `period` seconds.
    ///
    /// # Errors
    /// A bad period, a kernel longer than the ring or with more than one rectangle.
    pub fn try_new(kernel: &Kernel, period: f64, position: &[f64; N]) -> Result<Self, StageError> {
        if !(period > 0.0 && period.is_finite()) {
            return Err(StageError::Period { period });
        }
        let count = kernel.rectangles().len();
        if count > 1 {
            return Err(StageError::Rectangles { count });
        }
        let cycles = float::ceil(kernel.length() / period);
        // The tap of the longest delay looks at its entry and the next.
        let room = RING - 1;
        if cycles > room as f64 {
            return Err(StageError::TooLong { cycles, room });
        }
        let mut stage = Self {
            ring: [Entry { command: [0.0; N], integral: [0.0; N] }; RING],
            now: 0,
            lap: [0.0; N],
            taps: [Tap::default(); MAX_TAPS],
            tap_count: 0,
            length: cycles as usize,
            constant: 0,
        };
        stage.lay_taps(kernel, period);
        stage.reset(position);
        Ok(stage)
    }

    /// At rest at a position from now on: what was still inside is dropped. Costs a pass over the ring.
    pub fn reset(&mut self, position: &[f64; N]) {
        for (index, entry) in self.ring.iter_mut().enumerate() {
            *entry = Entry { command: *position, integral: position.map(|x| x * index as f64) };
        }
        self.lap = position.map(|x| x * RING as f64);
        self.now = 0;
        self.constant = self.length;
    }

    /// One cycle: takes the command of this instant, gives the prefiltered one.
    #[inline]
    #[must_use]
    pub fn update(&mut self, command: &[f64; N]) -> [f64; N] {
        self.take(command);
        if self.is_drained() {
            // What the sum below gives but for rounding.
            return *command;
        }
        let mut output = [0.0; N];
        for tap in self.taps.get(..self.tap_count).unwrap_or_default() {
            let at = self.now.wrapping_sub(tap.back) & Self::MASK;
            let lap = if tap.back > self.now { tap.integral } else { 0.0 };
            let (entry, next) = (&self.ring[at], &self.ring[(at + 1) & Self::MASK].command);
            for axis in 0..N {
                output[axis] += tap.integral * entry.integral[axis] - lap * self.lap[axis]
                    + tap.here * entry.command[axis]
                    + tap.next * next[axis];
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
    pub fn command(&self) -> &[f64; N] {
        &self.ring[self.now & Self::MASK].command
    }

    fn take(&mut self, command: &[f64; N]) {
        let Entry { command: last, integral } = self.ring[self.now & Self::MASK];
        let area = core::array::from_fn(|axis| integral[axis] + 0.5 * (last[axis] + command[axis]));
        self.now = (self.now + 1) & Self::MASK;
        let integral = if self.now == 0 {
            self.lap = area;
            [0.0; N]
        } else {
            area
        };
        self.ring[self.now & Self::MASK] = Entry { command: *command, integral };
        self.constant = if last == *command { (self.constant + 1).min(self.length) } else { 0 };
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
