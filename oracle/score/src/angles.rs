//! The error of a line of sight, as two angles in the camera system.

use contract::{Angle, CameraFrame, Direction, Measurement, PixelPoint};
use nalgebra::Vector3;
use sim::truth::FrameTruth;

/// One pixel of the far-range camera, as the paper prints it (Table 2): an error counts as within it when it is
/// strictly smaller. It is 0.983 px across columns and 1.019 px across rows.
pub const ONE_PIXEL: Angle = Angle::from_degrees(0.024);

/// Two pixels of the far-range camera, as the paper prints them (Table 2).
pub const TWO_PIXELS: Angle = Angle::from_degrees(0.048);

/// Error of a measured line of sight: two angles in the true camera frame, measured minus true, each in
/// [−180°, 180°].
///
/// The paper calls them right ascension and declination, but takes them in the camera system, where the angles of
/// its Eq. 3 would be singular at the boresight. They are atan2(X, Z) and atan2(Y, Z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSightError {
    /// Across columns ("RA"): positive when the measured target lies to the right of the true one.
    pub ra: Angle,
    /// Across rows ("Dec"): positive when the measured target lies below the true one.
    pub dec: Angle,
}

impl LineOfSightError {
    /// The error of a measurement.
    ///
    /// The measured direction in the true camera frame is
    /// - true camera_from_icrs · line of sight, when the pipeline gives a line of sight, so that an error of its
    ///   attitude counts;
    /// - `unproject(position)` with the true camera otherwise: a pipeline that measures in the image only is
    ///   granted the true attitude.
    ///
    /// `None` when that has no finite direction: the line of sight is not a number, or no direction has its image
    /// at that position.
    pub fn of(
        measurement: &Measurement,
        truth: &FrameTruth,
        unproject: &dyn Fn(PixelPoint) -> Option<Direction<CameraFrame>>,
    ) -> Option<Self> {
        let camera_from_icrs = &truth.camera_from_icrs;
        let measured = match &measurement.line_of_sight {
            Some(line_of_sight) => camera_from_icrs.rotate(line_of_sight.vector()),
            None => *unproject(measurement.position)?.vector(),
        };
        Self::between(&measured, &camera_from_icrs.rotate(truth.line_of_sight.vector()))
    }

    /// Measured minus true, for two vectors in the camera frame.
    fn between(measured: &Vector3<f64>, truth: &Vector3<f64>) -> Option<Self> {
        let error = Self {
            ra: difference(libm::atan2(measured.x, measured.z), libm::atan2(truth.x, truth.z)),
            dec: difference(libm::atan2(measured.y, measured.z), libm::atan2(truth.y, truth.z)),
        };
        (error.ra.radians().is_finite() && error.dec.radians().is_finite()).then_some(error)
    }
}

/// a − b, brought into [−π, π]: a target behind the camera lies near the cut of atan2.
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
    use crate::hand_made::{CENTRE, PIXEL, direction_at, frame, tilted, unproject};
    use contract::{Icrs, Rotation};

    fn measured(position: PixelPoint, line_of_sight: Option<Direction<Icrs>>) -> Measurement {
        Measurement { position, line_of_sight }
    }

    #[test]
    fn one_pixel_to_the_right_is_positive_in_ra_and_down_is_positive_in_dec() {
        let at = |x, y| {
            let point = PixelPoint::new(CENTRE.x + x, CENTRE.y + y);
            LineOfSightError::of(&measured(point, None), &frame(0), &unproject).unwrap()
        };
        let (right, down) = (at(1.0, 0.0), at(0.0, 1.0));
        assert!((right.ra.radians() - libm::atan(PIXEL)).abs() < 1e-12 && right.dec.radians().abs() < 1e-12);
        assert!((down.dec.radians() - libm::atan(PIXEL)).abs() < 1e-12 && down.ra.radians().abs() < 1e-12);
    }

    #[test]
    fn the_true_line_of_sight_has_no_error_whatever_the_attitude() {
        for truth in [frame(0), tilted(0)] {
            let error =
                LineOfSightError::of(&measured(CENTRE, Some(truth.line_of_sight)), &truth, &unproject)
                    .unwrap();
            assert!(error.ra.radians().abs() < 1e-12 && error.dec.radians().abs() < 1e-12, "{error:?}");
        }
    }

    /// A pipeline that knows the pixel exactly and turns it to the sky with a wrong attitude.
    #[test]
    fn an_error_of_the_attitude_counts_in_the_line_of_sight_and_not_in_the_pixel() {
        let truth = tilted(0);
        let roll = Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(Vector3::new(0.0, 0.001, 0.0));
        let wrong_attitude = roll * truth.camera_from_icrs;
        let line_of_sight = wrong_attitude.inverse() * direction_at(CENTRE);
        let of = |m: &Measurement| LineOfSightError::of(m, &truth, &unproject).unwrap();
        assert!((of(&measured(CENTRE, Some(line_of_sight))).ra.radians() + 0.001).abs() < 1e-9);
        assert!(of(&measured(CENTRE, None)).ra.radians().abs() < 1e-12);
    }

    #[test]
    fn saboteur_a_transposed_attitude_is_no_small_error() {
        let truth = tilted(0);
        let transposed: Rotation<Icrs, CameraFrame> =
            Rotation::from_unit_quaternion(*truth.camera_from_icrs.quaternion());
        let line_of_sight = transposed * direction_at(CENTRE);
        let error = LineOfSightError::of(&measured(CENTRE, Some(line_of_sight)), &truth, &unproject).unwrap();
        assert!(error.ra.abs() > TWO_PIXELS || error.dec.abs() > TWO_PIXELS, "{error:?}");
    }

    #[test]
    fn angles_across_the_cut_differ_by_little() {
        let behind = |x: f64| Vector3::new(x, 0.0, -1.0);
        let ra = |measured, truth| LineOfSightError::between(&measured, &truth).unwrap().ra.radians();
        // Seen from the camera's back, what lies to the right has the smaller angle.
        assert!((ra(behind(1e-6), behind(-1e-6)) + 2e-6).abs() < 1e-12);
        assert!((ra(behind(-1e-6), behind(1e-6)) - 2e-6).abs() < 1e-12);
        assert_eq!(ra(behind(0.0), Vector3::z()), std::f64::consts::PI);
        assert_eq!(ra(Vector3::z(), behind(0.0)), -std::f64::consts::PI);
    }

    #[test]
    fn one_angle_that_is_no_number_is_no_error_at_all() {
        for measured in [Vector3::new(f64::NAN, 0.0, 1.0), Vector3::new(0.0, f64::NAN, 1.0)] {
            assert_eq!(LineOfSightError::between(&measured, &Vector3::z()), None);
        }
    }

    #[test]
    fn a_place_without_a_direction_has_no_error() {
        assert_eq!(LineOfSightError::of(&measured(CENTRE, None), &frame(0), &|_| None), None);
    }
}
