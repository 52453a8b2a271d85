//! Likeness of two sets of frames of the night sky: those of a camera, and those of its twin.
//!
//! [`compare`] measures both sets in the same way and gives a [`Likeness`] per figure: the two values, their
//! difference with an interval of 95 %, and the smallest difference that the frames would show. The subjects,
//! each a module:
//!
//! 1. [`background`]: level, unevenness, noise of a pixel, of a row and of a column, correlation of
//!    neighbours.
//! 2. [`hot_pixels`]: pixels that are bright in most frames.
//! 3. [`stars`]: brightness, colour, width and scatter of the positions of the stars that both sets show.
//! 4. `geometry`: focal length, principal point and distortion.

pub mod background;
mod baseline;
mod compare;
mod difference;
mod estimate;
mod geometry;
pub mod hot_pixels;
mod offsets;
mod spectrum;
pub mod stars;

pub use baseline::{Change, KeptComparison, KeptFigure, changes};
pub use compare::{Comparison, Histogram, compare};
pub use difference::{Likeness, NotCompared, Unit};
pub use estimate::Estimate;
pub(crate) use offsets::{centred, covariance, variance_of_offsets};
pub use spectrum::{LENGTH_PX, Spectrum};
