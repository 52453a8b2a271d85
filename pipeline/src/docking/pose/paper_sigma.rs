//! Uncertainty of the paper's pose of a single field. Replaces the best estimator's covariance where that
//! estimator fails.

use contract::docking::{NoPose, PoseEstimate};
use nalgebra::{Matrix6, Vector6};

use super::geometry::to_vector;
use super::paper_pose::{PaperMeasurement, PaperTarget};

/// Standard deviation of cross, circle and radius, px, in a field on which the best estimator failed because
/// some of its marks or lines are disturbed.
const FEATURE_SIGMA_PX: f64 = 0.4;

/// Returns the paper's pose (3.1), aimed at the cross, with a covariance. The covariance includes noise of
/// the features, propagated by the formulas' derivatives, and the size of the effects that the formulas
/// neglect, treated as a standard deviation.
///
/// Neglected are the circle's centre under tilt, f tan(tilt) (r/d3)²; the roll that turns the parallax of
/// cross and circle; and products of lateral angle and attitude in the range. The neglected displacement
/// common to cross and circle, 4 px of a narrow lens at 3° of roll and tilt, is not included, because the
/// pose is rotated until the cross is at its measured position.
///
/// # Errors
/// Those of [`PaperMeasurement::pose`].
pub(crate) fn estimate(
    measurement: &PaperMeasurement,
    target: &PaperTarget,
    half_length_px: f64,
) -> Result<PoseEstimate, NoPose> {
    let pose = measurement.aimed_pose(target)?;
    let (d, phi) = (&pose.position_m, &pose.phi_rad);
    let lateral = libm::hypot(d.x, d.y) / d.z;
    let attitude = libm::hypot(phi.x, phi.y);
    let tilt = lateral + attitude;
    let flatness = target.radius_m / d.z;
    let bias_px = measurement.focal_px * tilt * flatness * flatness;
    let parallax_px = measurement.focal_px * lateral * target.height_m / d.z;
    let circle_px = libm::hypot(FEATURE_SIGMA_PX, bias_px + parallax_px * phi.z.abs());
    let sigma = Vector6::new(
        FEATURE_SIGMA_PX,
        FEATURE_SIGMA_PX,
        FEATURE_SIGMA_PX / half_length_px + lateral * attitude,
        circle_px,
        circle_px,
        FEATURE_SIGMA_PX + measurement.radius_px * (2.0 * lateral * attitude + tilt * tilt),
    );
    let mut spread = Matrix6::zeros();
    for i in 0..6 {
        let by = [sigma[i], -sigma[i]].map(|by| perturbed(measurement, i, by).aimed_pose(target));
        let column = match by {
            [Ok(up), Ok(down)] => (to_vector(&up) - to_vector(&down)) / 2.0,
            [Ok(one), Err(_)] | [Err(_), Ok(one)] => to_vector(&one) - to_vector(&pose),
            [Err(why), Err(_)] => return Err(why),
        };
        spread.set_column(i, &column);
    }
    Ok(PoseEstimate { pose, covariance: spread * spread.transpose() })
}

/// Returns the measurement with one of Xc, Yc, a, Xo, Yo, R changed.
fn perturbed(measurement: &PaperMeasurement, i: usize, by: f64) -> PaperMeasurement {
    let mut moved = *measurement;
    match i {
        0 => moved.cross[0] += by,
        1 => moved.cross[1] += by,
        2 => moved.slope += by,
        3 => moved.circle[0] += by,
        4 => moved.circle[1] += by,
        _ => moved.radius_px += by,
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::docking::Pose;
    use nalgebra::Vector3;

    const TARGET: PaperTarget = PaperTarget { radius_m: 0.25, height_m: 0.30 };

    fn at(d: [f64; 3]) -> PoseEstimate {
        let pose = Pose { position_m: d.into(), phi_rad: Vector3::zeros() };
        estimate(&PaperMeasurement::expected(&pose, &TARGET, 1000.0), &TARGET, 30.0).unwrap()
    }

    #[test]
    fn on_the_axis_the_covariance_is_that_of_the_formulas() {
        let estimate = at([0.0, 0.0, 5.0]);
        let sigma = estimate.covariance.diagonal().map(f64::sqrt);
        // d3 = f r/R: σ = d3 σ_R/R; d1 = (Xo − Xc) d3 (d3 − b)/(f b): σ = √2 σ_px times that factor. The
        // formulas are not linear in R: 0.8 % steps.
        assert!((sigma[2] / (5.0 * 0.4 / 50.0) - 1.0).abs() < 1e-3, "{sigma}");
        let lateral = std::f64::consts::SQRT_2 * 0.4 * 5.0 * 4.7 / (1000.0 * 0.3);
        assert!((sigma[0] / lateral - 1.0).abs() < 1e-3, "{sigma}");
        assert!((sigma[5] - 0.4 / 30.0).abs() < 1e-12, "{sigma}");
    }

    #[test]
    fn off_the_axis_the_neglected_terms_are_reported() {
        let (near, off) = (at([0.0, 0.0, 2.0]), at([0.3, 0.0, 2.0]));
        // f tan(tilt) (r/d3)² = 1000 · 0.15 · 0.0156 = 2.3 px against 0.4 px of noise.
        assert!(off.covariance[(0, 0)] > 4.0 * near.covariance[(0, 0)]);
        assert!(off.covariance[(2, 2)] > 4.0 * near.covariance[(2, 2)]);
    }

    #[test]
    fn the_error_of_the_formulas_is_within_the_covariance_as_a_whole() {
        use crate::docking::pose::geometry::target_from_camera;
        let focal_px = 2917.0;
        let mut worst = 0.0f64;
        for corner in 0..32_u32 {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { 1.0 } else { -1.0 };
            // Offset 3 % of 18 m, angles of 3°.
            let truth = Pose {
                position_m: Vector3::new(0.54 * sign(0), 0.54 * sign(1), 18.0),
                phi_rad: Vector3::new(sign(2), sign(3), sign(4)) * 3f64.to_radians(),
            };
            let rotation = target_from_camera(&truth.phi_rad).transpose();
            let see = |y1: f64, y3: f64| {
                let x = rotation * (Vector3::new(y1, 0.0, y3) - truth.position_m);
                [focal_px * x.x / x.z, focal_px * x.y / x.z]
            };
            let (left, right) = (see(-0.15, 0.30), see(0.15, 0.30));
            let seen = PaperMeasurement {
                focal_px,
                cross: see(0.0, 0.30),
                slope: (right[1] - left[1]) / (right[0] - left[0]),
                circle: see(0.0, 0.0),
                radius_px: focal_px * 0.25 / 18.0,
            };
            let estimated = estimate(&seen, &TARGET, 24.0).unwrap();
            let error = to_vector(&estimated.pose) - to_vector(&truth);
            worst = worst.max(error.dot(&(estimated.covariance.try_inverse().unwrap() * error)) / 6.0);
        }
        // Error of the formulas only, without errors of the features: less than the standard deviation.
        assert!(worst < 1.0, "{worst}");
    }

    #[test]
    fn numbers_that_make_no_pose_are_refused() {
        let pose = Pose { position_m: Vector3::new(0.0, 0.0, 5.0), phi_rad: Vector3::zeros() };
        let measurement =
            PaperMeasurement { radius_px: f64::NAN, ..PaperMeasurement::expected(&pose, &TARGET, 1000.0) };
        assert!(estimate(&measurement, &TARGET, 30.0).is_err());
    }
}
