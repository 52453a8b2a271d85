//! Studies: a pipeline over everything that can vary (Monte Carlo, sweeps, designs of experiments).
//!
//! A study is a scenario and the laws of some of its parameters ([`StudyFile`]). Case k is a scenario of its own: its values are
//! drawn from the address (seed of the study, k), so that any shard, in any order, on any machine, gives the same rows. What
//! is made of a case is one row of a table ([`CaseRow`]): the values drawn, and every figure of its score.
//!
//! - [`StudyFile`], [`Law`], [`DesignKind`]: what is asked for.
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
mod cases;
mod definition;
mod design;
mod engine;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod estimate;
mod evaluate;
mod file;
mod journal;
mod law;
mod overlay;
mod record;
mod requirement;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod sensitivity;
mod shard;
mod stopping;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod summary;
mod tried;

pub use campaign::{Campaign, Known};
pub use cases::{CaseFigure, CaseRow, CaseTable, Drawn};
pub use definition::{Case, Study};
pub use design::DesignKind;
pub use engine::Workers;
pub use estimate::{Estimate, overall};
pub use evaluate::{Evaluated, evaluate};
pub use file::{Dispersion, Record, Stop, StudyFile, Sweep, Until};
pub use law::Law;
pub use overlay::{value_at, with_overlay};
pub use record::StudyRecord;
pub use requirement::{Limit, RequiredOf, RequirementResult, RequirementVerdict, StudyRequirement};
pub use sensitivity::{RankCorrelation, SobolIndex};

pub use shard::{Plan, ShardManifest, ShardStore};
pub use stopping::Waited;
pub use summary::{CaseError, CauseSummary, FigureSummary, Summary, SweepDifference, SweepPoint, WorstCase};
pub use tried::{StudyPipeline, command_line};
