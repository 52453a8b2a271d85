//! Temporary directories.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use files::Failure;
use tempfile::TempDir;

/// Prefix of the names of temporary directories.
const PREFIX: &str = "boresight-scratch-";
/// File in each temporary directory on which its process holds a lock. A directory without this file belongs
/// to the user, regardless of its name.
const MARK: &str = ".boresight-scratch";
/// Minimum age of a directory before it is removed; a process locks a new directory at once.
const MIN_AGE: Duration = Duration::from_secs(3600);

/// Temporary directories of this process.
static DIRECTORIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A temporary directory, removed when the value is dropped.
pub(super) struct ScratchDirectory {
    directory: TempDir,
    /// Held as long as the process lives, however it ends: this distinguishes an abandoned directory from one
    /// in use.
    _lock: Option<File>,
}

impl ScratchDirectory {
    /// Creates a temporary directory in `folder`, and removes those of killed processes.
    ///
    /// # Errors
    /// [`Failure::Usage`] if no directory can be created there.
    pub(super) fn create(folder: &Path) -> Result<Self, Failure> {
        remove_abandoned(folder);
        // The lock on the list is held during creation, to include this directory in any concurrent removal
        // of all.
        let mut directories = directories();
        let directory = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder).map_err(|error| {
            Failure::Usage(format!("a temporary directory cannot be made in {}: {error}", folder.display()))
        })?;
        let lock = File::create_new(directory.path().join(MARK)).ok().filter(|file| file.try_lock().is_ok());
        directories.push(directory.path().to_owned());
        Ok(Self { directory, _lock: lock })
    }

    pub(super) fn path(&self) -> &Path {
        self.directory.path()
    }
}

impl Drop for ScratchDirectory {
    fn drop(&mut self) {
        directories().retain(|directory| directory != self.directory.path());
    }
}

/// Removes the temporary directories of this process, which is about to end without dropping them.
#[cfg(unix)]
pub(super) fn remove_all() {
    for directory in directories().iter() {
        // Another thread may create a file there in the meantime.
        let _ = std::fs::remove_dir_all(directory).or_else(|_| std::fs::remove_dir_all(directory));
    }
}

fn directories() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    DIRECTORIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the directories of killed processes. Errors are ignored, because no process reads these
/// directories.
fn remove_abandoned(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let age = entry.metadata().and_then(|metadata| metadata.modified()).ok();
        let age = age.and_then(|modified| SystemTime::now().duration_since(modified).ok());
        let is_old = entry.file_name().to_string_lossy().starts_with(PREFIX)
            && entry.file_type().is_ok_and(|kind| kind.is_dir())
            && age.is_some_and(|age| age > MIN_AGE);
        if is_old && File::open(path.join(MARK)).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_dir_all(&path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a directory that is two hours old.
    fn old_directory(folder: &Path, name: &str, file: &str) -> PathBuf {
        let path = folder.join(name);
        std::fs::create_dir(&path).unwrap();
        std::fs::write(path.join(file), "kept").unwrap();
        File::open(&path).unwrap().set_modified(SystemTime::now() - 2 * MIN_AGE).unwrap();
        path
    }

    #[test]
    fn only_leftovers_of_ended_processes_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let old = |name: &str, file: &str| old_directory(folder.path(), name, file);
        let left = old("boresight-scratch-left", MARK);
        let kept = [
            old("boresight-scratch-results", "score.json"),
            old("boresight-run-1", "score.json"),
            old("results", MARK),
        ];
        let used = old("boresight-scratch-used", MARK);
        let lock = File::open(used.join(MARK)).unwrap();
        lock.lock().unwrap();
        let own = ScratchDirectory::create(folder.path()).unwrap();
        assert!(!left.exists());
        assert!(kept.iter().chain([&used]).all(|path| path.exists()));
        let path = own.path().to_owned();
        drop(own);
        assert!(!path.exists());
    }
}
