//! The gate: whether a result is worse than a baseline, with statistics.
//!
//! A baseline is a scored run or study, unit by unit (frame, field or case), made by a deliberate command with a reason, small enough to
//! be committed ([`Baseline`]). A result is the same scenario again, by a pipeline that may have changed ([`read_result`]). Where the frames
//! are the same, which their digest proves, each is its own control; where only the seed differs, stretches of time are ([`Pairing`]).
//! Anything else cannot be compared, and [`Identity::pairing`] says by what it differs.
//!
//! Frames of a sequence are not independent. So both are cut into blocks longer than what is remembered (`blocks`), each figure is reduced
//! to what each block adds to the difference (`effects`), and those are tested together by exchanging blocks
//! ([`statistics::joint_test`]). [`compare`] does it all; [`GateReport`] is what it found.

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
pub use dependence::blocks::{Blocks, LEAST_BLOCKS};
pub use dependence::runs::LossRun;
pub use identity::{Identity, Pairing, SourceKind};
pub use read::read_result;
pub use report::junit::{junit, junit_of_failure};
pub use report::{FigureReport, FigureVerdict, GateReport};
pub use sample::Sample;
