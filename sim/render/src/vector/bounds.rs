//! Bounding boxes and bounding spheres of points.

use nalgebra::Vector3;

/// Largest gap between boxes that count as touching, m; the box of a plane perpendicular to an axis has no
/// thickness.
const SAME_POINT_M: f64 = 1e-6;

/// Smallest box, aligned with the target's axes, that contains some points.
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

    /// Returns true if two boxes intersect, up to rounding.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| {
            self.low[axis] <= other.high[axis] + SAME_POINT_M
                && other.low[axis] <= self.high[axis] + SAME_POINT_M
        })
    }
}

/// A bounding sphere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub(super) centre: Vector3<f64>,
    pub(super) radius: f64,
}

impl Sphere {
    /// Creates a sphere that contains the points, centred on the middle of their bounding box; centred on the
    /// origin if there are no points.
    pub(super) fn enclosing<'a>(points: impl Iterator<Item = &'a Vector3<f64>> + Clone) -> Self {
        let Extent { low, high } = Extent::from_points(points.clone());
        let centre = if low.x <= high.x { 0.5 * (low + high) } else { Vector3::zeros() };
        let radius = points.map(|point| (point - centre).norm()).fold(0.0, f64::max);
        Self { centre, radius }
    }
}
