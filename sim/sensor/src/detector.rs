//! Detector: its fixed properties, and the quantities that follow from them.

use render::draw::ExpectedImage;
use truth::SimError;

use super::config::SensorConfig;
use super::fixed_pattern::FixedPattern;
use super::hot_pixels::{HotPixel, hot_pixels};
use super::pixel::distribution::PixelDistribution;
use super::raw_image::RawImage;

/// Detector with its readout. Properties that are fixed for its life, including the hot pixels, are computed
/// once.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    config: SensorConfig,
    pub(super) distribution: PixelDistribution,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Temperature factor of all dark currents.
    warmth: f64,
    hot_pixels: Vec<HotPixel>,
    pattern: FixedPattern,
}

impl Sensor {
    /// Creates a sensor of `columns` × `rows` pixels.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a number out of range.
    pub fn new(config: &SensorConfig, columns: usize, rows: usize) -> Result<Self, SimError> {
        config.check()?;
        let warmth = config.temperature.factor();
        Ok(Self {
            distribution: PixelDistribution::new(config),
            warmth,
            hot_pixels: hot_pixels(&config.hot_pixels, columns, rows, warmth)?,
            pattern: FixedPattern::from_config(&config.fixed_pattern, columns, rows)?,
            config: config.clone(),
            columns,
            rows,
        })
    }

    /// Configuration of the sensor.
    pub fn config(&self) -> &SensorConfig {
        &self.config
    }

    /// Number of columns and of rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Fixed differences between pixels.
    pub(super) fn pattern(&self) -> &FixedPattern {
        &self.pattern
    }

    /// Hot pixels, in image order.
    pub fn hot_pixels(&self) -> &[HotPixel] {
        &self.hot_pixels
    }

    /// Photoelectrons of the uniform sky in every pixel: the initial level of an image.
    pub fn sky_electrons(&self, exposure_s: f64) -> f64 {
        self.config.background_e_per_s * exposure_s
    }

    /// Dark current of an ordinary pixel in an exposure, electrons; 0 if dark current is switched off.
    pub fn dark_electrons(&self, exposure_s: f64) -> f64 {
        self.config.noise.dark.apply(self.config.dark_current_e_per_s * self.warmth) * exposure_s
    }

    /// Standard deviation of the readout per pixel, electrons: the simulated read noise, including the noise
    /// common to rows and columns, and the rounding of the converter, which is uniform over one digital
    /// number and has the variance gain²/12 (Janesick, Photon Transfer, 2007, quantising noise).
    pub fn readout_noise_e(&self) -> f64 {
        let (pixel_e, lines) = (self.config.read_noise_e, self.config.line_noise);
        let read_e2 = pixel_e * pixel_e + lines.row_e * lines.row_e + lines.column_e * lines.column_e;
        let gain_e = self.config.gain_e_per_dn;
        (self.config.noise.read.apply(read_e2) + gain_e * gain_e / 12.0).sqrt()
    }

    /// Returns an image for [`Sensor::collect`] and [`Sensor::read_out`].
    pub fn new_expected(&self) -> ExpectedImage {
        ExpectedImage::new(self.columns, self.rows).with_response(&self.pattern.response)
    }

    /// Returns a raw image for [`Sensor::read_out`].
    pub fn new_raw(&self) -> RawImage {
        RawImage {
            columns: self.columns,
            rows: self.rows,
            bit_depth: self.config.bit_depth,
            dn: vec![0; self.columns * self.rows],
        }
    }
}
