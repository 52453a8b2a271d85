//! `boresight navigate`: relative orbit from the lines of sight of a run, or its bound before a flight.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use files::{Checksums, Failure, refuse_unfinished};
use navigate::{Campaign, Estimator, KnowledgeConfig, NavigationResult, TABLE_FILE, bound_of};
use run::{AnyWorld, ScenarioSource, world_of_run};
use scenario::FarRangeScenario;
use scenario::run_file::{RunFile, ScenarioFile};

use super::Answer;
use super::options::output_path;
use super::output::Output;
use super::report::write_beside_results;
use crate::table::{bound_table, navigation_table};

/// Number of intervals of a bound's table.
const BOUND_INTERVALS: u32 = 12;

/// Interval of the estimates, s, if none is given.
const EVERY_S: f64 = 600.0;

/// Name of a run's report.
const REPORT: &str = "report.html";

/// Files of a run that the command reads.
const READ: [&str; 3] = ["run.toml", "measurements.csv", "telemetry.csv"];

#[derive(Debug, Args)]
pub(super) struct NavigateArguments {
    /// Directory of a far-range run; with --bound also a built-in scenario or a TOML file
    #[arg(value_name = "RUN|SCENARIO")]
    input: PathBuf,
    /// Navigator
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    estimator: EstimatorName,
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
    #[arg(long, conflicts_with_all = ["estimator", "every", "out"])]
    bound: bool,
}

/// Name of a built-in navigator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum EstimatorName {
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
    pub(super) fn check_world(world: &dyn AnyWorld) -> Result<(), Failure> {
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
    pub(super) fn navigate_run(self, directory: &Path) -> Result<NavigationResult, Failure> {
        let campaign = campaign(directory, &KnowledgeConfig::default())?;
        let result = navigate::navigate(&campaign, self.estimator(), EVERY_S)?;
        result.write(directory)?;
        Ok(result)
    }
}

/// Runs the command; exit status 1 if there is no estimate at any time.
pub(super) fn navigate(arguments: &NavigateArguments, output: &Output) -> Result<Answer, Failure> {
    let mut knowledge = KnowledgeConfig::default();
    if arguments.no_prior {
        knowledge.prior_sigma_m = None;
    }
    let input = &arguments.input;
    if arguments.bound {
        let report = bound_of(&campaign_or_plan(input, &knowledge)?, BOUND_INTERVALS)?;
        output.answer(&report, bound_table(&report, output.is_terminal()).trim_end())?;
        return Ok(Answer::Yes);
    }
    let campaign = campaign(input, &knowledge)?;
    let result = navigate::navigate(&campaign, arguments.estimator.estimator(), arguments.every)?;
    let directory = arguments.out.as_deref().unwrap_or(input);
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

fn campaign_or_plan(input: &Path, knowledge: &KnowledgeConfig) -> Result<Campaign, Failure> {
    if input.join("run.toml").is_file() {
        return campaign(input, knowledge);
    }
    let source = ScenarioSource::read(&input.to_string_lossy())?;
    let scenario = source.typed::<FarRangeScenario>("far range")?;
    Campaign::from_plan(&source.name, "", scenario, knowledge)
}

fn campaign(directory: &Path, knowledge: &KnowledgeConfig) -> Result<Campaign, Failure> {
    let path = directory.join("run.toml");
    let world = world_of_run(&path)?;
    if world.code() != FarRangeScenario::WORLD {
        return Err(Failure::Usage(format!(
            "{}: is a run of the world {}, expected {}",
            directory.display(),
            world.code(),
            FarRangeScenario::WORLD
        )));
    }
    refuse_unfinished(directory)?;
    let run = RunFile::read(&path)?;
    let campaign = Campaign::read(directory, &run, knowledge)?;
    Checksums::check(directory, |name| READ.contains(&name))?;
    Ok(campaign)
}
