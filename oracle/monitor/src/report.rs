//! Report of a frame for the page: one JSON document.

use serde::Serialize;
use serde_json::Value;

/// Displayed data of a frame or field, except its picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameReport {
    /// Number of the frame or field.
    pub frame: u64,
    /// Time, UTC.
    pub time_utc: String,
    /// Time since the first frame of the scenario, s.
    pub elapsed_s: f64,
    /// Day or portion of the schedule; empty in a world without groups.
    pub group: String,
    /// Size of its picture.
    pub image: ImageLayout,
    /// Status as in `measurements.csv`.
    pub status: String,
    /// Rows of the parameter panel.
    pub parameters: Vec<Parameter>,
    /// Statements in words.
    pub facts: Vec<Fact>,
    /// Features recognised by the pipeline.
    pub overlay: Vec<Shape>,
    /// True positions of the features.
    pub truth_overlay: Vec<Shape>,
    /// Point of the phase chart.
    pub phase: Phase,
    /// Points on the ground; `None` without an orbit.
    pub ground: Option<Ground>,
    /// Positions of the bodies in the 3D model, with the key `world`.
    pub model: Value,
}

/// Size of the picture, and the camera row of each picture row: `first_row` + `row_step` × row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImageLayout {
    /// Columns of the picture.
    pub columns: usize,
    /// Rows of the picture.
    pub rows: usize,
    /// Camera row of the first picture row.
    pub first_row: usize,
    /// Camera rows from one picture row to the next.
    pub row_step: usize,
    /// Rows of the camera.
    pub camera_rows: usize,
}

/// A row of the parameter panel. Its name is the name of the column in the files of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// Heading of its group.
    pub section: &'static str,
    /// Name of the column.
    pub name: &'static str,
    /// Label on the page.
    pub label: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Number of displayed decimals.
    pub decimals: u8,
    /// Measured value.
    pub measured: Option<f64>,
    /// Standard deviation of the measured value.
    pub sigma: Option<f64>,
    /// True value.
    pub truth: Option<f64>,
}

/// A statement about a frame in words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fact {
    /// Label on the page.
    pub label: &'static str,
    /// Words.
    pub value: String,
}

/// A shape drawn over the picture, in pixels of the camera.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shape {
    /// Form of the shape: `circle`, `cross` or `box`.
    pub figure: &'static str,
    /// Kind of the marked feature, as in `features.parquet` and `clusters.parquet`.
    pub kind: String,
    /// Column.
    pub x_px: f64,
    /// Row.
    pub y_px: f64,
    /// Radius of a circle, arm length of a cross, or half side of a box, px.
    pub size_px: f64,
    /// Slope of the horizontal bar of a cross, rows per column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// Text beside the shape.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub label: String,
}

impl Shape {
    /// Creates a shape at a position, with all values rounded to a hundredth of a pixel.
    pub fn new(figure: &'static str, kind: &str, [x, y]: [f64; 2], size_px: f64) -> Self {
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
pub struct Phase {
    /// Last measured range and range rate.
    pub measured: Option<[f64; 2]>,
    /// True range and range rate.
    pub truth: [f64; 2],
}

/// Points on the ground, degrees: longitude east, latitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ground {
    /// Point below the spacecraft.
    pub spacecraft: [f64; 2],
    /// Point below the Sun.
    pub sun: [f64; 2],
}

/// A camera: its position, and its axes x (columns), y (rows) and z (optical) in the frame of the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CameraPose {
    /// Position.
    pub position: [f64; 3],
    /// Unit vectors of the axes.
    pub axes: [[f64; 3]; 3],
}
