//! How the camera really sits on the spacecraft, and how everybody believes it does.

use contract::{Mounting, OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The camera's mounting, real and believed. Their difference is what a pipeline can calibrate from stars.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountingConfig {
    /// As it is: images are made with it. Euler angles 123 from body to camera, degrees.
    pub actual: Mounting,
    /// As calibrated on the ground: guidance points with it, and pipelines are given it.
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
