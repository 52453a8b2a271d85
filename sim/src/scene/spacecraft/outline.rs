//! The target as something that stands in the way: of the stars behind it, and of the camera.

use contract::bounds::require;
use contract::{Direction, Icrs, OutOfRange, Rotation, Target};
use nalgebra::Vector3;

use super::{Model, Spacecraft};
use crate::scene::aberration::ABERRATION_MARGIN_RAD;
use crate::truth::States;

/// The target as seen from one place, lit or not. It moves with the chaser, so that it is seen where it is.
pub(crate) struct Outline<'a> {
    model: &'a Model,
    target_from_icrs: Rotation<Target, Icrs>,
    /// The camera in the target's body frame, m.
    eye_m: Vector3<f64>,
    line_of_sight: Vector3<f64>,
    /// Of the angle within which all of it is, and [`ABERRATION_MARGIN_RAD`]; −1 from within the sphere about it.
    cos_near: f64,
}

impl Spacecraft {
    /// Refuses a camera that is as good as at the target, or inside of it, in a frame.
    pub(crate) fn check_separation(&self, states: &States, frame: u64) -> Result<(), OutOfRange> {
        let (line_of_sight_km, range_m) = (states.line_of_sight_km(), states.range_km() * 1000.0);
        require("orbit.relative", range_m, "a separation of 1 m or more", |m| m >= 1.0)?;
        match self.outline(&-line_of_sight_km, self.attitude(states)) {
            Some(outline) if outline.holds_camera() => Err(OutOfRange::new(
                "orbit.relative",
                format!("{range_m:.3} m from the target's centre at frame {frame}"),
                "a camera outside of the target",
            )),
            _ => Ok(()),
        }
    }

    /// Its outline from `chaser_km` from it (ICRS axes), turned by `target_from_icrs`; `None` of a point of light.
    pub(crate) fn outline(
        &self,
        chaser_km: &Vector3<f64>,
        target_from_icrs: Option<Rotation<Target, Icrs>>,
    ) -> Option<Outline<'_>> {
        let radius_m = match &self.model {
            Model::Beacon { .. } => return None,
            Model::Sphere { radius_m, .. } => *radius_m,
            Model::Plates { plates, .. } => plates.iter().map(super::Plate::reach).fold(0.0, f64::max),
        };
        let target_from_icrs = target_from_icrs.unwrap_or_else(Rotation::identity);
        let eye_m = target_from_icrs.rotate(chaser_km) * 1000.0;
        let sine = radius_m / eye_m.norm();
        let cos_near = if sine < 1.0 { libm::cos(libm::asin(sine) + ABERRATION_MARGIN_RAD) } else { -1.0 };
        Some(Outline {
            model: &self.model,
            target_from_icrs,
            eye_m,
            line_of_sight: -chaser_km.normalize(),
            cos_near,
        })
    }
}

impl Outline<'_> {
    /// Whether it may stand before a far source with this astrometric direction: far quicker to tell than where it appears.
    pub(crate) fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.line_of_sight.dot(astrometric.vector()) >= self.cos_near
    }

    /// Whether it stands before a far source that an ideal camera sees in the direction `apparent`.
    pub(crate) fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        let ray = self.target_from_icrs.rotate(apparent.vector());
        match self.model {
            Model::Beacon { .. } => false,
            Model::Sphere { radius_m, .. } => {
                let ahead = -self.eye_m.dot(&ray);
                ahead > 0.0 && (self.eye_m + ray * ahead).norm() < *radius_m
            }
            Model::Plates { plates, .. } => plates.iter().any(|plate| plate.meets(&self.eye_m, &ray)),
        }
    }

    /// Whether the camera is inside of it.
    fn holds_camera(&self) -> bool {
        match self.model {
            Model::Beacon { .. } => false,
            Model::Sphere { radius_m, .. } => self.eye_m.norm() <= *radius_m,
            Model::Plates { bricks, .. } => bricks.iter().any(|brick| brick.contains(&self.eye_m)),
        }
    }
}
