//! The camera's data: numbers, no mathematics.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::require;
use crate::{Angle, Body, CameraFrame, ContractError, Rotation};

/// Geometry of a camera: detector, focal length, principal point, distortion (far-range paper, Table 1).
///
/// The model h: with x' = X/Z, y' = Y/Z, the undistorted offset from the principal point in pixels is
/// u = f x'/pixel_x, v = f y'/pixel_y. The distorted offset is
/// u (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 u v + p2 (r² + 2 u²),
/// v (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 v²) + 2 p2 u v, with r² = u² + v² in px².
/// Simulator and pipelines each implement it on their own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Columns of the detector, 1 to 16384.
    pub columns: usize,
    /// Rows of the detector, 1 to 16384.
    pub rows: usize,
    /// Focal length, mm, positive.
    pub focal_length_mm: f64,
    /// Width of a pixel (along columns), µm, positive.
    pub pixel_width_um: f64,
    /// Height of a pixel (along rows), µm, positive.
    pub pixel_height_um: f64,
    /// Principal point along columns, px; the centre of the first pixel is 0.
    pub principal_x_px: f64,
    /// Principal point along rows, px; the centre of the first pixel is 0.
    pub principal_y_px: f64,
    /// Radial distortion (k1, k2, k3) in px⁻², px⁻⁴, px⁻⁶.
    #[serde(default)]
    pub radial: [f64; 3],
    /// Tangential distortion (p1, p2) in px⁻¹.
    #[serde(default)]
    pub tangential: [f64; 2],
}

impl Camera {
    /// Largest number of columns or rows; bounds what a file can make us allocate.
    pub const MAX_SIDE_PX: usize = 16384;

    /// Checks every number.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), ContractError> {
        let side = |v: f64| (1.0..=Self::MAX_SIDE_PX as f64).contains(&v);
        require("camera.columns", self.columns as f64, "1 to 16384", side)?;
        require("camera.rows", self.rows as f64, "1 to 16384", side)?;
        let positive = |v: f64| v > 0.0;
        require("camera.focal_length_mm", self.focal_length_mm, "greater than 0", positive)?;
        require("camera.pixel_width_um", self.pixel_width_um, "greater than 0", positive)?;
        require("camera.pixel_height_um", self.pixel_height_um, "greater than 0", positive)?;
        require("camera.principal_x_px", self.principal_x_px, "a finite number", |_| true)?;
        require("camera.principal_y_px", self.principal_y_px, "a finite number", |_| true)?;
        for k in self.radial {
            require("camera.radial", k, "finite numbers", |_| true)?;
        }
        for p in self.tangential {
            require("camera.tangential", p, "finite numbers", |_| true)?;
        }
        Ok(())
    }

    /// Focal length in pixels along columns and along rows.
    pub fn focal_length_px(&self) -> (f64, f64) {
        let f_um = self.focal_length_mm * 1000.0;
        (f_um / self.pixel_width_um, f_um / self.pixel_height_um)
    }
}

/// How the camera sits on the spacecraft: Euler angles 123 of the rotation from body to camera, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mounting {
    /// φ, about x, degrees.
    pub phi_deg: f64,
    /// θ, about the resulting y, degrees.
    pub theta_deg: f64,
    /// ψ, about the resulting z, degrees.
    pub psi_deg: f64,
}

impl Mounting {
    /// Checks every number.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for an angle that is not finite.
    pub fn check(&self) -> Result<(), ContractError> {
        require("mounting.phi_deg", self.phi_deg, "a finite number", |_| true)?;
        require("mounting.theta_deg", self.theta_deg, "a finite number", |_| true)?;
        require("mounting.psi_deg", self.psi_deg, "a finite number", |_| true)
    }

    /// The rotation from body to camera.
    pub fn camera_from_body(&self) -> Rotation<CameraFrame, Body> {
        Rotation::from_euler_123(
            Angle::from_degrees(self.phi_deg),
            Angle::from_degrees(self.theta_deg),
            Angle::from_degrees(self.psi_deg),
        )
    }
}
