//! `boresight show`: frames of a run or dataset as one annotated picture.

mod picture_file;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use files::Failure;
use serde_json::{Value, json};
use show::{MAX_PANELS, Panel, ShowError, Stretch, encode, picture};
use view::{AnnotatedFrame, CloseUp, Source, views_of};

use self::picture_file::PictureFile;
use super::Answer;
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct ShowArguments {
    /// A run directory, a rendered dataset, or a dataset of real images
    #[arg(value_name = "RUN")]
    directory: PathBuf,
    /// Number of the frame (docking: of the field); several, up to 16, become a contact sheet
    #[arg(value_name = "FRAME", required = true)]
    frames: Vec<u64>,
    /// PNG file to write. Replaces an earlier picture of this command, but no other file; default:
    /// RUN/show/FRAME.png
    #[arg(short, long, value_name = "FILE.png")]
    out: Option<PathBuf>,
    /// Map from digital numbers to grey: asinh, linear (darkest to brightest pixel) or full (0 to full
    /// scale); default: asinh, docking full
    #[arg(long, value_name = "STRETCH")]
    stretch: Option<Stretch>,
    /// The whole frame, with the target enlarged in a close-up, or only the surroundings of the target
    #[arg(long, value_name = "VIEW", value_enum, default_value_t)]
    view: ShownArea,
    /// Outcomes to draw, CSV; default: `measurements.csv` in RUN, if it exists. The features and clusters
    /// that the pipeline recognised (features.parquet, clusters.parquet) are read beside it
    #[arg(long, value_name = "FILE")]
    measurements: Option<PathBuf>,
}

/// Part of the frame to draw.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum ShownArea {
    /// The whole frame
    #[default]
    Frame,
    /// The surroundings of the target
    Target,
}

pub(super) fn show(arguments: &ShowArguments, output: &Output) -> Result<Answer, Failure> {
    if arguments.frames.len() > MAX_PANELS {
        return Err(undrawn(ShowError::PanelCount(arguments.frames.len())));
    }
    let source = Source::open(&arguments.directory, arguments.measurements.as_deref())?;
    // Rejected before the work begins.
    let file = PictureFile::new(arguments.out.as_deref(), &source.directory, &arguments.frames)?;
    let views = views_of(source.world.code()).ok_or_else(|| {
        let code = source.world.code();
        Failure::Usage(format!("{}: frames of the world {code} cannot be drawn", source.name))
    })?;
    let mut shown = (views.panels)(&source, &arguments.frames)?;
    for AnnotatedFrame { panel, frame, .. } in &mut shown {
        panel.stretch = arguments.stretch.unwrap_or(panel.stretch);
        if arguments.view == ShownArea::Target {
            panel.view = panel.close_up.take().ok_or_else(|| {
                Failure::Usage(format!(
                    "--view is target, but frame {frame} has neither a target nor a measurement; use --view \
                     frame"
                ))
            })?;
        } else if views.close_up == CloseUp::None {
            panel.close_up = None;
        }
    }
    let panels: Vec<Panel> = shown.iter().map(|shown| shown.panel.clone()).collect();
    let drawn = picture(&panels).map_err(undrawn)?;
    let title = match panels.as_slice() {
        [only] => only.title.clone(),
        _ => format!("{}, {} frames", source.name, panels.len()),
    };
    let path = file.write(&encode(&drawn, &title).map_err(undrawn)?)?;
    let frames: Vec<Value> =
        shown.iter().zip(&drawn.panels).map(|(shown, place)| shown.document(place)).collect();
    output.answer(
        &json!({ "file": path, "width": drawn.width, "height": drawn.height, "frames": frames }),
        path.display(),
    )?;
    Ok(Answer::Yes)
}

/// Returns the failure of a picture that cannot be drawn.
fn undrawn(error: ShowError) -> Failure {
    Failure::Usage(error.to_string())
}
