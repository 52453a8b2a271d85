//! Frame grabber: conversion of a video signal to digital numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{OutOfRange, bounds};

/// Contrast and brightness of the digitiser: DN = full scale × (contrast × signal + brightness), rounded and
/// clipped. The signal is 0 at the video's black level and 1 at its white level.
///
/// A pipeline may request another setting (the paper's "automatic brightness and contrast control of the
/// image source device"). The request takes effect from the next field that has not been digitised yet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Digitiser {
    /// Contrast, dimensionless, 0.1 to 20.
    #[schemars(range(min = 0.1, max = 20))]
    pub contrast: f64,
    /// Brightness, −10 to 10, in units of full scale.
    #[schemars(range(min = -10, max = 10))]
    pub brightness: f64,
}

impl Default for Digitiser {
    /// Maps the black level to 0 and the white level to full scale.
    fn default() -> Self {
        Self::NEUTRAL
    }
}

impl Digitiser {
    /// Setting that maps the black level to 0 and the white level to full scale.
    pub const NEUTRAL: Self = Self { contrast: 1.0, brightness: 0.0 };

    /// Checks the ranges of contrast and brightness.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "digitiser")
    }
}
