//! A study's file, checked step by step: its scenario, the dispersed and the swept parameters, the design.

use std::path::Path;

use config::toml_file;
use contract::{OutOfRange, bounds};
use files::Failure;
use run::ScenarioSource;
use serde_json::{Value, json};

use super::design::{Design, DesignKind};
use super::distribution::{Distribution, PreparedDistribution};
use super::file::StudyFile;
use super::overlay::ValuePath;

/// Largest number of replications of a design.
const MAX_REPLICATIONS: u64 = 10_000;

/// Keys of a scenario that cannot be varied.
const NOT_VARIED: [&str; 4] = ["title", "world", "seed", "score"];

/// Names of the angles of an attitude given as a boresight; [`EULER_123`] has those of one given as Euler
/// angles.
const BORESIGHT: [&str; 3] = ["ra_deg", "dec_deg", "roll_deg"];
const EULER_123: [&str; 3] = ["phi_deg", "theta_deg", "psi_deg"];

/// A parameter with its distribution, ready to be drawn.
pub(super) struct VariedParameter {
    pub(super) path: ValuePath,
    pub(super) distribution: PreparedDistribution,
    /// Paths of the three angles; only for an attitude.
    pub(super) angles: Option<[ValuePath; 3]>,
    pub(super) is_euler: bool,
}

/// A parameter with the values of its sweep.
pub(super) struct SweptParameter {
    pub(super) path: ValuePath,
    pub(super) values: Vec<Value>,
}

/// Text of a study with its parsed file, while it is checked.
pub(super) struct StudySource<'a> {
    pub(super) file: &'a StudyFile,
    pub(super) path: &'a Path,
    pub(super) text: &'a str,
    /// Folder of the file, to which its paths are relative.
    pub(super) folder: &'a Path,
}

impl StudySource<'_> {
    /// Returns the error for the value of a key.
    fn refuse(&self, key: &str, message: String) -> Failure {
        toml_file::refuse(self.path, self.text, key, message).into()
    }

    fn refuse_range(&self, error: &OutOfRange) -> Failure {
        toml_file::out_of_range(self.path, self.text, error).into()
    }

    /// Returns the scenario, and its values with the warm-up frames of the study.
    pub(super) fn base(&self) -> Result<(ScenarioSource, Value), Failure> {
        let is_built_in = scenario::BUILT_IN.iter().any(|built_in| built_in.name == self.file.scenario);
        let word = if is_built_in {
            self.file.scenario.clone()
        } else {
            self.folder.join(&self.file.scenario).to_string_lossy().into_owned()
        };
        let base = match ScenarioSource::read(&word) {
            Err(Failure::Usage(message)) => return Err(self.refuse("scenario", message)),
            other => other?,
        };
        let mut values = base.scenario.to_json()?;
        if let (Some(frames), Some(table)) = (self.file.warm_up_frames, values.as_object_mut())
            && let Value::Object(score) = table.entry("score").or_insert_with(|| json!({}))
        {
            score.insert("warm_up_frames".to_owned(), frames.into());
        }
        Ok((base, values))
    }

    /// Returns the dispersed parameters; their paths are added to `taken`.
    pub(super) fn varied_parameters(
        &self,
        base_values: &Value,
        taken: &mut Vec<ValuePath>,
    ) -> Result<Vec<VariedParameter>, Failure> {
        let mut varied_parameters = Vec::new();
        for (i, dispersion) in self.file.vary.iter().enumerate() {
            let at = |field: &str| format!("vary[{i}].{field}");
            if let Distribution::Choice { values, .. } = &dispersion.distribution {
                check_finite(values).map_err(|(k, message)| {
                    self.refuse(&at(&format!("distribution.values[{k}]")), message)
                })?;
            }
            dispersion.distribution.check(&at("distribution")).map_err(|error| self.refuse_range(&error))?;
            let varied =
                VariedParameter::new(&dispersion.path, &dispersion.distribution, self.folder, base_values)
                    .map_err(|(field, message)| self.refuse(&at(field), message))?;
            check_free(taken, &varied.path).map_err(|message| self.refuse(&at("path"), message))?;
            varied_parameters.push(varied);
        }
        Ok(varied_parameters)
    }

    /// Returns the swept parameters; their paths are added to `taken`.
    pub(super) fn swept_parameters(
        &self,
        taken: &mut Vec<ValuePath>,
    ) -> Result<Vec<SweptParameter>, Failure> {
        let mut sweep = Vec::new();
        for (i, swept) in self.file.sweep.iter().enumerate() {
            let at = |field: &str| format!("sweep[{i}].{field}");
            let value_path = ValuePath::parse(&swept.path).map_err(|expected| {
                self.refuse(&at("path"), format!("is `{}`, expected {expected}", swept.path))
            })?;
            check_free(taken, &value_path).map_err(|message| self.refuse(&at("path"), message))?;
            if swept.values.is_empty() {
                return Err(self.refuse(&at("values"), "is [], expected at least one value".to_owned()));
            }
            check_finite(&swept.values)
                .map_err(|(k, message)| self.refuse(&at(&format!("values[{k}]")), message))?;
            sweep.push(SweptParameter { path: value_path, values: swept.values.clone() });
        }
        Ok(sweep)
    }

    /// Returns the number of points of the sweep.
    pub(super) fn sweep_points(&self, sweep: &[SweptParameter]) -> Result<u64, Failure> {
        let mut points: u64 = 1;
        for swept in sweep {
            points = points.checked_mul(swept.values.len() as u64).ok_or_else(|| {
                let message = "has 2^64 combinations or more, expected at most the number of cases";
                self.refuse("sweep", message.to_owned())
            })?;
        }
        Ok(points)
    }

    /// Checks the ranges of `stop` and of the requirements.
    pub(super) fn check_limits(&self) -> Result<(), Failure> {
        bounds::check(&self.file.stop, "stop").map_err(|error| self.refuse_range(&error))?;
        for (i, requirement) in self.file.require.iter().enumerate() {
            let at = format!("require[{i}]");
            bounds::check(requirement, &at).map_err(|error| self.refuse_range(&error))?;
            if let Err((field, message)) = requirement.limit() {
                return Err(self.refuse(&format!("{at}.{field}"), message.to_owned()));
            }
        }
        Ok(())
    }

    /// Checks that the design, its replications and the stopping rule fit the sweep of `points` points.
    pub(super) fn check_design(&self, sweep: &[SweptParameter], points: u64) -> Result<(), Failure> {
        let (cases, design, replications) = (self.file.stop.cases, self.file.design, self.file.replications);
        if !cases.is_multiple_of(points) {
            let message = format!("is {cases}, expected a multiple of the sweep's {points}");
            return Err(self.refuse("stop.cases", message));
        }
        if design == DesignKind::Saltelli && !sweep.is_empty() {
            return Err(self.refuse("design", "is saltelli, expected another design, or no sweep".to_owned()));
        }
        if !(1..=MAX_REPLICATIONS).contains(&replications) {
            let message = format!("is {replications}, expected 1 to {MAX_REPLICATIONS}");
            return Err(self.refuse("replications", message));
        }
        if replications > 1 && !matches!(design, DesignKind::LatinHypercube | DesignKind::Sobol) {
            let message = format!(
                "is {replications}, expected 1; only the designs latin_hypercube and sobol have replications"
            );
            return Err(self.refuse("replications", message));
        }
        if !(cases / points).is_multiple_of(replications) {
            let message = format!(
                "is {cases}, expected a multiple of {}: {replications} replications at the {points} points of the sweep",
                replications.saturating_mul(points)
            );
            return Err(self.refuse("stop.cases", message));
        }
        if self.file.stop.until.is_some() && design != DesignKind::Random {
            let message = "applies only to the random design: the cases of other designs form one unit";
            return Err(self.refuse("stop.until", message.to_owned()));
        }
        Ok(())
    }

    /// Returns the positions of the cases' draws.
    pub(super) fn design(&self, points: u64) -> Result<Design, Failure> {
        let cases = self.file.stop.cases;
        let dimensions = self.file.vary.iter().map(|dispersion| dispersion.distribution.dimensions()).sum();
        let draws = cases / points / self.file.replications;
        Design::new(self.file.design, dimensions, draws, self.file.seed)
            .map_err(|expected| self.refuse("stop.cases", format!("is {cases}, expected {expected}")))
    }
}

impl VariedParameter {
    fn new(path: &str, distribution: &Distribution, folder: &Path, base: &Value) -> Result<Self, Problem> {
        let value_path = ValuePath::parse(path)
            .map_err(|expected| ("path", format!("is `{path}`, expected {expected}")))?;
        let mut varied = Self {
            distribution: distribution
                .load(folder)
                .map_err(|error| ("distribution.path", error.to_string()))?,
            path: value_path,
            angles: None,
            is_euler: false,
        };
        if *distribution == Distribution::IsotropicAttitude {
            let table = varied.path.get(base);
            let has = |names: [&str; 3]| names.iter().all(|name| table.and_then(|t| t.get(name)).is_some());
            let names = if has(BORESIGHT) {
                BORESIGHT
            } else if has(EULER_123) {
                varied.is_euler = true;
                EULER_123
            } else {
                let message = format!(
                    "is `{path}`, expected a table of the scenario with the keys {}, or {}",
                    BORESIGHT.join(", "),
                    EULER_123.join(", ")
                );
                return Err(("path", message));
            };
            let angle = |name: &str| ValuePath::parse(&format!("{path}.{name}"));
            let [Ok(a), Ok(b), Ok(c)] = names.map(angle) else {
                return Err(("path", format!("is `{path}`, expected the path of a table")));
            };
            varied.angles = Some([a, b, c]);
        }
        Ok(varied)
    }
}

/// Field of an entry that is wrong, and the reason.
type Problem = (&'static str, String);

/// Rejects non-finite numbers: values are stored as JSON, which has null for them.
fn check_finite(values: &[Value]) -> Result<(), (usize, String)> {
    let message = || "is not finite, expected a finite number, or a value of another type".to_owned();
    values.iter().position(Value::is_null).map_or(Ok(()), |place| Err((place, message())))
}

fn check_free(taken: &mut Vec<ValuePath>, path: &ValuePath) -> Result<(), String> {
    if path.text().split('.').next().is_some_and(|first| NOT_VARIED.contains(&first)) {
        return Err(format!(
            "is `{}`, expected a parameter of the simulation or of the pipeline: seeds already differ \
             between cases, and all cases are scored with the same settings",
            path.text()
        ));
    }
    if let Some(other) = taken.iter().find(|other| other.overlaps(path)) {
        return Err(format!(
            "is `{}`, which overlaps `{}`, also set; expected separate paths",
            path.text(),
            other.text()
        ));
    }
    taken.push(path.clone());
    Ok(())
}
