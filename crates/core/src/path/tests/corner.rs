//! Corners, judged by dense sampling of the poses.

use std::f64::consts::{PI, TAU};
use std::format;
use std::string::String;
use std::vec::Vec;

use super::super::corner::{Blend, Bound, Corner, CornerZone, MustStop};
use super::random::Random;
use super::*;

/// What joins the corner on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Line,
    Arc,
    Quintic,
}

impl Random {
    fn log_within(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    fn unit(&mut self) -> Vector3 {
        self.vector(1.0).normalize()
    }

    fn across(&mut self, direction: &Vector3) -> Vector3 {
        direction.cross(&self.unit()).normalize()
    }

    fn kind(&mut self) -> Kind {
        match self.within(0.0, 1.0) {
            x if x < 0.48 => Kind::Line,
            x if x < 0.96 => Kind::Arc,
            _ => Kind::Quintic,
        }
    }

    /// A path of random length that leaves `corner` in a direction.
    fn leaving(&mut self, corner: &Pose, direction: &Vector3, kind: Kind) -> Path {
        let length = self.log_within(1e-3, 1.0);
        let turned = |random: &mut Self, position: Vector3| {
            Pose::from_parts(
                position.into(),
                Rotation::from_scaled_axis(random.vector(0.5)) * corner.rotation,
            )
        };
        let from = corner.translation.vector;
        match kind {
            Kind::Line => Path::line(corner, &turned(self, from + direction * length)),
            Kind::Arc => {
                let side = self.across(direction);
                let angle = self.within(0.3, 5.0);
                let radius = length / angle;
                let at = |angle: f64| from + (direction * angle.sin() + side * (1.0 - angle.cos())) * radius;
                let (via, end) = (turned(self, at(0.5 * angle)), turned(self, at(angle)));
                Path::arc(corner, &via, &end).unwrap()
            }
            Kind::Quintic => {
                let away = (direction + self.vector(0.5)).normalize();
                let near = Path::line(corner, &turned(self, from + direction * length));
                let end = turned(self, from + (direction + away) * length);
                let far = Path::line(&end, &turned(self, end.translation.vector + away * length));
                Path::blend(&near.jet(0.0), &far.jet(0.0)).unwrap()
            }
        }
    }

    /// Two paths that meet at an angle, with what is permitted there.
    fn corner(&mut self, kinds: [Kind; 2], angle: f64) -> (Path, Path, CornerZone) {
        let corner = self.pose(1.0, 1.0);
        let forward = self.unit();
        let onward = forward * angle.cos() + self.across(&forward) * angle.sin();
        let before = reversed(&self.leaving(&corner, &-forward, kinds[0]), kinds[0]);
        let after = self.leaving(&corner, &onward, kinds[1]);
        let room = [0.5 * before.length(), 0.5 * after.length()];
        let zone = CornerZone { position: self.log_within(1e-5, 1e-2), orientation: None, room };
        (before, after, zone)
    }
}

/// The path run backwards.
fn reversed(path: &Path, kind: Kind) -> Path {
    let at = |share: f64| path.pose(path.length() * share);
    match kind {
        Kind::Line => Path::line(&at(1.0), &at(0.0)),
        Kind::Arc => Path::arc(&at(1.0), &at(0.5), &at(0.0)).unwrap(),
        Kind::Quintic => {
            let backwards = |s: f64| {
                let jet = path.jet(s);
                let turn = |[first, second, third]: [Vector3; 3]| [-first, second, -third];
                PoseJet { pose: jet.pose, linear: turn(jet.linear), angular: turn(jet.angular) }
            };
            Path::blend(&backwards(path.length()), &backwards(0.0)).unwrap()
        }
    }
}

/// The parameter in [low, high] with the least value, by golden section.
fn least(value: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    for _ in 0..36 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        if value(left) < value(right) { high = right } else { low = left }
    }
    value(0.5 * (low + high))
}

/// Least value on a path's coordinates: golden section about each sample that is not above its neighbours.
fn least_along(length: f64, samples: usize, value: &dyn Fn(f64) -> f64) -> f64 {
    let at = |k: usize| length * k as f64 / samples as f64;
    let values: Vec<f64> = (0..=samples).map(|k| value(at(k))).collect();
    let beside = |k: usize| (k.saturating_sub(1), (k + 1).min(samples));
    let lows = (0..=samples).filter(|&k| {
        let (before, after) = beside(k);
        values[k] <= values[before] && values[k] <= values[after]
    });
    let refined = lows.map(|k| least(value, at(beside(k).0), at(beside(k).1)).min(values[k]));
    refined.fold(f64::INFINITY, f64::min)
}

/// Distance of a point from a path: by formula for a line and a circle, else by search from a coordinate on.
fn distance(path: &Path, point: &Vector3, kind: Kind, [from, to_end]: [f64; 2]) -> f64 {
    let to = |s: f64| (path.pose(s).translation.vector - point).norm();
    let ends = to(0.0).min(to(path.length()));
    match (kind, path.curve()) {
        (Kind::Line, _) => {
            let jet = path.jet(0.0);
            let offset = point - jet.pose.translation.vector;
            let s = offset.dot(&jet.linear[0]);
            if s < 0.0 || s > path.length() { ends } else { offset.cross(&jet.linear[0]).norm() }
        }
        (Kind::Arc, Curve::Arc(arc)) => {
            let normal = arc.radial.cross(&arc.tangent);
            let offset = point - arc.centre;
            let height = offset.dot(&normal);
            let flat = offset - normal * height;
            let angle = flat.dot(&arc.tangent).atan2(flat.dot(&arc.radial)).rem_euclid(TAU);
            if angle > arc.angle { ends } else { height.hypot(flat.norm() - arc.radius) }
        }
        _ => least_along(to_end - from, 12, &|s| to(from + s)),
    }
}

/// The error of a blend as the module defines it, found from poses alone.
fn measured(before: &Path, after: &Path, blend: &Blend, kinds: [Kind; 2]) -> f64 {
    let corner = after.pose(0.0).translation.vector;
    let length = blend.path.length();
    let point = |s: f64| blend.path.pose(s).translation.vector;
    let from_corner = least_along(length, 60, &|s| (point(s) - corner).norm());
    let near = [[before.length() - 1.5 * blend.trims[0], before.length()], [0.0, 1.5 * blend.trims[1]]];
    let from_paths = least_along(length, 60, &|s| {
        let on_before = distance(before, &point(s), kinds[0], near[0]);
        -on_before.min(distance(after, &point(s), kinds[1], near[1]))
    });
    from_corner.max(-from_paths)
}

/// Position, tangent and curvature where a path starts (`sign` 1) or ends (−1), from points `step` apart alone.
fn by_differences(path: &Path, sign: f64, step: f64) -> [Vector3; 3] {
    let origin = if sign > 0.0 { 0.0 } else { path.length() };
    let p = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|k| path.pose(origin + sign * k * step).translation.vector);
    let first = p[0] * (-25.0 / 12.0) + p[1] * 4.0 - p[2] * 3.0 + p[3] * (4.0 / 3.0) - p[4] * 0.25;
    let second = p[0] * 3.75 - p[1] * (77.0 / 6.0) + p[2] * (107.0 / 6.0) - p[3] * 13.0
        + p[4] * (61.0 / 12.0)
        - p[5] * (5.0 / 6.0);
    [p[0], first * (sign / step), second / (step * step)]
}

/// Cut paths and blend follow each other with continuous curvature and turning.
fn is_continuous(blend: &Blend) -> bool {
    let length = blend.path.length();
    let step = (2e-3 * length).min(0.05 / blend.greatest_curvature);
    // Rounding of coordinates of about a metre, and the differences' own error.
    let (slope_error, bend_error) =
        (1e-4 + 1e-14 / step, 1e-2 * (blend.greatest_curvature + 1.0 / length) + 1e-13 / (step * step));
    let cuts = [blend.before.jet(blend.before.length()), blend.after.jet(0.0)];
    let own = [blend.path.jet(0.0), blend.path.jet(length)];
    let mut continuous = true;
    for ((cut, own), sign) in cuts.iter().zip(&own).zip([1.0, -1.0]) {
        let [position, tangent, curvature] = by_differences(&blend.path, sign, step);
        let turn = (own.pose.rotation * cut.pose.rotation.inverse()).scaled_axis().norm();
        continuous &= (position - cut.pose.translation.vector).norm() < 1e-14
            && (tangent - cut.linear[0]).norm() < slope_error
            && (curvature - cut.linear[1]).norm() < bend_error
            && (own.linear[1] - cut.linear[1]).norm() < 1e-10 * (blend.greatest_curvature + 1.0 / length)
            && turn < 1e-13
            && (own.angular[0] - cut.angular[0]).norm() < 1e-10 / length
            && (own.angular[1] - cut.angular[1]).norm() < 1e-10 / (length * length);
    }
    continuous
}

/// One random corner solved and judged: how the blend was bound, or what is wrong with it.
fn judge(random: &mut Random) -> Result<Bound, String> {
    let kinds = [random.kind(), random.kind()];
    let angle = match random.within(0.0, 1.0) {
        x if x < 0.1 => 0.0,
        x if x < 0.2 => random.log_within(1e-7, 0.1),
        x if x < 0.3 => PI - random.log_within(0.06, 0.5),
        _ => random.within(0.0, 3.08),
    };
    let (before, after, zone) = random.corner(kinds, angle);
    let blend = match Corner::between(&before, &after, &zone) {
        Corner::Blend(blend) => blend,
        other => return Err(format!("{kinds:?} at {angle}: {other:?}")),
    };
    let error = measured(&before, &after, &blend, kinds);
    let Blend { trims, error: told, bound, .. } = blend;
    let good = error <= zone.position * 1.0002
        && (error - told).abs() <= 5e-4 * error + 1e-9
        && (bound != Bound::Position || error >= 0.999 * zone.position)
        && trims[0] <= zone.room[0]
        && trims[1] <= zone.room[1];
    if good && is_continuous(&blend) {
        return Ok(bound);
    }
    Err(format!(
        "{kinds:?} at {angle}: {error:e} (told {told:e}), trims {trims:?}, {bound:?}, {zone:?}, continuous: {}",
        is_continuous(&blend)
    ))
}

/// Judges so many corners; prints what is wrong, and counts: wrong, bound by position, by orientation, by room.
fn sweep(seed: u64, cases: u32) -> [u32; 4] {
    let (mut counts, mut random) = ([0; 4], Random(seed));
    for _ in 0..cases {
        counts[match judge(&mut random) {
            Err(wrong) => {
                std::println!("{wrong}");
                0
            }
            Ok(Bound::Position) => 1,
            Ok(Bound::Orientation) => 2,
            Ok(Bound::Room) => 3,
        }] += 1;
    }
    std::println!("wrong, bound by position, orientation, room: {counts:?}");
    counts
}

#[test]
fn random_corners_have_the_permitted_error() {
    let [wrong, by_position, ..] = sweep(6, 500);
    assert_eq!(wrong, 0);
    assert!(by_position > 150, "{by_position} corners tell about the error");
}

/// `cargo test --release -p seamline --features std --lib a_million_random_corners -- --ignored --nocapture`
#[test]
#[ignore = "a million corners take minutes"]
fn a_million_random_corners_have_the_permitted_error() {
    let wrong: u32 = (100..110).map(|seed| sweep(seed, 100_000)[0]).sum();
    assert_eq!(wrong, 0);
}

#[test]
fn a_right_angle_of_lines_is_cut_where_the_formula_says() {
    // Control points at 0.609375 and 0.295625 of the trim: the middle is 0.2188 trims·√2 from the corner.
    let at = |x: f64, y: f64| pose(x, y, 0.0, [0.0; 3]);
    let (before, after) =
        (Path::line(&at(-1.0, 0.0), &at(0.0, 0.0)), Path::line(&at(0.0, 0.0), &at(0.0, 1.0)));
    let zone = CornerZone { position: 1e-3, orientation: None, room: [0.5; 2] };
    let Corner::Blend(blend) = Corner::between(&before, &after, &zone) else { panic!("no blend") };
    assert!((blend.trims[0] / 3.231e-3 - 1.0).abs() < 1e-3, "{:?}", blend.trims);
    assert_eq!((blend.bound, blend.orientation_error), (Bound::Position, 0.0));
    assert!((blend.greatest_curvature * 1e-3 / 0.4877 - 1.0).abs() < 0.01, "{}", blend.greatest_curvature);
    // Less room on one side: the other is cut back twice as far, and the error is less than permitted.
    let zone = CornerZone { room: [1e-3, 0.5], ..zone };
    let Corner::Blend(blend) = Corner::between(&before, &after, &zone) else { panic!("no blend") };
    assert!((blend.trims[0] - 1e-3).abs() < 1e-15 && (blend.trims[1] - 2e-3).abs() < 1e-15);
    assert!(blend.bound == Bound::Room && blend.error < zone.position);
}

#[test]
fn straight_on_only_the_turning_is_blended() {
    let at = |x: f64, turn: f64| pose(x, 0.0, 0.0, [turn, 0.0, 0.0]);
    let (before, after) =
        (Path::line(&at(0.0, 0.0), &at(1.0, 0.0)), Path::line(&at(1.0, 0.0), &at(2.0, 1.0)));
    let room = [0.5; 2];
    let zone = CornerZone { position: 1e-3, orientation: Some(0.01), room };
    let Corner::Blend(blend) = Corner::between(&before, &after, &zone) else { panic!("no blend") };
    // A rate that steps by Δω is off by 3/16·Δω·trim in the middle.
    assert!((blend.trims[0] * 3.0 / 16.0 / 0.01 - 1.0).abs() < 0.05, "{:?}", blend.trims);
    assert!(blend.orientation_error <= 0.01 && blend.bound == Bound::Orientation);
    for k in 0..=20 {
        let point = blend.path.pose(blend.path.length() * f64::from(k) / 20.0).translation.vector;
        assert!(point.y.hypot(point.z) < 1e-15);
    }
    // By default 0.2°: here the trim of a right angle, 3.2 mm, gives less.
    let zone = CornerZone { orientation: None, ..zone };
    let Corner::Blend(blend) = Corner::between(&before, &after, &zone) else { panic!("no blend") };
    assert!((blend.orientation_error / 0.2_f64.to_radians() - 1.0).abs() < 0.05);
}

#[test]
fn what_cannot_be_passed_is_a_stop_and_what_goes_on_is_smooth() {
    let at = |x: f64, y: f64, turn: f64| pose(x, y, 0.0, [turn, 0.0, 0.0]);
    let zone = CornerZone { position: 1e-3, orientation: None, room: [0.5; 2] };
    let line = Path::line(&at(0.0, 0.0, 0.0), &at(1.0, 0.0, 0.5));
    let next = |end: Pose| Path::line(&at(1.0, 0.0, 0.5), &end);
    let go = |after: &Path, zone: &CornerZone| Corner::between(&line, after, zone);
    assert_eq!(go(&next(at(2.0, 0.0, 1.0)), &zone), Corner::Smooth);
    assert_eq!(go(&next(at(0.5, 0.01, 0.5)), &zone), Corner::Stop(MustStop::Reversal));
    assert_eq!(go(&next(at(1.0, 0.0, 1.0)), &zone), Corner::Stop(MustStop::OnTheSpot));
    assert_eq!(go(&line, &zone), Corner::Stop(MustStop::Apart));
    let aside = next(at(1.0, 1.0, 0.5));
    for zone in [CornerZone { position: 0.0, ..zone }, CornerZone { room: [0.5, 0.0], ..zone }] {
        assert_eq!(go(&aside, &zone), Corner::Stop(MustStop::NothingPermitted));
    }
    // Parts of one circle go on smoothly too.
    let arc = Path::arc(&at(0.0, 0.0, 0.0), &at(0.1, 0.1, 0.1), &at(0.0, 0.2, 0.3)).unwrap();
    let (first, second) = (arc.part(0.0, 0.1), arc.part(0.1, arc.length()));
    assert_eq!(Corner::between(&first, &second, &zone), Corner::Smooth);
}
