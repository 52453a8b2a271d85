//! A folder of its own for the files that readers are given.

use std::io::Result;
use std::path::{Path, PathBuf};

/// A folder, in memory where the system has one there; removed in the end.
#[derive(Debug)]
pub struct Sandbox(tempfile::TempDir);

impl Sandbox {
    /// Makes one.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn new() -> Result<Self> {
        let in_memory = Path::new("/dev/shm");
        if in_memory.is_dir() { tempfile::tempdir_in(in_memory) } else { tempfile::tempdir() }.map(Self)
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// Writes a file, in the place of an earlier one, with the folders above it.
    ///
    /// # Panics
    /// When it cannot be written.
    #[expect(
        clippy::expect_used,
        reason = "without its file an input tests nothing, and must not pass for tested"
    )]
    pub(crate) fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path().join(name);
        let folder = path.parent().unwrap_or_else(|| self.path());
        let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&path, bytes));
        written.expect("the sandbox can be written");
        path
    }
}
