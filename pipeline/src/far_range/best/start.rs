//! Initial attitude of a frame: from telemetry, or from the frame's stars only.

use contract::{CameraFrame, Icrs, Rotation};
use nalgebra::{Matrix3, Vector3};

use super::lost_in_space::FoundAttitude;
use super::mounting::AttitudeError;

/// Prior attitude of the camera: a reference, and the distribution of its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct AttitudeStart {
    pub(super) reference: Rotation<CameraFrame, Icrs>,
    pub(super) prior: AttitudeError,
}

/// Standard deviation of an attitude found without a prior, in addition to that from its sources, about each
/// axis, rad: one arc minute. Aberration shifts the directions of its stars by 20″ to 26″.
const FOUND_SIGMA_RAD: f64 = 2.908_882_086_657_216e-4;

/// Factor on the covariance of an attitude found without a prior. The same stars are used again for the final
/// attitude and must not count twice.
const WIDENING: f64 = 16.0;

impl AttitudeStart {
    /// Returns the camera's attitude for an error `e`, a small rotation about its axes.
    pub(super) fn attitude(&self, e: Vector3<f64>) -> Rotation<CameraFrame, Icrs> {
        Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(e) * self.reference
    }

    /// Creates the start from an attitude found by the stars without a prior.
    pub(super) fn from_found(found: &FoundAttitude) -> Self {
        let covariance =
            found.covariance * WIDENING + Matrix3::identity() * (FOUND_SIGMA_RAD * FOUND_SIGMA_RAD);
        Self {
            reference: found.camera_from_icrs,
            prior: AttitudeError { mean: Vector3::zeros(), covariance },
        }
    }
}
