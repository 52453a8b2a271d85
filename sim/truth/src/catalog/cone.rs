//! Search for the stars within a cone.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::RangeInclusive;

use contract::{Angle, Direction, Icrs};

use super::CatalogStar;

/// Number of bands of equal height in z, hence of equal area.
const BANDS: usize = 64;
/// Number of cells in a band, of equal width in right ascension: with 118 000 stars a cell holds 14 stars.
const CELLS: usize = 128;
/// Margin by which the search for candidates is wider than the cone, rad. It covers every rounding error of
/// the search, and costs nothing: [`within_cone`] decides whether a candidate is inside.
const MARGIN_RAD: f64 = 1e-7;

/// Index of directions on a grid of z and right ascension.
///
/// The results equal those of testing every star, in all cases: the poles, α = 0, radii from 0 to 180° and
/// beyond.
#[derive(Debug, Clone)]
pub struct ConeIndex {
    /// Direction and index of each star, sorted by cell.
    entries: Vec<(Direction<Icrs>, u32)>,
    /// Start of each cell's entries, and the total count as last element.
    starts: Vec<u32>,
}

impl ConeIndex {
    /// Indexes the stars' directions at the catalogue's epoch.
    pub fn new(stars: &[CatalogStar]) -> Self {
        Self::from_directions(stars.iter().map(CatalogStar::direction))
    }

    /// Indexes any directions, at most 2³² − 1, for example those of stars moved to another epoch.
    pub fn from_directions(directions: impl IntoIterator<Item = Direction<Icrs>>) -> Self {
        let mut celled: Vec<(usize, Direction<Icrs>, u32)> = directions
            .into_iter()
            .zip(0_u32..)
            .map(|(direction, index)| {
                let v = direction.vector();
                (band(v.z) * CELLS + cell(libm::atan2(v.y, v.x)), direction, index)
            })
            .collect();
        // A stable sort: within a cell the stars stay in the order of their indices.
        celled.sort_by_key(|(cell, ..)| *cell);
        let mut starts = vec![0_u32; BANDS * CELLS + 1];
        for (cell, ..) in &celled {
            starts[cell + 1] += 1;
        }
        for cell in 0..BANDS * CELLS {
            starts[cell + 1] += starts[cell];
        }
        let entries = celled.into_iter().map(|(_, direction, index)| (direction, index)).collect();
        Self { entries, starts }
    }

    /// Returns the indices of the stars within `radius` of `centre`, ascending; the boundary belongs to the
    /// cone. A negative radius holds no star, a radius of 180° or more every star.
    pub fn within(&self, centre: &Direction<Icrs>, radius: Angle) -> Vec<usize> {
        let mut found = Vec::new();
        self.within_into(centre, radius, &mut found);
        found
    }

    /// Writes the result of [`ConeIndex::within`] to a buffer, which is cleared first and can be reused.
    pub fn within_into(&self, centre: &Direction<Icrs>, radius: Angle, found: &mut Vec<usize>) {
        found.clear();
        if radius.radians().is_nan() || radius.radians() < 0.0 {
            return;
        }
        let inside = Cone::new(centre, radius);
        let mut scan = |first: usize, last: usize| {
            let entries = &self.entries[self.starts[first] as usize..self.starts[last + 1] as usize];
            found.extend(
                entries.iter().filter(|(star, _)| inside.contains(star)).map(|(_, index)| *index as usize),
            );
        };
        let Candidates { bands, cells } = Candidates::from_centre(centre, radius);
        for first in bands.map(|band| band * CELLS) {
            let (from, to) = cells;
            if from <= to {
                scan(first + from, first + to);
            } else {
                scan(first, first + to);
                scan(first + from, first + CELLS - 1);
            }
        }
        sort(found, self.entries.len());
    }
}

/// Returns true if a star lies in the cone: the definition that the index must reproduce.
pub(super) fn within_cone(centre: &Direction<Icrs>, star: &Direction<Icrs>, radius: Angle) -> bool {
    radius.radians() >= 0.0 && Cone::new(centre, radius).contains(star)
}

/// Cone prepared for comparison with many stars.
///
/// Up to 90° the chord to the centre is compared, beyond 90° the chord to the antipode: a dot product would
/// lose half of the digits near 0 and 180°.
enum Cone {
    NearCentre { centre: [f64; 3], chord_squared: f64 },
    AwayFromAntipode { antipode: [f64; 3], chord_squared: f64 },
    Everything,
}

impl Cone {
    fn new(centre: &Direction<Icrs>, radius: Angle) -> Self {
        let v = centre.vector();
        let square = |x: f64| x * x;
        match radius.radians() {
            r if r >= PI => Self::Everything,
            r if r > FRAC_PI_2 => Self::AwayFromAntipode {
                antipode: [-v.x, -v.y, -v.z],
                chord_squared: square(2.0 * libm::cos(r / 2.0)),
            },
            r => {
                Self::NearCentre { centre: [v.x, v.y, v.z], chord_squared: square(2.0 * libm::sin(r / 2.0)) }
            }
        }
    }

    fn contains(&self, star: &Direction<Icrs>) -> bool {
        let chord_squared = |[x, y, z]: &[f64; 3]| {
            let v = star.vector();
            let (dx, dy, dz) = (v.x - x, v.y - y, v.z - z);
            dx * dx + dy * dy + dz * dz
        };
        match self {
            Self::NearCentre { centre, chord_squared: limit } => chord_squared(centre) <= *limit,
            Self::AwayFromAntipode { antipode, chord_squared: limit } => chord_squared(antipode) >= *limit,
            Self::Everything => true,
        }
    }
}

/// Part of the grid that holds every star of a cone.
struct Candidates {
    bands: RangeInclusive<usize>,
    /// First and last cell; the interval crosses α = ±180° if the first is after the last.
    cells: (usize, usize),
}

impl Candidates {
    fn from_centre(centre: &Direction<Icrs>, radius: Angle) -> Self {
        let (dec, radius) = (centre.dec().radians(), (radius.radians() + MARGIN_RAD).min(PI));
        let (low, high) = (dec - radius, dec + radius);
        // The sine is flat at the poles, where a declination determines z poorly: the end bands are exact
        // there.
        let bottom = if low <= -FRAC_PI_2 { 0 } else { band(libm::sin(low)) };
        let top = if high >= FRAC_PI_2 { BANDS - 1 } else { band(libm::sin(high)) };
        let cells = if low <= -FRAC_PI_2 || high >= FRAC_PI_2 {
            (0, CELLS - 1)
        } else {
            // Meridians that touch the circle: sin Δα = sin r / cos δ; without a pole inside, r < 90° −
            // |δ|.
            let half_width = libm::asin((libm::sin(radius) / libm::cos(dec)).min(1.0)) + MARGIN_RAD;
            let ra = libm::atan2(centre.vector().y, centre.vector().x);
            (cell(ra - half_width), cell(ra + half_width))
        };
        Self { bands: bottom..=top, cells }
    }
}

fn band(z: f64) -> usize {
    (((z + 1.0) * (BANDS as f64 / 2.0)) as usize).min(BANDS - 1)
}

/// Cell of a right ascension within one and a half turns of 0. Cell 0 starts at −180°.
fn cell(ra: f64) -> usize {
    let turns = ra / TAU + 0.5;
    (((turns - turns.floor()) * CELLS as f64) as usize).min(CELLS - 1)
}

/// Sorts distinct indices below `count`. Large sets are sorted with a bitmap, which is faster than comparing.
fn sort(indices: &mut Vec<usize>, count: usize) {
    if indices.len() < count / 512 {
        indices.sort_unstable();
        return;
    }
    let mut bitmap = vec![0_u64; count.div_ceil(64)];
    for index in indices.drain(..) {
        bitmap[index / 64] |= 1 << (index % 64);
    }
    for (word, mut bits) in bitmap.into_iter().enumerate() {
        while bits != 0 {
            indices.push(word * 64 + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::super::Catalog;
    use super::*;

    fn direction(ra_deg: f64, dec_deg: f64) -> Direction<Icrs> {
        Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg))
    }

    /// Tests every star, without an index.
    fn brute_force(stars: &[Direction<Icrs>], centre: &Direction<Icrs>, radius: Angle) -> Vec<usize> {
        (0..stars.len()).filter(|index| within_cone(centre, &stars[*index], radius)).collect()
    }

    fn check(stars: &[Direction<Icrs>], centre: &Direction<Icrs>, radius: Angle) {
        let found = ConeIndex::from_directions(stars.iter().copied()).within(centre, radius);
        assert_eq!(found, brute_force(stars, centre, radius), "{centre:?} {radius:?}");
    }

    fn sky() -> &'static (Vec<Direction<Icrs>>, ConeIndex) {
        static SKY: OnceLock<(Vec<Direction<Icrs>>, ConeIndex)> = OnceLock::new();
        SKY.get_or_init(|| {
            let catalog = Catalog::hipparcos2();
            let directions = catalog.stars().iter().map(CatalogStar::direction).collect();
            (directions, ConeIndex::new(catalog.stars()))
        })
    }

    /// Directions at which an index may fail: poles and their neighbourhood, the seam of right ascension, the
    /// edges of cells.
    fn directions() -> impl Strategy<Value = Direction<Icrs>> {
        let ra =
            prop_oneof![Just(0.0), Just(180.0), 359.999..360.0_f64, 179.999..180.001_f64, 0.0..360.0_f64];
        let dec = prop_oneof![
            Just(90.0),
            Just(-90.0),
            Just(0.0),
            89.999999..90.0_f64,
            -90.0..-89.9999_f64,
            -90.0..90.0_f64
        ];
        (ra, dec).prop_map(|(ra, dec)| direction(ra, dec))
    }

    fn radii() -> impl Strategy<Value = Angle> {
        let degrees = prop_oneof![
            Just(0.0),
            Just(90.0),
            Just(180.0),
            Just(-1.0),
            0.0..1e-6_f64,
            0.0..10.0_f64,
            0.0..200.0_f64,
            179.9999..180.0_f64
        ];
        degrees.prop_map(Angle::from_degrees)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

        #[test]
        fn the_index_agrees_with_brute_force(
            stars in prop::collection::vec(directions(), 0..60),
            centre in directions(),
            radius in radii(),
        ) {
            check(&stars, &centre, radius);
        }

        /// The radius is the exact separation of a star, where rounding decides the result.
        #[test]
        fn a_star_on_the_boundary_is_treated_alike(stars in prop::collection::vec(directions(), 1..40), centre in directions()) {
            check(&stars, &centre, centre.separation(&stars[0]));
        }

        #[test]
        fn the_whole_catalogue_agrees_with_brute_force(centre in directions(), radius in radii()) {
            let (stars, index) = sky();
            prop_assert_eq!(index.within(&centre, radius), brute_force(stars, &centre, radius));
        }
    }

    /// Tests the definition of a cone against known angles.
    #[test]
    fn a_cone_holds_the_stars_nearer_than_its_radius() {
        for (separation, inside) in [(9.999999, true), (10.000001, false)] {
            for ra in [0.0, 90.0, 359.0] {
                let (centre, star) = (direction(ra, 85.0), direction(ra + 180.0, 95.0 - separation));
                assert_eq!(within_cone(&centre, &star, Angle::from_degrees(10.0)), inside, "{separation}");
            }
        }
        for (separation, inside) in [(169.999999, true), (170.000001, false)] {
            let star = direction(separation, 0.0);
            assert_eq!(
                within_cone(&direction(0.0, 0.0), &star, Angle::from_degrees(170.0)),
                inside,
                "{separation}"
            );
        }
    }

    #[test]
    fn a_radius_of_zero_holds_the_star_itself() {
        let (stars, index) = sky();
        for star in [0, 1000, 117_954] {
            assert!(index.within(&stars[star], Angle::ZERO).contains(&star));
        }
    }

    #[test]
    fn a_radius_of_180_deg_holds_all_stars_and_a_negative_one_none() {
        let (stars, index) = sky();
        let centre = direction(12.0, 34.0);
        assert_eq!(index.within(&centre, Angle::from_radians(PI)).len(), stars.len());
        assert_eq!(index.within(&centre, Angle::from_degrees(500.0)).len(), stars.len());
        assert!(index.within(&centre, Angle::from_degrees(-1e-9)).is_empty());
        assert!(index.within(&centre, Angle::from_radians(f64::NAN)).is_empty());
    }

    #[test]
    fn an_empty_index_finds_no_star() {
        assert!(ConeIndex::new(&[]).within(&direction(0.0, 0.0), Angle::from_degrees(180.0)).is_empty());
    }

    #[test]
    fn a_buffer_is_cleared_before_it_is_filled() {
        let index = ConeIndex::from_directions([Direction::from_unit(Vector3::x())]);
        let mut found = vec![7, 8, 9];
        index.within_into(&direction(0.0, 0.0), Angle::from_degrees(1.0), &mut found);
        assert_eq!(found, [0]);
    }
}
