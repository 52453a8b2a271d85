//! Shards: a study in pieces, each a file that is whole or not there.
//!
//! Shard i of n has the cases from ⌊i N/n⌋ on. Its file is written under another name, synced, and linked to its own, which never
//! replaces a file; in it stand the study's hash, the version, which shard it is, and the hash of its rows. What is not exactly so
//! is no shard: it is removed and made again. So any number of processes may work on the same folder, be killed at any moment,
//! and be started again.

use std::io::{ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use tempfile::NamedTempFile;

use super::cases::CaseTable;
use super::definition::Study;
use super::record::StudyRecord;
use crate::failure::Failure;
use crate::files::FileError;

/// Cases of a shard, about, when their number is not given.
const CASES_PER_SHARD: u64 = 32;
/// Most shards of a study, when their number is not given.
const MOST_SHARDS: u64 = 1000;

/// How the names of files begin that are being written, or were left by a process that was killed.
const PARTIAL: &str = ".partial-";

/// How a study is cut.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Name of the study.
    pub study: String,
    /// Hash of the study, its scenario and its pipeline.
    pub hash: String,
    /// Version of Boresight.
    pub version: String,
    /// Number of cases.
    pub cases: u64,
    /// Number of shards.
    pub shards: u64,
}

/// What a shard's file says of itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShardManifest {
    /// Its number, from 1.
    pub shard: u64,
    /// Number of shards.
    pub of: u64,
    /// Hash of the study, its scenario and its pipeline.
    pub study_hash: String,
    /// Version of Boresight.
    pub version: String,
    /// First case.
    pub first_case: u64,
    /// Number of rows, one a case.
    pub rows: u64,
    /// SHA-256 of the rows ([`CaseTable::sha256`]).
    pub rows_sha256: String,
}

impl Plan {
    /// A plan of a study; of about 32 cases a shard where `shards` is not given.
    ///
    /// # Errors
    /// [`Failure::Usage`] for more shards than cases.
    pub fn new(study: &Study, hash: String, shards: Option<u64>) -> Result<Self, Failure> {
        let cases = study.cases();
        let shards = shards.unwrap_or_else(|| cases.div_ceil(CASES_PER_SHARD).min(MOST_SHARDS));
        if !(1..=cases).contains(&shards) {
            return Err(Failure::Usage(format!(
                "--shards is {shards}, expected 1 to the number of cases, {cases}"
            )));
        }
        Ok(Self {
            study: study.name.clone(),
            hash,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            cases,
            shards,
        })
    }

    /// Cases of a shard, counted from 1.
    pub fn cases_of(&self, shard: u64) -> Range<u64> {
        let at = |i: u64| (u128::from(i) * u128::from(self.cases) / u128::from(self.shards)) as u64;
        at(shard - 1)..at(shard)
    }
}

/// The folder of a study's results.
#[derive(Debug, Clone)]
pub struct ShardStore {
    folder: PathBuf,
    plan: Plan,
}

impl ShardStore {
    /// Opens a folder for a plan, and makes it when it is not there. What is in it must be of the same plan.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the folder holds another study, or the same one in other pieces; [`Failure`] of files.
    pub fn open(folder: &Path, plan: Plan) -> Result<Self, Failure> {
        let store = Self { folder: folder.to_owned(), plan };
        std::fs::create_dir_all(store.shards()).map_err(|source| FileError::io(folder, "create", source))?;
        let path = store.folder.join("plan.json");
        let text = to_json(&store.plan)?;
        if !path.exists() {
            // Several processes may come to this at once: all write the same, and the first one's stays.
            commit(partial_with(&path, &text)?, &path)?;
        }
        store.check_plan(&path)?;
        Ok(store)
    }

    fn check_plan(&self, path: &Path) -> Result<(), Failure> {
        let text = sim::regular_file::read_text(path, 1 << 20)
            .map_err(|source| FileError::io(path, "read", source))?;
        let found: Plan =
            serde_json::from_str(&text).map_err(|error| FileError::format(path, "plan", error))?;
        let (plan, path) = (&self.plan, path.display());
        let other = |field: &str, found: &dyn std::fmt::Display, expected: &dyn std::fmt::Display| {
            Failure::Usage(format!(
                "{path}: `{field}` is `{found}`, expected `{expected}`: the folder holds another study, or the same one made \
                 otherwise; give another folder with --out"
            ))
        };
        if found.hash != plan.hash {
            Err(other("hash", &found.hash, &plan.hash))
        } else if found.version != plan.version {
            Err(other("version", &found.version, &plan.version))
        } else if found.shards != plan.shards || found.cases != plan.cases {
            Err(other("shards", &found.shards, &plan.shards))
        } else {
            Ok(())
        }
    }

    /// How the study is cut.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The number of shards of the plan that a folder already holds.
    pub fn planned_shards(folder: &Path) -> Option<u64> {
        let text = sim::regular_file::read_text(&folder.join("plan.json"), 1 << 20).ok()?;
        serde_json::from_str::<Plan>(&text).ok().map(|plan| plan.shards)
    }

    /// Refuses files among the shards that are none of the plan's.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the first one.
    pub fn check_foreign(&self) -> Result<(), Failure> {
        let folder = self.shards();
        let known: Vec<PathBuf> = (1..=self.plan.shards).map(|shard| self.path(shard)).collect();
        let io = |source| FileError::io(&folder, "read", source);
        for entry in std::fs::read_dir(&folder).map_err(io)? {
            let path = entry.map_err(io)?.path();
            let is_partial = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PARTIAL));
            if !is_partial && !known.contains(&path) {
                return Err(Failure::Usage(format!(
                    "{}: is none of the {} shards of `{}`, expected nothing else there",
                    path.display(),
                    self.plan.shards,
                    self.plan.study
                )));
            }
        }
        Ok(())
    }

    fn shards(&self) -> PathBuf {
        self.folder.join("shards")
    }

    /// The file of a shard.
    pub fn path(&self, shard: u64) -> PathBuf {
        let width = self.plan.shards.to_string().len();
        self.shards().join(format!("{shard:0width$}-of-{}.parquet", self.plan.shards))
    }

    /// The rows of a shard when its file is there, whole, and of this study.
    pub fn read(&self, shard: u64, empty: &CaseTable) -> Option<(CaseTable, ShardManifest)> {
        let (table, metadata) = empty.read(&self.path(shard)).ok()?;
        let manifest = self.manifest_of(shard, &table, &metadata)?;
        Some((table, manifest))
    }

    /// Makes room for a shard that [`ShardStore::read`] does not find: removes the file that stands in its place, if one does.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be removed.
    pub fn clear(&self, shard: u64) -> Result<(), FileError> {
        let path = self.path(shard);
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != ErrorKind::NotFound => {
                Err(FileError::io(&path, "remove", source))
            }
            _ => Ok(()),
        }
    }

    /// The manifest of rows, if what is written beside them is just that.
    fn manifest_of(
        &self,
        shard: u64,
        table: &CaseTable,
        metadata: &IndexMap<String, String>,
    ) -> Option<ShardManifest> {
        let expected = self.manifest(shard, table);
        let cases = self.plan.cases_of(shard);
        let are_its_cases = table.rows.iter().map(|row| row.case).eq(cases);
        let says = |(key, value): &(&str, String)| metadata.get(*key) == Some(value);
        (are_its_cases && expected.pairs().iter().all(says)).then_some(expected)
    }

    fn manifest(&self, shard: u64, table: &CaseTable) -> ShardManifest {
        ShardManifest {
            shard,
            of: self.plan.shards,
            study_hash: self.plan.hash.clone(),
            version: self.plan.version.clone(),
            first_case: self.plan.cases_of(shard).start,
            rows: table.rows.len() as u64,
            rows_sha256: table.sha256(),
        }
    }

    /// Writes a shard, at once or not at all. When another process has written it meanwhile, its file stays: it says the same.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be written.
    pub fn write(&self, shard: u64, table: &CaseTable) -> Result<ShardManifest, FileError> {
        let manifest = self.manifest(shard, table);
        let path = self.path(shard);
        let file = partial(&path)?;
        table.write(file.as_file(), &path, &manifest.pairs())?;
        commit(file, &path)?;
        Ok(manifest)
    }

    /// All rows of the study, `cases.parquet`, written at once in the place of those of an earlier merge.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be written.
    pub fn write_cases(&self, table: &CaseTable) -> Result<PathBuf, FileError> {
        let path = self.folder.join("cases.parquet");
        let file = partial(&path)?;
        let of = [("study_hash", self.plan.hash.clone()), ("version", self.plan.version.clone())];
        table.write(file.as_file(), &path, &of)?;
        replace(file, &path)?;
        Ok(path)
    }

    /// What the study is of, `study.json`, written at once in the place of an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_record(&self, record: &StudyRecord) -> Result<PathBuf, Failure> {
        let path = self.folder.join("study.json");
        replace(partial_with(&path, &to_json(record)?)?, &path)?;
        Ok(path)
    }

    /// The summary, `summary.json`, written at once in the place of an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_summary(&self, summary: &impl Serialize) -> Result<PathBuf, Failure> {
        let path = self.folder.join("summary.json");
        replace(partial_with(&path, &to_json(summary)?)?, &path)?;
        Ok(path)
    }
}

impl ShardManifest {
    /// As it stands beside the rows in the file.
    fn pairs(&self) -> [(&'static str, String); 6] {
        [
            ("shard", self.shard.to_string()),
            ("of", self.of.to_string()),
            ("study_hash", self.study_hash.clone()),
            ("version", self.version.clone()),
            ("rows", self.rows.to_string()),
            ("rows_sha256", self.rows_sha256.clone()),
        ]
    }
}

/// A file beside `path` that is gone unless it is given a name.
fn partial(path: &Path) -> Result<NamedTempFile, FileError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    tempfile::Builder::new()
        .prefix(PARTIAL)
        .tempfile_in(folder)
        .map_err(|source| FileError::io(path, "create", source))
}

fn partial_with(path: &Path, text: &str) -> Result<NamedTempFile, FileError> {
    let io = |source| FileError::io(path, "write", source);
    let mut file = partial(path)?;
    file.write_all(text.as_bytes()).map_err(io)?;
    file.as_file().sync_all().map_err(io)?;
    Ok(file)
}

/// Gives a file its name, unless there is one of that name already, which says the same.
fn commit(file: NamedTempFile, path: &Path) -> Result<(), FileError> {
    match file.persist_noclobber(path) {
        Err(error) if error.error.kind() == ErrorKind::AlreadyExists => Ok(()),
        Err(error) => Err(FileError::io(path, "create", error.error)),
        Ok(_) => Ok(()),
    }
}

/// Gives a file its name, in the place of an earlier one.
fn replace(file: NamedTempFile, path: &Path) -> Result<(), FileError> {
    file.persist(path).map(drop).map_err(|error| FileError::io(path, "create", error.error))
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value)
        .map(|json| json + "\n")
        .map_err(|error| Failure::Usage(format!("the result cannot be written as JSON: {error}")))
}
