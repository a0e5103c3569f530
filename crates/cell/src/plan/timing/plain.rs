//! The plain motion: the path's limits alone, stretch by stretch, in phases of constant jerk.
//!
//! Where two stretches meet, the motion has no acceleration, and a speed that both allow. So a ramp between two
//! speeds lies in the faster stretch, and each stretch is a matter of its own once the speeds at its ends are
//! known. These come from a backward and a forward pass, each with the highest speed that the stretch leaves
//! time for. Where stretches are so short that the motion would lose its acceleration at many meetings in a
//! row on its way up or down, neighbours are taken as one, with the lesser limits of both.

use super::course::{Limits, least};
use super::motion::{PathState, TimingPiece, constant_jerk, duration, starts};
use super::{PathLimits, TimingError};

/// Speeds this near are the same, as a share; a start may be too fast by this.
const SAME: f64 = 1e-9;
/// What rounding may make of a way, as a share.
const ROUNDING: f64 = 1e-13;
/// What is left of a stretch after its ramps counts as a cruise from this share of its length on.
const NO_WAY: f64 = 1e-13;
/// Rounds in which neighbours are taken as one: each halves the number of short stretches on a ramp.
const MERGES: usize = 16;
/// Bounds on the steps of root finders: bisection to the last digit, and Newton's from the far side.
const BISECTIONS: usize = 80;
const NEWTON_STEPS: usize = 40;

/// A time without acceleration: a cruise, or the instant at which two stretches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hold {
    /// Times of its start and its end.
    pub(super) from: f64,
    pub(super) to: f64,
    /// Path coordinate at its start.
    pub(super) place: f64,
    pub(super) speed: f64,
}

impl Hold {
    /// Path coordinate at its end.
    pub(super) fn end(&self) -> f64 {
        self.place + self.speed * (self.to - self.from)
    }
}

/// The plain motion over a whole path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plain {
    pub(super) pieces: Vec<TimingPiece>,
    /// Time at which each piece starts.
    pub(super) starts: Vec<f64>,
    pub(super) duration: f64,
    /// In order, start and end of the path included.
    pub(super) holds: Vec<Hold>,
}

/// A stretch between two of the places where the motion has no acceleration.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: f64,
    to: f64,
    limits: PathLimits,
}

impl Plain {
    /// The motion from `start`, a speed without acceleration, to rest. Cost: linear in the number of stretches.
    ///
    /// # Errors
    /// [`TimingError::Start`] where the first stretch does not allow that speed, or the way is too short to stop.
    pub(super) fn new<E>(limits: &Limits, start: f64) -> Result<Self, TimingError<E>> {
        let mut segments: Vec<Segment> =
            limits.parts().map(|(from, to, limits)| Segment { from, to, limits }).collect();
        let mut speeds = speeds(&segments, start)?;
        for _ in 0..MERGES {
            let merged = merged(&segments, &speeds);
            if merged.len() == segments.len() {
                break;
            }
            speeds = self::speeds(&merged, start)?;
            segments = merged;
        }
        Ok(Self::through(&segments, &speeds))
    }

    fn through(segments: &[Segment], speeds: &[f64]) -> Self {
        let mut pieces = Vec::new();
        let mut holds = Vec::new();
        let mut time = 0.0;
        for (segment, ends) in segments.iter().zip(speeds.windows(2)) {
            note(&mut holds, Hold { from: time, to: time, place: segment.from, speed: ends[0] });
            let [up, down] = segment.ramps(ends[0], ends[1]);
            let first = pieces.len();
            up.extend(&mut pieces, segment.from);
            let (begin, end) = (segment.from + up.distance(), segment.to - down.distance());
            if end - begin > NO_WAY * segment.length() && up.to > 0.0 {
                let from = time + duration(&pieces[first..]);
                let cruise = cruising(begin, end, up.to);
                note(&mut holds, Hold { from, to: from + cruise.duration, place: begin, speed: up.to });
                pieces.push(cruise);
            }
            down.extend(&mut pieces, end);
            time += duration(&pieces[first..]);
        }
        if let (Some(segment), Some(&speed)) = (segments.last(), speeds.last()) {
            note(&mut holds, Hold { from: time, to: time, place: segment.to, speed });
        }
        let starts = starts(&pieces);
        Self { pieces, starts, duration: time, holds }
    }

    /// Path coordinate and speed at a time in a hold.
    pub(super) fn held_at(&self, time: f64) -> (f64, f64) {
        let index = self.holds.partition_point(|hold| hold.from <= time).saturating_sub(1);
        self.holds.get(index).map_or((0.0, 0.0), |hold| {
            let within = (time - hold.from).min(hold.to - hold.from);
            (hold.place + hold.speed * within, hold.speed)
        })
    }

    /// The motion between two times, both of them in holds.
    pub(super) fn between(&self, from: f64, to: f64) -> Vec<TimingPiece> {
        let first = self.starts.partition_point(|&start| start <= from).saturating_sub(1);
        let parts = self.pieces[first..].iter().zip(&self.starts[first..]);
        parts
            .take_while(|(_, start)| **start < to)
            .map(|(piece, &start)| part(piece, from - start, to - start))
            .filter(|piece| piece.duration > SAME * (to - from))
            .collect()
    }
}

/// The piece between two of its times. What is not a whole piece is a cruise.
fn part(piece: &TimingPiece, from: f64, to: f64) -> TimingPiece {
    let (from, to) = (from.max(0.0), to.min(piece.duration));
    if from == 0.0 && to == piece.duration {
        return *piece;
    }
    TimingPiece { duration: to - from, position: piece.at(from).position, ..*piece }
}

pub(super) fn cruising(from: f64, to: f64, speed: f64) -> TimingPiece {
    TimingPiece { duration: (to - from) / speed, position: from, velocity: speed, ..TimingPiece::default() }
}

/// Adds a hold, or lengthens the one that it continues.
fn note(holds: &mut Vec<Hold>, hold: Hold) {
    match holds.last_mut() {
        Some(last) if last.speed == hold.speed && hold.from <= last.to * (1.0 + SAME) => {
            last.to = hold.to.max(last.to);
        }
        _ => holds.push(hold),
    }
}

impl Segment {
    fn length(&self) -> f64 {
        self.to - self.from
    }

    fn ramp(&self, from: f64, to: f64) -> Ramp {
        Ramp::new(from, to, &self.limits)
    }

    /// The ramps at the segment's ends, to and from the highest speed that it allows between these two.
    fn ramps(&self, from: f64, to: f64) -> [Ramp; 2] {
        let through = |peak: f64| [self.ramp(from, peak), self.ramp(peak, to)];
        let spare = |ramps: &[Ramp; 2]| self.length() - ramps[0].distance() - ramps[1].distance();
        let fastest = through(self.limits.speed.max(from).max(to));
        if spare(&fastest) >= 0.0 {
            return fastest;
        }
        if from == to {
            return through(self.limits.speed.min(reach(from, self.length() / 2.0, &self.limits)));
        }
        let mut low = from.max(to);
        let mut high = self.limits.speed;
        for _ in 0..BISECTIONS {
            let middle = low + (high - low) / 2.0;
            if spare(&through(middle)) >= 0.0 { low = middle } else { high = middle }
        }
        through(low)
    }

    /// Time from speed to speed; infinite where the segment is too short for that.
    fn time(&self, from: f64, to: f64) -> f64 {
        let direct = self.ramp(from, to).distance();
        if from.max(to) > self.limits.speed * (1.0 + SAME) || direct > self.length() * (1.0 + SAME) {
            return f64::INFINITY;
        }
        let [up, down] = self.ramps(from, to);
        let cruise = (self.length() - up.distance() - down.distance()).max(0.0);
        up.time() + down.time() + if up.to > 0.0 { cruise / up.to } else { 0.0 }
    }
}

/// The highest speeds at the segments' ends with which each can be passed.
fn speeds<E>(segments: &[Segment], start: f64) -> Result<Vec<f64>, TimingError<E>> {
    let calm = highest(segments);
    if start >= 0.0 && start <= calm[0] * (1.0 + SAME) {
        return Ok(forward(segments, start, calm));
    }
    let error = TimingError::Start { speed: start, limit: calm[0] };
    hasty(segments, start, &calm).ok_or(error)
}

/// The highest speed at each segment's end from which all that follow can be.
fn highest(segments: &[Segment]) -> Vec<f64> {
    backward(segments, |next, segment| reach(next, segment.length(), &segment.limits))
}

/// Speeds from a start that is too fast for these, if there are any. To brake to a low speed takes more way than to brake
/// to rest, since there is no acceleration left at either: so lower speeds than the highest may yet do.
fn hasty(segments: &[Segment], start: f64, calm: &[f64]) -> Option<Vec<f64>> {
    if segments.first().is_some_and(|first| start > first.limits.speed * (1.0 + SAME)) {
        return None;
    }
    // Of all speeds to brake to, the highest or rest takes the least way.
    let most = backward(segments, |next, segment| {
        let from = |speed: f64| reach(speed, segment.length(), &segment.limits);
        from(next).max(from(0.0))
    });
    let mut speeds = vec![start];
    for (index, segment) in segments.iter().enumerate() {
        let from = speeds[index];
        let reached = reach(from, segment.length(), &segment.limits);
        let [calm, most] = [calm[index + 1], most[index + 1]].map(|speed| speed.min(reached));
        let passes =
            |to: f64, slack: f64| segment.ramp(from, to).distance() <= segment.length() * (1.0 + slack);
        speeds.push(if passes(calm, ROUNDING) { calm } else { highest_below(most, |to| passes(to, 0.0))? });
    }
    (start >= 0.0).then_some(speeds)
}

/// The highest speed at each segment's end, from the last one on; `before` is what the next one permits in front of a segment.
fn backward(segments: &[Segment], before: impl Fn(f64, &Segment) -> f64) -> Vec<f64> {
    let mut speeds = vec![0.0; segments.len() + 1];
    for (index, segment) in segments.iter().enumerate().rev() {
        let neighbour = if index == 0 { f64::INFINITY } else { segments[index - 1].limits.speed };
        speeds[index] = before(speeds[index + 1], segment).min(segment.limits.speed).min(neighbour);
    }
    speeds
}

/// These speeds, as far as the start and what follows it reach them.
fn forward(segments: &[Segment], start: f64, mut speeds: Vec<f64>) -> Vec<f64> {
    speeds[0] = start;
    for (index, segment) in segments.iter().enumerate() {
        let most = reach(speeds[index], segment.length(), &segment.limits);
        speeds[index + 1] = speeds[index + 1].min(most);
    }
    speeds
}

/// The highest speed, from rest on, up to which all pass; `None` where not even rest does.
fn highest_below(speed: f64, passes: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..BISECTIONS {
        let middle = low + (high - low) / 2.0;
        if passes(middle) { low = middle } else { high = middle }
    }
    passes(low).then_some(low)
}

/// Neighbours taken as one, where the speed at which they meet is set by how short they are and the way through
/// both takes less time so.
fn merged(segments: &[Segment], speeds: &[f64]) -> Vec<Segment> {
    let mut merged = Vec::with_capacity(segments.len());
    let mut index = 0;
    while let Some(&segment) = segments.get(index) {
        let next = segments.get(index + 1).filter(|next| {
            let both = segment.with(next);
            let [from, middle, to] = [speeds[index], speeds[index + 1], speeds[index + 2]];
            middle < both.limits.speed * (1.0 - SAME)
                && both.time(from, to) < segment.time(from, middle) + next.time(middle, to)
        });
        merged.push(next.map_or(segment, |next| segment.with(next)));
        index += if next.is_some() { 2 } else { 1 };
    }
    merged
}

impl Segment {
    /// This one and the next as one.
    fn with(&self, next: &Self) -> Self {
        Self { from: self.from, to: next.to, limits: least(&self.limits, &next.limits) }
    }
}

/// A change of speed in the least time, without acceleration at either end.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    from: f64,
    to: f64,
    /// Positive where the speed rises.
    jerk: f64,
    /// Durations of either jerk phase and of constant acceleration.
    jerk_time: f64,
    acceleration_time: f64,
}

impl Ramp {
    fn new(from: f64, to: f64, limits: &PathLimits) -> Self {
        let PathLimits { acceleration, jerk, .. } = *limits;
        let change = (to - from).abs();
        let (jerk_time, acceleration_time) = if change >= acceleration * acceleration / jerk {
            (acceleration / jerk, change / acceleration - acceleration / jerk)
        } else {
            ((change / jerk).sqrt(), 0.0)
        };
        Self { from, to, jerk: jerk.copysign(to - from), jerk_time, acceleration_time }
    }

    fn time(&self) -> f64 {
        2.0 * self.jerk_time + self.acceleration_time
    }

    fn distance(&self) -> f64 {
        (self.from + self.to) / 2.0 * self.time()
    }

    /// Appends its pieces.
    fn extend(&self, pieces: &mut Vec<TimingPiece>, place: f64) {
        let phases =
            [(self.jerk, self.jerk_time), (0.0, self.acceleration_time), (-self.jerk, self.jerk_time)];
        let mut state = PathState { position: place, velocity: self.from, ..PathState::default() };
        for (jerk, duration) in phases {
            if duration > 0.0 {
                let piece = constant_jerk(&state, jerk, duration);
                state = piece.end();
                pieces.push(piece);
            }
        }
    }
}

/// The highest speed that is reached from `speed` over `distance`, without acceleration at either end.
fn reach(speed: f64, distance: f64, limits: &PathLimits) -> f64 {
    let PathLimits { acceleration, jerk, .. } = *limits;
    // The gain at which the acceleration is reached for an instant only.
    let knee = acceleration * acceleration / jerk;
    if (2.0 * speed + knee) * acceleration / jerk <= distance {
        // L = (v + v₁)/2 ((v₁ − v)/A + A/J), solved for v₁.
        let root = (knee - 2.0 * speed).hypot((8.0 * acceleration * distance).sqrt());
        return (root - knee) / 2.0;
    }
    // L = (2v + J t²) t, the duration of either jerk phase being t.
    let mut time = (distance / jerk).cbrt();
    if speed > 0.0 {
        time = time.min(distance / (2.0 * speed));
        // Convex and rising: Newton's steps come from above and never pass the root.
        for _ in 0..NEWTON_STEPS {
            let excess = (2.0 * speed + jerk * time * time) * time - distance;
            let next = time - excess / (2.0 * speed + 3.0 * jerk * time * time);
            if next >= time {
                break;
            }
            time = next;
        }
    }
    speed + jerk * time * time
}

#[cfg(test)]
mod tests {
    use super::super::course::Stretch;
    use super::*;

    const LIMITS: PathLimits = PathLimits { speed: 0.25, acceleration: 10.0, jerk: 500.0 };

    fn plain(stretches: &[Stretch], start: f64) -> Plain {
        let length = stretches.last().unwrap().to;
        Plain::new::<()>(&Limits::new::<()>(stretches, length).unwrap(), start).unwrap()
    }

    /// Ends at rest at the end, joins its pieces, and keeps each stretch's limits. Returns the highest share of
    /// the path's limits.
    fn assert_sound(plain: &Plain, stretches: &[Stretch], start: f64, what: &str) {
        let length = stretches.last().unwrap().to;
        let mut state = PathState { velocity: start, ..PathState::default() };
        for piece in &plain.pieces {
            let begin = piece.at(0.0);
            assert!((begin.position - state.position).abs() <= 1e-12 * length, "{what}");
            assert!((begin.velocity - state.velocity).abs() <= 1e-9 * begin.velocity.max(1e-3), "{what}");
            assert!((begin.acceleration - state.acceleration).abs() <= 1e-9 * LIMITS.acceleration, "{what}");
            for look in 1..8 {
                let here = piece.at(piece.duration * f64::from(look) / 8.0);
                let index = stretches.partition_point(|stretch| stretch.to < here.position);
                let limits = stretches[index].limits;
                assert!(here.velocity <= limits.speed * (1.0 + 1e-9), "{what}: {here:?} {limits:?}");
                assert!(here.acceleration.abs() <= limits.acceleration * (1.0 + 1e-9), "{what}: {here:?}");
                assert!(piece.jerk.abs() <= limits.jerk * (1.0 + 1e-9), "{what}: {here:?}");
                assert!(here.velocity >= -1e-12, "{what}");
            }
            state = piece.end();
        }
        assert!((state.position - length).abs() <= 1e-12 * length, "{what}");
        assert!(state.velocity.abs() <= 1e-9, "{what}");
        assert!((duration(&plain.pieces) - plain.duration).abs() <= 1e-9 * plain.duration, "{what}");
    }

    /// Lengths over seven decades and three speeds: the motion ends at rest at the end, keeps its limits, and
    /// takes the time that a closed form gives.
    #[test]
    fn every_length_ends_at_rest_within_its_limits() {
        for speed in [0.005, 0.25, 3.0] {
            let limits = PathLimits { speed, ..LIMITS };
            for step in 0..140 {
                let length = 10f64.powf(-5.0 + 0.05 * f64::from(step));
                let stretches = [Stretch { to: length, limits }];
                let plain = plain(&stretches, 0.0);
                assert_sound(&plain, &stretches, 0.0, &format!("{length} {speed}"));
                let PathLimits { acceleration: a, jerk: j, .. } = limits;
                let rise = |v: f64| if v >= a * a / j { v / a + a / j } else { 2.0 * (v / j).sqrt() };
                let reaches_speed = length >= speed * rise(speed);
                let peak = plain.pieces.iter().map(|piece| piece.velocity).fold(0.0, f64::max);
                assert_eq!(peak >= speed * (1.0 - 1e-9), reaches_speed, "{length} {speed}");
                if reaches_speed {
                    let wanted = length / speed + rise(speed);
                    assert!((plain.duration / wanted - 1.0).abs() < 1e-12, "{length} {speed}");
                }
            }
        }
    }

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    }

    /// 300 chains of up to 40 stretches, from 10 µm to 0.1 m and 5 mm/s to 1 m/s, some from a start in motion.
    #[test]
    fn every_chain_keeps_the_limits_of_each_stretch() {
        let mut seed = 1;
        let mut hasty = 0;
        for case in 0..300 {
            let count = 1 + (40.0 * random(&mut seed)) as usize;
            let mut to = 0.0;
            let stretches: Vec<Stretch> = (0..count)
                .map(|_| {
                    to += 10f64.powf(-5.0 + 4.0 * random(&mut seed));
                    let speed = 10f64.powf(-2.3 + 2.3 * random(&mut seed));
                    let acceleration = 10f64.powf(2.0 * random(&mut seed) - 1.0);
                    Stretch { to, limits: PathLimits { speed, acceleration, jerk: 50.0 * acceleration } }
                })
                .collect();
            let limits = Limits::new::<()>(&stretches, to).unwrap();
            let still = Plain::new::<()>(&limits, 0.0).unwrap();
            assert_sound(&still, &stretches, 0.0, &format!("chain {case}"));
            match Plain::new::<()>(&limits, stretches[0].limits.speed) {
                Ok(moving) => {
                    assert_sound(&moving, &stretches, stretches[0].limits.speed, &format!("chain {case}"));
                    // A start that leaves no way to the highest speeds may cost more than it brings.
                    let segments: Vec<Segment> =
                        limits.parts().map(|(from, to, limits)| Segment { from, to, limits }).collect();
                    if stretches[0].limits.speed <= highest(&segments)[0] * (1.0 + SAME) {
                        assert!(moving.duration < still.duration);
                    } else {
                        hasty += 1;
                    }
                }
                Err(TimingError::Start { speed, limit }) => {
                    let moving = Plain::new::<()>(&limits, limit).unwrap();
                    assert!(limit < speed);
                    assert_sound(&moving, &stretches, limit, &format!("chain {case}"));
                }
                Err(error) => panic!("{error:?}"),
            }
        }
        assert!(hasty > 0, "{hasty}");
    }

    /// A corner that was known by its first 8 µm, and then whole: the way to brake to its speed is longer than the way to rest was.
    #[test]
    fn what_braked_to_rest_passes_when_the_path_goes_on() {
        let line = PathLimits { speed: 0.04, acceleration: 2.0, jerk: 200.0 };
        let corner = PathLimits { speed: 0.0047, ..line };
        let known = |to: f64| [Stretch { to: 0.61018e-3, limits: line }, Stretch { to, limits: corner }];
        for to in [0.618e-3, 0.664e-3] {
            let stretches = known(to);
            assert_sound(&plain(&stretches, 0.04), &stretches, 0.04, &format!("{to}"));
        }
    }

    /// However much way there is to brake.
    #[test]
    fn a_start_faster_than_its_stretch_is_refused() {
        let limits = Limits::new::<()>(&[Stretch { to: 1.0, limits: LIMITS }], 1.0).unwrap();
        let refused = Plain::new::<()>(&limits, 1.01 * LIMITS.speed).unwrap_err();
        assert_eq!(refused, TimingError::Start { speed: 1.01 * LIMITS.speed, limit: LIMITS.speed });
        assert!(Plain::new::<()>(&limits, LIMITS.speed).is_ok());
    }

    /// From 0.1 to 0.25 m/s and back, and to rest: every ramp in the faster stretch.
    #[test]
    fn the_slower_speed_holds_where_two_meet() {
        let slow = PathLimits { speed: 0.1, ..LIMITS };
        let stretches = [
            Stretch { to: 0.1, limits: slow },
            Stretch { to: 0.2, limits: LIMITS },
            Stretch { to: 0.3, limits: slow },
        ];
        let plain = plain(&stretches, 0.0);
        assert_sound(&plain, &stretches, 0.0, "");
        let ramp = |from: f64, to: f64| (from + to) / 2.0 * 2.0 * ((to - from) / LIMITS.jerk).sqrt();
        let cruises: Vec<[f64; 3]> = plain
            .holds
            .iter()
            .filter(|hold| hold.to > hold.from)
            .map(|hold| [hold.place, hold.end(), hold.speed])
            .collect();
        let wanted = [
            [ramp(0.0, 0.1), 0.1, 0.1],
            [0.1 + ramp(0.1, 0.25), 0.2 - ramp(0.1, 0.25), 0.25],
            [0.2, 0.3 - ramp(0.0, 0.1), 0.1],
        ];
        for (found, wanted) in cruises.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-12, "{cruises:?}");
        }
        assert_eq!(cruises.len(), 3);
    }

    /// 20,000 moves of 1 mm with one speed but different accelerations are one cruise; and where every speed
    /// differs, the way up and down is not slower than all at the least limits by more than 1 %.
    #[test]
    fn short_moves_do_not_hold_it_up() {
        let chain = |speed: fn(usize) -> f64| -> Vec<Stretch> {
            let limits = |i| PathLimits {
                speed: speed(i),
                acceleration: if i % 2 == 0 { 10.0 } else { 9.0 },
                ..LIMITS
            };
            (0..20_000).map(|i| Stretch { to: 1e-3 * (i + 1) as f64, limits: limits(i) }).collect()
        };
        for stretches in [chain(|_| 0.25), chain(|i| 0.25 + 1e-4 * (i % 7) as f64)] {
            let plain = plain(&stretches, 0.0);
            assert_sound(&plain, &stretches, 0.0, "");
            let least = [Stretch { to: 20.0, limits: PathLimits { acceleration: 9.0, ..LIMITS } }];
            let simple = self::plain(&least, 0.0);
            assert!(plain.duration <= simple.duration * (1.0 + 1e-4), "{}", plain.duration);
            let ramp = plain.holds.iter().find(|hold| hold.speed >= 0.25).unwrap();
            assert!(ramp.from < 1.1 * simple.holds[1].from, "{ramp:?} {:?}", simple.holds[1]);
        }
    }
}
