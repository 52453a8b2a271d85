//! Frames with the camera that was fitted to them.

use camera_fit::{CameraFit, SkyFrame};
use rayon::prelude::*;

use crate::likeness::background::FrameBackground;

/// Frames of a camera with the fit to them.
#[derive(Debug)]
pub struct FrameSet {
    /// Frames, with and without an attitude.
    pub frames: Vec<SkyFrame>,
    /// Camera fitted to them.
    pub fit: CameraFit,
}

impl FrameSet {
    /// Returns the frame with the attitude number `index` of the fit.
    pub fn solved(&self, index: usize) -> Option<&SkyFrame> {
        let name = &self.fit.frames.get(index)?.name;
        self.frames.iter().find(|frame| frame.name == *name)
    }

    /// Measures the background of every frame with an attitude; `bin_dn` is the unit of the histograms, DN.
    pub fn backgrounds(&self, bin_dn: f64) -> Vec<FrameBackground> {
        (0..self.fit.frames.len())
            .into_par_iter()
            .filter_map(|index| FrameBackground::of(&self.solved(index)?.image, bin_dn))
            .collect()
    }
}
