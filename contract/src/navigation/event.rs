//! Events that a navigator receives.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::bounds::require;
use crate::{AttitudeSource, CameraFrame, Covariance2, Direction, Icrs, OutOfRange, Rotation};

/// Largest change of velocity of an impulse, m/s.
const MAX_DV_M_S: f64 = 100.0;

/// One event, in the order of its arrival, which need not be the order of its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A measured line of sight.
    LineOfSight(LineOfSightMeasurement),
    /// A reported manoeuvre of the chaser.
    Manoeuvre(ManoeuvreReport),
}

impl Event {
    /// Returns the time to which the event applies.
    pub fn time(&self) -> Epoch {
        match self {
            Self::LineOfSight(measurement) => measurement.time,
            Self::Manoeuvre(manoeuvre) => manoeuvre.time,
        }
    }
}

/// Measured direction from the chaser to the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSightMeasurement {
    /// Number of the frame; a second measurement with the same number and time is a duplicate.
    pub frame: u64,
    /// Time of the measurement, the middle of the exposure.
    pub time: Epoch,
    /// Geometric direction from the chaser to the target (aberration corrected).
    pub line_of_sight: Direction<Icrs>,
    /// Attitude of the camera used for the line of sight: turns it back into the camera's axes, in which the
    /// errors are stated.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Covariance of the angles atan2(X, Z) across columns and atan2(Y, Z) across rows in the camera frame,
    /// rad², without slow and constant errors; `None`: the white part of the setup's errors applies.
    pub covariance: Option<Covariance2>,
    /// Source of the camera's attitude, which selects the errors of the setup; `None` counts as without
    /// stars.
    pub attitude_source: Option<AttitudeSource>,
}

/// Reported impulse of the chaser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManoeuvreReport {
    /// Time of the impulse.
    pub time: Epoch,
    /// Change of velocity along the chaser's own radial, transverse and normal axes, m/s.
    pub dv_rtn_m_s: Vector3<f64>,
    /// Standard deviation of the error along each of these axes, m/s; 0: exact.
    pub sigma_rtn_m_s: Vector3<f64>,
}

impl ManoeuvreReport {
    /// Checks the range of every number: each component of the impulse −100 to 100, each σ 0 to 100 m/s.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        self.dv_rtn_m_s.iter().enumerate().try_for_each(|(axis, dv)| {
            require(format!("manoeuvre.dv_rtn_m_s[{axis}]"), *dv, "-100 to 100", |dv| dv.abs() <= MAX_DV_M_S)
        })?;
        self.sigma_rtn_m_s.iter().enumerate().try_for_each(|(axis, sigma)| {
            require(format!("manoeuvre.sigma_rtn_m_s[{axis}]"), *sigma, "0 to 100", |sigma| {
                (0.0..=MAX_DV_M_S).contains(&sigma)
            })
        })
    }
}
