//! Truth of a frame, and answer of a pipeline.

use contract::PixelPoint;
use files::{FieldDeclaration, Table, table};
use serde::Deserialize;

table! {
    /// A row of `truth/frames.parquet`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Truth: parquet(frame) {
        /// number of the frame; ascending
        frame: u64,
        /// distance between the camera and the body's centre, km
        range_km: f64,
        /// position of the body's centre in the image; null if it has none
        centre: Option<PixelPoint> = ["centre_x_px", "centre_y_px"],
        /// radius of the body's disk along the columns, for a body on the axis of the camera
        radius_px: f64,
        /// angle at the body between the Sun and the camera
        phase_deg: f64,
        /// exposure time, s
        exposure_s: f64,
        /// expected electrons of the brightest pixel, before saturation
        peak_electrons: f64,
        /// true if the whole disk is in the image
        is_whole: bool,
    }
}

table! {
    /// A row of `measurements.csv` after frame and status.
    #[derive(Debug, Clone, PartialEq, Deserialize)]
    pub struct Answer: csv {
        /// centre of the body's disk; both or none
        centre: Option<[f64; 2]> = ["x_px", "y_px"],
        /// radius of the disk along the columns
        radius_px: Option<f64>,
        /// distance to the body's centre, km
        range_km: Option<f64>,
        /// its standard deviation
        sigma_range_km: Option<f64>,
        /// largest digital number of the image, by which the exposure is controlled
        peak_dn: f64,
    }
}

/// Returns the fields of each CSV table with its name in `docs/formats.md`.
pub fn csv_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![("measurements.csv of the middle range", Answer::declarations())]
}

/// Returns the fields of each Parquet table with its name in `docs/formats.md`.
pub fn parquet_tables() -> Vec<(&'static str, Vec<FieldDeclaration>)> {
    vec![("truth/frames.parquet of the middle range", Truth::declarations())]
}
