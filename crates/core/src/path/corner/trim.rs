//! How far the two paths of a corner are cut back.

use core::f64::consts::{FRAC_1_SQRT_2, LN_10};

use super::super::blend::{Proportions, path, polynomial};
use super::super::curve::PointJet;
use super::super::{Curve, Path, SAME_POSITION};
use super::error::{Side, from_corner, from_paths, of_orientation};
use super::{Blend, Bound, CornerZone, ORIENTATION_ERROR};
use crate::geometry::{PoseJet, Rotation, Vector3};
use crate::math::float::{exp, ln, sin, sqrt};

/// The solver aims this far below a permitted error, in its logarithm, and is content within as much on either side.
const CONTENT: f64 = 3e-4;
/// The error of the orientation is found to a few per cent only.
const ORIENTATION_CONTENT: f64 = 0.02;
/// Evaluations of the error; the error goes as a power of the trim, so that four or five do.
const EVALUATIONS: u32 = 32;
/// Where one side has less room, the other may be trimmed this many times as far.
const UNEVENNESS: f64 = 2.0;

/// Two paths and the point where they meet.
pub(super) struct Joint<'a> {
    before: &'a Path,
    after: &'a Path,
    corner: Vector3,
    /// The orientation there: what the blend's is expressed by.
    reference: Rotation,
    angle: f64,
    /// Jump of the curvature, in 1/m.
    bend: f64,
    shape: Proportions,
    room: [f64; 2],
}

/// A trim, and whether there was no room for more.
struct Solution {
    trim: f64,
    room_ended: bool,
}

/// A blend for given trims.
struct Joined {
    trims: [f64; 2],
    polynomial: [Vector3; 6],
    path: Path,
    orientation_error: f64,
}

impl<'a> Joint<'a> {
    pub(super) fn new(
        before: &'a Path,
        after: &'a Path,
        ends: &[PoseJet; 2],
        angle: f64,
        room: [f64; 2],
    ) -> Self {
        let shape = Proportions::at(ends[0].linear[0].dot(&ends[1].linear[0]));
        // A blend that takes more than a radian out of an arc is no corner's any more.
        let within = |path: &Path, room: f64| {
            let curvature = path.curve().greatest_curvature();
            let room = room.min(path.length());
            if curvature * room > 1.0 { 1.0 / curvature } else { room }
        };
        Self {
            before,
            after,
            corner: ends[0].pose.translation.vector,
            reference: ends[0].pose.rotation,
            angle,
            bend: (ends[1].linear[1] - ends[0].linear[1]).norm(),
            shape,
            room: [within(before, room[0]), within(after, room[1])],
        }
    }

    /// The longest blend that the zone permits, or nothing where that is none.
    pub(super) fn blend(&self, zone: &CornerZone) -> Option<Blend> {
        let [shorter, longer] = [self.room[0].min(self.room[1]), self.room[0].max(self.room[1])];
        let most = longer.min(UNEVENNESS * shorter);
        let possible = shorter > SAME_POSITION;
        if !possible {
            return None;
        }
        let straight = self.closed_form(zone.position).filter(|trim| *trim <= shorter);
        let by_position = match straight {
            Some(trim) => Solution { trim, room_ended: false },
            None => {
                let error = |trim: f64| Some(self.error(self.trims(trim)));
                let power = if self.angle > 1e-3 { 1.0 } else { 2.0 };
                solve(error, zone.position, self.guess(zone.position), most, power, CONTENT)?
            }
        };
        let bound = if by_position.room_ended { Bound::Room } else { Bound::Position };
        let blend = self.join(by_position.trim)?;
        // The permitted error of the orientation costs a blend more to know; it is never less than this.
        let permitted = match zone.orientation {
            Some(error) => error,
            None if blend.orientation_error <= ORIENTATION_ERROR => ORIENTATION_ERROR,
            None => self.permitted_orientation(zone.position, by_position.trim)?,
        };
        if blend.orientation_error <= permitted {
            return Some(self.finish(&blend, bound));
        }
        let error = |trim: f64| self.join(trim).map(|blend| blend.orientation_error);
        let guess = by_position.trim * permitted / blend.orientation_error;
        let by_orientation = solve(error, permitted, guess, by_position.trim, 1.0, ORIENTATION_CONTENT)?;
        Some(self.finish(&self.join(by_orientation.trim)?, Bound::Orientation))
    }

    /// See [`CornerZone::orientation`].
    fn permitted_orientation(&self, position: f64, most: f64) -> Option<f64> {
        let right_angle = Proportions::at(0.0);
        let trim = position / (right_angle.middle() * FRAC_1_SQRT_2);
        Some(self.join(trim.min(most))?.orientation_error.max(ORIENTATION_ERROR))
    }

    /// The trim at which the blend of two straight lines, cut back equally, has a given distance from the corner.
    fn closed_form(&self, error: f64) -> Option<f64> {
        let straight = |path: &Path| matches!(path.curve(), Curve::Line { .. });
        let trim = (1.0 - CONTENT) * self.straight_trim(error);
        (straight(self.before) && straight(self.after) && trim.is_finite()).then_some(trim)
    }

    fn straight_trim(&self, error: f64) -> f64 {
        error / (self.shape.middle() * sin(0.5 * self.angle))
    }

    /// Where the search begins: as for straight lines, or as for a step of the curvature, whose blend lies off by a
    /// few hundredths of Δκ·trim².
    fn guess(&self, error: f64) -> f64 {
        self.straight_trim(error).min(sqrt(30.0 * error / self.bend.max(1e-12)))
    }

    fn trims(&self, trim: f64) -> [f64; 2] {
        self.room.map(|room| trim.min(room))
    }

    fn polynomial(&self, trims: [f64; 2]) -> [Vector3; 6] {
        let ends: [PointJet; 2] =
            [self.before.curve().jet(self.before.length() - trims[0]), self.after.curve().jet(trims[1])];
        polynomial(&ends, trims, &self.shape)
    }

    /// The error of the position, in metres.
    fn error(&self, trims: [f64; 2]) -> f64 {
        self.error_of(&self.polynomial(trims), trims)
    }

    fn error_of(&self, polynomial: &[Vector3; 6], trims: [f64; 2]) -> f64 {
        let sides = [
            Side::new(self.before, self.before.length(), 1.5 * trims[0]),
            Side::new(self.after, 0.0, 1.5 * trims[1]),
        ];
        from_paths(polynomial, &sides, from_corner(polynomial, &self.corner))
    }

    fn join(&self, trim: f64) -> Option<Joined> {
        let trims = self.trims(trim);
        let cuts = [self.before.jet(self.before.length() - trims[0]), self.after.jet(trims[1])];
        let polynomial = self.polynomial(trims);
        let blend = path(&cuts[0], &cuts[1], polynomial, self.reference).ok()?;
        let orientation_error = of_orientation(&blend, self.before, self.after, trims);
        Some(Joined { trims, polynomial, path: blend, orientation_error })
    }

    fn finish(&self, joined: &Joined, bound: Bound) -> Blend {
        let trims = joined.trims;
        Blend {
            before: self.before.part(0.0, self.before.length() - trims[0]),
            path: joined.path,
            after: self.after.part(trims[1], self.after.length()),
            trims,
            error: self.error_of(&joined.polynomial, trims),
            orientation_error: joined.orientation_error,
            greatest_curvature: joined.path.curve().greatest_curvature(),
            bound,
        }
    }
}

/// The trim at which a value that grows about as a power of it is just below `permitted`, or the greatest trim where
/// it stays below. Secants of the logarithms, held inside what is known to be below and above; nothing where the value
/// is none.
fn solve(
    value: impl Fn(f64) -> Option<f64>,
    permitted: f64,
    guess: f64,
    most: f64,
    power: f64,
    content: f64,
) -> Option<Solution> {
    let greatest = ln(most);
    // Logarithms of the trim that are known to be below and above what is permitted, and the last one's excess.
    let (mut low, mut high) = (None, None);
    let (mut x, mut slope, mut last) = (ln(guess.min(most)), power, None);
    for _ in 0..EVALUATIONS {
        let excess = ln(value(exp(x))?.max(f64::MIN_POSITIVE) / permitted) + content;
        if excess.abs() <= content {
            return Some(Solution { trim: exp(x), room_ended: false });
        }
        if excess < 0.0 && x >= greatest {
            return Some(Solution { trim: most, room_ended: true });
        }
        if excess < 0.0 {
            low = Some(x)
        } else {
            high = Some(x)
        }
        if let Some((before, excess_before)) = last.filter(|(before, _)| *before != x) {
            let secant: f64 = (excess - excess_before) / (x - before);
            slope = secant.max(0.2 * power).min(5.0 * power);
        }
        last = Some((x, excess));
        // Far from the answer the power is not yet known: at most a factor of ten at once.
        let secant = x - (excess / slope).clamp(-LN_10, LN_10);
        x = match (low, high) {
            (Some(low), Some(high)) if !(secant > low && secant < high) => 0.5 * (low + high),
            _ => secant.min(greatest),
        };
    }
    // The value may jump past the permitted one: what is below it is good.
    low.map(|x| Solution { trim: exp(x), room_ended: false })
}
