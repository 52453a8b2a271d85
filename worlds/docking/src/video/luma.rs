//! Conversion of the pixel layouts of uncompressed video to grey values.

/// Pixel layout of a frame of uncompressed video.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Layout {
    /// One byte per pixel, converted by a table of grey values if there is one.
    Grey {
        /// Grey values of the palette.
        palette: Option<Box<[u8; 256]>>,
    },
    /// Blue, green, red and, with 4 bytes, one unused byte.
    Bgr {
        /// Number of bytes per pixel, 3 or 4.
        bytes: usize,
    },
    /// Two pixels in four bytes: Y U Y V, or U Y V Y with the first brightness at byte 1.
    Packed422 {
        /// Index of the first brightness byte, 0 or 1.
        first: usize,
    },
    /// One plane of brightness, then two planes of a quarter of its size (4:2:0).
    Planar420,
}

/// An uncompressed frame: pixel layout, size and order of rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct UncompressedFormat {
    pub(super) layout: Layout,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) bottom_up: bool,
}

impl UncompressedFormat {
    /// Returns the number of bytes in a row of brightness, without padding.
    fn row_bytes(&self) -> usize {
        match self.layout {
            Layout::Grey { .. } | Layout::Planar420 => self.columns,
            Layout::Bgr { bytes } => bytes * self.columns,
            Layout::Packed422 { .. } => 4 * self.columns.div_ceil(2),
        }
    }

    /// Returns the possible lengths of a frame: rows packed, or padded to four bytes as in a
    /// device-independent bitmap.
    pub(super) fn lengths(&self) -> [usize; 2] {
        let packed = self.row_bytes() * self.rows;
        match self.layout {
            Layout::Planar420 => [packed + 2 * self.columns.div_ceil(2) * self.rows.div_ceil(2); 2],
            _ => [packed, self.row_bytes().next_multiple_of(4) * self.rows],
        }
    }

    /// Returns the grey values, row by row from the top; `None` if the length of the frame is not in
    /// [`Self::lengths`].
    ///
    /// Y is used unscaled as the digital number, even if a player would stretch its range. Colour is
    /// converted to grey with the weights of BT.601, (299 R + 587 G + 114 B)/1000, rounded.
    pub(super) fn grey(&self, frame: &[u8]) -> Option<Vec<u16>> {
        let [packed, padded] = self.lengths();
        let stride = match (&self.layout, frame.len()) {
            (Layout::Planar420, n) if n == packed => self.row_bytes(),
            (_, n) if n == packed => self.row_bytes(),
            (_, n) if n == padded => self.row_bytes().next_multiple_of(4),
            _ => return None,
        };
        let mut grey = Vec::with_capacity(self.columns * self.rows);
        for row in 0..self.rows {
            let from = if self.bottom_up { self.rows - 1 - row } else { row } * stride;
            self.push_row(frame.get(from..from + self.row_bytes())?, &mut grey);
        }
        Some(grey)
    }

    fn push_row(&self, row: &[u8], grey: &mut Vec<u16>) {
        match &self.layout {
            Layout::Grey { palette: None } | Layout::Planar420 => {
                grey.extend(row.iter().map(|&y| u16::from(y)))
            }
            Layout::Grey { palette: Some(table) } => {
                grey.extend(
                    row.iter().map(|&index| table.get(usize::from(index)).map_or(0, |&grey| u16::from(grey))),
                );
            }
            Layout::Bgr { bytes } => {
                let pixels = row.chunks_exact(*bytes).filter_map(|pixel| pixel.first_chunk());
                grey.extend(pixels.map(|&[blue, green, red]| u16::from(grey_of_bgr(blue, green, red))));
            }
            Layout::Packed422 { first } => {
                grey.extend(row.iter().skip(*first).step_by(2).take(self.columns).map(|&y| u16::from(y)));
            }
        }
    }
}

/// Returns the brightness of a colour, BT.601.
pub(super) fn grey_of_bgr(blue: u8, green: u8, red: u8) -> u8 {
    ((299 * u32::from(red) + 587 * u32::from(green) + 114 * u32::from(blue) + 500) / 1000) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(layout: Layout, columns: usize, rows: usize, bottom_up: bool) -> UncompressedFormat {
        UncompressedFormat { layout, columns, rows, bottom_up }
    }

    #[test]
    fn grey_stored_as_colour_keeps_its_value() {
        assert!((0..=255).all(|v| grey_of_bgr(v, v, v) == v));
        assert_eq!(
            [(0, 0, 255), (0, 255, 0), (255, 0, 0)].map(|(b, g, r)| grey_of_bgr(b, g, r)),
            [76, 150, 29]
        );
    }

    #[test]
    fn every_layout_gives_its_brightness() {
        let grey = |palette| Layout::Grey { palette };
        assert_eq!(frame(grey(None), 3, 2, false).grey(&[1, 2, 3, 4, 5, 6]).unwrap(), [1, 2, 3, 4, 5, 6]);
        let padded = [4, 5, 6, 99, 1, 2, 3, 99];
        assert_eq!(frame(grey(None), 3, 2, true).grey(&padded).unwrap(), [1, 2, 3, 4, 5, 6]);
        let mut table = [0; 256];
        table[7] = 200;
        assert_eq!(frame(grey(Some(Box::new(table))), 1, 1, false).grey(&[7]).unwrap(), [200]);
        assert_eq!(frame(Layout::Bgr { bytes: 3 }, 1, 1, false).grey(&[9, 9, 9]).unwrap(), [9]);
        assert_eq!(frame(Layout::Bgr { bytes: 4 }, 1, 1, false).grey(&[9, 9, 9, 0]).unwrap(), [9]);
        let yuyv = frame(Layout::Packed422 { first: 0 }, 3, 1, false);
        assert_eq!(yuyv.grey(&[1, 0, 2, 0, 3, 0, 0, 0]).unwrap(), [1, 2, 3]);
        let uyvy = frame(Layout::Packed422 { first: 1 }, 2, 1, false);
        assert_eq!(uyvy.grey(&[0, 1, 0, 2]).unwrap(), [1, 2]);
        let planar = frame(Layout::Planar420, 3, 1, false);
        assert_eq!(planar.grey(&[1, 2, 3, 0, 0, 0, 0]).unwrap(), [1, 2, 3]);
        assert_eq!(planar.grey(&[1, 2, 3]), None);
    }
}
