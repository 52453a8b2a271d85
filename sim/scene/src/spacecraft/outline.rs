//! The target as an obstacle: it occults the stars behind it and must not contain the camera.

use contract::{Direction, Icrs, Rotation, Target};
use nalgebra::Vector3;

use super::plate::{Brick, Plate};
use crate::aberration::ABERRATION_MARGIN_RAD;

/// Opaque solid of a target.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solid<'a> {
    /// Sphere about the origin of the body frame; its radius, m.
    Sphere(f64),
    /// All plates, and the boxes whose faces are among the plates.
    Plates(&'a [Plate], &'a [Brick]),
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
            Solid::Plates(plates, _) => plates.iter().map(Plate::reach).fold(0.0, f64::max),
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
            Solid::Plates(plates, _) => plates.iter().any(|plate| plate.is_hit_by(&self.eye_m, &ray)),
        }
    }

    /// Returns true if the camera is inside the target.
    pub(super) fn holds_camera(&self) -> bool {
        match self.solid {
            Solid::Sphere(radius_m) => self.eye_m.norm() <= radius_m,
            Solid::Plates(_, bricks) => bricks.iter().any(|brick| brick.contains(&self.eye_m)),
        }
    }
}
