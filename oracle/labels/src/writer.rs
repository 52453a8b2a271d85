//! Labels of a sequence of frames, in all requested formats.

use std::path::{Path, PathBuf};

use files::FileError;

use crate::bop::{self, BopFiles};
use crate::coco::{self, CocoFile};
use crate::speed::{self, SpeedFiles};
use crate::{FrameLabels, LabelFormat, LabelFormats, LabelSet, yolo};

/// Returns the name of the image of a frame in the folder of the images.
pub(crate) fn image_name(number: u64) -> String {
    format!("{number:06}.png")
}

/// Creates a folder with its parents.
///
/// # Errors
/// [`FileError::Io`].
pub(crate) fn create_folder(path: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(path).map_err(|source| FileError::io(path, "create", source))
}

/// Writes the tables of labels: frames in ascending order, each once. Tables appear when they are complete.
pub struct LabelWriter {
    images: LabelImages,
    coco: Option<CocoFile>,
    speed: Option<SpeedFiles>,
    bop: Option<BopFiles>,
    counts: LabelCounts,
}

/// Numbers of labels that were written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LabelCounts {
    /// Number of objects in all frames.
    pub objects: u64,
    /// Number of these that are smaller than a pixel, see [`crate::ObjectLabel::is_point`].
    pub points: u64,
}

/// Writes the separate files of each frame, in any order and from any thread.
#[derive(Debug, Clone)]
pub struct LabelImages {
    folder: PathBuf,
    set: LabelSet,
    formats: LabelFormats,
}

impl LabelWriter {
    /// Creates the folder of the labels, with a folder for each format, and begins the tables. The set must
    /// have passed [`LabelSet::check`].
    ///
    /// # Errors
    /// [`FileError::Io`] if a folder or file cannot be created; [`FileError::OutputTaken`] if a file exists.
    pub fn create(folder: &Path, set: LabelSet, formats: &LabelFormats) -> Result<Self, FileError> {
        let has = |format| formats.contains(format);
        let coco = if has(LabelFormat::Coco) {
            create_folder(&folder.join("coco"))?;
            Some(CocoFile::create(folder)?)
        } else {
            None
        };
        let speed = if has(LabelFormat::Speed) { Some(SpeedFiles::create(folder, &set)?) } else { None };
        let bop = if has(LabelFormat::Bop) { Some(BopFiles::create(folder, &set)?) } else { None };
        if has(LabelFormat::Yolo) {
            yolo::create_folders(folder)?;
        }
        let images = LabelImages { folder: folder.to_owned(), set, formats: formats.clone() };
        Ok(Self { images, coco, speed, bop, counts: LabelCounts::default() })
    }

    /// Returns the writer of the files of each frame.
    pub fn images(&self) -> LabelImages {
        self.images.clone()
    }

    /// Adds a frame to the tables.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn add(&mut self, frame: &FrameLabels) -> Result<(), FileError> {
        self.counts.objects += frame.objects.len() as u64;
        self.counts.points += frame.objects.iter().filter(|object| object.is_point).count() as u64;
        let set = &self.images.set;
        if let Some(coco) = &mut self.coco {
            coco.add(set, frame)?;
        }
        if let Some(speed) = &mut self.speed {
            speed.add(frame)?;
        }
        if let Some(bop) = &mut self.bop {
            bop.add(set, frame)?;
        }
        Ok(())
    }

    /// Returns the numbers of labels so far.
    pub fn counts(&self) -> LabelCounts {
        self.counts
    }

    /// Completes the tables, and returns their paths below the folder of the labels.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::OutputTaken`] if a file has appeared in the meantime.
    pub fn finish(self) -> Result<Vec<PathBuf>, FileError> {
        let Self { images: LabelImages { folder, set, formats }, coco, speed, bop, .. } = self;
        let mut paths = Vec::new();
        if let Some(coco) = coco {
            coco.finish(&set)?;
            paths.push(PathBuf::from(coco::FILE));
        }
        if let Some(speed) = speed {
            speed.finish()?;
            paths.extend(speed::files(&set));
        }
        if let Some(bop) = bop {
            bop.finish()?;
            paths.extend(bop::files());
        }
        if formats.contains(LabelFormat::Yolo) {
            yolo::finish(&folder, &set)?;
            paths.extend(yolo::files());
        }
        Ok(paths)
    }
}

impl LabelImages {
    /// Writes the separate files of a frame: masks of BOP, text of YOLO.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::OutputTaken`] if a file exists.
    pub fn write(&self, frame: &FrameLabels) -> Result<(), FileError> {
        let Some(view) = self.set.views.get(frame.view) else { return Ok(()) };
        if self.formats.contains(LabelFormat::Bop) {
            bop::write_masks(&self.folder, frame, view.camera.size())?;
        }
        if self.formats.contains(LabelFormat::Yolo) {
            yolo::write_image(&self.folder, &self.set, frame)?;
        }
        Ok(())
    }
}
