//! `features.parquet`: features that a pipeline recognised in each field, in addition to `measurements.csv`.
//! Coordinates are camera pixels.

use contract::docking::{Circle, Features};
use files::{nullable, table};

table! {
    /// A recognised feature with its field number.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FeatureRow: parquet(field) {
        /// number of the field; ascending
        field: u64,
        /// `cross`, `circle` (of the marks), `station`, `docking_unit` or `mark`
        kind: String,
        /// number of the mark; 0 for other features
        index: u32,
        /// centre after least squares, or position of a mark
        position: [f64; 2] = nullable(["x_px", "y_px"]),
        /// centre as first found, before least squares; empty for a mark
        raw_position: Option<[f64; 2]> = ["raw_x_px", "raw_y_px"],
        /// radius of a circle
        radius_px: Option<f64>,
        /// slope of the cross's horizontal bar
        slope: Option<f64>,
        /// points on a circle, or pairs on the horizontal bar; 0 for a mark
        points: u32,
        /// pairs on the vertical bar; 0 for other features
        vertical_pairs: u32,
        /// use of a mark: `used`, `rejected`, `missing`, `out_of_field`; for other features `used`
        usage: String,
    }
}

impl FeatureRow {
    /// Returns the rows of a field.
    pub fn from_features(field: u64, features: &Features) -> Vec<Self> {
        let plain = |kind: &str, index: u32, position: contract::PixelPoint| Self {
            field,
            kind: kind.to_owned(),
            index,
            position: [position.x, position.y],
            raw_position: None,
            radius_px: None,
            slope: None,
            points: 0,
            vertical_pairs: 0,
            usage: "used".to_owned(),
        };
        let circle = |kind: &str, circle: &Option<Circle>| {
            circle.map(|circle| Self {
                raw_position: Some([circle.raw_centre.x, circle.raw_centre.y]),
                radius_px: Some(circle.radius_px),
                points: circle.points,
                ..plain(kind, 0, circle.centre)
            })
        };
        let cross = features.cross.map(|cross| Self {
            raw_position: Some([cross.raw_centre.x, cross.raw_centre.y]),
            slope: Some(cross.slope),
            points: cross.horizontal_pairs,
            vertical_pairs: cross.vertical_pairs,
            ..plain("cross", 0, cross.centre)
        });
        let marks = features.marks.iter().map(|mark| Self {
            usage: mark.usage.code().to_owned(),
            ..plain("mark", mark.index, mark.position)
        });
        cross
            .into_iter()
            .chain(circle("circle", &features.circle))
            .chain(circle("station", &features.station))
            .chain(circle("docking_unit", &features.docking_unit))
            .chain(marks)
            .collect()
    }
}
