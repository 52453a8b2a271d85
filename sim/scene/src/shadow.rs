//! Polygons that cover a part of a plane: in the light of a source, by their shadow; from the camera, by
//! hiding it. Both are one projection along rays. Plates, meshes and docking scenes use it.

use nalgebra::Vector3;

use crate::polygon::keep_above;

/// Share of a near source's height above a plane, above which a point covers nothing: its shadow would extend
/// to infinity.
pub const MAX_HEIGHT_SHARE: f64 = 0.999;

/// Origin of rays: a light or the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// A very distant source: unit vector towards it.
    Parallel(Vector3<f64>),
    /// A near source: its position, m.
    Point(Vector3<f64>),
}

/// Plane that is covered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal of its front.
    pub normal: Vector3<f64>,
    /// Offset of the plane, m: normal · y of its points y.
    pub offset: f64,
}

impl Plane {
    /// Returns the height of a point in front of the plane, m; negative behind it.
    pub fn height(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

impl Source {
    /// Returns the vector from a point towards the source; a unit vector for a very distant source.
    pub fn from(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel(towards) => *towards,
            Self::Point(position) => position - point,
        }
    }

    /// Returns true if the front of a plane faces the source.
    pub fn illuminates(&self, plane: &Plane) -> bool {
        match self {
            Self::Parallel(towards) => plane.normal.dot(towards) > 0.0,
            Self::Point(position) => plane.height(position) > 0.0,
        }
    }

    /// Returns the height above a plane up to which points cover a part of it, m; infinite for a very distant
    /// source.
    pub fn highest(&self, plane: &Plane) -> f64 {
        match self {
            Self::Parallel(_) => f64::INFINITY,
            Self::Point(position) => MAX_HEIGHT_SHARE * plane.height(position),
        }
    }

    /// Writes the part of a polygon between a plane and the source to `cut`. Points lower than `touching_m`
    /// touch the plane and cover nothing. The content of `polygon` is unspecified afterwards.
    pub fn cut_between(
        &self,
        polygon: &mut Vec<Vector3<f64>>,
        plane: &Plane,
        touching_m: f64,
        cut: &mut Vec<Vector3<f64>>,
    ) {
        keep_above(polygon, cut, |point| plane.height(point) - touching_m);
        if let Self::Point(_) = self {
            let highest = self.highest(plane);
            std::mem::swap(polygon, cut);
            keep_above(polygon, cut, |point| highest - plane.height(point));
        }
    }

    /// Writes the projection of a polygon between a plane and the source onto the plane to `shadow`: x − t
    /// h/c of a point x at the height h, towards a source in the direction t that climbs by c = n · t; from a
    /// source at s with the height H, s + (x − s) H/(H − h).
    pub fn cast(&self, polygon: &[Vector3<f64>], plane: &Plane, shadow: &mut Vec<Vector3<f64>>) {
        shadow.clear();
        match self {
            Self::Parallel(towards) => {
                let climb = plane.normal.dot(towards);
                let along = |point: &Vector3<f64>| point - towards * (plane.height(point) / climb);
                shadow.extend(polygon.iter().map(along));
            }
            Self::Point(position) => {
                let height = plane.height(position);
                let along = |point: &Vector3<f64>| {
                    position + (point - position) * (height / (height - plane.height(point)))
                };
                shadow.extend(polygon.iter().map(along));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 1 m at a height of 1 m, over the plane z = 0.5, whose corners below it are cut.
    #[test]
    fn a_shadow_falls_along_the_rays_and_ends_at_the_plane() {
        let plane = Plane { normal: Vector3::z(), offset: 0.5 };
        let screen = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]].map(Vector3::from);
        let cases = [
            // The Sun at 45° towards −y: the upper edge, 0.5 m high, falls 0.5 m towards y.
            (Source::Parallel(Vector3::new(0.0, -1.0, 1.0).normalize()), [0.0, 0.5], [1.0, 0.5]),
            // A lamp 1 m above the plane at (0, −1): the edge, half as high, falls twice as far from it.
            (Source::Point(Vector3::new(0.0, -1.0, 1.5)), [0.0, 1.0], [2.0, 1.0]),
        ];
        for (source, left, right) in cases {
            assert!(source.illuminates(&plane));
            let (mut polygon, mut cut, mut shadow) = (screen.to_vec(), Vec::new(), Vec::new());
            source.cut_between(&mut polygon, &plane, 1e-9, &mut cut);
            source.cast(&cut, &plane, &mut shadow);
            assert!(shadow.iter().all(|point| plane.height(point).abs() < 1e-12), "{shadow:?}");
            for [x, y] in [[0.0, 0.0], [1.0, 0.0], left, right] {
                let corner = Vector3::new(x, y, 0.5);
                assert!(shadow.iter().any(|point| (point - corner).norm() < 1e-8), "{corner} in {shadow:?}");
            }
        }
    }
}
