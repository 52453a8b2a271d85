//! Relative navigation from lines of sight.
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

#[allow(clippy::indexing_slicing, reason = "indices are those of the measurements received")]
mod batch;
#[allow(clippy::indexing_slicing, reason = "constant indices of small matrices")]
mod bound;
mod config;
#[allow(clippy::indexing_slicing, reason = "columns are those of the layout of the state")]
mod filter;
#[allow(clippy::indexing_slicing, reason = "indices are those of the entries")]
mod history;
#[allow(clippy::indexing_slicing, reason = "indices of the grid of distances")]
mod initial;
#[allow(clippy::indexing_slicing, reason = "columns are those of the layout of the state")]
mod layout;
mod linearisation;
pub mod orbit;
#[allow(clippy::indexing_slicing, reason = "columns are those of the parameters")]
mod parameters;
#[allow(clippy::indexing_slicing, reason = "columns are those of the parameters")]
mod path;
#[allow(clippy::indexing_slicing, reason = "columns are those of the parameters")]
mod problem;
#[allow(clippy::indexing_slicing, reason = "constant indices of small matrices; pieces are counted")]
pub mod reference;
#[allow(clippy::indexing_slicing, reason = "constant indices of small matrices")]
pub mod relative;
#[allow(clippy::indexing_slicing, reason = "constant indices of small matrices")]
mod relative_state;
#[allow(clippy::indexing_slicing, reason = "indices are those of the events received")]
mod sequential;
pub mod short_period;
#[allow(clippy::indexing_slicing, reason = "two axes")]
mod sight;
#[allow(clippy::indexing_slicing, reason = "two axes")]
mod slow_errors;
#[allow(clippy::indexing_slicing, reason = "sizes are those of the layout of the state")]
mod smoother;
#[allow(clippy::indexing_slicing, reason = "sizes are those of the matrix")]
mod square_root;
mod time;
#[allow(clippy::indexing_slicing, reason = "columns are those of the layout of the state")]
mod transition;
#[allow(clippy::indexing_slicing, reason = "sizes are those of the filter")]
mod whitener;

pub use batch::{Batch, BatchFactory};
pub use bound::{Bound, Observability};
pub use config::{BatchConfig, ModelErrors, SequentialConfig};
pub use initial::Hypothesis;
pub use sequential::{Sequential, SequentialFactory};
pub use short_period::Osculation;
