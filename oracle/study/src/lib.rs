//! Studies: a pipeline over everything that can vary (Monte Carlo, sweeps, designs of experiments).
//!
//! A study is a scenario and the distributions of some of its parameters ([`StudyFile`]). Case k is a scenario of its own: its values are
//! drawn from the address (seed of the study, k), so that any shard, in any order, on any machine, gives the same rows. What
//! is made of a case is one row of a table ([`CaseRow`]): the values drawn, and every figure of its score.
//!
//! - [`StudyFile`], [`Distribution`], [`DesignKind`]: what is asked for.
//! - [`Study`]: what was asked for, checked; makes the scenario of a case.
//! - [`StudyPipeline`]: what is tried; built anew for every case.
//! - [`evaluate`]: simulates, processes and scores a case.
//! - [`Campaign`]: a study in a folder; makes what is missing of it.
//! - [`ShardStore`]: shards as files, each written at once or not at all; what is missing, what is whole.
//! - [`Summary`]: figures with intervals, sensitivities, the worst cases.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod campaign;
mod case_file;
mod cases;
#[cfg(test)]
mod coverage;
mod definition;
mod evaluate;
mod findings;
#[cfg(test)]
mod scale;
mod shard;

pub use campaign::{Campaign, CaseOutcome};
pub use case_file::CaseFile;
pub use cases::{CaseFigure, CaseRow, CaseTable, DrawnValue, case_columns};
pub use definition::design::DesignKind;
pub use definition::distribution::Distribution;
pub use definition::file::{Dispersion, Record, Stop, StudyFile, Sweep, Until};
pub use definition::overlay::{value_at, with_overlay};
pub use definition::{Case, Study};
pub use evaluate::engine::Workers;
pub use evaluate::{CaseResult, evaluate};
pub use findings::estimate::{Estimate, overall};
pub use findings::requirement::{
    Limit, RequiredStatistic, RequirementResult, RequirementVerdict, StudyRequirement,
};
pub use findings::sensitivity::{RankCorrelation, SobolIndex};
pub use shard::record::StudyRecord;

pub use evaluate::study_pipeline::{StudyPipeline, command_line};
pub use findings::stopping::StoppingStatus;
pub use findings::summary::{
    CaseError, CauseSummary, FigureSummary, Summary, SweepDifference, SweepPoint, WorstCase,
};
pub use shard::{Plan, ShardManifest, ShardStore};
