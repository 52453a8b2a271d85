//! A detector: what is fixed of it, and what follows from that alone.

use super::config::SensorConfig;
use super::fixed_pattern::FixedPattern;
use super::hot_pixels::{HotPixel, hot_pixels};
use super::pixel_distribution::PixelDistribution;
use super::raw_image::RawImage;
use crate::SimError;
use crate::draw::ExpectedImage;

/// A detector with its readout. What is fixed for its life, hot pixels included, is made once.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    config: SensorConfig,
    pub(super) distribution: PixelDistribution,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Factor of all dark currents by the temperature.
    warmth: f64,
    hot_pixels: Vec<HotPixel>,
    pattern: FixedPattern,
}

impl Sensor {
    /// A sensor of `columns` × `rows` pixels.
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

    /// The configuration it was made of.
    pub fn config(&self) -> &SensorConfig {
        &self.config
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// What is different from pixel to pixel.
    pub(super) fn pattern(&self) -> &FixedPattern {
        &self.pattern
    }

    /// Its hot pixels, in the order of the image.
    pub fn hot_pixels(&self) -> &[HotPixel] {
        &self.hot_pixels
    }

    /// Photo-electrons of the flat sky in every pixel: the level to clear an image to.
    pub fn sky_electrons(&self, exposure_s: f64) -> f64 {
        self.config.background_e_per_s * exposure_s
    }

    /// Dark current of an ordinary pixel in an exposure, electrons; 0 when it is off.
    pub fn dark_electrons(&self, exposure_s: f64) -> f64 {
        self.config.noise.dark.apply(self.config.dark_current_e_per_s * self.warmth) * exposure_s
    }

    /// Standard deviation of what the readout adds to a pixel, electrons: read noise with what rows and columns share, as
    /// far as it is simulated, and the rounding of the converter, which is even over one digital number and has the variance
    /// gain²/12 (Janesick, Photon Transfer, 2007, quantising noise).
    pub fn readout_noise_e(&self) -> f64 {
        let (pixel_e, lines) = (self.config.read_noise_e, self.config.line_noise);
        let read_e2 = pixel_e * pixel_e + lines.row_e * lines.row_e + lines.column_e * lines.column_e;
        let gain_e = self.config.gain_e_per_dn;
        (self.config.noise.read.apply(read_e2) + gain_e * gain_e / 12.0).sqrt()
    }

    /// An image that [`Sensor::collect`] and [`Sensor::read_out`] take.
    pub fn new_expected(&self) -> ExpectedImage {
        ExpectedImage::new(self.columns, self.rows).with_response(&self.pattern.response)
    }

    /// A raw image for [`Sensor::read_out`].
    pub fn new_raw(&self) -> RawImage {
        RawImage {
            columns: self.columns,
            rows: self.rows,
            bit_depth: self.config.bit_depth,
            dn: vec![0; self.columns * self.rows],
        }
    }
}
