//! Score of a docking run: a pure function of the truth and of the pipeline's outcome for each field.
//!
//! Every field is counted exactly once and has one [`Verdict`]: success, range only, doubtful, grossly wrong,
//! or missed with one cause. The sizes of the errors, and their consistency with the stated covariances
//! ([`consistency`]), are counted over the successes. The motions reported at the end of portions
//! (`portions`), and the time until a report, have separate figures. `docs/evidence/score.md` has the
//! complete definitions.

mod accumulate;
mod approach_parameters;
mod bins;
mod cause;
pub mod consistency;
mod errors;
mod field_verdict;
mod figures;
#[cfg(test)]
mod hand_made;
mod imaging_geometry;
mod portions;
mod report;
mod truth;
mod verdict;

pub use accumulate::{DockingContext, DockingScorer, figures};
pub use approach_parameters::ApproachParameters;
pub use bins::{RANGE_BINS_M, group_name, lens_names};
pub use cause::MissCause;
pub use errors::PoseErrors;
pub use report::{DockingGroup, DockingScore, names};
pub use truth::{TargetVisibility, TrueField};
pub use verdict::{GrossError, Limits, Verdict};
