//! Fuzz targets for text: TOML, JSON, and formats specific to Boresight.

use std::fmt::Debug;
use std::path::Path;

use boresight::docking::DockingScenario;
use boresight::docking::rows::SetupFile;
use boresight::docking::scoring::DockingScore;
use boresight::far_range::rows::CameraFile;
use boresight::far_range::scoring::Score;
use boresight::far_range::{CameraSource, FarRangeScenario};
use boresight::far_range_views::report::read_visibility;
use boresight::files::{
    AtomicFile, CalibrationFormat, Failure, FileError, LensCalibration, calibration_text, read_calibration,
};
use boresight::report::StudyResult;
use boresight::run::{Options, ScenarioSource};
use boresight::scenario::run_file::{RunFile, ScenarioFile};
use boresight::study::{Study, StudyRecord};
use boresight::toml_file;
use boresight::visibility::Requirements;
use serde::Serialize;
use serde::de::DeserializeOwned;
use sim::catalog::Catalog;
use sim::optics::{Psf, PsfConfig};
use sim::scene::TargetConfig;
use sim::scene::docking::TargetFile;

use crate::{Sandbox, written};

/// Largest number of pixels for which a simulator is built: a larger camera legitimately needs more memory
/// and time.
const MAX_PIXELS: usize = 1 << 16;
/// Largest number of frames for which a simulator is built.
const MAX_FRAMES: u64 = 1 << 16;

pub(crate) fn scenario(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(source) = ScenarioSource::read(&word(&sandbox.file("scenario.toml", bytes))) else { return };
    scenario_again::<FarRangeScenario>(sandbox, &source);
    scenario_again::<DockingScenario>(sandbox, &source);
}

/// Writes a scenario, if it is of this world, and reads it again.
fn scenario_again<S: ScenarioFile + PartialEq>(sandbox: &Sandbox, source: &ScenarioSource) {
    let Ok(scenario) = source.typed::<S>("fuzz") else { return };
    let write = |path: &Path, scenario: &S| -> Result<(), Failure> {
        Ok(AtomicFile::with_text(path, &scenario.to_toml()?)?.commit_new()?)
    };
    let read = |path: &Path| -> Result<S, Failure> {
        let text = toml_file::read_text(path).map_err(|error| Failure::Usage(error.to_string()))?;
        Ok(S::parse(path, &text)?)
    };
    written::check(sandbox, "again.toml", scenario, write, read);
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
    let path = sandbox.file("run.toml", bytes);
    let _ = ScenarioSource::read(&word(&path));
    run_again::<FarRangeScenario>(sandbox, &path);
    run_again::<DockingScenario>(sandbox, &path);
}

/// Writes a `run.toml`, if it is of this world, and reads it again.
fn run_again<S: ScenarioFile + PartialEq>(sandbox: &Sandbox, path: &Path) {
    if let Ok(run) = RunFile::<S>::read(path) {
        let write = |path: &Path, run: &RunFile<S>| run.write(path);
        written::check(sandbox, "again.toml", &run, write, RunFile::read);
    }
}

pub(crate) fn study(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Study::read(&sandbox.file("study.toml", bytes));
}

pub(crate) fn requirements(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Requirements::read(&word(&sandbox.file("requirements.toml", bytes)));
}

pub(crate) fn preset(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = CameraSource::read(&word(&sandbox.file("preset.toml", bytes)));
}

/// The camera of a file, or the first ones that another tool would select.
pub(crate) fn calibration(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("calibration.yaml", bytes);
    for name in [None, Some("cam0"), Some("1"), Some("left")] {
        if let Ok(lens) = read_calibration(&path, name) {
            let size_px = lens.size_px.unwrap_or([640, 480]);
            if let Ok(camera) = lens.to_camera(size_px, 5.0) {
                let _ = LensCalibration::from_camera(&camera.value);
            }
            let formats = [CalibrationFormat::OpenCvYaml, CalibrationFormat::OpenCvJson];
            let with_size = [CalibrationFormat::Ros].into_iter().filter(|_| lens.size_px.is_some());
            for format in formats.into_iter().chain(with_size) {
                let write = |path: &Path, lens: &LensCalibration| -> Result<(), FileError> {
                    AtomicFile::with_text(path, &calibration_text(path, lens, format)?)?.commit_new()
                };
                written::check(sandbox, "again.yaml", &lens, write, |path| read_calibration(path, None));
            }
        }
    }
}

pub(crate) fn camera(sandbox: &Sandbox, bytes: &[u8]) {
    if let Ok(camera) = CameraFile::read(&sandbox.file("camera.toml", bytes)) {
        let write = |path: &Path, camera: &CameraFile| camera.write(path);
        written::check(sandbox, "again.toml", &camera, write, CameraFile::read);
    }
}

pub(crate) fn setup(sandbox: &Sandbox, bytes: &[u8]) {
    if let Ok(setup) = SetupFile::read(&sandbox.file("setup.toml", bytes)) {
        let write = |path: &Path, setup: &SetupFile| setup.write(path);
        written::check(sandbox, "again.toml", &setup, write, SetupFile::read);
    }
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

pub(crate) fn mesh_glb(sandbox: &Sandbox, bytes: &[u8]) {
    let path = word(&sandbox.file("mesh.glb", bytes));
    mesh(&format!("path = {path:?}\nradius_m = 2.07"));
}

/// The same bytes are the mesh and its materials.
pub(crate) fn mesh_obj(sandbox: &Sandbox, bytes: &[u8]) {
    let [mesh_path, library] = ["mesh.obj", "mesh.mtl"].map(|name| word(&sandbox.file(name, bytes)));
    mesh(&format!("path = {mesh_path:?}\nmaterial_path = {library:?}\nradius_m = 1.0"));
}

fn mesh(keys: &str) {
    let text = format!("kind = \"mesh\"\n{keys}");
    if let Ok(target) = toml_file::parse::<TargetConfig>(Path::new("target.toml"), &text) {
        let _ = target.check();
    }
}

pub(crate) fn catalogue_csv(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Catalog::read(&sandbox.file("stars.csv", bytes));
}

pub(crate) fn catalogue_dat(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = Catalog::read(&sandbox.file("stars.dat", bytes));
}

pub(crate) fn json(sandbox: &Sandbox, bytes: &[u8]) {
    if let Ok(record) = StudyRecord::read(&sandbox.file("study.json", bytes)) {
        json_again(sandbox, &record);
    }
    sandbox.file("summary.json", bytes);
    let _ = StudyResult::read(sandbox.path());
    sandbox.file("visibility.json", bytes);
    let _ = read_visibility(sandbox.path());
    // The readers of these files need a complete run directory.
    if let Ok(score) = serde_json::from_slice::<Score>(bytes) {
        json_again(sandbox, &score);
    }
    if let Ok(score) = serde_json::from_slice::<DockingScore>(bytes) {
        json_again(sandbox, &score);
    }
}

/// Writes a value as JSON and reads it again.
///
/// # Panics
/// If that fails or changes the value.
#[expect(clippy::expect_used, reason = "a target reports a fault by panicking")]
fn json_again<T: Serialize + DeserializeOwned + Debug + PartialEq>(sandbox: &Sandbox, first: &T) {
    if !sandbox.writes() {
        return;
    }
    let text = serde_json::to_string(first).expect("what was read can be written");
    let second = serde_json::from_str(&text).expect("what was written can be read");
    written::check_same("JSON", first, &second);
}

fn word(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
