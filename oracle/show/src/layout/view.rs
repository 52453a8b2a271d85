//! Position of a part of a frame in a picture.

use contract::{PixelPoint, Window};
use serde::Serialize;

/// Position of a part of a frame in a picture. The point (x, y) of the frame is drawn at `left` + (x −
/// `first_column` + 0.5) × `zoom`, `top` + (y − `first_row` + 0.5) × `zoom`, where 0 is the edge of the
/// picture's first pixel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Placement {
    /// Left edge, px of the picture.
    pub left: usize,
    /// Upper edge, px of the picture.
    pub top: usize,
    /// Width, px of the picture.
    pub width: usize,
    /// Height, px of the picture.
    pub height: usize,
    /// First column of the frame that is drawn.
    pub first_column: usize,
    /// First row of the frame that is drawn.
    pub first_row: usize,
    /// Pixels of the picture per pixel of the frame.
    pub zoom: f64,
}

impl Placement {
    /// Returns the largest placement of a window that fits a width and height, at the upper left corner. A
    /// window is enlarged only by an integer, at most `most`.
    pub(crate) fn fit(window: Window, (width, height): (usize, usize), most: usize) -> Self {
        let side = |length: usize, room: usize| room as f64 / length.max(1) as f64;
        let room = side(window.columns, width).min(side(window.rows, height));
        let zoom = if room >= 1.0 { room.floor().min(most as f64) } else { room };
        let scaled = |length: usize| ((length as f64 * zoom).round() as usize).max(1);
        Self {
            left: 0,
            top: 0,
            width: scaled(window.columns),
            height: scaled(window.rows),
            first_column: window.x,
            first_row: window.y,
            zoom,
        }
    }

    /// Moves the placement's upper left corner to a point of the picture.
    pub(crate) fn moved_to(self, left: usize, top: usize) -> Self {
        Self { left, top, ..self }
    }

    /// Converts a point of the frame to its position relative to the placement's upper left corner, px of the
    /// picture.
    pub(crate) fn inner(&self, at: PixelPoint) -> (f64, f64) {
        let place = |at: f64, first: usize| (at - first as f64 + 0.5) * self.zoom;
        (place(at.x, self.first_column), place(at.y, self.first_row))
    }

    /// Returns true if a point of the frame lies inside the placement.
    pub fn shows(&self, at: PixelPoint) -> bool {
        let (x, y) = self.inner(at);
        (0.0..self.width as f64).contains(&x) && (0.0..self.height as f64).contains(&y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_is_enlarged_by_whole_numbers_and_reduced_by_any() {
        let fit = |columns, rows, room| Placement::fit(Window { x: 10, y: 20, columns, rows }, room, 9);
        let zoom = |placement: Placement| (placement.zoom, placement.width, placement.height);
        assert_eq!(zoom(fit(752, 580, (752, 600))), (1.0, 752, 580));
        assert_eq!(zoom(fit(30, 20, (100, 100))), (3.0, 90, 60));
        assert_eq!(zoom(fit(2, 2, (100, 100))), (9.0, 18, 18));
        assert_eq!(zoom(fit(2000, 1000, (1000, 1000))), (0.5, 1000, 500));
        assert_eq!(zoom(fit(16384, 1, (1024, 900))), (0.0625, 1024, 1));
    }

    #[test]
    fn the_centre_of_a_pixel_is_in_its_middle() {
        let placement = Placement::fit(Window { x: 10, y: 20, columns: 30, rows: 20 }, (90, 60), 9);
        assert_eq!(placement.inner(PixelPoint::new(10.0, 21.0)), (1.5, 4.5));
        assert!(placement.shows(PixelPoint::new(9.6, 19.6)) && !placement.shows(PixelPoint::new(9.4, 25.0)));
        assert!(!placement.shows(PixelPoint::new(f64::NAN, 25.0)));
    }
}
