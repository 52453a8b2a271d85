//! What is known of a camera before its frames are read: by arguments, or by the headers of its images.

use std::path::{Path, PathBuf};

use camera_fit::FirstGuess;
use clap::Args;
use contract::Camera;
use files::{Failure, SkyHeader, read_sky_header};
use hifitime::{Epoch, Unit};

use super::images::has_extension;
use super::sensor_file::SensorSource;
use crate::command::options::{exposure, number, time};
use crate::command::output::Output;

/// Largest difference of the times of frames that have one time, days: directions change by half an arc
/// second per day.
const MAX_SPAN_DAYS: f64 = 2.0;

/// Largest relative error of the field of a camera whose focal length is known.
const KNOWN_TOLERANCE: f64 = 0.005;

/// First guess and exposure time of the frames.
pub(super) struct Known {
    /// First guess of the camera.
    pub(super) guess: FirstGuess,
    /// Exposure time, s.
    pub(super) exposure_s: f64,
}

/// What is known of the camera beforehand.
#[derive(Debug, Args)]
pub(in crate::command) struct GuessArguments {
    /// Width of the field along the columns, degrees, 0.5 to 120 [default: by the world coordinates (TAN) of
    /// the FITS images]
    #[arg(long, value_name = "DEG", value_parser = field)]
    field_deg: Option<f64>,
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
    /// directions by half an arc second [default: by the headers (DATE-AVG or DATE-OBS) of the FITS images,
    /// otherwise 2026-01-01T00:00:00Z]
    #[arg(long, value_name = "UTC", value_parser = time)]
    time: Option<Epoch>,
    /// Exposure time of the frames, s, 1e-6 to 1000: for the brightness of stars per second [default: EXPTIME
    /// of the FITS images, otherwise 1]
    #[arg(long, value_name = "S", value_parser = exposure)]
    exposure: Option<f64>,
    /// Sensor file of `boresight camera sensor`: its gain, bias, noise and dark current are those of the
    /// camera
    #[arg(long, value_name = "FILE")]
    sensor: Option<PathBuf>,
}

impl GuessArguments {
    /// Returns the first guess: the arguments, and where they are absent the headers of the FITS images.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a field that neither states; a [`Failure`] for a header that cannot be read.
    pub(super) fn first_guess(
        &self,
        directory: &Path,
        paths: &[PathBuf],
        output: &Output,
    ) -> Result<Known, Failure> {
        let mut headers = Vec::new();
        if self.field_deg.is_none() || self.time.is_none() || self.exposure.is_none() {
            for path in paths.iter().filter(|path| has_extension(path, &["fits", "fit", "fts"])) {
                headers.push(read_sky_header(path)?);
            }
        }
        let field_deg = match self.field_deg {
            Some(field_deg) => field_deg,
            None => field_of_headers(&headers, directory)?,
        };
        let guess = FirstGuess {
            field_deg,
            tolerance: self.tolerance,
            pixel_um: [self.pixel_um, self.pixel_height_um.unwrap_or(self.pixel_um)],
            time: self.time.unwrap_or_else(|| time_of_headers(&headers, output)),
        };
        let exposure_s = self.exposure.unwrap_or_else(|| exposure_of_headers(&headers, output));
        Ok(Known { guess, exposure_s })
    }

    /// Reads the sensor file; `None` without the option.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake in it.
    pub(super) fn sensor(&self) -> Result<Option<SensorSource>, Failure> {
        self.sensor.as_deref().map(SensorSource::read).transpose()
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

/// Returns the field of the first header that states one.
fn field_of_headers(headers: &[SkyHeader], directory: &Path) -> Result<f64, Failure> {
    let of_header = headers.iter().find_map(|header| header.field_deg);
    of_header.filter(|field_deg| (0.5..=120.0).contains(field_deg)).ok_or_else(|| {
        Failure::Usage(format!(
            "{}: no image has world coordinates (FITS, TAN) of a field of 0.5 to 120 degrees; expected --field-deg",
            directory.display()
        ))
    })
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
        output.note(format!(
            "warning: the frames span {:.0} days, and one time is used for all: star places change by half an arc \
             second per day",
            span.to_unit(Unit::Day)
        ));
    }
    *first + span * 0.5
}

/// Returns the exposure time of the first header that states one, s, with a warning where they differ; 1
/// without one.
fn exposure_of_headers(headers: &[SkyHeader], output: &Output) -> f64 {
    let mut times_s = headers.iter().filter_map(|header| header.exposure_s).filter(|time_s| *time_s > 0.0);
    let Some(first_s) = times_s.next() else { return 1.0 };
    if times_s.any(|time_s| (time_s / first_s - 1.0).abs() > 1e-3) {
        output.note("warning: the frames have different exposure times; that of the first is used for all");
    }
    first_s
}

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
