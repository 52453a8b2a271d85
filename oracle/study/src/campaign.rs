//! A study in a directory: missing shards are run, one after another, until the study is complete.
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

/// A study, the pipeline under test, and the directory of the results.
pub struct Campaign<'a> {
    study: &'a Study,
    pipeline: &'a dyn StudyPipeline,
    store: ShardStore,
    starts: StartCounter,
}

/// Record of the pipeline's starts in the cases that were run: a pipeline that starts in none of the first
/// [`MAX_FAILED_CASES`] is assumed to start in none.
#[derive(Debug, Default)]
struct StartCounter {
    has_started: AtomicBool,
    failed_cases: AtomicU64,
}

impl StartCounter {
    /// Counts a case, and returns an error after too many cases without a start.
    fn add(&self, case: &CaseResult, cases: u64) -> Result<(), Failure> {
        // A study of fewer cases, none of which can be run, also fails: rows of errors only are not a study.
        let most = if case.row.error.is_some() { MAX_FAILED_CASES.min(cases) } else { MAX_FAILED_CASES };
        if case.has_started || self.has_started.load(Ordering::Relaxed) {
            self.has_started.store(true, Ordering::Relaxed);
        } else if self.failed_cases.fetch_add(1, Ordering::Relaxed) + 1 >= most {
            return Err(Failure::Usage(match (&case.row.error, &case.first_failure) {
                (Some(error), _) => {
                    format!("none of the first {most} cases can be run; case {}: {error}", case.row.case)
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

/// A case that a campaign has completed.
#[derive(Debug, Clone, Copy)]
pub enum CaseOutcome<'a> {
    /// The case was read from an existing shard or its journal.
    Kept(&'a CaseRow),
    /// The case was run now.
    Run(&'a CaseResult),
}

impl CaseOutcome<'_> {
    /// Returns the row of the case.
    pub fn row(&self) -> &CaseRow {
        match self {
            Self::Kept(row) => row,
            Self::Run(evaluated) => &evaluated.row,
        }
    }
}

impl<'a> Campaign<'a> {
    /// Opens a directory for a study, new or partly complete. The study has `shards` shards, or as many as
    /// the directory's plan states, or shards of about 32 cases. Nothing is written before study and pipeline
    /// are known to be compatible.
    ///
    /// # Errors
    /// A [`Failure`] for a missing pipeline, and for a directory that holds another study, or the same study
    /// in other shards.
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

    /// Opens a directory that holds a plan of the study.
    ///
    /// # Errors
    /// The errors of [`Campaign::open`], and [`Failure::Usage`] if there is no plan.
    pub fn reopen(study: &'a Study, pipeline: &'a dyn StudyPipeline, out: &Path) -> Result<Self, Failure> {
        // A damaged plan is reported as such by `open`.
        if !ShardStore::has_plan(out) {
            return Err(Failure::Usage(format!(
                "{}: no plan.json in it, expected the directory of a study's shards",
                out.display()
            )));
        }
        Self::open(study, pipeline, out, None)
    }

    /// Returns the directory of the results.
    pub fn store(&self) -> &ShardStore {
        &self.store
    }

    /// Returns a shard, and runs it first if it is missing or damaged; `done` is called with each of its
    /// cases.
    ///
    /// # Errors
    /// The [`Failure`] of the first case that has one, or of files; [`Failure::Usage`] where the pipeline
    /// starts in none of the first cases.
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
            // A case whose pipeline did not start is not recorded: a later attempt may succeed.
            if case.has_started { Ok(journal.add(&case.row)?) } else { Ok(()) }
        })?);
        rows.sort_by_key(|row| row.case);
        let table = empty.with_rows(rows);
        let manifest = self.store.write(shard, &table)?;
        journal.remove();
        Ok((table, manifest))
    }

    /// Returns all cases, or as many as the stopping rule requires; runs the missing ones, and calls `done`
    /// with each case.
    ///
    /// # Errors
    /// The errors of [`Campaign::shard`].
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

    /// Returns all cases of the existing shards, or as many as the stopping rule requires.
    ///
    /// # Errors
    /// [`Failure::Usage`] when shards are missing or damaged, or the directory holds files that do not belong
    /// to the plan.
    pub fn merge(&self) -> Result<CaseFile, Failure> {
        self.store.check_foreign()?;
        self.gather()
    }

    /// Returns the error for the missing shards, of which `first` is known to be missing. `first` is not read
    /// again: another process may have written it since, and the table would still lack it.
    fn missing_shards(&self, first: u64) -> Result<Failure, Failure> {
        let shards = self.store.plan().shards;
        let mut missing = vec![first.to_string()];
        for shard in first + 1..=shards {
            if self.store.read(shard, &self.study.table())?.is_none() {
                missing.push(shard.to_string());
            }
        }
        Ok(Failure::Usage(format!(
            "shards {} of {shards} are missing or damaged; `boresight study run` runs them",
            missing.join(", ")
        )))
    }

    /// Writes the cases of the shards in order, until the stopping rule ends the study. Shards are read on
    /// all threads, a limited number at a time.
    fn gather(&self) -> Result<CaseFile, Failure> {
        let empty = self.study.table();
        let mut stopping = StoppingRule::new(self.study);
        let shards: Vec<u64> = (1..=self.store.plan().shards).collect();
        let read = |shard: &u64| -> Result<Option<CaseTable>, Failure> {
            Ok(self.store.read(*shard, &empty)?.map(|(table, _)| table))
        };
        let path = self.store.write_cases(&empty, |cases| {
            // Number of shards that keeps every thread busy, with few shards in memory.
            for some in shards.chunks(4 * rayon::current_num_threads()) {
                let tables: Result<Vec<_>, Failure> = some.par_iter().map(read).collect();
                for (shard, table) in some.iter().zip(tables?) {
                    let Some(mut table) = table else { return Err(self.missing_shards(*shard)?) };
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

    /// Summarises the gathered cases, and writes the summary beside them; `path` is the study's file, used in
    /// the commands that the summary states.
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
