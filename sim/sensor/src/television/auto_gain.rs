//! Automatic gain of the camera.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gain that brings the mean of the picture towards a set value.
///
/// It is computed from the noise-free signal of the field itself, so any field can be made separately. A real
/// control loop averages over some tenths of a second, in which the mean of an approach's picture changes by
/// less than the accuracy of the control; only at a change of lens is this gain faster than a real one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AutoGainConfig {
    /// Target mean of the picture, in units of the white level, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1))]
    pub mean: f64,
    /// Share of the (logarithmic) difference that is corrected, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub strength: f64,
    /// Minimum gain, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1))]
    pub least: f64,
    /// Maximum gain, 1 to 100.
    #[schemars(range(min = 1, max = 100))]
    pub greatest: f64,
}

impl Default for AutoGainConfig {
    fn default() -> Self {
        Self { mean: 0.2, strength: 0.6, least: 0.2, greatest: 3.0 }
    }
}

impl AutoGainConfig {
    /// Returns the gain for a picture with this mean, in units of the white level.
    pub(super) fn gain(&self, mean: f64) -> f64 {
        // The lower limit keeps the ratio finite for a dark picture.
        let ratio = self.mean / mean.max(1e-6);
        libm::pow(ratio, self.strength).clamp(self.least, self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gain_steers_to_its_mean_within_its_limits() {
        let full = AutoGainConfig { mean: 0.4, strength: 1.0, least: 0.5, greatest: 4.0 };
        assert!((full.gain(0.2) * 0.2 - 0.4).abs() < 1e-15);
        assert_eq!(full.gain(0.0), 4.0);
        assert_eq!(full.gain(10.0), 0.5);
        assert!((AutoGainConfig { strength: 0.5, ..full }.gain(0.1) - 2.0).abs() < 1e-15);
        assert_eq!(AutoGainConfig { strength: 0.0, ..full }.gain(0.1), 1.0);
    }
}
