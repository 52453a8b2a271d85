//! The star list that is uploaded to a pipeline.
//!
//! Made on ground from the catalogue: proper motion is applied up to one epoch by the plain formula of an
//! ephemeris table (linear in the angles), and nothing else. The simulator's truth is rigorous; the difference is
//! part of what the oracle measures.

use contract::{Angle, Direction, ListedStar};
use sim::catalog::{Catalog, CatalogStar};

/// Julian years from the catalogue's epoch J1991.25 to J2000.0.
const CATALOG_EPOCH_TO_J2000_YR: f64 = 8.75;
const SECONDS_PER_JULIAN_YEAR: f64 = 31_557_600.0;

/// The stars of `catalog` not fainter than `magnitude_limit` (V), where they are at `tt_j2000_s` (seconds of TT since
/// J2000.0), ordered by number.
pub fn star_list(catalog: &Catalog, magnitude_limit: f64, tt_j2000_s: f64) -> Vec<ListedStar> {
    let years = CATALOG_EPOCH_TO_J2000_YR + tt_j2000_s / SECONDS_PER_JULIAN_YEAR;
    catalog
        .stars()
        .iter()
        .filter(|star| star.v_mag() <= magnitude_limit)
        .map(|star| {
            let (ra_deg, dec_deg) = moved(star, years);
            listed(star.id, ra_deg, dec_deg, star.v_mag())
        })
        .collect()
}

/// A star of the list from its columns in a file. The list is *defined* by these numbers, so that one read back
/// from a file is the same to the bit.
pub fn listed(id: u32, ra_deg: f64, dec_deg: f64, magnitude: f64) -> ListedStar {
    let direction = Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg));
    ListedStar { id, direction, magnitude }
}

/// Right ascension and declination after `years`, degrees.
fn moved(star: &CatalogStar, years: f64) -> (f64, f64) {
    let mas = |value: f64| Angle::from_arcsec(value / 1000.0).degrees();
    let ra_rate = star.pm_ra_mas_per_yr / libm::cos(star.dec_rad);
    let ra_deg = Angle::from_radians(star.ra_rad).degrees() + mas(ra_rate * years);
    let dec_deg = Angle::from_radians(star.dec_rad).degrees() + mas(star.pm_dec_mas_per_yr * years);
    (ra_deg.rem_euclid(360.0), dec_deg.clamp(-90.0, 90.0))
}
