//! Files that appear complete or not at all: written under a temporary name, synced and then renamed.

use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use tempfile::NamedTempFile;

use crate::FileError;

/// Prefix of the names of files that are being written or were left by a killed process.
pub(crate) const PARTIAL: &str = ".partial-";

/// Age after which a partial file counts as left by a killed process: a file that is still being written
/// grows.
const MAX_PARTIAL_AGE: Duration = Duration::from_secs(3600);

/// Number of bytes at the beginning of a file that identify its kind.
const BEGINNING_BYTES: u64 = 1 << 16;

/// A kind of file whose newer files may replace older ones.
#[derive(Clone, Copy)]
pub struct ReplaceableFile<'a> {
    /// Description of the kind, for example `an earlier report`.
    pub description: &'a str,
    /// Returns true if a file with this beginning is of the kind.
    pub matches: &'a dyn Fn(&[u8]) -> bool,
}

impl ReplaceableFile<'_> {
    /// Rejects a path that holds something else: a directory, a link, a device, a file of another kind, or a
    /// read-only file.
    ///
    /// # Errors
    /// [`FileError::NotReplaced`]; [`FileError::Io`] if the file cannot be read.
    pub fn check(&self, path: &Path) -> Result<(), FileError> {
        let refused = |reason: &str| {
            let (path, expected) =
                (path.to_owned(), format!("an unused name, or the name of {}", self.description));
            Err(FileError::NotReplaced { path, reason: reason.to_owned(), expected })
        };
        let error = |source| FileError::io(path, "open", source);
        let metadata = match path.symlink_metadata() {
            Ok(metadata) => metadata,
            // The writer reports a parent that is missing or not a directory.
            Err(source) if matches!(source.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                return Ok(());
            }
            Err(source) => return Err(error(source)),
        };
        if !metadata.is_file() {
            return refused("exists and is not a regular file");
        }
        let mut beginning = Vec::new();
        let file = config::regular_file::open(path).map_err(error)?;
        file.take(BEGINNING_BYTES).read_to_end(&mut beginning).map_err(error)?;
        if !(self.matches)(&beginning) {
            return refused("exists and is a file of another kind");
        }
        if metadata.permissions().readonly() { refused("exists and is read-only") } else { Ok(()) }
    }
}

/// Creates the folder of a file that will be written, with all folders above it, and returns its path.
///
/// # Errors
/// [`FileError::Io`] if it cannot be created.
pub(super) fn create_folder_of(path: &Path) -> Result<&Path, FileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(|source| FileError::io(path, "create", source))?;
    Ok(folder)
}

/// A file that is being written; removed on drop unless it has been committed.
#[derive(Debug)]
pub struct AtomicFile {
    file: NamedTempFile,
    path: PathBuf,
}

impl AtomicFile {
    /// Creates an empty temporary file, readable by all users, that will become `path`, and the missing
    /// folders above it.
    ///
    /// # Errors
    /// [`FileError::Io`] if it cannot be created in the directory of `path`.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let folder = create_folder_of(path)?;
        let mut builder = tempfile::Builder::new();
        // Normal permissions of a file, instead of access for the owner only.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // The name identifies the file it belongs to, but has a different ending than a complete file, so no
        // search for tables finds it.
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let file = builder.prefix(&format!("{PARTIAL}{name}-")).tempfile_in(folder);
        let file = file.map_err(|source| FileError::io(path, "create", source))?;
        Ok(Self { file, path: path.to_owned() })
    }

    /// Creates a temporary file like [`AtomicFile::create`], for a path that does not exist yet.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if the path exists; [`FileError::Io`] if the file cannot be created.
    pub fn create_new(path: &Path) -> Result<Self, FileError> {
        if path.symlink_metadata().is_ok() {
            return Err(output_taken(path));
        }
        Self::create(path)
    }

    /// Creates a temporary file that will become `path`, and writes `text` to it.
    ///
    /// # Errors
    /// [`FileError::Io`] if it cannot be written.
    pub fn with_text(path: &Path, text: &str) -> Result<Self, FileError> {
        let mut file = Self::create(path)?;
        file.file.write_all(text.as_bytes()).map_err(|source| FileError::io(path, "write", source))?;
        Ok(file)
    }

    /// Changes the final path of the file to another path in the same directory.
    pub fn with_path(self, path: &Path) -> Self {
        Self { path: path.to_owned(), ..self }
    }

    /// Returns the file for writing.
    pub fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Returns the temporary path of the file.
    pub fn temporary_path(&self) -> &Path {
        self.file.path()
    }

    /// Returns true if `path` has the name of a partial file.
    pub fn is_partial(path: &Path) -> bool {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PARTIAL))
    }

    /// Syncs the file and gives it its name. If a file of that name exists, returns this file instead.
    ///
    /// # Errors
    /// [`FileError::Io`] if it cannot be synced or named.
    pub fn commit(self) -> Result<Option<Self>, FileError> {
        self.sync()?;
        let Self { file, path } = self;
        match file.persist_noclobber(&path) {
            Ok(_) => Ok(None),
            Err(error) if error.error.kind() == ErrorKind::AlreadyExists => {
                Ok(Some(Self { file: error.file, path }))
            }
            Err(error) => Err(FileError::io(&path, "create", error.error)),
        }
    }

    /// Syncs the file and gives it its name, which must be free.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if a file of that name exists, [`FileError::Io`] if the file cannot be
    /// synced or named.
    pub fn commit_new(self) -> Result<(), FileError> {
        match self.commit()? {
            None => Ok(()),
            Some(Self { path, .. }) => Err(output_taken(&path)),
        }
    }

    /// Syncs the file and gives it its name, replacing an earlier file of its kind.
    ///
    /// # Errors
    /// Those of [`ReplaceableFile::check`]; [`FileError::Io`] if it cannot be synced or named.
    pub fn replace(self, earlier: ReplaceableFile<'_>) -> Result<(), FileError> {
        earlier.check(&self.path)?;
        self.sync()?;
        let Self { file, path } = self;
        file.persist(&path).map(drop).map_err(|error| FileError::io(&path, "create", error.error))
    }

    /// Removes the partial files that killed processes left in a directory, an hour after the last write.
    /// Failures are ignored, because no process reads these files.
    pub fn remove_abandoned(folder: &Path) {
        Self::remove_abandoned_of(folder, Self::is_partial);
    }

    /// Works like [`AtomicFile::remove_abandoned`], for the files that `is` selects.
    pub fn remove_abandoned_of(folder: &Path, is: impl Fn(&Path) -> bool) {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for path in entries.map(|entry| entry.path()).filter(|path| is(path)) {
            let modified = path.symlink_metadata().and_then(|metadata| metadata.modified());
            let age = modified.ok().and_then(|modified| SystemTime::now().duration_since(modified).ok());
            if age.is_some_and(|age| age > MAX_PARTIAL_AGE) {
                let _ = std::fs::remove_file(path);
            }
        }
    }

    fn sync(&self) -> Result<(), FileError> {
        self.file.as_file().sync_all().map_err(|source| FileError::io(&self.path, "write", source))
    }
}

/// Returns the error of an output path that already exists.
pub(crate) fn output_taken(path: &Path) -> FileError {
    FileError::OutputTaken { path: path.to_owned(), reason: "exists; nothing is overwritten" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_on_commit_and_overwrites_only_on_request() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        drop(AtomicFile::with_text(&path, "lost").unwrap());
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        assert!(AtomicFile::with_text(&path, "first").unwrap().commit().unwrap().is_none());
        let second = AtomicFile::with_text(&path, "second").unwrap().commit().unwrap().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "first");
        let earlier = |beginning: &'static [u8]| move |bytes: &[u8]| bytes == beginning;
        let foreign = ReplaceableFile { description: "an earlier one", matches: &earlier(b"zeroth") };
        let refused = foreign.check(&path).unwrap_err().to_string();
        assert!(
            refused
                .contains("a file of another kind, expected an unused name, or the name of an earlier one"),
            "{refused}"
        );
        assert!(foreign.check(folder.path()).unwrap_err().to_string().contains("not a regular file"));
        let first = ReplaceableFile { description: "an earlier one", matches: &earlier(b"first") };
        let set_readonly = |readonly| {
            let mut permissions = std::fs::metadata(&path).unwrap().permissions();
            permissions.set_readonly(readonly);
            std::fs::set_permissions(&path, permissions).unwrap();
        };
        set_readonly(true);
        assert!(first.check(&path).unwrap_err().to_string().contains("is read-only"));
        #[allow(clippy::permissions_set_readonly_false, reason = "in a folder of this test")]
        set_readonly(false);
        second.replace(first).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "second");
        let taken = AtomicFile::with_text(&path, "third").unwrap().commit_new().unwrap_err();
        assert!(taken.to_string().contains("nothing is overwritten"), "{taken}");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    }

    #[test]
    fn temporary_files_older_than_an_hour_are_removed_and_open_ones_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "whole").unwrap();
        let [old, new] = [(); 2].map(|()| AtomicFile::with_text(&path, "part").unwrap());
        for file in [old.file(), &File::options().append(true).open(&path).unwrap()] {
            file.set_modified(SystemTime::now() - MAX_PARTIAL_AGE - Duration::from_secs(1)).unwrap();
        }
        AtomicFile::remove_abandoned(folder.path());
        assert_eq!(
            [old.temporary_path().exists(), new.temporary_path().exists(), path.exists()],
            [false, true, true]
        );
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_it_as_any_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [whole, plain] = ["whole", "plain"].map(|name| folder.path().join(name));
        AtomicFile::with_text(&whole, "").unwrap().commit_new().unwrap();
        std::fs::write(&plain, "").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&whole), mode(&plain));
    }
}
