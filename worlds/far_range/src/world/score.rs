//! Outcomes of the far range, and the score of a run.

use std::path::Path;

use contract::{Body, CameraFrame, Icrs, Outcome, Rotation, Telemetry};
use files::{Failure, TableReader};
use indexmap::IndexMap;
use run::RowsByNumber;
use run::world::{self, WorldScenario as _, WorldScore, unscorable};
use scenario::AttitudeChoice;
use scenario::run_file::RunFile;
use score::{Figure, FigureSpec, ScoreError, UnitTable};
use sim::optics::Projection;
use sim::truth::ObjectTruth;

use super::answers::FrameAnswers;
use super::mission::{FarRangeMission, SceneTruth};
use crate::rows::{
    FrameCluster, FrameTruthRow, ObjectTruthRow, outcome_as_filed, read_measurements, read_telemetry,
};
use crate::scenario::{FarRangeScenario, is_argon};
use crate::scoring::{
    ARGON_TABLE_2, Cause, FarRangeJudgement, GrantedAttitude, Score, ScoreContext, WithinLimits, unit_table,
};

impl WorldScore for FarRangeMission {
    type Answers = FrameAnswers;
    type Scorer<'a> = Scorer<'a>;
    type Judgement = FarRangeJudgement;

    fn figures() -> Vec<FigureSpec> {
        crate::scoring::figures()
    }

    fn causes() -> Vec<(&'static str, &'static str)> {
        let of = |verdict| Cause::ALL.map(|cause| (verdict, cause.code()));
        [of("missed"), of("wrong")].concat()
    }

    fn scorer(&self) -> Scorer<'_> {
        Scorer::new(&self.run_file, self.simulator.projection())
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        clusters: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<FarRangeJudgement, Failure> {
        let mut run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
        run_file.scenario.score.attitude = attitude.or(run_file.scenario.score.attitude);
        let projection = Projection::new(&run_file.scenario.camera)?;
        let mut scorer = Scorer::new(&run_file, &projection);
        let truth = directory.join(Self::FACTS.truth_file);
        let table = directory.join("truth/objects.parquet");
        let mut objects = TableReader::<ObjectTruthRow>::open(&table)?;
        let frames = TableReader::<FrameTruthRow>::open(&truth)?;
        let telemetry = directory.join("telemetry.csv");
        let rows = match run_file.scenario.score.attitude {
            Some(AttitudeChoice::Telemetry) => read_telemetry(&telemetry)?,
            Some(AttitudeChoice::True) | None => Vec::new(),
        };
        let rows = rows.into_iter().map(|row| (row.frame, row.telemetry.body_from_icrs)).collect();
        let mut measured_attitudes = RowsByNumber::new(rows, &telemetry, "frame", &truth);
        let mut clusters = clusters.map(TableReader::<FrameCluster>::open).transpose()?;
        let mut answers = RowsByNumber::new(
            read_measurements(measurements, &run_file.scenario.camera)?,
            measurements,
            "frame",
            &truth,
        );
        for frame in frames {
            let (number, truths) = frame?;
            let objects: Vec<ObjectTruth> = objects.rows_of(number)?.into_iter().map(|row| row.0).collect();
            let mut outcome = answers.take(number)?;
            if let Some((outcome, table)) = outcome.as_mut().zip(clusters.as_mut()) {
                outcome.clusters = table.rows_of(number)?.into_iter().map(|row| row.cluster).collect();
            }
            let granted = scorer.granted(measured_attitudes.take(number)?).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: frame {number} has no row; --attitude telemetry requires its attitude",
                    telemetry.display()
                ))
            })?;
            for of_frame in &truths {
                scorer.scorer.add(&of_frame.0, &objects, outcome.as_ref(), granted).map_err(|error| {
                    let is_of_frames = matches!(
                        error,
                        ScoreError::Order { .. } | ScoreError::Impossible { field: "range_km", .. }
                    );
                    let path = if is_of_frames { &truth } else { &table };
                    Failure::Usage(format!("{}: {}", path.display(), unscorable(error)))
                })?;
            }
        }
        answers.end()?;
        Ok(world::Scorer::finish(scorer))
    }
}

/// Scores the frames of a run.
pub struct Scorer<'a> {
    scorer: crate::scoring::Scorer<'a>,
    is_argon: bool,
    attitude: Option<AttitudeChoice>,
    nominal_camera_from_body: Rotation<CameraFrame, Body>,
}

impl<'a> Scorer<'a> {
    fn new(run_file: &RunFile<FarRangeScenario>, projection: &'a Projection) -> Self {
        let scorer = crate::scoring::Scorer::new(context(run_file, projection));
        let scenario = &run_file.scenario;
        Self {
            scorer,
            is_argon: is_argon(scenario),
            attitude: scenario.score.attitude,
            nominal_camera_from_body: scenario.mounting.nominal.camera_from_body(),
        }
    }

    /// Returns the attitude that is granted in a frame with this measured attitude; `None` if the measured
    /// attitude is requested and missing.
    fn granted(&self, measured: Option<Rotation<Body, Icrs>>) -> Option<GrantedAttitude> {
        Some(match self.attitude {
            None => GrantedAttitude::None,
            Some(AttitudeChoice::True) => GrantedAttitude::True,
            Some(AttitudeChoice::Telemetry) => {
                GrantedAttitude::Telemetry(self.nominal_camera_from_body * measured?)
            }
        })
    }
}

impl world::Scorer<FarRangeMission> for Scorer<'_> {
    fn add(&mut self, truth: &SceneTruth, telemetry: &Telemetry, outcome: &Outcome) -> Result<(), Failure> {
        let granted = self.granted(Some(telemetry.body_from_icrs)).unwrap_or_default();
        let filed = outcome_as_filed(outcome);
        self.scorer.add(&truth.frame, &truth.objects, Some(&filed), granted).map_err(unscorable)?;
        Ok(())
    }

    fn finish(self) -> FarRangeJudgement {
        FarRangeJudgement { published: self.is_argon.then_some(&ARGON_TABLE_2), ..self.scorer.finish() }
    }
}

impl world::Judgement for FarRangeJudgement {
    type Score = Score;

    fn score(&self) -> &Score {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score.figures
    }

    fn units(&self) -> UnitTable {
        unit_table(&self.verdicts, &self.limits)
    }

    fn show_comparison(&mut self, other: Self) {
        self.best_mode = Some(Box::new(other.score));
    }
}

/// Returns the angular limits of "within one pixel" and "within two" in a scenario.
pub fn limits(scenario: &FarRangeScenario) -> WithinLimits {
    let of_camera = || WithinLimits::from_pixels(&scenario.camera);
    scenario.score.within_deg.map_or_else(of_camera, WithinLimits::from_degrees)
}

fn context<'a>(run_file: &RunFile<FarRangeScenario>, projection: &'a Projection) -> ScoreContext<'a> {
    ScoreContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        inject: run_file.inject.map(|stage| stage.to_string()),
        columns: run_file.scenario.camera.columns,
        rows: run_file.scenario.camera.rows,
        limits: limits(&run_file.scenario),
        warm_up_frames: run_file.scenario.score.warm_up_frames,
        unproject: Box::new(|point| projection.unproject(point)),
    }
}
