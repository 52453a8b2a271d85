//! Outcomes of docking, and the score of a run.

use std::path::Path;

use contract::Camera;
use contract::docking::{DockingOutcome, DockingSetup, FieldTelemetry};
use files::{Failure, TableReader};
use indexmap::IndexMap;
use run::RowsByNumber;
use run::world::{self, WorldScenario as _, WorldScore, refuse_attitude, unscorable};
use scenario::AttitudeChoice;
use scenario::run_file::RunFile;
use score::{Figure, FigureSpec, UnitTable};
use sim::docking::FieldTruth;

use super::answers::{FieldAnswers, answer_as_filed};
use super::mission::DockingMission;
use crate::rows::{FieldTruthRow, SetupFile, read_field_measurements, read_motion, truth_as_filed};
use crate::scenario::DockingScenario;
use crate::scoring::{DockingContext, DockingScore, DockingScorer, GrossError, MissCause, TrueField};

impl WorldScore for DockingMission {
    type Answers = FieldAnswers;
    type Scorer<'a> = Scorer;
    type Judgement = DockingJudgement;

    fn figures() -> Vec<FigureSpec> {
        crate::scoring::figures()
    }

    fn causes() -> Vec<(&'static str, &'static str)> {
        let missed = MissCause::CODES.map(|cause| ("missed", cause));
        missed.into_iter().chain(GrossError::ALL.map(|gross| ("wrong", gross.code()))).collect()
    }

    fn scorer(&self) -> Scorer {
        Scorer::new(&self.run_file, &self.setup)
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        motion: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<DockingJudgement, Failure> {
        refuse_attitude(attitude)?;
        let run_file = RunFile::<DockingScenario>::read(&directory.join("run.toml"))?;
        let setup = SetupFile::read(&directory.join("setup.toml"))?.setup();
        let mut scorer = Scorer::new(&run_file, &setup);
        let truth = directory.join(Self::FACTS.truth_file);
        let truths = TableReader::<FieldTruthRow>::open(&truth)?;
        let mut answers =
            RowsByNumber::new(read_field_measurements(measurements)?, measurements, "field", &truth);
        let reports = motion.map(read_motion).transpose()?.unwrap_or_default();
        let mut reports = RowsByNumber::new(reports, motion.unwrap_or(measurements), "field", &truth);
        for field in truths {
            let (number, rows) = field?;
            let (outcome, report) = (answers.take(number)?, reports.take(number)?);
            for row in rows {
                let truth = scorer.true_field(&FieldTruth::from(row));
                let judged = scorer.scorer.add_with_report(&truth, outcome.as_ref(), report.as_ref());
                judged.map_err(unscorable)?;
            }
        }
        answers.end()?;
        reports.end()?;
        Ok(world::Scorer::finish(scorer))
    }
}

/// Scores the fields of a run.
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

impl world::Scorer<DockingMission> for Scorer {
    /// Truth and outcome are scored with the precision of their files, so that a run and its files have
    /// bit-identical scores.
    fn add(
        &mut self,
        truth: &FieldTruth,
        _: &FieldTelemetry,
        outcome: &DockingOutcome,
    ) -> Result<(), Failure> {
        let truth = self.true_field(&truth_as_filed(truth.clone()));
        self.scorer.add(&truth, Some(&answer_as_filed(outcome))).map_err(unscorable)
    }

    fn finish(self) -> DockingJudgement {
        DockingJudgement { score: self.scorer.score(), scorer: self.scorer }
    }
}

/// Score of a docking run, with the scored fields.
pub struct DockingJudgement {
    /// Score of the run.
    pub score: DockingScore,
    scorer: DockingScorer,
}

impl world::Judgement for DockingJudgement {
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
        warm_up_frames: run_file.scenario.score.warm_up_frames,
        setup: setup.clone(),
    }
}
