//! `boresight gate`: test whether a result is worse than a baseline.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use files::{AtomicFile, Failure};
use gate::{
    Baseline, CompareOptions, GateReport, JUNIT_DOCUMENTS, Replacement, compare, junit, junit_of_failure,
    read_result,
};
use indexmap::IndexMap;
use scenario::AttitudeChoice;

use super::Answer;
use super::options::{AttitudeOption, output_path};
use super::output::Output;
use super::report::{check_option, write_gate};
use crate::table::{baseline_text, gate_table};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct GateArguments {
    #[command(subcommand)]
    command: Option<GateCommand>,
    #[command(flatten)]
    compare: Option<CompareArguments>,
}

#[derive(Debug, Subcommand)]
enum GateCommand {
    /// Make a baseline of a run or of a study, deliberately and with a stated reason
    Baseline(BaselineArguments),
}

#[derive(Debug, Args)]
struct CompareArguments {
    /// Folder of a baseline (`boresight gate baseline`)
    baseline: PathBuf,
    /// Directory of a run, or of a complete study
    result: PathBuf,
    /// Probability of reporting any figure as worse when none is
    #[arg(long, value_name = "P", default_value_t = 0.05)]
    alpha: f64,
    /// Only these figures, separated by commas; default: all figures of the baseline
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    figures: Vec<String>,
    /// Tolerated worsening of a figure, in the unit of the figure; may be given for several. Default: from
    /// the baseline
    #[arg(long, value_name = "FIGURE=SIZE")]
    tolerance: Vec<Tolerance>,
    /// Accept changes of figures with a best value (a bias, a NEES); the report states the reason
    #[arg(long, requires = "reason")]
    accept_changed: bool,
    /// Reason why these figures may change
    #[arg(long, value_name = "TEXT", requires = "accept_changed", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    reason: Option<String>,
    /// Also write the report as JUnit XML, or the reason why nothing could be compared;
    /// replaces an earlier report of this kind, but no other file
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    junit: Option<PathBuf>,
    /// Also write the report as one HTML file, with flipped frames as pictures; replaces an existing file
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    report: Option<PathBuf>,
    // Not flattened: for an `Option` of arguments, clap requires the group of their struct, and a struct that
    // contains other structs has none.
    /// Far range: convert a centroid without a line of sight to a line of sight by this attitude, instead of
    /// the attitude requested for the run
    #[arg(long, value_name = "ATTITUDE", value_enum)]
    attitude: Option<AttitudeChoice>,
}

#[derive(Debug, Args)]
struct BaselineArguments {
    /// Directory of a run, or of a complete study
    result: PathBuf,
    /// Folder of the baseline
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: PathBuf,
    /// Reason why later results are compared with this result
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Replace an existing baseline
    #[arg(long)]
    replace: bool,
    /// Frames (fields, cases) per block; default: ten times the longest autocorrelation time of the figures,
    /// fewer if that leaves fewer than twenty blocks, at least thirty
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    block_length: Option<u64>,
    /// Tolerated worsening of a figure, in the unit of the figure; may be given for several. Default: 1 % of
    /// an amount's size, 0.1 % of a rate
    #[arg(long, value_name = "FIGURE=SIZE")]
    tolerance: Vec<Tolerance>,
    #[command(flatten)]
    attitude: AttitudeOption,
}

/// A figure and its tolerance.
#[derive(Debug, Clone)]
struct Tolerance {
    figure: String,
    size: f64,
}

impl std::str::FromStr for Tolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(figure, size)| {
            let size = size.trim().parse().ok().filter(|size: &f64| size.is_finite() && *size >= 0.0)?;
            Some(Self { figure: figure.trim().to_owned(), size })
        });
        let parsed = parsed.ok_or_else(|| {
            format!(
                "tolerance is `{text}`, expected FIGURE=SIZE with a size of 0 or more, as in \
                 ra_rms_deg=0.001"
            )
        })?;
        // Rates are fractions in files and percent in tables: a larger tolerance would switch the figure off.
        if parsed.size > 1.0 && run::figure_by_name(&parsed.figure).is_rate() {
            return Err(format!(
                "tolerance is `{text}`, expected a fraction from 0 to 1 for a rate, as in {}=0.001 for a \
                 tenth of a percent",
                parsed.figure
            ));
        }
        Ok(parsed)
    }
}

fn sizes(tolerances: &[Tolerance]) -> IndexMap<String, f64> {
    tolerances.iter().map(|tolerance| (tolerance.figure.clone(), tolerance.size)).collect()
}

pub(super) fn gate(arguments: &GateArguments, output: &Output) -> Result<Answer, Failure> {
    match (&arguments.command, &arguments.compare) {
        (Some(GateCommand::Baseline(arguments)), _) => make_baseline(arguments, output),
        (None, Some(arguments)) => run_gate(arguments, output),
        // clap requires one of the two.
        (None, None) => Err(Failure::Usage("BASELINE and RESULT are missing".to_owned())),
    }
}

fn make_baseline(arguments: &BaselineArguments, output: &Output) -> Result<Answer, Failure> {
    let sample = read_result(&arguments.result, arguments.attitude.choice)?;
    let baseline = Baseline::new(sample, &arguments.reason, arguments.block_length)?;
    let mut baseline = baseline.with_tolerances(&sizes(&arguments.tolerance))?;
    let replace = if arguments.replace { Replacement::Allow } else { Replacement::Refuse };
    baseline.write(&arguments.out, replace)?;
    let text = format!("{}baseline in {}", baseline_text(&baseline), arguments.out.display());
    output.answer(&baseline.header, text)?;
    Ok(Answer::Yes)
}

fn run_gate(arguments: &CompareArguments, output: &Output) -> Result<Answer, Failure> {
    // Checked now, before minutes are spent on a report that could not be written.
    if let Some(path) = &arguments.junit {
        JUNIT_DOCUMENTS.check(path)?;
    }
    check_option(arguments.report.as_ref())?;
    let compared = compared(arguments);
    if let Some(path) = &arguments.junit {
        let xml = match &compared {
            Ok(report) => junit(report)?,
            Err(failure) => junit_of_failure(failure)?,
        };
        AtomicFile::with_text(path, &xml)?.replace(JUNIT_DOCUMENTS)?;
    }
    let report = compared?;
    if let Some(path) = &arguments.report {
        write_gate(&report, &arguments.result, path)?;
    }
    output.answer(&report, gate_table(&report, output.is_terminal()))?;
    Ok(if report.is_shut() { Answer::No } else { Answer::Yes })
}

fn compared(arguments: &CompareArguments) -> Result<GateReport, Failure> {
    let baseline = Baseline::read(&arguments.baseline)?;
    let result = read_result(&arguments.result, arguments.attitude)?;
    let options = CompareOptions {
        alpha: arguments.alpha,
        figures: arguments.figures.clone(),
        tolerances: sizes(&arguments.tolerance),
        accept_changed: arguments.reason.clone(),
    };
    compare(&baseline, &result, &options)
}
