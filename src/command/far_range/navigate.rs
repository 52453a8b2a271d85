//! `boresight navigate`: relative orbit from the lines of sight of a run, or its bound before a flight.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use contract::conformance::Violation;
use far_range::FarRangeScenario;
use far_range_views::{bound_table, budget_table, navigation_table};
use files::Failure;
use navigate::{
    Campaign, EVERY_S, Estimator, KnowledgeConfig, MeasurementSource, NavigationResult, NavigatorChoice,
    TABLE_FILE, bound_of, navigate_with, navigation_budget,
};
use pipeline::external::{DEFAULT_MEMORY_MB, Sandbox};
use run::{AnyWorld, ScenarioSource};
use scenario::run_file::ScenarioFile;
use serde_json::json;

use crate::command::Answer;
use crate::command::interrupt::{clean_up_when_interrupted, scratch_directory};
use crate::command::options::output_path;
use crate::command::output::Output;
use crate::command::report::write_beside_results;

/// Number of intervals of a bound's table.
const BOUND_INTERVALS: u32 = 12;

/// Name of a run's report.
const REPORT: &str = "report.html";

#[derive(Debug, Args)]
pub(in crate::command) struct NavigateArguments {
    /// Directory of a far-range run; with --bound also a built-in scenario or a TOML file
    #[arg(value_name = "RUN|SCENARIO", required_unless_present = "conformance")]
    input: Option<PathBuf>,
    #[command(flatten)]
    navigator: NavigatorOptions,
    /// Lines of sight from this file in place of the run's measurements.csv: a table with its columns (.csv),
    /// or a tracking data message of CCSDS with right ascension and declination (KVN or XML)
    #[arg(long, value_name = "FILE")]
    measurements: Option<PathBuf>,
    /// Standard deviation of each angle of lines of sight without a covariance, arcsec; required for a
    /// tracking data message, which states none
    #[arg(long, value_name = "S", requires = "measurements")]
    sigma_arcsec: Option<f64>,
    /// Interval of the estimates, s
    #[arg(long, value_name = "S", default_value_t = EVERY_S)]
    every: f64,
    /// Without a prior of the relative orbit
    #[arg(long)]
    no_prior: bool,
    /// Directory for navigation.csv and navigation.json, which must not exist there; default: that of the run
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Only the smallest standard deviations that the measurements allow, and the condition number
    #[arg(long, conflicts_with_all = ["navigator", "every", "out"])]
    bound: bool,
    /// Only the error budget: the navigation is repeated with one input true at a time; shares of the squared
    /// error along R, T, N; writes no file
    #[arg(long, conflicts_with_all = ["out", "bound", "measurements"])]
    budget: bool,
    /// Without a run: test that the navigator keeps the rules of the contract, on orbits of its own; exit
    /// status 1 if it does not
    #[arg(long, conflicts_with_all = ["input", "every", "no_prior", "out", "bound", "budget", "measurements"])]
    conformance: bool,
}

/// Choice of the navigator, and limits of an external one.
#[derive(Debug, Args)]
struct NavigatorOptions {
    /// `batch` (least squares over all measurements), `sequential` (filter: each estimate from the
    /// measurements until then), or `exec:COMMAND` for a program that implements the protocol of
    /// docs/navigation.md
    #[arg(long, alias = "estimator", value_name = "NAME|exec:COMMAND", default_value = "batch")]
    navigator: String,
    /// Maximum time of an `exec:` navigator per request, s
    #[arg(long, value_name = "S", default_value_t = 60.0)]
    timeout_s: f64,
    /// Maximum memory of an `exec:` navigator, and of each process that it starts, MB; enforced on Linux
    #[arg(long, value_name = "MB", default_value_t = DEFAULT_MEMORY_MB)]
    memory_mb: u64,
    /// Let an `exec:` navigator read the system and the files beside it, write temporary files, and nothing
    /// else: no truth, no scenario, no run, no network. Rejected if the kernel has no Landlock
    #[arg(long, requires = "navigator")]
    sandbox: bool,
    /// A file or folder that an `exec:` navigator may also read in its sandbox; may be given several times
    #[arg(long, value_name = "PATH", requires = "sandbox")]
    sandbox_read: Vec<PathBuf>,
}

impl NavigatorOptions {
    /// Returns the chosen navigator. A program is from now on ended together with this process when the
    /// process is requested to end. A sandbox hides `hidden` from it.
    fn choice(&self, hidden: &[&Path]) -> NavigatorChoice {
        let choice = NavigatorChoice {
            word: self.navigator.clone(),
            timeout_s: self.timeout_s,
            memory_mb: self.memory_mb,
            sandbox: self.sandbox.then(|| Sandbox {
                readable: self.sandbox_read.clone(),
                hidden: hidden.iter().map(|path| path.to_path_buf()).collect(),
            }),
        };
        if choice.is_program() {
            clean_up_when_interrupted();
        }
        choice
    }
}

/// Name of a built-in navigator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::command) enum EstimatorName {
    /// Least squares over all measurements
    #[default]
    Batch,
    /// Filter: each estimate from the measurements until then
    Sequential,
}

impl EstimatorName {
    fn estimator(self) -> Estimator {
        match self {
            Self::Batch => Estimator::Batch,
            Self::Sequential => Estimator::Sequential,
        }
    }

    /// Refuses the navigation of another world, before the run.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the world.
    pub(in crate::command) fn check_world(world: &dyn AnyWorld) -> Result<(), Failure> {
        if world.code() == FarRangeScenario::WORLD {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "--navigate applies only to the world {}: the scenario is of the world {}",
            FarRangeScenario::WORLD,
            world.code()
        )))
    }

    /// Navigates on a run that has just been written, with the defaults of the command `navigate`, and
    /// writes the files of that command into its directory.
    ///
    /// # Errors
    /// The errors of the command `navigate`.
    pub(in crate::command) fn navigate_run(self, directory: &Path) -> Result<NavigationResult, Failure> {
        let campaign = Campaign::open(directory, &KnowledgeConfig::default(), &MeasurementSource::default())?;
        let result = navigate::navigate(&campaign, self.estimator(), EVERY_S)?;
        result.write(directory)?;
        Ok(result)
    }
}

/// Runs the command; exit status 1 if there is no estimate at any time.
pub(in crate::command) fn navigate(
    arguments: &NavigateArguments,
    output: &Output,
) -> Result<Answer, Failure> {
    let mut knowledge = KnowledgeConfig::default();
    if arguments.no_prior {
        knowledge.prior_sigma_m = None;
    }
    let Some(input) = &arguments.input else { return conformance(&arguments.navigator, output) };
    let source =
        MeasurementSource { file: arguments.measurements.clone(), sigma_arcsec: arguments.sigma_arcsec };
    if arguments.bound {
        let report = bound_of(&campaign_or_plan(input, &knowledge, &source)?, BOUND_INTERVALS)?;
        output.answer(&report, bound_table(&report, output.is_terminal()).trim_end())?;
        return Ok(Answer::Yes);
    }
    let directory = arguments.out.as_deref().unwrap_or(input);
    let choice = arguments.navigator.choice(&[input, directory]);
    let campaign = Campaign::open(input, &knowledge, &source)?;
    let scratch = scratch_directory()?;
    if arguments.budget {
        let budget = navigation_budget(input, &campaign, &choice, scratch.path(), arguments.every)?;
        output.answer(&budget, budget_table(&budget, output.is_terminal()).trim_end())?;
        return Ok(Answer::Yes);
    }
    let factory = choice.factory(&campaign, scratch.path())?;
    let result = navigate_with(&campaign, factory.as_ref(), &choice.word, arguments.every)?;
    result.write(directory)?;
    // An existing report of the run lacks the new figure.
    if directory == input && input.join(REPORT).is_file() {
        write_beside_results(input, output);
    }
    let text = navigation_table(&result, output.is_terminal());
    let path = directory.join(TABLE_FILE);
    output.answer(&result, format!("{text}Each estimate is in {}", path.display()))?;
    Ok(if result.score.estimates > 0 { Answer::Yes } else { Answer::No })
}

/// Tests a navigator by the conformance checks of the contract.
fn conformance(options: &NavigatorOptions, output: &Output) -> Result<Answer, Failure> {
    let choice = options.choice(&[]);
    let scratch = scratch_directory()?;
    let shown: Vec<String> = choice
        .violations(scratch.path())?
        .iter()
        .map(|Violation { input, broken }| format!("{input}: {broken}"))
        .collect();
    let document = json!({ "navigator": choice.word, "violations": shown });
    let text = match shown.is_empty() {
        true => format!("{} keeps the rules of the contract", choice.word),
        false => shown.join("\n"),
    };
    output.answer(&document, text)?;
    Ok(if shown.is_empty() { Answer::Yes } else { Answer::No })
}

fn campaign_or_plan(
    input: &Path,
    knowledge: &KnowledgeConfig,
    measurements: &MeasurementSource,
) -> Result<Campaign, Failure> {
    if input.join("run.toml").is_file() {
        return Campaign::open(input, knowledge, measurements);
    }
    if measurements.file.is_some() {
        return Err(Failure::Usage(format!(
            "--measurements applies only to a run: {} has no run.toml",
            input.display()
        )));
    }
    let source = ScenarioSource::read(&input.to_string_lossy())?;
    let scenario = source.typed::<FarRangeScenario>("far range")?;
    Campaign::from_plan(&source.name, "", scenario, knowledge)
}
