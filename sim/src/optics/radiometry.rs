//! From magnitudes to photo-electrons.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::SimError;
use crate::error::require;

/// How many photo-electrons a star gives: aperture, transmission, passband and quantum efficiency in one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiometryConfig {
    /// Photo-electrons a second from a star of magnitude V = 0, over its whole image, greater than 0, at most 1e15.
    pub zero_point_e_per_s: f64,
}

impl RadiometryConfig {
    /// Checks the zero point.
    ///
    /// # Errors
    /// [`SimError::Parameter`] when it is outside its range.
    pub fn check(&self) -> Result<(), SimError> {
        require("radiometry.zero_point_e_per_s", self.zero_point_e_per_s, "in (0, 1e15]", |v| {
            v > 0.0 && v <= 1e15
        })
    }

    /// Photo-electrons a second from a star of a magnitude V: zero point times 10^(−0.4 V) (Pogson 1856).
    pub fn electrons_per_s(&self, magnitude: f64) -> f64 {
        self.zero_point_e_per_s * libm::pow(10.0, -0.4 * magnitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_magnitudes_are_a_factor_of_a_hundred() {
        let radiometry = RadiometryConfig { zero_point_e_per_s: 2e6 };
        assert_eq!(radiometry.electrons_per_s(0.0), 2e6);
        // A few units in the last place of pow.
        assert!((radiometry.electrons_per_s(5.0) - 2e4).abs() < 1e-8);
        assert!((radiometry.electrons_per_s(-5.0) - 2e8).abs() < 1e-4);
    }

    #[test]
    fn a_zero_point_of_zero_is_refused() {
        assert!(RadiometryConfig { zero_point_e_per_s: 0.0 }.check().is_err());
        assert!(RadiometryConfig { zero_point_e_per_s: f64::NAN }.check().is_err());
    }
}
