//! plotly.js, the library that draws the charts: a third-party file in the source tree, embedded in the
//! executable and in every report.

use std::io::{self, Read};

use flate2::read::ZlibDecoder;

/// The minified bundle, compressed by `build.rs`.
static COMPRESSED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/plotly.js.zlib"));

/// Returns the minified bundle. It contains no `</script`, so a script tag may contain it.
///
/// # Errors
/// An [`io::Error`] when the executable is damaged.
pub fn plotly_js() -> io::Result<String> {
    let mut script = String::new();
    ZlibDecoder::new(COMPRESSED).read_to_string(&mut script)?;
    Ok(script)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::plotly::Trace;
    use files::sha256::sha256_hex;

    const README: &str = include_str!("../../third_party/plotly/README.md");

    /// Returns a cell of the table in the README.
    fn documented(row: &str) -> &'static str {
        let prefix = format!("| {row} | ");
        let cell = README.lines().find_map(|line| line.strip_prefix(&prefix)?.strip_suffix(" |"));
        cell.unwrap_or_else(|| panic!("README.md has no row `{row}`"))
    }

    const PLOTLY_JS: &str = include_str!("../../third_party/plotly/plotly-cartesian.min.js");

    #[test]
    fn the_embedded_bundle_is_that_of_the_tree() {
        assert!(plotly_js().unwrap() == PLOTLY_JS);
    }

    #[test]
    fn the_bundle_is_the_documented_one() {
        assert_eq!(documented("SHA-256 of the bundle"), format!("`{}`", sha256_hex(PLOTLY_JS)));
        let version = documented("version");
        let head = PLOTLY_JS.lines().take(3).collect::<Vec<_>>().join("\n");
        assert_eq!(
            head.lines().nth(1),
            Some(format!("* plotly.js (cartesian - minified) v{version}").as_str())
        );
        assert!(documented("licence").starts_with("MIT"));
        assert!(include_str!("../../third_party/plotly/LICENSE").starts_with("MIT License"));
    }

    #[test]
    fn the_bundle_draws_every_trace_type_of_the_charts() {
        for kind in Trace::TRACE_TYPES {
            let module = format!("moduleType:\"trace\",name:\"{kind}\"");
            assert!(PLOTLY_JS.contains(&module), "the bundle has no trace type {kind}");
        }
    }

    #[test]
    fn the_bundle_cannot_end_its_script_tag() {
        let script = PLOTLY_JS.to_ascii_lowercase();
        // After `<!--` a browser interprets `<script` as the start of another script.
        for text in ["</script", "<!--"] {
            assert!(!script.contains(text), "{text}");
        }
    }
}
