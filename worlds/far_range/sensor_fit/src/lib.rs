//! Figures of an image sensor from stacks of bias, dark and flat frames, in the terms of EMVA Standard 1288.
//!
//! The steps, each a module:
//!
//! 1. [`stack`]: the frames, and checks of them before any figure.
//! 2. `moments`: mean and temporal noise of each stack, split into pixels, rows and columns.
//! 3. `defects`: pixels that take no part: hot, dead, noisy, or of another response.
//! 4. `photon_transfer`: means and variances of all stacks together give gain, read noise, bias, dark current
//!    and the curvature of the response; `rounding` frees the variances of the converter's rounding.
//! 5. `saturation`: levels that the converter or the full wells cut, and the full well.
//! 6. `patterns`: fixed differences of offset, dark current and response between pixels.
//! 7. `linearity`: deviation of the means from a straight line.
//!
//! [`fit_sensor`] is these steps in order.

mod defects;
mod figures;
mod fit;
mod linearity;
mod moments;
mod patterns;
mod photon_transfer;
mod rounding;
mod saturation;
pub mod stack;

pub use figures::{DefectCounts, Finding, HotPixels, LevelSummary, SaturationLimit, SensorFigures};
pub use fit::fit_sensor;
pub use stack::{FrameStack, SensorFitError, SensorFrames};
