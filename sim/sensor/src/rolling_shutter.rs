//! Rolling shutter: the rows of a frame are exposed one after another.

use contract::OutOfRange;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rolling shutter of a CMOS detector: every row is exposed for the exposure time of the shutter, each at its
/// own time. The time of the frame is mid-exposure of the middle of the detector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RollingShutterConfig {
    /// Time from the exposure of one row to that of the next, s, −0.01 to 0.01; negative: the last row is
    /// exposed first. Detectors have 1e-6 to 1e-4.
    #[schemars(range(min = -0.01, max = 0.01))]
    pub row_time_s: f64,
}

impl RollingShutterConfig {
    /// Returns mid-exposure of a row, counted from 0, of a detector with `rows` rows, s from the time of the
    /// frame.
    pub fn offset_s(&self, row: f64, rows: usize) -> f64 {
        self.row_time_s * (row - 0.5 * (rows as f64 - 1.0))
    }

    /// Returns mid-exposure of the first and of the last row of a detector, s from the time of the frame.
    pub fn offsets_s(&self, rows: usize) -> [f64; 2] {
        [self.offset_s(0.0, rows), self.offset_s(rows as f64 - 1.0, rows)]
    }

    /// Refuses a detector that is interlaced or transfers its frame: both expose all rows of a field at once.
    pub(crate) fn check(&self, is_interlaced: bool, frame_transfer_s: f64) -> Result<(), OutOfRange> {
        let path = "sensor.rolling_shutter.row_time_s";
        if is_interlaced {
            return Err(OutOfRange::new(path, self.row_time_s, "no rolling shutter with [sensor.interlace]"));
        }
        if frame_transfer_s > 0.0 {
            let expected = format!("no rolling shutter with sensor.frame_transfer_s = {frame_transfer_s}");
            return Err(OutOfRange::new(path, self.row_time_s, expected));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_follow_each_other_about_the_time_of_the_frame() {
        let shutter = RollingShutterConfig { row_time_s: 0.001 };
        assert_eq!(shutter.offsets_s(101), [-0.05, 0.05]);
        assert_eq!(shutter.offset_s(50.0, 101), 0.0);
        let upwards = RollingShutterConfig { row_time_s: -0.001 };
        assert_eq!(upwards.offsets_s(101), [0.05, -0.05]);
    }

    #[test]
    fn detectors_that_expose_all_rows_at_once_are_refused() {
        let shutter = RollingShutterConfig { row_time_s: 1e-5 };
        assert!(shutter.check(false, 0.0).is_ok());
        let interlaced = shutter.check(true, 0.0).unwrap_err().to_string();
        assert!(interlaced.contains("is 0.00001, expected no rolling shutter with [sensor.interlace]"));
        let transferred = shutter.check(false, 0.002).unwrap_err().to_string();
        assert!(transferred.contains("frame_transfer_s = 0.002"), "{transferred}");
    }
}
