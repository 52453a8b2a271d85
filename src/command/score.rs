//! `boresight score`: the oracle applied to the measurements of any pipeline.

use std::path::PathBuf;

use clap::Args;
use files::{Checksums, Failure, existing_file_beside, refuse_unfinished};
use run::{IncompleteRun, world_of_run, worlds};
use serde_json::{Map, Value};

use super::Answer;
use super::options::AttitudeOption;
use super::output::Output;
use crate::table::score_table;

#[derive(Debug, Args)]
pub(super) struct ScoreArguments {
    /// A rendered dataset or a run directory, from which `run.toml` and `truth/` are read
    directory: PathBuf,
    /// Measurements, CSV: frame, status, x_px, y_px, or field, status, d1_m ..., and optional columns
    /// (docs/formats.md)
    measurements: PathBuf,
    /// The pipeline's classification of each cluster, Parquet: evidence for the causes of misses. Default:
    /// `clusters.parquet` beside `measurements.csv`, `NAME.clusters.parquet` beside `NAME.csv`, if it exists
    #[arg(long, value_name = "FILE")]
    clusters: Option<PathBuf>,
    /// Docking: the pipeline's motion estimates at the end of portions, CSV. Default: `motion.csv` beside
    /// `measurements.csv`, `NAME.motion.csv` beside `NAME.csv`, if it exists
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    #[command(flatten)]
    attitude: AttitudeOption,
}

pub(super) fn score(arguments: &ScoreArguments, output: &Output) -> Result<Answer, Failure> {
    refuse_unfinished(&arguments.directory)?;
    let world = world_of_run(&arguments.directory.join("run.toml"))?;
    let mut evidence = None;
    for (option, name, given) in [
        ("--clusters", "clusters.parquet", &arguments.clusters),
        ("--motion", "motion.csv", &arguments.motion),
    ] {
        if let Some(given) = given {
            if world.facts().evidence_file != Some(name) {
                let other = worlds().into_iter().find(|world| world.facts().evidence_file == Some(name));
                let code = other.map_or("another world", |world| world.code());
                return Err(Failure::Usage(format!(
                    "{option} applies only to runs of {}",
                    code.replace('_', " ")
                )));
            }
            evidence = Some(given.clone());
        }
    }
    let neighbouring_file = || existing_file_beside(&arguments.measurements, world.facts().evidence_file?);
    let evidence = evidence.or_else(neighbouring_file);
    let (directory, attitude) = (&arguments.directory, arguments.attitude.choice);
    let scored = world.score(directory, &arguments.measurements, evidence.as_deref(), attitude)?;
    Checksums::check(&arguments.directory, |_| true)?;
    let mut document = scored.json()?;
    // Measurements of an incomplete run must not look complete.
    let incomplete_run =
        arguments.measurements.parent().map_or(Ok(None), IncompleteRun::read_from_directory)?;
    if let Some(incomplete) = &incomplete_run {
        output.note(format!("the run is not complete: {incomplete}"));
        document = with_incomplete_run(&document, incomplete)?;
    }
    output.answer_json(&document, score_table(scored.as_ref(), output.is_terminal()))?;
    Ok(Answer::Yes)
}

/// Returns the JSON of a score, with the frames that were not run added as `run` does.
fn with_incomplete_run(score: &str, incomplete: &IncompleteRun) -> Result<String, Failure> {
    let unwritable = |error| Failure::Usage(format!("the score cannot be written as JSON: {error}"));
    let mut document: Map<String, Value> = serde_json::from_str(score).map_err(unwritable)?;
    document.insert("not_flown".to_owned(), serde_json::to_value(incomplete).map_err(unwritable)?);
    serde_json::to_string_pretty(&document).map_err(unwritable)
}
