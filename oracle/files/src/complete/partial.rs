//! Files that are not there until they are complete.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use super::atomic_file::{PARTIAL, output_taken};
use crate::{AtomicFile, FileError};

/// Files that get their names when they are complete; until then they go by names of their own, and are removed when
/// the value is dropped.
#[derive(Debug)]
pub struct PartialFiles {
    names: Vec<PathBuf>,
    paths: Vec<PathBuf>,
}

impl PartialFiles {
    /// Files that will be `names`; none of them may exist.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] when one does; [`FileError::Io`] when there is no folder for one.
    pub fn for_paths(names: &[&Path]) -> Result<Self, FileError> {
        for name in names {
            if name.exists() {
                return Err(output_taken(name));
            }
            folder_of(name).metadata().map_err(|source| FileError::io(name, "create", source))?;
        }
        // Nobody else's: another process may be making the same files.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let own = format!("{}-{}", process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let partial = |name: &PathBuf| {
            let file = name.file_name().map_or_else(String::new, |file| file.to_string_lossy().into_owned());
            name.with_file_name(format!("{PARTIAL}{file}-{own}"))
        };
        let names: Vec<PathBuf> = names.iter().map(|name| name.to_path_buf()).collect();
        let files = Self { paths: names.iter().map(partial).collect(), names };
        files.remove(); // What a process of the same number left that was killed.
        files.names.iter().map(|name| folder_of(name)).for_each(AtomicFile::remove_abandoned);
        Ok(files)
    }

    /// Where the file of the name number `index` is written meanwhile.
    ///
    /// # Panics
    /// For an index that is not below the number of names.
    #[expect(clippy::indexing_slicing, reason = "the writer's own constant, nothing that was read")]
    pub fn path(&self, index: usize) -> &Path {
        &self.paths[index]
    }

    /// Gives the files their names, the first one last: nobody looks for the others without it. Of two processes that make the same
    /// files the first one does it.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] when a file of that name has come up meanwhile; [`FileError::Io`].
    pub fn complete(self) -> Result<(), FileError> {
        for (path, name) in self.paths.iter().zip(&self.names).rev() {
            // A link, unlike a renaming, never replaces a file.
            std::fs::hard_link(path, name).map_err(|source| match source.kind() {
                ErrorKind::AlreadyExists => output_taken(name),
                _ => FileError::io(name, "create", source),
            })?;
        }
        Ok(())
    }

    fn remove(&self) {
        for path in &self.paths {
            // It may not be there.
            let _ = std::fs::remove_file(path);
        }
    }
}

fn folder_of(name: &Path) -> &Path {
    name.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

impl Drop for PartialFiles {
    fn drop(&mut self) {
        self.remove();
    }
}
