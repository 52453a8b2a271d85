//! Shape of the target for labels: polygons of its silhouette, named points, and the points that it hides.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::facet::Facet;
use super::outline::Inside;
use super::{Model, Spacecraft};

/// Number of corners of the polygon that represents the outline of a sphere: its sides are within 1e-4 of the
/// radius of the circle.
const SPHERE_CORNERS: u32 = 256;
/// Least distance between a point and a facet that hides it, m: a facet does not hide its own corners.
const CLEARANCE_M: f64 = 1e-6;

/// Named point of the target.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPoint {
    /// Name, of letters, digits and underscores.
    pub name: String,
    /// Position in the frame of the target, m.
    pub position_m: Vector3<f64>,
}

/// Kind of a target, as far as labels depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetShape {
    /// Point source without extent and orientation.
    Point,
    /// Sphere, without orientation.
    Sphere,
    /// Body of plates or a mesh, with an attitude.
    Body,
}

impl Spacecraft {
    /// Returns the kind of the target.
    pub fn shape(&self) -> TargetShape {
        match &self.model {
            Model::Beacon { .. } => TargetShape::Point,
            Model::Sphere { .. } => TargetShape::Sphere,
            Model::Body { .. } => TargetShape::Body,
        }
    }

    /// Returns the named points: `origin` of the body frame; `box_I_corner_0` to `7` of each box;
    /// `plate_I_corner_0` to `3` of each single plate, counter-clockwise seen from its front;
    /// `bounds_corner_0` to `7` of the box along the axes of the body frame around a mesh. Bit 0 of a box's
    /// corner is set at the larger x, bit 1 at the larger y, bit 2 at the larger z.
    pub fn named_points(&self) -> Vec<NamedPoint> {
        let origin = NamedPoint { name: "origin".to_owned(), position_m: Vector3::zeros() };
        let mut points = vec![origin];
        let Model::Body { facets, inside, .. } = &self.model else { return points };
        let mut add_corners = |group: String, corners: &[Vector3<f64>]| {
            points.extend(corners.iter().enumerate().map(|(index, corner)| NamedPoint {
                name: format!("{group}_corner_{index}"),
                position_m: *corner,
            }));
        };
        match inside {
            Inside::Boxes(boxes) => {
                for (index, brick) in boxes.iter().enumerate() {
                    add_corners(format!("box_{index}"), &brick.corners_m());
                }
                // The faces of the boxes precede the single plates.
                for (index, plate) in facets.iter().skip(6 * boxes.len()).enumerate() {
                    let corners: Vec<_> = plate.corners_m().collect();
                    add_corners(format!("plate_{index}"), &corners);
                }
            }
            Inside::Mesh => {
                let corners: Vec<_> = facets.iter().flat_map(Facet::corners_m).collect();
                add_corners("bounds".to_owned(), &bounding_box_corners(&corners));
            }
        }
        points
    }

    /// Returns all corners of the target's surface in its body frame, m; empty for a target without corners.
    pub fn corners_m(&self) -> Vec<Vector3<f64>> {
        match &self.model {
            Model::Body { facets, .. } => facets.iter().flat_map(Facet::corners_m).collect(),
            Model::Beacon { .. } | Model::Sphere { .. } => Vec::new(),
        }
    }

    /// Returns polygons, body frame, m, whose union as seen from `eye_m` (body frame, m) is the silhouette of
    /// the target, lit or not; none for a point source.
    pub fn silhouette_polygons(&self, eye_m: &Vector3<f64>) -> Vec<Vec<Vector3<f64>>> {
        match &self.model {
            Model::Beacon { .. } => Vec::new(),
            Model::Sphere { radius_m, .. } => vec![limb_of_sphere(*radius_m, eye_m)],
            Model::Body { facets, .. } => {
                // The back of a facet of a closed mesh is behind another front.
                let is_seen =
                    |facet: &&Facet| !facet.is_of_mesh() || facet.normal.dot(&(eye_m - facet.centre)) > 0.0;
                facets.iter().filter(is_seen).map(|facet| facet.corners_m().collect()).collect()
            }
        }
    }

    /// Returns true if the target hides a point of its body frame, m, from `eye_m`.
    pub fn hides_point(&self, point_m: &Vector3<f64>, eye_m: &Vector3<f64>) -> bool {
        let towards = point_m - eye_m;
        let (length, ray) = (towards.norm(), towards.normalize());
        match &self.model {
            Model::Beacon { .. } => false,
            Model::Sphere { radius_m, .. } => {
                let nearest = (-eye_m.dot(&ray)).clamp(0.0, length);
                (eye_m + ray * nearest).norm() < radius_m - CLEARANCE_M
            }
            Model::Body { facets, .. } => facets.iter().any(|facet| {
                facet.distance_along(eye_m, &ray).is_some_and(|distance| distance < length - CLEARANCE_M)
            }),
        }
    }
}

/// Returns the corners of the smallest box along the axes around some points, m, in the order of
/// [`Spacecraft::named_points`].
fn bounding_box_corners(points: &[Vector3<f64>]) -> [Vector3<f64>; 8] {
    let low = points.iter().fold(Vector3::repeat(f64::INFINITY), |low, point| low.inf(point));
    let high = points.iter().fold(Vector3::repeat(f64::NEG_INFINITY), |high, point| high.sup(point));
    let pick = |index: usize, axis: usize| if index >> axis & 1 == 0 { low[axis] } else { high[axis] };
    std::array::from_fn(|index| Vector3::new(pick(index, 0), pick(index, 1), pick(index, 2)))
}

/// Returns the circle on a sphere about the origin where lines of sight from `eye_m` touch it, m; empty
/// inside the sphere.
fn limb_of_sphere(radius_m: f64, eye_m: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let distance = eye_m.norm();
    if distance <= radius_m {
        return Vec::new();
    }
    let towards = eye_m / distance;
    let aside = towards.cross(&if towards.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() }).normalize();
    let above = towards.cross(&aside);
    let sine = radius_m / distance;
    let (centre, radius) = (towards * (radius_m * sine), radius_m * (1.0 - sine * sine).sqrt());
    let corner = |i: u32| {
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i) / f64::from(SPHERE_CORNERS));
        centre + (aside * cos + above * sin) * radius
    };
    (0..SPHERE_CORNERS).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spacecraft::{BoxConfig, PlateConfig, SurfaceConfig, TargetConfig};
    use truth::TargetAttitudeConfig;

    fn surface() -> SurfaceConfig {
        toml::from_str("diffuse = 0.5").unwrap()
    }

    /// A box of 2 × 4 × 6 m with a plate over its +z face.
    fn box_and_plate() -> Spacecraft {
        let plate = PlateConfig {
            centre_m: [0.0, 0.0, 3.1],
            normal: [0.0, 0.0, 1.0],
            up: [0.0, 1.0, 0.0],
            width_m: 1.0,
            height_m: 2.0,
            front: surface(),
            back: None,
        };
        let boxes = vec![BoxConfig { centre_m: [0.0; 3], size_m: [2.0, 4.0, 6.0], surface: surface() }];
        let attitude = TargetAttitudeConfig::default();
        Spacecraft::new(&TargetConfig::Plates { attitude, boxes, plates: vec![plate] }).unwrap()
    }

    #[test]
    fn corners_are_named_by_the_bits_of_their_axes() {
        let points = box_and_plate().named_points();
        assert_eq!(points.len(), 1 + 8 + 4);
        let named = |name: &str| points.iter().find(|point| point.name == name).unwrap().position_m;
        assert_eq!(named("origin"), Vector3::zeros());
        assert_eq!(named("box_0_corner_0"), Vector3::new(-1.0, -2.0, -3.0));
        assert_eq!(named("box_0_corner_5"), Vector3::new(1.0, -2.0, 3.0));
        assert_eq!(named("plate_0_corner_2"), Vector3::new(0.5, 1.0, 3.1));
    }

    /// From +z, the front corners are visible, the rear ones and the origin are not.
    #[test]
    fn a_body_hides_the_points_behind_its_faces() {
        let (body, eye) = (box_and_plate(), Vector3::new(0.2, 0.1, 1000.0));
        for point in body.named_points() {
            let is_behind = point.position_m.z < 2.9;
            assert_eq!(body.hides_point(&point.position_m, &eye), is_behind, "{}", point.name);
        }
    }

    #[test]
    fn the_limb_of_a_sphere_is_where_lines_of_sight_touch_it() {
        let eye = Vector3::new(3.0, -4.0, 12.0);
        for corner in limb_of_sphere(2.0, &eye) {
            assert!((corner.norm() - 2.0).abs() < 1e-12);
            assert!(corner.dot(&(eye - corner)).abs() < 1e-12);
        }
        assert!(limb_of_sphere(14.0, &eye).is_empty());
    }
}
