//! Positions on the detector.

/// A position on the detector in pixels: x along columns, y along rows, the centre of the first pixel is (0,
/// 0).
///
/// A point is not a vector: two points have a distance, but no sum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PixelPoint {
    /// Coordinate along columns, positive to the right.
    pub x: f64,
    /// Coordinate along rows, positive downwards.
    pub y: f64,
}

impl PixelPoint {
    /// Creates a point from coordinates relative to the centre of the first pixel.
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Returns FITS coordinates: the centre of the first pixel is (1, 1).
    pub fn to_fits(self) -> (f64, f64) {
        (self.x + 1.0, self.y + 1.0)
    }

    /// Creates a point from FITS coordinates: the centre of the first pixel is (1, 1).
    pub fn from_fits(x: f64, y: f64) -> Self {
        Self { x: x - 1.0, y: y - 1.0 }
    }

    /// Returns corner-based coordinates: the corner of the first pixel is (0, 0), its centre (0.5, 0.5).
    pub fn to_corner_based(self) -> (f64, f64) {
        (self.x + 0.5, self.y + 0.5)
    }

    /// Creates a point from corner-based coordinates.
    pub fn from_corner_based(x: f64, y: f64) -> Self {
        Self { x: x - 0.5, y: y - 0.5 }
    }

    /// Returns the Euclidean distance to another point, px.
    pub fn distance(self, other: Self) -> f64 {
        {
            let (dx, dy) = (self.x - other.x, self.y - other.y);
            (dx * dx + dy * dy).sqrt()
        }
    }

    /// Returns true if the point lies on a detector of `columns` × `rows` pixels, including the borders of
    /// the outer pixels.
    pub fn is_on_detector(self, columns: usize, rows: usize) -> bool {
        let inside = |v: f64, n: usize| v >= -0.5 && v <= n as f64 - 0.5;
        inside(self.x, columns) && inside(self.y, rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_the_first_pixel_has_three_names() {
        let first = PixelPoint::new(0.0, 0.0);
        assert_eq!(first.to_fits(), (1.0, 1.0));
        assert_eq!(first.to_corner_based(), (0.5, 0.5));
        assert_eq!(PixelPoint::from_fits(1.0, 1.0), first);
        assert_eq!(PixelPoint::from_corner_based(0.5, 0.5), first);
    }
}
