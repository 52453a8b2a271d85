//! Whole television frames, and their two fields.

use std::str::FromStr;

use contract::docking::{Digitiser, Field, FieldTelemetry, Lines};
use contract::{ContractError, Frame};

/// A frame of a sequence, with the size of the camera.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VideoFrame {
    /// Index in the sequence; dropped frames count.
    pub(super) index: u64,
    /// Digital numbers, row by row from the top.
    pub(super) dn: Vec<u16>,
}

/// Order in time of the fields of an interlaced frame: which field is first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FieldOrder {
    /// The field with the top row is first: rows 0, 2, 4, …
    Top,
    /// The field without the top row is first: rows 1, 3, 5, …
    Bottom,
}

impl FromStr for FieldOrder {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "top" => Ok(Self::Top),
            "bottom" => Ok(Self::Bottom),
            _ => Err(format!("`{text}` is not a field order; expected top or bottom")),
        }
    }
}

/// Scan of the rows in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scan {
    /// All rows have the same time: a frame is one field.
    Progressive,
    /// Even and odd rows differ by half a frame period: a frame is two fields.
    Interlaced(FieldOrder),
}

impl Scan {
    /// Returns the camera rows of each field in a frame, in order of time.
    pub(super) fn fields(self) -> &'static [Lines] {
        match self {
            Self::Progressive => &[Lines::All],
            Self::Interlaced(FieldOrder::Top) => &[Lines::Even, Lines::Odd],
            Self::Interlaced(FieldOrder::Bottom) => &[Lines::Odd, Lines::Even],
        }
    }
}

/// Common properties of the frames of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Format {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) bit_depth: u8,
    pub(super) rate_hz: f64,
    pub(super) scan: Scan,
    pub(super) camera: usize,
    pub(super) digitiser: Digitiser,
}

impl Format {
    /// Returns the fields of a frame, in order of time: field k of the sequence has the time k/(fields per
    /// second).
    pub(super) fn split(&self, frame: &VideoFrame) -> Result<Vec<(Field, FieldTelemetry)>, ContractError> {
        let fields = self.scan.fields();
        let field = |(nth, &lines): (usize, &Lines)| {
            let number = frame.index * fields.len() as u64 + nth as u64;
            let dn = take_rows(&frame.dn, self.columns, lines);
            let rows = lines.rows(self.rows);
            let image = Frame::new(number, self.columns, rows, self.bit_depth, dn, None)?;
            let telemetry = FieldTelemetry {
                time_s: number as f64 / (self.rate_hz * fields.len() as f64),
                camera: self.camera,
                digitiser: self.digitiser,
            };
            Ok((Field::new(image, lines, self.rows)?, telemetry))
        };
        fields.iter().enumerate().map(field).collect()
    }
}

/// Returns the rows of an image that belong to a field.
pub(super) fn take_rows(dn: &[u16], columns: usize, lines: Lines) -> Vec<u16> {
    let first = lines.camera_row(0);
    dn.chunks_exact(columns).skip(first).step_by(lines.step()).flatten().copied().collect()
}

/// Copies the rows of a field to a whole frame, which has the size of the field's camera.
pub(super) fn weave(field: &Field, frame: &mut [u8]) -> Option<()> {
    let image = field.image();
    for row in 0..image.rows() {
        let from = field.lines().camera_row(row) * image.columns();
        let to = frame.get_mut(from..from + image.columns())?;
        for (value, &dn) in to.iter_mut().zip(image.row(row)) {
            *value = u8::try_from(dn).ok()?;
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn format(rows: usize, scan: Scan) -> Format {
        Format {
            columns: 2,
            rows,
            bit_depth: 8,
            rate_hz: 25.0,
            scan,
            camera: 1,
            digitiser: Digitiser::default(),
        }
    }

    fn ramp(rows: usize, index: u64) -> VideoFrame {
        VideoFrame { index, dn: (0..2 * rows as u16).collect() }
    }

    #[test]
    fn a_frame_is_two_fields_half_a_frame_apart_in_the_order_given() {
        for (order, first, second) in
            [(FieldOrder::Top, Lines::Even, Lines::Odd), (FieldOrder::Bottom, Lines::Odd, Lines::Even)]
        {
            let fields = format(4, Scan::Interlaced(order)).split(&ramp(4, 3)).unwrap();
            let seen: Vec<_> =
                fields.iter().map(|(f, t)| (f.lines(), f.number(), t.time_s, t.camera)).collect();
            assert_eq!(seen, [(first, 6, 0.12, 1), (second, 7, 0.14, 1)]);
            let even = fields.iter().find(|(f, _)| f.lines() == Lines::Even).unwrap();
            assert_eq!(even.0.image().dn(), [0, 1, 4, 5]);
        }
    }

    #[test]
    fn an_odd_number_of_rows_gives_the_even_field_one_more() {
        let fields = format(5, Scan::Interlaced(FieldOrder::Bottom)).split(&ramp(5, 0)).unwrap();
        assert_eq!(fields[0].0.image().dn(), [2, 3, 6, 7]);
        assert_eq!(fields[1].0.image().dn(), [0, 1, 4, 5, 8, 9]);
        let mut woven = vec![0; 10];
        fields.iter().for_each(|(field, _)| weave(field, &mut woven).unwrap());
        assert_eq!(woven, (0..10).collect::<Vec<u8>>());
    }

    #[test]
    fn a_progressive_frame_is_one_field() {
        let fields = format(3, Scan::Progressive).split(&ramp(3, 5)).unwrap();
        assert_eq!(fields.len(), 1);
        assert_eq!((fields[0].0.number(), fields[0].1.time_s, fields[0].0.lines()), (5, 0.2, Lines::All));
    }

    #[test]
    fn other_words_are_no_field_order() {
        assert_eq!("bottom".parse(), Ok(FieldOrder::Bottom));
        assert!("tff".parse::<FieldOrder>().unwrap_err().contains("top or bottom"));
    }
}
