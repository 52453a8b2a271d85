//! `boresight camera`: a camera from its frames.

mod camera_file;
mod fit;
mod fit_text;
mod images;
mod sensor;
mod sensor_file;
mod sensor_text;
mod stack_folders;

use clap::Subcommand;
use files::Failure;

use crate::command::Answer;
use crate::command::output::Output;

#[derive(Debug, Subcommand)]
pub(in crate::command) enum CameraCommand {
    /// Fit focal length, principal point and distortion to frames of the night sky
    ///
    /// Needs the field to about ten percent and no attitude. Images are grey or colour PNG, TIFF, JPEG
    /// (colour: the mean of the three), grey FITS or OpenEXR, not mirrored.
    Fit(fit::FitArguments),
    /// Determine gain, noise, dark current and more of a sensor from bias, dark and flat frames
    ///
    /// Images are grey FITS, PNG, TIFF or OpenEXR with the numbers of the converter. Of each kind, two frames
    /// or more: bias frames in one folder; dark and flat frames in a folder per exposure time, named by it
    /// (`0.5s`), or FITS with EXPTIME or EXPOSURE. Figures follow EMVA Standard 1288.
    Sensor(sensor::SensorArguments),
}

pub(in crate::command) fn camera(command: &CameraCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        CameraCommand::Fit(arguments) => fit::fit(arguments, output),
        CameraCommand::Sensor(arguments) => sensor::sensor(arguments, output),
    }
}
