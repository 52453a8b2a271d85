//! Spectra of stars by their colour, and of the Sun, as means over wavelength bins.
//!
//! Stars: flux-calibrated spectra of Pickles (1998, PASP 110, 863), dwarfs from O5 to G8 and giants from G5
//! to M7, scaled to V = 0. The Sun: ASTM G173-03 (Gueymard 2004), extraterrestrial.
//! `sim/data/make_spectra.py` generates the table and defines V.

/// First wavelength of the table, nm.
pub(super) const START_NM: f64 = 300.0;
/// Width of a bin, nm.
pub(super) const BIN_NM: f64 = 5.0;
/// Number of bins in a spectrum: up to 1100 nm, where silicon stops absorbing.
pub(super) const BINS: usize = 160;
/// Number of stars in the colour sequence.
pub(super) const STARS: usize = 36;
/// Number of stars, counted from the first, whose B−V increases from star to star: O5V to K4III. Beyond, the
/// molecular bands of M giants reverse B−V, and only V−I distinguishes the stars.
const BLUE: usize = 27;

/// B−V of a star whose colour is unknown, mag: the mean of the embedded catalogue.
const MEAN_B_V: f64 = 0.70;

const WORD: usize = size_of::<f64>();
const STAR_RECORD: usize = BINS + 2;

/// Table of spectra. A table of another size does not compile.
static TABLE: &[u8; (STARS * STAR_RECORD + BINS) * WORD] = include_bytes!("../../../data/spectra.bin");

/// Spectral irradiance, means over the bins, W m⁻² nm⁻¹.
pub(super) type Spectrum = [f64; BINS];

/// Middle of a bin, nm.
pub(super) fn wavelength_nm(bin: usize) -> f64 {
    START_NM + BIN_NM * (bin as f64 + 0.5)
}

fn table_value(index: usize) -> f64 {
    let (words, _) = TABLE.as_chunks::<WORD>();
    words.get(index).map_or(0.0, |word| f64::from_le_bytes(*word))
}

/// Spectral irradiance of star `number` of the sequence at V = 0.
pub(super) fn star(number: usize) -> Spectrum {
    std::array::from_fn(|bin| table_value(number * STAR_RECORD + 2 + bin))
}

/// Spectral irradiance of the Sun at 1 au.
pub(super) fn sun() -> Spectrum {
    std::array::from_fn(|bin| table_value(STARS * STAR_RECORD + bin))
}

/// Synthetic B−V of star `number` of the sequence, mag.
pub(super) fn b_v(number: usize) -> f64 {
    table_value(number * STAR_RECORD)
}

/// Synthetic V−I (Cousins) of star `number` of the sequence, mag.
pub(super) fn v_i(number: usize) -> f64 {
    table_value(number * STAR_RECORD + 1)
}

/// Position on the sequence of a star with these colours: the number of the preceding star, and the fraction
/// of the interval to the next, 0 to 1.
///
/// V−I is used if it is known, because it lies where silicon is sensitive: dwarfs and giants, reddened or
/// not, agree better in it. Otherwise B−V is used. Colours beyond the ends of the sequence use its ends.
pub(super) fn sequence_position(b_v_mag: Option<f64>, v_i_mag: Option<f64>) -> (usize, f64) {
    match (v_i_mag, b_v_mag) {
        (Some(colour), _) => between(colour, STARS, v_i),
        (None, b_v_mag) => between(b_v_mag.unwrap_or(MEAN_B_V), BLUE, b_v),
    }
}

/// Position of a colour among the first `count` stars, whose colours increase.
fn between(colour: f64, count: usize, colour_of: fn(usize) -> f64) -> (usize, f64) {
    let before = (1..count - 1).take_while(|&number| colour_of(number) <= colour).last().unwrap_or(0);
    let (low, high) = (colour_of(before), colour_of(before + 1));
    (before, ((colour - low) / (high - low)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use truth::catalog::Catalog;

    /// V of Bessell (1990), Table 2, every 10 nm from 470 nm.
    const V: [f64; 24] = [
        0.0, 0.030, 0.163, 0.458, 0.780, 0.967, 1.0, 0.973, 0.898, 0.792, 0.684, 0.574, 0.461, 0.359, 0.270,
        0.197, 0.135, 0.081, 0.045, 0.025, 0.017, 0.013, 0.009, 0.0,
    ];
    /// B of Bessell (1990), Table 2, every 10 nm from 360 nm.
    const B: [f64; 21] = [
        0.0, 0.030, 0.134, 0.567, 0.920, 0.978, 1.0, 0.978, 0.935, 0.853, 0.740, 0.640, 0.536, 0.424, 0.325,
        0.235, 0.150, 0.095, 0.043, 0.009, 0.0,
    ];

    /// Mean irradiance in a passband with nodes every 10 nm, energy weights.
    fn in_band(spectrum: &Spectrum, first_nm: f64, response: &[f64]) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (bin, irradiance) in spectrum.iter().enumerate() {
            let node = (wavelength_nm(bin) - first_nm) / 10.0;
            if node >= 0.0 && node < (response.len() - 1) as f64 {
                let (i, part) = (node as usize, node - node.floor());
                let weight = response[i] + part * (response[i + 1] - response[i]);
                sum += weight * irradiance;
                weights += weight;
            }
        }
        sum / weights
    }

    /// Magnitude relative to the irradiance of magnitude 0 of Bessell, Castelli & Plez (1998), Table A2.
    fn magnitude(irradiance: f64, zero_e11_erg_cm2_s_aa: f64) -> f64 {
        -2.5 * libm::log10(irradiance / (zero_e11_erg_cm2_s_aa * 1e-13))
    }

    #[test]
    fn every_spectrum_has_v_zero_and_its_stated_b_v() {
        for number in 0..STARS {
            let spectrum = star(number);
            let v = magnitude(in_band(&spectrum, 470.0, &V), 363.1);
            let b = magnitude(in_band(&spectrum, 360.0, &B), 632.0);
            // Bins of 5 nm compared with 0.25 nm: 0.003 mag where lines and molecular bands are dense.
            assert!(v.abs() < 0.003, "star {number}: V {v}");
            assert!((b - v - b_v(number)).abs() < 0.01, "star {number}: B−V {} for {}", b - v, b_v(number));
        }
    }

    /// Willmer (2018, ApJS 236, 47), Table 3: the Sun has V = −26.76 and B−V = 0.65.
    #[test]
    fn the_sun_has_its_published_magnitude_and_colour() {
        let v = magnitude(in_band(&sun(), 470.0, &V), 363.1);
        let b = magnitude(in_band(&sun(), 360.0, &B), 632.0);
        assert!((v + 26.76).abs() < 0.01, "{v}");
        // B−V of the Sun scatters by 0.02 from author to author.
        assert!((b - v - 0.65).abs() < 0.02, "{}", b - v);
    }

    /// The table ends at 1100 nm; the solar constant (1361 W m⁻²) has about 75 % of its energy between 300
    /// and 1100 nm.
    #[test]
    fn the_sun_has_the_energy_of_the_solar_constant() {
        let energy: f64 = sun().iter().sum::<f64>() * BIN_NM;
        assert!((energy - 0.75 * 1361.0).abs() < 0.02 * 1361.0, "{energy}");
    }

    #[test]
    fn the_colours_grow_along_the_sequence() {
        assert!((1..BLUE).all(|number| b_v(number) > b_v(number - 1)));
        assert!((1..STARS).all(|number| v_i(number) > v_i(number - 1)));
    }

    #[test]
    fn a_star_of_the_sequence_has_its_own_position() {
        for number in 0..STARS {
            let (before, part) = sequence_position(Some(0.5), Some(v_i(number)));
            assert!((before as f64 + part - number as f64).abs() < 1e-9, "{number}: {before} + {part}");
            if number < BLUE {
                let (before, part) = sequence_position(Some(b_v(number)), None);
                assert!((before as f64 + part - number as f64).abs() < 1e-9, "{number}: {before} + {part}");
            }
        }
    }

    #[test]
    fn colours_beyond_the_ends_are_those_of_the_ends() {
        assert_eq!(sequence_position(Some(-2.0), None), (0, 0.0));
        assert_eq!(sequence_position(Some(5.0), None), (BLUE - 2, 1.0));
        assert_eq!(sequence_position(None, Some(9.0)), (STARS - 2, 1.0));
    }

    #[test]
    fn the_mean_colour_is_that_of_the_catalogue() {
        let catalog = Catalog::hipparcos2();
        let colours: Vec<f64> = catalog.stars().iter().filter_map(|star| star.b_v).collect();
        let mean = colours.iter().sum::<f64>() / colours.len() as f64;
        assert!((mean - MEAN_B_V).abs() < 0.02, "{mean}");
    }
}
