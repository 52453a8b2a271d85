//! `boresight score`: the oracle over anybody's measurements.

use std::path::PathBuf;

use clap::Args;

use super::Answer;
use super::output::Output;
use crate::failure::Failure;
use crate::run;
use crate::run_file::RunFile;
use crate::scenario::is_argon;
use crate::score::ARGON_TABLE_2;
use crate::table::{TableStyle, far_range};

#[derive(Debug, Args)]
pub(super) struct ScoreArguments {
    /// A rendered dataset or a run directory: `run.toml` and `truth/` are read
    directory: PathBuf,
    /// The measurements, CSV: frame, status, x_px, y_px and what else docs/formats.md names
    measurements: PathBuf,
    /// What the pipeline took each cluster for, Parquet: evidence for the causes of misses. Default:
    /// `clusters.parquet` beside the measurements, if it is there
    #[arg(long, value_name = "FILE")]
    clusters: Option<PathBuf>,
}

pub(super) fn score(arguments: &ScoreArguments, output: &Output) -> Result<Answer, Failure> {
    let beside =
        || Some(arguments.measurements.with_file_name("clusters.parquet")).filter(|path| path.is_file());
    let clusters = arguments.clusters.clone().or_else(beside);
    let score = run::score(&arguments.directory, &arguments.measurements, clusters.as_deref())?.score;
    let is_argon = is_argon(&RunFile::read(&arguments.directory.join("run.toml"))?.scenario);
    let style = TableStyle {
        styled: output.is_terminal(),
        reference: is_argon.then_some(&ARGON_TABLE_2),
        ..TableStyle::default()
    };
    output.answer(&score, far_range(&score, style))?;
    Ok(Answer::Yes)
}
