//! Flat facet of a body: a rectangle, or a triangle of a closed mesh.

use nalgebra::{Vector2, Vector3};

use super::surface::SurfaceConfig;
use crate::polygon::{Polygon, bounds};

/// Checked facet, in the target's body frame: `right`, `up` and `normal` are orthonormal and right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Facet {
    /// Centre of the enclosing rectangle, m.
    pub centre: Vector3<f64>,
    pub right: Vector3<f64>,
    pub up: Vector3<f64>,
    pub normal: Vector3<f64>,
    /// Half the sides of the enclosing rectangle along `right` and `up`, m.
    pub half_width: f64,
    pub half_height: f64,
    /// Corners of a triangle, right and up from the centre, m, counter-clockwise; `None` for the rectangle.
    pub triangle: Option<[Vector2<f64>; 3]>,
    pub front: SurfaceConfig,
    /// Surface of the back; black if absent.
    pub back: Option<SurfaceConfig>,
}

impl Facet {
    /// Returns the triangle of a mesh, whose front shows its corners counter-clockwise; `None` if it has no
    /// area.
    pub(super) fn triangle(corners: [Vector3<f64>; 3], surface: SurfaceConfig) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        // The rectangle along the longest side is the smallest one.
        let sides = [b - a, c - b, a - c];
        let longest =
            sides.into_iter().max_by(|one, other| one.norm_squared().total_cmp(&other.norm_squared()))?;
        let right = longest.try_normalize(0.0)?;
        let up = normal.cross(&right);
        let in_plane = corners.map(|corner| Vector2::new((corner - a).dot(&right), (corner - a).dot(&up)));
        let (low, high) = bounds(&in_plane);
        let middle = 0.5 * (low + high);
        Some(Self {
            centre: a + right * middle.x + up * middle.y,
            right,
            up,
            normal,
            half_width: 0.5 * (high.x - low.x),
            half_height: 0.5 * (high.y - low.y),
            triangle: Some(in_plane.map(|corner| corner - middle)),
            front: surface,
            back: None,
        })
    }

    /// Area, m².
    pub(super) fn area(&self) -> f64 {
        let rectangle = 4.0 * self.half_width * self.half_height;
        if self.is_of_mesh() { 0.5 * rectangle } else { rectangle }
    }

    /// Returns true for a facet of a closed mesh: its back is inside the body.
    pub(super) fn is_of_mesh(&self) -> bool {
        self.triangle.is_some()
    }

    /// Returns true if the ray from `eye` along `ray` meets the facet from either side.
    pub(super) fn is_hit_by(&self, eye: &Vector3<f64>, ray: &Vector3<f64>) -> bool {
        self.distance_along(eye, ray).is_some()
    }

    /// Returns the distance from `eye` along the unit vector `ray` at which the ray meets the facet from
    /// either side, m; `None` if it does not.
    pub(super) fn distance_along(&self, eye: &Vector3<f64>, ray: &Vector3<f64>) -> Option<f64> {
        let (towards, along) = (self.centre - eye, ray.dot(&self.normal));
        let reach = towards.dot(&self.normal) / along;
        let off = ray * reach - towards;
        let at = Vector2::new(off.dot(&self.right), off.dot(&self.up));
        // A ray in the facet's plane gives NaN and meets nothing.
        let is_met = reach > 0.0
            && at.x.abs() <= self.half_width
            && at.y.abs() <= self.half_height
            && self.has_within(&at);
        is_met.then_some(reach)
    }

    /// Returns true if a point of the enclosing rectangle is in the facet or on its border.
    fn has_within(&self, at: &Vector2<f64>) -> bool {
        let Some([a, b, c]) = self.triangle else { return true };
        [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (to - from).perp(&(at - from)) >= 0.0)
    }

    /// Upper bound of the distance of the facet's corners from the origin of the body frame, m.
    pub(super) fn reach(&self) -> f64 {
        self.centre.norm() + libm::hypot(self.half_width, self.half_height)
    }

    /// Returns true if the sphere around another facet lies behind this facet.
    pub(super) fn is_above(&self, other: &Self) -> bool {
        let radius_m = libm::hypot(other.half_width, other.half_height);
        (other.centre - self.centre).dot(&self.normal) < -radius_m
    }

    /// Returns the reversed facet: `front` becomes its front, and its former front becomes its back.
    pub(super) fn turned(&self, front: SurfaceConfig) -> Self {
        Self { right: -self.right, normal: -self.normal, front, back: Some(self.front), ..*self }
    }

    /// Corners in the facet's plane: coordinates right and up from the centre.
    fn corners(&self) -> impl Iterator<Item = Vector2<f64>> + use<> {
        let (x, y) = (self.half_width, self.half_height);
        let rectangle = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let rectangle = rectangle.map(|(i, j)| Vector2::new(i * x, j * y));
        let (corners, count) = match self.triangle {
            Some([a, b, c]) => ([a, b, c, c], 3),
            None => (rectangle, 4),
        };
        corners.into_iter().take(count)
    }

    /// Outline in the facet's plane.
    pub(super) fn outline(&self) -> Polygon {
        self.corners().collect()
    }

    /// Corners in the body frame, m.
    pub(super) fn corners_m(&self) -> impl Iterator<Item = Vector3<f64>> + '_ {
        self.corners().map(|corner| self.point_in_body_frame(&corner))
    }

    /// Converts a point of the facet's plane to the body frame.
    pub(super) fn point_in_body_frame(&self, point: &Vector2<f64>) -> Vector3<f64> {
        self.centre + self.right * point.x + self.up * point.y
    }

    /// Converts a point of the body frame to the facet's axes: right, up and height above the front.
    pub(super) fn local(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let offset = point - self.centre;
        Vector3::new(offset.dot(&self.right), offset.dot(&self.up), offset.dot(&self.normal))
    }
}
