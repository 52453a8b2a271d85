//! Times in files: the simulator's reader and writer of UTC, with the words that a cell's error needs.

use hifitime::Epoch;
use sim::truth::clock;

/// An epoch as `2012-04-25T13:02:07.250000000Z`; see [`clock::format_utc`].
pub fn format_utc(epoch: Epoch) -> String {
    clock::format_utc(epoch)
}

/// Reads a UTC time; see [`clock::parse_utc`].
///
/// # Errors
/// What was expected.
pub fn parse_utc(text: &str) -> Result<Epoch, String> {
    clock::parse_utc(text).map_err(|error| error.expected)
}
