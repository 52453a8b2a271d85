//! `boresight camera`: a camera from its frames.

mod camera_file;
mod fit;
mod fit_text;
mod images;
mod mosaic;

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
}

pub(in crate::command) fn camera(command: &CameraCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        CameraCommand::Fit(arguments) => fit::fit(arguments, output),
    }
}
