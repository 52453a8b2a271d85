//! CSV catalogue with named columns.
//!
//! The first line names the columns, in any order; each name includes its unit. Fields are plain numbers:
//! there is no quoting, and a blank field is allowed only in an optional column.

use std::path::Path;

use super::super::star::CATALOG_EPOCH_JYR;
use super::super::{CatalogError, CatalogStar, photometry};
use super::field::Field;

/// Column that a file may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Id,
    RaDeg,
    DecDeg,
    HpMag,
    VMag,
    ParallaxMas,
    PmRaMasPerYr,
    PmDecMasPerYr,
    RadialVelocityKmS,
    BV,
    VI,
    EpochJyr,
}

const COLUMNS: [(Column, &str); 12] = [
    (Column::Id, "id"),
    (Column::RaDeg, "ra_deg"),
    (Column::DecDeg, "dec_deg"),
    (Column::HpMag, "hp_mag"),
    (Column::VMag, "v_mag"),
    (Column::ParallaxMas, "parallax_mas"),
    (Column::PmRaMasPerYr, "pm_ra_mas_per_yr"),
    (Column::PmDecMasPerYr, "pm_dec_mas_per_yr"),
    (Column::RadialVelocityKmS, "radial_velocity_km_s"),
    (Column::BV, "b_v"),
    (Column::VI, "v_i"),
    (Column::EpochJyr, "epoch_jyr"),
];

pub(super) fn parse(path: &Path, text: &str) -> Result<Vec<(usize, CatalogStar)>, CatalogError> {
    let mut lines = (1..).zip(text.lines());
    let header = header(path, lines.next().map_or("", |(_, line)| line))?;
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(line, content)| star(&Row::new(path, line, content, &header)?).map(|star| (line, star)))
        .collect()
}

/// Parses the header: the columns in the order of the file.
fn header(path: &Path, line: &str) -> Result<Vec<(Column, &'static str)>, CatalogError> {
    let mut header: Vec<(Column, &'static str)> = Vec::new();
    for name in line.split(',').map(str::trim) {
        let Some(column) = COLUMNS.iter().find(|(_, known)| *known == name) else {
            // Jaro-Winkler favours a common prefix: `pm_ra` is a shortened `pm_ra_mas_per_yr`.
            let likeness = |known: &str| strsim::jaro_winkler(known, name);
            let nearest = COLUMNS
                .iter()
                .map(|(_, known)| *known)
                .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
                .unwrap_or("id");
            let name = name.to_owned();
            return Err(CatalogError::UnknownColumn { path: path.to_path_buf(), name, nearest });
        };
        if header.contains(column) {
            return Err(problem(path, 1, format!("the column `{name}` occurs twice")));
        }
        header.push(*column);
    }
    let has = |column: Column| header.iter().any(|(known, _)| *known == column);
    for (column, name) in &COLUMNS[..3] {
        if !has(*column) {
            return Err(CatalogError::MissingColumn { path: path.to_path_buf(), name });
        }
    }
    match (has(Column::HpMag), has(Column::VMag)) {
        (false, false) => {
            Err(CatalogError::MissingColumn { path: path.to_path_buf(), name: "hp_mag (or v_mag)" })
        }
        (true, true) => Err(problem(path, 1, "hp_mag and v_mag exclude each other".to_owned())),
        _ => Ok(header),
    }
}

fn problem(path: &Path, line: usize, problem: String) -> CatalogError {
    CatalogError::Line { path: path.to_path_buf(), line, problem }
}

/// Line, split into its fields.
struct Row<'a> {
    fields: Vec<(Column, Field<'a>)>,
}

impl<'a> Row<'a> {
    fn new(
        path: &'a Path,
        line: usize,
        content: &'a str,
        header: &[(Column, &'static str)],
    ) -> Result<Self, CatalogError> {
        let found = content.split(',').count();
        if found != header.len() {
            let expected = header.len();
            return Err(problem(path, line, format!("{found} fields, expected {expected} as in line 1")));
        }
        let mut column = 1;
        let fields = header.iter().zip(content.split(',')).map(|(&(kind, name), text)| {
            let field = Field { path, line, column, name, text };
            column += text.chars().count() + 1;
            (kind, field)
        });
        Ok(Self { fields: fields.collect() })
    }

    /// Applies `read` to the field of a column, if the file has that column.
    fn get<T>(
        &self,
        column: Column,
        read: impl Fn(&Field<'a>) -> Result<T, CatalogError>,
    ) -> Result<Option<T>, CatalogError> {
        self.fields.iter().find(|(known, _)| *known == column).map(|(_, field)| read(field)).transpose()
    }

    /// Returns the value of a column that the header check guarantees: the default is never used.
    fn required<T: Default>(
        &self,
        column: Column,
        read: impl Fn(&Field<'a>) -> Result<T, CatalogError>,
    ) -> Result<T, CatalogError> {
        self.get(column, read).map(Option::unwrap_or_default)
    }

    /// Returns the value of a column that may be missing or blank.
    fn optional(
        &self,
        column: Column,
        read: impl Fn(&Field<'a>) -> Result<Option<f64>, CatalogError>,
    ) -> Result<Option<f64>, CatalogError> {
        self.get(column, read).map(Option::flatten)
    }
}

fn star(row: &Row<'_>) -> Result<CatalogStar, CatalogError> {
    let velocity =
        |field: &Field<'_>| field.optional(-299_792.0, 299_792.0, "blank, or km/s from -299792 to 299792");
    let b_v = row.optional(Column::BV, Field::colour)?;
    let hp_mag = match row.get(Column::VMag, Field::magnitude)? {
        Some(v_mag) => photometry::hp_mag(v_mag, b_v),
        None => row.required(Column::HpMag, Field::magnitude)?,
    };
    let epoch =
        |field: &Field<'_>| field.optional(1900.0, 2100.0, "blank, or a Julian year from 1900 to 2100");
    let epoch_jyr = row.optional(Column::EpochJyr, epoch)?.unwrap_or(CATALOG_EPOCH_JYR);
    let star = CatalogStar {
        id: row.required(Column::Id, Field::id)?,
        ra_rad: row.required(Column::RaDeg, Field::ra_deg)?.to_radians(),
        dec_rad: row.required(Column::DecDeg, Field::dec_deg)?.to_radians(),
        parallax_mas: row.optional(Column::ParallaxMas, Field::parallax_mas)?.unwrap_or(0.0),
        pm_ra_mas_per_yr: row.optional(Column::PmRaMasPerYr, Field::proper_motion_mas_per_yr)?.unwrap_or(0.0),
        pm_dec_mas_per_yr: row
            .optional(Column::PmDecMasPerYr, Field::proper_motion_mas_per_yr)?
            .unwrap_or(0.0),
        radial_velocity_km_s: row.optional(Column::RadialVelocityKmS, velocity)?.unwrap_or(0.0),
        hp_mag,
        b_v,
        v_i: row.optional(Column::VI, Field::colour)?,
    };
    Ok(star.at_catalog_epoch(epoch_jyr))
}

#[cfg(test)]
mod tests {
    use super::super::tests::message;
    use super::*;

    fn stars(content: &str) -> Vec<CatalogStar> {
        parse(Path::new("a.csv"), content).unwrap().into_iter().map(|(_, star)| star).collect()
    }

    fn refused(content: &str, expected: &str) {
        let message = message("a.csv", content.as_bytes());
        assert!(message.contains(expected), "`{message}` does not say `{expected}`");
    }

    #[test]
    fn every_column_is_read_in_any_order() {
        let header = "v_i,b_v,radial_velocity_km_s,pm_dec_mas_per_yr,pm_ra_mas_per_yr,parallax_mas,hp_mag,dec_deg,ra_deg,id";
        let stars = stars(&format!("{header}\r\n1.1,0.9,-20.5,3,-4,100.25,5.5,-45,180,77\r\n"));
        let expected = CatalogStar {
            id: 77,
            ra_rad: std::f64::consts::PI,
            dec_rad: -std::f64::consts::FRAC_PI_4,
            parallax_mas: 100.25,
            pm_ra_mas_per_yr: -4.0,
            pm_dec_mas_per_yr: 3.0,
            radial_velocity_km_s: -20.5,
            hp_mag: 5.5,
            b_v: Some(0.9),
            v_i: Some(1.1),
        };
        assert_eq!(stars, [expected]);
    }

    #[test]
    fn an_epoch_moves_the_star_to_that_of_the_catalogue() {
        let header = "id,ra_deg,dec_deg,hp_mag,pm_dec_mas_per_yr,epoch_jyr";
        let stars =
            stars(&format!("{header}\n1,10,20,5,1000,2016.0\n2,10,20,5,1000,\n3,10,20,5,1000,1991.25\n"));
        // 24.75 years at 1″ a year.
        let moved_arcsec = (stars[0].dec_rad.to_degrees() - 20.0) * 3_600.0;
        assert!((moved_arcsec + 24.75).abs() < 1e-4, "{moved_arcsec}");
        assert_eq!((stars[1].dec_rad, stars[2].dec_rad), (20.0_f64.to_radians(), 20.0_f64.to_radians()));
        refused(
            &format!("{header}\n1,10,20,5,1000,16\n"),
            "epoch_jyr is `16`, expected blank, or a Julian year",
        );
    }

    #[test]
    fn v_given_is_v_returned() {
        let stars = stars("id,ra_deg,dec_deg,v_mag,b_v\n1,2,3,4.5,1.2\n2,2,3,4.5,\n");
        assert!(stars.iter().all(|star| (star.v_mag() - 4.5).abs() < 1e-14));
        assert_eq!(stars[1].b_v, None);
    }

    #[test]
    fn an_unknown_column_is_reported_with_the_nearest_name() {
        refused("id,ra_dge,dec_deg,hp_mag\n", "unknown column `ra_dge`, did you mean `ra_deg`?");
        refused("id,ra_deg,dec_deg,hp_mag,pm_ra\n", "did you mean `pm_ra_mas_per_yr`?");
    }

    #[test]
    fn a_header_must_be_complete_and_unambiguous() {
        refused("id,ra_deg,hp_mag\n", "the column dec_deg is missing");
        refused("id,ra_deg,dec_deg\n", "the column hp_mag (or v_mag) is missing");
        refused("id,ra_deg,dec_deg,hp_mag,v_mag\n", "exclude each other");
        refused("id,ra_deg,dec_deg,hp_mag,id\n", "`id` occurs twice");
        refused("", "unknown column ``");
    }

    #[test]
    fn a_bad_field_is_reported_with_its_position() {
        let refuse = |row: &str, expected: &str| {
            refused(&format!("id,ra_deg,dec_deg,hp_mag,b_v\n1,2,3,4,\n{row}\n"), expected);
        };
        refuse("2,20,  100,4,", "line 3, column 8: dec_deg is `100`, expected degrees from -90 to 90");
        refuse("2,361,0,4,", "line 3, column 3: ra_deg is `361`, expected degrees from 0 to 360");
        refuse("2,nan,0,4,", "ra_deg is `nan`");
        refuse("2,1,0,inf,", "hp_mag is `inf`");
        refuse("2,1,0,,", "column 7: hp_mag is ``");
        refuse("-2,1,0,4,", "column 1: id is `-2`, expected an integer");
        refuse("2,1,0,4,red", "column 9: b_v is `red`");
        refuse("2,1,0,4", "line 3: 4 fields, expected 5");
    }

    #[test]
    fn columns_are_counted_in_characters() {
        refused("id,ra_deg,dec_deg,hp_mag\né,1,2,3\n", "column 1: id is `é`");
        refused("id,b_v,ra_deg,dec_deg,hp_mag\n1,0.5,é,2,3\n", "column 7: ra_deg is `é`");
    }
}
