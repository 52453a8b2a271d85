//! Where light comes from.

use nalgebra::Vector3;

use super::planes::Plane;
use crate::scene::docking::Facet;

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// From very far: the unit vector towards it.
    Parallel(Vector3<f64>),
    /// From a point, m.
    Point(Vector3<f64>),
}

impl Source {
    /// The vector towards the light from a point: a unit vector from very far.
    pub(super) fn from(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel(towards) => *towards,
            Self::Point(position) => position - point,
        }
    }

    /// Whether a plane has its front to the light.
    pub(super) fn illuminates(&self, plane: &Plane) -> bool {
        match self {
            Self::Parallel(towards) => plane.normal.dot(towards) > 0.0,
            Self::Point(position) => plane.height(position) > 0.0,
        }
    }

    /// Whether a facet is on the side of its part that casts.
    pub(super) fn casts_shadow(&self, facet: &Facet, dark_side: bool) -> bool {
        let Some(corner) = facet.outer.first() else { return false };
        (facet.normal.dot(&self.from(corner)) <= 0.0) == dark_side
    }
}
