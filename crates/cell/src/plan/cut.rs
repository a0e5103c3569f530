//! Cuts a motion along a route into the motions along its paths.

use seamline::path::TimingPiece;

/// Steps of the search for the instant of passing a place; Newton's method takes four or five.
const STEPS: usize = 60;
/// A place this near to a piece's end, as a share of the piece, is its end.
const AT_END: f64 = 1e-9;

/// The pieces of each path, in its own coordinate; `ends` are the paths' ends in the route's coordinate. Pieces after the last end
/// are left out.
pub(super) fn by_path(pieces: &[TimingPiece], ends: &[f64]) -> Vec<Vec<TimingPiece>> {
    let mut parts = vec![Vec::new(); ends.len()];
    let (mut index, mut start) = (0, 0.0);
    for piece in pieces {
        let mut left = *piece;
        while index < ends.len() {
            let end = ends[index];
            let ends_here = index + 1 == ends.len();
            let reached = left.end().position;
            if ends_here || reached <= end + AT_END * (reached - left.position) {
                parts[index].push(TimingPiece { position: left.position - start, ..left });
                if !ends_here && reached >= end {
                    (index, start) = (index + 1, end);
                }
                break;
            }
            let time = passing(&left, end);
            if time > 0.0 {
                parts[index].push(TimingPiece { duration: time, position: left.position - start, ..left });
            }
            left = TimingPiece { position: end, ..rest(&left, time) };
            (index, start) = (index + 1, end);
        }
    }
    parts
}

/// Pieces with a coordinate that begins at a place.
pub(super) fn moved_back(pieces: &[TimingPiece], place: f64) -> Vec<TimingPiece> {
    pieces.iter().map(|piece| TimingPiece { position: piece.position - place, ..*piece }).collect()
}

/// What is left of a piece after a time.
fn rest(piece: &TimingPiece, time: f64) -> TimingPiece {
    let state = piece.at(time);
    TimingPiece {
        duration: piece.duration - time,
        position: state.position,
        velocity: state.velocity,
        acceleration: state.acceleration,
        jerk: state.jerk,
        snap: piece.snap + time * piece.crackle,
        crackle: piece.crackle,
    }
}

/// When a piece passes a place: Newton's method, in a bracket that each step makes smaller.
fn passing(piece: &TimingPiece, place: f64) -> f64 {
    let (mut low, mut high) = (0.0, piece.duration);
    let mut time = 0.5 * high;
    for _ in 0..STEPS {
        let state = piece.at(time);
        let excess = state.position - place;
        if excess > 0.0 {
            high = time;
        } else {
            low = time;
        }
        let next = time - excess / state.velocity;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - time).abs() <= f64::EPSILON * piece.duration {
            return next;
        }
        time = next;
    }
    time
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An S-shaped start, a cruise and a quintic, cut at nine places, some of them where pieces meet: the parts follow one another
    /// without a jump, each begins at its path's start, and all together take the time of the whole.
    #[test]
    fn parts_are_the_whole() {
        let mut pieces = vec![
            TimingPiece { duration: 0.1, jerk: 60.0, ..TimingPiece::default() },
            TimingPiece {
                duration: 0.1,
                position: 0.01,
                velocity: 0.3,
                acceleration: 6.0,
                jerk: -60.0,
                ..TimingPiece::default()
            },
        ];
        let cruise = TimingPiece {
            duration: 0.5,
            position: pieces[1].end().position,
            velocity: pieces[1].end().velocity,
            ..TimingPiece::default()
        };
        pieces.push(cruise);
        let end = cruise.end();
        pieces.push(TimingPiece {
            duration: 0.2,
            position: end.position,
            velocity: end.velocity,
            snap: -500.0,
            crackle: 1000.0,
            ..TimingPiece::default()
        });
        let whole: f64 = pieces.iter().map(|piece| piece.duration).sum();
        let length = pieces[3].end().position;
        let ends = [1e-4, 0.005, 0.01, 0.03, cruise.position, 0.2, 0.21, end.position, length];
        let parts = by_path(&pieces, &ends);
        let mut start = 0.0;
        let mut before = (0.0, 0.0, 0.0);
        for (part, end) in parts.iter().zip(ends) {
            assert!(!part.is_empty(), "{end}");
            assert!(part[0].position.abs() < 1e-12);
            for piece in part {
                let state = piece.at(0.0);
                let now = (state.position + start, state.velocity, state.acceleration);
                let jump = [now.0 - before.0, now.1 - before.1, now.2 - before.2];
                assert!(
                    jump[0].abs() < 1e-12 && jump[1].abs() < 1e-9 && jump[2].abs() < 1e-6,
                    "{end}: {jump:?}"
                );
                let last = piece.end();
                before = (last.position + start, last.velocity, last.acceleration);
            }
            assert!((before.0 - end).abs() < 1e-12, "{end}");
            start = end;
        }
        let sum: f64 = parts.iter().flatten().map(|piece| piece.duration).sum();
        assert!((sum - whole).abs() < 1e-12);
    }
}
