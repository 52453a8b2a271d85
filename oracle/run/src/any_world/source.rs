//! Reading of scenarios of any world.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use config::toml_file;
use contract::OutOfRange;
use files::{Failure, FileError, file_sha256};
use scenario::BUILT_IN;
use scenario::run_file::{FileDigests, RunFile, ScenarioFile, content};
use serde_json::Value;
use sim::SimError;

use super::{AnyMission, AnyScenario, AnyWorld, Options};
use crate::worlds::{first_world, world_by_name};

/// A scenario that was read, with its text to locate mistakes found later. [`ScenarioSource::prepare`] checks
/// its values.
#[derive(Debug, Clone)]
pub struct ScenarioSource {
    /// Name of the built-in scenario, or of the file without its extension.
    pub name: String,
    /// Directory that relative paths in the scenario refer to.
    pub folder: PathBuf,
    /// Scenario with its world.
    pub scenario: AnyScenario,
    file: PathBuf,
    text: String,
    /// SHA-256 of the files at the time when the scenario was read, by absolute path. A file that changes
    /// before it is used is refused.
    contents: BTreeMap<PathBuf, String>,
}

impl ScenarioSource {
    /// Returns the world of the scenario.
    pub fn world(&self) -> &'static dyn AnyWorld {
        self.scenario.world()
    }

    /// Checks all values of the scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value, or for an option that the world does not
    /// support.
    pub fn prepare(&self, options: Options) -> Result<Box<dyn AnyMission>, Failure> {
        self.world().prepare(self, options)
    }

    /// Returns the scenario with its type `S`, for an operation that only the world of `S` supports.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the scenario is of another world; `what` names the operation.
    pub fn typed<S: ScenarioFile>(&self, what: &str) -> Result<&S, Failure> {
        self.scenario.values().ok_or_else(|| {
            Failure::Usage(format!(
                "{what}: scenario `{}` belongs to another world, expected a scenario of {}",
                self.name,
                S::WORLD
            ))
        })
    }

    /// Adds the location in the file to an error about a value that the simulator refuses.
    pub fn explain(&self, error: SimError) -> Failure {
        match error {
            SimError::OutOfRange(error) => self.out_of_range(&error),
            error => error.into(),
        }
    }

    /// Adds the location in the file to an error about a value in the table `table` of the scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the value.
    pub fn check_part(&self, table: &str, checked: Result<(), OutOfRange>) -> Result<(), Failure> {
        checked.map_err(|error| self.out_of_range(&error.under(table)))
    }

    /// Adds the location in the file to an error about a value outside its range.
    pub fn out_of_range(&self, error: &OutOfRange) -> Failure {
        toml_file::out_of_range(&self.file, &self.text, error).into()
    }

    /// Returns the failure for a value at a path of the scenario.
    pub fn refuse(&self, path: &str, message: String) -> Failure {
        toml_file::refuse(&self.file, &self.text, path, message).into()
    }
}

impl ScenarioSource {
    /// Reads the scenario `word`: a built-in name, the path of a TOML file, or of the `run.toml` of a run to
    /// be repeated.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such scenario, or with the location of the first mistake in it.
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
            let RunFile { name, mut scenario, files, .. } =
                world_in(&file, &text, "scenario.world")?.read_run(&file)?;
            let recorded = |(role, path): (&str, &mut String)| {
                files.get(role).map(|sha256| (PathBuf::from(&*path), sha256.clone()))
            };
            let contents = scenario.paths().into_iter().filter_map(recorded).collect();
            return Ok(Self { name, folder: PathBuf::new(), scenario, file, text, contents });
        }
        let name =
            file.file_stem().map_or_else(|| word.to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
        Self::parse(name, folder, file, text)
    }

    /// Parses the text of a scenario that was read from `file`. The key `world` names its world.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake.
    pub fn parse(name: String, folder: PathBuf, file: PathBuf, text: String) -> Result<Self, Failure> {
        let mut scenario = world_in(&file, &text, "world")?.parse(&file, &text)?;
        let mut contents = BTreeMap::new();
        for (_, path) in scenario.paths() {
            // Absolute paths let run.toml be used from any directory.
            if let Ok(absolute) = std::path::absolute(folder.join(&*path)) {
                *path = absolute.to_string_lossy().into_owned();
                contents.extend(content_of(absolute));
            }
        }
        Ok(Self { name, folder, scenario, file, text, contents })
    }

    /// Records the digest of the file at a path that a later value of the scenario may name; `None` if the
    /// file does not exist.
    pub fn note_file(&mut self, path: &str) -> Option<&str> {
        let path = self.folder.join(path);
        if !self.contents.contains_key(&path) {
            self.contents.extend(content_of(path.clone()));
        }
        self.contents.get(&path).map(String::as_str)
    }

    /// Returns the directory of the run to be repeated, if the scenario is that of a `run.toml`.
    pub fn directory_of_run(&self) -> Option<&Path> {
        self.file.parent().filter(|_| self.file.file_name().is_some_and(|name| name == "run.toml"))
    }

    /// Returns the files with a recorded digest: those that the scenario reads, or may read with other
    /// values.
    pub fn known_files(&self) -> impl Iterator<Item = &Path> {
        self.contents.keys().map(PathBuf::as_path)
    }

    /// Returns the SHA-256 of the files that the scenario reads, by their roles.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, or has changed since the scenario was read or, for a
    /// `run.toml`, since the run.
    pub fn files(&self) -> Result<FileDigests, Failure> {
        let mut digests = FileDigests::new();
        for (role, path) in self.scenario.clone().paths() {
            let path = self.folder.join(&*path);
            let missing = || FileError::io(&path, "read", std::io::ErrorKind::NotFound.into());
            let sha256 = file_sha256(&path)?.ok_or_else(missing)?;
            if let Some(earlier) = self.contents.get(&path).filter(|earlier| **earlier != sha256) {
                let message = format!(
                    "is {}, whose SHA-256 is {sha256}, expected {earlier}: the file has changed since that \
                     hash was recorded",
                    path.display()
                );
                return Err(self.refuse(role, message));
            }
            digests.insert(role.to_owned(), sha256);
        }
        Ok(digests)
    }

    /// Returns the scenario with the path of every file replaced by the digest of its content at the time
    /// when the scenario was read.
    pub fn identity(&self) -> AnyScenario {
        let mut scenario = self.scenario.clone();
        for (_, path) in scenario.paths() {
            if let Some(sha256) = self.contents.get(&self.folder.join(&*path)) {
                *path = content(sha256);
            }
        }
        scenario
    }

    /// Returns the scenario with other values, in the form of
    /// [`ScenarioValues::to_json`](scenario::run_file::ScenarioValues::to_json), and another seed.
    /// `label` is the origin named in error messages.
    ///
    /// # Errors
    /// A [`Failure`] with the path of an unknown value, or of a value of the wrong type.
    pub fn with_values(&self, values: &Value, seed: u64, label: String) -> Result<Self, Failure> {
        let unwritten = |error| Failure::Usage(format!("{label}: cannot be written: {error}"));
        let text = toml::to_string(&without_nulls(values)).map_err(unwritten)?;
        let parsed = self.world().parse(Path::new(&label), &text);
        let mut scenario =
            parsed.map_err(|error| Failure::Usage(format!("{label}: {}: {}", error.path, error.message)))?;
        scenario.set_seed(seed);
        let text = scenario.to_toml()?;
        Ok(Self { scenario, file: label.into(), text, ..self.clone() })
    }
}

/// Returns a path with the SHA-256 of its file; `None` if the file cannot be read, which is refused when it
/// is used.
fn content_of(path: PathBuf) -> Option<(PathBuf, String)> {
    let sha256 = file_sha256(&path).ok()??;
    Some((path, sha256))
}

/// Returns the world of a run or dataset, by its `run.toml`.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or with the location of an unknown world.
pub fn world_of_run(run_file: &Path) -> Result<&'static dyn AnyWorld, Failure> {
    let text = toml_file::read_text(run_file).map_err(|source| FileError::Io {
        path: run_file.to_owned(),
        doing: "read",
        source,
    })?;
    world_in(run_file, &text, "scenario.world")
}

/// Checks that the run in a directory is of the world with the name `expected`.
///
/// # Errors
/// [`Failure::Usage`] with both names for another world; those of [`world_of_run`].
pub fn check_world_of_run(directory: &Path, expected: &str) -> Result<(), Failure> {
    let world = world_of_run(&directory.join("run.toml"))?;
    if world.code() == expected {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{}: is a run of the world {}, expected {expected}",
        directory.display(),
        world.code()
    )))
}

/// Returns the world that a file names at a dotted path; the first world if it names none.
///
/// # Errors
/// A [`Failure`] with the location of an unknown world. Text that is not TOML is reported by the reader of
/// the complete file.
fn world_in(file: &Path, text: &str, path: &str) -> Result<&'static dyn AnyWorld, Failure> {
    let table = text.parse::<toml::Table>().unwrap_or_default();
    let mut steps = path.split('.');
    let first = steps.next().and_then(|step| table.get(step));
    match steps.try_fold(first, |value, step| Some(value?.get(step))).flatten() {
        Some(toml::Value::String(word)) => {
            world_by_name(word).map_err(|message| toml_file::refuse(file, text, path, message).into())
        }
        // A value of another type is reported when the complete file is read.
        _ => first_world(),
    }
}

/// Returns `values` without null members, which TOML cannot express: an absent key has the same meaning.
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
