//! Output files of a pipeline: `measurements.csv`, `motion.csv` and `features.parquet`, or a stream of
//! measurements.

use std::io;
use std::path::PathBuf;

use contract::docking::{Docking, DockingOutcome, DockingSetup, FieldTelemetry};
use files::{FileError, TableWriter};
use run::AnswerSummary;
use run::world::{Answers, paths};

use super::picture::PictureWarps;
use crate::rows::{
    FeatureRow, FieldMeasurementLine, FieldMeasurementWriter, MotionLine, MotionWriter, outcome_as_filed,
    report_as_filed,
};

/// Writes measurements, motions and features.
pub struct FieldAnswers {
    measurements: FieldMeasurementWriter,
    /// Writers of the motions at the end of portions, and of the recognised features; `None` for a stream.
    more: Option<(MotionWriter, TableWriter<FeatureRow>)>,
    warps: PictureWarps,
}

impl FieldAnswers {
    /// Writes only the measurements, to standard output, each immediately.
    ///
    /// # Errors
    /// [`FileError::Io`] when standard output cannot be written.
    pub fn stream() -> Result<Self, FileError> {
        let measurements = FieldMeasurementWriter::stream("standard output", io::stdout())?;
        Ok(Self { measurements, more: None, warps: PictureWarps::default() })
    }
}

impl Answers<Docking> for FieldAnswers {
    const BESIDE: &'static [&'static str] = &["motion.csv", "features.parquet"];

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        let [measurements, motion, features] = paths(files)?;
        Ok(Self {
            measurements: FieldMeasurementWriter::create(measurements)?,
            more: Some((MotionWriter::create(motion)?, TableWriter::create(features)?)),
            warps: PictureWarps::default(),
        })
    }

    fn add(
        &mut self,
        field: u64,
        telemetry: &FieldTelemetry,
        outcome: &DockingOutcome,
    ) -> Result<(), FileError> {
        self.measurements.line(&FieldMeasurementLine::from_outcome(field, outcome))?;
        self.warps.add(telemetry, outcome);
        if let Some((motion, features)) = &mut self.more {
            if let Some(report) = &outcome.motion {
                for row in MotionLine::from_report(field, report) {
                    motion.line(&row)?;
                }
            }
            features.write(FeatureRow::from_features(field, &outcome.features))?;
        }
        Ok(())
    }

    /// Returns what the camera file does not state of the picture.
    fn summary(&self, setup: &DockingSetup) -> Option<AnswerSummary> {
        self.warps.summary(setup)
    }

    fn finish(self) -> Result<(), FileError> {
        if let Some((motion, features)) = self.more {
            motion.finish()?;
            features.finish()?;
        }
        self.measurements.finish()
    }
}

/// Rounds an outcome to the precision of the files.
pub(crate) fn answer_as_filed(outcome: &DockingOutcome) -> DockingOutcome {
    let mut answered = outcome_as_filed(outcome);
    answered.motion = outcome.motion.as_ref().map(report_as_filed);
    answered
}
