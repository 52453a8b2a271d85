//! `stars.csv`: the star list that a pipeline receives.

use std::path::Path;

use contract::{Angle, Direction, ListedStar};
use files::{CsvLine, CsvReader, FileError, table, write_csv};

table! {
    /// A star of the list: catalogued position in ICRS with proper motion applied, without aberration.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct StarRow: csv {
        /// number in the catalogue (HIP); ascending, each once
        id: u32,
        /// right ascension, ICRS, 0 to 360; proper motion applied, without parallax and aberration
        ra_deg: f64,
        /// declination, ICRS, −90 to 90; proper motion applied, without parallax and aberration
        dec_deg: f64,
        /// Johnson V magnitude
        magnitude: f64,
    }
}

impl StarRow {
    /// Returns the star as a pipeline receives it. The list is *defined* by its rows, so a list read back
    /// from a file is bit-identical.
    pub fn to_listed_star(&self) -> ListedStar {
        let direction =
            Direction::from_ra_dec(Angle::from_degrees(self.ra_deg), Angle::from_degrees(self.dec_deg));
        ListedStar { id: self.id, direction, magnitude: self.magnitude }
    }
}

/// Writes the list.
///
/// # Errors
/// [`FileError::OutputTaken`] if the file exists; [`FileError::Io`] if it cannot be written.
pub fn write_stars(path: &Path, stars: &[StarRow]) -> Result<(), FileError> {
    write_csv(path, stars)
}

/// Reads the list; numbers ascend without repetition.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell.
pub fn read_stars(path: &Path) -> Result<Vec<StarRow>, FileError> {
    CsvReader::open::<StarRow>(path)?.read_rows(|row, previous: Option<&StarRow>| {
        let star = StarRow::read(row)?;
        if previous.is_some_and(|previous| star.id <= previous.id) {
            return Err(row.error("id", "more than the id of the previous row (each star once, ascending)"));
        }
        if !(0.0..=360.0).contains(&star.ra_deg) {
            return Err(row.error("ra_deg", "0 to 360"));
        }
        if !(-90.0..=90.0).contains(&star.dec_deg) {
            return Err(row.error("dec_deg", "-90 to 90"));
        }
        Ok(star)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIRIUS: StarRow =
        StarRow { id: 32349, ra_deg: 101.287_155_33, dec_deg: -16.716_115_86, magnitude: -1.44 };

    #[test]
    fn the_list_round_trips_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stars.csv");
        let stars = [StarRow { id: 1, ra_deg: 0.1 + 0.2, ..SIRIUS }, SIRIUS];
        write_stars(&path, &stars).unwrap();
        assert_eq!(read_stars(&path).unwrap(), stars);
        assert!(write_stars(&path, &stars).is_err(), "a file that exists is not overwritten");
    }

    fn refused(text: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stars.csv");
        std::fs::write(&path, text).unwrap();
        read_stars(&path).unwrap_err().to_string()
    }

    #[test]
    fn a_mistake_is_named_with_line_and_column() {
        for (row, column) in [
            ("7,361,0,1", "ra_deg"),
            ("7,0,-91,1", "dec_deg"),
            ("7,NaN,0,1", "ra_deg"),
            ("6,0,0,1", "id"),
            ("7,0,0,", "magnitude"),
        ] {
            let message = refused(&format!("id,ra_deg,dec_deg,magnitude\n6,1,2,3\n{row}\n"));
            assert!(message.contains("line 3") && message.contains(&format!("`{column}`")), "{message}");
        }
        assert!(refused("id,ra_deg,dec_deg\n").contains("magnitude"));
    }
}
