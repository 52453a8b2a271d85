//! Closed polygons of many corners, kept so that most corners need not be looked at.

use nalgebra::Vector3;

use super::bounds::Sphere;

/// Closed polygons, with spheres about stretches of their corners.
#[derive(Debug, Clone, Default)]
pub(super) struct Loops {
    points: Vec<Vector3<f64>>,
    stretches: Vec<Stretch>,
    polygons: Vec<Polygon>,
}

/// A sphere about a polygon, and where its stretches end.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    sphere: Sphere,
    end: usize,
}

/// Neighbouring corners of a polygon.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    /// Where it begins and ends among the points.
    start: usize,
    end: usize,
    sphere: Sphere,
}

impl Loops {
    /// Most corners of a stretch.
    const STRETCH: usize = 16;

    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.stretches.clear();
        self.polygons.clear();
    }

    /// How many polygons there are.
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

    /// A sphere about a polygon.
    pub(super) fn sphere(&self, index: usize) -> &Sphere {
        &self.polygons[index].sphere
    }

    /// The stretches of a polygon, in order.
    pub(super) fn stretches(&self, index: usize) -> impl Iterator<Item = (&Sphere, &[Vector3<f64>])> {
        let start = if index == 0 { 0 } else { self.polygons[index - 1].end };
        self.points_of(&self.stretches[start..self.polygons[index].end])
    }

    /// The stretches of all polygons.
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
