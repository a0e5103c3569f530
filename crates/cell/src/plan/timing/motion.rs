//! The result: the path coordinate as a function of time, piece by piece.

pub use seamline::path::{PathState, TimingPiece};

/// The piece of constant `jerk` that starts in `state`.
pub(super) fn constant_jerk(state: &PathState, jerk: f64, duration: f64) -> TimingPiece {
    let PathState { position, velocity, acceleration, .. } = *state;
    TimingPiece { duration, position, velocity, acceleration, jerk, snap: 0.0, crackle: 0.0 }
}

/// The piece that joins two states in position, velocity and acceleration.
pub(super) fn joining(start: &PathState, end: &PathState, duration: f64) -> TimingPiece {
    let t = duration;
    let PathState { position, velocity, acceleration, .. } = *start;
    // What is missing at the end if the piece went on with the start's acceleration; each scaled to a length.
    let gap = end.position - (position + t * (velocity + t * acceleration / 2.0));
    let gap_velocity = (end.velocity - velocity - t * acceleration) * t;
    let gap_acceleration = (end.acceleration - acceleration) * t * t;
    let t3 = t * t * t;
    TimingPiece {
        duration,
        position,
        velocity,
        acceleration,
        jerk: (60.0 * gap - 24.0 * gap_velocity + 3.0 * gap_acceleration) / t3,
        snap: (-360.0 * gap + 168.0 * gap_velocity - 24.0 * gap_acceleration) / (t3 * t),
        crackle: (720.0 * gap - 360.0 * gap_velocity + 60.0 * gap_acceleration) / (t3 * t * t),
    }
}

/// The same way as a piece goes, in `factor` times the time.
pub(super) fn stretched(piece: &TimingPiece, factor: f64) -> TimingPiece {
    let f2 = factor * factor;
    let f3 = f2 * factor;
    TimingPiece {
        duration: piece.duration * factor,
        position: piece.position,
        velocity: piece.velocity / factor,
        acceleration: piece.acceleration / f2,
        jerk: piece.jerk / f3,
        snap: piece.snap / (f3 * factor),
        crackle: piece.crackle / (f3 * f2),
    }
}

/// The same way as a row of pieces goes at another pace: `pace` tells, at a time of theirs, how many times as fast
/// it shall be, and how this factor changes per second of theirs. Exact where pieces meet.
pub(super) fn paced(pieces: &[TimingPiece], pace: impl Fn(f64) -> [f64; 2]) -> Vec<TimingPiece> {
    let changed = |state: &PathState, [factor, change]: [f64; 2]| PathState {
        velocity: state.velocity * factor,
        acceleration: (state.acceleration * factor + state.velocity * change) * factor,
        ..*state
    };
    let mut time = 0.0;
    let whole = |piece: &TimingPiece| {
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|share: f64| pace(time + share * piece.duration));
        time += piece.duration;
        // Simpson's rule.
        let duration = piece.duration * (1.0 / start[0] + 4.0 / middle[0] + 1.0 / end[0]) / 6.0;
        joining(&changed(&piece.at(0.0), start), &changed(&piece.end(), end), duration)
    };
    pieces.iter().map(whole).collect()
}

/// Duration of a row of pieces, in seconds.
pub(super) fn duration(pieces: &[TimingPiece]) -> f64 {
    pieces.iter().map(|piece| piece.duration).sum()
}

/// The time at which each of a row of pieces starts, from 0.
pub(super) fn starts(pieces: &[TimingPiece]) -> Vec<f64> {
    let mut time = 0.0;
    let begun = |piece: &TimingPiece| {
        let start = time;
        time += piece.duration;
        start
    };
    pieces.iter().map(begun).collect()
}

/// How a timing came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimingKind {
    /// The path's limits alone: no joint has to slow it.
    Plain,
    /// The same with lower limits in some stretches.
    Gentler,
    /// Near time-optimal under the joints' limits.
    Optimized,
    /// The plain motion stretched as a whole until every joint keeps its limits: from rest always possible,
    /// seldom fast.
    Stretched,
}

/// Order of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
    /// Jerk.
    Jerk,
}

/// A part of the path where the motion is slower than its programmed speed. Where that speed changes, one ends
/// and another may begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slowdown {
    /// Path coordinate where it starts.
    pub from: f64,
    /// Path coordinate where it ends.
    pub to: f64,
    /// Path coordinate of the least speed.
    pub place: f64,
    /// The least speed.
    pub speed: f64,
    /// The highest constant speed that the joints could hold all along this stretch; the programmed speed
    /// where only the change of speed takes longer than programmed.
    pub sustainable: f64,
    /// The joint that causes it, counted from 0.
    pub joint: usize,
    /// The order of the limit that causes it.
    pub order: Order,
}

/// The motion along a whole path: s(t) to rest at its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    pieces: Vec<TimingPiece>,
    /// Time at which each piece starts.
    starts: Vec<f64>,
    duration: f64,
    kind: TimingKind,
    slowdowns: Vec<Slowdown>,
    settled: usize,
}

impl Timing {
    /// With all pieces settled.
    pub(super) fn new(pieces: Vec<TimingPiece>, kind: TimingKind, slowdowns: Vec<Slowdown>) -> Self {
        let (starts, duration, settled) = (starts(&pieces), duration(&pieces), pieces.len());
        Self { pieces, starts, duration, kind, slowdowns, settled }
    }

    /// With so many settled pieces.
    pub(super) fn settled_for(self, settled: usize) -> Self {
        Self { settled, ..self }
    }

    /// Duration in seconds.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The pieces, in order.
    #[must_use]
    pub fn pieces(&self) -> &[TimingPiece] {
        &self.pieces
    }

    /// How the timing came about.
    #[must_use]
    pub fn kind(&self) -> TimingKind {
        self.kind
    }

    /// Where the motion is more than 1 % slower than the path limits alone would have it, in order of the
    /// path.
    #[must_use]
    pub fn slowdowns(&self) -> &[Slowdown] {
        &self.slowdowns
    }

    /// How many leading pieces stay as they are when the path goes on beyond its end: all of them, unless the
    /// course is open.
    ///
    /// They end where the motion has no acceleration and nothing that comes later can make it faster: at the
    /// programmed speed before the way to rest begins, or at an anchor. Who has
    /// carried them out calls [`time_path`](super::time_path) again for the path from there on, with the speed
    /// there as [`Course::start`](super::Course::start). Where there are none, the known part of the path is too
    /// short to reach such a place: more of it is needed, or the motion has to run to rest at its end, as
    /// planned. That stays possible from every place, whatever is found later.
    #[must_use]
    pub fn settled(&self) -> usize {
        self.settled
    }

    /// The state at `time` seconds after the start; before the start it is the start, after the end the end.
    /// Finding the piece takes logarithmic time; who walks through in order may use [`Timing::pieces`]
    /// instead.
    #[must_use]
    pub fn at(&self, time: f64) -> PathState {
        let index = self.starts.partition_point(|&start| start <= time).saturating_sub(1);
        match (self.pieces.get(index), self.starts.get(index)) {
            (Some(piece), Some(start)) => piece.at((time - start).clamp(0.0, piece.duration)),
            _ => PathState::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joining_piece_meets_both_ends() {
        let start = PathState { position: 0.3, velocity: 0.2, acceleration: -1.0, jerk: 0.0 };
        let end = PathState { position: 0.301, velocity: 0.25, acceleration: 2.0, jerk: 0.0 };
        let piece = joining(&start, &end, 0.004);
        let (first, last) = (piece.at(0.0), piece.end());
        assert_eq!((first.position, first.velocity, first.acceleration), (0.3, 0.2, -1.0));
        assert!((last.position - end.position).abs() < 1e-15);
        assert!((last.velocity - end.velocity).abs() < 1e-12);
        assert!((last.acceleration - end.acceleration).abs() < 1e-9);
    }

    /// Derivatives of a piece against differences of its own values, and the same way in 1.7 times the time.
    #[test]
    fn a_piece_is_its_own_derivative_and_stretches() {
        let piece = TimingPiece {
            duration: 2.0,
            position: 1.0,
            velocity: -0.5,
            acceleration: 0.25,
            jerk: 2.0,
            snap: -3.0,
            crackle: 1.5,
        };
        let (t, h, factor) = (1.1, 1e-5, 1.7);
        let [before, here, after] = [t - h, t, t + h].map(|t| piece.at(t));
        let slope = |pick: fn(&PathState) -> f64| (pick(&after) - pick(&before)) / (2.0 * h);
        assert!((slope(|state| state.position) - here.velocity).abs() < 1e-8);
        assert!((slope(|state| state.velocity) - here.acceleration).abs() < 1e-8);
        assert!((slope(|state| state.acceleration) - here.jerk).abs() < 1e-8);
        let slow = stretched(&piece, factor).at(t * factor);
        assert!((slow.position - here.position).abs() < 1e-14);
        assert!((slow.velocity * factor - here.velocity).abs() < 1e-14);
        assert!((slow.acceleration * factor.powi(2) - here.acceleration).abs() < 1e-14);
        assert!((slow.jerk * factor.powi(3) - here.jerk).abs() < 1e-14);
    }

    #[test]
    fn a_timing_finds_its_pieces_and_stays_at_its_ends() {
        let cruise =
            |position: f64| TimingPiece { duration: 0.5, position, velocity: 2.0, ..TimingPiece::default() };
        let timing = Timing::new(vec![cruise(0.0), cruise(1.0), cruise(2.0)], TimingKind::Plain, Vec::new());
        assert_eq!(timing.duration(), 1.5);
        for (time, place) in
            [(-1.0, 0.0), (0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (1.25, 2.5), (1.5, 3.0), (9.0, 3.0)]
        {
            assert_eq!(timing.at(time).position, place, "{time}");
        }
    }
}
