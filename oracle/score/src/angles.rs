//! The error of a line of sight, as two angles in the camera system.

use contract::{Angle, Camera, CameraFrame, Covariance2, Direction, Icrs, Measurement, PixelPoint, Rotation};
use nalgebra::Vector3;
use sim::truth::FrameTruth;

use crate::covariance::normalised_error::NormalisedError;

/// What "within one pixel" and "within two" mean: an error counts as within a limit when it is strictly smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithinLimits {
    /// Across columns ("RA"): of one pixel and of two, degrees.
    pub ra_deg: [f64; 2],
    /// Across rows ("Dec"): of one pixel and of two, degrees.
    pub dec_deg: [f64; 2],
}

impl WithinLimits {
    /// One and two pixels of a camera at its principal point, without distortion, each axis by its own scale.
    pub fn from_pixels(camera: &Camera) -> Self {
        let (across_columns, across_rows) = camera.focal_length_px();
        let of = |focal_length_px: f64| {
            [1.0, 2.0].map(|px: f64| Angle::from_radians(libm::atan(px / focal_length_px)).degrees())
        };
        Self { ra_deg: of(across_columns), dec_deg: of(across_rows) }
    }

    /// The same two angles for both axes, degrees.
    pub fn from_degrees(limits: [f64; 2]) -> Self {
        Self { ra_deg: limits, dec_deg: limits }
    }
}

/// The attitude that turns a measured line of sight into the camera, or a centroid into a line of sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum AttitudeUsed {
    /// The pipeline's own: it gives a line of sight.
    Own,
    /// The measured one of telemetry, with the nominal mounting, granted to a centroid.
    Telemetry,
    /// The true one, granted to a centroid.
    True,
}

impl AttitudeUsed {
    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Telemetry => "telemetry",
            Self::True => "true",
        }
    }
}

/// What attitude the lines of sight of a run rest on, in a word: `own`, `telemetry`, `true`; `own and …` where answers differ, `none`
/// where none of them has a line of sight. `own` and `centroids`: whether there are detections with a line of sight of their own, and with
/// a centroid alone; `granted` is what the latter are given. `None` of nothing detected.
pub fn attitude_word(own: bool, centroids: bool, granted: Option<&str>) -> Option<String> {
    let own_code = own.then_some(AttitudeUsed::Own.code());
    let words: Vec<&str> = own_code.into_iter().chain(granted.filter(|_| centroids)).collect();
    match (words.is_empty(), centroids) {
        (true, false) => None,
        (true, true) => Some("none".to_owned()),
        _ => Some(words.join(" and ")),
    }
}

/// What a reader of figures of RA and Dec must know of an [`attitude_word`]; nothing where lines of sight are the pipeline's own.
pub fn attitude_note(word: Option<&str>) -> Option<String> {
    match word? {
        "own" => None,
        "none" => {
            Some("No answer has a line of sight: RA and Dec have no figures (docs/score.md).".to_owned())
        }
        word => Some(format!(
            "RA and Dec are by the attitude `{word}`, not all the pipeline's own (docs/score.md)."
        )),
    }
}

/// The attitude that the score grants to answers that have a centroid alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GrantedAttitude {
    /// None: they have no line of sight.
    #[default]
    None,
    /// The measured one: the camera's, from telemetry and the nominal mounting.
    Telemetry(Rotation<CameraFrame, Icrs>),
    /// The true one.
    True,
}

/// Errors of an answer, measured minus true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnswerError {
    /// Of its centroid from the centre of the target's light, px across columns and rows; of a target without light in the image, from
    /// where its line of sight meets the image. `None` behind the camera.
    pub centroid_px: Option<[f64; 2]>,
    /// Of its line of sight; `None` when it has none and no attitude is granted.
    pub line_of_sight: Option<LineOfSightError>,
    /// That of the centroid in units of its covariance; `None` where the answer states none.
    pub centroid_normalised: Option<NormalisedError>,
    /// That of a line of sight of its own in units of its covariance; `None` where the answer states none.
    pub line_of_sight_normalised: Option<NormalisedError>,
}

impl AnswerError {
    /// The errors of a measurement, in units of the covariances that it states too.
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
/// The paper calls them right ascension and declination, but takes them in the camera system, where the angles of
/// its Eq. 3 would be singular at the boresight. They are atan2(X, Z) and atan2(Y, Z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSightError {
    /// Across columns ("RA"): positive when the measured target lies to the right of the true one.
    pub ra: Angle,
    /// Across rows ("Dec"): positive when the measured target lies below the true one.
    pub dec: Angle,
    /// The attitude that it rests on.
    pub attitude: AttitudeUsed,
}

impl LineOfSightError {
    /// The error of a measurement.
    ///
    /// The measured direction in the true camera frame is
    /// - true camera_from_icrs · line of sight, when the pipeline gives a line of sight, so that an error of its
    ///   attitude counts;
    /// - true camera_from_icrs · measured camera_from_icrs⁻¹ · `unproject(position)` when the attitude of telemetry is granted to a
    ///   measurement in the image only;
    /// - `unproject(position)` with the true camera when the true attitude is.
    ///
    /// `None` when there is no such direction, or no finite one: no line of sight and no attitude granted, a line of sight that is not a
    /// number, or no direction that has its image at that position.
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

    /// Measured minus true, for two vectors in the camera frame.
    fn between(measured: &Vector3<f64>, truth: &Vector3<f64>, attitude: AttitudeUsed) -> Option<Self> {
        let error = Self {
            ra: difference(libm::atan2(measured.x, measured.z), libm::atan2(truth.x, truth.z)),
            dec: difference(libm::atan2(measured.y, measured.z), libm::atan2(truth.y, truth.z)),
            attitude,
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
    use crate::hand_made::{CENTRE, PIXEL, camera, direction_at, frame, tilted, unproject};

    fn measured(position: PixelPoint, line_of_sight: Option<Direction<Icrs>>) -> Measurement {
        Measurement::new(position, line_of_sight)
    }

    /// The error of a line of sight of the pipeline's own.
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
    fn the_true_line_of_sight_has_no_error_whatever_the_attitude() {
        for truth in [frame(0), tilted(0)] {
            let error = own(truth.line_of_sight, &truth);
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
        assert!((own(line_of_sight, &truth).ra.radians() + 0.001).abs() < 1e-9);
        let of = |granted| {
            LineOfSightError::from_measurement(&measured(CENTRE, None), &truth, &unproject, granted)
        };
        let granted = of(GrantedAttitude::True).unwrap();
        assert!(granted.ra.radians().abs() < 1e-12);
        assert_eq!(granted.attitude, AttitudeUsed::True);
        // The measured attitude of telemetry counts like one of the pipeline's own.
        let granted = of(GrantedAttitude::Telemetry(wrong_attitude)).unwrap();
        assert!((granted.ra.radians() + 0.001).abs() < 1e-9);
        assert_eq!(granted.attitude, AttitudeUsed::Telemetry);
        // A line of sight of its own is what the pipeline says, whatever is granted to others.
        let error = LineOfSightError::from_measurement(
            &measured(CENTRE, Some(line_of_sight)),
            &truth,
            &unproject,
            GrantedAttitude::True,
        );
        assert_eq!(error, Some(own(line_of_sight, &truth)));
    }

    /// What it had been given silently, the true attitude, leaves nothing of an error but the image's.
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
        // 8.6 and 8.3 µm at 20.187 mm: the paper's 0.024° are 0.983 px across columns and 1.019 px across rows.
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
    fn the_attitude_of_a_run_is_reported_in_a_word() {
        for (own, centroids, granted, word) in [
            (true, false, Some("true"), Some("own")),
            (true, false, None, Some("own")),
            (false, true, Some("telemetry"), Some("telemetry")),
            (false, true, None, Some("none")),
            (true, true, Some("true"), Some("own and true")),
            (true, true, None, Some("own")),
            (false, false, Some("true"), None),
        ] {
            assert_eq!(attitude_word(own, centroids, granted).as_deref(), word);
            let note = attitude_note(word);
            assert_eq!(note.is_none(), matches!(word, None | Some("own")));
            assert!(note.is_none_or(|note| word == Some("none") || note.contains(&format!("`{}`", word.unwrap()))));
        }
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
        // Seen from the camera's back, what lies to the right has the smaller angle.
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
