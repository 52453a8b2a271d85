//! A place for files that nobody keeps.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use files::Failure;
use tempfile::TempDir;

/// How the names of these directories begin.
const PREFIX: &str = "boresight-scratch-";
/// The file in each that its process holds a lock on. A directory without it is somebody's, whatever its name.
const MARK: &str = ".boresight-scratch";
/// A process that has made one locks it at once.
const UNLOCKED: Duration = Duration::from_secs(3600);

/// Those of this process.
static PLACES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A directory for files that nobody keeps; gone with the value.
pub(super) struct ScratchDirectory {
    directory: TempDir,
    /// Held as long as the process lives, whatever ends it: so one that was left is told from one that is used.
    _lock: Option<File>,
}

impl ScratchDirectory {
    /// Makes one in a folder, and removes those of processes that were killed.
    ///
    /// # Errors
    /// [`Failure::Usage`] when none can be made there.
    pub(super) fn create(folder: &Path) -> Result<Self, Failure> {
        remove_abandoned(folder);
        // Held meanwhile: whoever removes them all knows this one too.
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

/// Removes those of this process, which is about to end without dropping them.
#[cfg(unix)]
pub(super) fn remove_all() {
    for directory in directories().iter() {
        // Another thread may put a file there meanwhile.
        let _ = std::fs::remove_dir_all(directory).or_else(|_| std::fs::remove_dir_all(directory));
    }
}

fn directories() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    PLACES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what processes left that were killed. That it cannot be done is no matter: nobody reads it.
fn remove_abandoned(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let age = entry.metadata().and_then(|metadata| metadata.modified()).ok();
        let age = age.and_then(|modified| SystemTime::now().duration_since(modified).ok());
        let is_old = entry.file_name().to_string_lossy().starts_with(PREFIX)
            && entry.file_type().is_ok_and(|kind| kind.is_dir())
            && age.is_some_and(|age| age > UNLOCKED);
        if is_old && File::open(path.join(MARK)).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_dir_all(&path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a directory of two hours ago.
    fn old_directory(folder: &Path, name: &str, file: &str) -> PathBuf {
        let path = folder.join(name);
        std::fs::create_dir(&path).unwrap();
        std::fs::write(path.join(file), "kept").unwrap();
        File::open(&path).unwrap().set_modified(SystemTime::now() - 2 * UNLOCKED).unwrap();
        path
    }

    #[test]
    fn what_a_process_left_is_removed_and_nothing_else() {
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
