//! What is in the field: stars, planets, the Moon and the target, as sources with a place and a rate of electrons.

mod background;
mod disk;
pub mod docking;
pub(crate) mod earth;
pub(crate) mod moon;
pub(crate) mod planets;
mod spacecraft;
mod star_field;

pub use background::{Background, BackgroundConfig, BackgroundField, EarthLightConfig, StrayLightConfig};
pub use spacecraft::{Appearance, BoxConfig, Lighting, PlateConfig, Spacecraft, SurfaceConfig, TargetConfig};
pub use star_field::StarField;

use contract::{Angle, CameraFrame, Direction, Icrs, PixelPoint, Rotation};

use crate::optics::Projection;
use crate::truth::ObjectKind;

/// More than aberration (26″ from an orbit about the Earth) and the Sun's deflection (2″) move a star: 0.1°.
const ABERRATION_MARGIN_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// Where the camera looks during an exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// In the middle of the exposure.
    pub middle: Rotation<CameraFrame, Icrs>,
    /// At its begin and its end.
    pub ends: [Rotation<CameraFrame, Icrs>; 2],
    /// How far from the middle it is at most turned at any other moment at which the frame is exposed: that of the other
    /// field of an interlaced one.
    pub elsewhere: Angle,
}

impl CameraMotion {
    /// A camera at rest.
    pub fn still(camera_from_icrs: Rotation<CameraFrame, Icrs>) -> Self {
        Self { middle: camera_from_icrs, ends: [camera_from_icrs; 2], elsewhere: Angle::ZERO }
    }

    /// How far it turns at most from the middle: to the farther end, or elsewhere.
    pub fn reach(&self) -> Angle {
        let [begin, end] = self.ends.map(|end| end.angle_to(&self.middle));
        [begin, end].into_iter().fold(self.elsewhere, larger)
    }

    /// Lets the camera also look out for what is seen in an exposure about another moment.
    pub(crate) fn widen_to(&mut self, other: &Self) {
        let [begin, end] = other.ends.map(|end| end.angle_to(&self.middle));
        self.elsewhere =
            [begin, end, other.middle.angle_to(&self.middle)].into_iter().fold(self.elsewhere, larger);
    }

    /// How far that moves the image of a far object, px, at most.
    pub(crate) fn reach_px(&self, projection: &Projection) -> f64 {
        let (x_px_per_rad, y_px_per_rad) = projection.plate_scale_px_per_rad();
        // Towards the corners of a wide field a turn moves a star by more than the plate scale on the axis says.
        let widening = 1.0 / libm::cos(projection.half_diagonal().radians()).max(0.1);
        self.reach().radians() * x_px_per_rad.max(y_px_per_rad) * widening * widening
    }
}

fn larger(a: Angle, b: Angle) -> Angle {
    if b.radians() > a.radians() { b } else { a }
}

/// A source of electrons on the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// What it is.
    pub kind: ObjectKind,
    /// Number within its kind.
    pub id: u32,
    /// Where it is in the middle of the exposure; may lie off the detector by as much as its image reaches. Of the target:
    /// where the origin of its body frame is; of the Moon: where the centre of its disk is.
    pub position: PixelPoint,
    /// Where it is at the begin and at the end of the exposure.
    pub ends: [PixelPoint; 2],
    /// Direction without aberration; for the target its geometric line of sight; `None` for what is no light of the
    /// sky.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude.
    pub magnitude: Option<f64>,
    /// Photoelectrons per second.
    pub electrons_per_s: f64,
}
