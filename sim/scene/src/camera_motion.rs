//! Attitude of the camera during an exposure.

use contract::{Angle, CameraFrame, Icrs, Rotation};
use optics::Projection;

/// Attitude of the camera during an exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// Attitude in the middle of the exposure.
    pub middle: Rotation<CameraFrame, Icrs>,
    /// Attitudes at the start and the end of the exposure.
    pub ends: [Rotation<CameraFrame, Icrs>; 2],
    /// Largest rotation from the middle at any other time at which the frame is exposed, namely during the
    /// other field of an interlaced frame.
    pub elsewhere: Angle,
}

impl CameraMotion {
    /// Returns the motion of a camera at rest.
    pub fn still(camera_from_icrs: Rotation<CameraFrame, Icrs>) -> Self {
        Self { middle: camera_from_icrs, ends: [camera_from_icrs; 2], elsewhere: Angle::ZERO }
    }

    /// Largest rotation from the middle: at the farther end, or during the other field.
    pub fn reach(&self) -> Angle {
        let [begin, end] = self.ends.map(|end| end.angle_to(&self.middle));
        [begin, end].into_iter().fold(self.elsewhere, larger)
    }

    /// Extends the range of attitudes to an exposure about another time.
    pub fn widen_to(&mut self, other: &Self) {
        let [begin, end] = other.ends.map(|end| end.angle_to(&self.middle));
        self.elsewhere =
            [begin, end, other.middle.angle_to(&self.middle)].into_iter().fold(self.elsewhere, larger);
    }

    /// Extends the range of attitudes by a rotation within the exposure.
    pub fn widen_by(&mut self, rotation: Angle) {
        self.elsewhere = Angle::from_radians(self.reach().radians() + rotation.radians());
    }

    /// Largest displacement of a distant object's image by the rotation, px.
    pub(crate) fn reach_px(&self, projection: &Projection) -> f64 {
        let (x_px_per_rad, y_px_per_rad) = projection.plate_scale_px_per_rad();
        // Towards the corners of a wide field a rotation moves a star by more than the plate scale on the
        // axis gives.
        let widening = 1.0 / libm::cos(projection.half_diagonal().radians()).max(0.1);
        self.reach().radians() * x_px_per_rad.max(y_px_per_rad) * widening * widening
    }
}

fn larger(a: Angle, b: Angle) -> Angle {
    if b.radians() > a.radians() { b } else { a }
}
