//! A seam beside the taught path, put together from what seams do.

use seamline::seam::Offset;

/// One thing that a seam does, along the coordinate of the taught path in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeamFeature {
    /// It wanders to and fro.
    Sine {
        /// Greatest offset to either side.
        amplitude: Offset,
        /// Length of one wave.
        length: f64,
        /// Where a wave begins.
        at: f64,
    },
    /// It moves away steadily, and then goes on at that distance.
    Drift {
        /// How far in all.
        offset: Offset,
        /// Where it begins.
        at: f64,
        /// Over which length.
        length: f64,
    },
    /// It jumps, as where plates are misaligned.
    Step {
        /// How far.
        offset: Offset,
        /// Where.
        at: f64,
    },
    /// It turns, and goes on straight.
    Kink {
        /// Tangents of the angles.
        slope: Offset,
        /// Where.
        at: f64,
    },
    /// A tack weld stands on it: a bead with round ends, which the laser sees but the weld does not follow.
    Tack {
        /// Its height.
        height: f64,
        /// Where it begins.
        at: f64,
        /// Its length.
        length: f64,
    },
    /// There is no joint to be seen.
    Gap {
        /// Where it begins.
        at: f64,
        /// Its length.
        length: f64,
    },
}

/// Width of the joint that the laser reports, in metres; on a tack it is closed.
const JOINT: f64 = 1e-3;
/// The laser's quality on the joint, and on a tack, which scatters the light.
const QUALITY: (f64, f64) = (1.0, 0.6);

/// What a laser sees at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sight {
    /// From the taught path.
    pub(super) offset: Offset,
    pub(super) gap: f64,
    pub(super) quality: f64,
}

/// A seam beside the taught path: the sum of its features.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SimulatedSeam {
    /// What it does; nothing lies on the taught path.
    pub features: Vec<SeamFeature>,
}

impl SimulatedSeam {
    /// Where the weld belongs, from the taught path, in metres.
    #[must_use]
    pub fn offset(&self, s: f64) -> Offset {
        self.features.iter().map(|feature| feature.offset(s)).sum()
    }

    /// What the laser sees there; `None` in a gap.
    pub(super) fn sight(&self, s: f64) -> Option<Sight> {
        let mut sight = Sight { offset: self.offset(s), gap: JOINT, quality: QUALITY.0 };
        for feature in &self.features {
            match *feature {
                SeamFeature::Gap { at, length } if along(s, at, length).is_some() => return None,
                SeamFeature::Tack { height, at, length } => {
                    let Some(along) = along(s, at, length) else { continue };
                    sight.offset.y += height * (4.0 * along * (1.0 - along)).sqrt();
                    (sight.gap, sight.quality) = (0.0, QUALITY.1);
                }
                _ => {}
            }
        }
        Some(sight)
    }
}

impl SeamFeature {
    fn offset(&self, s: f64) -> Offset {
        match *self {
            Self::Sine { amplitude, length, at } => {
                amplitude * (std::f64::consts::TAU * (s - at) / length).sin()
            }
            Self::Drift { offset, at, length } => offset * ((s - at) / length).clamp(0.0, 1.0),
            Self::Step { offset, at } if s > at => offset,
            Self::Kink { slope, at } => slope * (s - at).max(0.0),
            Self::Step { .. } | Self::Tack { .. } | Self::Gap { .. } => Offset::zeros(),
        }
    }
}

/// How far along a stretch a place lies, from 0 to 1.
fn along(s: f64, at: f64, length: f64) -> Option<f64> {
    Some((s - at) / length).filter(|along| (0.0..=1.0).contains(along))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_add_up_and_stand_where_they_are_put() {
        let aside = Offset::new(2e-3, -1e-3);
        let features = vec![
            SeamFeature::Sine { amplitude: aside, length: 0.2, at: 0.0 },
            SeamFeature::Drift { offset: aside, at: 0.1, length: 0.1 },
            SeamFeature::Step { offset: aside, at: 0.3 },
            SeamFeature::Kink { slope: aside * 100.0, at: 0.4 },
        ];
        let seam = SimulatedSeam { features };
        // In units of `aside`: the wave's crest, the drift half way and done, the step, the kink 50 mm on.
        for (s, expected) in
            [(0.05, 1.0), (0.1, 0.0), (0.15, -0.5), (0.25, 2.0), (0.35, 1.0), (0.45, 1.0 + 1.0 + 1.0 + 5.0)]
        {
            assert!((seam.offset(s) - aside * expected).norm() < 1e-12, "{s}: {}", seam.offset(s));
        }
    }

    #[test]
    fn a_tack_is_seen_and_not_followed_and_a_gap_is_neither() {
        let features = vec![
            SeamFeature::Tack { height: 2e-3, at: 0.1, length: 0.01 },
            SeamFeature::Gap { at: 0.2, length: 0.02 },
        ];
        let seam = SimulatedSeam { features };
        let top = seam.sight(0.105).unwrap();
        assert!((top.offset.y - 2e-3).abs() < 1e-9 && top.gap == 0.0 && top.quality < 1.0, "{top:?}");
        assert_eq!(seam.offset(0.105), Offset::zeros());
        assert_eq!(seam.sight(0.21), None);
        assert!(seam.sight(0.19).is_some() && seam.sight(0.23).is_some());
    }
}
