//! Star catalogue: stars in ascending order of their numbers, and the hash of their source.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use config::regular_file;
use contract::{Angle, Direction};
use sha2::{Digest, Sha256};

use super::cone::{ConeIndex, within_cone};
use super::config::{CatalogConfig, CatalogSource};
use super::contents::Exclusion;
use super::hex::hex;
use super::{CatalogError, CatalogStar, hipparcos, read};
use crate::memo::Memo;

/// Stars in ascending order of id, each id once. Copies share the stars.
#[derive(Debug, Clone)]
pub struct Catalog {
    stars: Arc<[CatalogStar]>,
    sha256: String,
    exclusions: Vec<Exclusion>,
    index: Arc<OnceLock<ConeIndex>>,
}

impl PartialEq for Catalog {
    fn eq(&self, other: &Self) -> bool {
        // The index is derived from the stars.
        let Self { stars, sha256, exclusions, index: _ } = self;
        *stars == other.stars && *sha256 == other.sha256 && *exclusions == other.exclusions
    }
}

/// Selections from the embedded catalogue.
static EMBEDDED: Memo<CatalogConfig, Catalog> = Memo::new();

impl Catalog {
    /// The embedded Hipparcos-2: 117 955 stars (van Leeuwen 2007, A&A 474, 653; CDS I/311), with the radial
    /// velocities of near and fast stars (`radial_velocity.rs` lists them and their sources).
    ///
    /// ```
    /// use boresight_truth::catalog::Catalog;
    /// let catalog = Catalog::hipparcos2();
    /// let pollux = catalog.star(37826).expect("Pollux is HIP 37826");
    /// assert!((pollux.v_mag() - 1.14).abs() < 0.02);
    /// ```
    pub fn hipparcos2() -> Self {
        Self::new(hipparcos::stars(), hipparcos::sha256(), Vec::new())
    }

    fn new(stars: Vec<CatalogStar>, sha256: String, exclusions: Vec<Exclusion>) -> Self {
        Self { stars: stars.into(), sha256, exclusions, index: Arc::default() }
    }

    /// Reads a catalogue file of the user. Name and content determine the format: a name ending in `.csv` is
    /// CSV with named columns; otherwise a first line that begins with `H|` is hip_main.dat (I/239), and a
    /// first line of at least 171 plain characters (of the 276 published) without a bar or a comma is
    /// hip2.dat (I/311).
    ///
    /// Stars that hip_main.dat lists without a position or without Hp are left out and reported by
    /// [`Catalog::exclusions`]; any other flaw is an error. The two Hipparcos formats have no radial
    /// velocities and receive those of the embedded catalogue.
    ///
    /// # Errors
    /// [`CatalogError`] with the file, the line and the position in the line.
    pub fn read(path: &Path) -> Result<Self, CatalogError> {
        let bytes = regular_file::read(path, MAX_BYTES)
            .map_err(|source| CatalogError::Io { path: path.to_path_buf(), source })?;
        let (rows, exclusions) = read::parse(path, &bytes)?;
        Ok(Self::new(unique(path, rows)?, hex(&Sha256::digest(&bytes)), exclusions))
    }

    /// Loads the stars that a scenario requests: the source, limited to the magnitude and to the cone. A
    /// relative path starts at `base_dir`.
    ///
    /// The cone is applied at the catalogue's epoch: add a margin for proper motion (at most 10.4″ per year).
    /// The hash covers the whole source.
    ///
    /// # Errors
    /// [`CatalogError`] if the source cannot be read. The configuration must have been checked.
    pub fn load(config: &CatalogConfig, base_dir: &Path) -> Result<Self, CatalogError> {
        match &config.source {
            CatalogSource::Hipparcos2 => {
                let cut = EMBEDDED.get(config.clone(), |config| Ok(Self::hipparcos2().cut(config)));
                cut.map(|catalog| (*catalog).clone())
            }
            CatalogSource::File(path) => Ok(Self::read(&base_dir.join(path))?.cut(config)),
        }
    }

    fn cut(self, config: &CatalogConfig) -> Self {
        let mut stars = self.stars.to_vec();
        if let Some(limit) = config.magnitude_limit {
            stars.retain(|star| star.v_mag() <= limit);
        }
        if let Some(cone) = &config.cone {
            let centre =
                Direction::from_ra_dec(Angle::from_degrees(cone.ra_deg), Angle::from_degrees(cone.dec_deg));
            let radius = Angle::from_degrees(cone.radius_deg);
            stars.retain(|star| within_cone(&centre, &star.direction(), radius));
        }
        Self::new(stars, self.sha256, self.exclusions)
    }

    /// Stars, in ascending order of id.
    pub fn stars(&self) -> &[CatalogStar] {
        &self.stars
    }

    /// Returns the star with this number.
    pub fn star(&self, id: u32) -> Option<&CatalogStar> {
        self.stars.binary_search_by_key(&id, |star| star.id).ok().and_then(|index| self.stars.get(index))
    }

    /// Index of the stars' directions at the catalogue's epoch, built on first use.
    pub fn index(&self) -> &ConeIndex {
        self.index.get_or_init(|| ConeIndex::new(&self.stars))
    }

    /// SHA-256 of the source's bytes (for the embedded catalogue: of hip2.dat), in hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Stars of the file that are not in the catalogue, in the order of the file.
    pub fn exclusions(&self) -> &[Exclusion] {
        &self.exclusions
    }
}

impl Catalog {
    /// Creates a catalogue of these stars, in ascending order of id.
    pub fn from_stars(stars: Vec<CatalogStar>) -> Self {
        Self::new(stars, String::new(), Vec::new())
    }
}

/// Returns the stars of the rows (line, star), in ascending order of id.
fn unique(path: &Path, rows: Vec<(usize, CatalogStar)>) -> Result<Vec<CatalogStar>, CatalogError> {
    let mut line_of_id = HashMap::with_capacity(rows.len());
    for (line, star) in &rows {
        if let Some(first_line) = line_of_id.insert(star.id, *line) {
            let (path, line, id) = (path.to_path_buf(), *line, star.id);
            return Err(CatalogError::DuplicateId { path, line, id, first_line });
        }
    }
    let mut stars: Vec<CatalogStar> = rows.into_iter().map(|(_, star)| star).collect();
    stars.sort_by_key(|star| star.id);
    Ok(stars)
}

/// Maximum size of a catalogue that is read, bytes: ten times hip_main.dat.
const MAX_BYTES: u64 = 1 << 29;

#[cfg(test)]
mod tests {
    use super::super::config::ConeConfig;
    use super::*;

    fn load(config: &CatalogConfig) -> Catalog {
        config.check().unwrap();
        Catalog::load(config, Path::new("")).unwrap()
    }

    #[test]
    fn the_default_is_all_of_hipparcos2() {
        assert_eq!(load(&CatalogConfig::default()), Catalog::hipparcos2());
    }

    #[test]
    fn the_magnitude_limit_keeps_exactly_the_bright_stars() {
        let all = Catalog::hipparcos2();
        let bright = load(&CatalogConfig { magnitude_limit: Some(6.0), ..CatalogConfig::default() });
        let expected: Vec<u32> =
            all.stars().iter().filter(|star| star.v_mag() <= 6.0).map(|star| star.id).collect();
        assert_eq!(bright.stars().iter().map(|star| star.id).collect::<Vec<_>>(), expected);
        // About 5000 stars are brighter than 6.0 in the Bright Star Catalogue (Hoffleit & Warren 1991).
        assert!((4500..5500).contains(&expected.len()), "{}", expected.len());
        assert_eq!(bright.sha256(), all.sha256());
    }

    #[test]
    fn the_cone_about_orion_holds_its_belt() {
        let cone = Some(ConeConfig { ra_deg: 84.05, dec_deg: -1.2, radius_deg: 2.0 });
        let belt = load(&CatalogConfig { cone, magnitude_limit: Some(2.5), ..CatalogConfig::default() });
        // Mintaka, Alnilam, Alnitak.
        assert_eq!(belt.stars().iter().map(|star| star.id).collect::<Vec<_>>(), [25930, 26311, 26727]);
    }

    #[test]
    fn a_path_starts_at_the_base_directory() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("three.csv"), "id,ra_deg,dec_deg,hp_mag\n7,1,2,3\n5,1,2,3\n").unwrap();
        let config =
            CatalogConfig { source: CatalogSource::File("three.csv".into()), ..CatalogConfig::default() };
        let catalog = Catalog::load(&config, dir.path()).unwrap();
        assert_eq!(catalog.stars().iter().map(|star| star.id).collect::<Vec<_>>(), [5, 7]);
        assert!(matches!(Catalog::load(&config, Path::new("/nowhere")), Err(CatalogError::Io { .. })));
    }

    #[test]
    fn two_stars_of_one_number_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("twice.csv");
        std::fs::write(&path, "id,ra_deg,dec_deg,hp_mag\n5,1,2,3\n7,1,2,3\n5,1,2,3\n").unwrap();
        let error = Catalog::read(&path).unwrap_err();
        assert!(matches!(error, CatalogError::DuplicateId { id: 5, line: 4, first_line: 2, .. }), "{error}");
    }

    #[test]
    fn the_hash_is_that_of_the_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("empty.csv");
        std::fs::write(&path, "id,ra_deg,dec_deg,hp_mag\n").unwrap();
        // From coreutils: printf 'id,ra_deg,dec_deg,hp_mag\n' | sha256sum
        assert_eq!(Catalog::read(&path).unwrap().sha256(), SHA256_OF_HEADER);
    }

    const SHA256_OF_HEADER: &str = "74f29f3b8f6b597672caa99c45caebcb251923521560be92b8e3f5691bb3e69f";
}
