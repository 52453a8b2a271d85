//! Reading a user's catalogue.

mod csv;
mod hip2;
mod hip_main;

use std::path::Path;

use super::catalog::Exclusion;
use super::{CatalogError, CatalogStar};

/// What a file holds: stars with the line each stands in, and the stars left out.
type Parsed = (Vec<(usize, CatalogStar)>, Vec<Exclusion>);

/// Parses a file of any known format; `path` tells the format and is named in errors.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Parsed, CatalogError> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes.iter().take(error.valid_up_to()).filter(|byte| **byte == b'\n').count();
        CatalogError::Line { path: path.to_path_buf(), line, problem: "not UTF-8 text".to_owned() }
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let first_line = text.lines().next().unwrap_or("");
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) {
        Ok((csv::parse(path, text)?, Vec::new()))
    } else if first_line.starts_with("H|") {
        hip_main::parse(path, text)
    } else if hip2::is_line(first_line) {
        Ok((hip2::parse(path, text)?, Vec::new()))
    } else {
        Err(CatalogError::UnknownFormat { path: path.to_path_buf() })
    }
}

/// A field of a line, and where it stands.
#[derive(Clone, Copy)]
struct Field<'a> {
    path: &'a Path,
    line: usize,
    /// First character in the line, counted from 1.
    column: usize,
    name: &'static str,
    text: &'a str,
}

impl Field<'_> {
    fn error(&self, expected: &'static str) -> CatalogError {
        let blanks = self.text.chars().take_while(|character| character.is_whitespace()).count();
        CatalogError::Field {
            path: self.path.to_path_buf(),
            line: self.line,
            column: if blanks < self.text.chars().count() { self.column + blanks } else { self.column },
            field: self.name,
            value: self.text.trim().to_owned(),
            expected,
        }
    }

    fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }

    fn id(&self) -> Result<u32, CatalogError> {
        self.text.trim().parse().map_err(|_| self.error("a whole number from 0 to 4294967295"))
    }

    /// A finite number from `low` to `high`.
    fn number(&self, low: f64, high: f64, expected: &'static str) -> Result<f64, CatalogError> {
        match self.text.trim().parse::<f64>() {
            // No NaN and no infinity lies between finite ends.
            Ok(value) if (low..=high).contains(&value) => Ok(value),
            _ => Err(self.error(expected)),
        }
    }

    fn optional(&self, low: f64, high: f64, expected: &'static str) -> Result<Option<f64>, CatalogError> {
        if self.is_blank() { Ok(None) } else { self.number(low, high, expected).map(Some) }
    }

    fn ra_deg(&self) -> Result<f64, CatalogError> {
        self.number(0.0, 360.0, "degrees from 0 to 360")
    }

    fn dec_deg(&self) -> Result<f64, CatalogError> {
        self.number(-90.0, 90.0, "degrees from -90 to 90")
    }

    fn magnitude(&self) -> Result<f64, CatalogError> {
        self.number(-30.0, 40.0, "a magnitude from -30 to 40")
    }

    fn parallax_mas(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-1e4, 1e4, "blank, or mas from -10000 to 10000")
    }

    fn proper_motion_mas_per_yr(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-1e5, 1e5, "blank, or mas per year from -100000 to 100000")
    }

    fn colour(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-10.0, 20.0, "blank, or a colour index from -10 to 20 mag")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message of the error that a file of this name and content gives.
    pub(super) fn message(name: &str, content: &[u8]) -> String {
        parse(Path::new(name), content).unwrap_err().to_string()
    }

    #[test]
    fn a_file_of_no_known_format_says_what_is_known() {
        for content in ["", "hello", "T|1|2"] {
            let message = message("stars.txt", content.as_bytes());
            assert!(message.contains("stars.txt") && message.contains("hip_main.dat"), "{message}");
        }
    }

    #[test]
    fn bytes_that_are_not_text_are_an_error_with_their_line() {
        assert!(message("a.csv", b"id,ra_deg\n1,\xff\xfe").contains("line 2: not UTF-8 text"));
    }

    #[test]
    fn a_byte_order_mark_is_not_part_of_the_first_name() {
        let content = "\u{feff}id,ra_deg,dec_deg,hp_mag\n1,2,3,4\n";
        assert_eq!(parse(Path::new("a.csv"), content.as_bytes()).unwrap().0.len(), 1);
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig {
            failure_persistence: None,
            ..proptest::prelude::ProptestConfig::with_cases(256)
        })]

        /// Arbitrary text behind each format's mark is read or refused, never a panic.
        #[test]
        fn no_text_makes_the_reader_panic(text in "(?s).{0,400}", lines in "[-0-9.,|é\n ]{0,400}") {
            for (name, start) in [("a.csv", "id,ra_deg,dec_deg,v_mag\n"), ("a.dat", "H|"), ("b.dat", HIP2_LINE)] {
                for content in [&text, &lines] {
                    let _ = parse(Path::new(name), format!("{start}{content}").as_bytes());
                }
            }
        }
    }

    /// A line of hip2.dat up to its last column used.
    const HIP2_LINE: &str = "     1   5 0 1  0.0000159148  0.0190068680    4.55    -4.55    -1.19   1.29   0.66   1.33   1.25   0.75  90  0.91  0    0.0    0  9.2043 0.0020 0.017 0  0.482 0.025  0.550\n";
}
