//! The gate: tests statistically whether a result is worse than a baseline.
//!
//! A baseline is a scored run or study, unit by unit (frame, field or case), made by a deliberate command
//! with a reason, and small enough to be committed ([`Baseline`]). A result is a repetition of the same
//! scenario by a pipeline that may have changed ([`read_result`]). If the frames are the same, which their
//! digest proves, each frame is its own control; if only the seed differs, time spans are compared
//! ([`Pairing`]). No other pair of runs can be compared; the error of [`Identity::pairing`] names the
//! difference.
//!
//! Frames of a sequence are not independent. Therefore baseline and result are cut into blocks longer than
//! the autocorrelation time (`blocks`), each figure is reduced to the contribution of each block to the
//! difference (`effects`), and the contributions of all figures are tested jointly by exchanging blocks
//! ([`statistics::joint_test`]). [`compare`] performs all steps and returns a [`GateReport`].

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

mod baseline;
mod comparison;
mod dependence;
#[cfg(test)]
mod hand_made;
mod identity;
mod read;
mod report;
mod sample;

pub use baseline::rows::row_columns;
pub use baseline::{Baseline, BaselineFigure, BaselineHeader, BlockRule, Replacement};
pub use comparison::compare::compare;
pub use comparison::flips::{Flip, FlipKind, Flips};
pub use comparison::options::CompareOptions;
pub use dependence::blocks::{Blocks, MIN_BLOCKS};
pub use dependence::runs::LossRun;
pub use identity::{Identity, Pairing, SourceKind};
pub use read::read_result;
pub use report::junit::{JUNIT_DOCUMENTS, junit, junit_of_failure};
pub use report::{FigureReport, FigureVerdict, GateReport};
pub use sample::Sample;
