//! Quantum efficiency: photoelectrons per photon.

use contract::OutOfRange;
use contract::bounds::require;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Quantum efficiency of a detector by wavelength.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"silicon_ccd\" or a table of [wavelength in nm, efficiency]")]
pub enum QuantumEfficiency {
    /// Detector with a built-in quantum efficiency.
    Known(KnownDetector),
    /// Wavelength (nm, increasing, 200 to 1200) and electrons per photon (0 to 1), 2 to 1000 pairs; linear
    /// between them, 0 outside.
    Table(
        #[schemars(length(min = 2, max = 1000), extend("items" = { "type": "array", "minItems": 2, "maxItems": 2, "prefixItems": [
            { "type": "number", "minimum": 200, "maximum": 1200 },
            { "type": "number", "minimum": 0, "maximum": 1 },
        ] }))]
        Vec<[f64; 2]>,
    ),
}

/// Detectors whose quantum efficiency is built in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KnownDetector {
    /// Front-illuminated silicon CCD without coating: the absorption of silicon behind gates of polysilicon.
    /// Its peak is 0.53 near 600 nm. It models no particular device; a table of the manufacturer is better if
    /// available.
    SiliconCcd,
}

impl QuantumEfficiency {
    /// Checks that the wavelengths of a table increase; the radiometry checks its numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] if they do not increase.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        let Self::Table(table) = self else { return Ok(()) };
        for pair in table.windows(2) {
            let [[before, _], [after, _]] = pair else { continue };
            require("radiometry.quantum_efficiency", *after, "increasing wavelengths", |w| w > *before)?;
        }
        Ok(())
    }

    /// Electrons per photon at a wavelength, 0 to 1.
    pub fn efficiency_at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Known(KnownDetector::SiliconCcd) => silicon_ccd(wavelength_nm),
            Self::Table(table) => linear(table, wavelength_nm).unwrap_or(0.0),
        }
    }
}

/// Interpolates linearly in a table of increasing abscissae; `None` outside.
fn linear(table: &[[f64; 2]], x: f64) -> Option<f64> {
    table.windows(2).find_map(|pair| match pair {
        [[x0, y0], [x1, y1]] if (*x0..=*x1).contains(&x) => Some(y0 + (x - x0) / (x1 - x0) * (y1 - y0)),
        _ => None,
    })
}

/// Absorption coefficient of silicon at 300 K: wavelength, nm, and natural logarithm of the coefficient in
/// cm⁻¹, from Green (2008, Sol. Energy Mater. Sol. Cells 92, 1305, Table 1).
const SILICON: [[f64; 2]; 17] = [
    [300.0, 14.364],
    [350.0, 13.855],
    [400.0, 11.464],
    [450.0, 10.146],
    [500.0, 9.315],
    [550.0, 8.762],
    [600.0, 8.328],
    [650.0, 7.941],
    [700.0, 7.550],
    [750.0, 7.170],
    [800.0, 6.745],
    [850.0, 6.282],
    [900.0, 5.724],
    [950.0, 5.056],
    [1000.0, 4.159],
    [1050.0, 2.791],
    [1100.0, 1.253],
];
/// Fraction of light that passes the surface: one minus reflection, losses of the gates' oxide and shaded
/// parts of the pixel.
const ENTERING: f64 = 0.60;
/// Thickness of polysilicon in which electrons are lost, µm.
const GATES_UM: f64 = 0.25;
/// Thickness from which electrons are collected, µm.
const COLLECTING_UM: f64 = 10.0;

/// Quantum efficiency of a silicon CCD: entering light, less absorption in the gates, times absorption in the
/// collecting depth (Janesick 2001, Scientific Charge-Coupled Devices, Sec. 3.2).
fn silicon_ccd(wavelength_nm: f64) -> f64 {
    let Some(ln_per_cm) = linear(&SILICON, wavelength_nm) else { return 0.0 };
    let per_um = libm::exp(ln_per_cm) * 1e-4;
    ENTERING * libm::exp(-per_um * GATES_UM) * -libm::expm1(-per_um * COLLECTING_UM)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CCD: QuantumEfficiency = QuantumEfficiency::Known(KnownDetector::SiliconCcd);

    #[test]
    fn a_table_is_read_by_straight_lines_and_ends() {
        let table = QuantumEfficiency::Table(vec![[400.0, 0.2], [600.0, 0.6], [900.0, 0.0]]);
        assert!((table.efficiency_at(500.0) - 0.4).abs() < 1e-15);
        assert!((table.efficiency_at(600.0) - 0.6).abs() < 1e-15);
        assert_eq!((table.efficiency_at(399.9), table.efficiency_at(900.1)), (0.0, 0.0));
    }

    /// Front-illuminated CCDs without coating are blind in the near ultraviolet, have between 0.4 and 0.6 at
    /// their peak from 600 to 700 nm, some 0.2 at 900 nm and a few hundredths at 1000 nm, as in the data
    /// sheets of such devices.
    #[test]
    fn a_front_illuminated_ccd_is_blind_in_the_ultraviolet_and_fades_in_the_infrared() {
        assert!(CCD.efficiency_at(350.0) < 0.01);
        assert!((0.02..0.10).contains(&CCD.efficiency_at(400.0)), "{}", CCD.efficiency_at(400.0));
        let peak = (300..1100).map(f64::from).fold((0.0, 0.0), |best: (f64, f64), nm| {
            if CCD.efficiency_at(nm) > best.1 { (nm, CCD.efficiency_at(nm)) } else { best }
        });
        assert!((580.0..680.0).contains(&peak.0) && (peak.1 - 0.53).abs() < 0.01, "{peak:?}");
        assert!((0.10..0.25).contains(&CCD.efficiency_at(900.0)), "{}", CCD.efficiency_at(900.0));
        assert!((0.02..0.06).contains(&CCD.efficiency_at(1000.0)), "{}", CCD.efficiency_at(1000.0));
        assert_eq!(CCD.efficiency_at(1101.0), 0.0);
    }

    #[test]
    fn a_bad_table_is_refused() {
        let check = |table: Vec<[f64; 2]>| {
            let spectral = crate::RadiometryConfig::Spectral {
                aperture_diameter_mm: 10.0,
                transmission: 0.8,
                quantum_efficiency: QuantumEfficiency::Table(table),
                band_nm: None,
            };
            spectral.check()
        };
        check(vec![[500.0, 0.5], [600.0, 0.6]]).unwrap();
        for table in [
            vec![[500.0, 0.5]],
            vec![[500.0, 0.5], [500.0, 0.6]],
            vec![[500.0, 0.5], [600.0, 1.1]],
            vec![[500.0, f64::NAN], [600.0, 0.5]],
            vec![[100.0, 0.5], [600.0, 0.5]],
        ] {
            assert!(check(table).unwrap_err().path.starts_with("radiometry.quantum_efficiency"));
        }
    }
}
