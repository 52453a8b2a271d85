//! Shards: a study in pieces, each a file that is whole or not there.
//!
//! Shard i of n has the cases from ⌊i N/n⌋ on. Its file is written under another name, synced, and linked to its own, which never
//! replaces a file; in it stand the study's hash, the version, which shard it is, and the hash of its rows. What is not exactly so,
//! to the byte, is no shard: it is made again. So any number of processes may work on the same folder, be killed at any moment,
//! and be started again.

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

/// Cases of a shard, about, when their number is not given.
const CASES_PER_SHARD: u64 = 32;
/// Extension of the journal of a shard that is not whole.
const JOURNAL: &str = "journal";
/// Most shards of a study, when their number is not given.
const MAX_SHARDS: u64 = 1000;

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
    /// SHA-256 of all that stands before it: a plan that was damaged is not taken for another study's.
    #[serde(default)]
    pub sha256: String,
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

    /// Reads the plan of a folder, if it has one.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be read, and [`Failure::Usage`] when it is damaged: what it says is not what was written.
    fn read(path: &Path) -> Result<Self, Failure> {
        let text = sim::regular_file::read_text(path, 1 << 20)
            .map_err(|source| FileError::io(path, "read", source))?;
        let plan: Option<Self> = serde_json::from_str(&text).ok();
        plan.filter(|plan| plan.sha256 == plan.computed_sha256()).ok_or_else(|| {
            Failure::Usage(format!(
                "{}: is damaged (its checksum `sha256` does not agree); delete it, and with it study.json, cases.parquet, summary.json and \
                 SHA256SUMS where they are there: `boresight study run` makes them anew, with the shards that are whole",
                path.display()
            ))
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
    /// Opens a folder for a plan, and makes it when it is not there. What is in it must be of the same plan; without a plan, nothing in it
    /// may have a name of a study's files.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the folder holds another study, or the same one in other pieces; [`Failure`] of files.
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
            // Several processes may come to this at once: all write the same, and the first one's stays.
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

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// How the study is cut.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The number of shards of the plan that a folder already holds.
    pub fn planned_shards(folder: &Path) -> Option<u64> {
        Plan::read(&folder.join("plan.json")).ok().map(|plan| plan.shards)
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
            let is_journal = path.extension().is_some_and(|extension| extension == JOURNAL);
            let is_known =
                known.contains(&path) || is_journal && known.contains(&path.with_extension("parquet"));
            if !AtomicFile::is_partial(&path) && !is_known {
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

    /// The journal of a shard that is not whole, with the rows that it keeps.
    ///
    /// # Errors
    /// [`FileError::Io`] for a file that cannot be read or added to.
    pub(crate) fn journal(&self, shard: u64) -> Result<(Journal, Vec<CaseRow>), FileError> {
        Journal::open(self.path(shard).with_extension(JOURNAL), &self.plan.hash)
    }

    /// How many cases are finished, in whole shards and in others.
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

    /// The rows of a shard when its file is there, whole, and of this study.
    ///
    /// # Errors
    /// [`FileError::Io`] when there is a file that cannot be opened: it may be whole.
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

    /// Writes a shard, at once or not at all. When another process has written it meanwhile, its file stays: it says the same. A
    /// damaged one gives way.
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

    /// The rows of the study with the columns of `empty`, `cases.parquet`: `fill` adds them, and the file takes the place of that of an earlier
    /// merge when it is complete.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be written; that of `fill`.
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

    /// What the study is of, `study.json`, written at once in the place of an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_record(&self, record: &StudyRecord) -> Result<PathBuf, Failure> {
        let path = self.folder.join("study.json");
        AtomicFile::with_text(&path, &to_json(record)?)?.replace(OF_THE_PLAN)?;
        Ok(path)
    }

    /// Writes the checksums of what is complete now.
    ///
    /// # Errors
    /// [`FileError::Io`] when a file cannot be read, or the checksums not be written.
    pub fn seal(&self) -> Result<(), FileError> {
        Checksums::write(&self.folder, &SEALED)
    }

    /// The summary, `summary.json`, written at once in the place of an earlier one.
    ///
    /// # Errors
    /// [`Failure`] when it cannot be written.
    pub fn write_summary(&self, summary: &impl Serialize) -> Result<PathBuf, Failure> {
        let path = self.folder.join("summary.json");
        AtomicFile::with_text(&path, &to_json(summary)?)?.replace(OF_THE_PLAN)?;
        Ok(path)
    }
}

/// What a file of a folder replaces whose plan is that of the study: whatever it held, it is made of the same cases.
const OF_THE_PLAN: ReplaceableFile<'static> =
    ReplaceableFile { description: "a file of the study", matches: &|_| true };

/// The files of a study that have checksums: those of the shards stand in them.
const SEALED: [&str; 4] = ["plan.json", "study.json", "cases.parquet", "summary.json"];

/// Whether a file holds these rows and nothing else: a byte that was changed where no row shows it may be one that matters tomorrow.
fn is_just(table: &CaseTable, manifest: &ShardManifest, path: &Path) -> Result<bool, FileError> {
    let mut bytes = Vec::new();
    table.write(&mut bytes, path, &manifest.pairs())?;
    Ok(std::fs::read(path).map_err(|source| FileError::io(path, "read", source))? == bytes)
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

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value)
        .map(|json| json + "\n")
        .map_err(|error| Failure::Usage(format!("the result cannot be written as JSON: {error}")))
}
