//! `boresight camera`: cameras from frames of the sky, and calibrations of other tools.

mod compare;
mod export;
mod fit;
mod fit_text;
mod guess;
mod images;
mod import;
mod mosaic;
#[cfg(feature = "report")]
mod pages;
#[cfg(not(feature = "report"))]
#[path = "no_pages.rs"]
mod pages;
mod sensor;
mod sensor_file;
mod sensor_text;
mod stack_folders;
mod twin;

use std::path::Path;

pub(in crate::command) use compare::{CompareArguments, compare};
pub(in crate::command) use twin::{TwinArguments, twin};

use clap::Subcommand;
use files::Failure;

use crate::command::Answer;
use crate::command::output::Output;

#[derive(Debug, Subcommand)]
pub(in crate::command) enum CameraCommand {
    /// Fit focal length, principal point and distortion to frames of the night sky
    ///
    /// Needs the field to about ten percent and no attitude. Images are grey or colour PNG, TIFF, JPEG
    /// (colour: the mean of the three), grey FITS or OpenEXR, not mirrored; raw mosaics with --bayer.
    Fit(fit::FitArguments),
    /// Read a calibration of OpenCV, ROS or Kalibr, and write a camera file
    ///
    /// Reads YAML and JSON of OpenCV's FileStorage, camera_info of ROS and camchain.yaml of Kalibr: pinhole
    /// cameras with the distortion k1, k2, p1, p2, k3. Detector and optics of the camera file are assumed.
    Import(import::ImportArguments),
    /// Write a camera as a calibration for OpenCV, ROS or Kalibr
    Export(export::CameraExportArguments),
    /// Determine gain, noise, dark current and more of a sensor from bias, dark and flat frames
    ///
    /// Images are grey FITS, PNG, TIFF or OpenEXR with the numbers of the converter. Of each kind, two frames
    /// or more: bias frames in one folder; dark and flat frames in a folder per exposure time, named by it
    /// (`0.5s`), or FITS with EXPTIME or EXPOSURE. Figures follow EMVA Standard 1288.
    Sensor(sensor::SensorArguments),
}

/// Refuses an output file that exists, before the work begins.
fn refuse_existing(out: &Path) -> Result<(), Failure> {
    if out.symlink_metadata().is_err() {
        return Ok(());
    }
    Err(Failure::Usage(format!("--out is {}, which exists; expected a new file", out.display())))
}

pub(in crate::command) fn camera(command: &CameraCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        CameraCommand::Fit(arguments) => fit::fit(arguments, output),
        CameraCommand::Import(arguments) => import::import(arguments, output),
        CameraCommand::Export(arguments) => export::export(arguments, output),
        CameraCommand::Sensor(arguments) => sensor::sensor(arguments, output),
    }
}
