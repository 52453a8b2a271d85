//! Drawing of lines, circles and text on an opaque picture.

pub(crate) mod colour;
pub(crate) mod label;
pub(crate) mod text;

use tiny_skia::{Color, Paint, PathBuilder, Pixmap, Rect, Stroke, Transform};

use crate::ShowError;
use crate::canvas::colour::{BLACK, Rgb, blend};
use crate::canvas::text::Font;
use crate::layout::view::Placement;
use crate::panel::{Mark, Shape};

/// Largest side of a picture, px: more than any layout needs.
const MAX_SIDE: usize = 20_000;
/// Width of the lines of marks, px.
pub(crate) const LINE: f64 = 1.8;

/// Smallest zoom of a close-up: pixels of the picture per pixel of the frame.
pub(crate) const CLOSE: f64 = 4.0;
/// Radius of the circle around an object in a close-up, px.
const CLOSE_RADIUS: f64 = 15.0;

/// Rectangle of the picture, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    /// Returns true if two areas have a point in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        let apart = |a: f64, wide: f64, b: f64, wide_b: f64| a + wide <= b || b + wide_b <= a;
        !(apart(self.left, self.width, other.left, other.width)
            || apart(self.top, self.height, other.top, other.height))
    }

    /// Returns the smallest area that contains two areas.
    pub(crate) fn with(&self, other: &Self) -> Self {
        let (left, top) = (self.left.min(other.left), self.top.min(other.top));
        let right = (self.left + self.width).max(other.left + other.width);
        let bottom = (self.top + self.height).max(other.top + other.height);
        Self { left, top, width: right - left, height: bottom - top }
    }

    /// Returns true if the area lies inside a picture of this size.
    pub(crate) fn is_inside(&self, width: usize, height: usize) -> bool {
        self.left >= 0.0
            && self.top >= 0.0
            && self.left + self.width <= width as f64
            && self.top + self.height <= height as f64
    }
}

/// Opaque picture to draw on.
pub(crate) struct Canvas(Pixmap);

impl Canvas {
    /// Creates a picture of one colour.
    ///
    /// # Errors
    /// [`ShowError::Size`] for a picture without pixels, or one that is too large to be allocated.
    pub(crate) fn new(width: usize, height: usize, [red, green, blue]: Rgb) -> Result<Self, ShowError> {
        let error = || ShowError::Size { width, height };
        let side =
            |length: usize| u32::try_from(length).ok().filter(|_| length <= MAX_SIDE).ok_or_else(error);
        let mut pixmap = Pixmap::new(side(width)?, side(height)?).ok_or_else(error)?;
        pixmap.fill(Color::from_rgba8(red, green, blue, u8::MAX));
        Ok(Self(pixmap))
    }

    pub(crate) fn width(&self) -> usize {
        self.0.width() as usize
    }

    pub(crate) fn height(&self) -> usize {
        self.0.height() as usize
    }

    /// Returns all pixels, row by row.
    pub(crate) fn rgb(&self) -> Vec<Rgb> {
        self.0.pixels().iter().map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect()
    }

    /// Returns the bytes of `count` consecutive pixels in a row, clipped at the picture's edge.
    fn row(&mut self, left: usize, top: usize, count: usize) -> impl Iterator<Item = &mut [u8; 4]> {
        let (width, height) = (self.width(), self.height());
        let count = if top < height { count.min(width.saturating_sub(left)) } else { 0 };
        let first = if count > 0 { top * width + left } else { 0 };
        let (pixels, _) = self.0.data_mut().as_chunks_mut::<4>();
        pixels.iter_mut().skip(first).take(count)
    }

    /// Copies rows of `width` pixels into the picture, with their upper left corner at a point.
    pub(crate) fn copy(&mut self, left: usize, top: usize, width: usize, pixels: &[Rgb]) {
        for (y, row) in pixels.chunks(width.max(1)).enumerate() {
            for (to, [red, green, blue]) in self.row(left, top + y, width).zip(row) {
                *to = [*red, *green, *blue, u8::MAX];
            }
        }
    }

    /// Darkens an area to make text on it legible.
    pub(crate) fn shade(&mut self, area: &Area) {
        let rectangle = rectangle(area);
        let mut paint = paint(BLACK);
        paint.set_color_rgba8(0, 0, 0, 165);
        if let Some(rectangle) = rectangle {
            self.0.fill_rect(rectangle, &paint, Transform::identity(), None);
        }
    }

    /// Draws the edge of an area.
    pub(crate) fn frame(&mut self, area: &Area, colour: Rgb, width: f64) {
        let path = rectangle(area).map(PathBuilder::from_rect);
        self.stroke(path, colour, width);
    }

    /// Draws a circle.
    pub(crate) fn circle(&mut self, (x, y): (f64, f64), radius: f64, colour: Rgb, width: f64) {
        self.stroke(PathBuilder::from_circle(x as f32, y as f32, radius as f32), colour, width);
    }

    /// Draws straight lines, each given by its two end points.
    pub(crate) fn lines(&mut self, lines: &[[(f64, f64); 2]], colour: Rgb, width: f64) {
        let mut path = PathBuilder::new();
        for [from, to] in lines {
            path.move_to(from.0 as f32, from.1 as f32);
            path.line_to(to.0 as f32, to.1 as f32);
        }
        self.stroke(path.finish(), colour, width);
    }

    fn stroke(&mut self, path: Option<tiny_skia::Path>, colour: Rgb, width: f64) {
        // The rasteriser rejects such coordinates: circles of outlines may be a thousand times as large as
        // the picture.
        let drawable = path.filter(|path| {
            let bounds = path.bounds();
            [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()].iter().all(|side| side.abs() < 1e5)
        });
        if let Some(path) = drawable {
            let stroke = Stroke { width: width as f32, ..Stroke::default() };
            self.0.stroke_path(&path, &paint(colour), &stroke, Transform::identity(), None);
        }
    }

    /// Writes a line of text with its upper left corner at a point.
    pub(crate) fn text(&mut self, left: usize, top: usize, text: &str, font: Font, colour: Rgb) {
        for (i, character) in text.chars().enumerate() {
            let Some(glyph) = font.glyph(character) else { continue };
            let at = left + i * font.advance();
            for (y, coverage) in glyph.rows().enumerate() {
                for (pixel, coverage) in self.row(at, top + y, glyph.width()).zip(coverage) {
                    let [red, green, blue, _] = *pixel;
                    let [red, green, blue] = blend([red, green, blue], colour, *coverage);
                    *pixel = [red, green, blue, u8::MAX];
                }
            }
        }
    }

    /// Draws a mark at a point, with a dark edge that makes it visible on bright pixels too.
    pub(crate) fn mark(&mut self, mark: &Mark, placement: &Placement) {
        let at = placement.inner(mark.at);
        if !(at.0.is_finite() && at.1.is_finite()) {
            return;
        }
        for (colour, width) in [([12, 12, 12], LINE + 2.0), (mark.class.rgb(), LINE)] {
            match mark.shape {
                Shape::Cross { arm } => self.open_cross(at, [(1.0, 0.0), (0.0, 1.0)], arm, colour, width),
                Shape::Saltire { arm } => {
                    let half = std::f64::consts::FRAC_1_SQRT_2;
                    self.open_cross(at, [(half, half), (half, -half)], arm, colour, width);
                }
                Shape::Square { half } => {
                    let area =
                        Area { left: at.0 - half, top: at.1 - half, width: 2.0 * half, height: 2.0 * half };
                    self.frame(&area, colour, width);
                }
                Shape::Around { .. } | Shape::Circle { .. } => {
                    self.circle(at, mark.shape.reach(placement.zoom), colour, width);
                    if matches!(mark.shape, Shape::Around { .. }) && placement.zoom >= CLOSE {
                        self.circle(at, 0.75, colour, width);
                    }
                }
            }
        }
    }

    /// Draws four arms around a point, which itself is left free.
    fn open_cross(&mut self, (x, y): (f64, f64), axes: [(f64, f64); 2], arm: f64, colour: Rgb, width: f64) {
        let inner = (0.3 * arm).max(2.0);
        let ends = |(dx, dy): (f64, f64)| {
            [-1.0, 1.0].map(|sign: f64| {
                let point = |length: f64| (x + sign * length * dx, y + sign * length * dy);
                // The dark edge of a line also covers its ends.
                [point(inner - 0.5 * (width - LINE)), point(arm + 0.5 * (width - LINE))]
            })
        };
        let lines: Vec<[(f64, f64); 2]> = axes.into_iter().flat_map(ends).collect();
        self.lines(&lines, colour, width);
    }
}

impl Shape {
    /// Returns the distance from the centre to the farthest line, px of the picture.
    pub(crate) fn reach(self, zoom: f64) -> f64 {
        match self {
            // A close-up shows the object itself: the mark indicates its position, not its extent.
            Self::Around { .. } if zoom >= CLOSE => CLOSE_RADIUS,
            Self::Around { radius_px, least } => (radius_px * zoom + 3.0).max(least),
            Self::Circle { radius_px } => (radius_px * zoom).max(1.0),
            Self::Cross { arm } | Self::Saltire { arm } => arm,
            Self::Square { half } => half,
        }
    }
}

fn rectangle(area: &Area) -> Option<Rect> {
    Rect::from_xywh(area.left as f32, area.top as f32, area.width as f32, area.height as f32)
}

fn paint(colour: Rgb) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let [red, green, blue] = colour;
    paint.set_color_rgba8(red, green, blue, u8::MAX);
    paint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::colour::{ORANGE, WHITE};

    #[test]
    fn drawing_beyond_the_edge_is_clipped() {
        let mut canvas = Canvas::new(20, 10, BLACK).unwrap();
        canvas.text(15, 3, "too long", Font::Body, WHITE);
        canvas.text(0, 30, "below", Font::Body, WHITE);
        canvas.copy(18, 8, 5, &[[1, 2, 3]; 25]);
        canvas.circle((5.0, 5.0), 1e30, ORANGE, 2.0);
        canvas.circle((f64::NAN, 5.0), 3.0, ORANGE, 2.0);
        canvas.lines(&[[(-50.0, 5.0), (50.0, 5.0)]], ORANGE, 2.0);
        canvas.frame(&Area { left: 0.0, top: 0.0, width: -1.0, height: 4.0 }, ORANGE, 1.0);
        let pixels = canvas.rgb();
        assert_eq!((pixels.len(), pixels[5 * 20], pixels[9 * 20 + 19]), (200, ORANGE, [1, 2, 3]));
    }

    #[test]
    fn a_picture_without_pixels_or_too_large_is_refused() {
        for (width, height) in [(0, 10), (10, 0), (MAX_SIDE + 1, 1), (usize::MAX, 1)] {
            assert!(Canvas::new(width, height, BLACK).is_err());
        }
    }

    #[test]
    fn areas_meet_where_they_overlap() {
        let area = |left: f64, top: f64| Area { left, top, width: 10.0, height: 5.0 };
        assert!(area(0.0, 0.0).meets(&area(9.0, 4.0)));
        assert!(!area(0.0, 0.0).meets(&area(10.0, 0.0)) && !area(0.0, 0.0).meets(&area(0.0, -5.0)));
        assert!(area(0.0, 0.0).is_inside(10, 5) && !area(0.5, 0.0).is_inside(10, 5));
    }
}
