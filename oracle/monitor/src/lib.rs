//! The monitor: what an operator sees of an approach, as a page served on loopback.
//!
//! One frame after the other is simulated and processed ahead of what the page shows, or read from a run directory
//! (`feed`); what is known of each is kept (`session`), its picture as long as there is room, and drawn anew after that
//! (`painter`): frame N alone is the frame N of the run. The server (`server`) gives any frame by its number and keeps
//! nothing of its clients.

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

mod docking;
mod far_range;
mod feed;
mod ground;
mod plan;
mod report;
mod server;
mod session;

pub use feed::{Feed, MAX_FRAMES, Measurements};
pub use server::assets::{BUILD_COMMAND, is_page_built};
pub use server::serve;
