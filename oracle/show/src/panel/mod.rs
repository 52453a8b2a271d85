//! What a picture is made of.

pub(crate) mod class;
pub(crate) mod raster;
pub(crate) mod stretch;

use contract::{PixelPoint, Window};

use crate::panel::class::Class;
use crate::panel::stretch::Stretch;

/// One frame, and everything drawn over and beside it.
#[derive(Debug, Clone)]
pub struct Panel {
    /// The digital numbers.
    pub pixels: Pixels,
    /// Transmitted regions; `None` when the whole frame was transmitted.
    pub regions: Option<Vec<Window>>,
    /// Part of the frame that is drawn; it must lie in the frame.
    pub view: Window,
    /// Part of the frame that is drawn again, enlarged; it must lie in the frame.
    pub close_up: Option<Window>,
    /// From digital numbers to grey.
    pub stretch: Stretch,
    /// How several pixels become one where the frame is reduced.
    pub reduction: Reduction,
    /// Angles and lengths of the scale bar.
    pub scale: PlateScale,
    /// What is drawn over the pixels; later marks lie over earlier ones.
    pub marks: Vec<Mark>,
    /// Heading: scenario and frame.
    pub title: String,
    /// Heading of a panel of a contact sheet.
    pub short_title: String,
    /// Verdict of the score.
    pub verdict: Option<Verdict>,
    /// Values beside a frame that is drawn alone, one table below the other.
    pub tables: Vec<Table>,
    /// Lines below a panel of a contact sheet.
    pub caption: Vec<String>,
}

impl Panel {
    /// Whether a point of the frame is in the view.
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
    /// Columns.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// The values, `columns` × `rows` of them.
    pub dn: Vec<u16>,
    /// The largest value that the converter gives.
    pub full_scale_dn: u16,
}

impl Pixels {
    /// All of the frame.
    pub fn full_window(&self) -> Window {
        Window { x: 0, y: 0, columns: self.columns, rows: self.rows }
    }
}

/// How several pixels become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reduction {
    /// The brightest of them: a star of one pixel is kept.
    Brightest,
    /// Their mean.
    Mean,
}

/// Angles and lengths of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateScale {
    /// Focal length in pixels along columns.
    pub focal_length_px: f64,
    /// Distance at which the scale bar tells a length, m.
    pub range_m: Option<f64>,
}

/// Something drawn over the pixels.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Its centre.
    pub at: PixelPoint,
    /// Its shape.
    pub shape: Shape,
    /// What it stands for.
    pub class: Class,
    /// Name written beside it, where there is room.
    pub label: Option<String>,
}

/// Shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A circle around an object: its radius on the frame, px, and the least one in the picture, px.
    Around {
        /// Radius of the object, px of the frame.
        radius_px: f64,
        /// Least radius, px of the picture.
        least: f64,
    },
    /// A circle of this radius, px of the frame.
    Circle {
        /// Its radius, px of the frame.
        radius_px: f64,
    },
    /// An upright cross, open in the middle: its arms are so long, px of the picture.
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
        /// Half of its side, px of the picture.
        half: f64,
    },
}

/// Names and values.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Heads of the second and the third column.
    pub head: Option<[String; 2]>,
    /// Name, value, and a second value (empty where there is none).
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

/// Verdict of the score, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// The words.
    pub words: String,
    /// Whether they are good news.
    pub tone: Tone,
}

/// Whether a verdict is good news.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// A right answer.
    Good,
    /// Part of an answer.
    Partial,
    /// A wrong answer, or none.
    Bad,
}
