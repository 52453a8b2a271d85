//! The frame grabber: from a video signal to digital numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{OutOfRange, bounds};

/// Contrast and brightness of the digitiser: DN = full scale × (contrast × signal + brightness), rounded and clipped.
/// The signal is 0 at the video's black level and 1 at its white level.
///
/// A pipeline may ask for another setting (the paper's "automatic brightness and contrast control of the image source
/// device"); it is in force from the next field that has not been digitised yet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Digitiser {
    /// Contrast, 0.1 to 20, without unit.
    #[schemars(range(min = 0.1, max = 20))]
    pub contrast: f64,
    /// Brightness, −10 to 10, in units of full scale.
    #[schemars(range(min = -10, max = 10))]
    pub brightness: f64,
}

impl Default for Digitiser {
    /// Black level to 0, white level to full scale.
    fn default() -> Self {
        Self::NEUTRAL
    }
}

impl Digitiser {
    /// Black level to 0, white level to full scale.
    pub const NEUTRAL: Self = Self { contrast: 1.0, brightness: 0.0 };

    /// Checks both numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first one outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "digitiser")
    }
}
