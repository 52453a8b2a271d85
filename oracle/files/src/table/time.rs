//! Times in files: the simulator's reader and writer of UTC, with the description for the error of a cell.

use hifitime::Epoch;
use sim::truth::clock;

/// Formats an epoch as `2012-04-25T13:02:07.250000000Z`; see [`clock::format_utc`].
pub fn format_utc(epoch: Epoch) -> String {
    clock::format_utc(epoch)
}

/// Parses a UTC time; see [`clock::parse_utc`].
///
/// # Errors
/// Description of the expected text.
pub fn parse_utc(text: &str) -> Result<Epoch, String> {
    clock::parse_utc(text).map_err(|error| error.expected)
}
