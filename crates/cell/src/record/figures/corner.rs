//! How near a passed corner the tool came.

use seamline::geometry::Vector3;

/// Follows the tool past a corner.
#[derive(Debug, Clone)]
pub(super) struct CornerWatch {
    corner: Vector3,
    last: Option<Vector3>,
    distance: f64,
}

impl CornerWatch {
    pub(super) fn new(corner: Vector3) -> Self {
        Self { corner, last: None, distance: f64::INFINITY }
    }

    /// Takes the next position.
    pub(super) fn push(&mut self, position: Vector3) {
        let from = self.last.replace(position).unwrap_or(position);
        self.distance = self.distance.min(distance_to_segment(&self.corner, &from, &position));
    }

    /// The least distance between the corner and the way of the tool, samples joined by straight lines.
    pub(super) fn distance(&self) -> Option<f64> {
        Some(self.distance).filter(|distance| distance.is_finite())
    }
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
}
