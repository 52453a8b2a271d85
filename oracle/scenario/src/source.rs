//! Where a scenario comes from, and reading it.

use std::path::{Path, PathBuf};

use contract::{OutOfRange, bounds};
use files::{Failure, toml_file};
use serde_json::Value;
use sim::catalog::CatalogSource;
use sim::docking::DockingSimulator;
use sim::optics::PsfConfig;
use sim::scene::docking::TargetFile;
use sim::{SimError, Simulator};

use super::{BUILT_IN, DockingScenario, FarRangeScenario, Scenario, World};
use crate::run_file::{RunFile, ScenarioFile};

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
            let (name, scenario) = match world(&file, &text, "scenario.world")? {
                World::FarRange => {
                    let RunFile { name, scenario, .. } = RunFile::<FarRangeScenario>::read(&file)?;
                    (name, Scenario::FarRange(Box::new(scenario)))
                }
                World::Docking => {
                    let RunFile { name, scenario, .. } = RunFile::<DockingScenario>::read(&file)?;
                    (name, Scenario::Docking(Box::new(scenario)))
                }
            };
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
        let scenario = match world(&file, &text, "world")? {
            World::FarRange => {
                let mut scenario = FarRangeScenario::parse(&file, &text)?;
                let catalog = match &mut scenario.catalog.source {
                    CatalogSource::File(path) => Some(path),
                    CatalogSource::Hipparcos2 => None,
                };
                let psf = match &mut scenario.psf {
                    PsfConfig::Sampled { path, .. } => Some(path),
                    _ => None,
                };
                catalog.into_iter().chain(psf).for_each(|path| make_absolute(&folder, path));
                Scenario::FarRange(Box::new(scenario))
            }
            World::Docking => {
                let mut scenario = DockingScenario::parse(&file, &text)?;
                if TargetFile::built_in(&scenario.target).is_none() {
                    make_absolute(&folder, &mut scenario.target);
                }
                Scenario::Docking(Box::new(scenario))
            }
        };
        Ok(Self { name, folder, scenario, file, text })
    }

    /// The same scenario with other values, from [`Scenario::to_json`], and another seed. `label` is what mistakes are told of.
    ///
    /// # Errors
    /// A [`Failure`] with the path of a value of the wrong type, or of one that there is not.
    pub fn with_values(&self, values: &Value, seed: u64, label: String) -> Result<Self, Failure> {
        fn typed<S: ScenarioFile>(text: &str, label: &str) -> Result<Box<S>, Failure> {
            S::parse(Path::new(label), text)
                .map(Box::new)
                .map_err(|error| Failure::Usage(format!("{label}: {}: {}", error.path, error.message)))
        }
        let unwritten = |error| Failure::Usage(format!("{label}: cannot be written: {error}"));
        let text = toml::to_string(&without_nulls(values)).map_err(unwritten)?;
        let mut scenario = match &self.scenario {
            Scenario::FarRange(_) => Scenario::FarRange(typed(&text, &label)?),
            Scenario::Docking(_) => Scenario::Docking(typed(&text, &label)?),
        };
        scenario.set_seed(seed);
        let text = match &scenario {
            Scenario::FarRange(scenario) => scenario.to_toml()?,
            Scenario::Docking(scenario) => scenario.to_toml()?,
        };
        Ok(Self { name: self.name.clone(), folder: self.folder.clone(), scenario, file: label.into(), text })
    }

    /// The far-range scenario that it is.
    ///
    /// # Errors
    /// [`Failure::Usage`] when it is of another world; `what` is what was meant to be done with it.
    pub fn far_range(&self, what: &str) -> Result<&FarRangeScenario, Failure> {
        match &self.scenario {
            Scenario::FarRange(scenario) => Ok(scenario),
            Scenario::Docking(_) => Err(self.other_world(what, World::FarRange)),
        }
    }

    /// The docking scenario that it is.
    ///
    /// # Errors
    /// As [`ScenarioSource::far_range`].
    pub fn docking(&self, what: &str) -> Result<&DockingScenario, Failure> {
        match &self.scenario {
            Scenario::FarRange(_) => Err(self.other_world(what, World::Docking)),
            Scenario::Docking(scenario) => Ok(scenario),
        }
    }

    fn other_world(&self, what: &str, expected: World) -> Failure {
        Failure::Usage(format!(
            "{what}: scenario `{}` is of another world, expected one of {expected}",
            self.name
        ))
    }

    /// The simulator of a far-range scenario; every value is checked.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn simulator(&self, scenario: &FarRangeScenario) -> Result<Simulator, Failure> {
        bounds::check(&scenario.star_list, "star_list").map_err(|error| self.out_of_range(error))?;
        self.check_part("far_range", scenario.far_range.check())?;
        Simulator::new(&scenario.simulation(), &self.folder).map_err(|error| self.explain(error))
    }

    /// Checks that the built-in pipeline can be run on the camera of a far-range scenario.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the parameter by which it cannot.
    pub fn check_built_in_pipeline(&self, scenario: &FarRangeScenario) -> Result<(), Failure> {
        let (floor_dn, bit_depth) = (scenario.zero_suppression_dn, scenario.sensor.bit_depth);
        self.check_part("far_range", scenario.far_range.check_suppression(floor_dn, bit_depth))
    }

    /// The simulator of a docking scenario; every value is checked, those of the target's file too.
    ///
    /// # Errors
    /// A [`Failure`] with the place of the first value that is not allowed.
    pub fn docking_simulator(&self, scenario: &DockingScenario) -> Result<DockingSimulator, Failure> {
        self.check_part("docking", scenario.docking.check())?;
        self.check_target(&scenario.target)?;
        DockingSimulator::new(&scenario.simulation(), &self.folder).map_err(|error| self.explain(error))
    }

    /// Checks the target's file, so that a mistake in it is told with its place there.
    fn check_target(&self, target: &str) -> Result<(), Failure> {
        if TargetFile::built_in(target).is_some() {
            return Ok(());
        }
        let file = self.folder.join(target);
        let text = toml_file::read_text(&file).map_err(|error| {
            let word = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
            let hint = toml_file::nearest(&word, TargetFile::built_in_names()).map_or_else(
                || {
                    format!(
                        "built-in targets: {}",
                        TargetFile::built_in_names().collect::<Vec<_>>().join(", ")
                    )
                },
                |name| format!("did you mean `{name}`?"),
            );
            let problem =
                format!("is neither a built-in target nor a TOML file that can be read ({error}); {hint}");
            self.refuse("target", format!("`{}` {problem}", file.display()))
        })?;
        let parsed: TargetFile = toml_file::parse(&file, &text)?;
        parsed.check().map_err(|error| toml_file::out_of_range(&file, &text, &error).into())
    }

    /// Gives a refused value its place in the file.
    fn explain(&self, error: SimError) -> Failure {
        match error {
            SimError::OutOfRange(error) => self.out_of_range(error),
            error => error.into(),
        }
    }

    /// What a pipeline says of its part of the scenario, the table `table`.
    fn check_part(&self, table: &str, checked: Result<(), OutOfRange>) -> Result<(), Failure> {
        checked.map_err(|error| self.out_of_range(error.under(table)))
    }

    fn out_of_range(&self, error: OutOfRange) -> Failure {
        toml_file::out_of_range(&self.file, &self.text, &error).into()
    }

    fn refuse(&self, path: &str, message: String) -> Failure {
        toml_file::refuse(&self.file, &self.text, path, message).into()
    }
}

/// The world that a file names at a dotted path; far range where it names none.
///
/// # Errors
/// A [`Failure`] with the place of a world that there is not. Text that is not TOML is left to the reader of the whole.
pub fn world(file: &Path, text: &str, path: &str) -> Result<World, Failure> {
    let Ok(table) = text.parse::<toml::Table>() else { return Ok(World::FarRange) };
    let steps: Vec<&str> = path.split('.').collect();
    let (last, tables) = steps.split_last().map_or((path, &[][..]), |(last, tables)| (*last, tables));
    let inner = tables.iter().try_fold(&table, |table, step| table.get(*step).and_then(|v| v.as_table()));
    match inner.and_then(|table| table.get(last)) {
        Some(toml::Value::String(word)) => {
            word.parse().map_err(|message| toml_file::refuse(file, text, path, message).into())
        }
        // Of another type: its place is told when the whole is read.
        _ => Ok(World::FarRange),
    }
}

/// So that run.toml can be run from anywhere.
fn make_absolute(folder: &Path, path: &mut String) {
    if let Ok(absolute) = std::path::absolute(folder.join(&*path)) {
        *path = absolute.to_string_lossy().into_owned();
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
