//! A place for files that nobody keeps.

use files::Failure;

/// A directory for files that nobody keeps; gone with the value.
pub(super) fn scratch_directory() -> Result<tempfile::TempDir, Failure> {
    tempfile::tempdir()
        .map_err(|error| Failure::Usage(format!("a temporary directory cannot be made: {error}")))
}
