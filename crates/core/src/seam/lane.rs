//! The lane: the correction as a function of path length.
//!
//! A uniform cubic B-spline c(s) = Σ dₖ B(s/Δ − k): two continuous derivatives, and a third one that is constant from knot to
//! knot. With first, second and third differences of the control points (Δ¹, Δ², Δ³ without the spacing)
//!
//! |c| ≤ max|d|, |c′| ≤ max|Δ¹d|/Δ, |c″| ≤ max|Δ²d|/Δ², c‴ = Δ³d/Δ³,
//!
//! so that what the lane demands is known before the torch is there. Between the knots k and k + 1 the points k − 1 … k + 2 count.

use super::Offset;
use crate::math::float::{cbrt, floor};
use crate::math::taylor::Taylor;

/// Coordinates nearer to each other than this are one, in metres.
const SAME_PLACE: f64 = 1e-6;
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

    /// Number of the oldest control point that is still held.
    #[must_use]
    pub fn oldest(&self) -> i64 {
        self.first
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
    /// The weld.
    pub weld: RecordedWeld,
    /// The control points, one after the other, as they froze.
    pub points: &'a [Offset],
}

/// The weld that a lane was recorded of: by this it is known again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RecordedWeld {
    /// Coordinate s of the lane at which it began, in metres.
    pub start: f64,
    /// Length of its taught path, in metres.
    pub length: f64,
    /// Travel speed, in m/s: up to it the lane keeps the bounds that it was made for.
    pub speed: f64,
}

/// How another pass lies from the one that was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// To the left and up, in metres.
    pub shift: Offset,
    /// Way from the weld's start over which the shift comes in, in metres.
    pub lead: f64,
}

/// The greatest that a lane demands, along either axis: |c| in metres, |c′|, and |c‴| in 1/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LanePeaks {
    /// |c|, as bounded by the control points.
    pub offset: f64,
    /// |c′|.
    pub slope: f64,
    /// |c‴|.
    pub third: f64,
}

impl Pass {
    /// A shift that comes in aside by no more than one in two, and with no more than a jerk (m/s³) at a travel speed (m/s).
    #[must_use]
    pub fn new(shift: Offset, speed: f64, jerk: f64) -> Self {
        let far = shift.norm();
        // The greatest derivatives of the way in are 1.875/lead and 60/lead³ of it.
        Self { shift, lead: (2.0 * 1.875 * far).max(speed * cbrt(60.0 * far / jerk)) }
    }

    /// The shift at a way from the weld's start.
    fn at(&self, s: f64) -> LaneJet {
        if s >= self.lead {
            return LaneJet { offset: self.shift, ..LaneJet::TAUGHT };
        }
        let share = Taylor::smooth_step((s / self.lead).max(0.0), 1.0 / self.lead);
        let derivatives = if s > 0.0 { share.derivatives() } else { [0.0; 3] };
        LaneJet { offset: self.shift * share.value(), derivatives: derivatives.map(|d| self.shift * d) }
    }
}

impl LaneRecord<'_> {
    /// It goes up to the end of its weld: the torch came there.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let known_to = (self.first + self.points.len() as i64 - 2) as f64 * self.spacing;
        known_to >= self.weld.start + self.weld.length - SAME_PLACE
    }

    /// The recorded lane at a way from its weld's start. Before its first and after its last knot it goes on at that point's offset.
    /// Where nothing was recorded it is the taught path.
    #[must_use]
    pub fn at(&self, s: f64) -> LaneJet {
        let last = self.points.len().saturating_sub(1) as i64;
        let point = |k: i64| {
            let held = usize::try_from((k - self.first).clamp(0, last)).unwrap_or(0);
            Some(self.points.get(held).copied().unwrap_or_default())
        };
        evaluate(self.spacing, self.weld.start + s, point).unwrap_or(LaneJet::TAUGHT)
    }

    /// The lane of another pass at a way from its weld's start: the recorded one, shifted.
    #[must_use]
    pub fn of_pass(&self, pass: &Pass, s: f64) -> LaneJet {
        let (recorded, shift) = (self.at(s), pass.at(s));
        LaneJet {
            offset: recorded.offset + shift.offset,
            derivatives: core::array::from_fn(|order| recorded.derivatives[order] + shift.derivatives[order]),
        }
    }

    /// What the lane demands at most.
    #[must_use]
    pub fn peaks(&self) -> LanePeaks {
        let mut peaks = LanePeaks { offset: 0.0, slope: 0.0, third: 0.0 };
        let rise = |peak: &mut f64, vector: Offset, scale: f64| *peak = peak.max(vector.amax() / scale);
        let spacing = self.spacing;
        for (k, point) in self.points.iter().enumerate() {
            let before = |back: usize| k.checked_sub(back).and_then(|at| self.points.get(at));
            rise(&mut peaks.offset, *point, 1.0);
            if let Some(d1) = before(1) {
                rise(&mut peaks.slope, point - d1, spacing);
            }
            if let (Some(d1), Some(d2), Some(d3)) = (before(1), before(2), before(3)) {
                rise(&mut peaks.third, point - d1 * 3.0 + d2 * 3.0 - d3, spacing * spacing * spacing);
            }
        }
        peaks
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
