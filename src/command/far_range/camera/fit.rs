//! `boresight camera fit`: a camera from frames of the night sky.

use std::path::PathBuf;

use camera_fit::{FirstGuess, FitError, SkyFrame, fit_camera};
use clap::Args;
use files::{AtomicFile, Failure, read_grey_image};
use hifitime::Epoch;
use serde_json::json;

use super::camera_file::camera_toml;
use super::fit_text::{document, fit_text};
use super::images::{has_extension, images};
use super::sensor_file::SensorSource;
use crate::command::Answer;
use crate::command::options::{exposure, number, output_path, time};
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct FitArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    pub(super) directory: PathBuf,
    /// Width of the field along the columns, degrees, 0.5 to 120
    #[arg(long, value_name = "DEG", value_parser = field)]
    pub(super) field_deg: f64,
    /// Largest relative error of the field, 0 to 0.2
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, value_parser = tolerance)]
    pub(super) tolerance: f64,
    /// Width of a pixel, µm, 0.01 to 1e4: sets the unit of the focal length, which in pixels does not depend
    /// on it
    #[arg(long, value_name = "UM", default_value_t = 5.0, value_parser = pixel)]
    pub(super) pixel_um: f64,
    /// Height of a pixel, µm, where it is not square
    #[arg(long, value_name = "UM", value_parser = pixel)]
    pub(super) pixel_height_um: Option<f64>,
    /// Time of the frames, UTC, 1990 to 2050: sets proper motion and aberration. A day wrong changes
    /// directions by half an arc second
    #[arg(long, value_name = "UTC", default_value = "2026-01-01T00:00:00Z", value_parser = time)]
    pub(super) time: Epoch,
    /// Exposure time of the frames, s, 1e-6 to 1000: for the brightness of stars per second
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = exposure)]
    pub(super) exposure: f64,
    /// Sensor file of `boresight camera sensor`: its gain, bias, noise and dark current are those of the
    /// camera
    #[arg(long, value_name = "FILE")]
    pub(super) sensor: Option<PathBuf>,
    /// A new file for the camera, TOML: for `boresight sky --camera FILE`, or to be pasted into a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    pub(super) out: Option<PathBuf>,
}

fn field(text: &str) -> Result<f64, String> {
    number(text, 0.5, 120.0)
}

fn tolerance(text: &str) -> Result<f64, String> {
    number(text, 0.0, 0.2)
}

fn pixel(text: &str) -> Result<f64, String> {
    number(text, 0.01, 1e4)
}

pub(super) fn fit(arguments: &FitArguments, output: &Output) -> Result<Answer, Failure> {
    let paths = images(&arguments.directory)?;
    if let Some(out) = arguments.out.as_deref().filter(|out| out.exists()) {
        return Err(Failure::Usage(format!("--out is {}, which exists; expected a new file", out.display())));
    }
    let sensor = arguments.sensor.as_deref().map(SensorSource::read).transpose()?;
    let progress = output.progress_of(paths.len() as u64, "images", "reading");
    let mut frames = Vec::with_capacity(paths.len());
    for path in &paths {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        frames.push(SkyFrame { name, image: read_grey_image(path)? });
        progress.inc(1);
    }
    progress.finish_and_clear();
    let guess = FirstGuess {
        field_deg: arguments.field_deg,
        tolerance: arguments.tolerance,
        pixel_um: [arguments.pixel_um, arguments.pixel_height_um.unwrap_or(arguments.pixel_um)],
        time: arguments.time,
    };
    let fit = match fit_camera(&frames, &guess) {
        Ok(fit) => fit,
        Err(error @ (FitError::NoAttitude(_) | FitError::TooFewStars(_))) => {
            let text = format!("{}: {error}", arguments.directory.display());
            output.answer(&json!({ "ok": false, "error": text }), text)?;
            return Ok(Answer::No);
        }
        Err(error) => return Err(Failure::Usage(format!("{}: {error}", arguments.directory.display()))),
    };
    if paths.iter().any(|path| has_extension(path, &["jpg", "jpeg"])) {
        output.note("warning: JPEG changes faint stars and widths; raw images give a better camera");
    }
    if let Some(out) = &arguments.out {
        AtomicFile::with_text(out, &camera_toml(&fit, arguments, sensor.as_ref())?)?.commit_new()?;
    }
    let mut text = fit_text(&fit);
    if let Some(out) = &arguments.out {
        text.push_str(&format!("\ncamera in {}", out.display()));
    }
    output.answer(&document(&fit), text)?;
    Ok(Answer::Yes)
}
