//! Zodiacal light by position in the sky, as seen from the Earth.

use nalgebra::Vector3;
use truth::ecliptic;

/// Ecliptic longitudes of the rows, relative to the Sun, degrees.
const LONGITUDES_DEG: [f64; 19] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0,
    165.0, 180.0,
];
/// Ecliptic latitudes of the columns, degrees.
const LATITUDES_DEG: [f64; 11] = [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 45.0, 60.0, 75.0, 90.0];

/// Brightness at 500 nm, 1e-8 W m⁻² sr⁻¹ µm⁻¹ (Leinert et al. 1998, A&AS 127, 1, Table 17). The table has no
/// values within 10° of the Sun; the largest value, that of 15°, is used there. The real brightness increases
/// further, and a camera so near the Sun is blinded.
#[rustfmt::skip]
const TABLE: [[f64; 11]; 19] = [
    [11500.0, 11500.0, 11500.0, 3140.0, 1610.0, 985.0, 640.0, 275.0, 150.0, 100.0, 77.0],
    [11500.0, 11500.0, 11500.0, 2940.0, 1540.0, 945.0, 625.0, 271.0, 150.0, 100.0, 77.0],
    [11500.0, 11500.0, 4740.0, 2470.0, 1370.0, 865.0, 590.0, 264.0, 148.0, 100.0, 77.0],
    [11500.0, 6780.0, 3440.0, 1860.0, 1110.0, 755.0, 525.0, 251.0, 146.0, 100.0, 77.0],
    [6400.0, 4480.0, 2410.0, 1410.0, 910.0, 635.0, 454.0, 237.0, 141.0, 99.0, 77.0],
    [3840.0, 2830.0, 1730.0, 1100.0, 749.0, 545.0, 410.0, 223.0, 136.0, 97.0, 77.0],
    [2480.0, 1870.0, 1220.0, 845.0, 615.0, 467.0, 365.0, 207.0, 131.0, 95.0, 77.0],
    [1650.0, 1270.0, 910.0, 680.0, 510.0, 397.0, 320.0, 193.0, 125.0, 93.0, 77.0],
    [1180.0, 940.0, 700.0, 530.0, 416.0, 338.0, 282.0, 179.0, 120.0, 92.0, 77.0],
    [910.0, 730.0, 555.0, 442.0, 356.0, 292.0, 250.0, 166.0, 116.0, 90.0, 77.0],
    [505.0, 442.0, 352.0, 292.0, 243.0, 209.0, 183.0, 134.0, 104.0, 86.0, 77.0],
    [338.0, 317.0, 269.0, 227.0, 196.0, 172.0, 151.0, 116.0, 93.0, 82.0, 77.0],
    [259.0, 251.0, 225.0, 193.0, 166.0, 147.0, 132.0, 104.0, 86.0, 79.0, 77.0],
    [212.0, 210.0, 197.0, 170.0, 150.0, 133.0, 119.0, 96.0, 82.0, 77.0, 77.0],
    [188.0, 186.0, 177.0, 154.0, 138.0, 125.0, 113.0, 90.0, 77.0, 74.0, 77.0],
    [179.0, 178.0, 166.0, 147.0, 134.0, 122.0, 110.0, 90.0, 77.0, 73.0, 77.0],
    [179.0, 178.0, 165.0, 148.0, 137.0, 127.0, 116.0, 96.0, 79.0, 72.0, 77.0],
    [196.0, 192.0, 179.0, 165.0, 151.0, 141.0, 131.0, 104.0, 82.0, 72.0, 77.0],
    [230.0, 212.0, 195.0, 178.0, 163.0, 148.0, 134.0, 105.0, 83.0, 72.0, 77.0],
];

/// One S10⊙ at 500 nm in the unit of the table (Leinert et al. 1998, Table 2): 60 S10⊙ are 77 at the pole.
const TABLE_UNITS_PER_S10: f64 = 1.28;

/// Surface brightness in S10⊙ (Sun-like stars of V = 10 per square degree) in the direction `direction`, with
/// the Sun in the direction `sun`; unit vectors, ICRS axes. Bilinear in longitude from the Sun and latitude,
/// symmetric between north and south.
pub(super) fn zodiacal_s10(direction: &Vector3<f64>, sun: &Vector3<f64>) -> f64 {
    let (direction, sun) = (ecliptic::from_icrs(*direction), ecliptic::from_icrs(*sun));
    let latitude_deg = libm::atan2(direction.z.abs(), libm::hypot(direction.x, direction.y)).to_degrees();
    // Angle between the projections on the ecliptic; 0 at the pole, where it is irrelevant.
    let longitude_deg = libm::atan2(
        (sun.x * direction.y - sun.y * direction.x).abs(),
        sun.x * direction.x + sun.y * direction.y,
    )
    .to_degrees();
    let (row, down) = interval(&LONGITUDES_DEG, longitude_deg);
    let (column, across) = interval(&LATITUDES_DEG, latitude_deg);
    let along = |row: usize| TABLE[row][column] + across * (TABLE[row][column + 1] - TABLE[row][column]);
    (along(row) + down * (along(row + 1) - along(row))) / TABLE_UNITS_PER_S10
}

/// Returns the interval of increasing `nodes` that contains `x`, and the relative position in the interval, 0
/// to 1.
fn interval(nodes: &[f64], x: f64) -> (usize, f64) {
    let first = nodes.partition_point(|node| *node <= x).clamp(1, nodes.len() - 1) - 1;
    (first, ((x - nodes[first]) / (nodes[first + 1] - nodes[first])).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sky(longitude_deg: f64, latitude_deg: f64) -> Vector3<f64> {
        let (sin_l, cos_l) = libm::sincos(longitude_deg.to_radians());
        let (sin_b, cos_b) = libm::sincos(latitude_deg.to_radians());
        ecliptic::to_icrs(Vector3::new(cos_b * cos_l, cos_b * sin_l, sin_b))
    }

    fn s10(from_sun_deg: f64, latitude_deg: f64) -> f64 {
        zodiacal_s10(&sky(40.0 + from_sun_deg, latitude_deg), &sky(40.0, 0.0))
    }

    /// Compares with Table 16 of the same paper, in S10⊙: two tables of one source reveal a wrong digit or
    /// unit.
    #[test]
    fn the_values_are_those_of_the_table_in_s10() {
        for (from_sun, latitude, published) in [
            (180.0, 0.0, 180.0),
            (90.0, 0.0, 202.0),
            (90.0, 90.0, 60.0),
            (30.0, 0.0, 1940.0),
            (60.0, 30.0, 143.0),
            (135.0, 45.0, 70.0),
        ] {
            let ours = s10(from_sun, latitude);
            // Table 16 is rounded to two or three digits.
            assert!(
                (ours - published).abs() < 0.015 * published,
                "{from_sun}, {latitude}: {ours} for {published}"
            );
        }
    }

    #[test]
    fn east_and_west_and_north_and_south_are_alike() {
        for (from_sun, latitude) in [(33.0, 7.0), (77.0, 51.0), (171.0, 2.0)] {
            let reference = s10(from_sun, latitude);
            for (a, b) in [(from_sun, -latitude), (-from_sun, latitude), (-from_sun, -latitude)] {
                assert!((s10(a, b) - reference).abs() < 1e-9 * reference);
            }
        }
    }

    #[test]
    fn there_are_no_steps_in_the_sky() {
        for i in 0..3600 {
            let longitude = f64::from(i) * 0.1;
            for latitude in [-80.0, -20.0, 0.5, 33.0, 89.9] {
                let (here, next) = (s10(longitude, latitude), s10(longitude + 0.001, latitude));
                // The steepest slope of the table is 1000 units per degree.
                assert!((next - here).abs() < 1.5, "{longitude}, {latitude}: {here}, {next}");
            }
        }
    }
}
