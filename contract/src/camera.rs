//! Camera parameters and mounting: data without projection mathematics.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Angle, Body, CameraFrame, OutOfRange, Rotation, bounds};

/// Geometry of a camera: detector, focal length, principal point, distortion (far-range paper, Table 1).
///
/// The model h: with x' = X/Z, y' = Y/Z, the undistorted offset from the principal point in pixels is u = f
/// x'/pixel_x, v = f y'/pixel_y. The distorted offset is u (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 u v + p2 (r² +
/// 2 u²), v (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 v²) + 2 p2 u v, with r² = u² + v² in px². Simulator and
/// pipelines implement this model independently.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Number of detector columns, 1 to 16384.
    #[schemars(range(min = 1, max = Self::MAX_SIDE_PX))]
    pub columns: usize,
    /// Number of detector rows, 1 to 16384.
    #[schemars(range(min = 1, max = Self::MAX_SIDE_PX))]
    pub rows: usize,
    /// Focal length, mm, 0.01 to 1e6.
    #[schemars(range(min = 0.01, max = 1e6))]
    pub focal_length_mm: f64,
    /// Width of a pixel (along columns), µm, 0.01 to 1e4.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub pixel_width_um: f64,
    /// Height of a pixel (along rows), µm, 0.01 to 1e4.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub pixel_height_um: f64,
    /// Column of the principal point, px, -1e5 to 1e5; the centre of the first pixel is 0.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub principal_x_px: f64,
    /// Row of the principal point, px, -1e5 to 1e5; the centre of the first pixel is 0.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub principal_y_px: f64,
    /// Radial distortion (k1, k2, k3) in px⁻², px⁻⁴, px⁻⁶, each -1 to 1.
    #[serde(default)]
    #[schemars(inner(range(min = -1, max = 1)))]
    pub radial: [f64; 3],
    /// Tangential distortion (p1, p2) in px⁻¹, each -1 to 1.
    #[serde(default)]
    #[schemars(inner(range(min = -1, max = 1)))]
    pub tangential: [f64; 2],
}

impl Camera {
    /// Largest number of columns or rows; limits the memory that an input file can make the program allocate.
    pub const MAX_SIDE_PX: usize = 16384;

    /// Checks the range of every number. Pixels are between a hundredth of a micrometre and a centimetre; a
    /// value outside indicates a wrong unit. The principal point may be far outside the detector, because a
    /// detector may cover only part of a larger image circle.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "camera")
    }

    /// Returns the focal length in pixels along columns and along rows.
    pub fn focal_length_px(&self) -> (f64, f64) {
        let f_um = self.focal_length_mm * 1000.0;
        (f_um / self.pixel_width_um, f_um / self.pixel_height_um)
    }
}

/// Orientation of the camera on the spacecraft: Euler angles 123 of the rotation from body to camera,
/// degrees.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mounting {
    /// Rotation angle φ about x, degrees, −3600 to 3600.
    #[schemars(range(min = -3600, max = 3600))]
    pub phi_deg: f64,
    /// Rotation angle θ about the resulting y, degrees, −3600 to 3600.
    #[schemars(range(min = -3600, max = 3600))]
    pub theta_deg: f64,
    /// Rotation angle ψ about the resulting z, degrees, −3600 to 3600.
    #[schemars(range(min = -3600, max = 3600))]
    pub psi_deg: f64,
}

impl Mounting {
    /// Checks the range of every angle.
    ///
    /// # Errors
    /// [`OutOfRange`] for an angle outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "mounting")
    }

    /// Returns the rotation from body to camera.
    pub fn camera_from_body(&self) -> Rotation<CameraFrame, Body> {
        Rotation::from_euler_123(
            Angle::from_degrees(self.phi_deg),
            Angle::from_degrees(self.theta_deg),
            Angle::from_degrees(self.psi_deg),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            columns: 768,
            rows: 576,
            focal_length_mm: 24.2,
            pixel_width_um: 8.3,
            pixel_height_um: 8.3,
            principal_x_px: 383.5,
            principal_y_px: 287.5,
            radial: [1e-8, 0.0, 0.0],
            tangential: [0.0; 2],
        }
    }

    #[test]
    fn each_number_outside_its_range_is_named() {
        camera().check().unwrap();
        let refused = |field: &str, change: fn(&mut Camera)| {
            let mut wrong = camera();
            change(&mut wrong);
            assert_eq!(wrong.check().unwrap_err().path, field);
        };
        refused("camera.columns", |c| c.columns = 0);
        refused("camera.rows", |c| c.rows = Camera::MAX_SIDE_PX + 1);
        refused("camera.focal_length_mm", |c| c.focal_length_mm = 1e300);
        refused("camera.focal_length_mm", |c| c.focal_length_mm = 0.0);
        refused("camera.pixel_width_um", |c| c.pixel_width_um = 1e-300);
        refused("camera.pixel_height_um", |c| c.pixel_height_um = f64::NAN);
        refused("camera.principal_x_px", |c| c.principal_x_px = -1e6);
        refused("camera.principal_y_px", |c| c.principal_y_px = f64::INFINITY);
        refused("camera.radial[2]", |c| c.radial[2] = 1e300);
        refused("camera.tangential[1]", |c| c.tangential[1] = -2.0);
    }

    #[test]
    fn a_focal_length_in_pixels_is_that_of_each_direction() {
        let wide = Camera { pixel_width_um: 8.3, pixel_height_um: 10.0, ..camera() };
        let (across, along) = wide.focal_length_px();
        assert!((across - 2_915.662_650_6).abs() < 1e-6 && (along - 2420.0).abs() < 1e-9);
    }

    #[test]
    fn a_mounting_that_is_no_number_is_named() {
        Mounting { phi_deg: 400.0, ..Mounting::default() }.check().unwrap();
        for (field, wrong) in [
            ("mounting.phi_deg", Mounting { phi_deg: f64::NAN, ..Mounting::default() }),
            ("mounting.phi_deg", Mounting { phi_deg: 3600.5, ..Mounting::default() }),
            ("mounting.theta_deg", Mounting { theta_deg: f64::INFINITY, ..Mounting::default() }),
            ("mounting.psi_deg", Mounting { psi_deg: f64::NEG_INFINITY, ..Mounting::default() }),
        ] {
            assert_eq!(wrong.check().unwrap_err().path, field);
        }
    }
}
