//! The target as an obstacle: it occults the stars behind it and must not contain the camera.

use contract::{Direction, Icrs, Rotation, Target};
use nalgebra::Vector3;

use super::facet::Facet;
use super::plate::Brick;
use crate::aberration::ABERRATION_MARGIN_RAD;

/// Opaque solid of a target.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solid<'a> {
    /// Sphere about the origin of the body frame; its radius, m.
    Sphere(f64),
    /// All facets of a body, and the space that they enclose.
    Facets(&'a [Facet], &'a Inside),
}

/// Space inside a body of facets.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Inside {
    /// That of boxes.
    Boxes(Vec<Brick>),
    /// That of the shells of a mesh.
    Mesh,
}

/// The target as seen from one position, lit or unlit. It moves with the chaser, so its direction has no
/// aberration.
pub struct Outline<'a> {
    solid: Solid<'a>,
    target_from_icrs: Rotation<Target, Icrs>,
    /// Position of the camera in the target's body frame, m.
    eye_m: Vector3<f64>,
    line_of_sight: Vector3<f64>,
    /// Cosine of the sum of the angular radius that contains the whole target and [`ABERRATION_MARGIN_RAD`];
    /// −1 if the camera is inside the enclosing sphere.
    cos_near: f64,
}

impl<'a> Outline<'a> {
    /// Returns the outline seen from `chaser_km` (relative to the target, ICRS axes), with the attitude
    /// `target_from_icrs`.
    pub(super) fn new(
        solid: Solid<'a>,
        chaser_km: &Vector3<f64>,
        target_from_icrs: Rotation<Target, Icrs>,
    ) -> Self {
        let radius_m = match solid {
            Solid::Sphere(radius_m) => radius_m,
            Solid::Facets(facets, _) => facets.iter().map(Facet::reach).fold(0.0, f64::max),
        };
        let eye_m = target_from_icrs.rotate(chaser_km) * 1000.0;
        let sine = radius_m / eye_m.norm();
        let cos_near = if sine < 1.0 { libm::cos(libm::asin(sine) + ABERRATION_MARGIN_RAD) } else { -1.0 };
        Self { solid, target_from_icrs, eye_m, line_of_sight: -chaser_km.normalize(), cos_near }
    }

    /// Returns true if the target may hide a distant source with this astrometric direction. This test is
    /// much faster than the computation of the apparent direction.
    pub fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.line_of_sight.dot(astrometric.vector()) >= self.cos_near
    }

    /// Returns true if the target hides a distant source that an ideal camera sees in the direction
    /// `apparent`.
    pub fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        let ray = self.target_from_icrs.rotate(apparent.vector());
        match self.solid {
            Solid::Sphere(radius_m) => {
                let ahead = -self.eye_m.dot(&ray);
                ahead > 0.0 && (self.eye_m + ray * ahead).norm() < radius_m
            }
            Solid::Facets(facets, _) => facets.iter().any(|facet| facet.is_hit_by(&self.eye_m, &ray)),
        }
    }

    /// Returns true if the camera is inside the target.
    pub(super) fn holds_camera(&self) -> bool {
        match self.solid {
            Solid::Sphere(radius_m) => self.eye_m.norm() <= radius_m,
            Solid::Facets(_, Inside::Boxes(bricks)) => bricks.iter().any(|brick| brick.contains(&self.eye_m)),
            // From outside of the enclosing sphere, no sum is needed.
            Solid::Facets(facets, Inside::Mesh) => self.cos_near == -1.0 && turns(facets, &self.eye_m) > 0.5,
        }
    }
}

/// Number of times that the shells of a mesh enclose a point: the sum of the solid angles of the triangles
/// over 4π, each tan(Ω/2) = a · (b × c)/(abc + (a · b) c + (b · c) a + (c · a) b) (Van Oosterom & Strackee
/// 1983, IEEE Trans. Biomed. Eng. 30, 125).
fn turns(facets: &[Facet], point_m: &Vector3<f64>) -> f64 {
    let solid_angle = |facet: &Facet| {
        let mut corners = facet.corners_m().map(|corner| corner - point_m);
        let (Some(a), Some(b), Some(c)) = (corners.next(), corners.next(), corners.next()) else {
            return 0.0;
        };
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * libm::atan2(a.dot(&b.cross(&c)), below)
    };
    facets.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
