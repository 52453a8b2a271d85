//! Interlaced readout: a frame consists of two fields of alternate rows, each exposed at a different time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rows of one field, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RowParity {
    /// Rows 0, 2, 4, …
    Even,
    /// Rows 1, 3, 5, …
    Odd,
}

/// Interlaced readout by frame integration: each field contains every second row, without summing
/// neighbouring rows. The time of the frame is the middle between the exposures of its two fields: the first
/// is exposed about time − `field_interval_s`/2, the second about time + `field_interval_s`/2, each for the
/// exposure time of the shutter. An exposure may be longer than the interval; the two exposures then overlap
/// in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InterlaceConfig {
    /// Time from the middle of the first field's exposure to the middle of the second's, s, 0 to 10; 0.02 in
    /// a 50-field (PAL) and 1.001/60 in a 60-field (NTSC) camera.
    #[schemars(range(min = 0, max = 10))]
    pub field_interval_s: f64,
    /// Rows of the field that is exposed first, counted from 0.
    pub first_field: RowParity,
}

impl InterlaceConfig {
    /// Mid-exposure times of the first and of the second field, s from the time of the frame.
    pub fn offsets_s(&self) -> [f64; 2] {
        [-0.5 * self.field_interval_s, 0.5 * self.field_interval_s]
    }

    /// Returns true if a row, counted from 0, belongs to the first field.
    pub fn is_first(&self, row: usize) -> bool {
        row.is_multiple_of(2) == (self.first_field == RowParity::Even)
    }

    /// Mid-exposure time of a row, counted from 0, s from the time of the frame.
    pub fn offset_s(&self, row: usize) -> f64 {
        let [first_s, second_s] = self.offsets_s();
        if self.is_first(row) { first_s } else { second_s }
    }

    /// Copies the rows of the second field into `frame`. `frame` holds the scene of the first field and
    /// `second` that of the second field, both row by row with `columns` columns.
    pub fn weave(&self, frame: &mut [f64], second: &[f64], columns: usize) {
        let columns = columns.max(1);
        for (y, (row, later)) in frame.chunks_exact_mut(columns).zip(second.chunks_exact(columns)).enumerate()
        {
            if !self.is_first(y) {
                row.copy_from_slice(later);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAL: InterlaceConfig = InterlaceConfig { field_interval_s: 0.02, first_field: RowParity::Even };

    #[test]
    fn each_row_has_the_moment_of_its_field() {
        assert_eq!([0, 1, 2, 3].map(|row| PAL.offset_s(row)), [-0.01, 0.01, -0.01, 0.01]);
        let odd = InterlaceConfig { first_field: RowParity::Odd, ..PAL };
        assert_eq!([0, 1, 2, 3].map(|row| odd.offset_s(row)), [0.01, -0.01, 0.01, -0.01]);
    }

    #[test]
    fn a_woven_frame_has_alternate_rows_of_both_scenes() {
        let woven = |config: InterlaceConfig| {
            let mut frame = vec![1.0; 6];
            config.weave(&mut frame, &[2.0; 6], 2);
            frame
        };
        assert_eq!(woven(PAL), [1.0, 1.0, 2.0, 2.0, 1.0, 1.0]);
        let odd = InterlaceConfig { first_field: RowParity::Odd, ..PAL };
        assert_eq!(woven(odd), [2.0, 2.0, 1.0, 1.0, 2.0, 2.0]);
    }

    #[test]
    fn an_interval_out_of_range_is_named() {
        for field_interval_s in [-0.02, 10.5, f64::NAN] {
            let config = InterlaceConfig { field_interval_s, ..PAL };
            let message = contract::bounds::check(&config, "sensor.interlace").unwrap_err().to_string();
            assert!(message.starts_with("sensor.interlace.field_interval_s"), "{message}");
        }
    }
}
