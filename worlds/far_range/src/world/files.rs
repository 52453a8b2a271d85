//! Files of a far-range run or dataset.

use std::fmt::Debug;
use std::path::Path;

use ::labels::{FrameLabels, LabelSet};
use contract::Setup;
use files::{ExpectedImage, Failure, ImageFormat, RunDirectory, write_expected};
use run::frame_jobs::{Expectation, FrameJobs};
use run::world::{OpenDataset, WorldFiles};
use sim::catalog::Catalog;

use super::dataset::{FrameDataset, save_image};
use super::labels;
use super::mission::FarRangeMission;
use super::star_list::star_list;
use crate::rows::{Dataset, StarRow, TelemetryRow, read_stars, read_telemetry};

impl WorldFiles for FarRangeMission {
    const IMAGES: ImageFormat = ImageFormat::Fits;

    type Images = ImageFormat;
    type Dataset<'a> = FrameDataset;

    fn files_for_pipelines(_: ImageFormat) -> String {
        "camera.toml, stars.csv, telemetry.csv, frames/".to_owned()
    }

    fn dataset(
        &self,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<ImageFormat>,
    ) -> Result<FrameDataset, Failure> {
        if frame_jobs.expectation == Expectation::Kept {
            directory.create_expected()?;
        }
        FrameDataset::create(
            directory,
            &self.run_file,
            &self.stars,
            self.star_epoch,
            self.simulator.trajectory().manoeuvres(),
            frame_jobs.images,
        )
    }

    fn save(
        &self,
        camera: &sim::SimulatedCamera<'_>,
        exposure: &sim::Exposure,
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<ImageFormat>,
    ) -> Result<(), Failure> {
        if let Some(format) = frame_jobs.images {
            save_image(directory, format, &self.simulator, &self.run_file, exposure)?;
        }
        if frame_jobs.expectation == Expectation::Kept {
            let image = camera.expected();
            let (columns, rows) = image.size();
            let electrons = image.iter().map(|electrons| electrons as f32).collect();
            let path = directory.expected(exposure.frame.number());
            write_expected(&path, &ExpectedImage { columns, rows, electrons })?;
        }
        Ok(())
    }

    fn label_set(&self) -> Result<LabelSet, Failure> {
        Ok(labels::label_set(self))
    }

    fn frame_labels(&self, frame: u64) -> Result<FrameLabels, Failure> {
        labels::frame_labels(self, frame)
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let dataset = Dataset::open(directory)?;
        let (setup, config) = (setup_of(directory, &dataset)?, dataset.camera().far_range.clone());
        let frames = dataset.frames().to_vec();
        let count = Some(frames.len() as u64);
        let images = frames.into_iter().map(move |frame| Ok((dataset.read(&frame)?, *frame.telemetry())));
        Ok(OpenDataset { setup, config, count, images: Box::new(images) })
    }

    fn telemetry_rows(directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        for TelemetryRow { frame, telemetry, windows, .. } in
            read_telemetry(&directory.join("telemetry.csv"))?
        {
            add(&(frame, telemetry, windows));
        }
        Ok(())
    }
}

/// Returns the setup of a dataset for the pipeline, with the dataset's star list, or the built-in catalogue
/// down to the magnitude limit of the dataset.
fn setup_of(directory: &Path, dataset: &Dataset) -> Result<Setup, Failure> {
    let camera = dataset.camera();
    let file = directory.join("stars.csv");
    let stars = if file.exists() {
        read_stars(&file)?
    } else {
        let epoch = dataset
            .star_epoch()
            .ok_or_else(|| Failure::Usage(format!("{}: the dataset has no frames", directory.display())))?;
        star_list(&Catalog::hipparcos2(), camera.magnitude_limit, epoch)
    };
    Ok(Setup {
        camera: camera.camera.clone(),
        camera_from_body: camera.mounting.camera_from_body(),
        bit_depth: camera.bit_depth,
        readout: camera.readout,
        calibration: camera.calibration,
        zero_suppression_dn: camera.zero_suppression_dn,
        stars: stars.iter().map(StarRow::to_listed_star).collect(),
    })
}
