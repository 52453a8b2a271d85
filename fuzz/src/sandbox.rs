//! Temporary directory for the files passed to the readers.

use std::io::Result;
use std::path::{Path, PathBuf};

/// A temporary directory, in memory if the system provides `/dev/shm`; removed on drop.
#[derive(Debug)]
pub struct Sandbox {
    folder: tempfile::TempDir,
    /// True if what is read is also written and read again.
    writes: bool,
}

impl Sandbox {
    /// Creates the directory.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn new() -> Result<Self> {
        let in_memory = Path::new("/dev/shm");
        let folder = if in_memory.is_dir() { tempfile::tempdir_in(in_memory) } else { tempfile::tempdir() }?;
        Ok(Self { folder, writes: true })
    }

    /// Returns the sandbox for targets that only read.
    #[must_use]
    pub fn reading_only(self) -> Self {
        Self { writes: false, ..self }
    }

    /// Returns true if what is read is also written and read again.
    pub(crate) fn writes(&self) -> bool {
        self.writes
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the path of a file that does not exist; an earlier file of that name is removed.
    pub(crate) fn fresh(&self, name: &str) -> PathBuf {
        let path = self.path().join(name);
        let _ = std::fs::remove_file(&path);
        path
    }

    /// Writes a file, replacing an earlier one, and creates its parent directories.
    ///
    /// # Panics
    /// If the file cannot be written.
    #[expect(
        clippy::expect_used,
        reason = "an input whose file cannot be written is not tested and must not pass"
    )]
    pub(crate) fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path().join(name);
        let folder = path.parent().unwrap_or_else(|| self.path());
        let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&path, bytes));
        written.expect("the sandbox can be written");
        path
    }
}
