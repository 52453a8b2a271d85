//! The target as something that stands in the way: of the stars behind it, and of the camera.

use contract::{Direction, Icrs, Rotation, Target};
use nalgebra::Vector3;

use super::plate::{Brick, Plate};
use crate::scene::aberration::ABERRATION_MARGIN_RAD;

/// What of a target is opaque.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solid<'a> {
    /// A sphere about the origin of the body frame, its radius in m.
    Sphere(f64),
    /// All its plates, and the boxes that some of them are the faces of.
    Plates(&'a [Plate], &'a [Brick]),
}

/// The target as seen from one place, lit or not. It moves with the chaser, so that it is seen where it is.
pub(crate) struct Outline<'a> {
    solid: Solid<'a>,
    target_from_icrs: Rotation<Target, Icrs>,
    /// The camera in the target's body frame, m.
    eye_m: Vector3<f64>,
    line_of_sight: Vector3<f64>,
    /// Of the angle within which all of it is, and [`ABERRATION_MARGIN_RAD`]; −1 from within the sphere about it.
    cos_near: f64,
}

impl<'a> Outline<'a> {
    /// Its outline from `chaser_km` from it (ICRS axes), turned by `target_from_icrs`.
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

    /// Whether it may stand before a far source with this astrometric direction: far quicker to tell than where it appears.
    pub(crate) fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.line_of_sight.dot(astrometric.vector()) >= self.cos_near
    }

    /// Whether it stands before a far source that an ideal camera sees in the direction `apparent`.
    pub(crate) fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        let ray = self.target_from_icrs.rotate(apparent.vector());
        match self.solid {
            Solid::Sphere(radius_m) => {
                let ahead = -self.eye_m.dot(&ray);
                ahead > 0.0 && (self.eye_m + ray * ahead).norm() < radius_m
            }
            Solid::Plates(plates, _) => plates.iter().any(|plate| plate.is_hit_by(&self.eye_m, &ray)),
        }
    }

    /// Whether the camera is inside of it.
    pub(super) fn holds_camera(&self) -> bool {
        match self.solid {
            Solid::Sphere(radius_m) => self.eye_m.norm() <= radius_m,
            Solid::Plates(_, bricks) => bricks.iter().any(|brick| brick.contains(&self.eye_m)),
        }
    }
}
