//! What was recognised in a field: evidence, drawn over the image and used for the cause of a miss.

use crate::PixelPoint;

/// The target's cross (docking paper, section 3). Coordinates are the camera's pixels, also for a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cross {
    /// (Xc, Yc) after least squares.
    pub centre: PixelPoint,
    /// (Xc, Yc) as first found.
    pub raw_centre: PixelPoint,
    /// a: slope of the horizontal bar, y rows over x columns.
    pub slope: f64,
    /// N1: point pairs on the horizontal bar.
    pub horizontal_pairs: u32,
    /// N2: point pairs on the vertical bar.
    pub vertical_pairs: u32,
}

/// A circle in the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// (Xo, Yo) after least squares.
    pub centre: PixelPoint,
    /// (Xo, Yo) as first found.
    pub raw_centre: PixelPoint,
    /// R, px.
    pub radius_px: f64,
    /// N3: points on it that were used.
    pub points: u32,
}

/// What became of a mark of the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkUse {
    /// Measured and used.
    Used,
    /// Seen, and rejected by the self-checking: shadowed, glinting, cut by something.
    Rejected,
    /// Not seen.
    Missing,
    /// Its predicted place is outside the image.
    OutOfField,
}

impl MarkUse {
    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Rejected => "rejected",
            Self::Missing => "missing",
            Self::OutOfField => "out_of_field",
        }
    }
}

/// A mark (label) of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Its place in [`crate::docking::TargetModel::marks`], 0-based.
    pub index: u32,
    /// Where it was seen, or where it was predicted.
    pub position: PixelPoint,
    /// What became of it.
    pub usage: MarkUse,
}

/// Everything that was recognised in a field; empty where a pipeline does not tell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The target's cross.
    pub cross: Option<Cross>,
    /// The circle of the marks.
    pub circle: Option<Circle>,
    /// The outline of the station.
    pub station: Option<Circle>,
    /// The docking unit's disk.
    pub docking_unit: Option<Circle>,
    /// The marks.
    pub marks: Vec<Mark>,
}
