//! The camera's automatic gain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gain that brings the mean of the picture towards a set value.
///
/// It looks at the noise-free light of the field itself, so that any field can be made alone: a real loop looks back over
/// some tenths of a second, in which the mean of an approach's picture changes by less than it is steered to; only at a
/// change of lens is it quicker than a real one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AutoGainConfig {
    /// Mean of the picture that is steered to, in units of the white level, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1))]
    pub mean: f64,
    /// Share of the (logarithmic) difference that is taken away, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub strength: f64,
    /// Least gain, 0.01 to 1.
    #[schemars(range(min = 0.01, max = 1))]
    pub least: f64,
    /// Greatest gain, 1 to 100.
    #[schemars(range(min = 1, max = 100))]
    pub greatest: f64,
}

impl Default for AutoGainConfig {
    fn default() -> Self {
        Self { mean: 0.2, strength: 0.6, least: 0.2, greatest: 3.0 }
    }
}

impl AutoGainConfig {
    /// The gain for a picture of this mean, in units of the white level.
    pub(super) fn gain(&self, mean: f64) -> f64 {
        // A dark picture would ask for any gain.
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
