//! A study in a folder: what is missing of it is made, shard by shard, until it is done.
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use files::Failure;
use rayon::prelude::*;

use crate::case_file::CaseFile;
use crate::cases::{CaseRow, CaseTable};
use crate::definition::{MAX_FAILED_CASES, Study};
use crate::evaluate::CaseResult;
use crate::evaluate::engine::{Workers, run_cases};
use crate::evaluate::study_pipeline::StudyPipeline;
use crate::findings::stopping::StoppingRule;
use crate::findings::summary::Summary;
use crate::shard::record::StudyRecord;
use crate::shard::{Plan, ShardManifest, ShardStore};

/// A study, the pipeline that it tries, and the folder of its results.
pub struct Campaign<'a> {
    study: &'a Study,
    pipeline: &'a dyn StudyPipeline,
    store: ShardStore,
    starts: StartCounter,
}

/// What is known of the pipeline's starts in the cases that were run: where it starts in none of the first
/// [`MAX_FAILED_CASES`], it would start in none.
#[derive(Debug, Default)]
struct StartCounter {
    has_started: AtomicBool,
    failed_cases: AtomicU64,
}

impl StartCounter {
    /// Counts a case, and refuses to go on where there were too many without a start.
    fn add(&self, case: &CaseResult, cases: u64) -> Result<(), Failure> {
        // Of a study of fewer cases none can be run: rows of errors alone are no study.
        let most = if case.row.error.is_some() { MAX_FAILED_CASES.min(cases) } else { MAX_FAILED_CASES };
        if case.has_started || self.has_started.load(Ordering::Relaxed) {
            self.has_started.store(true, Ordering::Relaxed);
        } else if self.failed_cases.fetch_add(1, Ordering::Relaxed) + 1 >= most {
            return Err(Failure::Usage(match (&case.row.error, &case.first_failure) {
                (Some(error), _) => {
                    format!("none of the first {most} cases can be run; of case {}: {error}", case.row.case)
                }
                (None, first) => {
                    let reason = first.as_ref().map_or("", |first| &first.reason);
                    format!(
                        "the pipeline did not start in any of the first {MAX_FAILED_CASES} cases: {reason}"
                    )
                }
            }));
        }
        Ok(())
    }
}

/// A case that a campaign knows.
#[derive(Debug, Clone, Copy)]
pub enum CaseOutcome<'a> {
    /// It was in a shard that is there already.
    Kept(&'a CaseRow),
    /// It was run now.
    Run(&'a CaseResult),
}

impl CaseOutcome<'_> {
    /// Its row.
    pub fn row(&self) -> &CaseRow {
        match self {
            Self::Kept(row) => row,
            Self::Run(evaluated) => &evaluated.row,
        }
    }
}

impl<'a> Campaign<'a> {
    /// Opens a folder for a study, new or with a part of it; in `shards` pieces, or as many as its plan says, or of about 32 cases. Nothing
    /// is written before study and pipeline are known to go together.
    ///
    /// # Errors
    /// A [`Failure`] for a pipeline that is not there, and a folder that holds another study, or the same one in other pieces.
    pub fn open(
        study: &'a Study,
        pipeline: &'a dyn StudyPipeline,
        out: &Path,
        shards: Option<u64>,
    ) -> Result<Self, Failure> {
        pipeline.check(study.scenario())?;
        let shards = shards.or_else(|| ShardStore::planned_shards(out));
        let plan = Plan::new(study, study.hash_with(pipeline), shards)?;
        Ok(Self { study, pipeline, store: ShardStore::open(out, plan)?, starts: StartCounter::default() })
    }

    /// Opens a folder that holds a plan of the study.
    ///
    /// # Errors
    /// As [`Campaign::open`], and [`Failure::Usage`] where there is no plan.
    pub fn reopen(study: &'a Study, pipeline: &'a dyn StudyPipeline, out: &Path) -> Result<Self, Failure> {
        if ShardStore::planned_shards(out).is_none() {
            return Err(Failure::Usage(format!(
                "{}: there is no plan.json that can be read, expected the directory of a study's shards",
                out.display()
            )));
        }
        Self::open(study, pipeline, out, None)
    }

    /// Its folder.
    pub fn store(&self) -> &ShardStore {
        &self.store
    }

    /// A shard, made if it is missing or damaged; `done` is told of each of its cases.
    ///
    /// # Errors
    /// The [`Failure`] of the first case that has one, or of files; [`Failure::Usage`] where the pipeline starts in none of the first cases.
    pub fn shard(
        &self,
        shard: u64,
        workers: Workers<'_>,
        done: impl Fn(CaseOutcome<'_>) + Sync,
    ) -> Result<(CaseTable, ShardManifest), Failure> {
        let empty = self.study.table();
        if let Some((table, manifest)) = self.store.read(shard, &empty)? {
            table.rows.iter().for_each(|row| done(CaseOutcome::Kept(row)));
            return Ok((table, manifest));
        }
        let mut cases: BTreeSet<u64> = self.store.plan().cases_of(shard).collect();
        let (journal, kept) = self.store.journal(shard)?;
        let mut rows: Vec<CaseRow> = kept.into_iter().filter(|row| cases.remove(&row.case)).collect();
        rows.iter().for_each(|row| done(CaseOutcome::Kept(row)));
        let cases = cases.into_iter().collect();
        rows.extend(run_cases(self.study, cases, self.pipeline, workers, |case| {
            done(CaseOutcome::Run(case));
            self.starts.add(case, self.study.cases())?;
            // A pipeline that did not start may do so another time.
            if case.has_started { Ok(journal.add(&case.row)?) } else { Ok(()) }
        })?);
        rows.sort_by_key(|row| row.case);
        let table = empty.with_rows(rows);
        let manifest = self.store.write(shard, &table)?;
        journal.remove();
        Ok((table, manifest))
    }

    /// All cases, or as many as the stopping rule asks for; what is missing is made, and `done` is told of each case.
    ///
    /// # Errors
    /// As [`Campaign::shard`].
    pub fn run(
        &self,
        workers: Workers<'_>,
        done: impl Fn(CaseOutcome<'_>) + Sync,
    ) -> Result<CaseFile, Failure> {
        let mut stopping = StoppingRule::new(self.study);
        for shard in 1..=self.store.plan().shards {
            let (table, _) = self.shard(shard, workers, &done)?;
            if stopping.add(&table).is_some() {
                break;
            }
        }
        self.gather()
    }

    /// All cases, or as many as the stopping rule asks for, of the shards that are there.
    ///
    /// # Errors
    /// [`Failure::Usage`] when shards are missing or damaged, or files are there that are none of the plan's.
    pub fn merge(&self) -> Result<CaseFile, Failure> {
        self.store.check_foreign()?;
        self.gather()
    }

    /// What to say of the shards that are not there, of which one is known. That one is not looked for again: another process may have
    /// made it since, and the table would still be without it.
    fn missing(&self, first: u64) -> Result<Failure, Failure> {
        let shards = self.store.plan().shards;
        let mut missing = vec![first.to_string()];
        for shard in first + 1..=shards {
            if self.store.read(shard, &self.study.table())?.is_none() {
                missing.push(shard.to_string());
            }
        }
        Ok(Failure::Usage(format!(
            "shards {} of {shards} are missing or were damaged; `boresight study run` makes them",
            missing.join(", ")
        )))
    }

    /// Writes the cases of the shards in order, up to where the stopping rule stops. Shards are read on all threads, some at a time.
    fn gather(&self) -> Result<CaseFile, Failure> {
        let empty = self.study.table();
        let mut stopping = StoppingRule::new(self.study);
        let shards: Vec<u64> = (1..=self.store.plan().shards).collect();
        let read = |shard: &u64| -> Result<Option<CaseTable>, Failure> {
            Ok(self.store.read(*shard, &empty)?.map(|(table, _)| table))
        };
        let path = self.store.write_cases(&empty, |cases| {
            // Enough that no thread waits for long, and few in memory.
            for some in shards.chunks(4 * rayon::current_num_threads()) {
                let tables: Result<Vec<_>, Failure> = some.par_iter().map(read).collect();
                for (shard, table) in some.iter().zip(tables?) {
                    let Some(mut table) = table else { return Err(self.missing(*shard)?) };
                    let enough = stopping.add(&table);
                    if let Some(count) = enough {
                        table.rows.retain(|row| row.case < count);
                    }
                    cases.add(&table)?;
                    if enough.is_some() {
                        return Ok(());
                    }
                }
            }
            Ok(())
        })?;
        Ok(CaseFile::open(&path, empty, self.study.cases_together())?)
    }

    /// Sums up the cases that were gathered, and writes the summary beside them; `path` is the study's file, for its commands.
    ///
    /// # Errors
    /// A [`Failure`] of files.
    pub fn finish(&self, path: &Path, cases: &CaseFile) -> Result<Summary, Failure> {
        let summary = Summary::new(self.study, self.pipeline, path, cases)?;
        self.store.write_record(&StudyRecord::new(self.study)?)?;
        self.store.write_summary(&summary)?;
        self.store.seal()?;
        Ok(summary)
    }
}
