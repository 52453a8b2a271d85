//! Window of a close-up.

use contract::{PixelPoint, Window};

/// Minimum sides of a close-up, px.
const MIN_CLOSE_UP_PX: (f64, f64) = (32.0, 24.0);

/// A rectangle around points.
pub struct Bounds {
    low: PixelPoint,
    high: PixelPoint,
}

impl Bounds {
    /// Creates the bounds of one point.
    pub fn from_point(point: PixelPoint) -> Self {
        Self { low: point, high: point }
    }

    /// Extends the bounds to a point.
    pub fn add(&mut self, point: PixelPoint) {
        self.low = PixelPoint::new(self.low.x.min(point.x), self.low.y.min(point.y));
        self.high = PixelPoint::new(self.high.x.max(point.x), self.high.y.max(point.y));
    }

    /// Returns the window around the rectangle, with an aspect ratio of four to three and a border of three
    /// pixels, shifted into the detector.
    pub fn window(&self, columns: usize, rows: usize) -> Window {
        let (wide, high) = (self.high.x - self.low.x + 7.0, self.high.y - self.low.y + 7.0);
        let width = wide.max(high * 4.0 / 3.0).max(MIN_CLOSE_UP_PX.0);
        let height = (0.75 * width).max(MIN_CLOSE_UP_PX.1);
        let side = |low: f64, high: f64, length: f64, limit: usize| {
            let length = (length.ceil() as usize).clamp(1, limit.max(1));
            let first = (0.5 * (low + high + 1.0) - 0.5 * length as f64).round().max(0.0) as usize;
            (first.min(limit.saturating_sub(length)), length)
        };
        let (x, columns) = side(self.low.x, self.high.x, width, columns);
        let (y, rows) = side(self.low.y, self.high.y, height, rows);
        Window { x, y, columns, rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_close_up_holds_its_points_and_stays_on_the_detector() {
        for (columns, rows) in [(752, 580), (40, 30), (3, 2), (1, 1)] {
            for (x, y) in [(0.0, 0.0), (0.4, 0.6), (columns as f64 - 1.0, rows as f64 - 1.0), (300.0, 200.0)]
            {
                let point = PixelPoint::new(x.min(columns as f64 - 1.0), y.min(rows as f64 - 1.0));
                let window = Bounds::from_point(point).window(columns, rows);
                assert!(window.x + window.columns <= columns && window.y + window.rows <= rows, "{window:?}");
                assert!(window.contains(point.x.round() as usize, point.y.round() as usize), "{window:?}");
            }
        }
    }
}
