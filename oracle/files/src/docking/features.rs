//! `features.parquet`: what a pipeline recognised in each field, beside `measurements.csv`. Coordinates are the camera's
//! pixels.

use contract::docking::{Circle, Features};

use super::super::FileError;
use super::super::parquet_table::{Columns, Row};
use super::super::table_column::Column;
use super::super::truth::{optional_numbers, words};

/// A feature and the field it was found in.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureRow {
    /// Number of the field.
    pub field: u64,
    /// `cross`, `circle` (of the marks), `station`, `docking_unit` or `mark`.
    pub kind: String,
    /// Number of the mark; of the others 0.
    pub index: u32,
    /// Centre after least squares, or a mark's place, px.
    pub position: [f64; 2],
    /// Centre as first found, px; of a mark none.
    pub raw_position: Option<[f64; 2]>,
    /// Radius of a circle, px.
    pub radius_px: Option<f64>,
    /// Slope of the cross's horizontal bar.
    pub slope: Option<f64>,
    /// Points on a circle, or pairs on the horizontal bar; of a mark 0.
    pub points: u32,
    /// Pairs on the vertical bar; of the others 0.
    pub vertical_pairs: u32,
    /// What became of a mark: `used`, `rejected`, `missing`, `out_of_field`; of the others `used`.
    pub usage: String,
}

impl FeatureRow {
    /// The rows of a field.
    pub fn of(field: u64, features: &Features) -> Vec<Self> {
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

impl Row for FeatureRow {
    const FRAME: &'static str = "field";

    fn columns(rows: &[Self]) -> Vec<Column> {
        let counts = |name, value: fn(&Self) -> u32| Column::new(name, rows.iter().map(value));
        vec![
            Column::new("field", rows.iter().map(|row| row.field)),
            words(rows, "kind", |row| &row.kind),
            counts("index", |row| row.index),
            optional_numbers(rows, "x_px", |row| Some(row.position[0])),
            optional_numbers(rows, "y_px", |row| Some(row.position[1])),
            optional_numbers(rows, "raw_x_px", |row| row.raw_position.map(|raw| raw[0])),
            optional_numbers(rows, "raw_y_px", |row| row.raw_position.map(|raw| raw[1])),
            optional_numbers(rows, "radius_px", |row| row.radius_px),
            optional_numbers(rows, "slope", |row| row.slope),
            counts("points", |row| row.points),
            counts("vertical_pairs", |row| row.vertical_pairs),
            words(rows, "usage", |row| &row.usage),
        ]
    }

    #[expect(
        clippy::indexing_slicing,
        reason = "`row` is below the number of rows of the batch, which all its columns have"
    )]
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let (field, index) = (columns.u64("field")?, columns.u32("index")?);
        let (points, pairs) = (columns.u32("points")?, columns.u32("vertical_pairs")?);
        let (kind, usage) = (columns.text("kind")?, columns.text("usage")?);
        let number = |name: &str| columns.optional_f64(name);
        let (x, y) = (number("x_px")?, number("y_px")?);
        let (raw_x, raw_y) = (number("raw_x_px")?, number("raw_y_px")?);
        let (radius, slope) = (number("radius_px")?, number("slope")?);
        (0..columns.len())
            .map(|row| {
                let place = x.get(row).zip(y.get(row));
                let (x, y) =
                    place.ok_or_else(|| columns.error(row, "x_px", "nothing", "a place, x_px and y_px"))?;
                Ok(Self {
                    field: field[row],
                    kind: kind.value(row).to_owned(),
                    index: index[row],
                    position: [x, y],
                    raw_position: raw_x.get(row).zip(raw_y.get(row)).map(|(x, y)| [x, y]),
                    radius_px: radius.get(row),
                    slope: slope.get(row),
                    points: points[row],
                    vertical_pairs: pairs[row],
                    usage: usage.value(row).to_owned(),
                })
            })
            .collect()
    }

    fn frame(&self) -> u64 {
        self.field
    }
}
