//! `boresight camera fit`: a camera from frames of the night sky.

use std::path::{Path, PathBuf};

use camera_fit::{FirstGuess, FitError, SkyFrame, fit_camera, saturation_dn};
use clap::Args;
use files::{AtomicFile, Failure, GreyImage, PixelConversion};
use serde_json::json;
use twin::{FrameSet, MeasuredSensor, Origin, TwinCamera, camera_toml};

use super::fit_text::{document, fit_text, warnings};
use super::guess::{GuessArguments, Known};
use super::images::{images, read_frames};
use super::mosaic::{Mosaic, camera_of_pixels};
use super::pages::write_fit_page;
use super::sensor_file::SensorSource;
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;
use crate::command::report::check_option;

#[derive(Debug, Args)]
pub(in crate::command) struct FitArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    #[command(flatten)]
    guess: GuessArguments,
    /// Pattern of a raw mosaic: the colours of its first two rows. The camera is fitted to the mean of the
    /// two green pixels of each square of two by two, and is that of the pixels of the mosaic
    #[arg(long, value_name = "PATTERN", ignore_case = true, conflicts_with = "report")]
    bayer: Option<Mosaic>,
    /// A new file for the camera, TOML: for `boresight sky --camera FILE`, or to be pasted into a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Also write the residuals, profiles and figures as one HTML file, replaced if it is a report
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    report: Option<PathBuf>,
}

pub(super) fn fit(arguments: &FitArguments, output: &Output) -> Result<Answer, Failure> {
    let directory = &arguments.directory;
    let paths = images(directory)?;
    if let Some(out) = &arguments.out {
        super::refuse_existing(out)?;
    }
    check_option(arguments.report.as_ref())?;
    let sensor = arguments.guess.sensor()?;
    let mut frames = read_frames(&paths, output)?;
    let Known { mut guess, exposure_s } = arguments.guess.first_guess(directory, &paths, output)?;
    let size = frames.first().map_or([0; 2], |frame| [frame.image.columns, frame.image.rows]);
    let saturation_dn = saturation_dn(&frames);
    if let Some(mosaic) = arguments.bayer {
        // The squares of a mosaic are fitted as pixels.
        guess.pixel_um = guess.pixel_um.map(|side_um| 2.0 * side_um);
        for frame in &mut frames {
            frame.image = green_pixels(frame, mosaic)?;
        }
    }
    let Some(mut set) = fitted(directory, frames, &guess, output)? else { return Ok(Answer::No) };
    let measured = measured_sensor(&set, sensor.as_ref(), exposure_s)?;
    let is_twin_needed = arguments.out.is_some() || arguments.report.is_some();
    let mut twin = is_twin_needed.then(|| TwinCamera::of(&set, measured));
    if arguments.bayer.is_some() {
        camera_of_pixels(&mut set.fit, size[0], size[1]);
        set.fit.saturation_dn = saturation_dn;
        twin.iter_mut().for_each(|twin| twin.convert_to_mosaic(saturation_dn));
    }
    for warning in warnings(&set.fit, guess.time) {
        output.note(format!("warning: {warning}"));
    }
    let mut text = fit_text(&set.fit);
    if let (Some(path), Some(twin)) = (&arguments.report, &twin) {
        write_fit_page(&set, twin, directory, path)?;
        text.push_str(&format!("\nreport in {}", path.display()));
    }
    if let (Some(out), Some(twin)) = (&arguments.out, &twin) {
        let origin = Origin { directory, time: guess.time, exposure_s };
        AtomicFile::with_text(out, &camera_toml(&set.fit, twin, &origin))?.commit_new()?;
        text.push_str(&format!("\ncamera in {}", out.display()));
    }
    output.answer(&document(&set.fit, guess.time), text)?;
    Ok(Answer::Yes)
}

/// Returns the green pixels of a mosaic.
///
/// # Errors
/// [`Failure::Usage`] for an image in colour, or without a square of two by two pixels.
fn green_pixels(frame: &SkyFrame, mosaic: Mosaic) -> Result<GreyImage, Failure> {
    let image = &frame.image;
    if image.conversion != PixelConversion::None || image.columns < 2 || image.rows < 2 {
        return Err(Failure::Usage(format!(
            "{}: --bayer is {mosaic:?}, and the image is {} × {} in colour or too small; expected a grey raw mosaic",
            frame.name, image.columns, image.rows
        )));
    }
    Ok(mosaic.green(image))
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
        Err(error @ (FitError::NoAttitude(_) | FitError::Reading { .. } | FitError::TooFewStars(_))) => {
            let text = format!("{}: {error}", directory.display());
            output.answer(&json!({ "ok": false, "error": text }), text)?;
            Ok(None)
        }
        Err(error) => Err(Failure::Usage(format!("{}: {error}", directory.display()))),
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
