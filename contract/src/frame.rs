//! One image, as received on the ground.

use crate::{ContractError, OutOfRange};

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
}

impl Window {
    /// Returns true if the pixel (x, y) is inside the window.
    pub fn contains(&self, x: usize, y: usize) -> bool {
        (self.x..self.x + self.columns).contains(&x) && (self.y..self.y + self.rows).contains(&y)
    }
}

/// One image in digital numbers, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    number: u64,
    columns: usize,
    rows: usize,
    bit_depth: u8,
    dn: Vec<u16>,
    windows: Option<Vec<Window>>,
}

impl Frame {
    /// Creates a frame of `columns` × `rows` digital numbers; `windows` are the transmitted regions, `None`
    /// if the whole image was transmitted. Pixels outside every window are 0 and carry no information.
    ///
    /// # Errors
    /// [`ContractError::ImageSize`] if the number of values is wrong, [`ContractError::OutOfRange`] if the
    /// bit depth is not 1 to 16 or a window extends beyond the image.
    pub fn new(
        number: u64,
        columns: usize,
        rows: usize,
        bit_depth: u8,
        dn: Vec<u16>,
        windows: Option<Vec<Window>>,
    ) -> Result<Self, ContractError> {
        if columns.checked_mul(rows) != Some(dn.len()) {
            return Err(ContractError::ImageSize { columns, rows, got: dn.len() });
        }
        if !(1..=16).contains(&bit_depth) {
            return Err(OutOfRange::new("bit depth of a frame", bit_depth, "1 to 16").into());
        }
        for window in windows.iter().flatten() {
            let fits = |first: usize, count: usize, n: usize| {
                count > 0 && first.checked_add(count).is_some_and(|end| end <= n)
            };
            if !fits(window.x, window.columns, columns) || !fits(window.y, window.rows, rows) {
                let first = if fits(window.x, window.columns, columns) { window.y } else { window.x };
                let expected = "a rectangle inside the image (value: its first column or row)";
                return Err(OutOfRange::new("window of a frame", first, expected).into());
            }
        }
        Ok(Self { number, columns, rows, bit_depth, dn, windows })
    }

    /// Returns the number of the frame in its scenario or dataset.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns the number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the bit depth of the analogue-digital converter.
    pub fn bit_depth(&self) -> u8 {
        self.bit_depth
    }

    /// Returns the largest digital number of the converter: 2^bits − 1.
    pub fn full_scale_dn(&self) -> u16 {
        (u32::MAX >> (32 - u32::from(self.bit_depth))) as u16
    }

    /// Returns all digital numbers, row by row.
    pub fn dn(&self) -> &[u16] {
        &self.dn
    }

    /// Returns all digital numbers, row by row, by value and without a copy.
    pub fn into_dn(self) -> Vec<u16> {
        self.dn
    }

    /// Returns the digital numbers of row `y`.
    ///
    /// # Panics
    /// If the frame has no such row.
    #[allow(clippy::indexing_slicing, reason = "like a slice, requires an index inside the frame")]
    pub fn row(&self, y: usize) -> &[u16] {
        &self.dn[y * self.columns..(y + 1) * self.columns]
    }

    /// Returns the digital number of the pixel (x, y).
    ///
    /// # Panics
    /// If the frame has no such pixel.
    #[allow(clippy::indexing_slicing, reason = "like a slice, requires an index inside the frame")]
    pub fn dn_at(&self, x: usize, y: usize) -> u16 {
        self.dn[y * self.columns + x]
    }

    /// Returns the transmitted regions; `None` if the whole image was transmitted.
    pub fn windows(&self) -> Option<&[Window]> {
        self.windows.as_deref()
    }
}
