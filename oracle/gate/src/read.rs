//! A result: a run directory or a study's, read unit by unit.

use std::path::Path;

use contract::docking::Digitiser;
use files::sha256::{hex, sha256_hex};
use files::{
    Checksums, Failure, FieldRow, FileError, TableReader, TelemetryRow, read_field_telemetry, read_telemetry,
    toml_file,
};
use run::{Prepared, PreparedDocking, Scored, World as _};
use scenario::run_file::RunFile;
use scenario::{DockingScenario, FarRangeScenario, World, world};
use score::{FigureTerms, Kind, Reduction, Term, UnitTable, UnitVerdict, names, sense};
use sha2::{Digest, Sha256};
use sim::docking::FieldTruth;
use sim::truth::FrameTruth;
use study::{CaseFigure, CaseTable, StudyRecord};
use toml::Table;

use super::identity::{Identity, SourceKind, split};
use super::sample::Sample;

/// Reads a run directory (its measurements are scored anew), or the directory of a study that is complete.
///
/// # Errors
/// A [`Failure`] for a directory that is neither, or files that cannot be read.
pub fn read_result(directory: &Path) -> Result<Sample, Failure> {
    let (run_file, cases) = (directory.join("run.toml"), directory.join("cases.parquet"));
    let sample = if run_file.is_file() {
        let text = read_text(&run_file)?;
        match world(&run_file, &text, "scenario.world")? {
            World::FarRange => far_range(directory, &run_file, &text)?,
            World::Docking => docking(directory, &run_file, &text)?,
        }
    } else if cases.is_file() {
        study(directory, &cases)?
    } else {
        return Err(Failure::Usage(format!(
            "{}: there is neither `run.toml` nor `cases.parquet`, expected the directory of a run or of a study that is complete",
            directory.display()
        )));
    };
    Checksums::check(directory, |_| true)?;
    Ok(sample)
}

fn read_text(path: &Path) -> Result<String, Failure> {
    Ok(toml_file::read_text(path).map_err(|source| FileError::Io {
        path: path.to_owned(),
        doing: "read",
        source,
    })?)
}

/// The resolved scenario of a run, as its file holds it.
fn scenario_of(path: &Path, text: &str) -> Result<Table, Failure> {
    let mut file: Table = toml_file::parse(path, text)?;
    match file.remove("scenario") {
        Some(toml::Value::Table(scenario)) => Ok(scenario),
        _ => Err(toml_file::refuse(path, text, "scenario", "is missing, expected a table".to_owned()).into()),
    }
}

fn far_range(directory: &Path, path: &Path, text: &str) -> Result<Sample, Failure> {
    let run_file = RunFile::<FarRangeScenario>::read(path)?;
    let clusters = Some(directory.join("clusters.parquet")).filter(|path| path.is_file());
    let scored = Prepared::score_files(directory, &directory.join("measurements.csv"), clusters.as_deref())?;
    let mut digest = FrameDigest::default();
    for TelemetryRow { frame, telemetry, windows, .. } in read_telemetry(&directory.join("telemetry.csv"))? {
        digest.add(&(frame, telemetry, windows));
    }
    for frame in TableReader::<FrameTruth>::open(&directory.join("truth/frames.parquet"))? {
        frame?.1.iter().for_each(|truth| digest.add(truth));
    }
    let split = split("far_range", scenario_of(path, text)?)?;
    let identity = Identity {
        kind: SourceKind::Run,
        world: "far_range".to_owned(),
        name: run_file.name,
        seed: run_file.scenario.seed,
        version: run_file.version,
        catalog_sha256: run_file.catalog_sha256,
        inject: run_file.inject.map(|stage| stage.to_string()),
        renderer: None,
        scenario_sha256: split.scenario_sha256,
        frames_sha256: digest.finish(),
        pipeline: split.pipeline,
        scenario: split.scenario,
    };
    Ok(Sample::new(identity, scored.units()))
}

fn docking(directory: &Path, path: &Path, text: &str) -> Result<Sample, Failure> {
    let run_file = RunFile::<DockingScenario>::read(path)?;
    let motion = Some(directory.join("motion.csv")).filter(|path| path.is_file());
    let scored =
        PreparedDocking::score_files(directory, &directory.join("measurements.csv"), motion.as_deref())?;
    let mut digest = FrameDigest::default();
    for FieldRow { field, lines, mut telemetry, .. } in
        read_field_telemetry(&directory.join("telemetry.csv"))?
    {
        // What the pipeline asked of the digitiser is its own doing.
        telemetry.digitiser = Digitiser::default();
        digest.add(&(field, lines, telemetry));
    }
    for field in TableReader::<FieldTruth>::open(&directory.join("truth/fields.parquet"))? {
        field?.1.iter().for_each(|truth| digest.add(truth));
    }
    let split = split("docking", scenario_of(path, text)?)?;
    let identity = Identity {
        kind: SourceKind::Run,
        world: "docking".to_owned(),
        name: run_file.name,
        seed: run_file.scenario.seed,
        version: run_file.version,
        catalog_sha256: None,
        inject: None,
        renderer: run_file.mitsuba.map(|_| "mitsuba".to_owned()),
        scenario_sha256: split.scenario_sha256,
        frames_sha256: digest.finish(),
        pipeline: split.pipeline,
        scenario: split.scenario,
    };
    Ok(Sample::new(identity, scored.units()))
}

fn study(directory: &Path, path: &Path) -> Result<Sample, Failure> {
    let record = StudyRecord::read(&directory.join("study.json"))?;
    let (table, _) = CaseTable::columns_of(path)?.read(path)?;
    let mut digest = FrameDigest::default();
    for row in &table.rows {
        digest.add(&(row.case, row.seed, &row.drawn));
    }
    let world = record.world;
    let mut split = split(&world, record.scenario)?;
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
        scenario_sha256: sha256_hex(&text),
        frames_sha256: digest.finish(),
        pipeline: split.pipeline,
        scenario: split.scenario,
        world,
    };
    Ok(Sample::new(identity, units_of_cases(&table)))
}

/// The cases of a study as units: rates over all frames of all cases, amounts as means over the cases, as the study sums them up.
#[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
fn units_of_cases(table: &CaseTable) -> UnitTable {
    let figure = |(index, name): (usize, &String)| {
        let is_rate = sense(name).kind == Kind::Rate;
        let term = |figure: CaseFigure| match figure.value {
            _ if is_rate => Term { sum: figure.count as f64, of: figure.of as u32 },
            Some(sum) => Term { sum, of: 1 },
            None => Term::default(),
        };
        let reduction = if is_rate { Reduction::Rate } else { Reduction::Mean };
        let terms = table.rows.iter().map(|row| term(row.figures[index])).collect();
        FigureTerms { name: name.clone(), reduction, terms }
    };
    let of_verdicts = [names::CORRECT_RATE, score::docking::names::SUCCESS_RATE];
    let verdict = table.figures.iter().position(|name| of_verdicts.contains(&name.as_str()));
    let units = table.rows.iter().map(|row| UnitVerdict {
        number: row.case,
        group: "all".to_owned(),
        verdict: verdict
            .map(|index| row.figures[index])
            .map_or_else(String::new, |figure| format!("{} of {}", figure.count, figure.of)),
        cause: None,
    });
    UnitTable { units: units.collect(), figures: table.figures.iter().enumerate().map(figure).collect() }
}

/// The digest of what is known of frames. Floating-point numbers are written so that they read back to the same bits.
#[derive(Default)]
struct FrameDigest(Sha256);

impl FrameDigest {
    fn add(&mut self, row: &impl std::fmt::Debug) {
        self.0.update(format!("{row:?}\n"));
    }

    fn finish(self) -> String {
        hex(self.0.finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rate counts all its frames, an amount has one value a case, and the verdict of a case is how many of its frames were right.
    #[test]
    fn the_cases_of_a_study_are_units() {
        let figure = |value, count, of| CaseFigure { value, count, of };
        let table = CaseTable {
            drawn: indexmap::IndexMap::new(),
            figures: ["correct_rate", "ra_rms_deg"].map(str::to_owned).to_vec(),
            rows: vec![
                study::CaseRow {
                    case: 0,
                    seed: 3,
                    has_failed: false,
                    drawn: Vec::new(),
                    figures: vec![figure(Some(0.75), 30, 40), figure(Some(0.5), 30, 30)],
                },
                study::CaseRow {
                    case: 1,
                    seed: 4,
                    has_failed: false,
                    drawn: Vec::new(),
                    figures: vec![figure(Some(0.0), 0, 40), figure(None, 0, 0)],
                },
            ],
        };
        let units = units_of_cases(&table);
        assert_eq!(units.units[0].verdict, "30 of 40");
        assert_eq!(units.figures[0].terms, [Term { sum: 30.0, of: 40 }, Term { sum: 0.0, of: 40 }]);
        assert_eq!(units.figures[1].terms, [Term { sum: 0.5, of: 1 }, Term::default()]);
    }
}
