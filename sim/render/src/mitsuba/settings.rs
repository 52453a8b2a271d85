//! Sampling of a rendered scene, and the rendered part of its image.

use contract::{Camera, OutOfRange};

/// Part of the image, px.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
}

impl Crop {
    /// Returns the whole image of a camera.
    pub fn full_frame(camera: &Camera) -> Self {
        Self { x: 0, y: 0, columns: camera.columns, rows: camera.rows }
    }
}

/// Settings of the rendering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Rays per pixel, the square of an integer from 1 to 64 (stratified as n × n). With 256 a flat surface
    /// has a noise of 0.013 % of full scale, a pixel on an edge 0.44 %.
    pub samples: u32,
    /// Rendered part; `None`: the whole image.
    pub crop: Option<Crop>,
}

impl Default for Settings {
    /// 256 rays per pixel, the whole image.
    fn default() -> Self {
        Self { samples: 256, crop: None }
    }
}

impl Settings {
    /// Checks the settings for a camera, and returns the rendered part.
    ///
    /// # Errors
    /// [`OutOfRange`] for a number of samples that is no square, and a crop that is empty or extends beyond
    /// the image.
    pub fn check(&self, camera: &Camera) -> Result<Crop, OutOfRange> {
        if !(1..=64).any(|side| side * side == self.samples) {
            let expected = "the square of an integer from 1 to 64: 16, 64, 256, …";
            return Err(OutOfRange::new("samples", self.samples, expected));
        }
        let crop = self.crop.unwrap_or_else(|| Crop::full_frame(camera));
        let fits = |from: usize, length: usize, side: usize| {
            length > 0 && from.checked_add(length).is_some_and(|end| end <= side)
        };
        if fits(crop.x, crop.columns, camera.columns) && fits(crop.y, crop.rows, camera.rows) {
            Ok(crop)
        } else {
            let value = format!("{}×{} px at ({}, {})", crop.columns, crop.rows, crop.x, crop.y);
            Err(OutOfRange::new("crop", value, "a non-empty rectangle within the camera's image"))
        }
    }
}
