//! Reads a run directory or a study directory unit by unit.

use std::path::Path;

use config::toml_file;
use files::sha256::{hex, sha256_hex};
use files::{Checksums, Failure, FileError, file_sha256, table_sha256};
use run::{figure_by_name, navigation_of, world_of_run, worlds};
use scenario::AttitudeChoice;
use scenario::identity::split;
use scenario::run_file::RunFile;
use score::{FigureTerms, Reduction, Term, UnitTable, UnitVerdict};
use sha2::{Digest, Sha256};
use study::{CaseFigure, CaseTable, StudyRecord};
use toml::Table;

use crate::identity::{Identity, SourceKind};
use crate::sample::Sample;

/// Reads a run directory, or the directory of a complete study. The measurements of a run are scored anew,
/// centroids with `attitude` instead of the attitude that the run's scenario names.
///
/// # Errors
/// A [`Failure`] if the directory is neither a run nor a complete study, if files cannot be read, or if an
/// attitude is given for a study, whose cases are already scored.
pub fn read_result(directory: &Path, attitude: Option<AttitudeChoice>) -> Result<Sample, Failure> {
    let (run_file, cases) = (directory.join("run.toml"), directory.join("cases.parquet"));
    let sample = if run_file.is_file() {
        run(directory, &run_file, attitude)?
    } else if cases.is_file() {
        if attitude.is_some() {
            return Err(Failure::Usage(format!(
                "--attitude applies only to a run: the cases of {} are already scored, with [score] of their \
                 scenario",
                directory.display()
            )));
        }
        study(directory, &cases)?
    } else {
        return Err(Failure::Usage(format!(
            "{}: neither `run.toml` nor `cases.parquet` in it, expected the directory of a run or of a \
             complete study",
            directory.display()
        )));
    };
    Checksums::check(directory, |_| true)?;
    Ok(sample)
}

/// Returns the resolved scenario of a run from its `run.toml`.
fn scenario_of(path: &Path, text: &str) -> Result<Table, Failure> {
    let mut file: Table = toml_file::parse(path, text)?;
    match file.remove("scenario") {
        Some(toml::Value::Table(scenario)) => Ok(scenario),
        _ => Err(toml_file::refuse(path, text, "scenario", "is missing, expected a table".to_owned()).into()),
    }
}

fn run(directory: &Path, path: &Path, attitude: Option<AttitudeChoice>) -> Result<Sample, Failure> {
    let world = world_of_run(path)?;
    let RunFile { name, version, catalog_sha256, inject, files, mitsuba, scenario, .. } =
        world.read_run(path)?;
    let evidence = world.facts().evidence_file.map(|name| directory.join(name)).filter(|path| path.is_file());
    let scored =
        world.score(directory, &directory.join("measurements.csv"), evidence.as_deref(), attitude)?;
    let mut digest = FrameDigest::default();
    world.telemetry_rows(directory, &mut |row| digest.add(row))?;
    for (name, sha256) in truth_digests(&directory.join("truth"))? {
        digest.add(&(name, sha256));
    }
    let text = toml_file::read_text(path).map_err(|source| FileError::Io {
        path: path.to_owned(),
        doing: "read",
        source,
    })?;
    let mut scenario_table = scenario_of(path, &text)?;
    // The scoring settings are compared figure by figure: figures that do not depend on them remain
    // comparable.
    let score = scenario_table.remove("score");
    let warm_up = score.as_ref().and_then(|score| score.get("warm_up_frames")?.as_integer());
    let split = split(world.code(), scenario_table, &files)?;
    let identity = Identity {
        kind: SourceKind::Run,
        world: world.code().to_owned(),
        name,
        seed: scenario.seed(),
        version,
        catalog_sha256,
        inject: inject.map(|stage| stage.to_string()),
        renderer: mitsuba.map(|_| "mitsuba".to_owned()),
        warm_up_frames: warm_up.map_or(0, |frames| frames.max(0) as u64),
        scenario_sha256: split.scenario_sha256,
        frames_sha256: digest.finish(),
        pipeline: split.pipeline,
        scenario: split.scenario,
    };
    let mut units = scored.units();
    if let Some(navigation) = navigation_of(world.code()) {
        units.figures.extend((navigation.terms)(directory)?);
    }
    Ok(Sample::new(identity, units))
}

/// Returns the sorted names of all truth files, each with the digest of its content.
fn truth_digests(folder: &Path) -> Result<Vec<(String, String)>, Failure> {
    let unreadable = |source| FileError::io(folder, "read", source);
    let mut digests = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let sha256 = match path.extension() {
            _ if !path.is_file() || name.starts_with('.') => None,
            Some(extension) if extension == "parquet" => Some(table_sha256(&path)?),
            _ => file_sha256(&path)?,
        };
        digests.extend(sha256.map(|sha256| (name, sha256)));
    }
    digests.sort();
    Ok(digests)
}

fn study(directory: &Path, path: &Path) -> Result<Sample, Failure> {
    let record = StudyRecord::read(&directory.join("study.json"))?;
    let (table, _) = CaseTable::columns_of(path)?.read(path)?;
    let mut digest = FrameDigest::default();
    for row in &table.rows {
        digest.add(&(row.case, row.seed, &row.drawn));
    }
    let world = record.world;
    let granted = record.scenario.get("score").and_then(|score| score.get("attitude")?.as_str());
    let attitude = table.attitude(granted);
    let mut split = split(&world, record.scenario, &record.files)?;
    split.scenario = Table::from_iter([
        ("study".to_owned(), toml::Value::Table(record.study)),
        ("base".to_owned(), toml::Value::Table(split.scenario)),
    ]);
    let text = toml::to_string(&split.scenario)
        .map_err(|error| Failure::Usage(format!("the study cannot be written: {error}")))?;
    let identity = Identity {
        kind: SourceKind::Study,
        name: record.name,
        seed: record.seed,
        version: record.version,
        catalog_sha256: None,
        inject: None,
        renderer: None,
        // The warm-up frames of a study are in its definition or its scenario.
        warm_up_frames: 0,
        scenario_sha256: sha256_hex(&text),
        frames_sha256: digest.finish(),
        pipeline: split.pipeline,
        scenario: split.scenario,
        world,
    };
    Ok(Sample::new(identity, units_of_cases(&table, attitude.as_ref())))
}

/// Converts the cases of a study to units, with the study's own reductions: rates count all frames of all
/// cases, amounts are means over the cases. Cases of one draw, at the points of a sweep, form a group.
#[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
fn units_of_cases(table: &CaseTable, attitude: Option<&String>) -> UnitTable {
    let figure = |(index, name): (usize, &String)| {
        let figure = figure_by_name(name);
        let is_rate = figure.is_rate();
        let term = |figure: CaseFigure| match figure.value {
            _ if is_rate => Term { sum: figure.count as f64, count: figure.of as u32 },
            Some(sum) => Term { sum, count: 1 },
            None => Term::default(),
        };
        let reduction = if is_rate { Reduction::Rate } else { Reduction::Mean };
        let terms = table.rows.iter().map(|row| term(row.figures[index])).collect();
        FigureTerms::from_terms(name, reduction, terms).with_attitude(&figure, attitude)
    };
    let headlines: Vec<&str> = worlds().into_iter().map(|world| world.facts().headline).collect();
    let verdict = table.figures.iter().position(|name| headlines.contains(&name.as_str()));
    let units = table.rows.iter().zip(table.draws()).map(|(row, draw)| UnitVerdict {
        number: row.case,
        group: format!("draw {draw}"),
        verdict: verdict
            .map(|index| row.figures[index])
            .map_or_else(String::new, |figure| format!("{} of {}", figure.count, figure.of)),
        cause: None,
    });
    UnitTable { units: units.collect(), figures: table.figures.iter().enumerate().map(figure).collect() }
}

/// Digest of the data of all frames. Floating-point numbers are written with enough digits to restore the
/// same bits.
#[derive(Default)]
struct FrameDigest(Sha256);

impl FrameDigest {
    fn add(&mut self, row: &dyn std::fmt::Debug) {
        self.0.update(format!("{row:?}\n"));
    }

    fn finish(self) -> String {
        hex(self.0.finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rate counts all its frames, an amount has one value per case, and the verdict of a case is its
    /// number of correct frames.
    #[test]
    fn the_cases_of_a_study_are_units() {
        crate::hand_made::register_worlds();
        let figure = |value, count, of| CaseFigure { value, count, of };
        let table = CaseTable {
            drawn: indexmap::IndexMap::new(),
            figures: ["correct_rate", "ra_rms_deg"].map(str::to_owned).to_vec(),
            causes: Vec::new(),
            rows: vec![
                study::CaseRow {
                    case: 0,
                    seed: 3,
                    has_failed: false,
                    error: None,
                    frames: 40,
                    drawn: Vec::new(),
                    causes: Vec::new(),
                    figures: vec![figure(Some(0.75), 30, 40), figure(Some(0.5), 30, 30)],
                },
                study::CaseRow {
                    case: 1,
                    seed: 4,
                    has_failed: false,
                    error: None,
                    frames: 40,
                    drawn: Vec::new(),
                    causes: Vec::new(),
                    figures: vec![figure(Some(0.0), 0, 40), figure(None, 0, 0)],
                },
            ],
        };
        let units = units_of_cases(&table, Some(&"own".to_owned()));
        assert_eq!(units.units[0].verdict, "30 of 40");
        assert_eq!([0, 1].map(|unit| &*units.units[unit].group), ["draw 0", "draw 1"]);
        assert_eq!(units.figures[0].terms, [Term { sum: 30.0, count: 40 }, Term { sum: 0.0, count: 40 }]);
        assert_eq!(units.figures[1].terms, [Term { sum: 0.5, count: 1 }, Term::default()]);
        assert_eq!(units.figures[0].attitude, None);
        assert_eq!(units.figures[1].attitude.as_deref(), Some("own"));
        assert_eq!(table.attitude(Some("true")), None, "the figure is not recorded");
    }
}
