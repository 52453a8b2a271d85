//! Baselines: accepted results that are kept for comparison with later ones.
//!
//! A baseline is a directory with two files. `baseline.toml`, readable in a diff, states the run, the
//! pipeline, the reason for this baseline, its division into blocks, and the figures; `rows.parquet` has one
//! row per unit. `baseline.toml` contains the SHA-256 of `rows.parquet`.
//!
//! Two files cannot be replaced in one operation. New rows are first stored under a name with their hash, and
//! get their final name once the header that contains this hash exists; a reader uses the rows that match the
//! header. A process that is killed at any time therefore leaves either the old or the new baseline.

pub(crate) mod rows;
pub(crate) mod tolerance;
use std::path::{Path, PathBuf};

use config::toml_file;
use files::sha256::sha256_hex;
use files::{AtomicFile, Checksums, Failure, FileError, ReplaceableFile};
use indexmap::IndexMap;
use score::{FigureTerms, Reduction};
use serde::{Deserialize, Serialize};

use crate::baseline::tolerance::default_tolerance;
use crate::dependence::blocks::{Blocks, MIN_BLOCKS, length_for, length_for_other_frames};
use crate::dependence::effects::value;
use crate::dependence::memory::{Memory, memory};
use crate::identity::Identity;
use crate::sample::Sample;

/// Version of the file format.
const FORMAT: u32 = 2;
/// Largest `rows.parquet` that is read, bytes.
const MAX_BYTES: u64 = 1 << 28;

/// Names of the files of a baseline.
const NAMES: [&str; 2] = ["baseline.toml", "rows.parquet"];

/// Number of attempts to read a baseline before the one whose error counts, and the pause after each.
const READ_AGAIN: u32 = 3;
const READ_PAUSE: std::time::Duration = std::time::Duration::from_millis(20);

/// Files that a newer baseline may replace.
const HEADERS: ReplaceableFile<'static> = ReplaceableFile {
    description: "the baseline.toml of an earlier baseline",
    matches: &|beginning| beginning.starts_with(b"format = "),
};
const ROWS: ReplaceableFile<'static> = ReplaceableFile {
    description: "the rows of an earlier baseline",
    matches: &|beginning| beginning.starts_with(b"PAR1"),
};
/// Treatment of an existing baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replacement {
    /// The existing baseline is kept, and writing another one to its directory is an error.
    Refuse,
    /// The existing baseline is replaced.
    Allow,
}

/// Contents of `baseline.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BaselineHeader {
    /// Version of the file format.
    pub format: u32,
    /// Reason why the result became the baseline.
    pub reason: String,
    /// SHA-256 of `rows.parquet`.
    pub rows_sha256: String,
    /// Number of rows: frames, fields or cases.
    pub units: u64,
    /// Division into blocks.
    pub blocks: BlockRule,
    /// Figures by name.
    pub figures: IndexMap<String, BaselineFigure>,
    /// Identity of the run.
    pub run: Identity,
}

/// Division of a baseline into blocks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockRule {
    /// Number of blocks.
    pub count: u64,
    /// Approximate number of units per block; blocks do not cross gaps, and are shorter in short sequences.
    pub length: u64,
    /// True if `--block-length` set the length: it then also holds for results of other frames, which
    /// otherwise use longer blocks.
    pub is_given: bool,
    /// Longest autocorrelation time of the figures, units.
    pub memory: f64,
    /// Figure with the longest autocorrelation time; empty if no figure is correlated.
    pub memory_of: String,
}

/// A figure of a baseline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BaselineFigure {
    /// Reduction of the unit values to the figure: `rate`, `mean`, `rms`, `median`.
    pub by: String,
    /// Value of the figure; absent if no unit has a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Number of values from which the figure is computed.
    pub of: u64,
    /// Largest worsening of a result that still passes, in the unit of the figure.
    pub tolerance: f64,
    /// Limit of a rate that counts errors "within" a limit, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit_deg: Option<f64>,
    /// Attitude on which a figure of lines of sight is based.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
}

/// A baseline in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// Contents of `baseline.toml`.
    pub header: BaselineHeader,
    /// Identity of the run, and the results of each unit.
    pub sample: Sample,
    /// The block of each unit.
    pub blocks: Blocks,
}

impl Baseline {
    /// Creates a baseline from a sample, divided into blocks of about `length` units. The default length is
    /// ten times the longest autocorrelation time of the figures, but short enough to leave twenty blocks,
    /// and at least thirty units.
    ///
    /// # Errors
    /// [`Failure::Usage`] for an empty reason, or for too few blocks to show any change.
    pub fn new(sample: Sample, reason: &str, length: Option<u64>) -> Result<Self, Failure> {
        let reason = reason.trim();
        if reason.is_empty() {
            return Err(Failure::Usage(
                "--reason is empty: it must say why this result becomes the baseline".to_owned(),
            ));
        }
        let Identity { kind, world, .. } = &sample.identity;
        let (kind, units) = (*kind, sample.table.units.len());
        let Memory { units: remembered, figure } = memory(kind, world, &sample.table);
        let is_given = length.is_some();
        let length = length.map_or_else(|| length_for(remembered, units), |length| length as usize);
        let blocks = Blocks::cut(kind, world, &sample.table, length);
        if blocks.count() < MIN_BLOCKS {
            return Err(Failure::Usage(format!(
                "the result has {units} {} in {} blocks, expected at least {MIN_BLOCKS} blocks for a test; \
                 make a longer run, or set a shorter --block-length",
                kind.units(world),
                blocks.count()
            )));
        }
        let figures =
            sample.table.figures.iter().map(|figure| (figure.name.clone(), baseline_figure(figure)));
        let header = BaselineHeader {
            format: FORMAT,
            reason: reason.to_owned(),
            rows_sha256: String::new(),
            units: units as u64,
            blocks: BlockRule {
                count: blocks.count() as u64,
                length: length as u64,
                is_given,
                memory: (remembered * 10.0).round() / 10.0,
                memory_of: figure,
            },
            figures: figures.collect(),
            run: sample.identity.clone(),
        };
        Ok(Self { header, sample, blocks })
    }

    /// Returns the baseline with the given tolerances for some figures, in their units.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a figure that the baseline does not have.
    pub fn with_tolerances(mut self, tolerances: &IndexMap<String, f64>) -> Result<Self, Failure> {
        for (name, tolerance) in tolerances {
            match self.header.figures.get_mut(name) {
                Some(figure) => figure.tolerance = *tolerance,
                None => return Err(unknown_figure("--tolerance", name, self.header.figures.keys())),
            }
        }
        Ok(self)
    }

    /// Returns the blocks for comparison with a result of other frames.
    pub(crate) fn blocks_for_other_frames(&self) -> Blocks {
        let BlockRule { memory, is_given, .. } = self.header.blocks;
        if is_given {
            return self.blocks.clone();
        }
        let Sample { identity, table } = &self.sample;
        let length = length_for_other_frames(memory, table.units.len());
        Blocks::cut(identity.kind, &identity.world, table, length)
    }

    /// Writes the files to a directory, which is created if it does not exist. The files get their names when
    /// both are complete.
    ///
    /// # Errors
    /// [`Failure`] if a baseline exists and `replace` does not allow its replacement, if the directory has
    /// other files with these names or checksums of other files, or if a file cannot be written.
    pub fn write(&mut self, folder: &Path, replace: Replacement) -> Result<(), Failure> {
        let [header, rows] = paths(folder);
        HEADERS.check(&header)?;
        ROWS.check(&rows)?;
        for path in [&header, &rows] {
            if replace == Replacement::Refuse && path.exists() {
                return Err(Failure::Usage(format!(
                    "{}: a baseline exists; replace it with --replace",
                    path.display()
                )));
            }
        }
        Checksums::check_own(folder, &NAMES)?;
        std::fs::create_dir_all(folder).map_err(|source| FileError::io(folder, "create", source))?;
        let new_rows = AtomicFile::create(&rows)?;
        rows::write(new_rows.file(), &rows, &self.sample.table, |unit| self.blocks.block_of(unit))?;
        self.header.rows_sha256 = file_sha256(new_rows.temporary_path())?;
        let text = toml::to_string(&self.header)
            .map_err(|error| Failure::Usage(format!("the baseline cannot be written: {error}")))?;
        let new_header = AtomicFile::with_text(&header, &text)?;
        let waiting = waiting_rows(folder, &self.header.rows_sha256);
        new_rows.with_path(&waiting).replace(ROWS)?;
        // The checksums of the earlier baseline would report the new header as damaged.
        Checksums::remove(folder)?;
        match replace {
            Replacement::Allow => new_header.replace(HEADERS)?,
            Replacement::Refuse => new_header.commit_new()?,
        }
        std::fs::rename(&waiting, &rows).map_err(|source| FileError::io(&rows, "create", source))?;
        AtomicFile::remove_abandoned_of(folder, is_waiting);
        Ok(Checksums::write(folder, &NAMES)?)
    }

    /// Reads a baseline. Header and rows of one that is being replaced do not agree for an instant: what
    /// cannot be read is read again, a few times.
    ///
    /// # Errors
    /// [`Failure`] for a directory without a baseline, or with a damaged one.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        for _ in 0..READ_AGAIN {
            if let Ok(baseline) = Self::read_once(folder) {
                return Ok(baseline);
            }
            std::thread::sleep(READ_PAUSE);
        }
        Self::read_once(folder)
    }

    fn read_once(folder: &Path) -> Result<Self, Failure> {
        let [path, rows_path] = paths(folder);
        if !path.is_file() {
            return Err(Failure::Usage(format!(
                "{}: no `baseline.toml` in it, expected a folder written by `boresight gate baseline`",
                folder.display()
            )));
        }
        let text = toml_file::read_text(&path).map_err(|source| FileError::io(&path, "read", source))?;
        let refuse = |at: &str, message: String| Failure::from(toml_file::refuse(&path, &text, at, message));
        let header: BaselineHeader = toml_file::parse(&path, &text)?;
        if header.format != FORMAT {
            return Err(refuse("format", format!("is {}, expected {FORMAT}", header.format)));
        }
        let mut figures = Vec::new();
        for (name, figure) in &header.figures {
            let Some(reduction) = Reduction::parse(&figure.by) else {
                let words = Reduction::ALL.map(Reduction::code).join(", ");
                return Err(refuse(
                    &format!("figures.{name}.by"),
                    format!("is `{}`, expected one of {words}", figure.by),
                ));
            };
            figures.push((name.clone(), reduction));
        }
        let waiting = waiting_rows(folder, &header.rows_sha256);
        let is_of_header = |path: &Path| Ok::<_, FileError>(file_sha256(path)? == header.rows_sha256);
        let rows_path = if waiting.is_file() && is_of_header(&waiting)? { waiting } else { rows_path };
        if !is_of_header(&rows_path)? {
            let message = format!(
                "differs from the checksum of {}: one of the two files was changed",
                rows_path.display()
            );
            return Err(refuse("rows_sha256", message));
        }
        let (mut table, numbers) = rows::read(&rows_path, &figures)?;
        for (figure, recorded) in table.figures.iter_mut().zip(header.figures.values()) {
            (figure.limit_deg, figure.attitude) = (recorded.limit_deg, recorded.attitude.clone());
        }
        let (recorded, units) = (header.units, table.units.len());
        if recorded != units as u64 {
            return Err(refuse(
                "units",
                format!("is {recorded}, expected {units}, the number of rows of {}", rows_path.display()),
            ));
        }
        let blocks = Blocks::from_numbers(numbers);
        let (recorded, count) = (header.blocks.count, blocks.count());
        if recorded != count as u64 || count < MIN_BLOCKS {
            let expected =
                format!("the number of blocks in {} ({count}), at least {MIN_BLOCKS}", rows_path.display());
            return Err(refuse("blocks.count", format!("is {recorded}, expected {expected}")));
        }
        for figure in &table.figures {
            let Some(recorded) = header.figures.get(&figure.name) else { continue };
            let known = BaselineFigure { tolerance: recorded.tolerance, ..baseline_figure(figure) };
            if !(recorded.tolerance.is_finite() && recorded.tolerance >= 0.0) {
                let message = format!("is {}, expected a tolerance of 0 or more", recorded.tolerance);
                return Err(refuse(&format!("figures.{}.tolerance", figure.name), message));
            }
            if recorded != &known {
                let value = known.value.map_or_else(|| "none".to_owned(), |value| value.to_string());
                return Err(refuse(
                    &format!("figures.{}", figure.name),
                    format!("differs from the rows, expected {value} of {}", known.of),
                ));
            }
        }
        Checksums::check(folder, |_| true)?;
        let sample = Sample { identity: header.run.clone(), table };
        Ok(Self { header, sample, blocks })
    }
}

/// Creates the error of an option that names an unknown figure.
pub(crate) fn unknown_figure<'a>(
    option: &str,
    name: &str,
    known: impl Iterator<Item = &'a String> + Clone,
) -> Failure {
    let hint = toml_file::nearest(name, known.clone().map(String::as_str)).map_or_else(
        || known.map(String::as_str).collect::<Vec<_>>().join(", "),
        |name| format!("did you mean `{name}`?"),
    );
    Failure::Usage(format!("{option} names `{name}`, expected a figure of the baseline; {hint}"))
}

/// Returns the header entry of a figure.
fn baseline_figure(figure: &FigureTerms) -> BaselineFigure {
    BaselineFigure {
        by: figure.reduction.code().to_owned(),
        value: value(figure.reduction, &figure.terms),
        of: figure.terms.iter().map(|term| u64::from(term.count)).sum(),
        tolerance: default_tolerance(figure),
        limit_deg: figure.limit_deg,
        attitude: figure.attitude.clone(),
    }
}

fn paths(folder: &Path) -> [PathBuf; 2] {
    NAMES.map(|name| folder.join(name))
}

/// Prefix of the names of rows that are stored before their header.
const WAITING: &str = ".rows-";

/// Returns the path of the rows until the header that refers to them exists.
fn waiting_rows(folder: &Path, sha256: &str) -> PathBuf {
    // The hash may come from an untrusted header: it must not form a path.
    let digits: String = sha256.chars().filter(char::is_ascii_hexdigit).collect();
    folder.join(format!("{WAITING}{digits}.parquet"))
}

fn is_waiting(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(WAITING))
}

fn file_sha256(path: &Path) -> Result<String, FileError> {
    let bytes =
        config::regular_file::read(path, MAX_BYTES).map_err(|source| FileError::io(path, "read", source))?;
    Ok(sha256_hex(&bytes))
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;
    use crate::hand_made::{figure, sample};

    /// Returns units of which the last is missed and the others have a hit with an error.
    fn run(units: usize) -> Sample {
        let hits: Vec<_> = (1..=units).map(|unit| Some(f64::from(u8::from(unit < units)))).collect();
        let errors: Vec<_> =
            (1..=units).map(|unit| Some(0.5 * unit as f64).filter(|_| unit < units)).collect();
        let median = figure("ra_median_deg", Reduction::Median, &errors);
        sample(vec![figure("hit_rate", Reduction::Rate, &hits), median])
    }

    /// Writes a baseline of `units` blocks of one unit, and returns it with its directory.
    fn written(units: usize) -> (Baseline, TempDir) {
        let mut baseline = Baseline::new(run(units), "a test", Some(1)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        baseline.write(folder.path(), Replacement::Refuse).unwrap();
        (baseline, folder)
    }

    #[test]
    fn a_baseline_is_read_as_it_was_written() {
        for units in [5, 6, 40] {
            let (baseline, folder) = written(units);
            assert_eq!(Baseline::read(folder.path()).unwrap(), baseline);
            let rows = std::fs::read(folder.path().join("rows.parquet")).unwrap();
            assert_eq!(baseline.header.rows_sha256, sha256_hex(rows));
            Checksums::check(folder.path(), |_| true).unwrap();
            let sums = std::fs::read_to_string(folder.path().join("SHA256SUMS")).unwrap();
            assert!(NAMES.iter().all(|name| sums.contains(name)), "{sums}");
        }
    }

    /// Limit and attitude of a figure are stored only in the header.
    #[test]
    fn limits_and_attitudes_are_read_back() {
        let mut sample = run(6);
        let figure = &mut sample.table.figures[1];
        (figure.limit_deg, figure.attitude) = (Some(0.024), Some("true".to_owned()));
        let mut baseline = Baseline::new(sample, "a test", Some(1)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        baseline.write(folder.path(), Replacement::Refuse).unwrap();
        let read = &Baseline::read(folder.path()).unwrap();
        assert_eq!(read, &baseline);
        assert_eq!(read.header.figures["ra_median_deg"].limit_deg, Some(0.024));
        assert_eq!(read.header.figures["ra_median_deg"].attitude.as_deref(), Some("true"));
    }

    /// Intermediate states of a `--replace` that is killed: either the old or the new baseline is always
    /// complete.
    #[test]
    fn a_killed_replacement_leaves_one_of_the_two() {
        let [(old, folder), (new, other)] = [written(6), written(7)];
        let at = |name: &str| folder.path().join(name);
        let waiting = waiting_rows(folder.path(), &new.header.rows_sha256);
        std::fs::copy(other.path().join("rows.parquet"), &waiting).unwrap();
        assert_eq!(Baseline::read(folder.path()).unwrap(), old);
        std::fs::remove_file(at("SHA256SUMS")).unwrap();
        assert_eq!(Baseline::read(folder.path()).unwrap(), old);
        std::fs::copy(other.path().join("baseline.toml"), at("baseline.toml")).unwrap();
        assert_eq!(Baseline::read(folder.path()).unwrap(), new);
        // The next baseline does not need the files of the killed replacement; until it has written its own
        // header, it keeps the rows to which the old header refers.
        let mut third = Baseline::new(run(8), "third", Some(1)).unwrap();
        third.write(folder.path(), Replacement::Allow).unwrap();
        assert_eq!(Baseline::read(folder.path()).unwrap(), third);
    }

    #[test]
    fn a_baseline_replaces_only_a_baseline() {
        let (mut baseline, folder) = written(6);
        let parts = |name: &str, text: &str, expected: &str| {
            let other = tempfile::tempdir().unwrap();
            std::fs::write(other.path().join(name), text).unwrap();
            for replace in [Replacement::Refuse, Replacement::Allow] {
                let message = baseline.clone().write(other.path(), replace).unwrap_err().to_string();
                assert!(message.contains(name) && message.contains(expected), "{message}");
            }
            assert_eq!(std::fs::read_dir(other.path()).unwrap().count(), 1);
            assert_eq!(std::fs::read_to_string(other.path().join(name)).unwrap(), text);
        };
        parts("baseline.toml", "name = 1\n", "a file of another kind");
        parts("rows.parquet", "mine", "a file of another kind");
        parts("SHA256SUMS", &format!("{}  run.toml\n", "0".repeat(64)), "checksums of the files");
        baseline.write(folder.path(), Replacement::Allow).unwrap();
    }

    #[test]
    fn a_baseline_is_replaced_only_on_request() {
        let (_, folder) = written(6);
        let mut other = Baseline::new(run(7), "another", Some(1)).unwrap();
        let message = other.write(folder.path(), Replacement::Refuse).unwrap_err().to_string();
        assert!(message.contains("baseline.toml: a baseline exists; replace it with --replace"), "{message}");
        assert_eq!(Baseline::read(folder.path()).unwrap().header.units, 6);
        other.write(folder.path(), Replacement::Allow).unwrap();
        assert_eq!(Baseline::read(folder.path()).unwrap(), other);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
        // A directory that does not exist yet, and a directory with only the rows.
        let inner = folder.path().join("a/b");
        other.write(&inner, Replacement::Allow).unwrap();
        std::fs::remove_file(inner.join("baseline.toml")).unwrap();
        let message = other.write(&inner, Replacement::Refuse).unwrap_err().to_string();
        assert!(message.contains("rows.parquet: a baseline exists"), "{message}");
    }

    #[test]
    fn the_header_states_blocks_figures_and_run() {
        let (baseline, _) = written(8);
        let header = &baseline.header;
        assert_eq!((header.format, header.units, header.reason.as_str()), (2, 8, "a test"));
        assert_eq!((header.blocks.count, header.blocks.length), (8, 1));
        let read = |by: &str, value, of| BaselineFigure {
            by: by.to_owned(),
            value,
            of,
            tolerance: if by == "rate" { 0.001 } else { 0.022 },
            limit_deg: None,
            attitude: None,
        };
        assert_eq!(header.figures["hit_rate"], read("rate", Some(0.875), 8));
        // 0.5, 1, … 3.5.
        assert_eq!(header.figures["ra_median_deg"], read("median", Some(2.0), 7));
        assert_eq!(header.run, baseline.sample.identity);
        // Without a given length, blocks have thirty units: seven blocks for 200 units.
        let of_days = Baseline::new(run(200), " why ", None).unwrap();
        assert_eq!((of_days.blocks.count(), of_days.header.blocks.length), (7, 30));
        assert_eq!(of_days.header.reason, "why");
        // Errors that grow throughout the run are correlated over the whole run.
        assert_eq!(of_days.header.blocks.memory_of, "ra_median_deg");
        let memory = of_days.header.blocks.memory;
        assert!(memory > 10.0 && memory * 10.0 == (memory * 10.0).round(), "{memory}");
    }

    /// Errors that grow through 400 units are correlated throughout: thirteen blocks of thirty, and eight of
    /// fifty for other frames.
    #[test]
    fn blocks_for_other_frames_are_longer_unless_their_length_was_given() {
        let counts = |length| {
            let baseline = Baseline::new(run(400), "a test", length).unwrap();
            (baseline.blocks.count(), baseline.blocks_for_other_frames().count())
        };
        assert_eq!(counts(None), (13, 8));
        assert_eq!(counts(Some(20)), (20, 20));
    }

    #[test]
    fn a_baseline_keeps_the_tolerances_that_it_is_given() {
        let with = |name: &str| {
            let baseline = Baseline::new(run(8), "a test", Some(1)).unwrap();
            baseline.with_tolerances(&IndexMap::from([(name.to_owned(), 0.25)]))
        };
        let mut baseline = with("hit_rate").unwrap();
        let folder = tempfile::tempdir().unwrap();
        baseline.write(folder.path(), Replacement::Refuse).unwrap();
        let read = Baseline::read(folder.path()).unwrap();
        let tolerance = |name: &str| read.header.figures[name].tolerance;
        assert_eq!((tolerance("hit_rate"), tolerance("ra_median_deg")), (0.25, 0.022));
        let message = with("hit_rat").unwrap_err().to_string();
        assert!(
            message.contains("--tolerance names `hit_rat`") && message.contains("`hit_rate`?"),
            "{message}"
        );
    }

    #[test]
    fn a_baseline_needs_a_reason_and_five_blocks() {
        let message =
            |units, reason, length| Baseline::new(run(units), reason, length).unwrap_err().to_string();
        assert!(message(8, " \n", None).contains("--reason is empty"));
        let few = message(4, "a test", Some(1));
        assert!(few.contains("the result has 4 frames in 4 blocks, expected at least 5"), "{few}");
        assert_eq!(Baseline::new(run(5), "a test", Some(1)).unwrap().blocks.count(), 5);
    }

    /// Too few blocks to show a difference, regardless of the program that wrote the file.
    #[test]
    fn a_baseline_of_four_blocks_is_refused_when_it_is_read() {
        let mut baseline = Baseline::new(run(8), "a test", Some(1)).unwrap();
        baseline.blocks = Blocks::every(8, 2);
        baseline.header.blocks.count = 4;
        let folder = tempfile::tempdir().unwrap();
        baseline.write(folder.path(), Replacement::Refuse).unwrap();
        let message = Baseline::read(folder.path()).unwrap_err().to_string();
        let parts = ["blocks.count", "is 4, expected the number of blocks in", "(4), at least 5"];
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }

    #[test]
    fn a_header_that_is_not_that_of_its_rows_is_refused_by_its_position() {
        let (baseline, folder) = written(6);
        let path = folder.path().join("baseline.toml");
        let header = std::fs::read_to_string(&path).unwrap();
        let refused = |old: &str, new: &str, parts: &[&str]| {
            let text = header.replacen(old, new, 1);
            assert_ne!(text, header, "{old}");
            std::fs::write(&path, text).unwrap();
            let message = Baseline::read(folder.path()).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{old}: {message}");
        };
        refused("format = 2", "format = 3", &["baseline.toml:1:10: format", "is 3, expected 2"]);
        refused("units = 6", "units = 7", &["units", "is 7, expected 6, the number of rows of"]);
        refused("count = 6", "count = 7", &["blocks.count", "is 7, expected the number of blocks in", "(6)"]);
        refused(
            "by = \"median\"",
            "by = \"middle\"",
            &["figures.ra_median_deg.by", "rate, mean, rms, median"],
        );
        // 0.5, 1 … 2.5.
        refused("value = 1.5", "value = 1.25", &["figures.ra_median_deg", "expected 1.5 of 5"]);
        refused(
            "tolerance = 0.001",
            "tolerance = -0.001",
            &["figures.hit_rate.tolerance", "is -0.001, expected a tolerance of 0"],
        );
        refused("tolerance = 0.001", "tolerance = inf", &["figures.hit_rate.tolerance", "is inf"]);
        refused("of = 5", "of = 4", &["figures.ra_median_deg", "expected 1.5 of 5"]);
        refused(&baseline.header.rows_sha256, "00", &["rows_sha256", "one of the two files was changed"]);
        // Values that the rows cannot contradict are protected by the checksums.
        refused("reason = \"a test\"", "reason = \"a text\"", &["SHA-256", "damaged"]);
    }

    #[test]
    fn rows_that_changed_are_reported_before_they_are_read() {
        let (_, folder) = written(6);
        std::fs::write(folder.path().join("rows.parquet"), "no table").unwrap();
        let message = Baseline::read(folder.path()).unwrap_err().to_string();
        assert!(message.contains("rows_sha256") && message.contains("was changed"), "{message}");
        let message = Baseline::read(&folder.path().join("nowhere")).unwrap_err().to_string();
        assert!(message.contains("nowhere: no `baseline.toml`"), "{message}");
    }
}
