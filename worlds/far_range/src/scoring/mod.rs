//! The score: a pure function of the ground truth and of a pipeline's outcomes.
//!
//! Every frame is counted exactly once and gets one [`Verdict`]. The score distinguishes two notions:
//!
//! - *Detected*, as counted in the far-range paper: the pipeline reports a target, rightly or wrongly. The
//!   accuracy figures of the paper (its Table 2) are counted over these frames.
//! - *Correct*: according to the truth table, most electrons of the chosen cluster come from the target.
//!
//! The verdict depends only on the truth and on the reported position and line of sight. A measurement file
//! of an external pipeline therefore gets the same figures as a built-in run. Only the *cause* of a miss also
//! uses the labelled clusters that a pipeline may report; without them the cause follows from the truth only.

mod accumulate;
mod angles;
mod argon_table2;
mod cause;
mod cluster_members;
mod covariance;
#[cfg(test)]
mod hand_made;
mod report;
mod settling;
mod verdict;

pub use accumulate::{FarRangeJudgement, ScoreContext, Scorer, figures, unit_table};
pub use angles::{AnswerError, AttitudeUsed, GrantedAttitude, LineOfSightError, WithinLimits};
pub use argon_table2::{ARGON_TABLE_2, Table2, Table2Distance};
pub use cause::Cause;
pub use cluster_members::brightest_member;
pub use covariance::image_state::ImageState;
pub use report::{ConsistencyRow, GroupScore, Score, ThresholdPoint, names};
pub use verdict::{FrameVerdict, MistakenObject, Unproject, Verdict, VerdictRow};
