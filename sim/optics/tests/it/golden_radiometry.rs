//! Radiometry compared with stars that were not used to make its spectra, and with the published zero point
//! and colours of Gaia.

use std::fs;

use boresight_optics::{KnownDetector, QuantumEfficiency, Radiometry, RadiometryConfig};

/// Returns the rows of a file of golden/radiometry/, without the header.
fn rows(name: &str) -> Vec<Vec<String>> {
    let path = format!("{}/../../golden/radiometry/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// An aperture of `area_cm2` square centimetres in front of a detector.
fn radiometry(area_cm2: f64, quantum_efficiency: QuantumEfficiency) -> Radiometry {
    Radiometry::new(&RadiometryConfig::Spectral {
        aperture_diameter_mm: 20.0 * (area_cm2 / std::f64::consts::PI).sqrt(),
        transmission: 1.0,
        quantum_efficiency,
        band_nm: None,
    })
    .unwrap()
}

fn gaia_g() -> QuantumEfficiency {
    let number = |text: &String| text.parse::<f64>().unwrap();
    QuantumEfficiency::Table(
        rows("gaia_g.csv").iter().map(|row| [number(&row[0]), number(&row[1])]).collect(),
    )
}

#[test]
fn electrons_agree_with_those_of_another_library_of_spectra() {
    let silicon = radiometry(1.0, QuantumEfficiency::Known(KnownDetector::SiliconCcd));
    let gaia = radiometry(1.0, gaia_g());
    let mut ratios = Vec::new();
    for row in rows("stars.csv") {
        let numbers: Vec<f64> = row[1..].iter().map(|text| text.parse().unwrap()).collect();
        let [b_v, v_i, silicon_e_per_s, gaia_e_per_s] = numbers[..] else { unreachable!() };
        for (name, ours, theirs) in [("silicon", &silicon, silicon_e_per_s), ("Gaia G", &gaia, gaia_e_per_s)]
        {
            let e_per_s = match row[0].as_str() {
                "sun" => ours.solar_zero_point_e_per_s(),
                _ => ours.zero_point_e_per_s(Some(b_v), Some(v_i)),
            };
            let ratio = e_per_s / theirs;
            let tolerance = if row[0] == "sun" { 0.02 } else { 0.07 };
            assert!((ratio - 1.0).abs() < tolerance, "{} in {name}: {ratio}", row[0]);
            ratios.push(ratio);
            // From B−V only, K dwarfs are mistaken for giants with less infrared flux.
            let by_b_v = ours.zero_point_e_per_s(Some(b_v), None) / theirs;
            assert!(b_v > 1.2 || (by_b_v - 1.0).abs() < 0.08, "{} in {name}: {by_b_v} by B−V", row[0]);
        }
    }
    assert_eq!(ratios.len(), 44);
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!((mean - 1.0).abs() < 0.01, "{mean}");
}

/// Gaia's telescope has a collecting area of 0.7278 m², and the zero point of its G band is 25.688 ± 0.002
/// mag for one electron per second in the Vega system (Evans et al. 2018, A&A 616, A4; Gaia DR2
/// documentation, Sec. 5.3.6): an absolute value that a real detector achieved.
#[test]
fn the_zero_point_of_gaia_comes_out() {
    let gaia = radiometry(7278.0, gaia_g());
    // An A0 star of V = 0 has G = 0.
    let zero_point = 2.5 * libm::log10(gaia.zero_point_e_per_s(Some(0.0), None));
    assert!((zero_point - 25.688).abs() < 0.03, "{zero_point}");
}

/// G − V = −0.01597 − 0.02809 x − 0.2483 x² + 0.03656 x³ − 0.002939 x⁴, x = V−I, from Landolt's standards,
/// scatter 0.027 (Riello et al. 2021, A&A 649, A3, Appendix C). The tolerance is 0.04 mag, because the zero
/// point of V itself differs by 0.02 between calibrations; it is 0.08 for M giants, which are rare among the
/// standards, and for which the relation of Jordi et al. (2010) differs by 0.04.
#[test]
fn the_colour_term_of_gaia_is_the_published_one() {
    let gaia = radiometry(7278.0, gaia_g());
    for (b_v, v_i) in [
        (-0.20, -0.20),
        (0.00, 0.00),
        (0.30, 0.38),
        (0.44, 0.52),
        (0.60, 0.68),
        (0.68, 0.74),
        (0.81, 0.87),
        (1.00, 1.00),
        (1.20, 1.21),
        (1.50, 1.75),
        (1.55, 2.20),
        (1.60, 2.80),
    ] {
        let g_minus_v = 25.688 - 2.5 * libm::log10(gaia.zero_point_e_per_s(Some(b_v), Some(v_i)));
        let published = -0.01597 + v_i * (-0.02809 + v_i * (-0.2483 + v_i * (0.03656 + v_i * -0.002939)));
        let tolerance = if v_i > 1.5 { 0.08 } else { 0.04 };
        assert!((g_minus_v - published).abs() < tolerance, "V−I {v_i}: {g_minus_v} for {published}");
    }
}
