//! Expected number of stars in the image that the star list lacks, by brightness.

use contract::ListedStar;

/// Exponent of the cumulative number of stars by flux, N(> F) ∝ F^−1.2 (Allen 1973, Astrophysical Quantities,
/// §117).
pub(super) const STAR_EXPONENT: f64 = 1.2;

/// Rank of the magnitude that counts as the limit of the list, as a fraction: single fainter stars do not
/// make a list complete to their brightness.
const LIMIT_RANK: f64 = 0.9;

/// Brightness above the list's limit over which the fraction of missing stars decreases by e, mag: stars are
/// listed by V, and red ones are brighter for silicon.
const MISSING_MAG: f64 = 0.5;

/// Smallest fraction of missing stars: variable stars, planets, errors of the list.
const MISSING_FRACTION: f64 = 0.003;

/// Number of stars brighter than the detection threshold if no star of the list is in the image.
const WITHOUT_LIST: f64 = 3.0;

/// Returns the magnitude that counts as the limit of a star list; `None` for an empty list.
pub(super) fn magnitude_limit(stars: &[ListedStar]) -> Option<f64> {
    let mut magnitudes: Vec<f64> = stars.iter().map(|star| star.magnitude).collect();
    let rank = (LIMIT_RANK * magnitudes.len() as f64) as usize;
    (rank < magnitudes.len()).then(|| *magnitudes.select_nth_unstable_by(rank, f64::total_cmp).1)
}

/// Distribution of the unlisted stars in a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnlistedStars {
    /// Expected number of all stars in the image brighter than `reference_e`.
    pub(super) count: f64,
    /// Flux, electrons.
    pub(super) reference_e: f64,
    /// True if the stars brighter than `reference_e`, the limit of the list, are identified by the list.
    pub(super) is_listed: bool,
}

impl UnlistedStars {
    /// Creates the distribution for a frame.
    ///
    /// `limit_e` is the flux of a star at the limit of the list, electrons, if the scale of brightness is
    /// known; `listed` is the number of listed stars in the image, `is_matched` true if some were found:
    /// without them a cluster may be any star of the list.
    pub(super) fn new(listed: usize, is_matched: bool, limit_e: Option<f64>, threshold_e: f64) -> Self {
        match limit_e {
            Some(limit_e) if listed > 0 => {
                Self { count: listed as f64, reference_e: limit_e.max(1e-9), is_listed: is_matched }
            }
            _ => Self {
                count: WITHOUT_LIST.max(listed as f64),
                reference_e: threshold_e.max(1e-9),
                is_listed: false,
            },
        }
    }

    /// Returns the expected number of unlisted stars in the image per unit of ln F at a flux, electrons.
    pub(super) fn per_log_flux(&self, flux_e: f64) -> f64 {
        let log_ratio = libm::log(flux_e.max(1e-9) / self.reference_e);
        let all = self.count * STAR_EXPONENT * libm::exp(-STAR_EXPONENT * log_ratio);
        let brighter_mag = 2.5 * log_ratio / std::f64::consts::LN_10;
        let missing = libm::exp(-brighter_mag / MISSING_MAG).clamp(MISSING_FRACTION, 1.0);
        if self.is_listed { all * missing } else { all }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_lacks_the_stars_beyond_its_limit_and_few_before_it() {
        let stars = UnlistedStars::new(20, true, Some(1000.0), 500.0);
        // All stars have N(> F) = 20 (F/1000)^−1.2, so 24 per unit of ln F at the limit.
        assert!((stars.per_log_flux(1000.0) - 24.0).abs() < 1e-9);
        assert!((stars.per_log_flux(100.0) - 24.0 * libm::pow(10.0, 1.2)).abs() < 1e-6);
        assert!(stars.per_log_flux(10_000.0) < 0.02);
    }

    #[test]
    fn without_a_brightness_scale_any_star_may_be_missing() {
        let stars = UnlistedStars::new(20, true, None, 500.0);
        assert!((stars.per_log_flux(500.0) - 24.0).abs() < 1e-9);
        assert!(stars.per_log_flux(5000.0) > 1.0);
    }
}
