//! Where the camera looks during an exposure.

use contract::{Angle, CameraFrame, Icrs, Rotation};

use crate::optics::Projection;

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
