//! Motion reported at the end of a portion, compared with the truth at the time that it refers to.

use contract::docking::Motion;
use nalgebra::{Matrix6, Vector6};

use super::approach_parameters::ApproachParameters;
use super::consistency::{nees, within_3_sigma};
use super::errors::{PoseErrors, phi_error};
use super::imaging_geometry::ImagingGeometry;
use super::truth::TrueField;
use super::verdict::gross;

/// Largest time difference between a motion and the field that reports it, s; beyond it the motion counts as
/// wrong.
const MAX_AGE_S: f64 = 1.0;

/// Verdict on one estimator's motion at the end of a portion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MotionVerdict {
    /// True if the estimator has reported an earlier motion; the first of a sequence has no prior.
    pub(super) is_led: bool,
    /// True if the pose is grossly wrong, by the criteria for fields.
    pub(super) is_wrong: bool,
    /// Errors, measured minus true: ρ (m), u (m/s), α, β, φ1, φ2, φ3 (rad).
    pub(super) errors: [f64; 7],
    /// True for each error within three of its standard deviations.
    pub(super) within: [Option<bool>; 7],
    /// NEES over its dimension: of (d, φ), of (d, d'), of (φ, φ').
    pub(super) nees: [Option<f64>; 3],
}

impl MotionVerdict {
    pub(super) fn from_motion(
        geometry: &ImagingGeometry,
        truth: &TrueField,
        motion: &Motion,
        is_led: bool,
    ) -> Self {
        // The last fields of a portion may be without measurement: its motion then refers to an earlier time
        // than the field that reports it. Over a few fields the true rates extrapolate the truth to
        // micrometres.
        let since_s = motion.time_s - truth.time_s;
        let moved = TrueField { pose: truth.moved(since_s), ..truth.clone() };
        // Times in files are rounded: times closer than a microsecond are equal.
        let truth = if since_s.abs() < 1e-6 { truth } else { &moved };
        let shown = ApproachParameters::from_motion(&motion.pose, &motion.velocity_m_s);
        let errors = shown.difference(&ApproachParameters::from_motion(&truth.pose, &truth.velocity_m_s));
        let sigmas = ApproachParameters::sigmas(motion);
        let within = std::array::from_fn(|i| sigmas.and_then(|sigmas| within_3_sigma(errors[i], sigmas[i])));
        let d = motion.pose.position_m - truth.pose.position_m;
        let phi = phi_error(&motion.pose, &truth.pose);
        let d_rate = motion.velocity_m_s - truth.velocity_m_s;
        let phi_rate = motion.phi_rate_rad_s - truth.phi_rate_rad_s;
        let both =
            |a: nalgebra::Vector3<f64>, b: nalgebra::Vector3<f64>| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
        Self {
            is_led,
            is_wrong: since_s.abs() > MAX_AGE_S
                || gross(geometry, truth, &PoseErrors::new(&motion.pose, &truth.pose)).is_some(),
            errors: errors.into(),
            within,
            nees: [
                nees(&both(d, phi), &pose_covariance(motion)),
                nees(&both(d, d_rate), &motion.position_covariance),
                nees(&both(phi, phi_rate), &motion.attitude_covariance),
            ],
        }
    }
}

/// Returns the covariance of (d, φ) of a motion.
fn pose_covariance(motion: &Motion) -> Matrix6<f64> {
    let mut covariance = Matrix6::zeros();
    covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&motion.position_covariance.fixed_view::<3, 3>(0, 0));
    covariance.fixed_view_mut::<3, 3>(3, 3).copy_from(&motion.attitude_covariance.fixed_view::<3, 3>(0, 0));
    covariance.fixed_view_mut::<3, 3>(0, 3).copy_from(&motion.cross_covariance);
    covariance.fixed_view_mut::<3, 3>(3, 0).copy_from(&motion.cross_covariance.transpose());
    covariance
}

/// Verdict on the report at the end of a portion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PortionVerdict {
    /// Motion from the pipeline's best estimator, if reported.
    pub(super) best: Option<MotionVerdict>,
    /// Motion from the paper's formulas, if reported.
    pub(super) paper: Option<MotionVerdict>,
    /// Number of fields from the portion's first measured one to the report, including both.
    pub(super) fields: u64,
}

#[cfg(test)]
mod tests {
    use contract::docking::Pose;
    use nalgebra::{Matrix3, Vector3};

    use super::*;
    use crate::scoring::hand_made::{field, setup};

    /// A motion reported for a time 0.1 s earlier, when the camera was 20 mm farther away, is equally
    /// correct.
    #[test]
    fn a_motion_is_compared_with_the_truth_at_its_time() {
        let truth = TrueField {
            time_s: 5.0,
            velocity_m_s: Vector3::new(0.0, 0.0, -0.2),
            phi_rate_rad_s: Vector3::new(0.0, 0.0, 0.03),
            ..field(0, 10.0)
        };
        let geometry = ImagingGeometry::new(&setup());
        let motion = |time_s: f64, d3_m: f64| Motion {
            time_s,
            pose: Pose {
                position_m: Vector3::new(0.0, 0.0, d3_m),
                phi_rad: truth.pose.phi_rad + truth.phi_rate_rad_s * (time_s - 5.0),
            },
            velocity_m_s: truth.velocity_m_s,
            phi_rate_rad_s: truth.phi_rate_rad_s,
            position_covariance: Matrix6::from_diagonal_element(1e-4),
            attitude_covariance: Matrix6::from_diagonal_element(1e-6),
            cross_covariance: Matrix3::zeros(),
            fields: 10,
        };
        let verdict = MotionVerdict::from_motion(&geometry, &truth, &motion(4.9, 10.02), false);
        assert!(!verdict.is_wrong && verdict.errors.iter().all(|error| error.abs() < 1e-12), "{verdict:?}");
        assert!(
            !MotionVerdict::from_motion(&geometry, &truth, &motion(4.0, 10.2), false).is_wrong,
            "a second old"
        );
        assert!(
            MotionVerdict::from_motion(&geometry, &truth, &motion(3.9, 10.22), false).is_wrong,
            "too old"
        );
        // A tenth of a microsecond is the rounding of a file and has no effect.
        let rounded = MotionVerdict::from_motion(&geometry, &truth, &motion(5.0 + 1e-7, 10.0), false);
        assert_eq!(rounded.errors[..6], [0.0; 6]);
    }

    #[test]
    fn errors_and_their_normalised_squares_are_those_of_a_sum_by_hand() {
        let mut truth = TrueField { phi_rate_rad_s: Vector3::new(0.0, 0.0, 0.010), ..field(0, 10.0) };
        truth.pose.phi_rad.y = 0.002;
        let geometry = ImagingGeometry::new(&setup());
        let motion = Motion {
            time_s: 0.0,
            pose: Pose {
                position_m: Vector3::new(0.0, 0.0, 10.02),
                phi_rad: Vector3::new(0.001, 0.002, -0.002),
            },
            velocity_m_s: Vector3::new(0.0, 0.0, -0.21),
            phi_rate_rad_s: Vector3::new(0.0, 0.0, 0.012),
            position_covariance: Matrix6::from_diagonal_element(1e-4),
            attitude_covariance: Matrix6::from_diagonal_element(1e-6),
            cross_covariance: Matrix3::zeros(),
            fields: 10,
        };
        let verdict = MotionVerdict::from_motion(&geometry, &truth, &motion, false);
        assert!(!verdict.is_wrong);
        let expected = [0.02, -0.01, 0.0, 0.0, 0.001, 0.0, -0.002];
        for (error, expected) in verdict.errors.iter().zip(expected) {
            assert!((error - expected).abs() < 1e-12, "{:?}", verdict.errors);
        }
        // Errors of d: 2σ, of its rate: 1σ; of φ: 1σ and 2σ, of its rate: 2σ.
        assert_eq!(verdict.within, [Some(true); 7]);
        for (met, expected) in verdict.nees.iter().zip([(4.0 + 1.0 + 4.0) / 6.0, 5.0 / 6.0, 9.0 / 6.0]) {
            assert!((met.unwrap() - expected).abs() < 1e-9, "{:?}", verdict.nees);
        }
    }
}
