//! From electrons to digital numbers, as calibrated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ContractError;
use crate::error::require;

/// How the electrons of a pixel become its digital number, as the camera's calibration tells: DN = electrons/gain + bias,
/// with a variance of electrons + read noise², up to saturation. What a pipeline needs to know how far a pixel is to be
/// believed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Readout {
    /// Electrons per digital number, 1e-3 to 1e6.
    pub gain_e_per_dn: f64,
    /// Digital number of a pixel without electrons, 0 to 65535.
    pub bias_dn: f64,
    /// Standard deviation of the read noise, electrons, 0 to 1e6.
    pub read_noise_e: f64,
    /// Digital number from which on a pixel does not follow its electrons any more: that of the full well or the largest of
    /// the converter, whichever is reached first; 1 to 65535.
    pub saturation_dn: u16,
}

impl Readout {
    /// Checks every number.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), ContractError> {
        let within = |low: f64, high: f64| move |v: f64| (low..=high).contains(&v);
        require("readout.gain_e_per_dn", self.gain_e_per_dn, "1e-3 to 1e6", within(1e-3, 1e6))?;
        require("readout.bias_dn", self.bias_dn, "0 to 65535", within(0.0, 65535.0))?;
        require("readout.read_noise_e", self.read_noise_e, "0 to 1e6", within(0.0, 1e6))?;
        let saturation_dn = f64::from(self.saturation_dn);
        require("readout.saturation_dn", saturation_dn, "1 to 65535", within(1.0, 65535.0))
    }
}
