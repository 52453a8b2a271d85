//! `boresight camera fit`: a camera from frames of the night sky.

use std::path::{Path, PathBuf};

use camera_fit::{FirstGuess, FitError, SkyFrame, fit_camera};
use clap::Args;
use contract::Camera;
use files::{AtomicFile, Failure};
use hifitime::Epoch;
use serde_json::json;
use twin::{FrameSet, MeasuredSensor, Origin, TwinCamera, camera_toml};

use super::fit_text::{document, fit_text};
use super::images::{images, read_frames};
use super::pages::write_fit_page;
use super::sensor_file::SensorSource;
use crate::command::Answer;
use crate::command::options::{exposure, number, output_path, time};
use crate::command::output::Output;
use crate::command::report::check_option;

#[derive(Debug, Args)]
pub(in crate::command) struct FitArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    #[command(flatten)]
    guess: GuessArguments,
    /// A new file for the camera, TOML: for `boresight sky --camera FILE`, or to be pasted into a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Also write the residuals, profiles and figures as one HTML file, replaced if it is a report
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    report: Option<PathBuf>,
}

/// What is known of the camera beforehand.
#[derive(Debug, Args)]
pub(in crate::command) struct GuessArguments {
    /// Width of the field along the columns, degrees, 0.5 to 120
    #[arg(long, value_name = "DEG", value_parser = field)]
    field_deg: f64,
    /// Largest relative error of the field, 0 to 0.2
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, value_parser = tolerance)]
    tolerance: f64,
    /// Width of a pixel, µm, 0.01 to 1e4: sets the unit of the focal length, which in pixels does not depend
    /// on it
    #[arg(long, value_name = "UM", default_value_t = 5.0, value_parser = pixel)]
    pixel_um: f64,
    /// Height of a pixel, µm, where it is not square
    #[arg(long, value_name = "UM", value_parser = pixel)]
    pixel_height_um: Option<f64>,
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
    sensor: Option<PathBuf>,
}

impl GuessArguments {
    pub(super) fn first_guess(&self) -> FirstGuess {
        FirstGuess {
            field_deg: self.field_deg,
            tolerance: self.tolerance,
            pixel_um: [self.pixel_um, self.pixel_height_um.unwrap_or(self.pixel_um)],
            time: self.time,
        }
    }

    /// Reads the sensor file; `None` without the option.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake in it.
    pub(super) fn sensor(&self) -> Result<Option<SensorSource>, Failure> {
        self.sensor.as_deref().map(SensorSource::read).transpose()
    }

    pub(super) fn origin<'a>(&self, directory: &'a Path) -> Origin<'a> {
        Origin { directory, time: self.time, exposure_s: self.exposure }
    }
}

fn field(text: &str) -> Result<f64, String> {
    number(text, 0.5, 120.0)
}

fn tolerance(text: &str) -> Result<f64, String> {
    number(text, 0.0, 0.2)
}

/// Parses the side of a pixel, µm.
pub(super) fn pixel(text: &str) -> Result<f64, String> {
    number(text, 0.01, 1e4)
}

pub(super) fn fit(arguments: &FitArguments, output: &Output) -> Result<Answer, Failure> {
    let paths = images(&arguments.directory)?;
    if let Some(out) = &arguments.out {
        super::refuse_existing(out)?;
    }
    check_option(arguments.report.as_ref())?;
    let sensor = arguments.guess.sensor()?;
    let frames = read_frames(&paths, output)?;
    let Some(set) = fitted(&arguments.directory, frames, &arguments.guess.first_guess(), output)? else {
        return Ok(Answer::No);
    };
    let mut text = fit_text(&set.fit);
    let measured = measured_sensor(&set, sensor.as_ref(), arguments.guess.exposure)?;
    let twin = TwinCamera::of(&set, measured);
    if let Some(path) = &arguments.report {
        write_fit_page(&set, &twin, &arguments.directory, path)?;
        text.push_str(&format!("\nreport in {}", path.display()));
    }
    if let Some(out) = &arguments.out {
        let camera = camera_toml(&set.fit, &twin, &arguments.guess.origin(&arguments.directory));
        AtomicFile::with_text(out, &camera)?.commit_new()?;
        text.push_str(&format!("\ncamera in {}", out.display()));
    }
    output.answer(&document(&set.fit), text)?;
    Ok(Answer::Yes)
}

/// Fits a camera to frames; `None` after an answer that says why there is none.
///
/// # Errors
/// [`Failure::Usage`] for frames that are not of one camera, or an invalid first guess.
pub(super) fn fitted(
    directory: &Path,
    frames: Vec<SkyFrame>,
    guess: &FirstGuess,
    output: &Output,
) -> Result<Option<FrameSet>, Failure> {
    match fit_camera(&frames, guess) {
        Ok(fit) => Ok(Some(FrameSet { frames, fit })),
        Err(error @ (FitError::NoAttitude(_) | FitError::TooFewStars(_))) => {
            let text = format!("{}: {error}", directory.display());
            output.answer(&json!({ "ok": false, "error": text }), text)?;
            Ok(None)
        }
        Err(error) => Err(Failure::Usage(format!("{}: {error}", directory.display()))),
    }
}

/// Largest relative error of the field of a camera whose focal length is known.
const KNOWN_TOLERANCE: f64 = 0.005;

/// Returns the first guess for frames of a known camera.
pub(super) fn known_guess(camera: &Camera, time: Epoch) -> FirstGuess {
    let (focal_px, _) = camera.focal_length_px();
    let half_field = libm::atan(0.5 * camera.columns as f64 / focal_px);
    FirstGuess {
        field_deg: 2.0 * half_field.to_degrees(),
        tolerance: KNOWN_TOLERANCE,
        pixel_um: [camera.pixel_width_um, camera.pixel_height_um],
        time,
    }
}

/// Returns a measured sensor with the light of the sky in the frames: their background above bias and dark
/// current.
///
/// # Errors
/// A [`Failure`] for tables that cannot be written.
pub(super) fn measured_sensor(
    set: &FrameSet,
    source: Option<&SensorSource>,
    exposure_s: f64,
) -> Result<Option<MeasuredSensor>, Failure> {
    let Some(source) = source else { return Ok(None) };
    let sensor = &source.sensor;
    let background_dn = set.fit.background_dn;
    let signal_e_per_s = (background_dn - sensor.bias_dn) * sensor.gain_e_per_dn / exposure_s;
    let sky_e_per_s = (signal_e_per_s - sensor.dark_current_e_per_s).clamp(0.0, 1e6);
    let origin = format!(
        "the background of the frames, {background_dn:.2} DN in {exposure_s} s, above bias and dark current"
    );
    let tables = source.tables(sky_e_per_s, &origin)?;
    Ok(Some(MeasuredSensor { gain_e_per_dn: sensor.gain_e_per_dn, tables }))
}
