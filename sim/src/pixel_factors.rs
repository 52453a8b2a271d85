//! A factor of every pixel of a detector, the same in every frame.

use std::ops::Deref;
use std::sync::Arc;

/// Factors of the pixels of a detector, row by row, none below 0; shared by all frames.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PixelFactors {
    values: Arc<[f32]>,
    largest: f32,
}

impl PixelFactors {
    /// The largest of them; 0 without any.
    pub(crate) fn largest(&self) -> f64 {
        f64::from(self.largest)
    }
}

impl Deref for PixelFactors {
    type Target = [f32];
    fn deref(&self) -> &[f32] {
        &self.values
    }
}

impl FromIterator<f32> for PixelFactors {
    fn from_iter<I: IntoIterator<Item = f32>>(factors: I) -> Self {
        let values: Arc<[f32]> = factors.into_iter().collect();
        let largest = values.iter().copied().fold(0.0, f32::max);
        Self { values, largest }
    }
}
