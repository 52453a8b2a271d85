//! Fuzz targets for text: TOML, JSON, and formats specific to Boresight.

use std::path::Path;

use boresight::files::CameraFile;
use boresight::files::docking::SetupFile;
use boresight::report::{StudyResult, read_visibility};
use boresight::run::{Options, ScenarioSource};
use boresight::scenario::{DockingScenario, FarRangeScenario};
use boresight::score::Score;
use boresight::score::docking::DockingScore;
use boresight::study::{Study, StudyRecord};
use boresight::toml_file;
use boresight::visibility::Requirements;
use sim::catalog::Catalog;
use sim::optics::{Psf, PsfConfig};
use sim::scene::docking::TargetFile;

use crate::Sandbox;

/// Largest number of pixels for which a simulator is built: a larger camera legitimately needs more memory
/// and time.
const MAX_PIXELS: usize = 1 << 16;
/// Largest number of frames for which a simulator is built.
const MAX_FRAMES: u64 = 1 << 16;

pub(crate) fn scenario(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = ScenarioSource::read(&word(&sandbox.file("scenario.toml", bytes)));
}

pub(crate) fn simulator(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(source) = ScenarioSource::read(&word(&sandbox.file("scenario.toml", bytes))) else { return };
    let pixels = |camera: &contract::Camera| camera.columns.saturating_mul(camera.rows);
    let is_small = if let Ok(scenario) = source.typed::<FarRangeScenario>("fuzz") {
        let frames: u64 = scenario.schedule.iter().fold(0, |sum, group| sum.saturating_add(group.count));
        pixels(&scenario.camera) <= MAX_PIXELS && frames <= MAX_FRAMES
    } else if let Ok(scenario) = source.typed::<DockingScenario>("fuzz") {
        scenario.cameras.iter().all(|lens| pixels(&lens.camera) <= MAX_PIXELS)
    } else {
        false
    };
    if is_small {
        let _ = source.prepare(Options::default());
    }
}

pub(crate) fn run_file(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = ScenarioSource::read(&word(&sandbox.file("run.toml", bytes)));
}

pub(crate) fn study(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Study::read(&sandbox.file("study.toml", bytes));
}

pub(crate) fn requirements(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Requirements::read(&word(&sandbox.file("requirements.toml", bytes)));
}

pub(crate) fn camera(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = CameraFile::read(&sandbox.file("camera.toml", bytes));
}

pub(crate) fn setup(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = SetupFile::read(&sandbox.file("setup.toml", bytes));
}

pub(crate) fn target(_: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let file = Path::new("target.toml");
    if let Ok(target) = toml_file::parse::<TargetFile>(file, text)
        && let Err(error) = target.check()
    {
        let _ = toml_file::refuse(file, text, "plate", error.to_string()).to_string();
    }
}

pub(crate) fn psf(sandbox: &Sandbox, bytes: &[u8]) {
    let path = word(&sandbox.file("psf.csv", bytes));
    let _ = Psf::new(&PsfConfig::Sampled { path, oversampling: 4.0 });
}

pub(crate) fn catalogue_csv(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Catalog::read(&sandbox.file("stars.csv", bytes));
}

pub(crate) fn catalogue_dat(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Catalog::read(&sandbox.file("stars.dat", bytes));
}

pub(crate) fn json(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = StudyRecord::read(&sandbox.file("study.json", bytes));
    sandbox.file("summary.json", bytes);
    let _ = StudyResult::read(sandbox.path());
    sandbox.file("visibility.json", bytes);
    let _ = read_visibility(sandbox.path());
    // The readers of these files need a complete run directory.
    let _ = serde_json::from_slice::<Score>(bytes);
    let _ = serde_json::from_slice::<DockingScore>(bytes);
}

fn word(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
