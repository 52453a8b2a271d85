//! Mounting of the camera on the spacecraft, actual and nominal.

use contract::{Mounting, OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Actual and nominal mounting of the camera. A pipeline can calibrate their difference from stars.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountingConfig {
    /// Actual mounting, used to make images. Euler angles 123 from body to camera, degrees.
    pub actual: Mounting,
    /// Mounting as calibrated on the ground: guidance uses it for pointing, and pipelines receive it.
    pub nominal: Mounting,
}

impl MountingConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for an angle that is not finite.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "mounting")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_that_is_not_finite_is_refused() {
        let bad = Mounting { phi_deg: f64::NAN, ..Mounting::default() };
        assert!(MountingConfig { actual: bad, ..Default::default() }.check().is_err());
        assert!(MountingConfig { nominal: bad, ..Default::default() }.check().is_err());
    }
}
