//! Studies of a pipeline over all parameters that can vary (Monte Carlo, sweeps, designs of experiments).
//!
//! A study is a scenario and the distributions of some of its parameters ([`StudyFile`]). Case k is a
//! separate scenario: its values are drawn from the address (seed of the study, k), and any shard, in any
//! order, on any machine, gives the same rows. Each case results in one row of a table ([`CaseRow`]): the
//! drawn values, and every figure of its score.
//!
//! - [`StudyFile`], [`Distribution`], [`DesignKind`]: definition of a study, as a file states it.
//! - [`Study`]: a checked study; creates the scenario of a case.
//! - [`StudyPipeline`]: pipeline under test; created anew for every case.
//! - [`evaluate`]: simulates, processes and scores a case.
//! - [`Campaign`]: a study in a directory; runs the missing shards.
//! - [`ShardStore`]: shards as files, each written atomically; reports missing and complete ones.
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
#[cfg(test)]
mod figures_of_tests;
mod findings;
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
