//! Findings of a study: figures with intervals, requirements, sensitivities, the rule that stops it.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod estimate;
pub(crate) mod requirement;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod sensitivity;
pub(crate) mod stopping;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod summary;
