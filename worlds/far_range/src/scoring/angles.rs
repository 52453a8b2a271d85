//! Error of a line of sight, as two angles in the camera system.

use contract::{Angle, Camera, CameraFrame, Covariance2, Direction, Icrs, Measurement, PixelPoint, Rotation};
use nalgebra::Vector3;
use score::NormalisedError;
use sim::truth::FrameTruth;

/// Angular limits of "within one pixel" and "within two": an error is within a limit if it is strictly
/// smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithinLimits {
    /// Limits across columns ("RA") for one pixel and two, degrees.
    pub ra_deg: [f64; 2],
    /// Limits across rows ("Dec") for one pixel and two, degrees.
    pub dec_deg: [f64; 2],
}

impl WithinLimits {
    /// Returns one and two pixels of a camera at its principal point, without distortion, each axis with its
    /// own scale.
    pub fn from_pixels(camera: &Camera) -> Self {
        let (across_columns, across_rows) = camera.focal_length_px();
        let of = |focal_length_px: f64| {
            [1.0, 2.0].map(|px: f64| Angle::from_radians(libm::atan(px / focal_length_px)).degrees())
        };
        Self { ra_deg: of(across_columns), dec_deg: of(across_rows) }
    }

    /// Returns the same two angles for each axis, degrees.
    pub fn from_degrees(limits: [f64; 2]) -> Self {
        Self { ra_deg: limits, dec_deg: limits }
    }
}

/// Attitude that converts a measured line of sight to the camera frame, or a centroid to a line of sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum AttitudeUsed {
    /// Attitude of the pipeline, which states a line of sight.
    Own,
    /// Measured attitude of telemetry, with the nominal mounting, granted to a centroid.
    Telemetry,
    /// True attitude, granted to a centroid.
    True,
}

impl AttitudeUsed {
    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Telemetry => "telemetry",
            Self::True => "true",
        }
    }
}

/// Attitude that the score grants to measurements that have only a centroid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GrantedAttitude {
    /// No attitude: these measurements have no line of sight.
    #[default]
    None,
    /// Measured attitude of the camera, from telemetry and the nominal mounting.
    Telemetry(Rotation<CameraFrame, Icrs>),
    /// True attitude.
    True,
}

/// Errors of a measurement, measured minus true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnswerError {
    /// Error of the centroid relative to the centroid of the target's flux, px across columns and rows; for a
    /// target without flux in the image, relative to the projection of its line of sight. `None` if that is
    /// behind the camera.
    pub centroid_px: Option<[f64; 2]>,
    /// Error of the line of sight; `None` if there is no line of sight and no attitude is granted.
    pub line_of_sight: Option<LineOfSightError>,
    /// Error of the centroid in units of its covariance; `None` if the measurement states none.
    pub centroid_normalised: Option<NormalisedError>,
    /// Error of the pipeline's line of sight in units of its covariance; `None` if the measurement states
    /// none.
    pub line_of_sight_normalised: Option<NormalisedError>,
}

impl AnswerError {
    /// Computes the errors of a measurement, also in units of the covariances that it states.
    pub fn from_measurement(
        measurement: &Measurement,
        centroid_px: Option<[f64; 2]>,
        line_of_sight: Option<LineOfSightError>,
    ) -> Self {
        let own = line_of_sight.filter(|error| error.attitude == AttitudeUsed::Own);
        let normalised = |error: Option<[f64; 2]>, covariance: Option<Covariance2>| {
            Some(NormalisedError::from_error(error?, &covariance?))
        };
        Self {
            centroid_px,
            line_of_sight,
            centroid_normalised: normalised(centroid_px, measurement.position_covariance),
            line_of_sight_normalised: normalised(
                own.map(|error| [error.ra.radians(), error.dec.radians()]),
                measurement.line_of_sight_covariance,
            ),
        }
    }
}

/// Error of a measured line of sight: two angles in the true camera frame, measured minus true, each in
/// [−180°, 180°].
///
/// The paper calls them right ascension and declination, but measures them in the camera system, where the
/// angles of its Eq. 3 would be singular at the boresight. They are atan2(X, Z) and atan2(Y, Z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSightError {
    /// Error across columns ("RA"): positive when the measured target is to the right of the true one.
    pub ra: Angle,
    /// Error across rows ("Dec"): positive when the measured target is below the true one.
    pub dec: Angle,
    /// Attitude that the line of sight is based on.
    pub attitude: AttitudeUsed,
}

impl LineOfSightError {
    /// Computes the error of a measurement.
    ///
    /// The measured direction in the true camera frame is
    /// - true camera_from_icrs · line of sight, when the pipeline states a line of sight; the error then
    ///   includes that of the pipeline's attitude;
    /// - true camera_from_icrs · measured camera_from_icrs⁻¹ · `unproject(position)`, when the attitude of
    ///   telemetry is granted to a measurement that has only a centroid;
    /// - `unproject(position)` with the true camera, when the true attitude is granted.
    ///
    /// Returns `None` when this direction does not exist or is not finite: without line of sight and granted
    /// attitude, for a line of sight that is NaN, or if no direction is imaged at the position.
    pub fn from_measurement(
        measurement: &Measurement,
        truth: &FrameTruth,
        unproject: &dyn Fn(PixelPoint) -> Option<Direction<CameraFrame>>,
        granted: GrantedAttitude,
    ) -> Option<Self> {
        let camera_from_icrs = &truth.camera_from_icrs;
        let (measured, attitude) = match (&measurement.line_of_sight, granted) {
            (Some(own), _) => (camera_from_icrs.rotate(own.vector()), AttitudeUsed::Own),
            (None, GrantedAttitude::None) => return None,
            (None, GrantedAttitude::Telemetry(measured_from_icrs)) => {
                let line_of_sight = measured_from_icrs.inverse() * unproject(measurement.position)?;
                (camera_from_icrs.rotate(line_of_sight.vector()), AttitudeUsed::Telemetry)
            }
            (None, GrantedAttitude::True) => (*unproject(measurement.position)?.vector(), AttitudeUsed::True),
        };
        Self::between(&measured, &camera_from_icrs.rotate(truth.line_of_sight.vector()), attitude)
    }

    /// Computes the difference, measured minus true, of two vectors in the camera frame.
    fn between(measured: &Vector3<f64>, truth: &Vector3<f64>, attitude: AttitudeUsed) -> Option<Self> {
        let error = Self {
            ra: difference(libm::atan2(measured.x, measured.z), libm::atan2(truth.x, truth.z)),
            dec: difference(libm::atan2(measured.y, measured.z), libm::atan2(truth.y, truth.z)),
            attitude,
        };
        (error.ra.radians().is_finite() && error.dec.radians().is_finite()).then_some(error)
    }
}

/// Returns a − b, wrapped to [−π, π]: a target behind the camera is near the branch cut of atan2.
fn difference(a: f64, b: f64) -> Angle {
    use std::f64::consts::PI;
    let d = a - b;
    Angle::from_radians(if d > PI {
        d - 2.0 * PI
    } else if d < -PI {
        d + 2.0 * PI
    } else {
        d
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{CENTRE, PIXEL, camera, direction_at, frame, tilted, unproject};

    fn measured(position: PixelPoint, line_of_sight: Option<Direction<Icrs>>) -> Measurement {
        Measurement::new(position, line_of_sight)
    }

    /// Error of a line of sight stated by the pipeline.
    fn own(line_of_sight: Direction<Icrs>, truth: &FrameTruth) -> LineOfSightError {
        let measurement = measured(CENTRE, Some(line_of_sight));
        LineOfSightError::from_measurement(&measurement, truth, &unproject, GrantedAttitude::None).unwrap()
    }

    #[test]
    fn one_pixel_to_the_right_is_positive_in_ra_and_down_is_positive_in_dec() {
        let at = |x, y| {
            let point = PixelPoint::new(CENTRE.x + x, CENTRE.y + y);
            LineOfSightError::from_measurement(
                &measured(point, None),
                &frame(0),
                &unproject,
                GrantedAttitude::True,
            )
            .unwrap()
        };
        let (right, down) = (at(1.0, 0.0), at(0.0, 1.0));
        assert!((right.ra.radians() - libm::atan(PIXEL)).abs() < 1e-12 && right.dec.radians().abs() < 1e-12);
        assert!((down.dec.radians() - libm::atan(PIXEL)).abs() < 1e-12 && down.ra.radians().abs() < 1e-12);
    }

    #[test]
    fn the_true_line_of_sight_has_no_error_at_any_attitude() {
        for truth in [frame(0), tilted(0)] {
            let error = own(truth.line_of_sight, &truth);
            assert!(error.ra.radians().abs() < 1e-12 && error.dec.radians().abs() < 1e-12, "{error:?}");
        }
    }

    /// The pipeline measures the pixel exactly, but converts it to the sky with a wrong attitude.
    #[test]
    fn an_error_of_the_attitude_counts_in_the_line_of_sight_and_not_in_the_pixel() {
        let truth = tilted(0);
        let roll = Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(Vector3::new(0.0, 0.001, 0.0));
        let wrong_attitude = roll * truth.camera_from_icrs;
        let line_of_sight = wrong_attitude.inverse() * direction_at(CENTRE);
        assert!((own(line_of_sight, &truth).ra.radians() + 0.001).abs() < 1e-9);
        let of = |granted| {
            LineOfSightError::from_measurement(&measured(CENTRE, None), &truth, &unproject, granted)
        };
        let granted = of(GrantedAttitude::True).unwrap();
        assert!(granted.ra.radians().abs() < 1e-12);
        assert_eq!(granted.attitude, AttitudeUsed::True);
        // The measured attitude of telemetry counts like an attitude of the pipeline.
        let granted = of(GrantedAttitude::Telemetry(wrong_attitude)).unwrap();
        assert!((granted.ra.radians() + 0.001).abs() < 1e-9);
        assert_eq!(granted.attitude, AttitudeUsed::Telemetry);
        // A line of sight stated by the pipeline is used unchanged, regardless of the granted attitude.
        let error = LineOfSightError::from_measurement(
            &measured(CENTRE, Some(line_of_sight)),
            &truth,
            &unproject,
            GrantedAttitude::True,
        );
        assert_eq!(error, Some(own(line_of_sight, &truth)));
    }

    /// With the true attitude, which was formerly granted silently, only the error in the image remains.
    #[test]
    fn a_centroid_has_no_line_of_sight_unless_an_attitude_is_granted() {
        let of = |granted| {
            LineOfSightError::from_measurement(&measured(CENTRE, None), &frame(0), &unproject, granted)
        };
        assert_eq!(of(GrantedAttitude::None), None);
        assert_eq!(GrantedAttitude::default(), GrantedAttitude::None);
    }

    #[test]
    fn a_pixel_of_each_axis_has_the_angle_of_its_own_scale() {
        let limits = WithinLimits::from_pixels(&camera());
        // 8.6 and 8.3 µm at 20.187 mm: the paper's 0.024° are 0.983 px across columns and 1.019 px across
        // rows.
        for (limits, px) in [(limits.ra_deg, 0.983), (limits.dec_deg, 1.019)] {
            assert!((0.024 / limits[0] - px).abs() < 5e-4, "{limits:?}");
            assert!((0.048 / limits[1] - px).abs() < 5e-4, "{limits:?}");
        }
        assert_eq!(
            WithinLimits::from_degrees([0.024, 0.048]),
            WithinLimits { ra_deg: [0.024, 0.048], dec_deg: [0.024, 0.048] }
        );
    }

    #[test]
    fn saboteur_a_transposed_attitude_is_no_small_error() {
        let truth = tilted(0);
        let transposed: Rotation<Icrs, CameraFrame> =
            Rotation::from_unit_quaternion(*truth.camera_from_icrs.quaternion());
        let line_of_sight = transposed * direction_at(CENTRE);
        let error = own(line_of_sight, &truth);
        let two_pixels = Angle::from_degrees(0.048);
        assert!(error.ra.abs() > two_pixels || error.dec.abs() > two_pixels, "{error:?}");
    }

    #[test]
    fn angles_across_the_cut_differ_by_little() {
        let behind = |x: f64| Vector3::new(x, 0.0, -1.0);
        let between =
            |measured, truth| LineOfSightError::between(&measured, &truth, AttitudeUsed::Own).unwrap();
        let ra = |measured, truth| between(measured, truth).ra.radians();
        // Behind the camera, a direction further to the right has the smaller angle.
        assert!((ra(behind(1e-6), behind(-1e-6)) + 2e-6).abs() < 1e-12);
        assert!((ra(behind(-1e-6), behind(1e-6)) - 2e-6).abs() < 1e-12);
        assert_eq!(ra(behind(0.0), Vector3::z()), std::f64::consts::PI);
        assert_eq!(ra(Vector3::z(), behind(0.0)), -std::f64::consts::PI);
    }

    #[test]
    fn one_angle_that_is_no_number_is_no_error_at_all() {
        for measured in [Vector3::new(f64::NAN, 0.0, 1.0), Vector3::new(0.0, f64::NAN, 1.0)] {
            assert_eq!(LineOfSightError::between(&measured, &Vector3::z(), AttitudeUsed::Own), None);
        }
    }

    #[test]
    fn a_position_without_a_direction_has_no_error() {
        let nowhere = LineOfSightError::from_measurement(
            &measured(CENTRE, None),
            &frame(0),
            &|_| None,
            GrantedAttitude::True,
        );
        assert_eq!(nowhere, None);
    }
}
