//! Star list that is uploaded to a pipeline.
//!
//! The list is made on ground from the catalogue. Only proper motion is applied, up to one epoch, by the
//! plain formula of an ephemeris table (linear in the angles). The simulator's truth is rigorous; the
//! difference is part of the error that the oracle measures.
use contract::Angle;
use hifitime::Epoch;
use sim::catalog::{Catalog, CatalogStar};
use sim::truth::clock;

use crate::rows::StarRow;

/// Julian years from the catalogue's epoch J1991.25 to J2000.0.
const CATALOG_EPOCH_TO_J2000_YR: f64 = 8.75;
const SECONDS_PER_JULIAN_YEAR: f64 = 31_557_600.0;

/// Returns the stars of `catalog` not fainter than `magnitude_limit` (V), at their positions at `epoch`,
/// ordered by number.
pub fn star_list(catalog: &Catalog, magnitude_limit: f64, epoch: Epoch) -> Vec<StarRow> {
    let years = CATALOG_EPOCH_TO_J2000_YR + clock::tt_j2000_s(epoch) / SECONDS_PER_JULIAN_YEAR;
    let stars = catalog.stars().iter().filter(|star| star.v_mag() <= magnitude_limit);
    stars.map(|star| moved(star, years)).collect()
}

/// Returns a star after `years` of proper motion.
fn moved(star: &CatalogStar, years: f64) -> StarRow {
    let degrees = |mas_per_yr: f64| Angle::from_arcsec(mas_per_yr * years / 1000.0).degrees();
    let ra_deg =
        Angle::from_radians(star.ra_rad).degrees() + degrees(star.pm_ra_mas_per_yr / libm::cos(star.dec_rad));
    let dec_deg = Angle::from_radians(star.dec_rad).degrees() + degrees(star.pm_dec_mas_per_yr);
    StarRow {
        id: star.id,
        ra_deg: ra_deg.rem_euclid(360.0),
        dec_deg: dec_deg.clamp(-90.0, 90.0),
        magnitude: star.v_mag(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::parse_utc;

    /// Barnard's star, the star with the largest proper motion. SIMBAD gives its Hipparcos-2 position at
    /// J2000.0 as 17 57 48.49803 +04 41 36.2072.
    #[test]
    fn proper_motion_is_applied_up_to_the_epoch() {
        let list = star_list(&Catalog::hipparcos2(), 10.0, parse_utc("2000-01-01T11:58:55.816Z").unwrap());
        let barnard = list.iter().find(|star| star.id == 87937).unwrap();
        let arcsec = |degrees: f64| degrees * 3600.0;
        // 1 mas: the rounding of the published position.
        assert!(arcsec(barnard.ra_deg - (269.0 + 27.0 / 60.0 + 7.47045 / 3600.0)).abs() < 0.001);
        assert!(arcsec(barnard.dec_deg - (4.0 + 41.0 / 60.0 + 36.2072 / 3600.0)).abs() < 0.001);
    }

    #[test]
    fn the_list_ends_at_its_limit_and_ascends() {
        let list = star_list(&Catalog::hipparcos2(), 4.0, parse_utc("2012-04-23T00:00:00Z").unwrap());
        assert!(list.iter().all(|star| star.magnitude <= 4.0));
        assert!(list.is_sorted_by_key(|star| star.id));
        // The Yale Bright Star Catalogue has about 510 stars to V = 4.0.
        assert!((450..600).contains(&list.len()), "{}", list.len());
    }
}
