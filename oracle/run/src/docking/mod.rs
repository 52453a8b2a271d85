//! Docking: the approach to a target, seen by a television camera.
//!
//! Fields are drawn in parallel, as video signals. They are digitised one after the other, because a pipeline may ask for another contrast
//! and brightness of the digitiser, which is in force from the next field on.

pub mod answers;
pub mod dataset;
mod prepared;
pub mod renderer;

pub use prepared::PreparedDocking;

use std::ops::Range;
use std::path::Path;

use contract::Camera;
use contract::docking::{Digitiser, Docking, DockingOutcome, DockingSetup, Field, FieldTelemetry};
use files::docking::{SetupFile, read_field_measurements, read_motion, truth_as_filed};
use files::{Failure, RunDirectory, TableReader, Y4mWriter};
use indexmap::IndexMap;
use scenario::DockingScenario;
use scenario::run_file::RunFile;
use score::docking::{DockingContext, DockingScore, DockingScorer, TrueField};
use score::{Figure, UnitTable};
use sim::docking::{DockingWorkspace, FieldExposure, FieldTruth};

use self::answers::{FieldAnswers, answer_as_filed};
use self::dataset::{FieldDataset, FieldImages};
use crate::by_number::ByNumber;
use crate::flight::in_order;
use crate::world::{self, Flight, World, unscorable};

impl PreparedDocking {
    /// Makes fields, digitised as they are by default, and writes them to standard output as Y4M.
    ///
    /// # Errors
    /// A [`Failure`] when standard output cannot be written.
    pub fn stream(&self, fields: Range<u64>, jobs: usize) -> Result<(), Failure> {
        let size = self.setup.cameras.first().map_or((0, 0), |camera| (camera.columns, camera.rows));
        let rate_hz = self.scenario().television.frame_rate_hz;
        let mut video = Y4mWriter::standard_output(size, rate_hz)?;
        let make = |workspace: &mut DockingWorkspace, field| {
            Ok(self.expose(workspace, field)?.video.digitise(&Digitiser::default()))
        };
        let bytes = self.exposure_bytes() as u64;
        in_order(fields, jobs, bytes, || self.workspace(), make, |field| Ok(video.write(&field)?))?;
        Ok(video.finish()?)
    }
}

impl World for PreparedDocking {
    type Interface = Docking;
    type Images = FieldImages;
    type Exposure = FieldExposure;
    type Workspace<'a> = DockingWorkspace;
    type Truth = FieldTruth;
    /// The setting of the digitiser.
    type Feedback = Digitiser;
    type Dataset<'a> = FieldDataset<'a>;
    type Answers = FieldAnswers;
    type Scorer<'a> = Scorer;
    type Scored = ScoredFields;

    fn frame_count(&self) -> u64 {
        self.simulator.field_count()
    }

    fn setup(&self) -> &DockingSetup {
        &self.setup
    }

    /// A video signal is kept as f32; a progressive field is a whole frame.
    fn exposure_bytes(&self) -> usize {
        let frame = |camera: &Camera| camera.columns * camera.rows * size_of::<f32>();
        self.setup.cameras.first().map_or(0, frame) / self.scenario().television.interlace.lines(0).step()
    }

    fn workspace(&self) -> Result<DockingWorkspace, Failure> {
        Ok(self.simulator.workspace()?)
    }

    fn expose(&self, workspace: &mut DockingWorkspace, field: u64) -> Result<FieldExposure, Failure> {
        self.renderer.expose(&self.simulator, &self.setup, workspace, field)
    }

    fn receive(exposure: FieldExposure, digitiser: &Digitiser) -> (Field, FieldTelemetry, FieldTruth) {
        (exposure.video.digitise(digitiser), exposure.telemetry(*digitiser), exposure.truth)
    }

    /// A wish that no digitiser has leaves it as it is.
    fn feedback(before: Digitiser, outcome: &DockingOutcome) -> Digitiser {
        outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(before)
    }

    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        flight: &Flight<FieldImages>,
    ) -> Result<FieldDataset<'a>, Failure> {
        FieldDataset::create(&self.run_file, &self.setup, directory, flight.images)
    }

    fn scorer(&self) -> Scorer {
        Scorer::new(&self.run_file, &self.setup)
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        motion: Option<&Path>,
    ) -> Result<ScoredFields, Failure> {
        let run_file = RunFile::<DockingScenario>::read(&directory.join("run.toml"))?;
        let setup = SetupFile::read(&directory.join("setup.toml"))?.setup();
        let mut scorer = Scorer::new(&run_file, &setup);
        let truth = directory.join("truth/fields.parquet");
        let truths = TableReader::<FieldTruth>::open(&truth)?;
        let mut answers =
            ByNumber::new(read_field_measurements(measurements)?, measurements, "field", &truth);
        let reports = motion.map(read_motion).transpose()?.unwrap_or_default();
        let mut reports = ByNumber::new(reports, motion.unwrap_or(measurements), "field", &truth);
        for field in truths {
            let (number, rows) = field?;
            let (outcome, report) = (answers.of(number)?, reports.of(number)?);
            for truth in &rows {
                let truth = scorer.true_field(truth);
                let judged = scorer.scorer.add_with_report(&truth, outcome.as_ref(), report.as_ref());
                judged.map_err(unscorable)?;
            }
        }
        answers.end()?;
        reports.end()?;
        Ok(world::Scorer::finish(scorer))
    }
}

/// Judges the fields of a run.
pub struct Scorer {
    scorer: DockingScorer,
    marks: usize,
    cameras: Vec<Camera>,
}

impl Scorer {
    fn new(run_file: &RunFile<DockingScenario>, setup: &DockingSetup) -> Self {
        Self {
            scorer: DockingScorer::new(context(run_file, setup)),
            marks: setup.target.marks.len(),
            cameras: setup.cameras.clone(),
        }
    }

    fn true_field(&self, truth: &FieldTruth) -> TrueField {
        let rows = self.cameras.get(truth.camera).map_or(0, |camera| camera.rows);
        TrueField::new(truth, self.marks, rows)
    }
}

impl world::Scorer<PreparedDocking> for Scorer {
    /// Truth and answer are judged as their files would give them back, so that a run and its files have the same score to the bit.
    fn add(&mut self, truth: &FieldTruth, outcome: &DockingOutcome) -> Result<(), Failure> {
        let truth = self.true_field(&truth_as_filed(truth.clone()));
        self.scorer.add(&truth, Some(&answer_as_filed(outcome))).map_err(unscorable)
    }

    fn finish(self) -> ScoredFields {
        ScoredFields { score: self.scorer.score(), scorer: self.scorer }
    }
}

/// The score of a docking run, with the fields that it was counted from.
pub struct ScoredFields {
    /// The score.
    pub score: DockingScore,
    scorer: DockingScorer,
}

impl world::Scored for ScoredFields {
    type Score = DockingScore;

    fn score(&self) -> &DockingScore {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score.figures
    }

    fn units(&self) -> UnitTable {
        self.scorer.units()
    }
}

fn context(run_file: &RunFile<DockingScenario>, setup: &DockingSetup) -> DockingContext {
    DockingContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        renderer: run_file.mitsuba.as_ref().map_or("fast", |_| "mitsuba").to_owned(),
        setup: setup.clone(),
    }
}
