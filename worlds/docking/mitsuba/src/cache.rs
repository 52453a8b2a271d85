//! Cache of rendered images, named by the digest of their inputs.

use std::fs::File;
use std::path::{Path, PathBuf};

use files::sha256::hex;
use files::{FileError, read_radiance};
use sha2::{Digest, Sha256};
use sim::mitsuba::SceneFiles;
use sim::vector::RadianceImage;

use super::{MitsubaError, VARIANT, VERSION};

/// Prefix of the names of rendering directories.
const RENDER: &str = "render-";
/// Name of the file in a rendering directory that the process holds locked.
const LOCK: &str = "in-use";

/// A directory of images that several processes may use at once. An image receives its name when it is
/// complete, and two processes that render the same image produce the same bits.
#[derive(Debug, Clone)]
pub(super) struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// Opens the directory and creates it if necessary. Without `asked_for` it is `boresight/mitsuba` in the
    /// user's cache directory (`XDG_CACHE_HOME`, `LOCALAPPDATA`, or `.cache` in `HOME`), or in the directory
    /// for temporary files if none of these is set.
    ///
    /// # Errors
    /// [`FileError::Io`] when the directory cannot be created.
    pub(super) fn open(asked_for: Option<&Path>) -> Result<Self, FileError> {
        let folder = asked_for.map_or_else(user_cache_folder, Path::to_owned);
        std::fs::create_dir_all(&folder).map_err(|source| FileError::Io {
            path: folder.clone(),
            doing: "create",
            source,
        })?;
        Ok(Self { folder })
    }

    /// Path of the finished image of a scene, named by the SHA-256 of everything that the image depends on.
    pub(super) fn entry_path(&self, scene: &SceneFiles) -> PathBuf {
        let mut hash = Sha256::new();
        let mut part = |bytes: &[u8]| {
            // The length before each part keeps the boundaries of the parts unambiguous.
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        part(VERSION.as_bytes());
        part(VARIANT.as_bytes());
        part(scene.xml.as_bytes());
        for mesh in &scene.meshes {
            part(mesh.file.as_bytes());
            part(&mesh.ply);
        }
        self.folder.join(hex(hash.finalize()) + ".exr")
    }

    /// Creates a new directory beside the images, which is removed when it is dropped. Directories of killed
    /// processes are removed first.
    ///
    /// # Errors
    /// [`FileError::Io`] when the directory cannot be created.
    pub(super) fn scratch_folder(&self) -> Result<ScratchFolder, FileError> {
        let io = |source| FileError::Io { path: self.folder.clone(), doing: "create a directory in", source };
        self.remove_abandoned();
        let folder = tempfile::Builder::new().prefix(RENDER).tempdir_in(&self.folder).map_err(io)?;
        // The file is locked before other processes can find it under its final name.
        let preliminary = folder.path().join("locking");
        let lock = File::create(&preliminary).map_err(io)?;
        lock.try_lock().map_err(|error| io(error.into()))?;
        std::fs::rename(preliminary, folder.path().join(LOCK)).map_err(io)?;
        Ok(ScratchFolder { folder, _lock: lock })
    }

    /// Removes the rendering directories that no process has locked. A failure to remove them is ignored: no
    /// process reads them.
    fn remove_abandoned(&self) {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten().flatten();
        for path in entries.map(|entry| entry.path()) {
            let is_render = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(RENDER));
            let is_free = || File::open(path.join(LOCK)).is_ok_and(|lock| lock.try_lock().is_ok());
            if is_render && is_free() {
                let _ = std::fs::remove_dir_all(path);
            }
        }
    }
}

/// A directory for one rendering. Its lock, which ends with the process, marks the directory as in use for
/// other processes.
pub(super) struct ScratchFolder {
    // Dropped first: the lock is held until the directory is removed.
    folder: tempfile::TempDir,
    _lock: File,
}

impl ScratchFolder {
    /// Path of the directory.
    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Reads an image and validates it: its size must be that of the crop, and every radiance finite and not
/// negative. The exit status does not suffice: a scene with an undefined reflectance renders with success.
pub(super) fn read_validated(
    path: &Path,
    scene: &SceneFiles,
    layer: &'static str,
) -> Result<RadianceImage, MitsubaError> {
    let image = read_radiance(path)?;
    let problem = |problem| Err(MitsubaError::Image { layer, problem });
    if (image.columns, image.rows) != (scene.crop.columns, scene.crop.rows) {
        let (columns, rows) = (scene.crop.columns, scene.crop.rows);
        return problem(format!("has {}×{} px, expected {columns}×{rows}", image.columns, image.rows));
    }
    match image.radiance.iter().enumerate().find(|(_, v)| !(v.is_finite() && **v >= 0.0)) {
        None => Ok(image),
        Some((at, radiance)) => {
            let (x, y) = (at % image.columns, at / image.columns);
            problem(format!("has the radiance {radiance} at pixel ({x}, {y}), expected 0 or more"))
        }
    }
}

fn user_cache_folder() -> PathBuf {
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable("XDG_CACHE_HOME")
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| variable("HOME").map(|home| home.join(".cache")))
        .unwrap_or_else(std::env::temp_dir)
        .join("boresight/mitsuba")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_killed_processes_are_removed_and_those_in_use_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(Some(folder.path())).unwrap();
        let abandoned = folder.path().join("render-abc");
        std::fs::create_dir(&abandoned).unwrap();
        for file in [LOCK, "scene.xml"] {
            std::fs::write(abandoned.join(file), "").unwrap();
        }
        std::fs::write(folder.path().join("0123.exr"), "").unwrap();

        let first = cache.scratch_folder().unwrap();
        assert!(!abandoned.exists());
        let second = cache.scratch_folder().unwrap();
        assert!(first.path().exists() && second.path().exists());
        drop((first, second));
        let left: Vec<_> =
            std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["0123.exr"]);
    }
}
