//! `boresight twin`: a scenario that flies the pointings of the frames of a camera.

use std::path::{Path, PathBuf};

use camera_fit::fit_camera;
use clap::Args;
use files::{AtomicFile, Failure};
use run::ScenarioSource;
use serde_json::json;
use twin::likeness::compare;
use twin::{FrameSet, Origin, TwinCamera, pointings, scenario_text, twin_frames};

use super::fit::{fitted, measured_sensor};
use super::fit_text::{fit_text, warnings};
use super::guess::{GuessArguments, Known, known_guess};
use super::images::{images, read_frames};
use super::refuse_existing;
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
    let directory = &arguments.directory;
    let paths = images(directory)?;
    let (scenario, attitudes) = (&arguments.out, arguments.out.with_extension("aem"));
    if *scenario == attitudes {
        let message = format!("--out is {}, expected a name that ends with .toml", scenario.display());
        return Err(Failure::Usage(message));
    }
    for file in [scenario, &attitudes] {
        refuse_existing(file)?;
    }
    let sensor = arguments.guess.sensor()?;
    let frames = read_frames(&paths, output)?;
    let Known { guess, exposure_s } = arguments.guess.first_guess(directory, &paths, output)?;
    let Some(set) = fitted(directory, frames, &guess, output)? else { return Ok(Answer::No) };
    for warning in warnings(&set.fit, guess.time) {
        output.note(format!("warning: {warning}"));
    }
    let origin = Origin { directory, time: guess.time, exposure_s };
    let measured = measured_sensor(&set, sensor.as_ref(), origin.exposure_s)?;
    let twin = TwinCamera::of(&set, measured);
    AtomicFile::with_text(&attitudes, &pointings(&set.fit, guess.time).to_kvn())?.commit_new()?;
    let written = corrected_scenario(&set, twin, &origin, scenario, output)
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
        directory.display(),
        scenario.display()
    );
    let document = json!({ "scenario": scenario, "attitudes": attitudes, "frames": set.fit.frames.len() });
    output.answer(&document, words)?;
    Ok(Answer::Yes)
}

/// Returns the text of the scenario, corrected by its own frames: they are simulated, compared with those of
/// the camera, and what differs is changed by the difference. Its attitudes stand beside it.
///
/// # Errors
/// A [`Failure`] for a scenario that cannot be simulated.
fn corrected_scenario(
    set: &FrameSet,
    mut twin: TwinCamera,
    origin: &Origin<'_>,
    scenario: &Path,
    output: &Output,
) -> Result<String, Failure> {
    let attitudes = scenario.with_extension("aem");
    let name = attitudes.file_name().unwrap_or_default().to_string_lossy();
    let folder = scenario.parent().map(Path::to_path_buf).unwrap_or_default();
    for _ in 0..MAX_CORRECTIONS {
        let text = scenario_text(set, &twin, origin, &name);
        let source = ScenarioSource::parse("twin".to_owned(), folder.clone(), scenario.to_path_buf(), text)?;
        let frames = twin_frames(source.typed("boresight twin")?, &source.folder)?;
        match fit_camera(&frames, &known_guess(&set.fit.camera, origin.time)) {
            Ok(fit) => {
                let is_changed = twin.correct(&compare(set, &FrameSet { frames, fit }));
                if !is_changed {
                    break;
                }
            }
            Err(error) => {
                output.note(format!(
                    "warning: the frames of the twin have no camera, and do not correct it: {error}"
                ));
                break;
            }
        }
    }
    Ok(scenario_text(set, &twin, origin, &name))
}
