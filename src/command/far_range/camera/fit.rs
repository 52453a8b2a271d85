//! `boresight camera fit`: a camera from frames of the night sky.

use std::path::{Path, PathBuf};

use camera_fit::{FirstGuess, FitError, SkyFrame, fit_camera};
use clap::Args;
use files::{AtomicFile, Failure, GreyImage, PixelConversion, SkyHeader, read_grey_image, read_sky_header};
use hifitime::{Epoch, Unit};
use serde_json::json;

use super::camera_file::camera_toml;
use super::fit_text::{document, fit_text, warnings};
use super::images::{has_extension, images};
use super::mosaic::{Mosaic, camera_of_pixels};
use crate::command::Answer;
use crate::command::options::{exposure, number, output_path, time};
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct FitArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    pub(super) directory: PathBuf,
    /// Width of the field along the columns, degrees, 0.5 to 120 [default: by the world coordinates (TAN) of
    /// the FITS images]
    #[arg(long, value_name = "DEG", value_parser = field)]
    pub(super) field_deg: Option<f64>,
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
    /// directions by half an arc second [default: by the headers (DATE-AVG or DATE-OBS) of the FITS images,
    /// otherwise 2026-01-01T00:00:00Z]
    #[arg(long, value_name = "UTC", value_parser = time)]
    pub(super) time: Option<Epoch>,
    /// Pattern of a raw mosaic: the colours of its first two rows. The camera is fitted to the mean of the
    /// two green pixels of each square of two by two, and is that of the pixels of the mosaic
    #[arg(long, value_name = "PATTERN", ignore_case = true)]
    pub(super) bayer: Option<Mosaic>,
    /// Exposure time of the frames, s, 1e-6 to 1000: for the brightness of stars per second
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = exposure)]
    pub(super) exposure: f64,
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
    let progress = output.progress_of(paths.len() as u64, "images", "reading");
    let mut frames = Vec::with_capacity(paths.len());
    let mut size = [0; 2];
    for path in &paths {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let image = read_grey_image(path)?;
        let image = match arguments.bayer {
            Some(mosaic) => {
                size = [image.columns, image.rows];
                mosaic_of(path, mosaic, &image)?
            }
            None => image,
        };
        frames.push(SkyFrame { name, image });
        progress.inc(1);
    }
    progress.finish_and_clear();
    let stated = Stated::new(arguments, &paths, output)?;
    // The squares of a mosaic are fitted as pixels.
    let scale = if arguments.bayer.is_some() { 2.0 } else { 1.0 };
    let pixel_um = [arguments.pixel_um, arguments.pixel_height_um.unwrap_or(arguments.pixel_um)];
    let guess = FirstGuess {
        field_deg: stated.field_deg,
        tolerance: arguments.tolerance,
        pixel_um: pixel_um.map(|side_um| scale * side_um),
        time: stated.time,
    };
    let mut fit = match fit_camera(&frames, &guess) {
        Ok(fit) => fit,
        Err(error @ (FitError::NoAttitude(_) | FitError::Reading { .. } | FitError::TooFewStars(_))) => {
            let text = format!("{}: {error}", arguments.directory.display());
            output.answer(&json!({ "ok": false, "error": text }), text)?;
            return Ok(Answer::No);
        }
        Err(error) => return Err(Failure::Usage(format!("{}: {error}", arguments.directory.display()))),
    };
    if arguments.bayer.is_some() {
        let [columns, rows] = size;
        camera_of_pixels(&mut fit, columns, rows);
    }
    if paths.iter().any(|path| has_extension(path, &["jpg", "jpeg"])) {
        output.note("warning: JPEG changes faint stars and widths; raw images give a better camera");
    }
    for warning in warnings(&fit, stated.time) {
        output.note(&format!("warning: {warning}"));
    }
    if let Some(out) = &arguments.out {
        AtomicFile::with_text(out, &camera_toml(&fit, arguments, stated.time))?.commit_new()?;
    }
    let mut text = fit_text(&fit);
    if let Some(out) = &arguments.out {
        text.push_str(&format!("\ncamera in {}", out.display()));
    }
    output.answer(&document(&fit, stated.time), text)?;
    Ok(Answer::Yes)
}

/// Returns the green pixels of a mosaic.
///
/// # Errors
/// [`Failure::Usage`] for an image in colour, or without a square of two by two pixels.
fn mosaic_of(path: &Path, mosaic: Mosaic, image: &GreyImage) -> Result<GreyImage, Failure> {
    if image.conversion != PixelConversion::None || image.columns < 2 || image.rows < 2 {
        return Err(Failure::Usage(format!(
            "{}: --bayer is {mosaic:?}, and the image is {} × {} in colour or too small; expected a grey raw mosaic",
            path.display(),
            image.columns,
            image.rows
        )));
    }
    Ok(mosaic.green(image))
}

/// Field and time by the arguments, or else by the headers of the images.
struct Stated {
    field_deg: f64,
    time: Epoch,
}

/// Largest difference of the times of frames that have one time, days: directions change by half an arc
/// second per day.
const MAX_SPAN_DAYS: f64 = 2.0;

impl Stated {
    fn new(arguments: &FitArguments, paths: &[PathBuf], output: &Output) -> Result<Self, Failure> {
        let mut headers = Vec::new();
        if arguments.field_deg.is_none() || arguments.time.is_none() {
            for path in paths.iter().filter(|path| has_extension(path, &["fits", "fit", "fts"])) {
                headers.push(read_sky_header(path)?);
            }
        }
        let field_deg = match arguments.field_deg {
            Some(field_deg) => field_deg,
            None => {
                let of_header = headers.iter().find_map(|header| header.field_deg);
                of_header.filter(|field_deg| (0.5..=120.0).contains(field_deg)).ok_or_else(|| {
                    Failure::Usage(format!(
                        "{}: no image has world coordinates (FITS, TAN) of a field of 0.5 to 120 degrees; expected \
                         --field-deg",
                        arguments.directory.display()
                    ))
                })?
            }
        };
        let time = match arguments.time {
            Some(time) => time,
            None => time_of_headers(&headers, output),
        };
        Ok(Self { field_deg, time })
    }
}

/// Returns the middle between the first and the last time of the headers, or the default without one.
fn time_of_headers(headers: &[SkyHeader], output: &Output) -> Epoch {
    let mut times: Vec<Epoch> = headers.iter().filter_map(|header| header.time).collect();
    times.sort();
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Epoch::from_gregorian_utc_at_midnight(2026, 1, 1);
    };
    let span = *last - *first;
    if span.to_unit(Unit::Day) > MAX_SPAN_DAYS {
        output.note(&format!(
            "warning: the frames span {:.0} days, and one time is used for all: star places change by half an arc \
             second per day",
            span.to_unit(Unit::Day)
        ));
    }
    *first + span * 0.5
}
