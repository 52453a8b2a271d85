//! Comparison of a result with a baseline, figure by figure.

pub(crate) mod comparable;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod compare;
pub(crate) mod flips;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod judge;
pub(crate) mod notes;
pub(crate) mod options;
