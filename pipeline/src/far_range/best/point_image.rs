//! Estimate of the image of a point: the calibrated image, corrected by the stars.

use contract::{Calibration, PsfCalibration};

use super::image_fit::{FittedImage, PointImage};

/// Default image of a point without a calibration: a sharp star tracker lens.
const UNKNOWN: PsfCalibration = PsfCalibration { sigma_px: 0.9, halo_sigma_px: 4.0, halo_fraction: 0.02 };

/// Standard deviation of the logarithm of a width without a calibration.
const UNKNOWN_LOG_WIDTH: f64 = 0.5;

/// Scatter of the logarithm of the stars' widths over the field and with colour: lower limit of the
/// estimate's standard deviation.
const MIN_LOG_WIDTH: f64 = 0.01;

/// Smallest signal-to-noise ratio, and largest misfit, of a star whose width is used.
const MIN_SNR: f64 = 30.0;
const MAX_MISFIT: f64 = 2.0;

/// Core and halo of the image of a point. The logarithm of the width relative to the calibrated one is a
/// normal variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointImageEstimate {
    image: PointImage,
    log_width: f64,
    variance: f64,
    /// Standard deviation of the share of the flux in the halo.
    pub(super) halo_sigma: f64,
}

impl PointImageEstimate {
    /// Creates the estimate before any star; `width_error` is the relative error of the calibrated width.
    pub(super) fn new(calibration: &Calibration, width_error: f64) -> Self {
        let PsfCalibration { sigma_px, halo_sigma_px, halo_fraction } = calibration.psf.unwrap_or(UNKNOWN);
        let sigma = if calibration.psf.is_some() { width_error } else { UNKNOWN_LOG_WIDTH };
        Self {
            image: PointImage { sigma_px, halo_sigma_px, halo_fraction, trail_px: [0.0; 2] },
            log_width: 0.0,
            variance: sigma * sigma,
            halo_sigma: if calibration.psf.is_some() { 0.2 * halo_fraction + 0.002 } else { 0.03 },
        }
    }

    /// Returns the image of a point, smeared by `trail_px` along columns and rows.
    pub(super) fn image(&self, trail_px: [f64; 2]) -> PointImage {
        PointImage { sigma_px: self.image.sigma_px * libm::exp(self.log_width), trail_px, ..self.image }
    }

    /// Returns the standard deviation of the logarithm of the width.
    pub(super) fn log_width_sigma(&self) -> f64 {
        self.variance.sqrt().max(MIN_LOG_WIDTH)
    }

    /// Updates the estimate with the width of a star that was fitted with this image and with a width prior
    /// of this estimate's standard deviation.
    pub(super) fn update_from_star(&mut self, star: &FittedImage) {
        let snr = star.flux_e / star.flux_sigma_e;
        if snr < MIN_SNR || star.misfit() > MAX_MISFIT {
            return;
        }
        // The width of a Gaussian is accurate to about 1/snr; pixels of half a width and the background
        // double this.
        let measured = (2.0 / snr).max(3.0 * MIN_LOG_WIDTH);
        let gain = self.variance / (self.variance + measured * measured);
        // The prior already reduced the fitted change, so it includes a part of the gain.
        self.log_width += gain * libm::log(star.width);
        self.variance = (self.variance * (1.0 - gain)).max(MIN_LOG_WIDTH * MIN_LOG_WIDTH);
    }
}
