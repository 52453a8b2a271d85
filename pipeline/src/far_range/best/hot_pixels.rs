//! Hot pixels: pixels that are bright alone in several frames.

use std::collections::HashMap;

/// Frames in which a pixel must be bright alone to count as hot.
const FRAMES: u32 = 3;

/// Pixels that were bright alone, by their index in the image, with the number of frames.
#[derive(Debug, Clone, Default)]
pub(super) struct HotPixels {
    frames: HashMap<usize, u32>,
}

impl HotPixels {
    /// Counts a frame in which the pixel was bright alone.
    pub(super) fn count(&mut self, index: usize) {
        *self.frames.entry(index).or_default() += 1;
    }

    /// Returns true if the pixel is hot.
    pub(super) fn contains(&self, index: usize) -> bool {
        self.frames.get(&index).is_some_and(|&frames| frames >= FRAMES)
    }

    /// Indices of the hot pixels, in no order.
    pub(super) fn indices(&self) -> impl Iterator<Item = usize> {
        self.frames.iter().filter(|(_, frames)| **frames >= FRAMES).map(|(index, _)| *index)
    }
}
