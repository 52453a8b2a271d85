//! Report of a frame for the page: one JSON document.

use serde::Serialize;

/// Displayed data of a frame or field, except its picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct FrameReport {
    pub(super) frame: u64,
    pub(super) time_utc: String,
    /// Time since the first frame of the scenario, s.
    pub(super) elapsed_s: f64,
    /// Day or portion of the schedule; empty in a world without groups.
    pub(super) group: String,
    pub(super) image: ImageLayout,
    /// Status as in `measurements.csv`.
    pub(super) status: String,
    pub(super) parameters: Vec<Parameter>,
    pub(super) facts: Vec<Fact>,
    /// Features recognised by the pipeline.
    pub(super) overlay: Vec<Shape>,
    /// True positions of the features.
    pub(super) truth_overlay: Vec<Shape>,
    pub(super) phase: Phase,
    pub(super) ground: Option<Ground>,
    pub(super) model: Model,
}

/// Size of the picture, and the camera row of each picture row: `first_row` + `row_step` × row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct ImageLayout {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) first_row: usize,
    pub(super) row_step: usize,
    pub(super) camera_rows: usize,
}

/// A row of the parameter panel. Its name is the name of the column in the files of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Parameter {
    pub(super) section: &'static str,
    pub(super) name: &'static str,
    pub(super) label: &'static str,
    pub(super) unit: &'static str,
    /// Number of displayed decimals.
    pub(super) decimals: u8,
    pub(super) measured: Option<f64>,
    pub(super) sigma: Option<f64>,
    pub(super) truth: Option<f64>,
}

/// A statement about a frame in words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Fact {
    pub(super) label: &'static str,
    pub(super) value: String,
}

/// A shape drawn over the picture, in pixels of the camera.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Shape {
    /// Form of the shape: `circle`, `cross` or `box`.
    pub(super) figure: &'static str,
    /// Kind of the marked feature, as in `features.parquet` and `clusters.parquet`.
    pub(super) kind: String,
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    /// Radius of a circle, arm length of a cross, or half side of a box, px.
    pub(super) size_px: f64,
    /// Slope of the horizontal bar of a cross, rows per column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) slope: Option<f64>,
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(super) label: String,
}

impl Shape {
    /// Creates a shape at a position, with all values rounded to a hundredth of a pixel.
    pub(super) fn new(figure: &'static str, kind: &str, [x, y]: [f64; 2], size_px: f64) -> Self {
        let round = |v: f64| (v * 100.0).round() / 100.0;
        Self {
            figure,
            kind: kind.to_owned(),
            x_px: round(x),
            y_px: round(y),
            size_px: round(size_px),
            slope: None,
            label: String::new(),
        }
    }
}

/// A point of the phase chart, in the units of the session.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Phase {
    /// Last measured range and range rate.
    pub(super) measured: Option<[f64; 2]>,
    pub(super) truth: [f64; 2],
}

/// Points on the ground, degrees: longitude east, latitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Ground {
    pub(super) spacecraft: [f64; 2],
    pub(super) sun: [f64; 2],
}

/// Positions of the bodies in the 3D model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "world", rename_all = "snake_case")]
pub(super) enum Model {
    /// Docking, in the target frame, m.
    Docking { camera: usize, measured: Option<CameraPose>, truth: CameraPose, sun: Option<[f64; 3]> },
    /// Far range, in the radial, along-track and normal axes of the target's orbit, km.
    FarRange {
        measured: Option<CameraPose>,
        truth: CameraPose,
        sun: [f64; 3],
        line_of_sight: Option<[f64; 3]>,
    },
}

/// A camera: its position, and its axes x (columns), y (rows) and z (optical) in the frame of the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct CameraPose {
    pub(super) position: [f64; 3],
    pub(super) axes: [[f64; 3]; 3],
}
