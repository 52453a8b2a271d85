//! `boresight visibility`: selection of a camera.

use std::path::{Path, PathBuf};

use clap::Args;
use far_range_views::{visibility_markdown, visibility_table};
use files::Failure;
use pipeline::external::protocol::harmless;
use visibility::{
    BUILT_IN_REQUIREMENTS, RequirementFile, Requirements, VisibilityReport, assess, write_report,
};

use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;
use crate::command::report::{check_option, write_beside_results};

#[derive(Debug, Args)]
pub(in crate::command) struct VisibilityArguments {
    /// A built-in requirement file (`--list`) or a TOML file (docs/visibility.md)
    #[arg(required_unless_present_any = ["schema", "list"])]
    requirement: Option<String>,
    /// A new or empty directory for visibility.json, visibility.md and the curves
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Also write the report as one HTML file, replaced if it exists; with --out it is always in the
    /// directory
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    report: Option<PathBuf>,
    /// Number of frames simulated for each result, instead of `confirm.frames` in the file; 0: none
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    frames: Option<u32>,
    /// Threads; default: all cores. The results do not depend on their number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Print the JSON Schema of requirement files
    #[arg(long, conflicts_with_all = ["requirement", "list", "out", "report", "frames", "jobs"])]
    schema: bool,
    /// List the built-in requirement files
    #[arg(long, conflicts_with_all = ["requirement", "out", "report", "frames", "jobs"])]
    list: bool,
}

/// Runs the command; exit status 0 if every requirement is met, 1 if a requirement is not met or cannot be
/// met.
pub(in crate::command) fn visibility(
    arguments: &VisibilityArguments,
    output: &Output,
) -> Result<Answer, Failure> {
    if arguments.schema {
        let schema = schemars::schema_for!(RequirementFile);
        let text = serde_json::to_string_pretty(&schema)
            .map_err(|error| Failure::Usage(format!("the schema cannot be written: {error}")))?;
        output.answer(&schema, text)?;
        return Ok(Answer::Yes);
    }
    let Some(word) = &arguments.requirement else {
        let names: Vec<_> = BUILT_IN_REQUIREMENTS.iter().map(|built_in| built_in.name).collect();
        output.answer(&names, names.join("\n"))?;
        return Ok(Answer::Yes);
    };
    check_option(arguments.report.as_ref())?;
    let mut requirements = Requirements::read(word)?;
    if requirements.file.requirements.is_empty() {
        return Err(Failure::Usage(format!("{word}: no [[requirements]], expected at least one")));
    }
    if let Some(frames) = arguments.frames {
        requirements.file.confirm.frames = frames;
    }
    let steps = requirements.file.requirements.len() as u64 + 2;
    let progress = output.progress_of(steps, "steps", &requirements.name);
    let show_progress = |what: &str| {
        progress.set_message(harmless(&format!("{}, {what}", requirements.name)));
        progress.inc(1);
    };
    let threads = arguments.jobs.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Usage(format!("threads cannot be started: {error}")))?;
    let report = pool.install(|| assess(&requirements, show_progress))?;
    progress.finish_and_clear();
    if let Some(folder) = &arguments.out {
        write_report(&report, &visibility_markdown(&report), folder)?;
        write_beside_results(folder, output);
    }
    if let Some(path) = &arguments.report {
        write_page(&report, path)?;
    }
    let mut text = visibility_table(&report, output.is_terminal());
    if let Some(folder) = &arguments.out {
        text.push_str(&format!("\nwritten to {}\n", folder.display()));
    }
    output.answer(&report, text.trim_end())?;
    let all_met = report.requirements.iter().all(|verdict| verdict.status.is_met());
    Ok(if all_met { Answer::Yes } else { Answer::No })
}

/// Writes the report of an assessment of requirements to `path`.
#[cfg(feature = "report")]
fn write_page(report: &VisibilityReport, path: &Path) -> Result<(), Failure> {
    report::write_page(&far_range_views::report::visibility_page(report), path).map(|_| ())
}

#[cfg(not(feature = "report"))]
fn write_page(_: &VisibilityReport, _: &Path) -> Result<(), Failure> {
    Err(crate::command::missing_feature("report"))
}
