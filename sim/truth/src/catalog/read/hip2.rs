//! hip2.dat, the new reduction of Hipparcos (van Leeuwen 2007, CDS I/311): fixed columns, radians, J1991.25.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::Range;
use std::path::Path;

use super::super::{CatalogError, CatalogStar, radial_velocity};
use super::field::Field;

/// Length of a line up to the last column used, bytes; the whole line has 276.
const LENGTH: usize = 171;

/// Returns true if a line has the structure of this format.
pub(super) fn is_line(line: &str) -> bool {
    line.len() >= LENGTH && line.is_ascii() && !line.contains(['|', ','])
}

pub(super) fn parse(path: &Path, text: &str) -> Result<Vec<(usize, CatalogStar)>, CatalogError> {
    (1..)
        .zip(text.lines())
        .map(|(line, content)| star(path, line, content).map(|star| (line, star)))
        .collect()
}

fn star(path: &Path, line: usize, content: &str) -> Result<CatalogStar, CatalogError> {
    if !is_line(content) {
        let problem = format!(
            "not a line of hip2.dat: expected at least {LENGTH} ASCII characters without `|` and `,`"
        );
        return Err(CatalogError::Line { path: path.to_path_buf(), line, problem });
    }
    // An ASCII line of this length contains every column.
    let field = |name, bytes: Range<usize>| Field {
        path,
        line,
        column: bytes.start + 1,
        name,
        text: content.get(bytes).unwrap_or(""),
    };
    let id = field("HIP", 0..6).id()?;
    let b_v = field("B-V", 152..158).number(-10.0, 20.0, "a colour index from -10 to 20 mag")?;
    let b_v_error = field("e_B-V", 159..164).number(0.0, 20.0, "mag from 0 to 20")?;
    let v_i = field("V-I", 165..171).number(-10.0, 20.0, "a colour index from -10 to 20 mag")?;
    // The format has no blanks: a star without colours has zeros in all three columns.
    let coloured = !(b_v == 0.0 && b_v_error == 0.0);
    let mas = "mas from -10000 to 10000";
    let motion = "mas per year from -100000 to 100000";
    Ok(CatalogStar {
        id,
        ra_rad: field("RArad", 15..28).number(0.0, TAU, "radians from 0 to 2π")?,
        dec_rad: field("DErad", 29..42).number(-FRAC_PI_2, FRAC_PI_2, "radians from -π/2 to π/2")?,
        parallax_mas: field("Plx", 43..50).number(-1e4, 1e4, mas)?,
        pm_ra_mas_per_yr: field("pmRA", 51..59).number(-1e5, 1e5, motion)?,
        pm_dec_mas_per_yr: field("pmDE", 60..68).number(-1e5, 1e5, motion)?,
        radial_velocity_km_s: radial_velocity::radial_velocity_km_s(id).unwrap_or(0.0),
        hp_mag: field("Hpmag", 129..136).magnitude()?,
        b_v: coloured.then_some(b_v),
        v_i: (coloured || v_i != 0.0).then_some(v_i),
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::Catalog;
    use super::super::tests::message;
    use super::*;

    /// Lines of hip2.dat: HIP 1, 2, 45 (without colours) and 87937 (Barnard's star, with a velocity).
    const LINES: &str = "     1   5 0 1  0.0000159148  0.0190068680    4.55    -4.55    -1.19   1.29   0.66   1.33   1.25   0.75  90  0.91  0    0.0    0  9.2043 0.0020 0.017 0  0.482 0.025  0.550
     2  75 4 1  0.0000662767 -0.3403189126   20.85   182.88    -1.31   0.95   0.53   1.13   1.22   0.66 121  0.06  0    0.0    0  9.4017 0.0017 0.015 0  0.999 0.002  1.040
    45  15 3 2  0.0023423103 -1.2601750270   16.05   -38.52    -1.77   0.88   0.84   1.06   1.03   0.87 136 -1.25  1    0.0    0  9.7391 0.0025 0.028 0  0.000 0.000  0.000
 87937   5 0 1  4.7028598776  0.0814769927  548.31  -798.58 10328.12   1.25   1.01   1.51   1.72   1.22  83  0.88  1    0.0    0  9.4901 0.0048 0.031 0  1.570 0.015  2.520
";

    #[test]
    fn a_user_s_file_gives_the_stars_of_the_embedded_one() {
        let embedded = Catalog::hipparcos2();
        let stars = parse(Path::new("hip2.dat"), LINES).unwrap();
        assert_eq!(stars.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [1, 2, 3, 4]);
        for (_, star) in stars {
            assert_eq!(Some(&star), embedded.star(star.id));
        }
    }

    #[test]
    fn a_bad_field_is_reported_with_its_position() {
        let refused = |from: &str, to: &str, expected: &str| {
            let message = message("hip2.dat", LINES.replace(from, to).as_bytes());
            assert!(message.contains(expected), "`{message}` does not say `{expected}`");
        };
        refused("  9.4017", "  9.40x7", "line 2, column 131: Hpmag is `9.40x7`, expected a magnitude");
        refused("  0.0000662767", "  9.0000662767", "line 2, column 17: RArad is `9.0000662767`");
        refused("   20.85", "     NaN", "line 2, column 48: Plx is `NaN`");
        refused("     2  75", "     x  75", "line 2, column 6: HIP is `x`");
        refused("  0.999 0.002", "  ----- 0.002", "line 2, column 154: B-V is `-----`");
    }

    #[test]
    fn a_short_line_is_refused() {
        let cut = &LINES[..LINES.len() - 150];
        assert!(message("hip2.dat", cut.as_bytes()).contains("line 4: not a line of hip2.dat"));
    }
}
