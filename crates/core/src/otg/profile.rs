//! The motion of one axis: phases of constant jerk, one after the other.

use super::fixed_duration::Piece;
use super::input::Control;
use super::number::{SIXTH, larger};

/// Most phases of a profile: four that bring the axis inside its limits, and fourteen of the motion proper.
pub const MAX_PHASES: usize = 18;

/// A piece of motion at constant jerk: its duration, and the state where it starts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Phase {
    /// In seconds, > 0.
    pub duration: f64,
    /// Position at the start.
    pub position: f64,
    /// Velocity at the start.
    pub velocity: f64,
    /// Acceleration at the start.
    pub acceleration: f64,
    /// Jerk, constant over the phase.
    pub jerk: f64,
}

impl Phase {
    /// The motion a time after the start: position, velocity, acceleration and jerk.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64) -> Phase {
        let Phase { position: p, velocity: v, acceleration: a, jerk: j, duration } = *self;
        Phase {
            duration: duration - time,
            position: p + time * (v + time * (0.5 * a + time * j * SIXTH)),
            velocity: v + time * (a + 0.5 * time * j),
            acceleration: a + time * j,
            jerk: j,
        }
    }
}

/// Position, velocity and acceleration of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) p: f64,
    pub(super) v: f64,
    pub(super) a: f64,
}

impl From<Point> for Phase {
    fn from(Point { p, v, a }: Point) -> Self {
        Self { duration: 0.0, position: p, velocity: v, acceleration: a, jerk: 0.0 }
    }
}

/// Two states closer than this fraction of the motion's size are one. Rounding is some hundred times less; whatever is more is a
/// number beyond the range of floats.
const JOINS: f64 = 1e-9;

/// Whether a difference is rounding only. Not where the size has overflowed.
#[inline]
fn close(difference: f64, size: f64) -> bool {
    difference <= JOINS * size && size < f64::INFINITY
}

/// What a profile's control is: the derivative of position that may jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// Jerk.
    #[default]
    Third,
    /// Acceleration: jerk is unlimited.
    Second,
    /// Velocity: acceleration and jerk are unlimited.
    First,
}

/// The motion of one axis.
#[derive(Debug, Clone, Copy)]
pub struct Profile {
    phases: [Phase; MAX_PHASES],
    len: usize,
    /// How many of the phases, from the first, belong to the brake.
    brake_len: usize,
    /// Of all phases together.
    duration: f64,
    /// The state reached. Its acceleration goes on for ever.
    end: Phase,
    order: Order,
}

impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        (self.phases(), self.brake_len, self.end, self.order)
            == (other.phases(), other.brake_len, other.end, other.order)
    }
}

impl Profile {
    /// A profile without motion.
    pub(super) const EMPTY: Self = Self {
        phases: [Phase { duration: 0.0, position: 0.0, velocity: 0.0, acceleration: 0.0, jerk: 0.0 };
            MAX_PHASES],
        len: 0,
        brake_len: 0,
        duration: 0.0,
        end: Phase { duration: 0.0, position: 0.0, velocity: 0.0, acceleration: 0.0, jerk: 0.0 },
        order: Order::Third,
    };

    /// Begins anew, with a motion that will end at `end`.
    pub(super) fn begin(&mut self, end: Point, order: Order) {
        (self.len, self.brake_len, self.duration) = (0, 0, 0.0);
        (self.end, self.order) = (end.into(), order);
    }

    /// The state to be reached.
    pub(super) fn target(&self) -> Point {
        Point { p: self.end.position, v: self.end.velocity, a: self.end.acceleration }
    }

    /// Sets the state reached.
    pub(super) fn end_at(&mut self, end: Point) {
        self.end = end.into();
    }

    /// Appends a piece whose jerk and acceleration are in units of `scale`, and moves `now` from its start to its end.
    /// Pieces without duration are left out.
    #[inline]
    pub(super) fn push_forward(&mut self, piece: &Piece, scale: f64, now: &mut Point) {
        let &Piece { duration: t, .. } = piece;
        let (a, j) = (piece.acceleration * scale, piece.jerk * scale);
        if t > 0.0 {
            self.push(Phase { duration: t, position: now.p, velocity: now.v, acceleration: a, jerk: j });
            now.p += t * (now.v + t * (0.5 * a + t * j * SIXTH));
            now.v += t * (a + 0.5 * t * j);
        }
    }

    /// Appends pieces that lead to the end state, reckoned back from there. Says where they start: position and velocity.
    #[inline]
    pub(super) fn push_backward<const K: usize>(&mut self, pieces: &[Piece; K], scale: f64) -> (f64, f64) {
        let Phase { position: mut p, velocity: mut v, .. } = self.end;
        let mut place = self.len + pieces.iter().filter(|piece| piece.duration > 0.0).count();
        self.len = place.min(MAX_PHASES);
        for piece in pieces.iter().rev() {
            let t = piece.duration;
            if t > 0.0 {
                let (a, j) = (piece.acceleration * scale, piece.jerk * scale);
                v -= t * (a + 0.5 * t * j);
                p -= t * (v + t * (0.5 * a + t * j * SIXTH));
                place -= 1;
                if let Some(phase) = self.phases.get_mut(place) {
                    *phase = Phase { duration: t, position: p, velocity: v, acceleration: a, jerk: j };
                    self.duration += t;
                }
            }
        }
        (p, v)
    }

    /// Whether two states of this motion that must be one are one, but for rounding. Numbers that have overflowed are not.
    /// `size` is that of the coordinates.
    #[inline]
    pub(super) fn joins(&self, one: Point, (p, v): (f64, f64), size: f64) -> bool {
        let (p, v) = ((one.p - p).abs(), (one.v - v).abs());
        let speed = one.v.abs() + self.end.velocity.abs();
        close(p, size + speed * self.duration) && close(v, speed) || self.joins_by_size(p, v, size)
    }

    /// As [`Self::joins`], with the largest velocity that the motion has.
    #[cold]
    fn joins_by_size(&self, p: f64, v: f64, size: f64) -> bool {
        let mut speed = self.end.velocity.abs();
        for phase in self.phases() {
            let change = phase.acceleration.abs() + phase.jerk.abs() * phase.duration;
            speed = larger(speed, phase.velocity.abs() + change * phase.duration);
        }
        close(p, size + speed * self.duration) && close(v, speed)
    }

    #[inline]
    fn push(&mut self, phase: Phase) {
        if let Some(place) = self.phases.get_mut(self.len) {
            *place = phase;
            self.len += 1;
            self.duration += phase.duration;
        }
    }

    /// Says that the phases so far are the brake.
    pub(super) fn brake_is_complete(&mut self) {
        self.brake_len = self.len;
    }

    /// Takes back all phases but the first few.
    pub(super) fn cut(&mut self, phases: usize) {
        self.len = phases.min(self.len);
        self.duration = self.phases().iter().map(|phase| phase.duration).sum();
    }

    /// Says that the phases up to the one that brings the velocity between two limits for good are the brake, and the first `least` in
    /// any case.
    pub(super) fn brake_until_within(&mut self, least: usize, min: f64, max: f64) {
        let outside = |phase: &Phase| phase.velocity < min || phase.velocity > max;
        let last = self.phases().iter().rposition(outside);
        self.brake_len = last.map_or(0, |last| last + 1).max(least);
    }

    /// This profile is s(t) along a line; the motion of an axis that has the share `direction` of it.
    pub(super) fn along(&self, current: Point, target: Point, control: Control, direction: f64) -> Self {
        let mut profile = *self;
        // In velocity control s starts at rest, and the axis' own velocity goes on beside it.
        let drift = if control == Control::Velocity { current.v } else { 0.0 };
        let mut base = current.p;
        for phase in &mut profile.phases[..self.len] {
            phase.position = base + direction * phase.position;
            phase.velocity = drift + direction * phase.velocity;
            phase.acceleration *= direction;
            phase.jerk *= direction;
            base += drift * phase.duration;
        }
        profile.end = target.into();
        if control == Control::Velocity {
            profile.end.position = base + direction * self.end.position;
        }
        profile
    }

    /// What is said in a frame that moves at the velocity `drift`, in the frame at rest.
    pub(super) fn carry(&mut self, drift: f64) {
        let mut elapsed = 0.0;
        for phase in &mut self.phases[..self.len] {
            phase.position += drift * elapsed;
            phase.velocity += drift;
            elapsed += phase.duration;
        }
        self.end.position += drift * self.duration;
        self.end.velocity += drift;
    }

    /// Whether no number has overflowed.
    pub(super) fn is_finite(&self) -> bool {
        let finite = |p: &Phase| (p.position + p.velocity + p.acceleration + p.jerk).is_finite();
        self.duration.is_finite() && finite(&self.end) && self.phases().iter().all(finite)
    }

    /// All phases in order, those of the brake first.
    ///
    /// A profile has at most 7 phases after the brake where the axis reaches its own minimum time or cruises, and at most 14 where
    /// a synchronized axis has to move between two extreme motions.
    #[must_use]
    pub fn phases(&self) -> &[Phase] {
        &self.phases[..self.len]
    }

    /// The phases that bring the axis inside its limits; empty where it starts inside.
    #[must_use]
    pub fn brake(&self) -> &[Phase] {
        &self.phases[..self.brake_len]
    }

    /// Seconds from start to target.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Which derivative is the control, and may jump between phases.
    #[must_use]
    pub fn order(&self) -> Order {
        self.order
    }

    /// The state reached at the end.
    #[must_use]
    pub fn end(&self) -> Phase {
        self.end
    }

    /// The motion at a time from which on the target has been reached.
    #[inline]
    pub(super) fn after_end(&self, time: f64) -> Phase {
        self.end.at(larger(time - self.duration, 0.0))
    }

    /// Position, velocity, acceleration and jerk at a time; before the start those of the start, after the end those
    /// of the target going on at its acceleration. (`duration` is what is left of the phase.)
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64) -> Phase {
        let mut rest = if time > 0.0 { time } else { 0.0 };
        for phase in &self.phases[..self.len] {
            if rest < phase.duration {
                return phase.at(rest);
            }
            rest -= phase.duration;
        }
        self.end.at(rest)
    }
}
