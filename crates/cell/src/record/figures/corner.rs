//! How near a passed corner the tool came.

use seamline::geometry::Vector3;

use crate::least::least_between;

/// Steps of the search for the nearest place between two samples: each leaves two thirds of what is searched.
const SEARCH: usize = 24;

/// Samples that a curve is laid through.
const SAMPLES: usize = 6;

/// Follows the tool past a corner.
#[derive(Debug, Clone)]
pub(super) struct CornerWatch {
    corner: Vector3,
    /// The last positions, the oldest first, or fewer at the beginning.
    last: Vec<Vector3>,
    distance: f64,
}

impl CornerWatch {
    pub(super) fn new(corner: Vector3) -> Self {
        Self { corner, last: Vec::with_capacity(SAMPLES + 1), distance: f64::INFINITY }
    }

    /// Takes the next position.
    pub(super) fn push(&mut self, position: Vector3) {
        let from = self.last.last().copied().unwrap_or(position);
        self.distance = self.distance.min(distance_to_segment(&self.corner, &from, &position));
        self.last.push(position);
        if self.last.len() > SAMPLES {
            self.last.remove(0);
        }
        if let Some(samples) = self.last.first_chunk() {
            self.distance = self.distance.min(distance_between(&self.corner, samples));
        }
    }

    /// The least distance between the corner and the way of the tool. Samples are joined by the polynomial of degree five
    /// through them and their neighbours: a straight line would cut the curve short, and lie further from the corner.
    pub(super) fn distance(&self) -> Option<f64> {
        Some(self.distance).filter(|distance| distance.is_finite())
    }
}

/// Least distance of a point from the polynomial through the samples, between the two in the middle.
fn distance_between(point: &Vector3, samples: &[Vector3; SAMPLES]) -> f64 {
    let weight = |node: usize, t: f64| {
        let others = (0..SAMPLES).filter(|other| *other != node).map(|other| other as f64);
        others.map(|other| (t - other) / (node as f64 - other)).product::<f64>()
    };
    let at = |t: f64| {
        let weighted = samples.iter().enumerate().map(|(node, sample)| sample * weight(node, t));
        (weighted.sum::<Vector3>() - point).norm()
    };
    at(least_between(at, [2.0, 3.0], SEARCH))
}

fn distance_to_segment(point: &Vector3, from: &Vector3, to: &Vector3) -> f64 {
    let way = to - from;
    let length_squared = way.norm_squared();
    let share = if length_squared > 0.0 { (point - from).dot(&way) / length_squared } else { 0.0 };
    (point - from - way * share.clamp(0.0, 1.0)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples on either side of the nearest point, and none before or after.
    #[test]
    fn the_way_between_samples_counts() {
        let mut watch = CornerWatch::new(Vector3::new(0.0, 3e-4, 0.0));
        assert_eq!(watch.distance(), None);
        for x in [-0.003, -0.001, 0.002, 0.004] {
            watch.push(Vector3::new(x, 0.0, 0.0));
        }
        assert!((watch.distance().unwrap() - 3e-4).abs() < 1e-15);
        let mut single = CornerWatch::new(Vector3::new(0.0, 3e-4, 0.0));
        single.push(Vector3::new(4e-4, 0.0, 0.0));
        assert!((single.distance().unwrap() - 5e-4).abs() < 1e-15);
    }

    /// Past the outside of a circle of 1 mm in steps of a twentieth turn: straight lines would be a micrometre further off.
    #[test]
    fn a_bend_is_not_cut_short() {
        let mut watch = CornerWatch::new(Vector3::new(1.5e-3, 0.0, 0.0));
        for step in -6..6 {
            let (sin, cos) = (0.05 * (f64::from(step) + 0.5)).sin_cos();
            watch.push(Vector3::new(cos, sin, 0.0) * 1e-3);
        }
        let error = watch.distance().unwrap() - 5e-4;
        assert!(error.abs() < 1e-12, "{error}");
    }
}
