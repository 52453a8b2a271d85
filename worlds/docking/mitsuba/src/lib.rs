//! Mitsuba 3, the reference for the fast renderer: finds Mitsuba, runs it, and caches its images.
//!
//! Mitsuba is an external program (`pip install mitsuba==3.9.1`). Its input is made by [`sim::mitsuba`].

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod cache;
mod command;
mod error;
mod process;
mod version;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use cache::{Cache, read_validated};
use command::MitsubaCommand;
use contract::docking::Pose;
use contract::{Camera, OutOfRange};
pub use error::MitsubaError;
use files::FileError;
use process::{ProcessEnd, last_output};
use sim::SimError;
use sim::mitsuba::{Layer, SceneFiles, Settings};
use sim::scene::docking::{DockingScene, Lighting};
use sim::vector::RadianceImage;
pub use version::{VARIANT, VERSION};

/// Number of threads per rendering. With one or two threads Mitsuba can hang while it writes the image. The
/// bits of the image do not depend on the number of threads.
const THREADS: &str = "4";

/// Exit status with which Mitsuba refuses a scene.
const SCENE_REFUSED: i32 = 255;

/// Options for the use of Mitsuba.
#[derive(Debug, Clone, PartialEq)]
pub struct MitsubaOptions {
    /// Command of Mitsuba, split as by a shell; `None`: that of `BORESIGHT_MITSUBA`, or `mitsuba`, or `uvx`.
    pub command: Option<String>,
    /// Directory of finished images; `None`: the user's cache directory.
    pub cache: Option<PathBuf>,
    /// Time limit per layer of an image, s, greater than 0.
    pub time_limit_s: f64,
    /// Rays per pixel, and the part of the image.
    pub settings: Settings,
}

impl Default for MitsubaOptions {
    /// The command is found automatically; the user's cache, 15 minutes per layer, the whole image with 256
    /// rays per pixel.
    fn default() -> Self {
        Self { command: None, cache: None, time_limit_s: 900.0, settings: Settings::default() }
    }
}

/// Renders docking scenes with Mitsuba. Images that any process has rendered before are read from the cache,
/// and do not require Mitsuba.
#[derive(Debug)]
pub struct MitsubaRenderer {
    options: MitsubaOptions,
    limit: Duration,
    cache: Cache,
    /// The command, once it is found and its version checked.
    command: OnceLock<MitsubaCommand>,
}

impl MitsubaRenderer {
    /// Opens the cache. Mitsuba is searched for when it is first needed.
    ///
    /// # Errors
    /// [`MitsubaError::Simulation`] for an invalid time limit, [`MitsubaError::File`] for a cache that cannot
    /// be created.
    pub fn new(options: MitsubaOptions) -> Result<Self, MitsubaError> {
        let limit = Duration::try_from_secs_f64(options.time_limit_s).ok().filter(|limit| !limit.is_zero());
        let limit = limit.ok_or_else(|| {
            let (path, value) = ("time limit of Mitsuba, s", options.time_limit_s);
            SimError::from(OutOfRange::new(path, value, "greater than 0"))
        })?;
        let cache = Cache::open(options.cache.as_deref())?;
        Ok(Self { options, limit, cache, command: OnceLock::new() })
    }

    /// Returns the mean radiance over each pixel of the camera (or of the crop), in the form of
    /// [`sim::vector::Drawer::draw`].
    ///
    /// # Errors
    /// A [`MitsubaError`]: Mitsuba is missing or of another version, it fails or exceeds the time limit, its
    /// image is invalid, or the scene or the camera cannot be described to it.
    pub fn radiance(
        &self,
        scene: &DockingScene,
        lighting: &Lighting,
        pose: &Pose,
        camera: &Camera,
    ) -> Result<RadianceImage, MitsubaError> {
        let crop = self.options.settings.check(camera).map_err(SimError::from)?;
        let mut sum = RadianceImage {
            columns: crop.columns,
            rows: crop.rows,
            radiance: vec![0.0; crop.columns * crop.rows],
        };
        for layer in Layer::from_lighting(lighting)? {
            let files = SceneFiles::new(scene, &layer, pose, camera, &self.options.settings)?;
            let image = self.layer(&files, layer.name())?;
            for (total, part) in sum.radiance.iter_mut().zip(&image.radiance) {
                *total += part;
            }
        }
        Ok(sum)
    }

    fn layer(&self, scene: &SceneFiles, layer: &'static str) -> Result<RadianceImage, MitsubaError> {
        let entry_path = self.cache.entry_path(scene);
        // A damaged file in the cache is rendered anew.
        if let Ok(image) = read_validated(&entry_path, scene, layer) {
            return Ok(image);
        }
        let scratch_folder = self.cache.scratch_folder()?;
        let command = self.command(scratch_folder.path())?;
        let fresh = self.render(command, scene, layer, scratch_folder.path())?;
        let image = read_validated(&fresh, scene, layer)?;
        std::fs::rename(&fresh, &entry_path).map_err(|source| FileError::Io {
            path: entry_path,
            doing: "create",
            source,
        })?;
        Ok(image)
    }

    fn command(&self, folder: &Path) -> Result<&MitsubaCommand, MitsubaError> {
        if let Some(command) = self.command.get() {
            return Ok(command);
        }
        let command = MitsubaCommand::find(self.options.command.as_deref())?;
        command.check(folder, self.limit)?;
        Ok(self.command.get_or_init(|| command))
    }

    fn render(
        &self,
        command: &MitsubaCommand,
        scene: &SceneFiles,
        layer: &'static str,
        folder: &Path,
    ) -> Result<PathBuf, MitsubaError> {
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            std::fs::write(&path, bytes).map_err(|source| FileError::Io { path, doing: "write", source })
        };
        write("scene.xml", scene.xml.as_bytes())?;
        for mesh in &scene.meshes {
            write(&mesh.file, &mesh.ply)?;
        }
        let arguments = ["-m", VARIANT, "-t", THREADS, "-o", "image.exr", "scene.xml"];
        let (end, log) = command.run(&arguments, folder, self.limit)?;
        let doing = format!("rendering the layer {layer}");
        match end {
            ProcessEnd::Exited(status) if status.success() => Ok(folder.join("image.exr")),
            ProcessEnd::TimeLimit => Err(MitsubaError::TimeLimit {
                limit_s: self.options.time_limit_s,
                doing,
                words: last_output(&log),
            }),
            ProcessEnd::Exited(status) if status.code() == Some(SCENE_REFUSED) => {
                Err(MitsubaError::Scene { doing, words: last_output(&log) })
            }
            ProcessEnd::Exited(status) => {
                Err(MitsubaError::Failed { status: status.to_string(), doing, words: last_output(&log) })
            }
        }
    }
}
