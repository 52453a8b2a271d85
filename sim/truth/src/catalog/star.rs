//! Star of a catalogue.

use contract::{Angle, Direction, Icrs};
use nalgebra::Vector3;

use super::photometry;

/// Star as catalogued: ICRS, epoch J1991.25 (TT).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogStar {
    /// Hipparcos number, or the number in the user's catalogue.
    pub id: u32,
    /// Right ascension at J1991.25, rad.
    pub ra_rad: f64,
    /// Declination at J1991.25, rad.
    pub dec_rad: f64,
    /// Parallax, mas; may be negative as published.
    pub parallax_mas: f64,
    /// Proper motion in right ascension times cos δ, mas per Julian year.
    pub pm_ra_mas_per_yr: f64,
    /// Proper motion in declination, mas per Julian year.
    pub pm_dec_mas_per_yr: f64,
    /// Radial velocity, km/s, positive for recession; 0 if unknown.
    pub radial_velocity_km_s: f64,
    /// Magnitude in the Hipparcos band.
    pub hp_mag: f64,
    /// Colour index B−V, mag, never NaN; `None` if unknown.
    pub b_v: Option<f64>,
    /// Colour index V−I, mag; `None` if unknown.
    pub v_i: Option<f64>,
}

/// Epoch of the catalogue, Julian year (TT).
pub(super) const CATALOG_EPOCH_JYR: f64 = 1991.25;

/// An astronomical unit per Julian year, km/s.
const AU_PER_YEAR_KM_S: f64 = 4.740_470_463_533_349;

/// Milliarcsecond, rad.
const MAS: f64 = std::f64::consts::PI / 648_000_000.0;

impl CatalogStar {
    /// Returns a star whose values are those at `epoch_jyr`, a Julian year (TT), at the catalogue's epoch: in
    /// straight and uniform space motion, without light time (ESA 1997, SP-1200, Vol. 1, Sec. 1.5.5). A star
    /// without a positive parallax moves across the line of sight.
    pub(super) fn at_catalog_epoch(self, epoch_jyr: f64) -> Self {
        let years = CATALOG_EPOCH_JYR - epoch_jyr;
        if years == 0.0 {
            return self;
        }
        let parallax_rad = self.parallax_mas.max(0.0) * MAS;
        // Motion per year in units of the distance at `epoch_jyr`.
        let radial = self.radial_velocity_km_s / AU_PER_YEAR_KM_S * parallax_rad;
        let from = *self.direction().vector();
        let [east, north] = tangents(self.ra_rad, self.dec_rad);
        let motion = (east * self.pm_ra_mas_per_yr + north * self.pm_dec_mas_per_yr) * MAS + from * radial;
        let moved = from + motion * years;
        let distance = moved.norm();
        let direction = moved / distance;
        let ra_rad = libm::atan2(direction.y, direction.x).rem_euclid(std::f64::consts::TAU);
        let dec_rad = libm::atan2(direction.z, libm::hypot(direction.x, direction.y));
        let [east, north] = tangents(ra_rad, dec_rad);
        let motion = motion / distance;
        let radial_velocity_km_s = if parallax_rad > 0.0 {
            motion.dot(&direction) * distance / parallax_rad * AU_PER_YEAR_KM_S
        } else {
            self.radial_velocity_km_s
        };
        Self {
            ra_rad,
            dec_rad,
            parallax_mas: self.parallax_mas / distance,
            pm_ra_mas_per_yr: motion.dot(&east) / MAS,
            pm_dec_mas_per_yr: motion.dot(&north) / MAS,
            radial_velocity_km_s,
            ..self
        }
    }

    /// Direction at the catalogue's epoch.
    pub fn direction(&self) -> Direction<Icrs> {
        Direction::from_ra_dec(Angle::from_radians(self.ra_rad), Angle::from_radians(self.dec_rad))
    }

    /// Johnson V, mag, computed by [`photometry::v_mag`], whose limits apply.
    pub fn v_mag(&self) -> f64 {
        photometry::v_mag(self.hp_mag, self.b_v)
    }
}

/// Unit vectors to the east and to the north at a position.
fn tangents(ra_rad: f64, dec_rad: f64) -> [Vector3<f64>; 2] {
    let ((sin_ra, cos_ra), (sin_dec, cos_dec)) = (libm::sincos(ra_rad), libm::sincos(dec_rad));
    [Vector3::new(-sin_ra, cos_ra, 0.0), Vector3::new(-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Barnard's star at J2016.0 (Gaia DR3 4472832130942575872), and its Hipparcos-2 position of J1991.25.
    #[test]
    fn the_position_of_a_fast_star_of_2016_is_that_of_1991() {
        let star = CatalogStar {
            id: 87937,
            ra_rad: 269.448_502_525_438_36_f64.to_radians(),
            dec_rad: 4.739_420_051_112_412_f64.to_radians(),
            parallax_mas: 546.975_939_730_948,
            pm_ra_mas_per_yr: -801.550_977_872_7,
            pm_dec_mas_per_yr: 10_362.394_206_546_573,
            radial_velocity_km_s: -110.11,
            hp_mag: 9.5,
            b_v: None,
            v_i: None,
        };
        let moved = star.at_catalog_epoch(2016.0);
        // Hipparcos-2 (CDS I/311), HIP 87937: 269.454 023 05° and 4.668 288 15° at J1991.25.
        let arcsec = |rad: f64, deg: f64| (rad.to_degrees() - deg) * 3_600.0;
        assert!(arcsec(moved.ra_rad, 269.454_023_05).abs() < 0.05, "{}", moved.ra_rad.to_degrees());
        assert!(arcsec(moved.dec_rad, 4.668_288_15).abs() < 0.05, "{}", moved.dec_rad.to_degrees());
        // The parallax grows as the star approaches: 110 km/s in 24.75 years are 581 au of 377 000 au.
        let growth = star.parallax_mas / moved.parallax_mas - 1.0;
        assert!(
            (growth - 110.11 / AU_PER_YEAR_KM_S * 24.75 * star.parallax_mas * MAS).abs() < 3e-5,
            "{growth}"
        );
        // Unchanged at the epoch itself.
        assert_eq!(star.at_catalog_epoch(CATALOG_EPOCH_JYR), star);
    }

    #[test]
    fn a_star_without_a_parallax_moves_on_a_great_circle() {
        let star = CatalogStar {
            id: 1,
            ra_rad: 0.0,
            dec_rad: 0.0,
            parallax_mas: 0.0,
            pm_ra_mas_per_yr: 1_000.0,
            pm_dec_mas_per_yr: 0.0,
            radial_velocity_km_s: 30.0,
            hp_mag: 9.5,
            b_v: None,
            v_i: None,
        };
        let moved = star.at_catalog_epoch(2091.25);
        let expected = std::f64::consts::TAU - libm::atan(100_000.0 * MAS);
        assert!((moved.ra_rad - expected).abs() < 1e-12 && moved.dec_rad.abs() < 1e-15);
        assert_eq!((moved.parallax_mas, moved.radial_velocity_km_s), (0.0, 30.0));
    }
}
