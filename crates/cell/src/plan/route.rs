//! Paths that follow one another, under one coordinate.

use seamline::geometry::{Pose, PoseJet, Rotation};
use seamline::path::{Measure, Path};

/// Paths run one after the other; the coordinate runs from 0 to the sum of their lengths.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Route {
    paths: Vec<Path>,
    /// Where each path ends.
    ends: Vec<f64>,
}

impl From<&Path> for Route {
    fn from(path: &Path) -> Self {
        let mut route = Self::default();
        route.push(*path);
        route
    }
}

impl From<Path> for Route {
    fn from(path: Path) -> Self {
        Self::from(&path)
    }
}

impl Route {
    /// Goes on with a path that begins where the route ends.
    pub fn push(&mut self, path: Path) {
        self.ends.push(self.length() + path.length());
        self.paths.push(path);
    }

    /// Length of the whole.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// The paths in order.
    #[must_use]
    pub fn paths(&self) -> &[Path] {
        &self.paths
    }

    /// Where each path ends, in order.
    #[must_use]
    pub fn ends(&self) -> &[f64] {
        &self.ends
    }

    /// Where the path with this number begins.
    #[must_use]
    pub fn start_of(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { self.ends[index - 1] }
    }

    /// The path that a coordinate lies on, by its number, and the coordinate on it.
    #[must_use]
    pub fn locate(&self, s: f64) -> (usize, f64) {
        let index = self.ends.partition_point(|end| *end <= s).min(self.paths.len().saturating_sub(1));
        (index, s - self.start_of(index))
    }

    /// The pose at a coordinate.
    #[must_use]
    pub fn pose(&self, s: f64) -> Pose {
        let (index, local) = self.locate(s);
        self.paths[index].pose(local)
    }

    /// The pose and its derivatives with respect to the coordinate. Where two paths meet, those of the second.
    #[must_use]
    pub fn jet(&self, s: f64) -> PoseJet {
        let (index, local) = self.locate(s);
        self.paths[index].jet(local)
    }

    /// What the coordinate counts. A turn on the spot stands alone.
    #[must_use]
    pub fn measure(&self) -> Measure {
        self.paths.first().map_or(Measure::Length, Path::measure)
    }

    /// The same way without weaves.
    #[must_use]
    pub fn seam(&self) -> Self {
        Self { paths: self.paths.iter().map(Path::seam).collect(), ends: self.ends.clone() }
    }

    /// The same way with the tool turned by a constant rotation in its own frame.
    #[must_use]
    pub fn tilted(&self, tilt: &Rotation) -> Self {
        Self { paths: self.paths.iter().map(|path| path.tilted(tilt)).collect(), ends: self.ends.clone() }
    }
}
