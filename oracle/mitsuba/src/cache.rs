//! Images by what they are images of.
use std::path::{Path, PathBuf};

use files::sha256::hex;
use files::{FileError, read_radiance};
use sha2::{Digest, Sha256};
use sim::mitsuba::SceneFiles;
use sim::vector::RadianceImage;

use super::{MitsubaError, VARIANT, VERSION};

/// A folder of images. Several processes may use it at once: an image gets its name when it is complete, and two that
/// make the same one make the same bits.
#[derive(Debug, Clone)]
pub(super) struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// The folder, made if need be; without one asked for, `boresight/mitsuba` where the user keeps caches
    /// (`XDG_CACHE_HOME`, `LOCALAPPDATA`, or `.cache` in `HOME`), and without that among temporary files.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be made.
    pub(super) fn open(asked_for: Option<&Path>) -> Result<Self, FileError> {
        let folder = asked_for.map_or_else(users_own, Path::to_owned);
        std::fs::create_dir_all(&folder).map_err(|source| FileError::Io {
            path: folder.clone(),
            doing: "create",
            source,
        })?;
        Ok(Self { folder })
    }

    /// Where the image of a scene is, once it is made: named by the SHA-256 of all that it depends on.
    pub(super) fn place(&self, scene: &SceneFiles) -> PathBuf {
        let mut hash = Sha256::new();
        let mut part = |bytes: &[u8]| {
            // With its length before it, no part can pass for the end of the one before.
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

    /// A fresh folder beside the images, gone when it is dropped.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be made.
    pub(super) fn workshop(&self) -> Result<tempfile::TempDir, FileError> {
        tempfile::Builder::new().prefix("render-").tempdir_in(&self.folder).map_err(|source| FileError::Io {
            path: self.folder.clone(),
            doing: "create a folder in",
            source,
        })
    }
}

/// Reads an image and judges it: the size of the crop, every radiance finite and not negative. The exit status does not
/// say so: a reflectance without a value renders with success.
pub(super) fn read_judged(
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

fn users_own() -> PathBuf {
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable("XDG_CACHE_HOME")
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| variable("HOME").map(|home| home.join(".cache")))
        .unwrap_or_else(std::env::temp_dir)
        .join("boresight/mitsuba")
}
