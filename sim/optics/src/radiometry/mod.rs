//! Conversion of magnitudes to photoelectrons.
//!
//! The conversion uses either one zero point for light of every colour, or an integral over the spectrum: n =
//! A τ ∫ E(λ) λ/(hc) η(λ) dλ, with the area A of the aperture, the transmission τ of the optics, the
//! irradiance E of the star or of the Sun, and the quantum efficiency η of the detector (Bessell & Murphy
//! 2012, PASP 124, 140, Eq. 1, for a detector that counts photons).

mod quantum_efficiency;
mod spectra;

pub use quantum_efficiency::{KnownDetector, QuantumEfficiency};

use contract::OutOfRange;
use contract::bounds::{self, require};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spectra::Spectrum;
use truth::memo::Memo;

/// V magnitude of the Sun at 1 au (Willmer 2018, ApJS 236, 47: −26.76, Vega system, Johnson V).
pub const SUN_V_MAG_AT_1_AU: f64 = -26.76;

/// Colour B − V of the Sun, mag (Ramírez et al. 2012, ApJ 752, 5: 0.653).
pub const SUN_B_MINUS_V: f64 = 0.653;

/// Planck's constant times the speed of light, J nm (SI, exact): 6.62607015e-34 J s · 299792458 m/s · 1e9
/// nm/m.
const HC_J_NM: f64 = 6.626_070_15e-34 * 299_792_458.0 * 1e9;

/// Photoelectron yield of a star.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum RadiometryConfig {
    /// Aperture, transmission, passband and quantum efficiency in one number, with a term for the colour.
    ZeroPoint {
        /// Photoelectrons per second from a star of magnitude V = 0, over its whole image, greater than 0, at
        /// most 1e15.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e15))]
        zero_point_e_per_s: f64,
        /// Colour term c, magnitudes by which a star is brighter per magnitude of B−V, −2 to 2: its electrons
        /// per second are the zero point times 10^(0.4 c (B−V)) at V = 0. 0: every colour is equal.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[schemars(range(min = -2, max = 2))]
        colour_term: f64,
    },
    /// From spectra: stars by their colour, sunlit bodies by the spectrum of the Sun.
    Spectral {
        /// Diameter of the circular, unobstructed aperture, mm, greater than 0, at most 10 000.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 10000))]
        aperture_diameter_mm: f64,
        /// Transmission of the optics, greater than 0, at most 1; it includes a central obstruction.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
        transmission: f64,
        /// Photoelectrons per photon: "silicon_ccd", or a table of [wavelength in nm, efficiency].
        quantum_efficiency: QuantumEfficiency,
        /// Shortest and longest wavelength that a filter transmits, nm, increasing, within 300 to 1100;
        /// absent: no filter.
        #[schemars(inner(range(min = 300, max = 1100)))]
        band_nm: Option<[f64; 2]>,
    },
}

impl RadiometryConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "radiometry")?;
        if let Self::Spectral { quantum_efficiency, band_nm, .. } = self {
            quantum_efficiency.check()?;
            if let Some([short, long]) = *band_nm {
                require(
                    "radiometry.band_nm",
                    long,
                    "greater than the first wavelength, at most 1100",
                    |w| w > short,
                )?;
            }
        }
        Ok(())
    }
}

/// Conversion of magnitudes to photoelectrons per second.
///
/// ```
/// use boresight_optics::{KnownDetector, QuantumEfficiency, Radiometry, RadiometryConfig};
/// let radiometry = Radiometry::new(&RadiometryConfig::Spectral {
///     aperture_diameter_mm: 13.8,
///     transmission: 0.8,
///     quantum_efficiency: QuantumEfficiency::Known(KnownDetector::SiliconCcd),
///     band_nm: None,
/// })?;
/// // An aperture of 1.5 cm² with a plain silicon CCD behind it, a star like the Sun.
/// let zero_point_e_per_s = radiometry.zero_point_e_per_s(Some(0.65), None);
/// assert!((1.5e6..2.5e6).contains(&zero_point_e_per_s));
/// // Of two stars of the same V, silicon sees the red one brighter.
/// assert!(radiometry.zero_point_e_per_s(Some(1.5), Some(2.5)) > 2.0 * zero_point_e_per_s);
/// # Ok::<(), truth::SimError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Radiometry {
    /// Electrons per second of every star of the colour sequence at V = 0.
    stars: [f64; spectra::STARS],
    /// Electrons per second of sunlight of V = 0.
    sunlight: f64,
    /// Area of the aperture times transmission, m²; `None` if only a zero point is given.
    collecting_area_m2: Option<f64>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Cache of the latest conversions: only a few cameras occur, and each requires the integrals over all
/// spectra.
static PREPARED: Memo<RadiometryConfig, Radiometry> = Memo::new();

impl Radiometry {
    /// Prepares the conversion.
    ///
    /// # Errors
    /// [`OutOfRange`] for a number outside its range, or if the detector does not respond to any of the
    /// light.
    pub fn new(config: &RadiometryConfig) -> Result<Self, OutOfRange> {
        Ok((*PREPARED.get(config.clone(), Self::compute)?).clone())
    }

    fn compute(config: &RadiometryConfig) -> Result<Self, OutOfRange> {
        config.check()?;
        let prepared = match config {
            RadiometryConfig::ZeroPoint { zero_point_e_per_s, colour_term } => {
                let of_colour = |b_v: f64| zero_point_e_per_s * libm::pow(10.0, 0.4 * colour_term * b_v);
                Self {
                    stars: std::array::from_fn(|number| of_colour(spectra::b_v(number))),
                    sunlight: of_colour(SUN_B_MINUS_V),
                    collecting_area_m2: None,
                }
            }
            RadiometryConfig::Spectral {
                aperture_diameter_mm,
                transmission,
                quantum_efficiency,
                band_nm,
            } => {
                let radius_m = aperture_diameter_mm / 2000.0;
                let area_m2 = std::f64::consts::PI * radius_m * radius_m * transmission;
                let [short, long] = band_nm.unwrap_or([spectra::START_NM, 1100.0]);
                let rate = |spectrum: &Spectrum| {
                    let electrons_per_m2_s: f64 = spectrum
                        .iter()
                        .enumerate()
                        .map(|(bin, irradiance)| {
                            let wavelength_nm = spectra::wavelength_nm(bin);
                            let start_nm = (wavelength_nm - spectra::BIN_NM / 2.0).max(short);
                            let end_nm = (wavelength_nm + spectra::BIN_NM / 2.0).min(long);
                            let photons = irradiance * wavelength_nm / HC_J_NM * (end_nm - start_nm).max(0.0);
                            photons * quantum_efficiency.efficiency_at(wavelength_nm)
                        })
                        .sum();
                    area_m2 * electrons_per_m2_s
                };
                let to_v_zero = libm::pow(10.0, 0.4 * SUN_V_MAG_AT_1_AU);
                Self {
                    stars: std::array::from_fn(|number| rate(&spectra::star(number))),
                    sunlight: rate(&spectra::sun()) * to_v_zero,
                    collecting_area_m2: Some(area_m2),
                }
            }
        };
        let least = prepared.stars.iter().copied().fold(prepared.sunlight, f64::min);
        require("radiometry.quantum_efficiency", least, "an efficiency above 0 within the band", |e| {
            e > 0.0
        })?;
        Ok(prepared)
    }

    /// Photoelectrons per second from a star of V = 0 with these colours, B−V and V−I (Cousins), mag.
    ///
    /// V−I is used if it is known, otherwise B−V, which cannot distinguish M stars. A star without colours is
    /// treated as B−V = 0.70, the mean of Hipparcos. Colours beyond O5 and M7 use the ends of the sequence.
    pub fn zero_point_e_per_s(&self, b_v: Option<f64>, v_i: Option<f64>) -> f64 {
        let (before, part) = spectra::sequence_position(b_v, v_i);
        let (low, high) = (self.stars[before], self.stars[before + 1]);
        low + part * (high - low)
    }

    /// Photoelectrons per second from a grey body in sunlight of V = 0: its light has the spectrum of the
    /// Sun.
    pub fn solar_zero_point_e_per_s(&self) -> f64 {
        self.sunlight
    }

    /// Photoelectrons per second and square metre of a detector under sunlight of V = 0 without optics;
    /// `None` if the aperture is unknown, because only a zero point was given.
    pub fn bare_sunlight_e_per_s_m2(&self) -> Option<f64> {
        self.collecting_area_m2.map(|area_m2| self.sunlight / area_m2)
    }

    /// Photoelectrons per second from a star: zero point of its colour times 10^(−0.4 V) (Pogson 1856).
    pub fn star(&self, v_mag: f64, b_v: Option<f64>, v_i: Option<f64>) -> f64 {
        self.zero_point_e_per_s(b_v, v_i) * libm::pow(10.0, -0.4 * v_mag)
    }

    /// Photoelectrons per second from a grey body in sunlight.
    pub fn sunlit(&self, v_mag: f64) -> f64 {
        self.sunlight * libm::pow(10.0, -0.4 * v_mag)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Aperture of 1 cm² without losses, with every photon counted.
    fn perfect(band_nm: Option<[f64; 2]>) -> RadiometryConfig {
        RadiometryConfig::Spectral {
            aperture_diameter_mm: 20.0 / libm::sqrt(std::f64::consts::PI),
            transmission: 1.0,
            quantum_efficiency: QuantumEfficiency::Table(vec![[300.0, 1.0], [1100.0, 1.0]]),
            band_nm,
        }
    }

    fn silicon() -> Radiometry {
        Radiometry::new(&RadiometryConfig::Spectral {
            aperture_diameter_mm: 13.8,
            transmission: 0.8,
            quantum_efficiency: QuantumEfficiency::Known(KnownDetector::SiliconCcd),
            band_nm: None,
        })
        .unwrap()
    }

    #[test]
    fn a_colour_term_brightens_red_stars() {
        let config = RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1e6, colour_term: 0.3 };
        let radiometry = Radiometry::new(&config).unwrap();
        for b_v in [0.0, 0.65, 1.2] {
            // Between two stars of the sequence the relation is linear in electrons.
            let expected = 1e6 * libm::pow(10.0, 0.4 * 0.3 * b_v);
            assert!((radiometry.zero_point_e_per_s(Some(b_v), None) / expected - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_single_zero_point_ignores_colour_and_five_magnitudes_are_a_factor_of_100() {
        let one = Radiometry::new(&RadiometryConfig::ZeroPoint { zero_point_e_per_s: 2e6, colour_term: 0.0 })
            .unwrap();
        assert_eq!(one.star(0.0, Some(1.5), Some(2.7)), 2e6);
        assert_eq!(one.star(0.0, None, None), one.sunlit(0.0));
        // Tolerance: a few units in the last digit of pow.
        assert!((one.star(5.0, None, None) - 2e4).abs() < 1e-8);
        assert!((one.sunlit(-5.0) - 2e8).abs() < 1e-4);
    }

    /// Vega-like light of V = 0 has about 1000 photons per second, cm² and ångström at 550 nm: 3.63e-9 erg/(s
    /// cm² Å) (Bessell, Castelli & Plez 1998, Table A2) over the energy of a photon, 3.61e-12 erg, is 1005.
    #[test]
    fn a_star_of_v_zero_gives_a_thousand_photons_an_angstrom() {
        let green = Radiometry::new(&perfect(Some([545.0, 555.0]))).unwrap();
        let photons = green.zero_point_e_per_s(Some(0.0), None) / 100.0;
        // The slope of the spectrum over V changes the irradiance at 550 nm by 2 %.
        assert!((photons - 1005.0).abs() < 30.0, "{photons}");
    }

    /// Between 400 and 700 nm the Sun emits 39 % of the solar constant, 1361 W m⁻², at 4.57 µmol per joule
    /// (McCree 1972): 2.4 mmol m⁻² s⁻¹.
    #[test]
    fn sunlight_has_its_published_number_of_photons() {
        let visible = Radiometry::new(&perfect(Some([400.0, 700.0]))).unwrap();
        let mmol = visible.sunlit(SUN_V_MAG_AT_1_AU) * 1e4 / 6.022_140_76e20;
        assert!((mmol - 2.43).abs() < 0.07, "{mmol}");
    }

    #[test]
    fn a_bin_cut_by_the_band_counts_in_part() {
        let all = |band| Radiometry::new(&perfect(Some(band))).unwrap().solar_zero_point_e_per_s();
        let (whole, left, right) = (all([500.0, 505.0]), all([500.0, 501.25]), all([501.25, 505.0]));
        assert!((left + right - whole).abs() < 1e-9 * whole);
        assert!((left - 0.25 * whole).abs() < 1e-9 * whole);
    }

    #[test]
    fn electrons_follow_area_and_transmission() {
        let rate = |aperture_diameter_mm, transmission| {
            Radiometry::new(&RadiometryConfig::Spectral {
                aperture_diameter_mm,
                transmission,
                quantum_efficiency: QuantumEfficiency::Known(KnownDetector::SiliconCcd),
                band_nm: None,
            })
            .unwrap()
            .star(3.0, Some(0.4), None)
        };
        assert!((rate(40.0, 0.5) / rate(20.0, 1.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn silicon_sees_red_stars_brighter_and_the_sun_as_a_star_of_its_colour() {
        let silicon = silicon();
        let zero = |b_v| silicon.zero_point_e_per_s(Some(b_v), None);
        assert!([-0.2, 0.0, 0.3, 0.65, 1.0, 1.4].windows(2).all(|pair| zero(pair[0]) < zero(pair[1])));
        // Pickles' G2V and the measured Sun: two sources of one spectrum.
        let ratio = silicon.solar_zero_point_e_per_s() / zero(0.65);
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    }

    #[test]
    fn a_radiometry_without_signal_is_refused() {
        let zero = RadiometryConfig::ZeroPoint { zero_point_e_per_s: 0.0, colour_term: 0.0 };
        assert!(zero.check().is_err());
        assert!(
            RadiometryConfig::ZeroPoint { zero_point_e_per_s: f64::NAN, colour_term: 0.0 }.check().is_err()
        );
        let blind = RadiometryConfig::Spectral {
            aperture_diameter_mm: 20.0,
            transmission: 0.5,
            quantum_efficiency: QuantumEfficiency::Table(vec![[400.0, 0.0], [500.0, 0.0]]),
            band_nm: None,
        };
        let message = Radiometry::new(&blind).unwrap_err().to_string();
        assert!(message.contains("quantum_efficiency"), "{message}");
        assert!(perfect(Some([700.0, 400.0])).check().is_err());
    }
}
