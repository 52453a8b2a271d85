//! Error of the telemetry's attitude and of the mounting: prior of each frame, and a filter over frames.
//!
//! The camera's attitude is R = M exp([e]×) T, with the nominal mounting M, the telemetry's attitude T and
//! the error e in axes of the body. e = c + s + w: a constant, a Gauss–Markov process of first order (Gelb
//! 1974, Applied Optimal Estimation, Eq. 3.8-14) and white noise. A Kalman filter estimates c and s from the
//! attitudes that stars give.

use contract::{AttitudeKnowledge, Body, CameraFrame, Icrs, Rotation};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Error of a frame's attitude, in axes of the camera, with its covariance, rad².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AttitudeError {
    pub(super) mean: Vector3<f64>,
    pub(super) covariance: Matrix3<f64>,
}

/// Prior knowledge without a calibration: a star tracker's white noise, a slow error of half an arc minute, a
/// mounting known to a tenth of a degree.
const UNKNOWN: AttitudeKnowledge = AttitudeKnowledge {
    white_arcsec: [60.0; 3],
    slow_arcsec: [30.0; 3],
    slow_period_s: 3000.0,
    constant_arcsec: [360.0; 3],
};

/// Smallest standard deviation of any part, arcsec. Keeps covariances invertible.
const MIN_SIGMA_ARCSEC: f64 = 0.1;

/// Filter of the constant and the slow error.
#[derive(Debug, Clone)]
pub(super) struct MountingFilter {
    nominal: Rotation<CameraFrame, Body>,
    white: Matrix3<f64>,
    slow_variance: Vector3<f64>,
    /// Correlation time of the slow error, s.
    memory_s: f64,
    state: Vector6<f64>,
    covariance: Matrix6<f64>,
    start: Matrix6<f64>,
}

impl MountingFilter {
    pub(super) fn new(nominal: Rotation<CameraFrame, Body>, knowledge: Option<AttitudeKnowledge>) -> Self {
        let knowledge = knowledge.unwrap_or(UNKNOWN);
        let variance = |arcsec: [f64; 3]| {
            Vector3::from(arcsec).map(|arcsec| {
                let rad = (arcsec.max(MIN_SIGMA_ARCSEC) / 3600.0).to_radians();
                rad * rad
            })
        };
        let (constant, slow) = (variance(knowledge.constant_arcsec), variance(knowledge.slow_arcsec));
        let start =
            Matrix6::from_diagonal(&Vector6::new(constant.x, constant.y, constant.z, slow.x, slow.y, slow.z));
        Self {
            nominal,
            white: Matrix3::from_diagonal(&variance(knowledge.white_arcsec)),
            slow_variance: slow,
            memory_s: knowledge.slow_period_s / std::f64::consts::TAU,
            state: Vector6::zeros(),
            covariance: start,
            start,
        }
    }

    /// Resets the filter to its state before all frames.
    pub(super) fn restart(&mut self) {
        self.state = Vector6::zeros();
        self.covariance = self.start;
    }

    /// Advances the filter by `elapsed_s`.
    pub(super) fn advance(&mut self, elapsed_s: f64) {
        let kept = libm::exp(-elapsed_s.max(0.0) / self.memory_s);
        for i in 3..6 {
            self.state[i] *= kept;
            for j in 0..6 {
                self.covariance[(i, j)] *= kept;
                self.covariance[(j, i)] *= kept;
            }
            self.covariance[(i, i)] += (1.0 - kept * kept) * self.slow_variance[i - 3];
        }
    }

    /// Returns the prior error of a frame's attitude, about the axes of the camera.
    pub(super) fn prior(&self) -> AttitudeError {
        let camera_from_body = self.nominal.matrix();
        // The constant and the slow error, about the axes of the body.
        let (mean, covariance) = self.systematic();
        AttitudeError {
            mean: camera_from_body * mean,
            covariance: camera_from_body * (covariance + self.white) * camera_from_body.transpose(),
        }
    }

    /// Returns the camera's attitude for an error of zero.
    pub(super) fn reference(&self, body_from_icrs: Rotation<Body, Icrs>) -> Rotation<CameraFrame, Icrs> {
        self.nominal * body_from_icrs
    }

    /// Updates the filter with a frame whose stars changed the error from `prior`, as returned by this
    /// filter, to `posterior`.
    pub(super) fn update(&mut self, prior: &AttitudeError, posterior: &AttitudeError) {
        let mounting = self.nominal.matrix();
        let in_body = |covariance: &Matrix3<f64>| mounting.transpose() * covariance * mounting;
        let Some(inverse) = in_body(&prior.covariance).try_inverse() else { return };
        // P Hᵀ with H = [I I], and the regression of c and s on e.
        let gain = (self.covariance.fixed_columns::<3>(0) + self.covariance.fixed_columns::<3>(3)) * inverse;
        self.state += gain * (mounting.transpose() * (posterior.mean - prior.mean));
        self.covariance -= gain * in_body(&(prior.covariance - posterior.covariance)) * gain.transpose();
        self.covariance = 0.5 * (self.covariance + self.covariance.transpose());
    }

    /// Returns mean and covariance of c + s, in axes of the body.
    fn systematic(&self) -> (Vector3<f64>, Matrix3<f64>) {
        let part = |row: usize, column: usize| self.covariance.fixed_view::<3, 3>(row, column).into_owned();
        let mean = self.state.fixed_rows::<3>(0) + self.state.fixed_rows::<3>(3);
        (mean, part(0, 0) + part(0, 3) + part(3, 0) + part(3, 3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARCSEC: f64 = 4.848_136_811_095_36e-6;

    fn filter() -> MountingFilter {
        let knowledge = AttitudeKnowledge {
            white_arcsec: [50.0; 3],
            slow_arcsec: [20.0; 3],
            slow_period_s: 3000.0,
            constant_arcsec: [180.0; 3],
        };
        let nominal = Rotation::from_rotation_vector(Vector3::new(0.3, -0.8, 0.2));
        MountingFilter::new(nominal, Some(knowledge))
    }

    #[test]
    fn the_prior_of_the_first_frame_is_the_calibration() {
        let prior = filter().prior();
        let sigma = (50.0_f64 * 50.0 + 20.0 * 20.0 + 180.0 * 180.0).sqrt() * ARCSEC;
        for i in 0..3 {
            assert!((prior.covariance[(i, i)].sqrt() / sigma - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_constant_error_is_learnt_to_the_noise_of_the_mean() {
        let mut filter = filter();
        let truth = filter.nominal.matrix() * Vector3::new(100.0, -60.0, 30.0) * ARCSEC;
        let measured = AttitudeError { mean: truth, covariance: Matrix3::identity() * (ARCSEC * ARCSEC) };
        for _ in 0..400 {
            let prior = filter.prior();
            filter.update(&prior, &measured);
            filter.advance(15.0);
        }
        let prior = filter.prior();
        assert!((prior.mean - truth).norm() < 15.0 * ARCSEC, "{}", (prior.mean - truth).norm() / ARCSEC);
        // The white noise is independent in every frame.
        assert!(
            prior.covariance[(0, 0)].sqrt() > 50.0 * ARCSEC
                && prior.covariance[(0, 0)].sqrt() < 55.0 * ARCSEC
        );
        filter.restart();
        assert_eq!(filter.prior().mean, Vector3::zeros());
    }

    #[test]
    fn the_slow_error_grows_back_to_its_variance() {
        let mut filter = filter();
        let prior = filter.prior();
        filter.update(&prior, &AttitudeError { mean: Vector3::zeros(), covariance: Matrix3::zeros() });
        let known = filter.covariance[(3, 3)];
        filter.advance(1e6);
        assert!(known < filter.covariance[(3, 3)]);
        assert!((filter.covariance[(3, 3)].sqrt() / (20.0 * ARCSEC) - 1.0).abs() < 1e-9);
    }
}
