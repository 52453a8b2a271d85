//! The monitor: the operator's view of an approach, as a page served on loopback.
//!
//! Frames are simulated and processed in order ahead of the frame that the page shows, or read from a run
//! directory (`feed`). The report of each frame is kept (`session`); its picture is kept as long as there is
//! room, and afterwards drawn anew (`painter`), since frame N can be computed independently of the frames
//! before it. The server (`server`) provides any frame by its number and keeps no state of its clients.

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

pub mod feed;
pub mod ground;
pub mod plan;
pub mod report;
mod server;
pub mod session;

pub use feed::{Feed, MAX_FRAMES, Measurements, register};
pub use server::overview::camera;
pub use server::serve;
