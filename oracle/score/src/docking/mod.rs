//! The score of a docking run: a pure function of the truth and of what a pipeline said about each field.
//!
//! Every field is counted exactly once and gets one [`Verdict`]: measured and right, measured and grossly wrong, the
//! range alone, or missed for one cause. How large the errors are is counted over the right ones, whether they are as
//! large as the pipeline says ([`consistency`]) as well; what is said at the end of a portion (`portions`) and how
//! long it takes has figures of its own. `docs/score.md` has the definitions in full.

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
