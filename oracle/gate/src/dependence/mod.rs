//! How units of a run depend on one another: memory, blocks, and what each adds to a figure.

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
