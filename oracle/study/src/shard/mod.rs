//! Shards: parts of a study, each a file that is either complete or absent.
//!
//! Shard i of n, counted from 1, starts at case ⌊(i − 1) N/n⌋. Its file is written under another name,
//! synced, and linked to its final name, which never replaces a file. It contains the study's hash, the
//! version, the number of the shard, and the hash of its rows. A file that differs from this by a single byte
//! is not a shard: the shard is run again. Any number of processes may therefore work on the same directory,
//! be killed at any time, and be started again.

pub(crate) mod journal;
pub(crate) mod record;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};

use files::sha256::sha256_hex;
use files::{AtomicFile, Checksums, Failure, FileError, ReplaceableFile};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::case_file::CaseWriter;
use crate::cases::{CaseRow, CaseTable};
use crate::definition::Study;
use crate::shard::journal::Journal;
use crate::shard::record::StudyRecord;

/// Approximate number of cases per shard, when the number of shards is not given.
const CASES_PER_SHARD: u64 = 32;
/// Extension of the journal of an incomplete shard.
const JOURNAL: &str = "journal";
/// Maximum number of shards of a study if the user states no number.
const MAX_SHARDS: u64 = 1000;

/// Division of a study into shards.
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
    /// SHA-256 of all preceding fields, which distinguishes a damaged plan from the plan of another study.
    #[serde(default)]
    pub sha256: String,
}

/// Metadata in a shard's file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShardManifest {
    /// Number of the shard, from 1.
    pub shard: u64,
    /// Number of shards.
    pub of: u64,
    /// Hash of the study, its scenario and its pipeline.
    pub study_hash: String,
    /// Version of Boresight.
    pub version: String,
    /// Number of the first case.
    pub first_case: u64,
    /// Number of rows, one per case.
    pub rows: u64,
    /// SHA-256 of the rows ([`CaseTable::sha256`]).
    pub rows_sha256: String,
}

impl Plan {
    /// Creates a plan of a study, with about 32 cases per shard if `shards` is not given.
    ///
    /// # Errors
    /// [`Failure::Usage`] for more shards than cases.
    pub fn new(study: &Study, hash: String, shards: Option<u64>) -> Result<Self, Failure> {
        let cases = study.cases();
        let shards = shards.unwrap_or_else(|| cases.div_ceil(CASES_PER_SHARD).min(MAX_SHARDS));
        if !(1..=cases).contains(&shards) {
            return Err(Failure::Usage(format!(
                "--shards is {shards}, expected 1 to the number of cases, {cases}"
            )));
        }
        let (study, version) = (study.name.clone(), env!("CARGO_PKG_VERSION").to_owned());
        let mut plan = Self { study, hash, version, cases, shards, sha256: String::new() };
        plan.sha256 = plan.computed_sha256();
        Ok(plan)
    }

    fn computed_sha256(&self) -> String {
        let Self { study, hash, version, cases, shards, sha256: _ } = self;
        sha256_hex(format!("{study:?} {hash} {version:?} {cases} {shards}"))
    }

    /// Reads the plan of a directory.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be read, and [`Failure::Usage`] when it is damaged: its content does not
    /// match its checksum.
    fn read(path: &Path) -> Result<Self, Failure> {
        let text = config::regular_file::read_text(path, 1 << 20)
            .map_err(|source| FileError::io(path, "read", source))?;
        let plan: Option<Self> = serde_json::from_str(&text).ok();
        plan.filter(|plan| plan.sha256 == plan.computed_sha256()).ok_or_else(|| {
            Failure::Usage(format!(
                "{}: is damaged (`sha256` differs from its content); delete it and, if they exist, \
                 study.json, cases.parquet, summary.json and SHA256SUMS: `boresight study run` runs this \
                 shard again and keeps the undamaged ones",
                path.display()
            ))
        })
    }

    /// Returns the cases of a shard, counted from 1.
    pub fn cases_of(&self, shard: u64) -> Range<u64> {
        let at = |i: u64| (u128::from(i) * u128::from(self.cases) / u128::from(self.shards)) as u64;
        at(shard - 1)..at(shard)
    }
}

/// Directory of a study's results.
#[derive(Debug, Clone)]
pub struct ShardStore {
    folder: PathBuf,
    plan: Plan,
}

impl ShardStore {
    /// Opens a directory for a plan, and creates it if it is missing. Its content must belong to the same
    /// plan; a directory without a plan must not contain any of a study's file names.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the directory holds another study, or the same study in other shards;
    /// [`Failure`] of files.
    pub fn open(folder: &Path, plan: Plan) -> Result<Self, Failure> {
        let store = Self { folder: folder.to_owned(), plan };
        let path = store.folder.join("plan.json");
        if !path.exists() {
            let is_free = ReplaceableFile {
                description: "a folder of a study with its plan.json",
                matches: &|_| false,
            };
            let [_, others @ ..] = &SEALED;
            others.iter().try_for_each(|name| is_free.check(&folder.join(name)))?;
        }
        Checksums::check_own(folder, &SEALED)?;
        std::fs::create_dir_all(store.shards()).map_err(|source| FileError::io(folder, "create", source))?;
        AtomicFile::remove_abandoned(folder);
        AtomicFile::remove_abandoned(&store.shards());
        let text = to_json(&store.plan)?;
        if !path.exists() {
            // Several processes may write the plan at once: all write the same content, and the first file
            // stays.
            AtomicFile::with_text(&path, &text)?.commit()?;
        }
        store.check_plan(&path)?;
        Ok(store)
    }

    fn check_plan(&self, path: &Path) -> Result<(), Failure> {
        let found = Plan::read(path)?;
        let (plan, path) = (&self.plan, path.display());
        let other = |field: &str, found: &dyn std::fmt::Display, expected: &dyn std::fmt::Display| {
            Failure::Usage(format!(
                "{path}: `{field}` is `{found}`, expected `{expected}`: the folder contains another study, \
                 or this study with other settings; give another folder with --out"
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

    /// Returns the directory.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the division of the study into shards.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns true if a directory holds a plan, readable or not.
    pub(crate) fn has_plan(folder: &Path) -> bool {
        folder.join("plan.json").exists()
    }

    /// Returns the number of shards in the plan of a directory, if it holds one.
    pub fn planned_shards(folder: &Path) -> Option<u64> {
        Plan::read(&folder.join("plan.json")).ok().map(|plan| plan.shards)
    }

    /// Checks that the directory of shards holds only files of the plan.
    ///
    /// # Errors
    /// [`Failure::Usage`] that names the first other file.
    pub fn check_foreign(&self) -> Result<(), Failure> {
        let folder = self.shards();
        let known: Vec<PathBuf> = (1..=self.plan.shards).map(|shard| self.path(shard)).collect();
        let io = |source| FileError::io(&folder, "read", source);
        for entry in std::fs::read_dir(&folder).map_err(io)? {
            let path = entry.map_err(io)?.path();
            let is_journal = path.extension().is_some_and(|extension| extension == JOURNAL);
            let is_known =
                known.contains(&path) || is_journal && known.contains(&path.with_extension("parquet"));
            if !AtomicFile::is_partial(&path) && !is_known {
                return Err(Failure::Usage(format!(
                    "{}: not one of the {} shards of `{}`; move it out of this folder",
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

    /// Returns the path of a shard's file.
    pub fn path(&self, shard: u64) -> PathBuf {
        let width = self.plan.shards.to_string().len();
        self.shards().join(format!("{shard:0width$}-of-{}.parquet", self.plan.shards))
    }

    /// Opens the journal of an incomplete shard, and returns the rows that it holds.
    ///
    /// # Errors
    /// [`FileError::Io`] for a file that cannot be read or appended to.
    pub(crate) fn journal(&self, shard: u64) -> Result<(Journal, Vec<CaseRow>), FileError> {
        Journal::open(self.path(shard).with_extension(JOURNAL), &self.plan.hash)
    }

    /// Returns the number of finished cases, in complete and incomplete shards.
    pub fn finished_cases(&self) -> u64 {
        let finished = |shard| {
            let cases = self.plan.cases_of(shard);
            let path = self.path(shard);
            if path.is_file() {
                return cases.end - cases.start;
            }
            journal::count(&path.with_extension(JOURNAL), &self.plan.hash) as u64
        };
        (1..=self.plan.shards).map(finished).sum()
    }

    /// Reads the rows of a shard; `None` unless its file exists, is complete, and belongs to this study.
    ///
    /// # Errors
    /// [`FileError::Io`] when a file exists but cannot be opened: it may be complete.
    pub fn read(
        &self,
        shard: u64,
        empty: &CaseTable,
    ) -> Result<Option<(CaseTable, ShardManifest)>, FileError> {
        let path = self.path(shard);
        match empty.read(&path) {
            Ok((table, metadata)) => {
                let manifest = self.manifest_of(shard, &table, &metadata);
                let is_whole = match &manifest {
                    Some(manifest) => is_just(&table, manifest, &path)?,
                    None => false,
                };
                Ok(manifest.filter(|_| is_whole).map(|manifest| (table, manifest)))
            }
            Err(FileError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => Ok(None),
            Err(error @ FileError::Io { .. }) => Err(error),
            Err(_) => Ok(None),
        }
    }

    /// Returns the manifest of the rows, if the metadata beside them match it exactly.
    fn manifest_of(
        &self,
        shard: u64,
        table: &CaseTable,
        metadata: &IndexMap<String, String>,
    ) -> Option<ShardManifest> {
        let expected = self.manifest(shard, table);
        let cases = self.plan.cases_of(shard);
        let are_its_cases = table.rows.iter().map(|row| row.case).eq(cases);
        let agrees = |(key, value): &(&str, String)| metadata.get(*key) == Some(value);
        (are_its_cases && expected.pairs().iter().all(agrees)).then_some(expected)
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

    /// Writes a shard atomically. A complete file that another process wrote meanwhile stays, since its
    /// content is the same; a damaged one is replaced.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be written.
    pub fn write(&self, shard: u64, table: &CaseTable) -> Result<ShardManifest, FileError> {
        let manifest = self.manifest(shard, table);
        let path = self.path(shard);
        let file = AtomicFile::create(&path)?;
        table.write(file.file(), &path, &manifest.pairs())?;
        if let Some(file) = file.commit()?
            && self.read(shard, &table.with_rows(Vec::new()))?.is_none()
        {
            file.replace(OF_THE_PLAN)?;
        }
        Ok(manifest)
    }

    /// Writes the rows of the study, `cases.parquet`, with the columns of `empty`: `fill` adds the rows, and
    /// the complete file replaces that of an earlier merge.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be written; the error of `fill`.
    pub(crate) fn write_cases(
        &self,
        empty: &CaseTable,
        fill: impl FnOnce(&mut CaseWriter<'_>) -> Result<(), Failure>,
    ) -> Result<PathBuf, Failure> {
        let path = self.folder.join("cases.parquet");
        let file = AtomicFile::create(&path)?;
        let of = [("study_hash", &self.plan.hash), ("version", &self.plan.version)];
        let notes = of.map(|(key, value)| (key.to_owned(), value.clone())).to_vec();
        let mut writer = CaseWriter::new(file.file(), &path, empty, notes)?;
        fill(&mut writer)?;
        writer.finish()?;
        file.replace(OF_THE_PLAN)?;
        Ok(path)
    }

    /// Writes the record of the study, `study.json`, which atomically replaces an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_record(&self, record: &StudyRecord) -> Result<PathBuf, Failure> {
        let path = self.folder.join("study.json");
        AtomicFile::with_text(&path, &to_json(record)?)?.replace(OF_THE_PLAN)?;
        Ok(path)
    }

    /// Writes the checksums of the files that are now complete.
    ///
    /// # Errors
    /// [`FileError::Io`] when a file cannot be read, or the checksums cannot be written.
    pub fn seal(&self) -> Result<(), FileError> {
        Checksums::write(&self.folder, &SEALED)
    }

    /// Writes the summary, `summary.json`, which atomically replaces an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_summary(&self, summary: &impl Serialize) -> Result<PathBuf, Failure> {
        let path = self.folder.join("summary.json");
        AtomicFile::with_text(&path, &to_json(summary)?)?.replace(OF_THE_PLAN)?;
        Ok(path)
    }
}

/// Earlier files that may be replaced in a directory with the plan of the study: any, because all of them
/// derive from the same cases.
const OF_THE_PLAN: ReplaceableFile<'static> =
    ReplaceableFile { description: "a file of the study", matches: &|_| true };

/// Files of a study listed with their checksums; the files of the shards contain their own.
const SEALED: [&str; 4] = ["plan.json", "study.json", "cases.parquet", "summary.json"];

/// Returns true if a file holds exactly these rows: also rejects a changed byte that affects no row, since it
/// may matter later.
fn is_just(table: &CaseTable, manifest: &ShardManifest, path: &Path) -> Result<bool, FileError> {
    let mut bytes = Vec::new();
    table.write(&mut bytes, path, &manifest.pairs())?;
    Ok(std::fs::read(path).map_err(|source| FileError::io(path, "read", source))? == bytes)
}

impl ShardManifest {
    /// Returns the manifest as the key-value pairs written beside the rows.
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

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value)
        .map(|json| json + "\n")
        .map_err(|error| Failure::Usage(format!("the result cannot be written as JSON: {error}")))
}
