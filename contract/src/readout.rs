//! Calibrated conversion from electrons to digital numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{OutOfRange, bounds};

/// Calibrated readout of a pixel: DN = electrons/gain + bias, with a variance of electrons + read noise², up
/// to saturation. A pipeline needs it to weight pixels by their uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Readout {
    /// Gain, electrons per DN, 1e-3 to 1e6.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub gain_e_per_dn: f64,
    /// Bias: digital number of a pixel without electrons, 0 to 65535.
    #[schemars(range(min = 0, max = 65535))]
    pub bias_dn: f64,
    /// Standard deviation of the read noise, electrons, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub read_noise_e: f64,
    /// Digital number from which on a pixel no longer follows its electrons: the value of the full well or
    /// the largest value of the converter, whichever is reached first; 1 to 65535.
    #[schemars(range(min = 1, max = 65535))]
    pub saturation_dn: u16,
}

impl Readout {
    /// Checks the range of every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "readout")
    }
}
