//! hip_main.dat, the Hipparcos Catalogue of 1997 (ESA SP-1200, CDS I/239): fields H0 to H77 between bars,
//! degrees, J1991.25.

use std::path::Path;

use super::super::contents::{CatalogContents, Exclusion};
use super::super::{CatalogError, CatalogStar, radial_velocity};
use super::field::Field;

/// Number of fields, H0 to H77.
const FIELDS: usize = 78;

pub(super) fn parse(path: &Path, text: &str) -> Result<CatalogContents, CatalogError> {
    let mut stars = Vec::new();
    let mut exclusions = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let fields = Fields::new(path, line, content)?;
        let id = fields.get(1, "HIP (H1)").id()?;
        let blank = |number, name| fields.get(number, name).is_blank();
        if blank(8, "RAdeg (H8)") || blank(9, "DEdeg (H9)") {
            exclusions.push(Exclusion { line, id, reason: "no astrometric solution: H8 and H9 are blank" });
        } else if blank(44, "Hpmag (H44)") {
            exclusions.push(Exclusion { line, id, reason: "no magnitude Hp: H44 is blank" });
        } else {
            stars.push((line, star(id, &fields)?));
        }
    }
    Ok((stars, exclusions))
}

fn star(id: u32, fields: &Fields<'_>) -> Result<CatalogStar, CatalogError> {
    Ok(CatalogStar {
        id,
        ra_rad: fields.get(8, "RAdeg (H8)").ra_deg()?.to_radians(),
        dec_rad: fields.get(9, "DEdeg (H9)").dec_deg()?.to_radians(),
        parallax_mas: fields.get(11, "Plx (H11)").parallax_mas()?.unwrap_or(0.0),
        pm_ra_mas_per_yr: fields.get(12, "pmRA (H12)").proper_motion_mas_per_yr()?.unwrap_or(0.0),
        pm_dec_mas_per_yr: fields.get(13, "pmDE (H13)").proper_motion_mas_per_yr()?.unwrap_or(0.0),
        radial_velocity_km_s: radial_velocity::radial_velocity_km_s(id).unwrap_or(0.0),
        hp_mag: fields.get(44, "Hpmag (H44)").magnitude()?,
        b_v: fields.get(37, "B-V (H37)").colour()?,
        v_i: fields.get(40, "V-I (H40)").colour()?,
    })
}

/// Line, split at its bars.
struct Fields<'a> {
    path: &'a Path,
    line: usize,
    texts: Vec<&'a str>,
}

impl<'a> Fields<'a> {
    fn new(path: &'a Path, line: usize, content: &'a str) -> Result<Self, CatalogError> {
        let texts: Vec<&str> = content.split('|').collect();
        if texts.len() == FIELDS && texts.first() == Some(&"H") {
            return Ok(Self { path, line, texts });
        }
        let problem =
            format!("not a line of hip_main.dat: {} fields, expected H and {} more", texts.len(), FIELDS - 1);
        Err(CatalogError::Line { path: path.to_path_buf(), line, problem })
    }

    /// Returns field H`number`, below [`FIELDS`].
    fn get(&self, number: usize, name: &'static str) -> Field<'a> {
        let before: usize = self.texts.iter().take(number).map(|text| text.chars().count() + 1).sum();
        let text = self.texts.get(number).copied().unwrap_or("");
        Field { path: self.path, line: self.line, column: before + 1, name, text }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Catalog;
    use super::super::tests::message;
    use super::*;

    /// Line of HIP 1 as published.
    const HIP_1: &str = "H|           1| |00 00 00.22|+01 05 20.4| 9.10| |H|000.00091185|+01.08901332| |   3.54|   -5.20|   -1.88|  1.32|  0.74|  1.39|  1.36|  0.81| 0.32|-0.07|-0.11|-0.24| 0.09|-0.01| 0.10|-0.01| 0.01| 0.34|  0| 0.74|     1| 9.643|0.020| 9.130|0.019| | 0.482|0.025|T|0.55|0.03|L| | 9.2043|0.0020|0.017| 87| | 9.17| 9.24|       | | | |          | |  | 1| | | |  |   |       |     |     |    |S| | |224700|B+00 5077 |          |          |0.66|F5          |S \n";

    /// Line of HIP 1 with one field replaced by another text.
    fn line_with_field(number: usize, text: &str) -> String {
        let mut texts: Vec<&str> = HIP_1.split('|').collect();
        texts[number] = text;
        texts.join("|")
    }

    #[test]
    fn the_two_reductions_agree_about_the_first_star() {
        let (stars, exclusions) = parse(Path::new("hip_main.dat"), HIP_1).unwrap();
        assert!(exclusions.is_empty());
        let (first, second) = (stars[0].1, *Catalog::hipparcos2().star(1).unwrap());
        // The two reductions differ by their errors, about a milliarcsecond here.
        assert!(first.direction().separation(&second.direction()).arcsec() < 0.003);
        assert_eq!((first.hp_mag, first.b_v, first.v_i), (second.hp_mag, second.b_v, second.v_i));
        assert_eq!(
            (first.parallax_mas, first.pm_ra_mas_per_yr, first.pm_dec_mas_per_yr),
            (3.54, -5.20, -1.88)
        );
    }

    #[test]
    fn an_excluded_star_is_reported_with_the_reason() {
        let text = HIP_1.to_owned() + &line_with_field(8, "            ") + &line_with_field(44, "       ");
        let (stars, exclusions) = parse(Path::new("hip_main.dat"), &text).unwrap();
        assert_eq!(stars.len(), 1);
        assert_eq!(exclusions.iter().map(|star| (star.line, star.id)).collect::<Vec<_>>(), [(2, 1), (3, 1)]);
        assert!(exclusions[0].reason.contains("H8") && exclusions[1].reason.contains("H44"));
    }

    #[test]
    fn a_blank_colour_is_unknown() {
        let (stars, _) = parse(Path::new("hip_main.dat"), &line_with_field(37, "      ")).unwrap();
        assert_eq!((stars[0].1.b_v, stars[0].1.v_i), (None, Some(0.55)));
    }

    #[test]
    fn a_bad_field_is_reported_with_its_position() {
        let refused = |content: String, expected: &str| {
            let message = message("hip_main.dat", content.as_bytes());
            assert!(message.contains(expected), "`{message}` does not say `{expected}`");
        };
        refused(
            line_with_field(8, "400.00091185"),
            "line 1, column 52: RAdeg (H8) is `400.00091185`, expected degrees",
        );
        refused(line_with_field(9, "         inf"), "DEdeg (H9) is `inf`");
        refused(line_with_field(1, "         one"), "line 1, column 12: HIP (H1) is `one`");
        refused(HIP_1.to_owned() + "H|2|\n", "line 2: not a line of hip_main.dat: 3 fields");
    }
}
