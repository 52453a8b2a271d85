//! Johnson V from the Hipparcos magnitude Hp.

/// Range of B−V for which the transformation was derived, mag.
const COLOUR_RANGE: (f64, f64) = (-0.25, 2.0);

/// V − Hp of a star without a colour, mag: the mean of the transformation over the stars of Hipparcos-2 that
/// have a colour. It scatters by 0.06 mag.
const MEAN_V_MINUS_HP: f64 = -0.107;

/// Johnson V from Hp and Johnson B−V, mag (Harmanec 1998, A&A 335, 173): V = Hp − 0.2964 (B−V) + 0.1110
/// (B−V)² + 0.0157 (B−V)³ + 0.0072.
///
/// The paper's term 0.0050 (U−B) is left out, because Hipparcos has no U−B: at most 0.01 mag. The relation
/// was derived for B−V from −0.25 to 2.0, V brighter than 8 and reddening below 1; a bluer or redder star
/// gets the offset of the nearest end, and a star without colour the mean offset, −0.107.
///
/// Accuracy, against the V of the 41 000 stars of I/239 brighter than about 8: median −0.003, half of the
/// stars within 0.006, 95 % within 0.032, 99 % within 0.14 mag. B−V does not follow the molecular bands of M
/// giants: at V−I of 2.5 the result is too bright by 0.1 mag, at 3.5 by 0.4 mag (some 600 stars are redder
/// than 3). Two stars have a published Hp that does not fit their V: Sirius (the result is too faint by 0.38
/// mag) and Vega (by 0.06 mag).
pub fn v_mag(hp_mag: f64, b_v: Option<f64>) -> f64 {
    let offset = b_v.map_or(MEAN_V_MINUS_HP, |b_v| {
        let colour = b_v.clamp(COLOUR_RANGE.0, COLOUR_RANGE.1);
        0.0072 + colour * (-0.2964 + colour * (0.1110 + colour * 0.0157))
    });
    hp_mag + offset
}

/// Hp from Johnson V and B−V, mag: the inverse of [`v_mag`].
pub fn hp_mag(v_mag: f64, b_v: Option<f64>) -> f64 {
    v_mag - self::v_mag(0.0, b_v)
}

#[cfg(test)]
mod tests {
    use super::super::Catalog;
    use super::*;

    /// V of well-known stars that vary little, from the Bright Star Catalogue (Hoffleit & Warren 1991, CDS
    /// V/50), whose V are means of photoelectric UBV measurements.
    const PUBLISHED: [(u32, &str, f64); 14] = [
        (69673, "Arcturus", -0.04),
        (24608, "Capella", 0.08),
        (37279, "Procyon", 0.38),
        (97649, "Altair", 0.77),
        (113368, "Fomalhaut", 1.16),
        (37826, "Pollux", 1.14),
        (102098, "Deneb", 1.25),
        (49669, "Regulus", 1.35),
        (21421, "Aldebaran", 0.85),
        (9884, "Hamal", 2.00),
        (8102, "τ Ceti", 3.50),
        (16537, "ε Eridani", 3.73),
        (25336, "Bellatrix", 1.64),
        (67301, "Alkaid", 1.86),
    ];

    #[test]
    fn published_v_is_recovered_from_hp() {
        let catalog = Catalog::hipparcos2();
        let errors: Vec<f64> = PUBLISHED
            .iter()
            .map(|(id, name, published)| {
                let error = catalog.star(*id).unwrap().v_mag() - published;
                // The V of stars this bright scatters by 0.02 from source to source, and some vary by as
                // much; 0.05 is 2.5 σ. Without the transformation, Aldebaran and Arcturus would be off by
                // 0.15.
                assert!(error.abs() < 0.05, "{name}: {error:+.3}");
                error
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        // 0.02/sqrt(14) = 0.005 is the standard error of the mean; three of them.
        assert!(mean.abs() < 0.015, "mean error {mean:+.4}");
    }

    /// Known deviation, left uncorrected: the catalogue is drawn as published.
    #[test]
    fn sirius_and_vega_are_as_faint_as_their_published_hp() {
        let catalog = Catalog::hipparcos2();
        let error = |id: u32, v: f64| catalog.star(id).unwrap().v_mag() - v;
        assert!((error(32_349, -1.46) - 0.38).abs() < 0.01);
        assert!((error(91_262, 0.03) - 0.06).abs() < 0.01);
    }

    /// Bessell (2000, PASP 112, 961), Table 2: B−V (as BT−VT + Δ(B−V)) and V − Hp of dwarfs, an independent
    /// calibration.
    #[test]
    fn the_transformation_agrees_with_bessell() {
        for (b_v, v_minus_hp) in [
            (-0.179, 0.051),
            (0.083, -0.038),
            (0.179, -0.058),
            (0.275, -0.079),
            (0.374, -0.094),
            (0.465, -0.108),
            (0.549, -0.120),
            (0.632, -0.131),
            (0.715, -0.137),
            (0.796, -0.147),
            (0.878, -0.155),
            (0.958, -0.157),
            (1.034, -0.162),
        ] {
            let difference = v_mag(0.0, Some(b_v)) - v_minus_hp;
            // The two calibrations were made from different standards: they agree to 0.005 for cool stars and
            // differ by up to 0.02 where B−V is near 0.
            assert!(difference.abs() < 0.025, "B−V {b_v}: {difference:+.4}");
        }
    }

    #[test]
    fn beyond_the_range_the_offset_is_that_of_the_end() {
        assert_eq!(v_mag(5.0, Some(5.46)), v_mag(5.0, Some(2.0)));
        assert_eq!(v_mag(5.0, Some(-0.4)), v_mag(5.0, Some(-0.25)));
    }

    #[test]
    fn the_mean_offset_is_the_mean_over_the_catalogue() {
        let catalog = Catalog::hipparcos2();
        let coloured = || catalog.stars().iter().filter(|star| star.b_v.is_some());
        let mean = coloured().map(|star| star.v_mag() - star.hp_mag).sum::<f64>() / coloured().count() as f64;
        assert!((mean - MEAN_V_MINUS_HP).abs() < 0.0005, "{mean}");
    }

    #[test]
    fn hp_is_recovered_from_v() {
        for b_v in [None, Some(0.5), Some(3.0)] {
            assert!((hp_mag(v_mag(6.0, b_v), b_v) - 6.0).abs() < 1e-14);
        }
    }
}
