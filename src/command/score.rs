//! `boresight score`: the oracle over anybody's measurements.

use std::path::PathBuf;

use clap::Args;
use files::{Checksums, Failure, FileError, toml_file};
use run::{Prepared, PreparedDocking, World as _};
use scenario::run_file::RunFile;
use scenario::{FarRangeScenario, World, is_argon, world};
use score::ARGON_TABLE_2;

use super::Answer;
use super::output::Output;
use crate::table::docking;
use crate::table::{TableStyle, far_range};

#[derive(Debug, Args)]
pub(super) struct ScoreArguments {
    /// A rendered dataset or a run directory: `run.toml` and `truth/` are read
    directory: PathBuf,
    /// The measurements, CSV: frame, status, x_px, y_px, or field, status, d1_m ..., and what else docs/formats.md names
    measurements: PathBuf,
    /// What the pipeline took each cluster for, Parquet: evidence for the causes of misses. Default:
    /// `clusters.parquet` beside the measurements, if it is there
    #[arg(long, value_name = "FILE")]
    clusters: Option<PathBuf>,
    /// Docking: what the pipeline said at the end of portions, CSV. Default: `motion.csv` beside the measurements, if it
    /// is there
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
}

pub(super) fn score(arguments: &ScoreArguments, output: &Output) -> Result<Answer, Failure> {
    let run_file = arguments.directory.join("run.toml");
    let text = toml_file::read_text(&run_file).map_err(|source| FileError::Io {
        path: run_file.clone(),
        doing: "read",
        source,
    })?;
    let beside = |name: &str| Some(arguments.measurements.with_file_name(name)).filter(|path| path.is_file());
    let world = world(&run_file, &text, "scenario.world")?;
    let (given, expected) = match world {
        World::FarRange => (arguments.motion.as_ref().map(|_| "--motion"), "docking"),
        World::Docking => (arguments.clusters.as_ref().map(|_| "--clusters"), "far range"),
    };
    if let Some(given) = given {
        return Err(Failure::Usage(format!("{given} is given, expected with a run of {expected} alone")));
    }
    if world == World::Docking {
        let motion = arguments.motion.clone().or_else(|| beside("motion.csv"));
        let score =
            PreparedDocking::score_files(&arguments.directory, &arguments.measurements, motion.as_deref())?
                .score;
        Checksums::check(&arguments.directory, |_| true)?;
        output.answer(&score, docking(&score, output.is_terminal()))?;
        return Ok(Answer::Yes);
    }
    let clusters = arguments.clusters.clone().or_else(|| beside("clusters.parquet"));
    let score =
        Prepared::score_files(&arguments.directory, &arguments.measurements, clusters.as_deref())?.score;
    Checksums::check(&arguments.directory, |_| true)?;
    let is_argon = is_argon(&RunFile::<FarRangeScenario>::read(&run_file)?.scenario);
    let style = TableStyle {
        styled: output.is_terminal(),
        reference: is_argon.then_some(&ARGON_TABLE_2),
        ..TableStyle::default()
    };
    output.answer(&score, far_range(&score, style))?;
    Ok(Answer::Yes)
}
