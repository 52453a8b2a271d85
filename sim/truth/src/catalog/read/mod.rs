//! Reader of catalogue files of the user.

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

mod csv;
mod field;
mod hip2;
mod hip_main;

use std::path::Path;

use super::CatalogError;
use super::contents::CatalogContents;

/// Parses a file of any known format; `path` helps to determine the format and appears in errors.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<CatalogContents, CatalogError> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Error message for a file with this name and content.
    pub(super) fn message(name: &str, content: &[u8]) -> String {
        parse(Path::new(name), content).unwrap_err().to_string()
    }

    #[test]
    fn a_file_of_unknown_format_is_reported_with_the_known_ones() {
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

        /// Arbitrary text after the marker of each format is read or refused, and never causes a panic.
        #[test]
        fn no_text_makes_the_reader_panic(text in "(?s).{0,400}", lines in "[-0-9.,|é\n ]{0,400}") {
            for (name, start) in [("a.csv", "id,ra_deg,dec_deg,v_mag\n"), ("a.dat", "H|"), ("b.dat", HIP2_LINE)] {
                for content in [&text, &lines] {
                    let _ = parse(Path::new(name), format!("{start}{content}").as_bytes());
                }
            }
        }
    }

    /// Line of hip2.dat up to the last column used.
    const HIP2_LINE: &str = "     1   5 0 1  0.0000159148  0.0190068680    4.55    -4.55    -1.19   1.29   0.66   1.33   1.25   0.75  90  0.91  0    0.0    0  9.2043 0.0020 0.017 0  0.482 0.025  0.550\n";
}
