//! Pictures of frames: a window of the pixels, stretched for display, with marks over it.
use std::io::Cursor;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use contract::{PixelPoint, Window};
use files::Failure;
use image::{GrayImage, ImageFormat};

/// Maximum number of samples of a picture. If a window has more pixels, each square of pixels is drawn as its
/// brightest pixel.
const MAX_SAMPLES: usize = 60_000;

/// Pictures of frames, and the reason if there are none.
pub type RenderedPictures = (Vec<Picture>, Option<String>);

/// A window of a frame with marks.
#[derive(Debug, Clone)]
pub struct Picture {
    /// First words of the caption.
    pub title: String,
    /// Caption after the title.
    pub caption: String,
    /// Window that the picture shows, columns and rows of the image.
    pub window: Window,
    /// Camera rows of the rows of the image.
    pub lines: RowMapping,
    /// Pixels, as a PNG in a `data:` URI.
    pub png: String,
    /// Marks drawn over the pixels.
    pub marks: Vec<Mark>,
}

/// A mark drawn over the pixels.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Position in the frame: the centre, or the upper left corner of a rectangle.
    pub at: PixelPoint,
    /// Shape of the mark.
    pub shape: Shape,
    /// Meaning of the mark, as the name of its style.
    pub class: &'static str,
    /// Text shown when the pointer is over the mark.
    pub title: String,
}

/// Shape of a mark; lengths are pixels of the frame.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// A circle of this radius.
    Circle(f64),
    /// An upright cross with arms of this length.
    Cross(f64),
    /// A rectangle.
    Rectangle {
        /// Width of the rectangle.
        width: f64,
        /// Height of the rectangle.
        height: f64,
    },
}

impl Mark {
    /// Creates the outline of a rectangle of pixels.
    pub fn region(window: &Window, title: impl Into<String>) -> Self {
        Self {
            at: PixelPoint::new(window.x as f64 - 0.5, window.y as f64 - 0.5),
            shape: Shape::Rectangle { width: window.columns as f64, height: window.rows as f64 },
            class: "region",
            title: title.into(),
        }
    }
}

/// Camera row of each row of an image: `first` + `pitch` × row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowMapping {
    /// Camera row of the first image row.
    pub first: f64,
    /// Number of camera rows per image row.
    pub pitch: f64,
}

impl RowMapping {
    /// Mapping of a whole frame.
    pub const WHOLE: Self = Self { first: 0.0, pitch: 1.0 };
}

/// Conversion of digital numbers to grey levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// Asinh from the median to the brightest pixel: both noise and bright cores are visible.
    Stars,
    /// Linear from the darkest to the brightest pixel.
    Linear,
}

/// Digital numbers, row by row.
#[derive(Debug, Clone, Copy)]
pub struct Pixels<'a> {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Digital numbers.
    pub dn: &'a [u16],
}

impl Picture {
    /// Creates a picture of `window`, which must lie within the pixels.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the PNG cannot be encoded.
    pub fn new(
        pixels: Pixels<'_>,
        window: Window,
        lines: RowMapping,
        stretch: Stretch,
    ) -> Result<Self, Failure> {
        let png = png(pixels, window, stretch)?;
        Ok(Self { title: String::new(), caption: String::new(), window, lines, png, marks: Vec::new() })
    }

    /// Returns the displayed part of the frame as an SVG view box, in which pixel centres have integer
    /// coordinates.
    pub fn view_box(&self) -> String {
        format!("{} {} {} {}", self.left(), self.top(), self.window.columns, self.height())
    }

    /// Left edge, px of the frame.
    pub fn left(&self) -> f64 {
        self.window.x as f64 - 0.5
    }

    /// Upper edge, rows of the camera.
    pub fn top(&self) -> f64 {
        self.lines.first + self.lines.pitch * (self.window.y as f64 - 0.5)
    }

    /// Height, rows of the camera.
    pub fn height(&self) -> f64 {
        self.lines.pitch * self.window.rows as f64
    }
}

/// Returns the window with aspect ratio 4:3 that contains all `points` with a margin of `margin_px`, limited
/// to the detector; the whole detector if no point is on it.
pub fn window_around(points: &[PixelPoint], margin_px: f64, columns: usize, rows: usize) -> Window {
    let inside: Vec<_> = points.iter().filter(|point| point.is_on_detector(columns, rows)).collect();
    let whole = Window { x: 0, y: 0, columns, rows };
    let Some(first) = inside.first() else { return whole };
    let (mut low, mut high) = (**first, **first);
    for point in inside {
        low = PixelPoint::new(low.x.min(point.x), low.y.min(point.y));
        high = PixelPoint::new(high.x.max(point.x), high.y.max(point.y));
    }
    let width = (high.x - low.x + 2.0 * margin_px).max((high.y - low.y + 2.0 * margin_px) * 4.0 / 3.0);
    let side = |middle: f64, length: f64, limit: usize| {
        let length = (length.ceil() as usize).min(limit);
        let start = (middle - length as f64 / 2.0).round().max(0.0) as usize;
        (start.min(limit - length), length)
    };
    let (x, columns) = side(0.5 * (low.x + high.x), width, columns);
    let (y, rows) = side(0.5 * (low.y + high.y), width * 0.75, rows);
    Window { x, y, columns, rows }
}

/// Encodes a window of the pixels as an 8-bit PNG.
fn png(pixels: Pixels<'_>, window: Window, stretch: Stretch) -> Result<String, Failure> {
    let mut step = 1;
    while (window.columns / step) * (window.rows / step) > MAX_SAMPLES {
        step += 1;
    }
    let (columns, rows) = (window.columns.div_ceil(step), window.rows.div_ceil(step));
    let mut samples: Vec<u16> = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            samples.push(brightest(pixels, window, (column * step, row * step), step));
        }
    }
    let shades = match stretch {
        Stretch::Stars => asinh_shades(&samples),
        Stretch::Linear => linear_shades(&samples),
    };
    let image = GrayImage::from_raw(columns as u32, rows as u32, shades);
    let mut bytes = Cursor::new(Vec::new());
    let written = image.map(|image| image.write_to(&mut bytes, ImageFormat::Png));
    match written {
        Some(Ok(())) => Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes.get_ref()))),
        Some(Err(error)) => Err(Failure::Usage(format!("a picture of the report cannot be made: {error}"))),
        None => Err(Failure::Usage("a picture of the report has no pixels".to_owned())),
    }
}

/// Returns the brightest pixel of a square in a window, so that a star remains visible.
fn brightest(pixels: Pixels<'_>, window: Window, (column, row): (usize, usize), step: usize) -> u16 {
    let (left, top) = (window.x + column, window.y + row);
    let right = (left + step).min(window.x + window.columns);
    let bottom = (top + step).min(window.y + window.rows);
    let of_row = |y: usize| pixels.dn[y * pixels.columns + left..y * pixels.columns + right].iter();
    (top..bottom).flat_map(of_row).copied().max().unwrap_or(0)
}

fn asinh_shades(samples: &[u16]) -> Vec<u8> {
    // Pixels that were not transmitted are 0 and contain no noise.
    let mut lit: Vec<u16> = samples.iter().copied().filter(|&dn| dn > 0).collect();
    lit.sort_unstable();
    let at = |part: usize| f64::from(lit.get(lit.len() / part).copied().unwrap_or(0));
    let (middle, below) = (at(2), at(6));
    let high = f64::from(lit.last().copied().unwrap_or(1)).max(middle + 1.0);
    // Black is two standard deviations of the noise below the median.
    let black = (middle - 2.0 * (middle - below)).max(0.0);
    let softening = ((high - black) / 25.0).max(1.0);
    let full = libm::asinh((high - black) / softening);
    let shade = |dn: &u16| {
        let above = (f64::from(*dn) - black).max(0.0);
        (255.0 * libm::asinh(above / softening) / full).round().min(255.0) as u8
    };
    samples.iter().map(shade).collect()
}

fn linear_shades(samples: &[u16]) -> Vec<u8> {
    let (low, high) = samples.iter().fold((u16::MAX, 0), |(low, high), &dn| (low.min(dn), high.max(dn)));
    let range = f64::from(high.saturating_sub(low)).max(1.0);
    samples.iter().map(|&dn| (255.0 * f64::from(dn - low) / range).round() as u8).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_holds_its_points_and_stays_on_the_detector() {
        let points = [PixelPoint::new(3.0, 4.0), PixelPoint::new(90.0, 500.0)];
        let window = window_around(&points, 36.0, 752, 580);
        assert!(points.iter().all(|p| window.contains(p.x as usize, p.y as usize)), "{window:?}");
        assert!(window.x + window.columns <= 752 && window.y + window.rows <= 580);
        let whole = Window { x: 0, y: 0, columns: 752, rows: 580 };
        assert_eq!(window_around(&[PixelPoint::new(-40.0, 3.0)], 36.0, 752, 580), whole);
        assert_eq!(window_around(&[PixelPoint::new(5.0, 3.0)], 36.0, 16, 9).columns, 16);
    }

    #[test]
    fn a_picture_is_a_png_and_few_samples_of_many_pixels_keep_a_star() {
        let mut dn = vec![100_u16; 1000 * 800];
        dn[417 * 1000 + 333] = 900;
        let pixels = Pixels { columns: 1000, rows: 800, dn: &dn };
        let whole = Window { x: 0, y: 0, columns: 1000, rows: 800 };
        let uri = png(pixels, whole, Stretch::Stars).unwrap();
        let bytes = STANDARD.decode(uri.strip_prefix("data:image/png;base64,").unwrap()).unwrap();
        let image = image::load_from_memory(&bytes).unwrap().to_luma8();
        assert!((image.width() * image.height()) as usize <= 2 * MAX_SAMPLES);
        assert_eq!(image.pixels().filter(|pixel| pixel.0[0] == 255).count(), 1);
    }

    #[test]
    fn a_black_picture_is_black() {
        let dn = [0_u16; 12];
        let window = Window { x: 0, y: 0, columns: 4, rows: 3 };
        for stretch in [Stretch::Stars, Stretch::Linear] {
            assert!(png(Pixels { columns: 4, rows: 3, dn: &dn }, window, stretch).is_ok());
        }
    }
}
