//! The error budget: the same frames with the truth in the place of one stage's result, beside the honest run.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use files::Failure;
use scenario::run_file::RunFile;
use scenario::{FarRangeScenario, Stage, World};
use score::{Score, names};

use super::FarRangeRun;
use crate::chart::{BESIDE, Chart, MEASURED, axes, intervals, rounded};
use crate::figures::{cell, percent_cell};
use crate::page::{DataTable, Section};
use crate::plotly::Trace;
use crate::read::{missing, read_json, world_of};

/// A run of the same frames that was told the truth for one stage.
pub struct InjectedRun {
    stage: Stage,
    score: Score,
}

impl InjectedRun {
    /// Reads the directory of one, to be held against `honest`.
    ///
    /// # Errors
    /// A [`Failure`] for a directory that is none, or is of other frames.
    fn read(directory: &Path, honest: &FarRangeRun) -> Result<Self, Failure> {
        for name in ["run.toml", "score.json"] {
            if !directory.join(name).is_file() {
                return Err(missing(directory, name));
            }
        }
        let path = directory.join("run.toml");
        let refuse = |what: &str| Err(Failure::Usage(format!("{}: {what}", path.display())));
        if world_of(directory)? != World::FarRange {
            return refuse("`scenario.world` is that of docking, expected a run of the far range");
        }
        let run_file = RunFile::<FarRangeScenario>::read(&path)?;
        let Some(stage) = run_file.inject else {
            return refuse("`inject` is missing, expected a run with --inject STAGE");
        };
        let (own, mut scenario) = (&honest.run_file, run_file.scenario);
        if stage == Stage::Roi {
            scenario.roi.clone_from(&own.scenario.roi);
        }
        if own.inject.is_some() {
            return Err(Failure::Usage(
                "--budget is given, expected with the report of an honest run alone".to_owned(),
            ));
        }
        if scenario != own.scenario {
            return refuse("`scenario` is another one, expected that of the honest run");
        }
        let score: Score = read_json(&directory.join("score.json"), "score")?;
        let frames = |score: &Score| {
            score.groups.iter().map(|(name, group)| (name.clone(), group.frames)).collect::<Vec<_>>()
        };
        if frames(&score) != frames(&honest.score) {
            return refuse("the run is of other frames, expected those of the honest run");
        }
        Ok(Self { stage, score })
    }

    /// Reads several, in the order of the stages.
    ///
    /// # Errors
    /// A [`Failure`] for a directory that is none, or is of other frames.
    pub fn read_all(directories: &[PathBuf], honest: &FarRangeRun) -> Result<Vec<Self>, Failure> {
        let runs: Result<Vec<Self>, _> =
            directories.iter().map(|directory| Self::read(directory, honest)).collect();
        let mut runs = runs?;
        runs.sort_by_key(|run| run.stage as u8);
        Ok(runs)
    }
}

/// The runs of an error budget that are kept with a run, in `budget/STAGE`.
pub fn kept_budget(directory: &Path) -> Vec<PathBuf> {
    let folder = |stage: &Stage| directory.join("budget").join(stage.to_string());
    let folders = Stage::value_variants().iter().map(folder);
    folders.filter(|folder| folder.join("score.json").is_file()).collect()
}

/// What each stage costs.
pub(super) fn budget(run: &FarRangeRun) -> Section {
    let section = Section::new("budget", "Error budget by stage");
    if run.run_file.inject.is_some() {
        return section;
    }
    if run.budget.is_empty() {
        return section.text(
            "Nothing was held against this run. `boresight report DIR --budget all` flies the same frames once a stage, with the truth in the \
             place of that stage's result, and shows here what each stage of the built-in pipeline costs (docs/report.md).",
        );
    }
    let honest = ("none: the honest run".to_owned(), &run.score);
    let injected = run.budget.iter().map(|injected| (injected.stage.to_string(), &injected.score));
    let rows: Vec<(String, &Score)> = [honest].into_iter().chain(injected).collect();
    let rates = [
        names::HIT_RATE,
        names::CORRECT_RATE,
        names::WRONG_RATE,
        names::RA_WITHIN_1PX,
        names::DEC_WITHIN_1PX,
    ];
    let amounts = [names::RA_RMS_DEG, names::DEC_RMS_DEG, names::RA_MEAN_DEG, names::DEC_MEAN_DEG];
    let mut table = DataTable::new(["true stage"].into_iter().chain(rates).chain(amounts))
        .caption("Rates in percent with 95 % intervals, errors of the right answers in degrees.");
    for (stage, score) in &rows {
        let mut cells = vec![stage.clone()];
        cells.extend(rates.map(|name| percent_cell(score.figures.get(name))));
        cells.extend(amounts.map(|name| cell(score.figures.get(name).and_then(|figure| figure.value))));
        table.push(cells);
    }
    let of = |label: &str, name: &str, colour| -> Trace {
        let figures: Vec<_> = rows
            .iter()
            .filter_map(|(stage, score)| {
                let figure = score.figures.get(name)?;
                let value = figure.value?;
                Some((stage.clone(), value, figure.low.unwrap_or(value), figure.high.unwrap_or(value)))
            })
            .collect();
        let y = figures.iter().map(|figure| rounded(figure.1, 6)).collect();
        let low: Vec<f64> = figures.iter().map(|figure| figure.2).collect();
        let high: Vec<f64> = figures.iter().map(|figure| figure.3).collect();
        let stages: Vec<String> = figures.into_iter().map(|figure| figure.0).collect();
        intervals(label, stages, y, &low, &high, colour)
    };
    let traces = vec![of("RA", names::RA_RMS_DEG, MEASURED), of("Dec", names::DEC_RMS_DEG, BESIDE)];
    section
        .text(
            "The same frames, each time with the truth in the place of one stage's result: what becomes better is what that stage \
             costs (docs/score.md).",
        )
        .chart(Chart::new(
            "RMS error of the right answers with 95 % intervals, by the stage that was told the truth.",
            380,
            table,
            traces,
            axes("true stage", "RMS error, °"),
        ))
}
