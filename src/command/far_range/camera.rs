//! `boresight camera fit`: a camera from frames of the night sky.

use std::path::{Path, PathBuf};

use camera_fit::adjustment::Term;
use camera_fit::{CameraFit, FirstGuess, FitError, FittedFrame, SkyFrame, fit_camera};
use clap::{Args, Subcommand};
use contract::{Angle, Direction, PixelPoint};
use files::{AtomicFile, Failure, FileError, format_utc, read_grey_image};
use hifitime::Epoch;
use pipeline::CameraModel;
use serde_json::{Value, json};

use super::sky::{exposure, number, time};
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;

/// Extensions of image files.
const EXTENSIONS: [&str; 9] = ["fits", "fit", "fts", "png", "tif", "tiff", "exr", "jpg", "jpeg"];

/// Largest number of frames of a fit: the normal equations grow with the square.
const MAX_FRAMES: usize = 200;

/// Number of frames that are printed; the JSON lists all.
const PRINTED_FRAMES: usize = 20;

#[derive(Debug, Subcommand)]
pub(in crate::command) enum CameraCommand {
    /// Fit focal length, principal point and distortion to frames of the night sky
    ///
    /// Needs the field to about ten percent and no attitude. Images are grey or colour PNG, TIFF, JPEG
    /// (colour: the mean of the three), grey FITS or OpenEXR, not mirrored.
    Fit(FitArguments),
}

#[derive(Debug, Args)]
pub(in crate::command) struct FitArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    directory: PathBuf,
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
    time: Epoch,
    /// Exposure time of the frames, s, 1e-6 to 1000: for the brightness of stars per second
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = exposure)]
    exposure: f64,
    /// A new file for the camera, TOML: for `boresight sky --camera FILE`, or to be pasted into a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: Option<PathBuf>,
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

pub(in crate::command) fn camera(command: &CameraCommand, output: &Output) -> Result<Answer, Failure> {
    let CameraCommand::Fit(arguments) = command;
    let paths = images(&arguments.directory)?;
    if let Some(out) = arguments.out.as_deref().filter(|out| out.exists()) {
        return Err(Failure::Usage(format!("--out is {}, which exists; expected a new file", out.display())));
    }
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
        AtomicFile::with_text(out, &camera_toml(&fit, arguments))?.commit_new()?;
    }
    let mut text = fit_text(&fit);
    if let Some(out) = &arguments.out {
        text.push_str(&format!("\ncamera in {}", out.display()));
    }
    output.answer(&document(&fit), text)?;
    Ok(Answer::Yes)
}

/// Returns the image files of a directory, in order of their names.
fn images(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(directory).map_err(|source| FileError::Io {
        path: directory.to_owned(),
        doing: "open",
        source,
    })?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| FileError::io(directory, "read", source))?;
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !is_hidden && has_extension(&entry.path(), &EXTENSIONS) && entry.path().is_file() {
            paths.push(entry.path());
        }
    }
    paths.sort();
    if paths.is_empty() || paths.len() > MAX_FRAMES {
        return Err(Failure::Usage(format!(
            "{}: {} images in it ({}), expected 1 to {MAX_FRAMES}",
            directory.display(),
            paths.len(),
            EXTENSIONS.join(", ")
        )));
    }
    Ok(paths)
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    extension.is_some_and(|extension| extensions.contains(&extension.as_str()))
}

/// Name of a term's parameter, with its unit.
fn parameter_name(term: Term) -> &'static str {
    match term {
        Term::FocalLength => "focal length, mm",
        Term::PrincipalX => "principal point x, px",
        Term::PrincipalY => "principal point y, px",
        Term::Radial1 => "k1, px^-2",
        Term::Radial2 => "k2, px^-4",
        Term::Radial3 => "k3, px^-6",
        Term::Tangential1 => "p1, px^-1",
        Term::Tangential2 => "p2, px^-1",
    }
}

/// Returns a value with its standard deviation, to two digits of the latter.
fn with_sigma(value: f64, sigma: f64) -> String {
    if value.abs() < 1e-2 {
        return format!("{value:.3e} ± {sigma:.1e}");
    }
    let digits = (1 - libm::log10(sigma).floor() as i32).clamp(0, 9) as usize;
    format!("{value:.digits$} ± {sigma:.digits$}")
}

/// Returns the fit as text for a terminal.
fn fit_text(fit: &CameraFit) -> String {
    let all = fit.frames.len() + fit.unsolved.len();
    let mut text = format!(
        "{} of {all} frames have an attitude, with {} stars; rms {:.3} px along an axis",
        fit.frames.len(),
        fit.stars,
        fit.rms_px
    );
    if fit.left_out_rms_px.is_finite() {
        text.push_str(&format!(", {:.3} px of stars left out", fit.left_out_rms_px));
    }
    let (focal_px, _) = fit.camera.focal_length_px();
    for (term, sigma, is_determined) in &fit.sigmas {
        let value = with_sigma(term.parameter(&fit.camera), *sigma);
        text.push_str(&format!("\n  {:<22} {value}", parameter_name(*term)));
        if *term == Term::FocalLength {
            text.push_str(&format!(" ({focal_px:.2} px)"));
        }
        if !is_determined {
            text.push_str("  not determined by these frames");
        }
    }
    if fit.sigmas.iter().any(|(_, _, is_determined)| !is_determined) {
        text.push_str(
            "\n  Frames at other roll angles separate the principal point from the pointing; stars near the corners \
             determine the distortion.",
        );
    }
    text.push_str(&sensor_text(fit));
    for frame in fit.frames.iter().take(PRINTED_FRAMES) {
        let (ra_deg, dec_deg, roll_deg) = pointing(fit, frame);
        text.push_str(&format!(
            "\n  {:<20} RA {ra_deg:9.4}°  Dec {dec_deg:+9.4}°  roll {roll_deg:9.3}°  {} stars, {:.3} px",
            frame.name, frame.stars, frame.rms_px
        ));
    }
    for frame in fit.unsolved.iter().take(PRINTED_FRAMES) {
        text.push_str(&format!("\n  {:<20} no attitude: {}", frame.name, frame.reason));
    }
    text
}

/// Returns the figures of the sensor and the optics as text.
fn sensor_text(fit: &CameraFit) -> String {
    let mut text =
        format!("\n  background {:.2} DN, noise {:.2} DN per pixel", fit.background_dn, fit.noise_dn);
    if let Some(width_px) = fit.width_px {
        text.push_str(&format!("; stars have σ = {width_px:.2} px"));
    }
    if let Some(hot_pixels) = fit.hot_pixels {
        text.push_str(&format!("; {hot_pixels} hot pixels"));
    }
    if let Some(light) = &fit.photometry {
        let [zero_point, zero_point_sigma] = light.zero_point;
        let [colour, colour_sigma] = light.colour_term;
        text.push_str(&format!(
            "\n  zero point V = {zero_point:.2} ± {zero_point_sigma:.2} for 1 DN, colour term {colour:+.2} ± \
             {colour_sigma:.2} per mag of B−V, scatter {:.2} mag",
            light.scatter_mag
        ));
        if let Some(limit) = light.limiting_v {
            text.push_str(&format!("; half of the stars of V = {limit:.1} are seen"));
        }
    }
    if fit.is_colour {
        text.push_str("\n  colour images: the mean of the three colours as stored");
    }
    text
}

/// Returns right ascension and declination of the centre of the image, apparent, and the clockwise angle in
/// the image from up to north there, degrees.
fn pointing(fit: &CameraFit, frame: &FittedFrame) -> (f64, f64, f64) {
    let camera = &fit.camera;
    let centre = PixelPoint::new(0.5 * camera.columns as f64 - 0.5, 0.5 * camera.rows as f64 - 0.5);
    let ahead = CameraModel::new(camera).ok().and_then(|model| model.back_project(centre));
    let ahead = ahead.unwrap_or_else(Direction::z);
    let sky = frame.camera_from_icrs.inverse().rotate(ahead.vector());
    let dec = libm::asin(sky.z.clamp(-1.0, 1.0));
    let ra = libm::atan2(sky.y, sky.x);
    // The direction of north in camera axes: x along columns, y along rows, which count downwards.
    let north = Direction::from_ra_dec(
        Angle::from_radians(ra),
        Angle::from_radians(dec + std::f64::consts::FRAC_PI_2),
    );
    let north = frame.camera_from_icrs.rotate(north.vector());
    let roll = libm::atan2(north.x, -north.y);
    (ra.to_degrees().rem_euclid(360.0), dec.to_degrees(), roll.to_degrees())
}

/// Returns the fit as JSON.
fn document(fit: &CameraFit) -> Value {
    let parameters: Vec<Value> = fit
        .sigmas
        .iter()
        .map(|(term, sigma, is_determined)| {
            let value = term.parameter(&fit.camera);
            json!({ "name": parameter_name(*term), "value": value, "sigma": sigma, "determined": is_determined })
        })
        .collect();
    let frames: Vec<Value> = fit
        .frames
        .iter()
        .map(|frame| {
            let (ra_deg, dec_deg, roll_deg) = pointing(fit, frame);
            json!({
                "name": frame.name, "q_cam_j2000": frame.camera_from_icrs.wxyz(), "ra_deg": ra_deg,
                "dec_deg": dec_deg, "roll_deg": roll_deg, "stars": frame.stars, "rms_px": frame.rms_px,
            })
        })
        .collect();
    let unsolved: Vec<Value> = fit
        .unsolved
        .iter()
        .map(|frame| json!({ "name": frame.name, "sources": frame.sources, "reason": frame.reason }))
        .collect();
    let photometry = fit.photometry.map(|light| {
        json!({
            "zero_point_v": light.zero_point[0], "zero_point_sigma": light.zero_point[1],
            "colour_term": light.colour_term[0], "colour_term_sigma": light.colour_term[1],
            "scatter_mag": light.scatter_mag, "stars": light.stars, "limiting_v": light.limiting_v,
        })
    });
    json!({
        "ok": true, "camera": fit.camera, "parameters": parameters, "stars": fit.stars, "rms_px": fit.rms_px,
        "left_out_rms_px": fit.left_out_rms_px.is_finite().then_some(fit.left_out_rms_px),
        "background_dn": fit.background_dn, "noise_dn": fit.noise_dn, "star_sigma_px": fit.width_px,
        "hot_pixels": fit.hot_pixels, "photometry": photometry, "frames": frames, "unsolved": unsolved,
    })
}

/// Returns the camera file: tables of a camera, with the origin of each value in a comment.
fn camera_toml(fit: &CameraFit, arguments: &FitArguments) -> String {
    let camera = &fit.camera;
    let sigma_of = |term: Term| {
        let found = fit.sigmas.iter().find(|(of, _, _)| *of == term);
        match found {
            Some((_, sigma, true)) => format!("± {sigma:.2e}"),
            _ => "not determined by the frames".to_owned(),
        }
    };
    let bits = if fit.full_scale > 255.0 { 16 } else { 8 };
    let width_px = fit.width_px.unwrap_or(0.8);
    let zero_point =
        fit.photometry.map_or(1e6, |light| libm::pow(10.0, 0.4 * light.zero_point[0])) / arguments.exposure;
    let [k1, k2, k3] = camera.radial;
    let [p1, p2] = camera.tangential;
    format!(
        "# Camera fitted to {} frames with {} stars of {}, rms {:.3} px along an axis.\n\
         # Epoch of the star places: {}. Values without ± are assumed, or taken as the comment says.\n\
         [camera]\n\
         columns = {}\nrows = {}\n\
         focal_length_mm = {:?} # {}\n\
         pixel_width_um = {:?} # as stated: only its ratio to the focal length is measured\n\
         pixel_height_um = {:?}\n\
         principal_x_px = {:?} # {}\n\
         principal_y_px = {:?} # {}\n\
         radial = [{k1:e}, {k2:e}, {k3:e}] # k1 {}; k2 {}; k3 {}\n\
         tangential = [{p1:e}, {p2:e}] # p1 {}; p2 {}\n\n\
         [sensor]\n\
         bit_depth = {bits} # of the files\n\
         gain_e_per_dn = 1.0 # not determined: needs flat fields; \"electrons\" below are DN\n\
         bias_dn = {:.3} # the background of the frames, with the light of the sky\n\
         full_well_e = {:?} # full scale of the files\n\
         read_noise_e = {:.3} # the noise of the frames, with that of the sky\n\
         dark_current_e_per_s = 0.0 # not determined: needs dark frames\n\
         background_e_per_s = 0.0 # in the bias\n\n\
         [psf]\n\
         kind = \"gaussian\"\n\
         sigma_px = {width_px:.3} # {}\n\n\
         [radiometry]\n\
         kind = \"zero_point\"\n\
         zero_point_e_per_s = {zero_point:.4e} # {}\n",
        fit.frames.len(),
        fit.stars,
        arguments.directory.display(),
        fit.rms_px,
        format_utc(arguments.time),
        camera.columns,
        camera.rows,
        camera.focal_length_mm,
        sigma_of(Term::FocalLength),
        camera.pixel_width_um,
        camera.pixel_height_um,
        camera.principal_x_px,
        sigma_of(Term::PrincipalX),
        camera.principal_y_px,
        sigma_of(Term::PrincipalY),
        sigma_of(Term::Radial1),
        sigma_of(Term::Radial2),
        sigma_of(Term::Radial3),
        sigma_of(Term::Tangential1),
        sigma_of(Term::Tangential2),
        fit.background_dn.max(0.0),
        fit.full_scale,
        fit.noise_dn,
        if fit.width_px.is_some() { "median of the stars" } else { "assumed" },
        match &fit.photometry {
            Some(light) => format!("V = {:.2} for 1 DN in {} s", light.zero_point[0], arguments.exposure),
            None => "assumed: too few stars".to_owned(),
        },
    )
}
