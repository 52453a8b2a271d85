//! Features recognised in a field, drawn over the image and used to find the cause of a miss.

use crate::PixelPoint;

/// Image of the target's cross (docking paper, section 3). Coordinates are camera pixels, also for a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cross {
    /// Centre (Xc, Yc) after least squares.
    pub centre: PixelPoint,
    /// Centre (Xc, Yc) as first found.
    pub raw_centre: PixelPoint,
    /// Slope a of the horizontal bar, rows y per column x.
    pub slope: f64,
    /// Number N1 of point pairs on the horizontal bar.
    pub horizontal_pairs: u32,
    /// Number N2 of point pairs on the vertical bar.
    pub vertical_pairs: u32,
}

/// Image of a circular feature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Centre (Xo, Yo) after least squares.
    pub centre: PixelPoint,
    /// Centre (Xo, Yo) as first found.
    pub raw_centre: PixelPoint,
    /// Radius R, px.
    pub radius_px: f64,
    /// Number N3 of points on the circle that were used.
    pub points: u32,
}

/// Use of a target mark in the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkUse {
    /// Measured and used.
    Used,
    /// Seen, and rejected by the self-checking: shadowed, glinting or partly hidden.
    Rejected,
    /// Not found in the image.
    Missing,
    /// Predicted position is outside the image.
    OutOfField,
}

impl MarkUse {
    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Rejected => "rejected",
            Self::Missing => "missing",
            Self::OutOfField => "out_of_field",
        }
    }
}

/// Image of a mark (label) of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Index of the mark in [`crate::docking::TargetModel::marks`], from 0.
    pub index: u32,
    /// Observed position, or predicted position if the mark was not seen.
    pub position: PixelPoint,
    /// Use of the mark in the measurement.
    pub usage: MarkUse,
}

/// Displacements of the picture that the camera file does not state, as a pipeline found them: the content at
/// (u, v) px from the principal point, without the distortion of the camera file, is displaced. 0 for a warp
/// that was not found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PictureWarp {
    /// Radial distortion, px⁻²: displacement by (u, v) · radial · (u² + v²); to first order what the first
    /// coefficient of [`crate::Camera::radial`] lacks.
    pub radial: f64,
    /// Bend of the columns, px⁻¹: displacement along the row by bend · v².
    pub bend: f64,
    /// Shear: displacement along the row by shear · v.
    pub shear: f64,
    /// Stretch of the columns: displacement along the column by stretch · v.
    pub stretch: f64,
}

/// All features recognised in a field; empty if a pipeline does not report them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The target's cross.
    pub cross: Option<Cross>,
    /// Circle through the marks.
    pub circle: Option<Circle>,
    /// Outline of the station.
    pub station: Option<Circle>,
    /// Disk of the docking unit.
    pub docking_unit: Option<Circle>,
    /// The marks.
    pub marks: Vec<Mark>,
    /// Warp of the picture that this and recent fields show.
    pub warp: Option<PictureWarp>,
}
