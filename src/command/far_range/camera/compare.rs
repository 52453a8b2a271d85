//! `boresight compare`: the likeness of the frames of a camera and of its twin.

use std::path::{Path, PathBuf};

use camera_fit::{FirstGuess, SkyFrame};
use clap::Args;
use config::toml_file;
use far_range::FarRangeScenario;
use far_range_views::likeness_table;
use files::{Failure, FileError, parse_utc};
use run::ScenarioSource;
use serde_json::{Value, json};
use twin::likeness::{Change, Comparison, KeptComparison, changes, compare as compare_sets};
use twin::{FrameSet, twin_frames};

use super::fit::fitted;
use super::guess::known_guess;
use super::images::{images, read_frames};
use super::pages::write_likeness_page;
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;
use crate::command::report::check_option;

/// Largest relative error of the field that the twin's scenario states for the camera.
const TOLERANCE: f64 = 0.05;

#[derive(Debug, Args)]
pub(in crate::command) struct CompareArguments {
    /// Directory with the images of the camera
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Scenario of the twin, TOML (`boresight twin` writes one): its frames are simulated and compared
    #[arg(value_name = "TWIN")]
    twin: PathBuf,
    /// Also write figures, spectra and pictures as one HTML file, replaced if it is a report
    #[arg(long, value_name = "FILE", value_parser = output_path())]
    report: Option<PathBuf>,
    /// An earlier comparison, the output of --json: the exit status is then 1 if a figure changed by more
    /// than its error, and not if one differs
    #[arg(long, value_name = "FILE.json")]
    baseline: Option<PathBuf>,
}

pub(in crate::command) fn compare(arguments: &CompareArguments, output: &Output) -> Result<Answer, Failure> {
    check_option(arguments.report.as_ref())?;
    let kept = arguments.baseline.as_deref().map(read_kept).transpose()?;
    let paths = images(&arguments.directory)?;
    let source = ScenarioSource::read(&arguments.twin.to_string_lossy())?;
    let scenario: &FarRangeScenario = source.typed("boresight compare")?;
    let of_twin = twin_guess(scenario, &arguments.twin)?;
    let of_camera = FirstGuess { tolerance: TOLERANCE, ..of_twin };
    let frames = read_frames(&paths, output)?;
    check_size(&frames, scenario, &arguments.directory)?;
    let simulated = twin_frames(scenario, &source.folder)?;
    let Some(camera) = fitted(&arguments.directory, frames, &of_camera, output)? else {
        return Ok(Answer::No);
    };
    let Some(twin) = fitted(&arguments.twin, simulated, &of_twin, output)? else { return Ok(Answer::No) };
    let found = compare_sets(&camera, &twin);
    if let Some(path) = &arguments.report {
        write_likeness_page(&camera, &twin, &found, &arguments.directory, path)?;
    }
    let changed = kept.map(|kept| changes(&kept, &found.figures));
    let is_alike = found.is_alike();
    let mut text = likeness_table(&camera, &twin, &found, output.is_terminal());
    for change in changed.iter().flatten() {
        text.push_str(&format!("\nchanged: {}", change_words(change)));
    }
    let is_as_before = changed.as_ref().map_or(is_alike, Vec::is_empty);
    output.answer(&document(&camera, &twin, &found, changed.as_deref()), text)?;
    Ok(if is_as_before { Answer::Yes } else { Answer::No })
}

/// Refuses frames of another size than those of the twin.
fn check_size(frames: &[SkyFrame], scenario: &FarRangeScenario, directory: &Path) -> Result<(), Failure> {
    let camera = &scenario.camera;
    for SkyFrame { name, image } in frames {
        if [image.columns, image.rows] != [camera.columns, camera.rows] {
            return Err(Failure::Usage(format!(
                "{}: {name} is {} × {} pixels, expected {} × {} as the camera of the twin",
                directory.display(),
                image.columns,
                image.rows,
                camera.columns,
                camera.rows
            )));
        }
    }
    Ok(())
}

/// Reads an earlier comparison.
///
/// # Errors
/// [`Failure::Usage`] for a file that is no comparison.
fn read_kept(path: &Path) -> Result<KeptComparison, Failure> {
    let text = toml_file::read_text(path).map_err(|source| FileError::io(path, "read", source))?;
    let refuse = |reason: String| {
        Failure::Usage(format!(
            "--baseline: {}: {reason}; expected the output of `boresight compare --json`",
            path.display()
        ))
    };
    let kept: KeptComparison = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
    if kept.figures.is_empty() {
        return Err(refuse("has no figures".to_owned()));
    }
    Ok(kept)
}

fn change_words(change: &Change) -> String {
    match change {
        Change::Moved { code, differences: [before, now], limit } => {
            format!("{code}: the difference was {before:.4}, and is {now:.4} (± {limit:.4})")
        }
        Change::Lost { code } => format!("{code}: is in the baseline, and the frames no longer give it"),
    }
}

/// Returns what the scenario of the twin says of its camera.
///
/// # Errors
/// [`Failure::Usage`] for a time that cannot be read.
fn twin_guess(scenario: &FarRangeScenario, path: &Path) -> Result<FirstGuess, Failure> {
    let start = scenario.schedule.first().map_or("", |group| group.start_utc.as_str());
    let time = parse_utc(start).map_err(|expected| {
        Failure::Usage(format!("{}: schedule[0].start_utc is `{start}`, expected {expected}", path.display()))
    })?;
    Ok(known_guess(&scenario.camera, time))
}

/// Returns the comparison as JSON.
fn document(camera: &FrameSet, twin: &FrameSet, found: &Comparison, changed: Option<&[Change]>) -> Value {
    let is_alike = found.is_alike();
    json!({
        "ok": changed.map_or(is_alike, <[Change]>::is_empty),
        "changed": changed.map(|changes| changes.iter().map(change_words).collect::<Vec<_>>()),
        "frames": [camera.fit.frames.len(), twin.fit.frames.len()],
        "shared_stars": found.stars.len(),
        "figures": found.figures,
        "not_compared": found.missing,
    })
}
