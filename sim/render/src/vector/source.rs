//! Light sources.

use nalgebra::Vector3;
use scene::docking::Facet;

use super::planes::Plane;

/// Light source of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// A very distant source: unit vector towards it.
    Parallel(Vector3<f64>),
    /// A point source: its position, m.
    Point(Vector3<f64>),
}

impl Source {
    /// Returns the vector from a point towards the light; a unit vector for a very distant source.
    pub(super) fn from(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel(towards) => *towards,
            Self::Point(position) => position - point,
        }
    }

    /// Returns true if the front of a plane faces the light.
    pub(super) fn illuminates(&self, plane: &Plane) -> bool {
        match self {
            Self::Parallel(towards) => plane.normal.dot(towards) > 0.0,
            Self::Point(position) => plane.height(position) > 0.0,
        }
    }

    /// Returns true if a facet belongs to the side of its part that casts the shadow.
    pub(super) fn casts_shadow(&self, facet: &Facet, dark_side: bool) -> bool {
        let Some(corner) = facet.outer.first() else { return false };
        (facet.normal.dot(&self.from(corner)) <= 0.0) == dark_side
    }
}
