//! Density of the atmosphere after Harris and Priester.
//!
//! Montenbruck & Gill, *Satellite Orbits* (2000), Sec. 3.5.2, Eq. 3.109–3.113 and Table 3.8: mean solar
//! activity, with a diurnal bulge that follows the Sun by 30° of right ascension. Solar and geomagnetic
//! activity have no effect.

use nalgebra::Vector3;

/// Equatorial radius, km, and flattening of WGS 84, above which heights count.
const RADIUS_KM: f64 = 6_378.137;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Lag of the bulge behind the Sun: sine and cosine of 30°.
const LAG: [f64; 2] = [0.5, 0.866_025_403_784_438_6];

/// Height, km, and minimum and maximum density, g/km³ (1e-12 kg/m³).
const TABLE: [[f64; 3]; 50] = [
    [100.0, 497_400.0, 497_400.0],
    [120.0, 24_900.0, 24_900.0],
    [130.0, 8_377.0, 8_710.0],
    [140.0, 3_899.0, 4_059.0],
    [150.0, 2_122.0, 2_215.0],
    [160.0, 1_263.0, 1_344.0],
    [170.0, 800.8, 875.8],
    [180.0, 528.3, 601.0],
    [190.0, 361.7, 429.7],
    [200.0, 255.7, 316.2],
    [210.0, 183.9, 239.6],
    [220.0, 134.1, 185.3],
    [230.0, 99.49, 145.5],
    [240.0, 74.88, 115.7],
    [250.0, 57.09, 93.08],
    [260.0, 44.03, 75.55],
    [270.0, 34.3, 61.82],
    [280.0, 26.97, 50.95],
    [290.0, 21.39, 42.26],
    [300.0, 17.08, 35.26],
    [320.0, 10.99, 25.11],
    [340.0, 7.214, 18.19],
    [360.0, 4.824, 13.37],
    [380.0, 3.274, 9.955],
    [400.0, 2.249, 7.492],
    [420.0, 1.558, 5.684],
    [440.0, 1.091, 4.355],
    [460.0, 0.7701, 3.362],
    [480.0, 0.5474, 2.612],
    [500.0, 0.3916, 2.042],
    [520.0, 0.2819, 1.605],
    [540.0, 0.2042, 1.267],
    [560.0, 0.1488, 1.005],
    [580.0, 0.1092, 0.7997],
    [600.0, 0.0807, 0.639],
    [620.0, 0.06012, 0.5123],
    [640.0, 0.04519, 0.4121],
    [660.0, 0.0343, 0.3325],
    [680.0, 0.02632, 0.2691],
    [700.0, 0.02043, 0.2185],
    [720.0, 0.01607, 0.1779],
    [740.0, 0.01281, 0.1452],
    [760.0, 0.01036, 0.119],
    [780.0, 0.008496, 0.09776],
    [800.0, 0.007069, 0.08059],
    [840.0, 0.00468, 0.05741],
    [880.0, 0.0032, 0.0421],
    [920.0, 0.00221, 0.0313],
    [960.0, 0.00156, 0.0236],
    [1_000.0, 0.00115, 0.0181],
];

/// Density, kg/m³, at an Earth-fixed position, km, with the Sun in the direction `sun` (of any length, same
/// axes). `exponent` is n of cosⁿ(ψ/2), from 2 (low inclination) to 6 (polar orbit). 0 above 1000 km; below
/// 100 km the value at 100 km.
pub(super) fn density_kg_m3(position_km: &Vector3<f64>, sun: &Vector3<f64>, exponent: f64) -> f64 {
    let height_km = height_km(position_km).max(TABLE[0][0]);
    let next = TABLE.partition_point(|row| row[0] <= height_km);
    let (Some(below), Some(above)) = (TABLE.get(next.wrapping_sub(1)), TABLE.get(next)) else { return 0.0 };
    let share = (height_km - below[0]) / (above[0] - below[0]);
    // Exponential between the heights of the table.
    let between = |column: usize| {
        let (lower, upper): (f64, f64) = (below[column], above[column]);
        lower * libm::exp(share * libm::log(upper / lower))
    };
    let (minimum, maximum) = (between(1), between(2));
    let [sin, cos] = LAG;
    let bulge = Vector3::new(cos * sun.x - sin * sun.y, sin * sun.x + cos * sun.y, sun.z);
    let cos_psi = position_km.dot(&bulge) / (position_km.norm() * bulge.norm());
    // cos²(ψ/2) = (1 + cos ψ)/2.
    let square = (0.5 + 0.5 * cos_psi).max(0.0);
    (minimum + (maximum - minimum) * libm::pow(square, 0.5 * exponent)) * 1e-12
}

/// Height above the ellipsoid, km, along the line to the Earth's centre. It exceeds the height along the
/// normal by at most 5 m at 1000 km: 1e-4 of the density.
fn height_km(position_km: &Vector3<f64>) -> f64 {
    let distance_km = position_km.norm();
    let sine = position_km.z / distance_km;
    let eccentricity2 = FLATTENING * (2.0 - FLATTENING);
    let surface_km = RADIUS_KM * ((1.0 - eccentricity2) / (1.0 - eccentricity2 * (1.0 - sine * sine))).sqrt();
    distance_km - surface_km
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_height_is_that_above_the_ellipsoid() {
        let polar_km = RADIUS_KM * (1.0 - FLATTENING);
        assert!((height_km(&Vector3::new(0.0, 0.0, -polar_km - 700.0)) - 700.0).abs() < 1e-9);
        assert!((height_km(&Vector3::new(0.0, RADIUS_KM + 700.0, 0.0)) - 700.0).abs() < 1e-9);
        // A point above the geodetic latitude 45°, 700 km along the normal.
        let eccentricity2 = FLATTENING * (2.0 - FLATTENING);
        let normal_km = RADIUS_KM / (1.0 - 0.5 * eccentricity2).sqrt();
        let cosine = std::f64::consts::FRAC_1_SQRT_2;
        let equatorial_km = (normal_km + 700.0) * cosine;
        let axial_km = (normal_km * (1.0 - eccentricity2) + 700.0) * cosine;
        let error_km = height_km(&Vector3::new(equatorial_km, 0.0, axial_km)) - 700.0;
        assert!((0.0..5e-3).contains(&error_km), "{error_km}");
    }

    /// Rows of the table, and the geometric mean half-way between two of them.
    #[test]
    fn the_density_has_its_extremes_at_the_bulge_and_opposite() {
        let at = |height_km: f64, exponent| {
            let sun = Vector3::new(0.866_025_403_784_438_6, -0.5, 0.0);
            let position = Vector3::new(RADIUS_KM + height_km, 0.0, 0.0);
            // With the Sun 30° behind the position the bulge is above it.
            (density_kg_m3(&position, &sun, exponent), density_kg_m3(&-position, &sun, exponent))
        };
        let (maximum, minimum) = at(500.0, 4.0);
        assert!((maximum / 2.042e-12 - 1.0).abs() < 1e-9 && (minimum / 3.916e-13 - 1.0).abs() < 1e-9);
        let (maximum, minimum) = at(730.0, 6.0);
        assert!((maximum / (1.779e-13_f64 * 1.452e-13).sqrt() - 1.0).abs() < 1e-9);
        assert!((minimum / (1.607e-14_f64 * 1.281e-14).sqrt() - 1.0).abs() < 1e-9);
        assert_eq!(at(1000.5, 4.0).0, 0.0);
        assert!((at(50.0, 4.0).0 / 4.974e-7 - 1.0).abs() < 1e-9);
    }
}
