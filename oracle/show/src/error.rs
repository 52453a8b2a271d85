//! Errors of drawing a picture.

use thiserror::Error;

/// Largest number of panels of a contact sheet.
pub const MAX_PANELS: usize = 16;

/// Reason why a picture cannot be drawn.
#[derive(Debug, Error)]
pub enum ShowError {
    /// No panel, or too many panels for a picture.
    #[error("{0} frames are selected, expected 1 to {MAX_PANELS}")]
    PanelCount(usize),
    /// A view without pixels, or a canvas that cannot be allocated.
    #[error("a picture of {width} × {height} pixels cannot be drawn")]
    Size {
        /// Width, px.
        width: usize,
        /// Height, px.
        height: usize,
    },
    /// The PNG encoder failed.
    #[error("the picture cannot be encoded: {0}")]
    Encode(String),
}
