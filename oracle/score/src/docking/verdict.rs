//! What became of a field: one verdict each.

use contract::docking::{DockingOutcome, DockingSolution, FailedCheck, NoPose, Pose};

use super::cause::MissCause;
use super::errors::PoseErrors;
use super::imaging_geometry::ImagingGeometry;
use super::truth::TrueField;

/// In what a pose is grossly wrong: not measured badly, but of something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GrossError {
    /// ρ is off by more than [`Limits::RANGE`].
    Range,
    /// The target is said to be where it is not.
    Direction,
    /// φ3 is off by more than [`Limits::ANGLE_RAD`].
    Roll,
    /// The disk's normal is off by more than the image allows.
    Tilt,
    /// A range from the outline is off by more than [`Limits::OUTLINE`].
    Outline,
}

impl GrossError {
    /// Every one, in the order in which they are looked for.
    pub const ALL: [Self; 5] = [Self::Range, Self::Direction, Self::Roll, Self::Tilt, Self::Outline];

    /// The word used in files.
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

/// How far a pose may be off before it is wrong, at a true pose and with a lens.
///
/// The limits are those of mistaking one thing for another (a block of the docking ring for the cross, the plate's shadow
/// for its edge, a target turned by a mark) and lie many standard deviations from a sound measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Of ρ, m.
    pub range_m: f64,
    /// Of the direction of the target's origin, rad: half of the marks' circle as seen from here.
    pub direction_rad: f64,
    /// Of the disk's normal, rad: [`Limits::ANGLE_RAD`], or the tilt that moves the cross over the disk by one pixel,
    /// ρ/(f b), where that is more: an image does not show less.
    pub tilt_rad: f64,
}

impl Limits {
    /// Of ρ, as a fraction of it.
    pub const RANGE: f64 = 0.05;
    /// Of ρ from the outline of the station, as a fraction of it: its dimensions are assumed, its edges are many.
    pub const OUTLINE: f64 = 0.2;
    /// Of roll and tilt, rad: 5°.
    pub const ANGLE_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

    /// Of a true pose; `None` for a camera that is not there.
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

    /// In what a pose of these errors is grossly wrong, if it is.
    pub(super) fn gross(&self, errors: &PoseErrors) -> Option<GrossError> {
        // Negated, so that a NaN is gross.
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

/// An angle brought to −π to π.
fn turn(angle_rad: f64) -> f64 {
    libm::remainder(angle_rad, 2.0 * std::f64::consts::PI)
}

/// What became of a field.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// All six parameters, none grossly wrong.
    Success {
        /// How far they are off.
        errors: PoseErrors,
    },
    /// The range alone, not grossly wrong.
    RangeOnly {
        /// Measured minus true d3, m.
        error_m: f64,
        /// The standard deviation told, m.
        sigma_m: f64,
    },
    /// A pose that the pipeline itself doubts, right or wrong.
    Doubtful {
        /// The test that it failed.
        doubt: FailedCheck,
        /// In what it is grossly wrong, if it is.
        gross: Option<GrossError>,
    },
    /// An answer that is grossly wrong.
    Wrong {
        /// In what.
        gross: GrossError,
    },
    /// No answer.
    Missed {
        /// Why.
        cause: MissCause,
    },
}

impl Verdict {
    /// Judges an answer; `None`: there is none.
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

/// In what a pose is grossly wrong. Of a camera that the setup does not have nothing can be said, and nothing is.
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
    use crate::docking::hand_made::{ahead, doubtful_outcome, field, measured_outcome, range_only, setup};

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
    fn an_upside_down_target_is_wrong_and_a_whole_turn_is_none() {
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = 0.09), Some(GrossError::Roll));
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = std::f64::consts::PI), Some(GrossError::Roll));
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.z = 0.08), None);
    }

    /// Half of the circle's radius of 0.25 m at 10 m is 12.5 mrad.
    #[test]
    fn a_position_beyond_half_the_circle_is_of_something_else() {
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.x = 0.0124), None);
        assert_eq!(gross_of(10.0, |pose| pose.phi_rad.x = 0.0126), Some(GrossError::Direction));
    }

    /// With the target where it was: at 10 m the limit is 5°, at 100 m one pixel of parallax, 100/(2917 × 0.3) = 6.55°.
    #[test]
    fn a_tilt_is_wrong_beyond_what_the_image_shows() {
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

    /// A doubtful pose is neither success nor wrong, and its error is looked at all the same.
    #[test]
    fn a_doubtful_pose_is_doubtful_whatever_its_error() {
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
