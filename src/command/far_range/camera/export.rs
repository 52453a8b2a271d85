//! `boresight camera export`: a camera as a calibration of OpenCV, ROS or Kalibr.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use far_range::CameraSource;
use files::{AtomicFile, CalibrationFormat, Conversion, Failure, LensCalibration, calibration_text};
use serde_json::json;

use super::import::{check_displacement, displacement};
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct CameraExportArguments {
    /// A built-in camera (`boresight scenario camera` lists them), or a TOML file with the tables [camera],
    /// [sensor], [psf] and [radiometry]
    #[arg(value_name = "CAMERA")]
    camera: String,
    /// Format of the calibration
    #[arg(long, value_name = "FORMAT", value_enum)]
    format: ExportFormat,
    /// Largest displacement of a pixel by the conversion of the distortion, px, 0 to 100: not 0 where pixels
    /// are not square
    #[arg(long, value_name = "PX", default_value_t = 0.1, value_parser = displacement)]
    max_displacement_px: f64,
    /// File to write; an existing file is not replaced. FILE.yaml or FILE.yml, of OpenCV also FILE.json
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: PathBuf,
}

/// Format of an exported calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    /// FileStorage of OpenCV, with the keys of its calibration sample
    Opencv,
    /// A camchain with the camera cam0
    Kalibr,
    /// A camera_info file
    Ros,
}

pub(super) fn export(arguments: &CameraExportArguments, output: &Output) -> Result<Answer, Failure> {
    super::refuse_existing(&arguments.out)?;
    let format = calibration_format(arguments.format, &arguments.out)?;
    let source = CameraSource::read(&arguments.camera)?;
    let camera = &source.preset.camera;
    let Conversion { value: lens, displacement_px } = LensCalibration::from_camera(camera)
        .map_err(|error| source.explain(sim::SimError::OutOfRange(error)))?;
    if displacement_px > 0.0 {
        let words = format!(
            "pixels are {} × {} µm, while the distortion is round in pixels here and in angles there: the two \
             differ by at most {displacement_px:.2e} px in the image",
            camera.pixel_width_um, camera.pixel_height_um
        );
        check_displacement(
            Path::new(&arguments.camera),
            &words,
            displacement_px,
            arguments.max_displacement_px,
        )?;
        output.note(format!("warning: {words}"));
    }
    let text = calibration_text(Path::new(&arguments.camera), &lens, format)?;
    AtomicFile::with_text(&arguments.out, &text)?.commit_new()?;
    let document = json!({
        "ok": true, "file": arguments.out, "displacement_px": displacement_px, "focal_px": lens.focal_px,
        "principal_px": lens.principal_px, "radial": lens.radial, "tangential": lens.tangential,
    });
    output.answer(&document, format!("calibration in {}", arguments.out.display()))?;
    Ok(Answer::Yes)
}

/// Returns the format of a file, from the option and the extension.
fn calibration_format(format: ExportFormat, out: &Path) -> Result<CalibrationFormat, Failure> {
    let extension = out.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    match (format, extension.as_deref()) {
        (ExportFormat::Opencv, Some("json")) => Ok(CalibrationFormat::OpenCvJson),
        (ExportFormat::Opencv, Some("yaml" | "yml")) => Ok(CalibrationFormat::OpenCvYaml),
        (ExportFormat::Kalibr, Some("yaml" | "yml")) => Ok(CalibrationFormat::Kalibr),
        (ExportFormat::Ros, Some("yaml" | "yml")) => Ok(CalibrationFormat::Ros),
        (_, _) => {
            let json = if format == ExportFormat::Opencv { ", or .json" } else { "" };
            Err(Failure::Usage(format!(
                "--out is {}, expected a file name that ends in .yaml or .yml{json}",
                out.display()
            )))
        }
    }
}
