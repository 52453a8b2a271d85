//! Measurement model: the line of sight in the camera's axes.
//!
//! The model is exact: the absolute states of chaser and target are subtracted. The linear map of relative
//! elements to R, T, N omits the curvature of the orbit, 63 m at 30 km.

use contract::navigation::{AngleErrors, LineOfSightErrors, LineOfSightMeasurement, RelativeElements, Use};
use hifitime::Epoch;
use nalgebra::{Matrix2x3, Matrix2x6, Matrix3, Vector3};

use crate::orbit::{Orbit, wrap};
use crate::reference::Reference;
use crate::relative;
use crate::short_period::Osculation;
use crate::time::seconds_between;

/// Class of errors of a measurement, by the source of the camera's attitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ErrorClass {
    /// Attitude solved from stars of the same image.
    WithStars,
    /// Attitude from telemetry, or of unknown source.
    WithoutStars,
}

impl ErrorClass {
    /// Both classes.
    pub(crate) const ALL: [Self; 2] = [Self::WithStars, Self::WithoutStars];

    /// Returns the errors of this class.
    pub(crate) fn errors(self, errors: &LineOfSightErrors) -> &AngleErrors {
        match self {
            Self::WithStars => &errors.with_stars,
            Self::WithoutStars => &errors.without_stars,
        }
    }
}

/// Measurement prepared for estimation.
#[derive(Debug, Clone)]
pub(crate) struct Sight {
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    /// Measured angles across columns and across rows, rad.
    pub(crate) measured: [f64; 2],
    /// Class of errors.
    pub(crate) class: ErrorClass,
    /// Covariance of the white errors, elements xx, xy, yy, rad².
    pub(crate) noise: [f64; 3],
    camera_from_icrs: Matrix3<f64>,
    chaser: Orbit,
    chaser_position_km: Vector3<f64>,
}

/// Predicted measurement.
#[derive(Debug, Clone)]
pub(crate) struct Prediction {
    /// Angles atan2(X, Z) and atan2(Y, Z), rad.
    pub(crate) angles: [f64; 2],
    /// Vector from the chaser to the target, camera axes, km.
    direction: Vector3<f64>,
    /// Mean orbit of the target.
    target: Orbit,
}

impl Sight {
    /// Prepares a measurement.
    ///
    /// # Errors
    /// The reason why the measurement cannot be used.
    pub(crate) fn new(
        measurement: &LineOfSightMeasurement,
        epoch: Epoch,
        errors: &LineOfSightErrors,
        reference: &Reference,
    ) -> Result<Self, Use> {
        let seconds = seconds_between(epoch, measurement.time);
        let class = match measurement.attitude_source {
            Some(source) if source.is_by_stars() => ErrorClass::WithStars,
            _ => ErrorClass::WithoutStars,
        };
        let noise = match &measurement.covariance {
            Some(covariance) => covariance.matrix(),
            None => {
                let [x, y] = class.errors(errors).white_arcsec.map(radians_from_arcsec);
                [x * x, 0.0, y * y]
            }
        };
        let determinant = noise[0] * noise[2] - noise[1] * noise[1];
        let is_positive = noise[0] > 0.0 && noise[2] > 0.0 && determinant > 0.0 && determinant.is_finite();
        let camera_from_icrs = measurement.camera_from_icrs.matrix();
        let direction = camera_from_icrs * measurement.line_of_sight.vector();
        let is_finite = direction.iter().all(|x| x.is_finite());
        if !is_positive || !is_finite || direction.z <= 0.0 {
            return Err(Use::Unusable);
        }
        let chaser = reference.orbit(seconds).ok_or(Use::NoChaserOrbit)?;
        Ok(Self {
            seconds,
            measured: angles(&direction),
            class,
            noise,
            camera_from_icrs,
            chaser,
            chaser_position_km: reference.osculation().state(&chaser).position_km,
        })
    }

    /// Predicts the measurement from the relative elements at its time.
    pub(crate) fn predict(&self, elements: &RelativeElements, osculation: Osculation) -> Prediction {
        let target = relative::target(&self.chaser, elements);
        let offset = osculation.state(&target).position_km - self.chaser_position_km;
        let direction = self.camera_from_icrs * offset;
        Prediction { angles: angles(&direction), direction, target }
    }

    /// Returns measured minus predicted angles, rad.
    pub(crate) fn residual(&self, prediction: &Prediction) -> [f64; 2] {
        [0, 1].map(|axis| wrap(self.measured[axis] - prediction.angles[axis]))
    }

    /// Returns the derivatives of the predicted angles with respect to the elements, rad/m.
    pub(crate) fn by_elements(
        &self,
        elements: &RelativeElements,
        prediction: &Prediction,
        osculation: Osculation,
    ) -> Matrix2x6<f64> {
        let position = relative::position_partials(&prediction.target, elements, osculation);
        angle_partials(&prediction.direction) * self.camera_from_icrs * position
    }

    /// Returns the angle between the measured direction and the along-track direction of the chaser's orbit
    /// as its cosine: positive if the target is ahead.
    pub(crate) fn ahead(&self, osculation: Osculation) -> f64 {
        let [x, y] = self.measured.map(libm::tan);
        let direction = self.camera_from_icrs.transpose() * Vector3::new(x, y, 1.0).normalize();
        let [_, along, _] = osculation.state(&self.chaser).rtn_axes();
        direction.dot(&along)
    }
}

impl Prediction {
    /// Returns the derivatives of the angles with respect to a rotation of the measured direction about the
    /// camera's axes, rad/rad.
    pub(crate) fn by_rotation(&self) -> Matrix2x3<f64> {
        // δd = b × d = −[d]× b; the angles do not depend on the length of d.
        let d = &self.direction;
        let cross = Matrix3::new(0.0, -d.z, d.y, d.z, 0.0, -d.x, -d.y, d.x, 0.0);
        -angle_partials(d) * cross
    }

    /// Returns the derivatives of the angles across columns and rows with respect to a displacement of the
    /// target along columns and along rows, rad/m.
    pub(crate) fn by_displacement(&self) -> [f64; 2] {
        let partials = angle_partials(&self.direction) * 1e-3;
        [partials[(0, 0)], partials[(1, 1)]]
    }
}

fn angles(direction: &Vector3<f64>) -> [f64; 2] {
    [libm::atan2(direction.x, direction.z), libm::atan2(direction.y, direction.z)]
}

/// Derivatives of the two angles with respect to the vector.
fn angle_partials(d: &Vector3<f64>) -> Matrix2x3<f64> {
    let (xz, yz) = (d.x * d.x + d.z * d.z, d.y * d.y + d.z * d.z);
    Matrix2x3::new(d.z / xz, 0.0, -d.x / xz, 0.0, d.z / yz, -d.y / yz)
}

/// Converts arcseconds to radians.
pub(crate) fn radians_from_arcsec(arcsec: f64) -> f64 {
    (arcsec / 3600.0).to_radians()
}
