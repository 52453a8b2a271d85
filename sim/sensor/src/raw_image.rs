//! Output of the converter.

/// Digital numbers as output by the converter. Reused from frame to frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawImage {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) bit_depth: u8,
    pub(super) dn: Vec<u16>,
}

impl RawImage {
    /// Creates an image from given digital numbers.
    #[cfg(test)]
    pub(crate) fn from_dn(columns: usize, rows: usize, bit_depth: u8, dn: Vec<u16>) -> Self {
        assert_eq!(dn.len(), columns * rows);
        Self { columns, rows, bit_depth, dn }
    }

    /// Number of columns and of rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Bits of the converter.
    pub fn bit_depth(&self) -> u8 {
        self.bit_depth
    }

    /// All digital numbers, row by row.
    pub fn dn(&self) -> &[u16] {
        &self.dn
    }
}
