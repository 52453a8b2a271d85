//! Verdict on one field: every field gets exactly one.

use contract::docking::{DockingOutcome, DockingSolution, FailedCheck, NoPose, Pose};

use super::cause::MissCause;
use super::errors::PoseErrors;
use super::imaging_geometry::ImagingGeometry;
use super::truth::TrueField;

/// Kind of a gross pose error, which means that another object was measured, rather than the target
/// inaccurately.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GrossError {
    /// The error of ρ exceeds [`Limits::RANGE`].
    Range,
    /// The error of the target's direction exceeds [`Limits::direction_rad`].
    Direction,
    /// The error of φ3 exceeds [`Limits::ANGLE_RAD`].
    Roll,
    /// The error of the disk's normal exceeds [`Limits::tilt_rad`], which depends on the resolution of the
    /// image.
    Tilt,
    /// The error of a range from the station's outline exceeds [`Limits::OUTLINE`].
    Outline,
}

impl GrossError {
    /// All kinds, in the order in which they are tested.
    pub const ALL: [Self; 5] = [Self::Range, Self::Direction, Self::Roll, Self::Tilt, Self::Outline];

    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Range => "range",
            Self::Direction => "place",
            Self::Roll => "roll",
            Self::Tilt => "tilt",
            Self::Outline => "outline",
        }
    }
}

/// Largest pose errors that do not count as gross, for a true pose and a lens.
///
/// The limits correspond to mistaking one object for another (a block of the docking ring for the cross, the
/// plate's shadow for its edge, a target rotated by one mark) and exceed the errors of a sound measurement by
/// many standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Limit of the error of ρ, m.
    pub range_m: f64,
    /// Limit of the error in the direction of the target's origin, rad: half the radius of the circle of
    /// marks as seen from the true position.
    pub direction_rad: f64,
    /// Limit of the error of the disk's normal, rad: the larger of [`Limits::ANGLE_RAD`] and the tilt that
    /// moves the cross over the disk by one pixel, ρ/(f b), since an image shows no smaller tilt.
    pub tilt_rad: f64,
}

impl Limits {
    /// Limit of the error of ρ, as a fraction of ρ.
    pub const RANGE: f64 = 0.05;
    /// Limit of the error of a range from the station's outline, as a fraction of ρ: the dimensions of the
    /// station are assumed, and it has many edges.
    pub const OUTLINE: f64 = 0.2;
    /// Limit of the errors of roll and tilt, rad: 5°.
    pub const ANGLE_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

    /// Returns the limits at a true pose; `None` for a camera that the setup does not have.
    pub(super) fn for_pose(geometry: &ImagingGeometry, camera: usize, truth: &Pose) -> Option<Self> {
        let rho = truth.position_m.norm();
        let target = geometry.target();
        let pixel_rad = rho / (geometry.focal_px(camera)? * target.cross.height_m);
        Some(Self {
            range_m: Self::RANGE * rho,
            direction_rad: libm::atan2(0.5 * target.mark_circle_radius_m, rho),
            tilt_rad: Self::ANGLE_RAD.max(if pixel_rad.is_finite() { pixel_rad } else { 0.0 }),
        })
    }

    /// Returns the first gross error among these pose errors, if any.
    pub(super) fn gross(&self, errors: &PoseErrors) -> Option<GrossError> {
        // Tests for "within the limit" and negates the result, which makes a NaN gross.
        let within = |error: f64, limit: f64| error.abs() <= limit;
        let held = [
            (GrossError::Range, within(errors.range_m, self.range_m)),
            (GrossError::Direction, within(errors.direction_rad, self.direction_rad)),
            (GrossError::Roll, within(turn(errors.phi_rad.z), Self::ANGLE_RAD)),
            (GrossError::Tilt, within(errors.tilt_rad, self.tilt_rad)),
        ];
        held.into_iter().find_map(|(gross, holds)| (!holds).then_some(gross))
    }
}

/// Reduces an angle to the range from −π to π.
fn turn(angle_rad: f64) -> f64 {
    libm::remainder(angle_rad, 2.0 * std::f64::consts::PI)
}

/// Verdict on one field.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// All six parameters were measured, and none of them is grossly wrong.
    Success {
        /// Errors of the measured pose.
        errors: PoseErrors,
    },
    /// Only the range was measured, and it is not grossly wrong.
    RangeOnly {
        /// Measured minus true d3, m.
        error_m: f64,
        /// Stated standard deviation, m.
        sigma_m: f64,
    },
    /// A pose that failed a test of the pipeline, whether correct or wrong.
    Doubtful {
        /// Test that the pose failed.
        doubt: FailedCheck,
        /// Gross error of the pose, if any.
        gross: Option<GrossError>,
    },
    /// A measurement that is grossly wrong.
    Wrong {
        /// Kind of the gross error.
        gross: GrossError,
    },
    /// No measurement.
    Missed {
        /// Cause of the miss.
        cause: MissCause,
    },
}

impl Verdict {
    /// Classifies an outcome; `None` stands for a field without an outcome.
    pub(super) fn from_outcome(
        geometry: &ImagingGeometry,
        truth: &TrueField,
        outcome: Option<&DockingOutcome>,
    ) -> Self {
        match outcome.map(|outcome| &outcome.solution) {
            Some(DockingSolution::Measured(measurement)) => {
                let errors = PoseErrors::new(&measurement.best.pose, &truth.pose);
                match gross(geometry, truth, &errors) {
                    Some(gross) => Self::Wrong { gross },
                    None => Self::Success { errors },
                }
            }
            Some(DockingSolution::Doubtful { measurement, doubt }) => {
                let errors = PoseErrors::new(&measurement.best.pose, &truth.pose);
                Self::Doubtful { doubt: *doubt, gross: gross(geometry, truth, &errors) }
            }
            Some(DockingSolution::RangeOnly { range_m, sigma_m }) => {
                let error_m = range_m - truth.pose.position_m.z;
                if error_m.abs() <= Limits::OUTLINE * truth.pose.position_m.norm() {
                    Self::RangeOnly { error_m, sigma_m: *sigma_m }
                } else {
                    Self::Wrong { gross: GrossError::Outline }
                }
            }
            Some(DockingSolution::NoSolution(reason)) => Self::missed(geometry, truth, Some(reason)),
            None => Self::missed(geometry, truth, None),
        }
    }
}

impl Verdict {
    fn missed(geometry: &ImagingGeometry, truth: &TrueField, reason: Option<&NoPose>) -> Self {
        let is_resolved = geometry.resolves(truth.camera, &truth.pose);
        Self::Missed { cause: MissCause::from_truth(truth, is_resolved, reason) }
    }
}

/// Returns the gross error of a pose, if any; always `None` for a camera that the setup does not have, since
/// its limits are unknown.
pub(super) fn gross(
    geometry: &ImagingGeometry,
    truth: &TrueField,
    errors: &PoseErrors,
) -> Option<GrossError> {
    Limits::for_pose(geometry, truth.camera, &truth.pose).and_then(|limits| limits.gross(errors))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::scoring::hand_made::{ahead, doubtful_outcome, field, measured_outcome, range_only, setup};

    fn verdict(range_m: f64, outcome: &DockingOutcome) -> Verdict {
        Verdict::from_outcome(&ImagingGeometry::new(&setup()), &field(0, range_m), Some(outcome))
    }

    fn gross_of(range_m: f64, change: impl FnOnce(&mut Pose)) -> Option<GrossError> {
        let mut pose = ahead(range_m);
        change(&mut pose);
        match verdict(range_m, &measured_outcome(pose)) {
            Verdict::Wrong { gross } => Some(gross),
            Verdict::Success { .. } => None,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_range_is_wrong_beyond_five_percent() {
        assert_eq!(gross_of(10.0, |pose| pose.position_m.z = 10.49), None);
        assert_eq!(gross_of(10.0, |pose| pose.position_m.z = 10.51), Some(GrossError::Range));
        assert_eq!(gross_of(10.0, |pose| pose.position_m.z = 9.49), Some(GrossError::Range));
    }

    #[test]
    fn a_half_turn_is_wrong_and_a_whole_turn_is_no_error() {
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = 0.09), Some(GrossError::Roll));
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = std::f64::consts::PI), Some(GrossError::Roll));
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = 0.08), None);
    }

    /// Half of the circle's radius of 0.25 m, seen from 10 m, is 12.5 mrad.
    #[test]
    fn a_position_beyond_half_the_circle_is_of_something_else() {
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.x = 0.0124), None);
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.x = 0.0126), Some(GrossError::Direction));
    }

    /// The target's direction is kept: at 10 m the limit is 5°, at 100 m one pixel of parallax, 100/(2917 ×
    /// 0.3) = 6.55°.
    #[test]
    fn a_tilt_beyond_the_resolution_of_the_image_is_wrong() {
        let tilted = |range_m: f64, degrees: f64| {
            gross_of(range_m, |pose| {
                let turn = degrees.to_radians();
                pose.position_m = Vector3::new(libm::sin(turn), 0.0, libm::cos(turn)) * range_m;
                pose.phi_rad.y = -turn;
            })
        };
        assert_eq!((tilted(10.0, 4.9), tilted(10.0, 5.1)), (None, Some(GrossError::Tilt)));
        assert_eq!((tilted(100.0, 6.5), tilted(100.0, 6.6)), (None, Some(GrossError::Tilt)));
    }

    /// A doubtful pose is neither a success nor wrong, but its error is still tested for being gross.
    #[test]
    fn a_doubtful_pose_is_doubtful_regardless_of_its_error() {
        let at = |d3_m| verdict(10.0, &doubtful_outcome(ahead(d3_m), FailedCheck::Motion));
        assert_eq!(at(10.0), Verdict::Doubtful { doubt: FailedCheck::Motion, gross: None });
        assert_eq!(
            at(11.0),
            Verdict::Doubtful { doubt: FailedCheck::Motion, gross: Some(GrossError::Range) }
        );
    }

    #[test]
    fn a_range_alone_is_right_within_twenty_percent() {
        let at = |range_m| verdict(300.0, &range_only(range_m, 5.0));
        assert_eq!(at(310.0), Verdict::RangeOnly { error_m: 10.0, sigma_m: 5.0 });
        assert_eq!(at(361.0), Verdict::Wrong { gross: GrossError::Outline });
    }

    #[test]
    fn a_turn_is_brought_to_half_a_turn_either_way() {
        use std::f64::consts::TAU;
        for (angle, expected) in [(TAU + 0.1, 0.1), (0.1 - TAU, 0.1), (3.0, 3.0), (3.5, 3.5 - TAU)] {
            assert!((turn(angle) - expected).abs() < 1e-14, "{angle}");
        }
    }
}
