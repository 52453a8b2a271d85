//! Time that files of flight dynamics cover, and the frames.

use std::path::Path;

use files::{FileError, FileLocation};
use flight_dynamics::Coverage;
use hifitime::Epoch;
use sim::truth::clock;

/// Checks that one span without gaps covers all frames, from the first to the last mid-exposure.
///
/// # Errors
/// [`FileError::Value`] with the file and the spans.
pub(crate) fn check_coverage(
    path: &Path,
    ends: Option<[Epoch; 2]>,
    coverage: &[Coverage],
) -> Result<(), FileError> {
    let refused = |field: &str, value: String, expected: String| {
        Err(FileError::value(path, FileLocation::Whole, field, value, expected))
    };
    for (index, pair) in coverage.windows(2).enumerate() {
        if let [earlier, later] = pair
            && earlier.stop < later.start
        {
            let expected = format!("a start at {}: there must be no gap", clock::format_utc(earlier.stop));
            return refused(&format!("span of segment {}", index + 2), later.to_string(), expected);
        }
    }
    let (Some([first, last]), Some(start), Some(stop)) = (ends, coverage.first(), coverage.last()) else {
        return Ok(());
    };
    let whole = Coverage { start: start.start, stop: stop.stop };
    if whole.start <= first && last <= whole.stop {
        return Ok(());
    }
    let frames = Coverage { start: first, stop: last };
    refused("covered time", whole.to_string(), format!("a span that contains all frames, {frames}"))
}
