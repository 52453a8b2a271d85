//! Views of the worlds for the terminal and for annotated pictures.
//!
//! A world registers its views ([`register`]): its printed table and the panels of its pictures. A world
//! without views has the table of all figures and no pictures.

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

mod annotated_frame;
mod bounds;
mod score_table;
mod source;
pub mod terminal;
mod world_views;

pub use annotated_frame::{AnnotatedFrame, PixelSource, display_name, time_words};
pub use bounds::Bounds;
pub use score_table::score_table;
pub use source::{Source, not_stored, rows_of};
pub use world_views::{CloseUp, WorldViews, register, views_of};
