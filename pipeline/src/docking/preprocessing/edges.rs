//! Edges by Canny's method: an alternative to the regions where no threshold separates target and plate.

use contract::OutOfRange;
use contract::bounds::require;
use imageproc::edges::canny;
use imageproc::image::GrayImage;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of Canny's hysteresis: magnitudes of the Sobel gradient of the 8-bit image, 0 to 1140.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EdgeConfig {
    /// Gradient above which an edge continues, 1 to 1140.
    #[schemars(range(min = 1, max = 1140))]
    pub low: f64,
    /// Gradient above which an edge begins, `low` to 1140.
    #[schemars(range(min = 1, max = 1140))]
    pub high: f64,
}

impl Default for EdgeConfig {
    fn default() -> Self {
        Self { low: 30.0, high: 70.0 }
    }
}

impl EdgeConfig {
    pub(crate) fn check(&self) -> Result<(), OutOfRange> {
        require("edges.high", self.high, "edges.low to 1140", |v| v >= self.low)
    }

    /// Returns an image that is white (255) on edges, else black. Edges only select candidates; positions are
    /// measured on grey values.
    pub(crate) fn find(&self, grey: &GrayImage) -> GrayImage {
        // Canny's filters need a neighbourhood.
        if grey.width() < 8 || grey.height() < 8 {
            return GrayImage::new(grey.width(), grey.height());
        }
        canny(grey, self.low as f32, self.high as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use imageproc::image::Luma;

    #[test]
    fn the_outline_of_a_square_is_found_and_its_inside_is_not() {
        let grey = GrayImage::from_fn(60, 60, |x, y| {
            Luma([if (20..40).contains(&x) && (20..40).contains(&y) { 200 } else { 30 }])
        });
        let edges = EdgeConfig::default().find(&grey);
        assert_eq!(edges.get_pixel(30, 30).0[0], 0);
        assert!((18..=21).any(|x| edges.get_pixel(x, 30).0[0] == 255));
        assert!((38..=41).any(|y| edges.get_pixel(30, y).0[0] == 255));
    }

    #[test]
    fn a_tiny_image_has_no_edges() {
        assert!(EdgeConfig::default().find(&GrayImage::new(3, 3)).pixels().all(|p| p.0[0] == 0));
    }
}
