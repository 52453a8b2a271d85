//! The files of a pipeline's answers: `measurements.csv` and `clusters.parquet`.

use std::path::{Path, PathBuf};

use contract::{FarRange, Outcome};
use files::{FileError, FrameCluster, MeasurementWriter, TableWriter};

use crate::world::{Answers, paths};

/// Writes measurements, and what clusters were taken for.
pub struct FrameAnswers {
    measurements: MeasurementWriter,
    clusters: TableWriter<FrameCluster>,
}

impl Answers<FarRange> for FrameAnswers {
    fn files(measurements: &Path) -> Vec<PathBuf> {
        vec![measurements.to_owned(), measurements.with_file_name("clusters.parquet")]
    }

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        let [measurements, clusters] = paths(files)?;
        Ok(Self {
            measurements: MeasurementWriter::create(measurements)?,
            clusters: TableWriter::create(clusters)?,
        })
    }

    fn add(&mut self, frame: u64, outcome: &Outcome) -> Result<(), FileError> {
        self.measurements.write(frame, outcome)?;
        self.clusters.write(outcome.clusters.iter().map(|&cluster| FrameCluster { frame, cluster }))
    }

    fn finish(self) -> Result<(), FileError> {
        self.clusters.finish()?;
        self.measurements.finish()
    }
}
