//! The Moon: its position, to a few hundredths of a degree, and its brightness.

use nalgebra::Vector3;

use super::ecliptic;

/// Mean radius of the Moon, km (IAU Working Group on Cartographic Coordinates 2015).
pub const MOON_RADIUS_KM: f64 = 1_737.4;
/// Mean distance of the Moon, km, to which [`moon_magnitude`] refers.
pub const MOON_MEAN_DISTANCE_KM: f64 = 384_400.0;
/// Colour index B−V of the Moon (Cox 2000, Allen's Astrophysical Quantities, Table 12.6).
pub const MOON_B_V: f64 = 0.92;
/// Phase angle up to which the observed phase function applies, degrees.
const LAST_PHASE_DEG: f64 = 150.0;

/// Seconds in a Julian century.
const CENTURY_S: f64 = 36_525.0 * 86_400.0;

/// Periodic terms of longitude and distance: multiples of D, M, M', F; sine coefficient of longitude, 1e-6
/// degrees; cosine coefficient of distance, m. Meeus (1998), Table 47.A, to 0.002 degrees.
const LONGITUDE_AND_DISTANCE: [([f64; 4], f64, f64); 32] = [
    ([0.0, 0.0, 1.0, 0.0], 6_288_774.0, -20_905_355.0),
    ([2.0, 0.0, -1.0, 0.0], 1_274_027.0, -3_699_111.0),
    ([2.0, 0.0, 0.0, 0.0], 658_314.0, -2_955_968.0),
    ([0.0, 0.0, 2.0, 0.0], 213_618.0, -569_925.0),
    ([0.0, 1.0, 0.0, 0.0], -185_116.0, 48_888.0),
    ([0.0, 0.0, 0.0, 2.0], -114_332.0, -3_149.0),
    ([2.0, 0.0, -2.0, 0.0], 58_793.0, 246_158.0),
    ([2.0, -1.0, -1.0, 0.0], 57_066.0, -152_138.0),
    ([2.0, 0.0, 1.0, 0.0], 53_322.0, -170_733.0),
    ([2.0, -1.0, 0.0, 0.0], 45_758.0, -204_586.0),
    ([0.0, 1.0, -1.0, 0.0], -40_923.0, -129_620.0),
    ([1.0, 0.0, 0.0, 0.0], -34_720.0, 108_743.0),
    ([0.0, 1.0, 1.0, 0.0], -30_383.0, 104_755.0),
    ([2.0, 0.0, 0.0, -2.0], 15_327.0, 10_321.0),
    ([0.0, 0.0, 1.0, 2.0], -12_528.0, 0.0),
    ([0.0, 0.0, 1.0, -2.0], 10_980.0, 79_661.0),
    ([4.0, 0.0, -1.0, 0.0], 10_675.0, -34_782.0),
    ([0.0, 0.0, 3.0, 0.0], 10_034.0, -23_210.0),
    ([4.0, 0.0, -2.0, 0.0], 8_548.0, -21_636.0),
    ([2.0, 1.0, -1.0, 0.0], -7_888.0, 24_208.0),
    ([2.0, 1.0, 0.0, 0.0], -6_766.0, 30_824.0),
    ([1.0, 0.0, -1.0, 0.0], -5_163.0, -8_379.0),
    ([1.0, 1.0, 0.0, 0.0], 4_987.0, -16_675.0),
    ([2.0, -1.0, 1.0, 0.0], 4_036.0, -12_831.0),
    ([2.0, 0.0, 2.0, 0.0], 3_994.0, -10_445.0),
    ([4.0, 0.0, 0.0, 0.0], 3_861.0, -11_650.0),
    ([2.0, 0.0, -3.0, 0.0], 3_665.0, 14_403.0),
    ([0.0, 1.0, -2.0, 0.0], -2_689.0, -7_003.0),
    ([2.0, 0.0, -1.0, 2.0], -2_602.0, 0.0),
    ([2.0, -1.0, -2.0, 0.0], 2_390.0, 10_056.0),
    ([1.0, 0.0, 1.0, 0.0], -2_348.0, 6_322.0),
    ([2.0, -2.0, 0.0, 0.0], 2_236.0, -9_884.0),
];

/// Periodic terms of latitude: multiples of D, M, M', F; sine coefficient, 1e-6 degrees. Meeus (1998), Table
/// 47.B, to 0.002 degrees.
const LATITUDE: [([f64; 4], f64); 17] = [
    ([0.0, 0.0, 0.0, 1.0], 5_128_122.0),
    ([0.0, 0.0, 1.0, 1.0], 280_602.0),
    ([0.0, 0.0, 1.0, -1.0], 277_693.0),
    ([2.0, 0.0, 0.0, -1.0], 173_237.0),
    ([2.0, 0.0, -1.0, 1.0], 55_413.0),
    ([2.0, 0.0, -1.0, -1.0], 46_271.0),
    ([2.0, 0.0, 0.0, 1.0], 32_573.0),
    ([0.0, 0.0, 2.0, 1.0], 17_198.0),
    ([2.0, 0.0, 1.0, -1.0], 9_266.0),
    ([0.0, 0.0, 2.0, -1.0], 8_822.0),
    ([2.0, -1.0, 0.0, -1.0], 8_216.0),
    ([2.0, 0.0, -2.0, -1.0], 4_324.0),
    ([2.0, 0.0, 1.0, 1.0], 4_200.0),
    ([2.0, 1.0, 0.0, -1.0], -3_359.0),
    ([2.0, -1.0, -1.0, 1.0], 2_463.0),
    ([2.0, -1.0, 0.0, 1.0], 2_211.0),
    ([2.0, -1.0, -1.0, -1.0], 2_065.0),
];

/// Position of the Moon's centre relative to the Earth's centre, km, ICRS axes; geometric, at `tdb_j2000_s`
/// (s of TDB since J2000.0, see [`super::clock::tdb_j2000_s`]).
///
/// The largest terms of Meeus (1998, Astronomical Algorithms, Ch. 47) in longitude, latitude and distance,
/// with the precession of longitude subtracted (Eq. 21.7, first order). From 1990 to 2050 it agrees with
/// JPL's DE421 to 0.02° and 40 km.
pub fn moon_position_km(tdb_j2000_s: f64) -> Vector3<f64> {
    let t = tdb_j2000_s / CENTURY_S;
    let mean_longitude = 218.316_447_7 + t * (481_267.881_234_21 - t * 0.001_578_6);
    let elongation = 297.850_192_1 + t * (445_267.111_403_4 - t * 0.001_881_9);
    let sun_anomaly = 357.529_109_2 + t * (35_999.050_290_9 - t * 0.000_153_6);
    let moon_anomaly = 134.963_396_4 + t * (477_198.867_505_5 + t * 0.008_741_4);
    let node_argument = 93.272_095_0 + t * (483_202.017_523_3 - t * 0.003_653_9);
    // The eccentricity of the Earth's orbit decreases: terms with the Sun's anomaly M shrink, those with 2 M
    // quadratically.
    let rounder = 1.0 - t * 0.002_516;
    let angle = |[d, m, m1, f]: [f64; 4]| {
        (d * elongation + m * sun_anomaly + m1 * moon_anomaly + f * node_argument).to_radians()
    };
    let factor = |m: f64| match m.abs() {
        1.0 => rounder,
        2.0 => rounder * rounder,
        _ => 1.0,
    };

    // Terms due to Venus and to the flattening of the Earth.
    let venus = (119.75 + 131.849 * t).to_radians();
    let flattening = (mean_longitude - node_argument).to_radians();
    let mut longitude_e6 = 3_958.0 * libm::sin(venus) + 1_962.0 * libm::sin(flattening);
    let mut distance_m = 385_000_560.0;
    for (multiples, sine, cosine) in LONGITUDE_AND_DISTANCE {
        let (sin, cos) = libm::sincos(angle(multiples));
        longitude_e6 += factor(multiples[1]) * sine * sin;
        distance_m += factor(multiples[1]) * cosine * cos;
    }
    let mut latitude_e6 = -2_235.0 * libm::sin(mean_longitude.to_radians());
    for (multiples, sine) in LATITUDE {
        latitude_e6 += factor(multiples[1]) * sine * libm::sin(angle(multiples));
    }

    let precession_deg = t * (1.396_971 + t * 0.000_308_6);
    let (sin_l, cos_l) = libm::sincos((mean_longitude + longitude_e6 * 1e-6 - precession_deg).to_radians());
    let (sin_b, cos_b) = libm::sincos((latitude_e6 * 1e-6).to_radians());
    ecliptic::to_icrs(Vector3::new(cos_b * cos_l, cos_b * sin_l, sin_b) * (distance_m / 1000.0))
}

/// V magnitude of the Moon at mean distance with the Sun at 1 au, at the phase angle `phase_deg` (0 to 180):
/// Krisciunas & Schaefer (1991, PASP 103, 1033, Eq. 9, after Allen). Beyond 150°, where this formula would
/// leave flux at new Moon, it fades like a Lommel–Seeliger sphere; infinite at 180°.
pub fn moon_magnitude(phase_deg: f64) -> f64 {
    let observed = |phase_deg: f64| {
        let square = phase_deg * phase_deg;
        -12.73 + 0.026 * phase_deg.abs() + 4e-9 * square * square
    };
    if phase_deg <= LAST_PHASE_DEG {
        return observed(phase_deg);
    }
    let faded =
        lommel_seeliger_phase(phase_deg.to_radians()) / lommel_seeliger_phase(LAST_PHASE_DEG.to_radians());
    observed(LAST_PHASE_DEG) - 2.5 * libm::log10(faded)
}

/// Phase function of a Lommel–Seeliger sphere, 1 at full phase, 0 at π: 1 − sin(α/2) tan(α/2) ln cot(α/4)
/// (Fairbairn 2005, JRASC 99, 92).
pub fn lommel_seeliger_phase(phase_rad: f64) -> f64 {
    if phase_rad <= 0.0 {
        return 1.0;
    }
    let (sin, cos) = libm::sincos(0.5 * phase_rad);
    if cos <= 0.0 {
        return 0.0;
    }
    (1.0 + sin * sin / cos * libm::log(libm::tan(0.25 * phase_rad))).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Full Moon: a geometric albedo of 0.12 (NASA's Moon Fact Sheet) with a Sun of V = −26.76 (Willmer
    /// 2018). Other phases: Allen, Astrophysical Quantities (3rd ed. 1973), p. 143; the formula smooths this
    /// table to 0.05 mag, at 140° to 0.11 mag.
    #[test]
    fn the_moon_has_its_published_magnitudes() {
        let sine = 1737.4 / 384_400.0;
        let full = -26.76 - 2.5 * libm::log10(0.12 * sine * sine);
        assert!((moon_magnitude(0.0) - full).abs() < 0.02, "{} for {full}", moon_magnitude(0.0));
        for (phase_deg, fainter) in [
            (10.0, 0.23),
            (30.0, 0.79),
            (50.0, 1.35),
            (70.0, 1.91),
            (90.0, 2.63),
            (110.0, 3.48),
            (120.0, 3.93),
            (140.0, 5.07),
            (150.0, 5.9),
        ] {
            let tolerance = if phase_deg <= 120.0 { 0.05 } else { 0.11 };
            let got = moon_magnitude(phase_deg) - moon_magnitude(0.0);
            assert!((got - fainter).abs() < tolerance, "{phase_deg}°: {got}, published {fainter}");
        }
    }

    #[test]
    fn the_new_moon_fades_to_nothing_without_a_step() {
        assert!((moon_magnitude(150.0) - moon_magnitude(150.001)).abs() < 1e-3);
        let magnitudes: Vec<f64> = (0..180).map(|degrees| moon_magnitude(f64::from(degrees))).collect();
        assert!(magnitudes.windows(2).all(|pair| pair[0] < pair[1]));
        // The observed formula, extrapolated to this phase, would give −3.97.
        assert!(moon_magnitude(179.0) > -2.0, "{}", moon_magnitude(179.0));
        assert!(moon_magnitude(180.0) > 10.0);
    }

    /// Meeus, Example 47.a: 1992 April 12, 0h TD: longitude 133.162655°, latitude −3.229126°, 368 409.7 km,
    /// of date.
    #[test]
    fn the_example_of_meeus_comes_out() {
        let tdb_s = (2_448_724.5 - 2_451_545.0) * 86_400.0;
        let ecliptic = ecliptic::from_icrs(moon_position_km(tdb_s));
        let longitude = libm::atan2(ecliptic.y, ecliptic.x).to_degrees();
        let latitude = libm::asin(ecliptic.z / ecliptic.norm()).to_degrees();
        // Precession over 7.72 years is 0.10788°; the omitted terms amount to 0.01° and 30 km.
        assert!((longitude - 0.107_88 - 133.162_655).abs() < 0.02, "{longitude}");
        assert!((latitude + 3.229_126).abs() < 0.01, "{latitude}");
        assert!((ecliptic.norm() - 368_409.7).abs() < 50.0, "{}", ecliptic.norm());
    }
}
