//! What the page is told of a frame: one JSON document.

use serde::Serialize;

/// All that is shown of a frame or field but its picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct FrameReport {
    pub(super) frame: u64,
    pub(super) time_utc: String,
    /// Since the first frame of the scenario, s.
    pub(super) elapsed_s: f64,
    /// Day or portion of the schedule; empty in a world without.
    pub(super) group: String,
    pub(super) image: ImageLayout,
    /// The word of `measurements.csv`.
    pub(super) status: String,
    pub(super) parameters: Vec<Parameter>,
    pub(super) facts: Vec<Fact>,
    /// What the pipeline recognised.
    pub(super) overlay: Vec<Shape>,
    /// Where it truly is.
    pub(super) truth_overlay: Vec<Shape>,
    pub(super) phase: Phase,
    pub(super) ground: Option<Ground>,
    pub(super) model: Model,
}

/// Size of the picture, and which rows of the camera its rows are: `first_row` + `row_step` × row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct ImageLayout {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) first_row: usize,
    pub(super) row_step: usize,
    pub(super) camera_rows: usize,
}

/// A row of the panel of parameters. Its name is that of the column in the run's files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Parameter {
    pub(super) section: &'static str,
    pub(super) name: &'static str,
    pub(super) label: &'static str,
    pub(super) unit: &'static str,
    /// Decimals shown.
    pub(super) decimals: u8,
    pub(super) measured: Option<f64>,
    pub(super) sigma: Option<f64>,
    pub(super) truth: Option<f64>,
}

/// Something said of a frame in words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Fact {
    pub(super) label: &'static str,
    pub(super) value: String,
}

/// A figure drawn over the picture, in the camera's pixels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Shape {
    /// `circle`, `cross` or `box`.
    pub(super) figure: &'static str,
    /// What it marks, as `features.parquet` and `clusters.parquet` call it.
    pub(super) kind: String,
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    /// Radius of a circle, length of a cross's arm, half side of a box.
    pub(super) size_px: f64,
    /// Of a cross: of its horizontal bar, rows over columns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) slope: Option<f64>,
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(super) label: String,
}

impl Shape {
    /// A figure at a place; a hundredth of a pixel is as fine as it is drawn.
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
    /// As last measured: range and range rate.
    pub(super) measured: Option<[f64; 2]>,
    pub(super) truth: [f64; 2],
}

/// Points on the ground, degrees: longitude east, latitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Ground {
    pub(super) spacecraft: [f64; 2],
    pub(super) sun: [f64; 2],
}

/// Where the bodies of the 3D model are.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "world", rename_all = "snake_case")]
pub(super) enum Model {
    /// Target frame, m.
    Docking { camera: usize, measured: Option<CameraPose>, truth: CameraPose, sun: Option<[f64; 3]> },
    /// Radial, along-track and normal axes of the target's orbit, km.
    FarRange {
        measured: Option<CameraPose>,
        truth: CameraPose,
        sun: [f64; 3],
        line_of_sight: Option<[f64; 3]>,
    },
}

/// A camera: where it is, and its axes x (columns), y (rows) and z (optical) in the model's frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct CameraPose {
    pub(super) position: [f64; 3],
    pub(super) axes: [[f64; 3]; 3],
}
