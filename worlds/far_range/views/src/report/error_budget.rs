//! Runs of an error budget.

use std::path::{Path, PathBuf};

use ::report::read::{missing, read_json};
use ::run::world_of_run;
use far_range::FarRangeScenario;
use far_range::scoring::Score;
use files::Failure;
use scenario::Stage;
use scenario::run_file::RunFile;

/// A run on the same frames in which the result of one stage was replaced by the truth.
pub struct InjectedRun {
    pub(super) stage: Stage,
    pub(super) score: Score,
}

impl InjectedRun {
    /// Reads the directory of a run with one replaced stage, for comparison with the run without replacement.
    ///
    /// # Errors
    /// A [`Failure`] for a directory that is not such a run, or has other frames.
    fn read(
        directory: &Path,
        plain: &RunFile<FarRangeScenario>,
        plain_score: &Score,
    ) -> Result<Self, Failure> {
        for name in ["run.toml", "score.json"] {
            if !directory.join(name).is_file() {
                return Err(missing(directory, name));
            }
        }
        let path = directory.join("run.toml");
        let refuse = |what: &str| Err(Failure::Usage(format!("{}: {what}", path.display())));
        if !world_of_run(&path)?.has_scenario::<FarRangeScenario>() {
            return refuse("`scenario.world` is docking, expected a far-range run");
        }
        let run_file = RunFile::<FarRangeScenario>::read(&path)?;
        let Some(stage) = run_file.inject else {
            return refuse("`inject` is missing, expected a run with --inject STAGE");
        };
        let (own, mut scenario) = (plain, run_file.identity());
        if stage == Stage::Roi {
            scenario.roi.clone_from(&own.scenario.roi);
        }
        if own.inject.is_some() {
            return Err(Failure::Usage(
                "--budget applies only to the report of a run without --inject".to_owned(),
            ));
        }
        if scenario != own.identity() || run_file.catalog_sha256 != own.catalog_sha256 {
            return refuse("`scenario` differs from that of the reported run");
        }
        let score: Score = read_json(&directory.join("score.json"), "score")?;
        let frames = |score: &Score| {
            score.groups.iter().map(|(name, group)| (name.clone(), group.frames)).collect::<Vec<_>>()
        };
        if frames(&score) != frames(plain_score) {
            return refuse("the frames differ from those of the reported run");
        }
        Ok(Self { stage, score })
    }

    /// Reads several runs, and returns them in the order of the stages.
    ///
    /// # Errors
    /// A [`Failure`] for a directory that is not such a run, or has other frames.
    pub fn read_all(
        directories: &[PathBuf],
        plain: &RunFile<FarRangeScenario>,
        plain_score: &Score,
    ) -> Result<Vec<Self>, Failure> {
        let runs: Result<Vec<Self>, _> =
            directories.iter().map(|directory| Self::read(directory, plain, plain_score)).collect();
        let mut runs = runs?;
        runs.sort_by_key(|run| run.stage as u8);
        Ok(runs)
    }
}

/// Returns the directories of an error budget that are stored with a run, in `budget/STAGE`.
pub fn kept_budget(directory: &Path) -> Vec<PathBuf> {
    let folder = |stage: &Stage| directory.join("budget").join(stage.to_string());
    let folders = Stage::ALL.iter().map(folder);
    folders.filter(|folder| folder.join("score.json").is_file()).collect()
}
