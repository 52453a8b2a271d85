//! Input of a picture: pixels, marks and text.

pub(crate) mod class;
pub(crate) mod raster;
pub(crate) mod stretch;

use contract::{PixelPoint, Window};

use crate::panel::class::Class;
use crate::panel::stretch::Stretch;

/// One frame, with everything drawn over and beside it.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Digital numbers of the frame.
    pub pixels: Pixels,
    /// Transmitted regions; `None` when the whole frame was transmitted.
    pub regions: Option<Vec<Window>>,
    /// Part of the frame that is drawn; it must lie in the frame.
    pub view: Window,
    /// Part of the frame that is drawn again, enlarged; it must lie in the frame.
    pub close_up: Option<Window>,
    /// Conversion of digital numbers to grey.
    pub stretch: Stretch,
    /// Method of combining several pixels into one where the frame is reduced.
    pub reduction: Reduction,
    /// Angles and lengths of the scale bar.
    pub scale: PlateScale,
    /// Marks drawn over the pixels; later marks cover earlier ones.
    pub marks: Vec<Mark>,
    /// Heading: scenario and frame.
    pub title: String,
    /// Heading of a panel of a contact sheet.
    pub short_title: String,
    /// Verdict of the score on the frame.
    pub verdict: Option<Verdict>,
    /// Tables beside a single frame, one below another.
    pub tables: Vec<Table>,
    /// Lines below a panel of a contact sheet.
    pub caption: Vec<String>,
}

impl Panel {
    /// Returns true if a point of the frame is in the view.
    pub(crate) fn shows(&self, at: PixelPoint) -> bool {
        let side = |at: f64, first: usize, length: usize| {
            (first as f64 - 0.5..(first + length) as f64 - 0.5).contains(&at)
        };
        side(at.x, self.view.x, self.view.columns) && side(at.y, self.view.y, self.view.rows)
    }
}

/// Digital numbers, row by row from the top.
#[derive(Debug, Clone)]
pub struct Pixels {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Values, DN: `columns` × `rows` of them.
    pub dn: Vec<u16>,
    /// Largest output of the converter, DN.
    pub full_scale_dn: u16,
}

impl Pixels {
    /// Returns the window of the entire frame.
    pub fn full_window(&self) -> Window {
        Window { x: 0, y: 0, columns: self.columns, rows: self.rows }
    }
}

/// Method of combining several pixels into one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reduction {
    /// The brightest of the pixels, which preserves a star of one pixel.
    Brightest,
    /// The mean of the pixels.
    Mean,
}

/// Scale of the pixels as an angle and as a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateScale {
    /// Focal length in pixels along columns.
    pub focal_length_px: f64,
    /// Distance at which the scale bar states a length, m; `None` if the bar states only an angle.
    pub range_m: Option<f64>,
}

/// Mark drawn over the pixels.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Centre of the mark, in pixels of the frame.
    pub at: PixelPoint,
    /// Shape of the mark.
    pub shape: Shape,
    /// Kind of object that the mark represents.
    pub class: Class,
    /// Label written beside the mark if there is room.
    pub label: Option<String>,
}

/// Shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A circle around an object, with a smallest radius in the picture.
    Around {
        /// Radius of the object, px of the frame.
        radius_px: f64,
        /// Smallest radius of the circle, px of the picture.
        least: f64,
    },
    /// A circle of a given radius.
    Circle {
        /// Radius of the circle, px of the frame.
        radius_px: f64,
    },
    /// An upright cross, open in the middle.
    Cross {
        /// Length of an arm from the centre, px of the picture.
        arm: f64,
    },
    /// A diagonal cross, open in the middle.
    Saltire {
        /// Length of an arm from the centre, px of the picture.
        arm: f64,
    },
    /// A square.
    Square {
        /// Half of the side length, px of the picture.
        half: f64,
    },
}

/// Table of names and values.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Headings of the second and the third column.
    pub head: Option<[String; 2]>,
    /// Name, value, and a second value (empty if there is none).
    pub rows: Vec<[String; 3]>,
}

impl Table {
    /// Adds a row with one value.
    pub fn push(&mut self, name: &str, value: impl Into<String>) {
        self.rows.push([name.to_owned(), value.into(), String::new()]);
    }

    /// Adds a row with two values.
    pub fn push_pair(&mut self, name: &str, value: impl Into<String>, second: impl Into<String>) {
        self.rows.push([name.to_owned(), value.into(), second.into()]);
    }
}

/// Verdict of the score on a frame, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Text of the verdict.
    pub words: String,
    /// Tone of the verdict: good, partial or bad.
    pub tone: Tone,
}

/// Tone of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// Correct measurement.
    Good,
    /// Part of a measurement.
    Partial,
    /// Wrong measurement, or none.
    Bad,
}
