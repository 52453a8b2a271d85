//! Dependence between the units of a run: autocorrelation, blocks, and the contribution of each unit or block
//! to a figure.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod blocks;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod effects;
pub(crate) mod influence;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod memory;
pub(crate) mod runs;
