//! Measurement of the target with its covariances.

use contract::{Covariance2, Measurement, PixelPoint};
use nalgebra::Matrix2;

use super::frame_attitude::FrameAttitude;
use super::stars::image_covariance;
use super::state::BestPipeline;
use super::target::{CandidateImage, TargetContext};
use crate::far_range::overrides::Overrides;

/// Standard deviation of the logarithm of the width of the target's image without a calibration of the
/// target's size, and its lower limit with one.
const UNKNOWN_BODY_LOG_WIDTH: f64 = 0.03;
const MIN_BODY_LOG_WIDTH: f64 = 0.001;

/// Standard deviation of the distance between the centre of brightness of a sunlit body and its centre, along
/// an axis, relative to half its size. The distance is up to 0.6 for a Lambert sphere at a phase of 90°, and
/// 0 for a plate with the Sun behind the camera.
const BRIGHTNESS_OFFSET: f64 = 0.35;

impl BestPipeline {
    /// Returns half the angular size of the target, derived from its flux, rad; `None` without a calibration
    /// of the target.
    fn angular_radius(&self, flux_e: f64, exposure_s: f64) -> Option<f64> {
        let target = self.calibration.target?;
        let range_m = 1000.0 * (target.e_per_s_at_1_km * exposure_s / flux_e.max(1e-9)).sqrt();
        Some(target.radius_m / range_m)
    }

    /// Returns the centroid error due to the structure of the body, px. A body of half size a with a skewness
    /// of 1 shifts the position given by pixels at three widths from the centre by (3² − 3) μ₃/(6 σ²), with
    /// the third moment μ₃ = (a/√3)³ (Gram–Charlier series of the image).
    fn structure_px(&self, flux_e: f64, exposure_s: f64) -> f64 {
        let Some(radius) = self.angular_radius(flux_e, exposure_s) else { return 0.0 };
        let (fx, fy) = self.model.focal_px();
        let deviation_px = radius * fx.max(fy) / 3.0_f64.sqrt();
        let sigma_px = self.psf.image([0.0; 2]).sigma_px;
        // A body larger than the image of a point is resolved, so its structure no longer acts as a skewness
        // of a point.
        (deviation_px * deviation_px * deviation_px / (sigma_px * sigma_px)).min(deviation_px)
    }

    /// Returns the standard deviation of the logarithm of the width of the target's image. A uniform body of
    /// half size a widens a Gaussian of width σ by a²/(6 σ²).
    pub(super) fn body_log_width(&self, flux_e: f64, exposure_s: f64) -> f64 {
        let Some(radius) = self.angular_radius(flux_e, exposure_s) else { return UNKNOWN_BODY_LOG_WIDTH };
        let (fx, fy) = self.model.focal_px();
        let size_px = radius * fx.max(fy) / self.psf.image([0.0; 2]).sigma_px;
        (size_px * size_px / 6.0).clamp(MIN_BODY_LOG_WIDTH, 0.5)
    }

    /// Returns the measurement: position and line of sight of the target with their covariances.
    /// `log_odds` is the logarithm of the odds of its track.
    pub(super) fn measurement(
        &self,
        image: &CandidateImage,
        inputs: TargetContext<'_>,
        overrides: &Overrides<'_>,
        log_odds: Option<f64>,
    ) -> Measurement {
        let TargetContext { attitude, exposure_s, .. } = inputs;
        let (candidate, fit) = (&image.candidate, image.fit.as_ref());
        let frame = inputs.context.frame;
        let given = overrides.centroid.and_then(|centroid| centroid(candidate.position));
        let (columns, rows) = (frame.columns() as f64, frame.rows() as f64);
        let fitted = given.unwrap_or(candidate.position);
        // The centre of a truncated image may be a fraction of a pixel off the detector.
        let position = PixelPoint::new(fitted.x.clamp(-0.5, columns - 0.5), fitted.y.clamp(-0.5, rows - 0.5));
        let line_of_sight = self.direction(position, attitude);
        let centroid = match (given, fit) {
            (None, Some(fit)) => {
                let structure_px = self.structure_px(fit.image.flux_e, exposure_s);
                let floor = self.config.best.target_floor_px * self.config.best.target_floor_px
                    + structure_px * structure_px;
                let misfit = fit.image.misfit().max(1.0);
                let [xx, xy, yy] = fit.image.covariance_px2.map(|element| misfit * element);
                Some(Matrix2::new(xx + floor, xy, xy, yy + floor))
            }
            _ => None,
        };
        let offset = fit
            .and_then(|fit| self.angular_radius(fit.image.flux_e, exposure_s))
            .map_or(0.0, |radius| BRIGHTNESS_OFFSET * radius);
        let checked = |matrix: Matrix2<f64>| {
            Covariance2::from_matrix(matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 1)]).ok()
        };
        Measurement {
            position,
            position_covariance: centroid.and_then(checked),
            line_of_sight,
            log_odds,
            line_of_sight_covariance: centroid.and_then(|centroid| {
                checked(self.line_of_sight_covariance(position, centroid, offset, attitude)?)
            }),
        }
    }

    /// Returns the covariance of the angles atan2(X, Z) and atan2(Y, Z) of the line of sight, rad². It
    /// includes the covariances of the centroid, px², and of the attitude, and the standard deviation of the
    /// distance between the centre of brightness and the body, rad.
    fn line_of_sight_covariance(
        &self,
        position: PixelPoint,
        centroid: Matrix2<f64>,
        offset: f64,
        attitude: &FrameAttitude,
    ) -> Option<Matrix2<f64>> {
        attitude.camera_from_icrs?;
        let (u, v) = self.model.to_ideal(position)?;
        let (fx, fy) = self.model.focal_px();
        let (x, y) = (u / fx, v / fy);
        // dα = d(X/Z)/(1 + (X/Z)²). The distortion changes the scale of a pixel by less than a percent.
        let by_ideal = Matrix2::new(1.0 / (fx * (1.0 + x * x)), 0.0, 0.0, 1.0 / (fy * (1.0 + y * y)));
        let in_image = centroid + image_covariance(&attitude.error.covariance, x, y, (fx, fy));
        Some(by_ideal * in_image * by_ideal.transpose() + Matrix2::identity() * (offset * offset))
    }
}
