//! `boresight camera import`: a camera from a calibration of OpenCV, ROS or Kalibr.

use std::path::{Path, PathBuf};

use clap::Args;
use contract::{Camera, PixelPoint};
use files::{AtomicFile, Conversion, Failure, LensCalibration, read_calibration};
use pipeline::CameraModel;
use serde_json::json;

use super::guess::pixel;
use crate::command::Answer;
use crate::command::options::{number, output_path};
use crate::command::output::Output;

#[derive(Debug, Args)]
pub(in crate::command) struct ImportArguments {
    /// Calibration: OpenCV (YAML or JSON of its FileStorage), ROS camera_info (YAML), or Kalibr camchain.yaml
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Camera of a file with several: cam0 (Kalibr), 1 (M1 and D1 of OpenCV's stereo sample), left (K_left)
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Width of a pixel, µm, 0.01 to 1e4: sets the unit of the focal length, which in pixels does not depend
    /// on it
    #[arg(long, value_name = "UM", default_value_t = 5.0, value_parser = pixel)]
    pixel_um: f64,
    /// Columns of the images, where the file does not state them
    #[arg(long, value_name = "N", requires = "rows", value_parser = side())]
    columns: Option<u64>,
    /// Rows of the images, where the file does not state them
    #[arg(long, value_name = "N", requires = "columns", value_parser = side())]
    rows: Option<u64>,
    /// Largest displacement of a pixel by the conversion of the distortion, px, 0 to 100: not 0 where the
    /// focal lengths along columns and rows differ
    #[arg(long, value_name = "PX", default_value_t = 0.1, value_parser = displacement)]
    max_displacement_px: f64,
    /// A new file for the camera, TOML: for `boresight sky --camera FILE`, or to be pasted into a scenario
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: PathBuf,
}

/// Parser of the number of columns or rows.
fn side() -> clap::builder::RangedU64ValueParser {
    clap::value_parser!(u64).range(1..=Camera::MAX_SIDE_PX as u64)
}

/// Parses the largest displacement of a conversion, px.
pub(super) fn displacement(text: &str) -> Result<f64, String> {
    number(text, 0.0, 100.0)
}

pub(super) fn import(arguments: &ImportArguments, output: &Output) -> Result<Answer, Failure> {
    super::refuse_existing(&arguments.out)?;
    let file = &arguments.file;
    let lens = read_calibration(file, arguments.name.as_deref())?;
    let size_px = size_px(&lens, arguments)?;
    let Conversion { value: camera, displacement_px } = lens
        .to_camera(size_px, arguments.pixel_um)
        .map_err(|error| Failure::Usage(format!("{}: {error}", file.display())))?;
    let mut warnings = Vec::new();
    if displacement_px > 0.0 {
        let words = focal_lengths_differ(&lens, displacement_px);
        check_displacement(file, &words, displacement_px, arguments.max_displacement_px)?;
        warnings.push(words);
    }
    warnings.extend(pixels_without_direction(&camera));
    for warning in &warnings {
        output.note(format!("warning: {warning}"));
    }
    let text = camera_toml(&camera, file, &warnings);
    AtomicFile::with_text(&arguments.out, &text)?.commit_new()?;
    let document = json!({
        "ok": true, "camera": camera, "displacement_px": displacement_px, "warnings": warnings,
        "file": arguments.out,
    });
    output.answer(&document, summary(&camera, &arguments.out))?;
    Ok(Answer::Yes)
}

/// Returns the number of columns and rows: those of the file, or of the options.
fn size_px(lens: &LensCalibration, arguments: &ImportArguments) -> Result<[usize; 2], Failure> {
    let shown = arguments.file.display();
    let given = match (arguments.columns, arguments.rows) {
        (Some(columns), Some(rows)) => Some([columns as usize, rows as usize]),
        _ => None,
    };
    match (lens.size_px, given) {
        (Some(stated), Some(given)) if stated != given => Err(Failure::Usage(format!(
            "--columns and --rows are {} and {}, but {shown} states images of {} × {} px, to which its numbers \
             belong; expected its size, or neither option",
            given[0], given[1], stated[0], stated[1]
        ))),
        (Some(size), _) | (None, Some(size)) => Ok(size),
        (None, None) => Err(Failure::Usage(format!(
            "{shown} does not state the size of its images, expected --columns N --rows N"
        ))),
    }
}

/// Returns the warning for a calibration with different focal lengths along columns and rows.
fn focal_lengths_differ(lens: &LensCalibration, displacement_px: f64) -> String {
    let [fx, fy] = lens.focal_px;
    format!(
        "fx is {fx:.3} and fy {fy:.3} px, while the distortion is round in pixels here and in angles there: the \
         two differ by at most {displacement_px:.2e} px in the image"
    )
}

/// Refuses a conversion of the distortion that is too coarse.
pub(super) fn check_displacement(
    file: &Path,
    words: &str,
    displacement_px: f64,
    max_px: f64,
) -> Result<(), Failure> {
    if displacement_px <= max_px {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{}: {words}, expected at most {max_px} px; --max-displacement-px PX accepts more",
        file.display()
    )))
}

/// Returns the warning for a camera whose distortion has no inverse at a corner or the middle of an edge.
fn pixels_without_direction(camera: &Camera) -> Option<String> {
    let model = CameraModel::new(camera).ok()?;
    let (right, bottom) = (camera.columns as f64 - 1.0, camera.rows as f64 - 1.0);
    let border = [0.0, 0.5, 1.0].iter().flat_map(|x| [0.0, 0.5, 1.0].map(|y| (x * right, y * bottom)));
    let missing: Vec<String> = border
        .filter(|(x, y)| model.back_project(PixelPoint::new(*x, *y)).is_none())
        .map(|(x, y)| format!("({x:.0}, {y:.0})"))
        .collect();
    (!missing.is_empty()).then(|| {
        format!(
            "the distortion folds the image: pixels as {} have no direction; a calibration needs points in the \
             corners of the images",
            missing.join(", ")
        )
    })
}

/// Returns the summary for a terminal.
fn summary(camera: &Camera, out: &Path) -> String {
    let (fx, fy) = camera.focal_length_px();
    let degrees = |side: usize, focal_px: f64| 2.0 * libm::atan(0.5 * side as f64 / focal_px).to_degrees();
    format!(
        "{} × {} px, focal length {fx:.3} and {fy:.3} px, field about {:.2}° × {:.2}°, principal point ({:.3}, \
         {:.3}) px\ncamera in {}",
        camera.columns,
        camera.rows,
        degrees(camera.columns, fx),
        degrees(camera.rows, fy),
        camera.principal_x_px,
        camera.principal_y_px,
        out.display(),
    )
}

/// Returns the camera file: the calibrated geometry, and assumed tables of detector and optics.
fn camera_toml(camera: &Camera, file: &Path, warnings: &[String]) -> String {
    let [k1, k2, k3] = camera.radial;
    let [p1, p2] = camera.tangential;
    let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let name: String = name.chars().filter(|letter| !letter.is_control()).collect();
    let warnings: String = warnings.iter().map(|warning| format!("# Warning: {warning}.\n")).collect();
    format!(
        "# Camera of the calibration {name}. The geometry is that of the calibration, in pixels; the other \
         tables are assumed.\n{warnings}\
         # A docking setup.toml has these keys below [[cameras]], a scenario below [cameras.camera].\n\
         [camera]\n\
         columns = {}\nrows = {}\n\
         focal_length_mm = {:?} # of the stated pixel width: only their ratio is calibrated\n\
         pixel_width_um = {:?} # as stated\n\
         pixel_height_um = {:?}\n\
         principal_x_px = {:?}\n\
         principal_y_px = {:?}\n\
         radial = [{k1:e}, {k2:e}, {k3:e}]\n\
         tangential = [{p1:e}, {p2:e}]\n\n\
         [sensor] # assumed\n\
         bit_depth = 12\n\
         gain_e_per_dn = 2.5\n\
         bias_dn = 64.0\n\
         full_well_e = 10000.0\n\
         read_noise_e = 5.0\n\
         dark_current_e_per_s = 1.0\n\
         background_e_per_s = 0.0\n\n\
         [psf] # assumed\n\
         kind = \"gaussian\"\n\
         sigma_px = 0.8\n\n\
         [radiometry] # assumed\n\
         kind = \"zero_point\"\n\
         zero_point_e_per_s = 1e6\n",
        camera.columns,
        camera.rows,
        camera.focal_length_mm,
        camera.pixel_width_um,
        camera.pixel_height_um,
        camera.principal_x_px,
        camera.principal_y_px,
    )
}
