//! Reading scenarios, of whatever world.

use std::path::{Path, PathBuf};

use files::{Failure, FileError, toml_file};
use scenario::BUILT_IN;
use scenario::run_file::RunFile;
use serde_json::Value;

use crate::any_world::{AnyWorld, ScenarioSource};
use crate::worlds::world_called;

impl ScenarioSource {
    /// Reads `word`: a built-in name, the path of a TOML file, or of the `run.toml` of a run to be repeated.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such scenario, or with the place of the first mistake in it.
    pub fn read(word: &str) -> Result<Self, Failure> {
        if let Some(built_in) = BUILT_IN.iter().find(|built_in| built_in.name == word) {
            let file = PathBuf::from(format!("scenarios/{word}.toml"));
            return Self::parse(word.to_owned(), PathBuf::new(), file, built_in.text.to_owned());
        }
        let file = PathBuf::from(word);
        let text = toml_file::read_text(&file).map_err(|error| {
            let names = BUILT_IN.iter().map(|built_in| built_in.name);
            let hint = match toml_file::nearest(word, names.clone()) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("built-in scenarios: {}", names.collect::<Vec<_>>().join(", ")),
            };
            Failure::Usage(format!(
                "`{word}` is neither a built-in scenario nor a TOML file that can be read ({error}); {hint}"
            ))
        })?;
        if file.file_name().is_some_and(|name| name == "run.toml") {
            let RunFile { name, scenario, .. } = world_in(&file, &text, "scenario.world")?.read_run(&file)?;
            return Ok(Self { name, folder: PathBuf::new(), scenario, file, text });
        }
        let name =
            file.file_stem().map_or_else(|| word.to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
        Self::parse(name, folder, file, text)
    }

    /// Reads the text of a scenario that came from `file`. Its key `world` says which kind it is.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first mistake.
    pub fn parse(name: String, folder: PathBuf, file: PathBuf, text: String) -> Result<Self, Failure> {
        let mut scenario = world_in(&file, &text, "world")?.parse(&file, &text)?;
        for path in scenario.paths() {
            // So that run.toml can be run from anywhere.
            if let Ok(absolute) = std::path::absolute(folder.join(&*path)) {
                *path = absolute.to_string_lossy().into_owned();
            }
        }
        Ok(Self { name, folder, scenario, file, text })
    }

    /// The same scenario with other values, from [`AnyScenario::to_json`](crate::AnyScenario::to_json), and another seed. `label` is what mistakes are told of.
    ///
    /// # Errors
    /// A [`Failure`] with the path of a value of the wrong type, or of one that there is not.
    pub fn with_values(&self, values: &Value, seed: u64, label: String) -> Result<Self, Failure> {
        let unwritten = |error| Failure::Usage(format!("{label}: cannot be written: {error}"));
        let text = toml::to_string(&without_nulls(values)).map_err(unwritten)?;
        let parsed = self.world().parse(Path::new(&label), &text);
        let mut scenario =
            parsed.map_err(|error| Failure::Usage(format!("{label}: {}: {}", error.path, error.message)))?;
        scenario.set_seed(seed);
        let text = scenario.to_toml()?;
        Ok(Self { name: self.name.clone(), folder: self.folder.clone(), scenario, file: label.into(), text })
    }
}

/// The world of a run or dataset, by its `run.toml`.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or with the place of a world that there is not.
pub fn world_of_run(run_file: &Path) -> Result<&'static dyn AnyWorld, Failure> {
    let text = toml_file::read_text(run_file).map_err(|source| FileError::Io {
        path: run_file.to_owned(),
        doing: "read",
        source,
    })?;
    world_in(run_file, &text, "scenario.world")
}

/// The world that a file names at a dotted path; the first one where it names none.
///
/// # Errors
/// A [`Failure`] with the place of a world that there is not. Text that is not TOML is left to the reader of the whole.
fn world_in(file: &Path, text: &str, path: &str) -> Result<&'static dyn AnyWorld, Failure> {
    let table = text.parse::<toml::Table>().unwrap_or_default();
    let mut steps = path.split('.');
    let first = steps.next().and_then(|step| table.get(step));
    match steps.try_fold(first, |value, step| Some(value?.get(step))).flatten() {
        Some(toml::Value::String(word)) => {
            world_called(word).map_err(|message| toml_file::refuse(file, text, path, message).into())
        }
        // Of another type: its place is told when the whole is read.
        _ => Ok(crate::worlds::FIRST),
    }
}

/// `values` without null members, which TOML cannot express: an absent key means the same.
fn without_nulls(values: &Value) -> Value {
    match values {
        Value::Object(members) => {
            let members = members.iter().filter(|(_, value)| !value.is_null());
            Value::Object(members.map(|(key, value)| (key.clone(), without_nulls(value))).collect())
        }
        Value::Array(items) => Value::Array(items.iter().map(without_nulls).collect()),
        value => value.clone(),
    }
}
