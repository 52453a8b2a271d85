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
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod blocks;
mod comparable;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod compare;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod effects;
mod flips;
#[cfg(test)]
mod hand_made;
mod identity;
mod influence;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod judge;
mod junit;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod memory;
mod notes;
mod options;
mod read;
mod report;
mod rows;
mod runs;
mod sample;
mod tolerance;

pub use baseline::{Baseline, BaselineFigure, BaselineHeader, BlockRule, Replace};
pub use blocks::{Blocks, LEAST_BLOCKS};
pub use compare::compare;
pub use flips::{Flip, FlipKind, Flips};
pub use identity::{Identity, Pairing, SourceKind};
pub use junit::{junit, junit_of_failure};
pub use options::CompareOptions;
pub use read::read_result;
pub use report::{FigureReport, FigureVerdict, GateReport};
pub use runs::LossRun;
pub use sample::Sample;
