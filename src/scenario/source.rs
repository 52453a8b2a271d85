//! Where a scenario comes from, and reading it.

use std::path::{Path, PathBuf};

use pipeline::PipelineError;
use sim::catalog::CatalogSource;
use sim::optics::PsfConfig;
use sim::{SimError, Simulator};

use super::{BUILT_IN, Scenario, is_argon};
use crate::failure::Failure;
use crate::run_file::RunFile;
use crate::toml_file;

/// A scenario that was read and checked, with its text for the places of later mistakes.
#[derive(Debug, Clone)]
pub struct ScenarioSource {
    /// Name: that of the built-in one, or the file's without its extension.
    pub name: String,
    /// Folder that relative paths in the scenario start from.
    pub folder: PathBuf,
    /// The scenario.
    pub scenario: Scenario,
    file: PathBuf,
    text: String,
}

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
            let RunFile { name, scenario, .. } = RunFile::read(&file)?;
            return Ok(Self { name, folder: PathBuf::new(), scenario, file, text });
        }
        let name =
            file.file_stem().map_or_else(|| word.to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
        Self::parse(name, folder, file, text)
    }

    /// Reads the text of a scenario that came from `file`.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first mistake.
    pub fn parse(name: String, folder: PathBuf, file: PathBuf, text: String) -> Result<Self, Failure> {
        let mut scenario: Scenario = toml_file::parse(&file, &text)?;
        let catalog = match &mut scenario.catalog.source {
            CatalogSource::File(path) => Some(path),
            CatalogSource::Hipparcos2 => None,
        };
        let psf = match &mut scenario.psf {
            PsfConfig::Sampled { path, .. } => Some(path),
            _ => None,
        };
        for path in catalog.into_iter().chain(psf) {
            if let Ok(absolute) = std::path::absolute(folder.join(&*path)) {
                // So that run.toml can be run from anywhere.
                *path = absolute.to_string_lossy().into_owned();
            }
        }
        Ok(Self { name, folder, scenario, file, text })
    }

    /// Whether the published figures of ARGON may stand beside those of this scenario.
    pub fn is_argon(&self) -> bool {
        is_argon(&self.scenario)
    }

    /// The simulator of this scenario; every value is checked.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn simulator(&self) -> Result<Simulator, Failure> {
        let limit = self.scenario.star_list.magnitude_limit;
        if !(-2.0..=15.0).contains(&limit) {
            let message = format!("is {limit}, expected -2 to 15");
            return Err(self.refuse("star_list.magnitude_limit", message));
        }
        if let Err(PipelineError::Parameter { field, value, expected }) = self.scenario.far_range.check() {
            return Err(
                self.refuse(&format!("far_range.{field}"), format!("is {value}, expected {expected}"))
            );
        }
        Simulator::new(&self.scenario.simulation(), &self.folder).map_err(|error| self.explain(error))
    }

    /// Gives a refused value its place in the file.
    fn explain(&self, error: SimError) -> Failure {
        match &error {
            SimError::Parameter { field, value, expected } => {
                self.refuse(field, format!("is {value}, expected {expected}"))
            }
            SimError::Entry { path, value, expected } => {
                self.refuse(path, format!("is {value}, expected {expected}"))
            }
            SimError::Contract(contract::ContractError::OutOfRange { field, value, expected }) => {
                self.refuse(field, format!("is {value}, expected {expected}"))
            }
            _ => error.into(),
        }
    }

    fn refuse(&self, path: &str, message: String) -> Failure {
        toml_file::refuse(&self.file, &self.text, path, message).into()
    }
}
