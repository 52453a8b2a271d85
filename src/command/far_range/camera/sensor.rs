//! `boresight camera sensor`: figures of an image sensor from bias, dark and flat frames.

use std::path::PathBuf;

use clap::Args;
use files::{AtomicFile, Failure};
use sensor_fit::{Finding, fit_sensor};

use super::sensor_file::sensor_toml;
use super::sensor_text::{document, sensor_text};
use super::stack_folders::read_stacks;
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct SensorArguments {
    /// Directory with two or more frames of the shortest exposure, without light
    #[arg(long, value_name = "DIR", required_unless_present_any = ["dark", "flat"])]
    pub(super) bias: Option<PathBuf>,
    /// Directory of frames without light: a folder per exposure time, named by it (`0.5s`), or FITS with
    /// EXPTIME or EXPOSURE
    #[arg(long, value_name = "DIR")]
    pub(super) dark: Option<PathBuf>,
    /// Directory of frames with uniform, steady light: a folder per exposure time (`0.5s`) or per time and
    /// relative light (`0.5s_x0.25`), or FITS with EXPTIME or EXPOSURE
    #[arg(long, value_name = "DIR")]
    pub(super) flat: Option<PathBuf>,
    /// A new file with a [sensor] table, TOML: for `boresight camera fit --sensor FILE`, or to be pasted into
    /// a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    pub(super) out: Option<PathBuf>,
}

pub(super) fn sensor(arguments: &SensorArguments, output: &Output) -> Result<Answer, Failure> {
    if let Some(out) = arguments.out.as_deref().filter(|out| out.exists()) {
        return Err(Failure::Usage(format!("--out is {}, which exists; expected a new file", out.display())));
    }
    let frames = read_stacks(arguments, output)?;
    let figures = fit_sensor(&frames).map_err(|error| Failure::Usage(error.to_string()))?;
    let has_gain = figures.gain_e_per_dn.value().is_some();
    let mut text = sensor_text(&figures);
    if let Some(out) = &arguments.out {
        if let Finding::Missing(reason) = &figures.gain_e_per_dn {
            text.push_str(&format!("\nno file: a sensor in electrons needs the gain ({reason})"));
        } else {
            AtomicFile::with_text(out, &sensor_toml(&figures)?)?.commit_new()?;
            text.push_str(&format!("\nsensor in {}", out.display()));
        }
    }
    output.answer(&document(&figures), text)?;
    // Flats and a file are requests for a gain.
    let is_gain_expected = arguments.flat.is_some() || arguments.out.is_some();
    Ok(if has_gain || !is_gain_expected { Answer::Yes } else { Answer::No })
}
