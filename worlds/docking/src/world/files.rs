//! Files of a docking run or dataset, and its video on standard output.

use std::fmt::Debug;
use std::path::Path;

use ::labels::{FrameLabels, LabelSet};
use contract::docking::Digitiser;
use files::{Failure, RunDirectory};
use run::frame_jobs::{FrameJobs, process_in_order};
use run::world::{OpenDataset, WorldFiles, WorldFrames as _, WorldScenario as _};
use sim::docking::DockingWorkspace;

use super::dataset::{FieldDataset, FieldImages};
use super::labels;
use super::mission::DockingMission;
use crate::rows::{FieldRow, SetupFile, read_field_telemetry};
use crate::video::{FieldSource, SequenceOptions, Y4mWriter};

impl WorldFiles for DockingMission {
    const IMAGES: FieldImages = FieldImages::Png;

    type Images = FieldImages;
    type Dataset<'a> = FieldDataset<'a>;

    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        frame_jobs.refuse_expectation(Self::CODE)?;
        let count = frame_jobs.frames.end - frame_jobs.frames.start;
        if let Some(most) = frame_jobs.images.and_then(|images| images.max_fields(&self.setup))
            && count > most
        {
            return Err(Failure::Usage(format!(
                "{count} fields exceed the {most} that fit into an uncompressed AVI of 4 GB; select fewer \
                 with --frames, or write mjpeg, png or y4m"
            )));
        }
        self.probe(frame_jobs.frames.start)
    }

    fn files_for_pipelines(images: FieldImages) -> String {
        format!("setup.toml, telemetry.csv, {}", images.file_pattern())
    }

    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<FieldImages>,
    ) -> Result<FieldDataset<'a>, Failure> {
        FieldDataset::create(&self.run_file, &self.setup, directory, frame_jobs.images)
    }

    fn label_set(&self) -> Result<LabelSet, Failure> {
        Ok(labels::label_set(self))
    }

    fn frame_labels(&self, field: u64) -> Result<FrameLabels, Failure> {
        labels::field_labels(self, field)
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let file = SetupFile::read(&directory.join(Self::FACTS.setup_file))?;
        let setup = file.setup();
        let images = FieldSource::open(directory, &setup, &SequenceOptions::INTERLACED)?;
        let images = Box::new(images.map(|field| Ok(field?)));
        Ok(OpenDataset { setup, config: file.docking, count: None, images })
    }

    fn telemetry_rows(directory: &Path, add: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        for FieldRow { field, lines, mut telemetry, .. } in
            read_field_telemetry(&directory.join("telemetry.csv"))?
        {
            // The digitiser settings depend on the requests of the pipeline and are excluded.
            telemetry.digitiser = Digitiser::default();
            add(&(field, lines, telemetry));
        }
        Ok(())
    }

    fn check_stream(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        if frame_jobs.images == Some(FieldImages::Y4m) {
            return Ok(());
        }
        let message = "--out - requires --format y4m: no other format can be streamed";
        Err(Failure::Usage(message.to_owned()))
    }

    /// Writes fields, digitised with the default settings, as Y4M.
    fn stream(&self, frame_jobs: &FrameJobs<FieldImages>) -> Result<(), Failure> {
        self.check_stream(frame_jobs)?;
        let size = self.setup.cameras.first().map_or((0, 0), |camera| (camera.columns, camera.rows));
        let rate_hz = self.scenario().television.frame_rate_hz;
        let mut video = Y4mWriter::standard_output(size, rate_hz)?;
        if let Some(camera) = self.setup.cameras.first() {
            video = video.with_pixel_size(camera.pixel_width_um, camera.pixel_height_um);
        }
        let make = |workspace: &mut DockingWorkspace, field| {
            Ok(self.expose(workspace, field, &Digitiser::default())?.video.digitise(&Digitiser::default()))
        };
        let (fields, bytes) = (frame_jobs.frames.clone(), self.exposure_bytes() as u64);
        process_in_order(
            fields,
            frame_jobs.jobs,
            bytes,
            || self.workspace(),
            make,
            |field| Ok(video.write(&field)?),
        )?;
        Ok(video.finish()?)
    }
}
