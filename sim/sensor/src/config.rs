//! Configuration of a sensor.

use contract::OutOfRange;
use contract::bounds::{self, require};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::Switch;

use super::cosmic_rays::CosmicRayConfig;
use super::fixed_pattern::FixedPatternConfig;
use super::interlace::InterlaceConfig;
use super::rolling_shutter::RollingShutterConfig;
use super::spill::BloomingConfig;
use super::telegraph::TelegraphConfig;

/// Components of the pixel noise. They are one effect with one draw per pixel: switching a component changes
/// that draw, and no other draw of the simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NoiseConfig {
    /// Poisson statistics of the collected electrons; if off, exactly the expected number is collected.
    pub shot: Switch,
    /// Gaussian readout noise.
    pub read: Switch,
    /// Dark current, with its shot noise.
    pub dark: Switch,
}

/// Temperature of the detector. The dark current, including that of hot pixels, is multiplied by
/// 2^((`temperature_c` − `reference_c`)/`doubling_k`); without the table, by 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemperatureConfig {
    /// Temperature of the detector, °C, −150 to 100.
    #[schemars(range(min = -150, max = 100))]
    pub temperature_c: f64,
    /// Temperature for which the dark currents are specified, °C, −150 to 100.
    #[schemars(range(min = -150, max = 100))]
    pub reference_c: f64,
    /// Temperature difference that doubles the dark current, K, 1 to 50; silicon near room temperature: 6 to
    /// 9.
    #[schemars(range(min = 1, max = 50))]
    pub doubling_k: f64,
}

impl Default for TemperatureConfig {
    fn default() -> Self {
        Self { temperature_c: 20.0, reference_c: 20.0, doubling_k: 7.0 }
    }
}

impl TemperatureConfig {
    /// Factor of the dark current.
    pub(super) fn factor(&self) -> f64 {
        libm::exp2((self.temperature_c - self.reference_c) / self.doubling_k)
    }
}

/// Noise common to the pixels of a row or of a column, drawn anew in every frame; off by default. It is part
/// of the read noise and is switched with it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LineNoiseConfig {
    /// Standard deviation of the offset of a row, electrons, 0 to 500.
    #[schemars(range(min = 0, max = 500))]
    pub row_e: f64,
    /// Standard deviation of the offset of a column, electrons, 0 to 500; for permanent offsets see
    /// `fixed_pattern.column_offset_e`.
    #[schemars(range(min = 0, max = 500))]
    pub column_e: f64,
}

/// Distribution of the dark currents of hot pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum HotPixelDistribution {
    /// Log-normal distribution with the parameters `median_e_per_s` and `spread`.
    #[default]
    LogNormal,
    /// Pareto distribution: P(I > i) = ½ (`median_e_per_s`/i)^`index` for i from median/2^(1/`index`)
    /// upwards. It has a heavy tail, like detectors after years of proton radiation.
    Pareto {
        /// Exponent, 0.3 to 10; at 1 and below the mean is infinite.
        #[schemars(range(min = 0.3, max = 10))]
        index: f64,
    },
}

/// Pixels with a high dark current; the same pixels in every frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HotPixelConfig {
    /// Number of hot pixels, at most a tenth of all pixels; 0 for none.
    #[schemars(range(max = 26_843_545))]
    pub count: usize,
    /// Seed of this detector; not the seed of the scenario.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Median of the hot pixels' dark current, electrons per second, 0 to 1e9.
    #[schemars(range(min = 0, max = 1e9))]
    pub median_e_per_s: f64,
    /// Standard deviation of the natural logarithm of the dark current in a log-normal distribution, 0 to 5;
    /// values of 1 and above give a heavy tail.
    #[schemars(range(min = 0, max = 5))]
    pub spread: f64,
    /// Distribution of the dark currents; none exceeds 1e9 electrons per second.
    #[serde(default)]
    pub law: HotPixelDistribution,
    /// Random telegraph switching; off without the table.
    #[serde(default)]
    pub telegraph: Option<TelegraphConfig>,
}

/// Detector, readout and analogue-digital converter.
///
/// The digital number of a pixel is floor((e (1 − β e/full well) + read noise)/gain + bias + ½), clipped to 0
/// to 2^bits − 1, where e is the number of collected electrons, at most the full well, and β is
/// `non_linearity`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorConfig {
    /// Bits of the analogue-digital converter, 8 to 16.
    #[schemars(range(min = 8, max = 16))]
    pub bit_depth: u8,
    /// Electrons per digital number, 0.05 to 1e5.
    #[schemars(range(min = 0.05, max = 1e5))]
    pub gain_e_per_dn: f64,
    /// Digital number of a pixel without electrons, from 0 to less than 2^bit_depth − 1; fractions are
    /// allowed.
    #[schemars(range(min = 0, max = 65535))]
    pub bias_dn: f64,
    /// Full well of a pixel, electrons, 1 to 1e9; excess electrons are lost, or spill along the column with
    /// `blooming`.
    #[schemars(range(min = 1, max = 1e9))]
    pub full_well_e: f64,
    /// Standard deviation of the read noise, electrons, 0 to 500.
    #[schemars(range(min = 0, max = 500))]
    pub read_noise_e: f64,
    /// Dark current of an ordinary pixel, electrons per second, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub dark_current_e_per_s: f64,
    /// Photoelectrons of the sky, equal in every pixel, electrons per second, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub background_e_per_s: f64,
    /// Share of its signal that a full pixel loses (or, if negative, gains), −0.3 to 0.3; the deviation grows
    /// with the square of the charge. 0: linear.
    #[serde(default)]
    #[schemars(range(min = -0.3, max = 0.3))]
    pub non_linearity: f64,
    /// Time in which the image of a frame-transfer CCD is shifted into the storage area while still
    /// illuminated, s, 0 to 10; 0: no smear. Each pixel collects light at the positions of all other rows of
    /// its column, for 1/rows of that time each: at some on its way out, and at the others when it came in.
    #[serde(default)]
    #[schemars(range(min = 0, max = 10))]
    pub frame_transfer_s: f64,
    /// Switches of the noise components.
    #[serde(default)]
    pub noise: NoiseConfig,
    /// Pixels with a high dark current.
    #[serde(default)]
    pub hot_pixels: HotPixelConfig,
    /// Spilling of full wells along columns; off without the table.
    #[serde(default)]
    pub blooming: Option<BloomingConfig>,
    /// Temperature of the detector.
    #[serde(default)]
    pub temperature: TemperatureConfig,
    /// Differences between pixels.
    #[serde(default)]
    pub fixed_pattern: FixedPatternConfig,
    /// Noise common to rows and columns.
    #[serde(default)]
    pub line_noise: LineNoiseConfig,
    /// Cosmic-ray hits; none without the table.
    #[serde(default)]
    pub cosmic_rays: Option<CosmicRayConfig>,
    /// Interlaced readout; without the table all rows are exposed simultaneously.
    #[serde(default)]
    pub interlace: Option<InterlaceConfig>,
    /// Rolling shutter; without the table all rows are exposed simultaneously.
    #[serde(default)]
    pub rolling_shutter: Option<RollingShutterConfig>,
}

/// Ideal detector as a starting point: 16 bits, one electron per digital number, photoelectrons only, no read
/// noise, every defect off.
impl Default for SensorConfig {
    fn default() -> Self {
        Self {
            bit_depth: 16,
            gain_e_per_dn: 1.0,
            bias_dn: 0.0,
            full_well_e: 65_535.0,
            read_noise_e: 0.0,
            dark_current_e_per_s: 0.0,
            background_e_per_s: 0.0,
            noise: NoiseConfig::default(),
            hot_pixels: HotPixelConfig::default(),
            blooming: None,
            non_linearity: 0.0,
            frame_transfer_s: 0.0,
            temperature: TemperatureConfig::default(),
            fixed_pattern: FixedPatternConfig::default(),
            line_noise: LineNoiseConfig::default(),
            cosmic_rays: None,
            interlace: None,
            rolling_shutter: None,
        }
    }
}

impl SensorConfig {
    /// Checks every number. Limits without a physical reason bound the time and memory that a malicious file
    /// can use.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "sensor")?;
        let full_scale_dn = f64::from(self.full_scale_dn());
        let expected = "0 or more, and less than the largest digital number, 2^bit_depth - 1";
        require("sensor.bias_dn", self.bias_dn, expected, |v| v < full_scale_dn)?;
        if let Some(rolling) = &self.rolling_shutter {
            rolling.check(self.interlace.is_some(), self.frame_transfer_s)?;
        }
        self.cosmic_rays.as_ref().map_or(Ok(()), CosmicRayConfig::check)
    }

    /// Returns mid-exposure of a row, counted from 0, of a detector with `rows` rows, s from the time of the
    /// frame.
    pub fn offset_s(&self, row: usize, rows: usize) -> f64 {
        let of_field = self.interlace.map_or(0.0, |interlace| interlace.offset_s(row));
        of_field + self.rolling_shutter.map_or(0.0, |rolling| rolling.offset_s(row as f64, rows))
    }

    /// Longest time from the time of a frame to mid-exposure of one of its rows, s; 0 if all rows are exposed
    /// simultaneously.
    pub fn half_interval_s(&self, rows: usize) -> f64 {
        let of_fields = self.interlace.map_or(0.0, |interlace| interlace.offsets_s()[1]);
        let of_rows = self.rolling_shutter.map_or(0.0, |rolling| rolling.offsets_s(rows)[1].abs());
        of_fields.max(of_rows)
    }

    /// Largest digital number, 2^bits − 1.
    pub fn full_scale_dn(&self) -> u16 {
        u16::MAX >> 16_u32.saturating_sub(u32::from(self.bit_depth))
    }

    /// Electrons at which a pixel saturates: the full well or the upper limit of the converter, whichever is
    /// lower.
    pub fn saturation_e(&self) -> f64 {
        let converter_e = (f64::from(self.full_scale_dn()) - self.bias_dn) * self.gain_e_per_dn;
        // Root of e (1 − β e/full well) = converter_e, in a form that is also valid for β = 0.
        let root = 1.0 - 4.0 * self.non_linearity * converter_e / self.full_well_e;
        if root < 0.0 {
            self.full_well_e
        } else {
            self.full_well_e.min(2.0 * converter_e / (1.0 + root.sqrt()))
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::ExposureInterval;
    use draws::Seed;

    /// Twelve-bit sensor similar to a star tracker's.
    pub(crate) fn twelve_bit() -> SensorConfig {
        SensorConfig {
            bit_depth: 12,
            gain_e_per_dn: 10.0,
            bias_dn: 50.3,
            full_well_e: 40_000.0,
            read_noise_e: 15.0,
            dark_current_e_per_s: 10.0,
            background_e_per_s: 30.0,
            noise: NoiseConfig::default(),
            hot_pixels: HotPixelConfig {
                count: 5,
                seed: 3,
                median_e_per_s: 2000.0,
                spread: 1.0,
                ..HotPixelConfig::default()
            },
            ..SensorConfig::default()
        }
    }

    /// Returns an exposure at J2000.0.
    pub(crate) fn interval(exposure_s: f64) -> ExposureInterval {
        ExposureInterval { seed: Seed { seed: 42, case: 0 }, middle_s: 0.0, exposure_s }
    }

    #[test]
    fn full_scale_follows_the_bit_depth() {
        for (bit_depth, expected) in [(8, 255), (12, 4095), (16, 65535)] {
            assert_eq!(SensorConfig { bit_depth, ..twelve_bit() }.full_scale_dn(), expected);
        }
    }

    #[test]
    fn saturation_is_the_well_or_the_converter() {
        // (4095 − 50.3) × 10 = 40447 e⁻.
        assert_eq!(twelve_bit().saturation_e(), 40_000.0);
        let deep = SensorConfig { full_well_e: 1e6, ..twelve_bit() };
        assert!((deep.saturation_e() - 40_447.0).abs() < 1e-9);
        // 5 % lost at a full well of one million: e − 5e-8 e² = 40447 at 40529.
        let bent = SensorConfig { non_linearity: 0.05, ..deep };
        let e = bent.saturation_e();
        assert!((e - 5e-8 * e * e - 40_447.0).abs() < 1e-6);
    }

    #[test]
    fn a_number_out_of_range_is_named() {
        let wrong = SensorConfig { gain_e_per_dn: 0.0, ..twelve_bit() };
        assert_eq!(wrong.check().unwrap_err().to_string(), "sensor.gain_e_per_dn is 0, expected 0.05 to 1e5");
        assert!(SensorConfig { bit_depth: 17, ..twelve_bit() }.check().is_err());
        assert!(SensorConfig { read_noise_e: f64::NAN, ..twelve_bit() }.check().is_err());
    }
}
