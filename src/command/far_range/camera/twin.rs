//! `boresight twin`: a scenario that flies the pointings of the frames of a camera.

use std::path::{Path, PathBuf};

use camera_fit::fit_camera;
use clap::Args;
use files::{AtomicFile, Failure};
use run::ScenarioSource;
use serde_json::json;
use twin::likeness::compare;
use twin::{FrameSet, TwinCamera, camera_toml, pointings, scenario_text, twin_frames};

use super::fit::{GuessArguments, fitted, known_guess, measured_sensor};
use super::fit_text::fit_text;
use super::images::{images, read_frames};
use super::refuse_existing;
use super::sensor_file::SensorSource;
use crate::command::Answer;
use crate::command::options::output_path;
use crate::command::output::Output;

/// Largest number of times that a twin is corrected by its own frames.
const MAX_CORRECTIONS: usize = 4;

#[derive(Debug, Args)]
pub(in crate::command) struct TwinArguments {
    /// Directory with the images, all of one camera
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    #[command(flatten)]
    guess: GuessArguments,
    /// A new file for the scenario, TOML; the attitudes stand beside it, in a file of the same name that ends
    /// with .aem
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    out: PathBuf,
}

pub(in crate::command) fn twin(arguments: &TwinArguments, output: &Output) -> Result<Answer, Failure> {
    let paths = images(&arguments.directory)?;
    let (scenario, attitudes) = (&arguments.out, arguments.out.with_extension("aem"));
    for file in [scenario, &attitudes] {
        refuse_existing(file)?;
    }
    let guess = &arguments.guess;
    let sensor = guess.sensor()?;
    let frames = read_frames(&paths, output)?;
    let Some(set) = fitted(&arguments.directory, frames, &guess.first_guess(), output)? else {
        return Ok(Answer::No);
    };
    let aem = pointings(&set.fit, guess.time);
    AtomicFile::with_text(&attitudes, &aem.to_kvn())?.commit_new()?;
    let written = corrected_scenario(arguments, &set, sensor.as_ref(), &attitudes, output)
        .and_then(|text| Ok(AtomicFile::with_text(scenario, &text)?.commit_new()?));
    if let Err(failure) = written {
        // Attitudes without a scenario are of no use, and in the way of the next attempt.
        let _ = std::fs::remove_file(&attitudes);
        return Err(failure);
    }
    let words = format!(
        "{}\nscenario in {}, attitudes in {}\nnext: boresight compare {} {}",
        fit_text(&set.fit),
        scenario.display(),
        attitudes.display(),
        shown(&arguments.directory),
        shown(scenario)
    );
    let document = json!({ "scenario": scenario, "attitudes": attitudes, "frames": set.fit.frames.len() });
    output.answer(&document, words)?;
    Ok(Answer::Yes)
}

/// Returns the text of the scenario, corrected by its own frames: they are simulated, compared with those of
/// the camera, and what differs is changed by the difference.
fn corrected_scenario(
    arguments: &TwinArguments,
    set: &FrameSet,
    sensor: Option<&SensorSource>,
    attitudes: &Path,
    output: &Output,
) -> Result<String, Failure> {
    let guess = &arguments.guess;
    let origin = guess.origin(&arguments.directory);
    let name = attitudes.file_name().unwrap_or_default().to_string_lossy();
    let text_of = |twin: &TwinCamera| {
        scenario_text(&set.fit, &camera_toml(&set.fit, twin, &origin), &name, guess.time, guess.exposure)
    };
    let measured = measured_sensor(set, sensor, guess.exposure)?;
    let mut twin = TwinCamera::of(set, measured);
    for _ in 0..MAX_CORRECTIONS {
        let folder = arguments.out.parent().map(Path::to_path_buf).unwrap_or_default();
        let source = ScenarioSource::parse("twin".to_owned(), folder, arguments.out.clone(), text_of(&twin))?;
        let frames = twin_frames(source.typed("boresight twin")?, &source.folder)?;
        match fit_camera(&frames, &known_guess(&set.fit.camera, guess.time)) {
            Ok(fit) => {
                let is_changed = twin.correct(&compare(set, &FrameSet { frames, fit }));
                if !is_changed {
                    break;
                }
            }
            Err(error) => {
                output.note(&format!(
                    "warning: the frames of the twin have no camera, and do not correct it: {error}"
                ));
                break;
            }
        }
    }
    Ok(text_of(&twin))
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}
