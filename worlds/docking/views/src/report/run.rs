//! Results of a docking run, read from its directory.

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
use ::report::RunFiles;
use ::report::read::read_json;
use contract::docking::{DockingOutcome, Motion};
use docking::rows::{FieldRow, FieldTruthRow, read_field_measurements, read_field_telemetry, read_motion};
use docking::scoring::DockingScore;
use docking::{DockingMission, DockingScenario};
use files::{Failure, TableReader};
use run::{Judgement as _, WorldScore as _};
use scenario::run_file::RunFile;
use score::{UnitVerdict, WARM_UP};
use sim::docking::FieldTruth;

/// Results of a docking run, read from its directory.
pub struct DockingRun {
    /// Content of `run.toml`.
    pub run_file: RunFile<DockingScenario>,
    /// Content of `score.json`.
    pub score: DockingScore,
    /// One verdict per field, from truth and measurements.
    pub verdicts: Vec<UnitVerdict>,
    /// Content of `truth/fields.parquet`, in the order of the verdicts.
    pub truths: Vec<FieldTruth>,
    /// Content of `measurements.csv`, for the same fields; `None` for a field without a row.
    pub outcomes: Vec<Option<DockingOutcome>>,
    /// Content of `telemetry.csv`, for the same fields.
    pub telemetry: Vec<FieldRow>,
    /// Motions reported at the end of portions, with the index of the field at which each portion ended.
    pub reports: Vec<PortionReport>,
}

/// Motion reported at the end of a portion.
pub struct PortionReport {
    /// Index of the field at which the portion ended.
    pub row: usize,
    /// Motion from the best estimator.
    pub best: Option<Motion>,
    /// Motion from the paper's formulas.
    pub paper: Option<Motion>,
}

impl DockingRun {
    /// Reads the files of a run.
    ///
    /// # Errors
    /// A [`Failure`] that names the file which is missing, cannot be read, or does not cover the same fields
    /// as the other files.
    pub fn read(files: &RunFiles) -> Result<Self, Failure> {
        files.check(&["telemetry.csv", "setup.toml", "truth/fields.parquet"])?;
        let (directory, measurements) = (&files.directory, &files.measurements);
        let run_file = RunFile::<DockingScenario>::read(&files.path("run.toml"))?;
        let motion = files.beside("motion.csv");
        let scored = DockingMission::score_files(directory, measurements, motion.as_deref(), None)?;
        let score: DockingScore = match files.score() {
            Some(path) => read_json(&path, "score")?,
            None => scored.score.clone(),
        };
        let verdicts = scored.units().units;
        let mut truths = Vec::with_capacity(verdicts.len());
        for field in TableReader::<FieldTruthRow>::open(&directory.join("truth/fields.parquet"))? {
            truths.extend(field?.1.into_iter().map(FieldTruth::from));
        }
        // The fields of the warm-up are counted in their own group alone.
        let warm_up = score.groups.get(WARM_UP).map_or(0, |group| group.frames);
        let expected = (truths.len() as u64).saturating_sub(warm_up);
        if truths.is_empty() || score.frames != expected || verdicts.len() != truths.len() {
            return Err(Failure::Usage(format!(
                "{}: `frames` is {}, expected {expected} as in truth/fields.parquet without its warm-up, and at \
                 least 1 there",
                directory.join("score.json").display(),
                score.frames
            )));
        }
        let mut answers = read_field_measurements(measurements)?.into_iter().peekable();
        let mut rows = read_field_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
        let mut reports_by_field =
            motion.as_deref().map(read_motion).transpose()?.unwrap_or_default().into_iter().peekable();
        let (mut outcomes, mut telemetry, mut reports) = (Vec::new(), Vec::new(), Vec::new());
        for (row, truth) in truths.iter().enumerate() {
            outcomes.push(answers.next_if(|(field, _)| *field == truth.field).map(|(_, outcome)| outcome));
            telemetry.push(rows.next_if(|row| row.field == truth.field).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: no row for field {}, expected one for every field of the truth",
                    directory.join("telemetry.csv").display(),
                    truth.field
                ))
            })?);
            if let Some((_, report)) = reports_by_field.next_if(|(field, _)| *field == truth.field) {
                reports.push(PortionReport { row, best: report.best, paper: report.paper });
            }
        }
        Ok(Self { run_file, score, verdicts, truths, outcomes, telemetry, reports })
    }
}
