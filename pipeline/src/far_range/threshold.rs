//! Detection thresholds I1 and I2 (section 2.1).

use contract::bounds::require;
use contract::{Frame, OutOfRange};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::background::Background;

/// Source of the thresholds I1 (every pixel of a cluster) and I2 (at least one pixel of a cluster).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum ThresholdConfig {
    /// Constants, as fractions of full scale.
    Constant {
        /// I1, fraction of full scale, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        low: f64,
        /// I2, fraction of full scale, `low` to 1.
        #[schemars(range(min = 0, max = 1))]
        high: f64,
    },
    /// Computed from the frame: I1 = b + low_sigmas · σ and I2 = b + max(high_sigmas · σ, star_fraction · (p
    /// − b)), with the background's median b and noise σ and the brightest pixel p. Both thresholds are
    /// limited to the lower half of the range between background and full scale, so that bright stars still
    /// pass in a noisy frame. The paper names these inputs and gives no formula; this formula is ours.
    Automatic {
        /// I1 above the background, in standard deviations of its noise, 0 to 1000.
        #[serde(default = "default_low_sigmas")]
        #[schemars(range(min = 0, max = 1000))]
        low_sigmas: f64,
        /// I2 above the background, in standard deviations of its noise, `low_sigmas` to 1000. At 6, a frame
        /// of half a million pixels of normal noise has no false cluster.
        #[serde(default = "default_high_sigmas")]
        #[schemars(range(min = 0, max = 1000))]
        high_sigmas: f64,
        /// Minimum of I2 above the background, as a fraction of the brightest pixel's height above the
        /// background, 0 to 1. Values above 0 hide objects much fainter than the brightest object: fewer
        /// ghosts, fewer stars.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        star_fraction: f64,
    },
}

fn default_low_sigmas() -> f64 {
    3.0
}

fn default_high_sigmas() -> f64 {
    6.0
}

impl Default for ThresholdConfig {
    fn default() -> Self {
        Self::Automatic {
            low_sigmas: default_low_sigmas(),
            high_sigmas: default_high_sigmas(),
            star_fraction: 0.0,
        }
    }
}

/// Thresholds of one frame: a pixel passes when its DN is greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Thresholds {
    /// I1, DN.
    pub(super) low_dn: u16,
    /// I2, DN; not below `low_dn`.
    pub(super) high_dn: u16,
}

/// Upper limit of automatic thresholds, as a fraction of the range between background and full scale.
const HIGHEST_AUTOMATIC: f64 = 0.5;

impl ThresholdConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        match *self {
            Self::Constant { low, high } => {
                require("thresholds.high", high, "thresholds.low to 1", |v| v >= low)
            }
            Self::Automatic { low_sigmas, high_sigmas, .. } => {
                let expected = "thresholds.low_sigmas to 1000";
                require("thresholds.high_sigmas", high_sigmas, expected, |v| v >= low_sigmas)
            }
        }
    }

    /// Returns true if the thresholds depend on the frame's background.
    pub(super) fn needs_background(&self) -> bool {
        matches!(self, Self::Automatic { .. })
    }

    /// Computes the thresholds of a frame. A required background that is missing counts as zero.
    pub(super) fn for_frame(&self, frame: &Frame, background: Option<Background>) -> Thresholds {
        let full_scale = f64::from(frame.full_scale_dn());
        let (low, high) = match *self {
            Self::Constant { low, high } => (low * full_scale, high * full_scale),
            Self::Automatic { low_sigmas, high_sigmas, star_fraction } => {
                let (base, sigma) = background.map_or((0.0, 0.0), |b| (b.median_dn, b.sigma_dn));
                let highest = base + HIGHEST_AUTOMATIC * (full_scale - base).max(0.0);
                let by_stars = if star_fraction > 0.0 {
                    star_fraction * (f64::from(brightest_dn(frame)) - base)
                } else {
                    0.0
                };
                let low = base + low_sigmas * sigma;
                let high = base + (high_sigmas * sigma).max(by_stars);
                (low.min(highest), high.min(highest))
            }
        };
        // For integer DN, DN > t and DN > floor(t) are equivalent; the cast saturates.
        Thresholds { low_dn: low.floor() as u16, high_dn: high.floor() as u16 }
    }
}

fn brightest_dn(frame: &Frame) -> u16 {
    frame.dn().iter().fold(0, |most, &dn| most.max(dn))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(brightest: u16) -> Frame {
        Frame::new(0, 2, 1, 12, vec![0, brightest], None).unwrap()
    }

    fn automatic(star_fraction: f64) -> ThresholdConfig {
        ThresholdConfig::Automatic { low_sigmas: 3.0, high_sigmas: 6.0, star_fraction }
    }

    fn background(median_dn: f64, sigma_dn: f64) -> Option<Background> {
        Some(Background { median_dn, sigma_dn })
    }

    #[test]
    fn constants_are_fractions_of_full_scale() {
        let got = ThresholdConfig::Constant { low: 0.1, high: 0.5 }.for_frame(&frame(0), None);
        assert_eq!(got, Thresholds { low_dn: 409, high_dn: 2047 });
    }

    #[test]
    fn automatic_thresholds_stand_on_the_background() {
        let got = automatic(0.0).for_frame(&frame(4000), background(100.0, 2.0));
        assert_eq!(got, Thresholds { low_dn: 106, high_dn: 112 });
    }

    #[test]
    fn bright_stars_raise_the_second_threshold_only() {
        let got = automatic(0.1).for_frame(&frame(1100), background(100.0, 2.0));
        assert_eq!(got, Thresholds { low_dn: 106, high_dn: 200 });
    }

    #[test]
    fn a_noisy_frame_lets_bright_stars_through() {
        let got = automatic(0.0).for_frame(&frame(4095), background(2095.0, 900.0));
        assert_eq!(got, Thresholds { low_dn: 3095, high_dn: 3095 });
    }

    #[test]
    fn thresholds_in_the_wrong_order_are_refused() {
        let error = ThresholdConfig::Constant { low: 0.5, high: 0.4 }.check().unwrap_err();
        assert_eq!(error.to_string(), "thresholds.high is 0.4, expected thresholds.low to 1");
        assert!(ThresholdConfig::Constant { low: f64::NAN, high: 0.4 }.check().is_err());
        assert!(ThresholdConfig::default().check().is_ok());
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let json = r#"{"mode": "constant", "low": 0.1, "high": 0.2, "hi": 3}"#;
        assert!(serde_json::from_str::<ThresholdConfig>(json).is_err());
        let json = r#"{"mode": "automatic"}"#;
        assert_eq!(serde_json::from_str::<ThresholdConfig>(json).unwrap(), ThresholdConfig::default());
    }
}
