//! Bounds of points: boxes and spheres.

use nalgebra::Vector3;

/// Boxes nearer than this touch, m: a plane along the axes has a flat one.
const SAME_POINT_M: f64 = 1e-6;

/// The smallest box along the target's axes about some points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) low: Vector3<f64>,
    pub(super) high: Vector3<f64>,
}

impl Extent {
    pub(super) fn from_points<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> Self {
        let nothing = Self { low: Vector3::repeat(f64::INFINITY), high: Vector3::repeat(f64::NEG_INFINITY) };
        points
            .into_iter()
            .fold(nothing, |extent, point| Self { low: extent.low.inf(point), high: extent.high.sup(point) })
    }

    /// Whether two boxes have something in common, up to rounding.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| {
            self.low[axis] <= other.high[axis] + SAME_POINT_M
                && other.low[axis] <= self.high[axis] + SAME_POINT_M
        })
    }
}

/// A sphere about something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub(super) centre: Vector3<f64>,
    pub(super) radius: f64,
}

impl Sphere {
    /// About the middle of the points' extent along the axes; about the origin where there are no points.
    pub(super) fn enclosing<'a>(points: impl Iterator<Item = &'a Vector3<f64>> + Clone) -> Self {
        let Extent { low, high } = Extent::from_points(points.clone());
        let centre = if low.x <= high.x { 0.5 * (low + high) } else { Vector3::zeros() };
        let radius = points.map(|point| (point - centre).norm()).fold(0.0, f64::max);
        Self { centre, radius }
    }
}
