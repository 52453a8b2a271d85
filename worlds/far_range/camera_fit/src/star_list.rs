//! Apparent places of the catalogue's stars.

use std::collections::HashMap;

use contract::{Direction, Icrs, ListedStar};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::SimError;
use sim::catalog::{Catalog, CatalogStar};
use sim::truth::{Observer, StarMotion};

/// Faintest stars of the list, V. Hipparcos is complete to 7.3 to 9, by galactic latitude.
const FAINTEST_V: f64 = 10.0;

/// Stars with their apparent directions, and what the photometry needs of them.
pub(crate) struct SkyList {
    /// Stars, brightest first.
    pub(crate) stars: Vec<ListedStar>,
    /// Colour index B−V of each star, `None` if unknown.
    pub(crate) b_v: Vec<Option<f64>>,
}

impl SkyList {
    /// Returns the stars of Hipparcos at `time`, seen from the centre of the Earth.
    pub(crate) fn new(time: Epoch) -> Result<Self, SimError> {
        let observer = Observer::new(time, Vector3::zeros(), Vector3::zeros())?;
        let catalog = Catalog::hipparcos2();
        let mut stars: Vec<&CatalogStar> =
            catalog.stars().iter().filter(|star| star.v_mag() <= FAINTEST_V).collect();
        stars.sort_by(|a, b| a.v_mag().total_cmp(&b.v_mag()).then(a.id.cmp(&b.id)));
        let listed = |star: &CatalogStar| {
            let direction: Direction<Icrs> = observer.apparent(&StarMotion::new(star));
            ListedStar { id: star.id, direction, magnitude: star.v_mag() }
        };
        Ok(Self {
            b_v: stars.iter().map(|star| star.b_v).collect(),
            stars: stars.into_iter().map(listed).collect(),
        })
    }
}

/// Returns the apparent directions of stars, by their numbers in the catalogue, at a time.
///
/// # Errors
/// [`SimError`] for a time outside the ephemerides.
pub(crate) fn directions_of(stars: &[u32], time: Epoch) -> Result<Vec<Vector3<f64>>, SimError> {
    let observer = Observer::new(time, Vector3::zeros(), Vector3::zeros())?;
    let catalog = Catalog::hipparcos2();
    let of_number: HashMap<u32, &CatalogStar> = catalog.stars().iter().map(|star| (star.id, star)).collect();
    let mut directions = Vec::with_capacity(stars.len());
    for star in stars {
        let direction = of_number.get(star).map(|star| observer.apparent(&StarMotion::new(star)));
        directions.push(direction.map_or_else(Vector3::zeros, |direction| *direction.vector()));
    }
    Ok(directions)
}
