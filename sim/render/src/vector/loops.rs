//! Closed polygons with many corners, stored with bounding spheres to skip most corners in tests.

use nalgebra::Vector3;

use super::bounds::Sphere;

/// Closed polygons, with bounding spheres of stretches of their corners.
#[derive(Debug, Clone, Default)]
pub(super) struct Loops {
    points: Vec<Vector3<f64>>,
    stretches: Vec<Stretch>,
    polygons: Vec<Polygon>,
}

/// Bounding sphere of a polygon, and the end of its stretches in the list.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    sphere: Sphere,
    end: usize,
}

/// Consecutive corners of a polygon.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    /// Index of the first corner in the points; `end` is excluded.
    start: usize,
    end: usize,
    sphere: Sphere,
}

impl Loops {
    /// Maximum number of corners of a stretch.
    const STRETCH: usize = 16;

    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.stretches.clear();
        self.polygons.clear();
    }

    /// Returns the number of polygons.
    pub(super) fn len(&self) -> usize {
        self.polygons.len()
    }

    /// Adds a polygon.
    pub(super) fn push(&mut self, polygon: impl IntoIterator<Item = Vector3<f64>>) {
        let first = self.points.len();
        self.points.extend(polygon);
        for start in (first..self.points.len()).step_by(Self::STRETCH) {
            let end = self.points.len().min(start + Self::STRETCH);
            let sphere = Sphere::enclosing(self.points[start..end].iter());
            self.stretches.push(Stretch { start, end, sphere });
        }
        let sphere = Sphere::enclosing(self.points[first..].iter());
        self.polygons.push(Polygon { sphere, end: self.stretches.len() });
    }

    /// Returns the bounding sphere of a polygon.
    pub(super) fn sphere(&self, index: usize) -> &Sphere {
        &self.polygons[index].sphere
    }

    /// Returns the stretches of a polygon, in order, each with its bounding sphere.
    pub(super) fn stretches(&self, index: usize) -> impl Iterator<Item = (&Sphere, &[Vector3<f64>])> {
        let start = if index == 0 { 0 } else { self.polygons[index - 1].end };
        self.points_of(&self.stretches[start..self.polygons[index].end])
    }

    /// Returns the stretches of all polygons, each with its bounding sphere.
    pub(super) fn all_stretches(&self) -> impl Iterator<Item = (&Sphere, &[Vector3<f64>])> {
        self.points_of(&self.stretches)
    }

    fn points_of<'a>(
        &'a self,
        some: &'a [Stretch],
    ) -> impl Iterator<Item = (&'a Sphere, &'a [Vector3<f64>])> {
        some.iter().map(|stretch| (&stretch.sphere, &self.points[stretch.start..stretch.end]))
    }
}
