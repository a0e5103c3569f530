//! The lane: the correction as a function of path length.
//!
//! A uniform cubic B-spline c(s) = Σ dₖ B(s/Δ − k): two continuous derivatives, and a third one that is constant from knot to
//! knot. With first, second and third differences of the control points (Δ¹, Δ², Δ³ without the spacing)
//!
//! |c| ≤ max|d|, |c′| ≤ max|Δ¹d|/Δ, |c″| ≤ max|Δ²d|/Δ², c‴ = Δ³d/Δ³,
//!
//! so that what the lane demands is known before the torch is there. Between the knots k and k + 1 the points k − 1 … k + 2 count.

use super::Offset;
use crate::math::float::floor;

/// Control points held, behind the torch and ahead of it.
const CAPACITY: usize = 256;

/// The lane's offset at one place, and its first three derivatives along the taught path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneJet {
    /// c(s), in metres.
    pub offset: Offset,
    /// c′, c″ and c‴.
    pub derivatives: [Offset; 3],
}

impl LaneJet {
    /// The seam where it was taught.
    pub const TAUGHT: Self = Self { offset: Offset::new(0.0, 0.0), derivatives: [Offset::new(0.0, 0.0); 3] };
}

/// The lane of the running weld: its frozen control points, the last 256 of them. A frozen point never changes.
#[derive(Debug, Clone)]
pub struct Lane {
    points: [Offset; CAPACITY],
    spacing: f64,
    /// Numbers of the oldest and after the newest control point; number k stands at s = kΔ.
    first: i64,
    end: i64,
}

impl Lane {
    /// A lane whose points stand at multiples of `spacing`, frozen at `offset` as far as a torch at `s` needs it.
    pub(super) fn new(spacing: f64, s: f64, offset: Offset) -> Self {
        let here = floor(s / spacing) as i64;
        Self { points: [offset; CAPACITY], spacing, first: here - 1, end: here + 3 }
    }

    /// Distance Δ of the control points, in metres.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The lane at a coordinate; `None` before the oldest point or beyond [`Lane::known_to`].
    #[must_use]
    pub fn at(&self, s: f64) -> Option<LaneJet> {
        evaluate(self.spacing, s, |k| self.point(k))
    }

    /// The lane at a coordinate; beyond what is frozen as it would go on if its slope stayed. For looking ahead only.
    #[must_use]
    pub fn expected(&self, s: f64) -> Option<LaneJet> {
        let [last, before] = [self.newest(0), self.newest(1)];
        let beyond = |k: i64| last + (last - before) * (k - self.end + 1) as f64;
        evaluate(self.spacing, s, |k| if k < self.end { self.point(k) } else { Some(beyond(k)) })
    }

    /// Up to which coordinate the lane is frozen.
    #[must_use]
    pub fn known_to(&self) -> f64 {
        (self.end - 2) as f64 * self.spacing
    }

    /// From which coordinate on the lane is still held.
    #[must_use]
    pub fn known_from(&self) -> f64 {
        (self.first + 1) as f64 * self.spacing
    }

    /// Control point number `k`, at s = kΔ, if it is frozen and still held.
    #[must_use]
    pub fn point(&self, k: i64) -> Option<Offset> {
        (self.first <= k && k < self.end).then(|| self.points[slot(k)])
    }

    /// Number of the control point that freezes next.
    #[must_use]
    pub fn next(&self) -> i64 {
        self.end
    }

    /// The `back`-th newest point; the oldest one where there are no more.
    pub(super) fn newest(&self, back: i64) -> Offset {
        self.points[slot((self.end - 1 - back).max(self.first))]
    }

    pub(super) fn push(&mut self, point: Offset) {
        self.points[slot(self.end)] = point;
        self.end += 1;
        self.first = self.first.max(self.end - CAPACITY as i64);
    }
}

fn slot(k: i64) -> usize {
    k.rem_euclid(CAPACITY as i64) as usize
}

/// A lane kept from an earlier pass, from which another pass is welded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneRecord<'a> {
    /// Distance Δ of the control points, in metres.
    pub spacing: f64,
    /// Number of the first control point: it stands at s = first · Δ.
    pub first: i64,
    /// The control points, one after the other, as they froze.
    pub points: &'a [Offset],
    /// How far this pass lies from that one: to the left and up, in metres.
    pub shift: Offset,
}

impl LaneRecord<'_> {
    /// The recorded lane, shifted. Before its first and after its last knot it goes on at that point's offset.
    /// Where nothing was recorded it is the taught path, shifted.
    #[must_use]
    pub fn at(&self, s: f64) -> LaneJet {
        let last = self.points.len().saturating_sub(1) as i64;
        let point = |k: i64| {
            let held = usize::try_from((k - self.first).clamp(0, last)).unwrap_or(0);
            self.points.get(held).map_or(Some(self.shift), |point| Some(point + self.shift))
        };
        evaluate(self.spacing, s, point).unwrap_or(LaneJet::TAUGHT)
    }
}

/// The spline of the points that `point` gives by their number, at `s`. `None` where one of the four is missing.
fn evaluate(spacing: f64, s: f64, point: impl Fn(i64) -> Option<Offset>) -> Option<LaneJet> {
    let at = floor(s / spacing);
    if !at.is_finite() {
        return None;
    }
    let (k, u) = (at as i64, s / spacing - at);
    let [d0, d1, d2, d3] = [point(k - 1)?, point(k)?, point(k + 1)?, point(k + 2)?];
    let (e1, e2, e3) = (d1 - d0, d2 - d1, d3 - d2);
    let (f1, f2) = (e2 - e1, e3 - e2);
    let v = 1.0 - u;
    let third = f2 - f1;
    // In terms of differences, so that a constant lane is constant to the last bit.
    let offset = d1
        + (e2 * (3.0 * v * v * v - 6.0 * v * v + 4.0 + u * u * u) + e3 * (u * u * u) - e1 * (v * v * v))
            / 6.0;
    Some(LaneJet {
        offset,
        derivatives: [
            (e1 * (v * v) + e2 * (1.0 + 2.0 * u * v) + e3 * (u * u)) / (2.0 * spacing),
            (f1 * v + f2 * u) / (spacing * spacing),
            third / (spacing * spacing * spacing),
        ],
    })
}
