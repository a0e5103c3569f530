//! How far a pose lies from a programmed path.

use std::f64::consts::{PI, TAU};

use seamline::geometry::{Pose, Rotation, Vector3};
use seamline::path::{Arc, Curve, Measure, Orientation, Path, SeamFrame};

/// Where a pose stands with respect to a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Deviation {
    /// Path coordinate of the nearest point: metres, or radians for a turn on the spot.
    pub(super) s: f64,
    /// The pose's position without the weave: where it stands at the seam.
    pub(super) seam: Vector3,
    /// Distance from the curve with its weave, in metres.
    pub(super) distance: f64,
    /// Angle from the programmed orientation at `s`, in radians.
    pub(super) angle: f64,
}

/// Steps of the search for the nearest point of a woven path; between two cycles it takes two or three.
const STEPS: usize = 20;
/// Steps shorter than this end it: a picometre.
const SAME_PLACE: f64 = 1e-12;

/// A path prepared for the question.
#[derive(Debug, Clone, Copy)]
pub(super) struct Programmed {
    path: Path,
    start: Rotation,
    /// The whole turn of the orientation, as a rotation vector.
    turn: Vector3,
}

impl Programmed {
    pub(super) fn new(path: &Path) -> Self {
        let (start, end) = (path.pose(0.0).rotation, path.pose(path.length()).rotation);
        let turn = (end * start.inverse()).scaled_axis();
        Self { path: *path, start, turn }
    }

    /// Whether a weave goes about it.
    pub(super) fn is_woven(&self) -> bool {
        self.path.is_woven()
    }

    /// `last_s` is the coordinate of the last question: a woven path may come near to a pose several times. NaN where there was none.
    pub(super) fn deviation(&self, pose: &Pose, last_s: f64) -> Deviation {
        let position = pose.translation.vector;
        let (on_curve, distance) = match self.path.curve() {
            Curve::Line { start, direction, length } => from_line(&position, start, direction, *length),
            Curve::Arc(arc) => from_arc(&position, arc),
            Curve::Quintic(curve) => curve.nearest(&position),
        };
        let turned = pose.rotation * self.start.inverse();
        let s = match self.path.measure() {
            Measure::Length => on_curve,
            Measure::Angle => nearest_turn(&turned, &self.turn),
        };
        let (s, seam, distance) = if self.path.is_woven() {
            self.off_weave(&position, if last_s.is_nan() { s } else { last_s })
        } else {
            (s, position, distance)
        };
        Deviation { s, seam, distance, angle: (turned * self.programmed(s).inverse()).angle() }
    }

    /// Distance of a pose across from the coordinate `s` from where a correction (to the left, up; metres) puts it.
    pub(super) fn beside(&self, pose: &Pose, s: f64, [lateral, height]: [f64; 2]) -> f64 {
        let jet = self.path.seam_jet(s);
        let aside = SeamFrame::of(&jet).map_or_else(Vector3::zeros, |at| at.vector([0.0, lateral, height]));
        (pose.translation.vector - jet.pose.translation.vector - aside).norm()
    }

    /// The nearest point of the woven path, found by Gauss and Newton's method from a place near to it: its coordinate, the position without the
    /// weave there, and the distance.
    fn off_weave(&self, position: &Vector3, near: f64) -> (f64, Vector3, f64) {
        let mut s = near;
        for _ in 0..STEPS {
            let jet = self.path.jet(s);
            let (off, along) = (position - jet.pose.translation.vector, jet.linear[0]);
            let next = (s + off.dot(&along) / along.norm_squared()).clamp(0.0, self.path.length());
            let step = next - s;
            s = next;
            if step.abs() < SAME_PLACE {
                break;
            }
        }
        let off = position - self.path.pose(s).translation.vector;
        (s, self.path.seam_jet(s).pose.translation.vector + off, off.norm())
    }

    /// The programmed turn from the start: the geodesic, or what the path has through its via point.
    fn programmed(&self, s: f64) -> Rotation {
        match self.path.orientation() {
            Orientation::Geodesic(_) if self.path.length() > 0.0 => {
                Rotation::from_scaled_axis(self.turn * (s / self.path.length()))
            }
            Orientation::Geodesic(_) => Rotation::identity(),
            Orientation::Through(_) | Orientation::Quintic(_) => {
                self.path.pose(s).rotation * self.start.inverse()
            }
        }
    }
}

fn from_line(position: &Vector3, start: &Vector3, direction: &Vector3, length: f64) -> (f64, f64) {
    let offset = position - start;
    let s = offset.dot(direction).clamp(0.0, length);
    (s, (offset - direction * s).norm())
}

/// Beyond the ends of the arc the nearest end counts.
fn from_arc(position: &Vector3, arc: &Arc) -> (f64, f64) {
    let offset = position - arc.centre;
    let angle = offset.dot(&arc.tangent).atan2(offset.dot(&arc.radial)).rem_euclid(TAU);
    let opposite = 0.5 * arc.angle + PI;
    let angle = match angle {
        angle if angle <= arc.angle => angle,
        angle if angle < opposite => arc.angle,
        _ => 0.0,
    };
    let nearest = (arc.radial * angle.cos() + arc.tangent * angle.sin()) * arc.radius;
    (arc.radius * angle, (offset - nearest).norm())
}

/// How far along `turn` (a rotation vector) a rotation has come: the angle that leaves the least rest.
fn nearest_turn(turned: &Rotation, turn: &Vector3) -> f64 {
    let whole = turn.norm();
    if whole == 0.0 {
        return 0.0;
    }
    // A rotation by φ about u is (cos φ/2, u sin φ/2); both signs are the same rotation.
    let sine = turned.imag().dot(turn) / whole;
    let angle = 2.0 * sine.atan2(turned.scalar());
    let angle = if angle > PI {
        angle - TAU
    } else if angle < -PI {
        angle + TAU
    } else {
        angle
    };
    angle.clamp(0.0, whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::testing::Random;

    fn pose(random: &mut Random) -> Pose {
        let mut vector = |size: f64| {
            Vector3::new(random.within(-size, size), random.within(-size, size), random.within(-size, size))
        };
        Pose::new(vector(1.0), vector(1.5))
    }

    fn perpendicular(direction: &Vector3) -> Vector3 {
        let other = if direction.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        direction.cross(&other).normalize()
    }

    /// 2,000 random lines, arcs and turns on the spot: a pose moved off the path by a known distance and angle is found
    /// with just these.
    #[test]
    fn known_offsets_are_found() {
        let mut random = Random::new(3);
        for case in 0..2000 {
            let (start, via, mut end) = (pose(&mut random), pose(&mut random), pose(&mut random));
            if case % 3 == 2 {
                end.translation = start.translation;
            }
            let path = match case % 3 {
                0 => Path::arc(&start, &via, &end).unwrap(),
                _ => Path::line(&start, &end),
            };
            let s = path.length() * random.within(0.05, 0.95);
            let jet = path.jet(s);
            let distance = random.within(0.0, 1e-3);
            let angle = random.within(0.0, 1e-3);
            let sideways = perpendicular(&if case % 3 == 2 { Vector3::x() } else { jet.linear[0] });
            let axis = perpendicular(&jet.angular[0].normalize());
            let tilted = Pose::from_parts(
                (jet.pose.translation.vector + sideways * distance).into(),
                Rotation::from_scaled_axis(axis * angle) * jet.pose.rotation,
            );
            let found = Programmed::new(&path).deviation(&tilted, f64::NAN);
            assert!((found.s - s).abs() < 1e-9, "case {case}: {} for {s}", found.s);
            assert!((found.distance - distance).abs() < 1e-12, "case {case}");
            assert!((found.angle - angle).abs() < 1e-9, "case {case}: {} for {angle}", found.angle);
        }
    }

    /// Points beyond the ends are measured from the ends, on a line and on an arc.
    #[test]
    fn overshoot_counts() {
        let at = |x: f64, y: f64| Pose::translation(x, y, 0.0);
        let line = Programmed::new(&Path::line(&at(0.0, 0.0), &at(1.0, 0.0)));
        assert_eq!(line.deviation(&at(1.5, 0.0), f64::NAN).distance, 0.5);
        assert_eq!(line.deviation(&at(-0.25, 0.0), f64::NAN).distance, 0.25);
        let side = std::f64::consts::FRAC_1_SQRT_2;
        let arc = Programmed::new(&Path::arc(&at(1.0, 0.0), &at(side, side), &at(0.0, 1.0)).unwrap());
        assert!((arc.deviation(&at(1.0, -0.1), f64::NAN).distance - 0.1).abs() < 1e-2);
        assert_eq!(arc.deviation(&at(1.0, -0.1), f64::NAN).s, 0.0);
        assert!((arc.deviation(&at(-0.1, 1.0), f64::NAN).s - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
