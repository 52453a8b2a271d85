//! Hot pixels: pixels that are isolated and bright in several frames.

use std::collections::HashMap;

/// Number of frames in which a pixel must be isolated and bright to count as hot.
const FRAMES: u32 = 3;

/// Number of frames in which each pixel was isolated and bright, by the pixel's index in the image.
#[derive(Debug, Clone, Default)]
pub(super) struct HotPixels {
    frames: HashMap<usize, u32>,
}

impl HotPixels {
    /// Counts a frame in which the pixel was isolated and bright.
    pub(super) fn count(&mut self, index: usize) {
        *self.frames.entry(index).or_default() += 1;
    }

    /// Returns true if the pixel is hot.
    pub(super) fn contains(&self, index: usize) -> bool {
        self.frames.get(&index).is_some_and(|&frames| frames >= FRAMES)
    }

    /// Returns the indices of the hot pixels, unordered.
    pub(super) fn indices(&self) -> impl Iterator<Item = usize> {
        self.frames.iter().filter(|(_, frames)| **frames >= FRAMES).map(|(index, _)| *index)
    }
}
