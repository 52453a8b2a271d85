//! Files and directories that appear only when complete, and checksums of their contents at that time.

pub(crate) mod atomic_file;
mod checksums;
mod directory;
pub(crate) mod partial;
pub mod sha256;

pub use atomic_file::{AtomicFile, ReplaceableFile};
pub use checksums::{Checksums, file_sha256};
pub use directory::{RunDirectory, create_empty_directory, create_numbered_directory, refuse_unfinished};
pub use partial::PartialFiles;
