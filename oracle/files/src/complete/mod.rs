//! Files and directories that are whole or not there, and what their bits were when they were written.

mod checksums;
mod directory;
pub(crate) mod partial;
pub mod sha256;
pub(crate) mod whole_file;

pub use checksums::{Checksums, file_sha256};
pub use directory::{RunDirectory, refuse_unfinished};
pub use partial::PartialFiles;
pub use whole_file::{Earlier, WholeFile};
