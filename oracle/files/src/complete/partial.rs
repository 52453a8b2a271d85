//! Files that become visible only when complete.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use super::atomic_file::{PARTIAL, create_folder_of, output_taken};
use crate::{AtomicFile, FileError};

/// Output files that get their names when they are complete; until then they have temporary names, and are
/// removed when the value is dropped.
#[derive(Debug)]
pub struct PartialFiles {
    names: Vec<PathBuf>,
    paths: Vec<PathBuf>,
}

impl PartialFiles {
    /// Prepares files for `names`, none of which may exist, and creates the missing folders above them.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if one exists; [`FileError::Io`] if a folder cannot be created.
    pub fn for_paths(names: &[&Path]) -> Result<Self, FileError> {
        for name in names {
            if name.exists() {
                return Err(output_taken(name));
            }
        }
        let mut folders = Vec::new();
        for name in names {
            folders.push(create_folder_of(name)?);
        }
        // Unique name: another process may be writing the same files.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let own = format!("{}-{}", process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let partial = |name: &PathBuf| {
            let file = name.file_name().map_or_else(String::new, |file| file.to_string_lossy().into_owned());
            name.with_file_name(format!("{PARTIAL}{file}-{own}"))
        };
        let names: Vec<PathBuf> = names.iter().map(|name| name.to_path_buf()).collect();
        let files = Self { paths: names.iter().map(partial).collect(), names };
        files.remove(); // What a process of the same number left that was killed.
        folders.into_iter().for_each(AtomicFile::remove_abandoned);
        Ok(files)
    }

    /// Returns the temporary path of the file with name number `index`.
    ///
    /// # Panics
    /// If `index` is not below the number of names.
    #[expect(clippy::indexing_slicing, reason = "the writer's own constant, nothing that was read")]
    pub fn path(&self, index: usize) -> &Path {
        &self.paths[index]
    }

    /// Gives the files their names, the first name last: readers look for the other files only if the first
    /// exists. Of two processes that write the same files, the first to complete succeeds.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if a file of that name has appeared in the meantime; [`FileError::Io`].
    pub fn complete(self) -> Result<(), FileError> {
        for (path, name) in self.paths.iter().zip(&self.names).rev() {
            // A hard link, unlike a rename, never replaces a file.
            std::fs::hard_link(path, name).map_err(|source| match source.kind() {
                ErrorKind::AlreadyExists => output_taken(name),
                _ => FileError::io(name, "create", source),
            })?;
        }
        Ok(())
    }

    fn remove(&self) {
        for path in &self.paths {
            // The file may not exist.
            let _ = std::fs::remove_file(path);
        }
    }
}

impl Drop for PartialFiles {
    fn drop(&mut self) {
        self.remove();
    }
}
