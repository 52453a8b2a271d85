//! A study that was read and checked, and the scenarios of its cases.

pub(crate) mod design;
pub(crate) mod distribution;
pub(crate) mod file;
pub(crate) mod overlay;
pub(crate) mod sobol;
mod source;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use config::toml_file;
use draws::{Effect, Seed};
use files::sha256::hex;
use files::{Failure, file_sha256};
use indexmap::IndexMap;
use run::{AnyScenario, Options, ScenarioSource, navigation_of};
use scenario::run_file::{FileDigests, content};
use score::navigation_figures;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::cases::{CaseTable, DrawnValue};
use crate::definition::design::Design;
use crate::definition::distribution::{Distribution, PreparedDistribution, boresight, euler_123};
use crate::definition::file::StudyFile;
use crate::definition::overlay::ValuePath;
use crate::definition::source::{StudySource, SweptParameter, VariedParameter};
use crate::findings::requirement::fraction_words;

/// Largest half width of a rate's interval in a stopping rule; any interval is narrower than a wider one.
const MAX_RATE_HALF_WIDTH: f64 = 0.5;

/// A study that was read and checked.
pub struct Study {
    /// Name of the study: its file name without the extension.
    pub name: String,
    /// Content of the study file.
    pub file: StudyFile,
    /// Scenario from which the cases are derived.
    base: ScenarioSource,
    base_values: Value,
    vary: Vec<VariedParameter>,
    sweep: Vec<SweptParameter>,
    design: Design,
    path: PathBuf,
    text: String,
    identity: StudyFile,
    hash: String,
}

/// A case of a study, with its scenario.
#[derive(Debug, Clone)]
pub struct Case {
    /// Number of the case.
    pub number: u64,
    /// Seed of the case's scenario.
    pub seed: u64,
    /// Drawn values, in the order of [`Study::drawn_columns`].
    pub drawn: Vec<DrawnValue>,
    /// Scenario of the case.
    pub source: ScenarioSource,
}

/// Number of first cases that cannot be run after which a study ends.
pub(crate) const MAX_FAILED_CASES: u64 = 10;

/// Values drawn for a case.
pub(crate) struct DrawnCase {
    pub(crate) number: u64,
    pub(crate) seed: u64,
    pub(crate) drawn: Vec<DrawnValue>,
    /// Scenario with the drawn values.
    values: Value,
}

impl Study {
    /// Returns the attitude that the scenario grants to measurements with a centroid only.
    pub(crate) fn granted_attitude(&self) -> Option<&str> {
        self.base_values.get("score")?.get("attitude")?.as_str()
    }

    /// Returns the number of first frames of every case that count in no figure.
    pub(crate) fn warm_up_frames(&self) -> u64 {
        self.base_values.pointer("/score/warm_up_frames").and_then(Value::as_u64).unwrap_or(0)
    }

    /// Reads and checks a study and its scenario. The first case is also created, to find an invalid path or
    /// a value of the wrong type before anything runs.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = toml_file::read_text(path)
            .map_err(|error| Failure::Usage(format!("study `{}` cannot be read: {error}", path.display())))?;
        let file: StudyFile = toml_file::parse(path, &text)?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let source = StudySource { file: &file, path, text: &text, folder: &folder };

        let (mut base, base_values) = source.base()?;
        let identity = identity(&file, &folder, &mut base)?;
        let mut taken = Vec::new();
        let vary = source.varied_parameters(&base_values, &mut taken)?;
        let sweep = source.swept_parameters(&mut taken)?;
        let points = source.sweep_points(&sweep)?;
        source.check_limits()?;
        source.check_design(&sweep, points)?;
        let design = source.design(points)?;

        let name =
            path.file_stem().map_or_else(|| "study".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let mut study = Self {
            name,
            file,
            base,
            base_values,
            vary,
            sweep,
            design,
            path: path.to_owned(),
            text,
            identity,
            hash: String::new(),
        };
        study.hash = study.make_hash()?;
        study.check_cases()?;
        Ok(study)
    }

    /// Checks the study against its scenario and its first case.
    fn check_cases(&self) -> Result<(), Failure> {
        let world = self.scenario().world();
        if self.file.navigate.is_some() && navigation_of(world.code()).is_none() {
            let message = format!("the world {} of the scenario has no relative navigation", world.code());
            return Err(self.refuse("navigate", message));
        }
        self.check_names()?;
        let frames = self.frames(self.first_frame_count()?)?;
        let count = frames.end - frames.start;
        let warm_up = self.warm_up_frames();
        if warm_up >= count {
            let message = format!("is {warm_up}, expected fewer than the {count} frames of a case");
            return Err(self.refuse("warm_up_frames", message));
        }
        Ok(())
    }

    /// Returns the number of frames of the first case that can be run, among the first ten.
    ///
    /// # Errors
    /// The [`Failure`] of the first case if none of them can be run.
    fn first_frame_count(&self) -> Result<u64, Failure> {
        let count = |number| Ok(self.case(number)?.source.prepare(Options::default())?.frame_count());
        let first = count(0);
        (1..self.cases().min(MAX_FAILED_CASES)).fold(first, |found, number| match found {
            Err(failure @ (Failure::Toml(_) | Failure::Simulation(_) | Failure::Contract(_))) => {
                count(number).map_err(|_: Failure| failure)
            }
            found => found,
        })
    }

    /// Returns the largest number of cases.
    pub fn cases(&self) -> u64 {
        self.file.stop.cases
    }

    /// Returns the number of successive cases that form one group, from the first case on: the cases of a
    /// draw at every point of the sweep, or, in a replicated design, all cases of a replication. Different
    /// groups are independent.
    pub(crate) fn cases_together(&self) -> u64 {
        match self.file.replications {
            1 => self.sweep_points(),
            replications => (self.cases() / replications).max(1),
        }
    }

    /// Returns the number of points of the sweep: this many first cases cover each point once.
    pub(crate) fn sweep_points(&self) -> u64 {
        self.sweep.iter().map(|swept| swept.values.len() as u64).product()
    }

    /// Checks that the built-in pipeline can run on the cameras of the sweep, at its first thousand points.
    ///
    /// # Errors
    /// A [`Failure`] with the location, in the case's scenario, of the parameter that prevents this.
    pub fn check_built_in_pipeline(&self) -> Result<(), Failure> {
        const MAX_POINTS: u64 = 1000;
        for number in 0..self.sweep_points().min(self.cases()).min(MAX_POINTS) {
            // A case without a valid scenario has a row with the error.
            if let Ok(Case { source, .. }) = self.case(number) {
                source.world().check_built_in(&source)?;
            }
        }
        Ok(())
    }

    /// Returns cases at the limits of the design: for every parameter that varies, the cases with its
    /// smallest and largest value among all cases (of the first 100,000 draws); for a choice, one case per
    /// value; all of these at the first and the last point of the sweep; and every point of the sweep once.
    /// At most a thousand, in order.
    pub fn extremes(&self) -> BTreeSet<u64> {
        const MAX_DRAWS: u64 = 100_000;
        const MAX_CASES: usize = 1000;
        let points = self.sweep_points();
        let draws = (self.cases() / points).min(MAX_DRAWS);
        let mut found = BTreeSet::from([0]);
        let mut ends: Vec<Option<[(f64, u64); 2]>> = Vec::new();
        let mut chosen = BTreeSet::new();
        for draw in 0..draws {
            let unit = self.design.point(draw);
            ends.resize(unit.len(), None);
            for (end, &u) in ends.iter_mut().zip(&unit) {
                let [low, high] = end.get_or_insert([(u, draw); 2]);
                // Values increase or decrease with the quantile: the ends are the same.
                *low = if u < low.0 { (u, draw) } else { *low };
                *high = if u > high.0 { (u, draw) } else { *high };
            }
            let mut unit = unit.iter().copied();
            for (place, varied) in self.vary.iter().enumerate() {
                let u: Vec<f64> = unit
                    .by_ref()
                    .take(
                        self.file
                            .vary
                            .get(place)
                            .map_or(1, |dispersion| dispersion.distribution.dimensions()),
                    )
                    .collect();
                let is_choice = matches!(
                    varied.distribution,
                    PreparedDistribution::Distribution(Distribution::Choice { .. })
                );
                let value =
                    u.first().filter(|_| is_choice).map(|u| varied.distribution.value(*u).to_string());
                if value.is_some_and(|value| chosen.insert((place, value))) {
                    found.insert(draw);
                }
            }
        }
        found.extend(ends.into_iter().flatten().flatten().map(|(_, draw)| draw));
        let at_ends = found.into_iter().flat_map(|draw| [draw * points, draw * points + points - 1]);
        (0..points).chain(at_ends).take(MAX_CASES).collect()
    }

    /// Returns the SHA-256 of everything that the rows depend on, except the pipeline: the study, its
    /// scenario, and the content of the files that these read; hexadecimal.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Returns the study file with the content of every file (`sha256:` and the digits) in place of the
    /// file's path, and without the path of its scenario.
    pub(crate) fn identity(&self) -> &StudyFile {
        &self.identity
    }

    /// Returns the SHA-256 of each file that the scenario reads, by the role of the file.
    ///
    /// # Errors
    /// The errors of [`ScenarioSource::files`].
    pub(crate) fn files(&self) -> Result<FileDigests, Failure> {
        self.base.files()
    }

    /// Returns the files that the study reads: the study file, its scenario file if it has one, and the files
    /// that cases read.
    pub fn files_read(&self) -> Vec<PathBuf> {
        let scenario = self.scenario_file();
        let own = [self.path.as_path(), scenario.as_path()];
        own.into_iter()
            .chain(self.base.known_files())
            .filter(|file| file.is_file())
            .map(Path::to_path_buf)
            .collect()
    }

    /// Returns the path of the scenario file; no file exists there for a built-in scenario.
    pub fn scenario_file(&self) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(&self.file.scenario)
    }

    /// Returns the scenario from which the cases are derived.
    pub fn scenario(&self) -> &AnyScenario {
        &self.base.scenario
    }

    /// Returns the frames of every case, for a scenario with `count` frames.
    ///
    /// # Errors
    /// A [`Failure`] with the location of a range that the scenario does not have.
    pub fn frames(&self, count: u64) -> Result<Range<u64>, Failure> {
        let Some(text) = &self.file.frames else { return Ok(0..count) };
        let range = text
            .split_once("..")
            .and_then(|(from, to)| Some(from.trim().parse::<u64>().ok()?..to.trim().parse::<u64>().ok()?));
        match range.filter(|range| range.start < range.end && range.end <= count) {
            Some(range) => Ok(range),
            None => {
                let message = format!(
                    "is `{text}`, expected A..B with A < B, within the {count} frames of the scenario"
                );
                Err(self.refuse("frames", message))
            }
        }
    }

    /// Creates the failure for a mistake in the study file.
    pub(crate) fn refuse(&self, at: &str, message: String) -> Failure {
        toml_file::refuse(&self.path, &self.text, at, message).into()
    }

    /// Returns the names of the drawn values, each with true if its values are numbers: swept parameters
    /// first, then varying ones.
    pub fn drawn_columns(&self) -> IndexMap<String, bool> {
        let mut columns = IndexMap::new();
        for swept in &self.sweep {
            columns.insert(swept.path.text().to_owned(), swept.values.iter().all(Value::is_number));
        }
        for varied in &self.vary {
            match (&varied.angles, &varied.distribution) {
                (Some(angles), _) => {
                    columns.extend(angles.iter().map(|angle| (angle.text().to_owned(), true)));
                }
                (None, PreparedDistribution::Distribution(Distribution::Choice { values, .. })) => {
                    columns.insert(varied.path.text().to_owned(), values.iter().all(Value::is_number));
                }
                (None, _) => {
                    columns.insert(varied.path.text().to_owned(), true);
                }
            }
        }
        columns
    }

    /// Returns a table of this study without rows.
    pub fn table(&self) -> CaseTable {
        let causes = self.scenario().world().causes();
        CaseTable {
            drawn: self.drawn_columns(),
            figures: self.figures(),
            causes: causes.iter().map(|(verdict, cause)| format!("{verdict}.{cause}")).collect(),
            rows: Vec::new(),
        }
    }

    /// Returns the names of the recorded figures.
    pub fn figures(&self) -> Vec<String> {
        self.file.record.figures.clone().unwrap_or_else(|| self.known_figures())
    }

    /// Returns the names of the figures that a case has: those of the score, then those of the navigation if
    /// the study navigates.
    fn known_figures(&self) -> Vec<String> {
        let navigation = self.file.navigate.iter().flat_map(|_| navigation_figures());
        let of_score = self.scenario().world().figure_names().into_iter();
        of_score.chain(navigation.map(|figure| figure.name)).collect()
    }

    /// Returns the figure that ranks cases from good to bad.
    pub fn worst_by(&self) -> String {
        let headline = || self.scenario().world().facts().headline.to_owned();
        self.file.record.worst_by.clone().unwrap_or_else(headline)
    }

    /// Returns a case, which depends only on its number and the study.
    ///
    /// # Errors
    /// A [`Failure`] when the drawn values do not form a valid scenario, with the location of the value in
    /// the case's scenario.
    pub fn case(&self, number: u64) -> Result<Case, Failure> {
        self.prepare_case(self.draw(number)?)
    }

    /// Returns the case of a draw, with its scenario.
    ///
    /// # Errors
    /// The errors of [`Study::case`].
    pub(crate) fn prepare_case(
        &self,
        DrawnCase { number, seed, drawn, values }: DrawnCase,
    ) -> Result<Case, Failure> {
        let name = format!("{}, case {number}", self.path.display());
        Ok(Case { number, seed, drawn, source: self.base.with_values(&values, seed, name)? })
    }

    /// Draws the values of a case.
    ///
    /// # Errors
    /// A [`Failure`] for a path that does not exist in the scenario.
    pub(crate) fn draw(&self, number: u64) -> Result<DrawnCase, Failure> {
        let cells = self.sweep_points();
        let (mut cell, replicate) = (number % cells, number / cells);
        let mut values = self.base_values.clone();
        let mut drawn = Vec::new();
        for (i, swept) in self.sweep.iter().enumerate().rev() {
            let count = swept.values.len() as u64;
            // Every sweep has a value, as checked when the study was read.
            let value = swept.values.get((cell % count) as usize).cloned().unwrap_or_default();
            cell /= count;
            drawn.insert(0, recorded(&value));
            let at = format!("sweep[{i}].path");
            swept
                .path
                .set(&mut values, value)
                .map_err(|expected| self.refuse_path(&at, &swept.path, &expected))?;
        }
        let point = self.design.point(replicate);
        let mut u = point.iter().copied();
        for (i, varied) in self.vary.iter().enumerate() {
            let at = format!("vary[{i}].path");
            let mut set = |path: &ValuePath, value: Value| {
                drawn.push(recorded(&value));
                path.set(&mut values, value).map_err(|expected| self.refuse_path(&at, path, &expected))
            };
            if let Some(angles) = &varied.angles {
                let unit = [0; 3].map(|_: i32| u.next().unwrap_or(0.5));
                let drawn = if varied.is_euler { euler_123(unit) } else { boresight(unit) };
                for (path, angle) in angles.iter().zip(drawn) {
                    set(path, Value::from(angle))?;
                }
            } else {
                set(&varied.path, varied.distribution.value(u.next().unwrap_or(0.5)))?;
            }
        }
        // The seed is the same at every point of a sweep. It has one bit less, because TOML's integers are
        // signed.
        let seed = Seed { seed: self.file.seed, case: replicate }.streams(0, Effect::CaseSeed).word(0) >> 1;
        Ok(DrawnCase { number, seed, drawn, values })
    }

    fn refuse_path(&self, at: &str, path: &ValuePath, expected: &str) -> Failure {
        self.refuse(at, format!("is `{}`, expected {expected}", path.text()))
    }

    /// Checks that all named figures exist and are recorded.
    fn check_names(&self) -> Result<(), Failure> {
        let known = self.known_figures();
        let check = |at: &str, name: &str| {
            if known.iter().any(|figure| figure == name) {
                return Ok(());
            }
            let hint = toml_file::nearest(name, known.iter().map(String::as_str))
                .map_or_else(|| known.join(", "), |name| format!("did you mean `{name}`?"));
            Err(self.refuse(at, format!("is `{name}`, expected a figure of the score; {hint}")))
        };
        let recorded = self.file.record.figures.iter().flatten();
        for (i, name) in recorded.enumerate() {
            check(&format!("record.figures[{i}]"), name)?;
        }
        check("record.worst_by", &self.worst_by())?;
        if let Some(until) = &self.file.stop.until {
            check("stop.until.figure", &until.figure)?;
        }
        let required = self.file.require.iter().enumerate();
        let required: Vec<(String, &str)> =
            required.map(|(i, r)| (format!("require[{i}].figure"), r.figure.as_str())).collect();
        for (at, name) in &required {
            check(at, name)?;
        }
        for (i, requirement) in self.file.require.iter().enumerate() {
            let has_unit = requirement.check_unit();
            has_unit.map_err(|(field, message)| self.refuse(&format!("require[{i}].{field}"), message))?;
        }
        if let Some(until) = &self.file.stop.until
            && run::figure_by_name(&until.figure).is_rate()
            && until.half_width > MAX_RATE_HALF_WIDTH
        {
            let message = fraction_words(&until.figure, until.half_width, MAX_RATE_HALF_WIDTH);
            return Err(self.refuse("stop.until.half_width", message));
        }
        let recorded = self.figures();
        let worst_by = self.worst_by();
        let until = self.file.stop.until.iter().map(|until| ("stop.until.figure", until.figure.as_str()));
        let named = [("record.worst_by", worst_by.as_str())].into_iter().chain(until);
        for (at, name) in named.chain(required.iter().map(|(at, name)| (at.as_str(), *name))) {
            if !recorded.iter().any(|figure| figure == name) {
                return Err(self.refuse(at, format!("is `{name}`, expected one of record.figures")));
            }
        }
        Ok(())
    }

    fn make_hash(&self) -> Result<String, Failure> {
        let mut hash = Sha256::new();
        hash.update(serde_json::to_string(&self.identity).map_err(unwritable)?);
        hash.update(serde_json::to_string(&self.base.identity().to_json()?).map_err(unwritable)?);
        hash.update(env!("CARGO_PKG_VERSION"));
        Ok(hex(hash.finalize()))
    }
}

/// Computes [`Study::identity`] of a file. Files named in its values are recorded in `base`: a case later
/// rejects a file that changed.
fn identity(file: &StudyFile, folder: &Path, base: &mut ScenarioSource) -> Result<StudyFile, Failure> {
    let mut identity = file.clone();
    identity.require.clear();
    if scenario::BUILT_IN.iter().all(|built_in| built_in.name != file.scenario) {
        identity.scenario.clear();
    }
    for dispersion in &mut identity.vary {
        match &mut dispersion.distribution {
            Distribution::Table { path, .. } => {
                if let Some(sha256) = file_sha256(&folder.join(&*path))? {
                    *path = content(&sha256);
                }
            }
            Distribution::Choice { values, .. } => {
                values.iter_mut().for_each(|value| replace_paths(value, base))
            }
            _ => {}
        }
    }
    let swept = identity.sweep.iter_mut().flat_map(|sweep| &mut sweep.values);
    swept.for_each(|value| replace_paths(value, base));
    Ok(identity)
}

/// Replaces every text that is the path of a file by the content of the file, with paths resolved as in the
/// scenario.
fn replace_paths(value: &mut Value, base: &mut ScenarioSource) {
    match value {
        Value::String(text) => {
            if let Some(sha256) = base.note_file(text) {
                *text = content(sha256);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| replace_paths(value, base)),
        Value::Object(members) => members.values_mut().for_each(|value| replace_paths(value, base)),
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

/// Converts a value to its form in a table.
fn recorded(value: &Value) -> DrawnValue {
    match (value, value.as_f64()) {
        (_, Some(number)) => DrawnValue::Number(number),
        (Value::String(text), _) => DrawnValue::Text(text.clone()),
        (other, _) => DrawnValue::Text(other.to_string()),
    }
}

fn unwritable(error: serde_json::Error) -> Failure {
    Failure::Usage(format!("the study cannot be written as JSON: {error}"))
}
