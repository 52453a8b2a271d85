//! Field of a line of a catalogue.

use std::path::Path;

use super::super::CatalogError;

/// Text of a field, with its file, line and column.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) path: &'a Path,
    pub(super) line: usize,
    /// Position of the first character in the line, counted from 1.
    pub(super) column: usize,
    pub(super) name: &'static str,
    pub(super) text: &'a str,
}

impl Field<'_> {
    fn error(&self, expected: &'static str) -> CatalogError {
        let blanks = self.text.chars().take_while(|character| character.is_whitespace()).count();
        CatalogError::Field {
            path: self.path.to_path_buf(),
            line: self.line,
            column: if blanks < self.text.chars().count() { self.column + blanks } else { self.column },
            field: self.name,
            value: self.text.trim().to_owned(),
            expected,
        }
    }

    pub(super) fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }

    pub(super) fn id(&self) -> Result<u32, CatalogError> {
        self.text.trim().parse().map_err(|_| self.error("an integer from 0 to 4294967295"))
    }

    /// Parses a finite number from `low` to `high`.
    pub(super) fn number(&self, low: f64, high: f64, expected: &'static str) -> Result<f64, CatalogError> {
        match self.text.trim().parse::<f64>() {
            // NaN and infinity never lie between finite limits.
            Ok(value) if (low..=high).contains(&value) => Ok(value),
            _ => Err(self.error(expected)),
        }
    }

    pub(super) fn optional(
        &self,
        low: f64,
        high: f64,
        expected: &'static str,
    ) -> Result<Option<f64>, CatalogError> {
        if self.is_blank() { Ok(None) } else { self.number(low, high, expected).map(Some) }
    }

    pub(super) fn ra_deg(&self) -> Result<f64, CatalogError> {
        self.number(0.0, 360.0, "degrees from 0 to 360")
    }

    pub(super) fn dec_deg(&self) -> Result<f64, CatalogError> {
        self.number(-90.0, 90.0, "degrees from -90 to 90")
    }

    pub(super) fn magnitude(&self) -> Result<f64, CatalogError> {
        self.number(-30.0, 40.0, "a magnitude from -30 to 40")
    }

    pub(super) fn parallax_mas(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-1e4, 1e4, "blank, or mas from -10000 to 10000")
    }

    pub(super) fn proper_motion_mas_per_yr(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-1e5, 1e5, "blank, or mas per year from -100000 to 100000")
    }

    pub(super) fn colour(&self) -> Result<Option<f64>, CatalogError> {
        self.optional(-10.0, 20.0, "blank, or a colour index from -10 to 20 mag")
    }
}
