//! Calibration of a camera and of the attitude knowledge, beyond geometry and readout.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{OutOfRange, bounds};

/// Calibration values of the point-spread function, the detector, the brightness scale and the errors of the
/// telemetry, as determined by the user. An unknown value is absent. The values may be wrong: a pipeline
/// estimates them where possible and uses these values as a prior.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Calibration {
    /// Point-spread function.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub psf: Option<PsfCalibration>,
    /// Full well of a pixel, e⁻, 1 to 1e9.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1e9))]
    pub full_well_e: Option<f64>,
    /// Fraction of the charge above the full well that spills along the columns, 0 (no spill) to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub spill_fraction: Option<f64>,
    /// Standard deviation of the pixel response, relative to its mean, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub response_sigma: Option<f64>,
    /// Photoelectrons per second from a star like the Sun of V = 0, 1e-3 to 1e15.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-3, max = 1e15))]
    pub zero_magnitude_e_per_s: Option<f64>,
    /// Size and brightness of the target.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<TargetCalibration>,
    /// Errors of the attitude in the telemetry and of the nominal mounting.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attitude: Option<AttitudeKnowledge>,
}

/// Size and brightness of the target, to a factor of two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetCalibration {
    /// Half the size of the target, m, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub radius_m: f64,
    /// Photoelectrons per second from the sunlit target at a range of 1 km, 1e-3 to 1e18.
    #[schemars(range(min = 1e-3, max = 1e18))]
    pub e_per_s_at_1_km: f64,
}

/// Point-spread function: a circular Gaussian core and a wider Gaussian halo.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PsfCalibration {
    /// Standard deviation of the core, px, 0.2 to 20.
    #[schemars(range(min = 0.2, max = 20))]
    pub sigma_px: f64,
    /// Standard deviation of the halo, px, 0.2 to 200.
    #[serde(default = "no_halo_px")]
    #[schemars(range(min = 0.2, max = 200))]
    pub halo_sigma_px: f64,
    /// Fraction of the flux in the halo, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub halo_fraction: f64,
}

/// Width of a halo without flux, px.
fn no_halo_px() -> f64 {
    4.0
}

/// Standard deviations of the attitude in the telemetry and of the mounting, about the body axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttitudeKnowledge {
    /// Standard deviation of the error that is independent in every frame, about x, y, z, arcsec, each 0 to
    /// 36000.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub white_arcsec: [f64; 3],
    /// Standard deviation of the slow error, about x, y, z, arcsec, each 0 to 36000.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub slow_arcsec: [f64; 3],
    /// Time scale of the slow error, s, 1 to 1e9.
    #[schemars(range(min = 1, max = 1e9))]
    pub slow_period_s: f64,
    /// Standard deviation of the constant error, including that of the nominal mounting, about x, y, z,
    /// arcsec, each 0 to 36000.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub constant_arcsec: [f64; 3],
}

impl Calibration {
    /// Checks the range of every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "calibration")
    }

    /// Returns this calibration with each value that `stated` contains in place of its own value.
    pub fn replaced_by(self, stated: Self) -> Self {
        Self {
            psf: stated.psf.or(self.psf),
            full_well_e: stated.full_well_e.or(self.full_well_e),
            spill_fraction: stated.spill_fraction.or(self.spill_fraction),
            response_sigma: stated.response_sigma.or(self.response_sigma),
            zero_magnitude_e_per_s: stated.zero_magnitude_e_per_s.or(self.zero_magnitude_e_per_s),
            target: stated.target.or(self.target),
            attitude: stated.attitude.or(self.attitude),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_outside_its_range_is_named() {
        let good = Calibration {
            psf: Some(PsfCalibration { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.04 }),
            target: Some(TargetCalibration { radius_m: 0.4, e_per_s_at_1_km: 1e8 }),
            ..Calibration::default()
        };
        good.check().unwrap();
        let refused = |calibration: Calibration| calibration.check().unwrap_err().path;
        assert_eq!(refused(Calibration { full_well_e: Some(0.0), ..good }), "calibration.full_well_e");
        let target = TargetCalibration { radius_m: -1.0, e_per_s_at_1_km: 1e8 };
        assert_eq!(refused(Calibration { target: Some(target), ..good }), "calibration.target.radius_m");
        let psf = PsfCalibration { sigma_px: f64::NAN, halo_sigma_px: 4.0, halo_fraction: 0.0 };
        assert_eq!(refused(Calibration { psf: Some(psf), ..good }), "calibration.psf.sigma_px");
    }

    #[test]
    fn a_stated_number_replaces_a_derived_one_alone() {
        let derived =
            Calibration { full_well_e: Some(6e4), response_sigma: Some(0.01), ..Calibration::default() };
        let stated = Calibration { full_well_e: Some(5e4), ..Calibration::default() };
        let expected = Calibration { full_well_e: Some(5e4), ..derived };
        assert_eq!(derived.replaced_by(stated), expected);
    }
}
