//! Radial velocities of near and fast stars, which Hipparcos does not have.
//!
//! A star's proper motion changes as its distance from us and its angle change: by −2 μ v_r π/A per year,
//! with A = 4.740 47 km yr/s (perspective acceleration; Schlesinger 1917, AJ 30, 137). Over 25 years this
//! moves a star by 0.64 mas × μ\[″/yr\] × π\[″\] × v_r\[km/s\] beyond its linear motion: 0.4″ for Barnard's
//! star, less than 1 mas for all but a few hundred stars. The table holds stars whose effect exceeds 1 mas at
//! their velocity or at 30 km/s, a common velocity near the Sun, and for which a sourced velocity was
//! available.
//!
//! The table is incomplete: 230 stars without a velocity would exceed 1 mas at 30 km/s, most of them faint.
//! The three largest effects are those of HIP 67593 (21 mas, of a doubtful solution), HIP 3829 (13 mas: van
//! Maanen's star, a white dwarf whose published velocities from −38 to +263 km/s disagree by its
//! gravitational redshift and more) and HIP 57367 (11 mas, also a white dwarf). A star without a velocity
//! moves linearly. A double star has the velocity of one component, orbital motion included. CNS3, the oldest
//! source, may be wrong by 10 km/s and more for M dwarfs.

/// Source of a velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// Gliese & Jahreiß 1991, Preliminary Version of the Third Catalogue of Nearby Stars (CDS V/70A).
    Cns3,
    /// SKY2000 Master Star Catalog (Myers et al. 2001, CDS V/145) with the updates of Gaia DR3.
    Sky2000,
    /// Gaia DR3 (Gaia Collaboration 2022, CDS I/355).
    GaiaDr3,
    /// Kervella, Thévenin & Lovis 2017, A&A 598, L7.
    Kervella2017,
    /// SIMBAD (Wenger et al. 2000, A&AS 143, 9).
    Simbad,
}

/// Radial velocity of a star by its HIP number, km/s, positive for recession.
pub(super) fn radial_velocity_km_s(hip: u32) -> Option<f64> {
    TABLE.binary_search_by_key(&hip, |(hip, ..)| *hip).ok().map(|row| TABLE[row].1)
}

/// HIP number, radial velocity in km/s, and source; in ascending order of HIP.
const TABLE: &[(u32, f64, Source)] = &[
    (439, 22.9, Source::Cns3),
    (1_242, -29.0, Source::Cns3),
    (1_475, 12.5, Source::Cns3),
    (1_599, 9.3, Source::Sky2000),
    (2_021, 22.9, Source::Sky2000),
    (3_821, 8.2, Source::Cns3),
    (5_336, -98.1, Source::Sky2000),
    (5_643, 28.0, Source::Cns3),
    (8_102, -16.4, Source::Cns3),
    (12_114, 25.7, Source::Sky2000),
    (15_330, 12.4, Source::Sky2000),
    (15_371, 11.9, Source::Sky2000),
    (15_510, 86.7, Source::Sky2000),
    (16_537, 16.7, Source::Cns3),
    (19_849, -42.5, Source::Cns3),
    (21_088, 17.0, Source::Cns3),
    (24_186, 245.5, Source::Cns3),
    (25_878, 10.6, Source::Cns3),
    (26_857, 103.0, Source::Cns3),
    (29_295, 3.9, Source::Cns3),
    (30_920, 24.0, Source::Cns3),
    (32_349, -7.6, Source::Cns3),
    (33_226, 36.0, Source::Cns3),
    (34_603, 39.0, Source::Cns3),
    (36_208, 18.2, Source::Cns3),
    (37_279, -3.2, Source::Cns3),
    (45_343, 11.1, Source::Cns3),
    (49_908, -26.1, Source::Cns3),
    (53_020, 4.0, Source::Cns3),
    (53_767, 29.0, Source::Cns3),
    (54_035, -86.8, Source::Cns3),
    (54_211, 64.9, Source::Cns3),
    (57_443, 16.9, Source::Sky2000),
    (57_544, -119.0, Source::Cns3),
    (57_548, -31.0, Source::Simbad),
    (57_757, 4.4, Source::Sky2000),
    (57_939, -98.1, Source::Sky2000),
    (67_155, 15.3, Source::Cns3),
    (70_890, -22.204, Source::Kervella2017),
    (71_681, -20.7, Source::Cns3),
    (71_683, -24.6, Source::Cns3),
    (73_184, 25.9, Source::Cns3),
    (74_995, -30.0, Source::Cns3),
    (76_074, 15.4, Source::Cns3),
    (80_459, -12.6, Source::Cns3),
    (80_824, -13.0, Source::Cns3),
    (82_809, 21.8, Source::Cns3),
    (82_817, 18.8, Source::Cns3),
    (84_140, -19.0, Source::Cns3),
    (84_405, 0.4, Source::Cns3),
    (85_523, -10.2, Source::Cns3),
    (86_162, -23.2, Source::Cns3),
    (86_214, -60.0, Source::Cns3),
    (86_990, -115.0, Source::Cns3),
    (87_937, -110.47, Source::GaiaDr3),
    (88_601, -10.0, Source::Cns3),
    (91_768, -0.6, Source::Cns3),
    (91_772, 6.0, Source::Cns3),
    (92_403, -4.0, Source::Cns3),
    (94_761, 32.4, Source::Cns3),
    (96_100, 26.55, Source::GaiaDr3),
    (97_649, -26.1, Source::Cns3),
    (99_240, -21.7, Source::Cns3),
    (99_461, -129.8, Source::Cns3),
    (99_701, -31.1, Source::Cns3),
    (104_214, -64.3, Source::Cns3),
    (104_217, -63.9, Source::Cns3),
    (105_090, 19.8, Source::Cns3),
    (106_106, 1.0, Source::Cns3),
    (106_440, 4.1, Source::Cns3),
    (108_870, -40.0, Source::Cns3),
    (110_893, -27.1, Source::Cns3),
    (112_460, -1.5, Source::Cns3),
    (113_020, 8.7, Source::Cns3),
    (113_296, -19.4, Source::Cns3),
    (114_046, 9.5, Source::Cns3),
    (114_622, -17.8, Source::Cns3),
    (117_473, -64.8, Source::Cns3),
];

#[cfg(test)]
mod tests {
    use super::super::{Catalog, CatalogStar};
    use super::*;

    /// Effect of a radial velocity on a star's position after 25 years, mas: ½ t² × 2 μ v π/A.
    fn effect_mas(star: &CatalogStar, velocity_km_s: f64) -> f64 {
        let mas = std::f64::consts::PI / 180.0 / 3600.0e3;
        let motion = libm::hypot(star.pm_ra_mas_per_yr, star.pm_dec_mas_per_yr);
        25.0 * 25.0 * motion * (star.parallax_mas * mas) * velocity_km_s.abs() / 4.740_47
    }

    #[test]
    fn the_table_is_in_order() {
        assert!(TABLE.windows(2).all(|rows| rows[0].0 < rows[1].0));
    }

    #[test]
    fn every_velocity_is_significant_and_belongs_to_a_star() {
        let catalog = Catalog::hipparcos2();
        for (hip, velocity, source) in TABLE {
            let star = catalog.star(*hip).unwrap();
            assert_eq!(star.radial_velocity_km_s, *velocity);
            assert!(effect_mas(star, velocity.abs().max(30.0)) >= 1.0, "HIP {hip} of {source:?}");
        }
    }

    /// Compares with geometry: a star moved along a straight line in space, with its velocity and without it.
    #[test]
    fn the_effect_is_that_of_a_straight_line_in_space() {
        let catalog = Catalog::hipparcos2();
        let star = catalog.star(87_937).unwrap();
        let mas = std::f64::consts::PI / 180.0 / 3600.0e3;
        let motion = libm::hypot(star.pm_ra_mas_per_yr, star.pm_dec_mas_per_yr) * mas;
        // Motion along the line of sight and along the proper motion, in units of the star's distance.
        let approach = star.radial_velocity_km_s / 4.740_47 * (star.parallax_mas * mas);
        let angle_mas = |approach: f64| libm::atan2(25.0 * motion, 1.0 + 25.0 * approach) / mas;
        let shift = angle_mas(approach) - angle_mas(0.0);
        // Third-order terms: 25 years of approach are 0.0016 of the distance, an effect of 0.2 %.
        let effect = effect_mas(star, star.radial_velocity_km_s);
        assert!((shift / effect - 1.0).abs() < 0.002, "{shift} and {effect}");
        // 0.4″, as the module documentation states.
        assert!((shift - 400.0).abs() < 5.0, "{shift}");
    }

    /// Checks the module documentation's count of missing velocities.
    #[test]
    fn the_stars_without_a_velocity_are_counted() {
        let catalog = Catalog::hipparcos2();
        let mut gaps: Vec<(f64, u32)> = catalog
            .stars()
            .iter()
            .filter(|star| radial_velocity_km_s(star.id).is_none())
            .map(|star| (effect_mas(star, 30.0), star.id))
            .filter(|(effect, _)| *effect >= 1.0)
            .collect();
        gaps.sort_by(|a, b| b.0.total_cmp(&a.0));
        assert_eq!(gaps.len(), 230);
        let largest: Vec<u32> = gaps.iter().take(5).map(|(_, id)| *id).collect();
        assert_eq!(largest, [67_593, 3_829, 57_367, 72_511, 55_360], "{:?}", &gaps[..5]);
    }
}
