//! `boresight export`: truth, estimates and measurements of a far-range run as messages of CCSDS.

mod attitude;
mod directions;
mod orbit;
mod parts;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use far_range::FarRangeScenario;
use files::{AtomicFile, Failure};
use flight_dynamics::Notation;
use run::check_world_of_run;
use scenario::run_file::{RunFile, ScenarioFile};
use serde_json::json;

use self::attitude::{AttitudeFrame, attitude_count, measured_attitude, true_attitude};
use self::directions::tdm;
use self::orbit::{Spacecraft, estimated_orbit, state_count, true_orbit};
use self::parts::Export;
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct ExportArguments {
    /// Directory of a far-range run
    #[arg(value_name = "RUN")]
    directory: PathBuf,
    /// Content of the message
    #[arg(long, value_name = "FORMAT", value_enum)]
    format: ExportFormat,
    /// Estimates in place of the truth: the target's orbit by relative navigation (OEM), or the attitude that
    /// the pipeline states (AEM)
    #[arg(long)]
    estimates: bool,
    /// Directory of the navigation.csv and navigation.json of estimates (OEM); default: that of the run
    #[arg(long, value_name = "DIR", requires = "estimates")]
    navigation: Option<PathBuf>,
    /// Spacecraft of an OEM; default: the chaser, of estimates the target
    #[arg(long, value_name = "OBJECT", value_enum)]
    object: Option<Spacecraft>,
    /// Largest step between the true states of an OEM, s, 0.1 to 600; default: 30
    #[arg(long, value_name = "S")]
    step_s: Option<f64>,
    /// Frame of an AEM; default: the body, of estimates by the nominal mounting of the camera
    #[arg(long, value_name = "FRAME", value_enum)]
    frame: Option<AttitudeFrame>,
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
    /// Orbit ephemeris message: the true motion of the chaser or the target, or the estimated one of the
    /// target
    Oem,
    /// Attitude ephemeris message: the true or the measured attitude of the chaser at the frames
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

/// Default of the largest step between true states, s.
const DEFAULT_STEP_S: f64 = 30.0;

impl ExportArguments {
    /// Refuses an option that does not apply to the content.
    fn check_options(&self) -> Result<(), Failure> {
        use ExportFormat::{Aem, Oem};
        let Self { format, estimates, navigation, object, step_s, frame, .. } = self;
        let refused = [
            (*estimates && *format == ExportFormat::Tdm, "--estimates", "--format oem or aem"),
            (navigation.is_some() && *format != Oem, "--navigation", "--format oem"),
            (object.is_some() && *format != Oem, "--object", "--format oem"),
            (step_s.is_some() && (*format != Oem || *estimates), "--step-s", "the truth of --format oem"),
            (frame.is_some() && *format != Aem, "--frame", "--format aem"),
        ];
        if let Some((_, option, content)) = refused.iter().find(|(is_refused, ..)| *is_refused) {
            return Err(Failure::Usage(format!("{option} applies only to {content}")));
        }
        if *estimates && *object == Some(Spacecraft::Chaser) {
            let message = "--object is chaser, expected target: navigators estimate the target's orbit";
            return Err(Failure::Usage(message.to_owned()));
        }
        match step_s {
            Some(step_s) if !(0.1..=600.0).contains(step_s) => {
                Err(Failure::Usage(format!("--step-s is {step_s}, expected 0.1 to 600")))
            }
            _ => Ok(()),
        }
    }
}

pub(in crate::command) fn export(arguments: &ExportArguments, output: &Output) -> Result<Answer, Failure> {
    arguments.check_options()?;
    let ExportArguments { directory, format, estimates, navigation, object, step_s, frame, notation, out } =
        arguments;
    let run = run_file(directory)?;
    let notation = match notation {
        MessageNotation::Kvn => Notation::Kvn,
        MessageNotation::Xml => Notation::Xml,
    };
    let (text, count, unit, left_out) = match format {
        ExportFormat::Oem => {
            let Export { message, left_out } = if *estimates {
                estimated_orbit(navigation.as_deref().unwrap_or(directory), &run)?
            } else {
                let object = object.unwrap_or(Spacecraft::Chaser);
                true_orbit(directory, &run, object, step_s.unwrap_or(DEFAULT_STEP_S))?
            };
            (message.to_text(notation), state_count(&message), "states", left_out)
        }
        ExportFormat::Aem => {
            let attitude = if *estimates { measured_attitude } else { true_attitude };
            let Export { message, left_out } = attitude(directory, &run, frame.unwrap_or_default())?;
            (message.to_text(notation), attitude_count(&message), "attitudes", left_out)
        }
        ExportFormat::Tdm => {
            let tdm = tdm(directory, &run)?;
            let count = tdm.segments.iter().map(|segment| segment.observations.len()).sum::<usize>();
            (tdm.to_text(notation), count, "directions", 0)
        }
    };
    AtomicFile::with_text(out, &text)?.commit_new()?;
    let document = json!({ "file": out, unit: count, "left_out": left_out });
    let mut told = format!("{count} {unit} in {}", out.display());
    if left_out > 0 {
        told += &format!("; left out, alone between two gaps: {left_out}");
    }
    output.answer(&document, told)?;
    Ok(Answer::Yes)
}

/// Reads the description of a far-range run.
fn run_file(directory: &Path) -> Result<RunFile<FarRangeScenario>, Failure> {
    check_world_of_run(directory, FarRangeScenario::WORLD)?;
    RunFile::read(&directory.join("run.toml"))
}
