//! `boresight export`: truth and measurements of a far-range run as messages of CCSDS.

mod messages;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use files::{AtomicFile, Failure};
use flight_dynamics::Notation;
use run::world_of_run;
use scenario::FarRangeScenario;
use scenario::run_file::{RunFile, ScenarioFile};
use serde_json::json;

use self::messages::Spacecraft;
use super::Answer;
use super::options::output_path;
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    /// Directory of a far-range run
    #[arg(value_name = "RUN")]
    directory: PathBuf,
    /// Content of the message
    #[arg(long, value_name = "FORMAT", value_enum)]
    format: ExportFormat,
    /// Spacecraft of an OEM
    #[arg(long, value_name = "OBJECT", value_enum, default_value_t)]
    object: Spacecraft,
    /// Largest step between the states of an OEM, s, 0.1 to 600
    #[arg(long, value_name = "S", default_value_t = 30.0)]
    step_s: f64,
    /// Notation of the message
    #[arg(long, value_name = "NOTATION", value_enum, default_value_t)]
    notation: MessageNotation,
    /// File to write; an existing file is not replaced
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: PathBuf,
}

/// Content of an exported message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    /// Orbit ephemeris message: the true motion of the chaser or the target
    Oem,
    /// Attitude ephemeris message: the true attitude of the chaser at the frames
    Aem,
    /// Tracking data message: measured lines of sight, right ascension and declination
    Tdm,
}

/// Notation of an exported message.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum MessageNotation {
    /// Keyword = value
    #[default]
    Kvn,
    /// XML
    Xml,
}

pub(super) fn export(arguments: &ExportArguments, output: &Output) -> Result<Answer, Failure> {
    let ExportArguments { directory, format, object, step_s, notation, out } = arguments;
    if !(0.1..=600.0).contains(step_s) {
        return Err(Failure::Usage(format!("--step-s is {step_s}, expected 0.1 to 600")));
    }
    let run = run_file(directory)?;
    let notation = match notation {
        MessageNotation::Kvn => Notation::Kvn,
        MessageNotation::Xml => Notation::Xml,
    };
    let (text, count, unit) = match format {
        ExportFormat::Oem => {
            let oem = messages::oem(&run, *object, *step_s)?;
            let count = oem.segments.iter().map(|segment| segment.states.len()).sum::<usize>();
            (oem.to_text(notation), count, "states")
        }
        ExportFormat::Aem => {
            let aem = messages::aem(directory, &run)?;
            let count = aem.segments.iter().map(|segment| segment.attitudes.len()).sum::<usize>();
            (aem.to_text(notation), count, "attitudes")
        }
        ExportFormat::Tdm => {
            let tdm = messages::tdm(directory, &run)?;
            let count = tdm.segments.iter().map(|segment| segment.observations.len()).sum::<usize>();
            (tdm.to_text(notation), count, "directions")
        }
    };
    AtomicFile::with_text(out, &text)?.commit_new()?;
    let document = json!({ "file": out, unit: count });
    output.answer(&document, format!("{count} {unit} in {}", out.display()))?;
    Ok(Answer::Yes)
}

/// Reads the description of a far-range run.
fn run_file(directory: &Path) -> Result<RunFile<FarRangeScenario>, Failure> {
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
    RunFile::read(&path)
}
