//! Files of a world: a dataset, written and read, and images on standard output.

use std::fmt::Debug;
use std::path::Path;
use std::str::FromStr;

use contract::Interface as _;
use files::{Failure, FileError, RunDirectory};
use labels::{FrameLabels, LabelSet};

use super::{ImageOf, SetupOf, TelemetryOf, WorldFrames, WorldPipelines};
use crate::frame_jobs::FrameJobs;

/// Files of a run or a rendered dataset, besides outcomes and score.
pub trait WorldFiles: WorldPipelines {
    /// Default image format of a rendered dataset.
    const IMAGES: Self::Images;

    /// Formats in which images are stored.
    type Images: Copy + Sync + FromStr<Err = String>;
    /// Writes frames as a dataset.
    type Dataset<'a>: Dataset<Self>
    where
        Self: 'a;

    /// Refuses a flight that cannot succeed, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] with the reason.
    fn check_frame_jobs(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        Ok(())
    }

    /// Describes the files of a rendered dataset for a pipeline.
    fn files_for_pipelines(_: Self::Images) -> String {
        format!("{} and the {}s", Self::FACTS.setup_file, Self::Interface::IMAGE)
    }

    /// Begins a dataset: writes the files that do not depend on frames.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<Self::Images>,
    ) -> Result<Self::Dataset<'a>, Failure>;

    /// Writes the separate files of an exposure, on the thread that made it.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    fn save(
        &self,
        _: &Self::Workspace<'_>,
        _: &Self::Exposure,
        _: &RunDirectory,
        _: &FrameJobs<Self::Images>,
    ) -> Result<(), Failure> {
        Ok(())
    }

    /// Returns the classes and cameras of labels, for a world that labels its images.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a world without labels.
    fn label_set(&self) -> Result<LabelSet, Failure> {
        Err(no_labels(Self::CODE))
    }

    /// Returns the labels of a frame, which depend on its number alone.
    ///
    /// # Errors
    /// A [`Failure`] when the frame does not exist; [`Failure::Usage`] for a world without labels.
    fn frame_labels(&self, _frame: u64) -> Result<FrameLabels, Failure> {
        Err(no_labels(Self::CODE))
    }

    /// Opens a dataset for a pipeline, of real or rendered images.
    ///
    /// # Errors
    /// A [`Failure`] with the first missing or wrong item.
    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure>;

    /// Passes to `add`, for every frame of a run, the input of a pipeline besides the image: telemetry,
    /// transmitted regions. The default is that of a world without telemetry.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read.
    fn telemetry_rows(_directory: &Path, _add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        Ok(())
    }

    /// Refuses a flight whose images cannot be written to standard output.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a format that cannot be streamed, or a world without a stream.
    fn check_stream(&self, _: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        let code = Self::CODE;
        Err(Failure::Usage(format!(
            "--out is -, expected a path: {code} writes nothing to standard output (`./-` names a file)"
        )))
    }

    /// Writes images to standard output, in a format that can be streamed.
    ///
    /// # Errors
    /// Those of [`WorldFiles::check_stream`]; a [`Failure`] when standard output cannot be written.
    fn stream(&self, frame_jobs: &FrameJobs<Self::Images>) -> Result<(), Failure> {
        self.check_stream(frame_jobs)
    }
}

fn no_labels(world: &str) -> Failure {
    Failure::Usage(format!("--labels requires a world that labels its images, which {world} does not"))
}

/// A dataset for a pipeline, before its images are read.
pub struct OpenDataset<W: WorldPipelines> {
    /// Setup that a pipeline receives before the first image.
    pub setup: SetupOf<W>,
    /// Parameters of the built-in pipeline.
    pub config: W::Config,
    /// Number of images, if known.
    pub count: Option<u64>,
    /// Images in order.
    pub images: Images<W>,
}

/// Images with their telemetry, read one by one.
pub type Images<W> = Box<dyn Iterator<Item = Result<(ImageOf<W>, TelemetryOf<W>), Failure>>>;

/// Writes the files common to a run and a rendered dataset: all except outcomes and score.
pub trait Dataset<W: WorldFrames> {
    /// Adds a frame.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn add(
        &mut self,
        image: &ImageOf<W>,
        telemetry: TelemetryOf<W>,
        truth: W::Truth,
    ) -> Result<(), FileError>;

    /// Completes the files, the telemetry last: it marks the directory as a dataset.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    fn finish(self) -> Result<(), FileError>;
}
