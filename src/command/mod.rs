//! The command `boresight`: arguments in, exit status out. Printing, clocks and environment are confined to
//! this module.

mod answer;
mod cluster;
mod dataset;
mod demo;
mod docking;
mod examples;
mod execute;
mod far_range;
mod gate;
mod interrupt;
#[cfg(not(all(feature = "report", feature = "monitor", feature = "mitsuba")))]
mod missing_feature;
mod monitor;
mod options;
mod output;
mod report;
mod reproduce;
mod run;
mod scenario;
mod score;
mod scratch_directory;
mod shell;
mod show;
mod study;
use std::ffi::OsString;
use std::process::ExitCode;

use answer::Answer;
use clap::{CommandFactory, Parser, Subcommand};
use files::Failure;
use interrupt::{clean_up_when_interrupted, scratch_directory};
#[cfg(not(all(feature = "report", feature = "monitor", feature = "mitsuba")))]
use missing_feature::missing_feature;
pub use report::write_page_of;

/// Version, commit of the source and enabled features.
const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (commit ",
    env!("BORESIGHT_COMMIT"),
    "; features: ",
    env!("BORESIGHT_FEATURES"),
    ")"
);

/// Synthetic scene simulator and test oracle for optical navigation.
#[derive(Debug, Parser)]
#[command(
    name = "boresight",
    version = VERSION,
    max_term_width = 110,
    after_help = "First steps:\n  \
        boresight demo                       two rendezvous, measured and scored, in ten seconds\n  \
        boresight reproduce argon            Table 2 of the far-range paper, in a minute\n  \
        boresight scenario new my.toml       a commented scenario to change\n\n\
        Exit status: 0 success, 1 negative result, 2 usage error or invalid input."
)]
struct Arguments {
    /// Print one JSON document, and nothing else, on stdout
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Simulate, process and score two small rendezvous in ten seconds, and show the results on one page
    Demo(demo::DemoArguments),
    /// Simulate, process and score a scenario; write a run directory
    Run(run::RunArguments),
    /// Render a dataset for an external pipeline, with the truth apart from the frames
    Render(dataset::RenderArguments),
    /// Write one picture of the sky, as a camera sees it: PNG, or FITS with world coordinates
    ///
    /// Stars of the Hipparcos catalogue, Moon, planets and zodiacal light. The camera is at rest, on the
    /// orbit of the built-in scenario `starting-point`; neither Sun nor Earth is drawn, and the Earth covers
    /// no star.
    Sky(far_range::SkyArguments),
    /// Determine a camera from its frames
    #[command(subcommand)]
    Camera(far_range::CameraCommand),
    /// Write a scenario that simulates the frames of a camera: the camera fitted to them, at their pointings
    ///
    /// `boresight compare` then states where the simulated frames differ from those of the camera.
    Twin(far_range::TwinArguments),
    /// State where the frames of a camera differ from those of its simulated twin
    ///
    /// Each figure has an interval of 95 %, so that one of twenty differs by chance. The exit status is 1 if
    /// they differ as a whole, by more than chance gives in one of so many.
    Compare(far_range::CompareArguments),
    /// Reproduce the tables and figures of a paper whose method is built in
    Reproduce(reproduce::ReproduceArguments),
    /// Run a pipeline on a dataset, which may contain real images
    Process(dataset::ProcessArguments),
    /// Score measurements of any pipeline against the truth of a dataset or run directory
    Score(score::ScoreArguments),
    /// Monte Carlo: a scenario with variation of any parameter that can vary
    #[command(subcommand)]
    Study(study::StudyCommand),
    /// Find cameras that detect enough stars and the target: verify requirements, find exposure, aperture or
    /// field
    Visibility(far_range::VisibilityArguments),
    /// Test whether a result is worse than a baseline; exit status 1 if it is
    Gate(gate::GateArguments),
    /// Write the content of a result directory as one HTML file: charts, tables, frames; needs no network
    Report(report::ReportArguments),
    /// Draw frames of a run or dataset: pixels, truth, answer, regions, scale bar and legend as one PNG
    Show(show::ShowArguments),
    /// Write truth or measurements of a far-range run as a message of CCSDS: OEM, AEM or TDM
    Export(far_range::ExportArguments),
    /// Determine the relative orbit from the lines of sight of a far-range run, and compare it with the truth
    Navigate(far_range::NavigateArguments),
    /// Serve an operator's page on loopback: camera, ground track, phase chart, model and parameters
    #[command(
        after_help = "SCENARIO may be the directory of a run, which is replayed with its pictures rendered \
            again. The name of a built-in scenario takes precedence over a folder of that name (./NAME)."
    )]
    Monitor(monitor::MonitorArguments),
    /// Write the example pipelines, studies, requirements and targets of the book
    Examples(examples::ExamplesArguments),
    /// List, check and start scenarios
    #[command(subcommand)]
    Scenario(scenario::ScenarioCommand),
    /// Print completions for a shell
    Completions(shell::CompletionsArguments),
    /// Write manual pages
    Man(shell::ManArguments),
}

/// Runs the command with this process's arguments.
pub fn main() -> ExitCode {
    ExitCode::from(run_words(std::env::args_os()))
}

/// Runs the command with the given words, starting with the command name, and returns the exit status: 0
/// success, 1 negative result, 2 usage error, invalid input, or a pipeline that does not start.
pub fn run_words(words: impl IntoIterator<Item = OsString>) -> u8 {
    crate::register_worlds();
    let words: Vec<OsString> = words.into_iter().collect();
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // The arguments may be invalid, but the output format that the caller expects is known.
            output::Output::new(words.iter().any(|word| word == "--json")).misuse(&error);
            // A closed stream cannot be reported.
            let _ = error.print();
            return u8::from(error.use_stderr()) * Failure::EXIT_STATUS;
        }
    };
    let output = output::Output::new(arguments.json);
    let Some(command) = arguments.command else {
        return without_command(&output);
    };
    if !matches!(command, Command::Monitor(_)) {
        // The monitor's server handles signals itself.
        clean_up_when_interrupted();
    }
    let answer = match command {
        Command::Demo(arguments) => demo::demo(&arguments, &output),
        Command::Run(arguments) => run::run(&arguments, &output),
        Command::Render(arguments) => dataset::render(&arguments, &output),
        Command::Sky(arguments) => far_range::sky(&arguments, &output),
        Command::Camera(command) => far_range::camera(&command, &output),
        Command::Twin(arguments) => far_range::twin(&arguments, &output),
        Command::Compare(arguments) => far_range::compare(&arguments, &output),
        Command::Reproduce(arguments) => reproduce::reproduce(&arguments, &output),
        Command::Process(arguments) => dataset::process(&arguments, &output),
        Command::Score(arguments) => score::score(&arguments, &output),
        Command::Study(command) => study::study(&command, &output),
        Command::Visibility(arguments) => far_range::visibility(&arguments, &output),
        Command::Gate(arguments) => gate::gate(&arguments, &output),
        Command::Report(arguments) => report::report(&arguments, &output),
        Command::Show(arguments) => show::show(&arguments, &output),
        Command::Export(arguments) => far_range::export(&arguments, &output),
        Command::Navigate(arguments) => far_range::navigate(&arguments, &output),
        Command::Monitor(arguments) => monitor::monitor(&arguments, &output),
        Command::Examples(arguments) => examples::examples(&arguments, &output),
        Command::Scenario(command) => scenario::scenario(&command, &output),
        Command::Completions(arguments) => shell::completions(&arguments, Arguments::command(), &output),
        Command::Man(arguments) => shell::man(&arguments, Arguments::command(), &output),
    };
    match answer {
        Ok(Answer::Yes) => 0,
        Ok(Answer::No) => 1,
        Ok(Answer::Part) => Failure::EXIT_STATUS,
        Err(failure) => {
            output.failure(failure);
            Failure::EXIT_STATUS
        }
    }
}

/// Prints the help of the command; `--json` alone requests no document and is a usage error.
fn without_command(output: &output::Output) -> u8 {
    let free = output.check_free("the help without a command");
    let printed = free.and_then(|()| output.answer(&(), Arguments::command().render_help()));
    match printed {
        Ok(()) => 0,
        Err(failure) => {
            output.failure(failure);
            Failure::EXIT_STATUS
        }
    }
}
