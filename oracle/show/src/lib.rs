//! Annotated pictures of frames: pixels, true objects, the pipeline's outcome, transmitted regions, a scale
//! bar and a legend.
//!
//! [`picture`] is a pure function of [`Panel`]s: a single frame is drawn large, with a close-up and a table
//! beside it; several frames form a contact sheet. [`encode`] returns the picture as a PNG with a palette,
//! which names this program in a text chunk; [`is_boresight_picture`] recognises this chunk. This crate
//! neither reads nor writes files.
//!
//! Positions are pixels of the frame: the centre of the first pixel is (0, 0).

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

mod canvas;
mod error;
mod layout;
mod panel;
mod png_file;

pub use error::{MAX_PANELS, ShowError};
pub use layout::view::Placement;
pub use layout::{PanelLayout, Picture, image, picture};
pub use panel::class::{Class, Colour, Symbol};
pub use panel::stretch::Stretch;
pub use panel::{Mark, Panel, Pixels, PlateScale, Reduction, Shape, Table, Tone, Verdict};
pub use png_file::{encode, is_boresight_picture};
