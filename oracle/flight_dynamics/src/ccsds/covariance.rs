//! Covariances of states.

use files::FileError;
use hifitime::Epoch;
use nalgebra::Matrix6;

use crate::document::{COVARIANCE_KEYWORDS, Notation, Record, Writer};
use crate::frame::{FRAME_NAMES, ReferenceFrame};
use crate::time::TimeSystem;

/// Axes of a covariance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CovarianceFrame {
    /// Axes of a celestial frame.
    Reference(ReferenceFrame),
    /// Radial, transverse and normal axes of the orbit.
    Rtn,
    /// Tangential, normal and orbit-normal axes.
    Tnw,
}

impl CovarianceFrame {
    pub(super) fn code(self) -> &'static str {
        match self {
            Self::Reference(frame) => frame.code(),
            Self::Rtn => "RTN",
            Self::Tnw => "TNW",
        }
    }

    pub(super) fn parse(code: &str) -> Option<Self> {
        match code.to_ascii_uppercase().as_str() {
            "RTN" | "RSW" => Some(Self::Rtn),
            "TNW" => Some(Self::Tnw),
            code => ReferenceFrame::parse(code).map(Self::Reference),
        }
    }
}

/// Covariance of position and velocity at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    /// Time.
    pub time: Epoch,
    /// Axes.
    pub frame: CovarianceFrame,
    /// Lower triangle row by row, in the order x, y, z, x', y', z'; km², km²/s, km²/s².
    pub lower_triangle: [f64; 21],
}

/// Units of the numbers by the number of derivatives in their keyword.
fn unit_of(keyword: &str) -> &'static str {
    match keyword.matches("DOT").count() {
        0 => "km**2",
        1 => "km**2/s",
        _ => "km**2/s**2",
    }
}

impl Covariance {
    /// Creates the covariance of position, km, and velocity, km/s, along the axes ICRF.
    pub fn from_icrf(time: Epoch, matrix: &Matrix6<f64>) -> Self {
        let lower = (0..6).flat_map(|row| (0..=row).map(move |column| (row, column)));
        let mut lower_triangle = [0.0; 21];
        for (number, index) in lower_triangle.iter_mut().zip(lower) {
            *number = matrix.get(index).copied().unwrap_or_default();
        }
        Self { time, frame: CovarianceFrame::Reference(ReferenceFrame::Icrf), lower_triangle }
    }

    /// Reads a covariance. Without a frame of its own it has the frame before it, at first that of the
    /// states.
    pub(crate) fn read(
        record: &Record<'_>,
        time: Epoch,
        frame_before: CovarianceFrame,
    ) -> Result<Self, FileError> {
        let frame = match record.find("COV_REF_FRAME") {
            None => frame_before,
            Some(entry) => CovarianceFrame::parse(entry.value)
                .ok_or_else(|| record.refuse(entry, format!("RTN, TNW or {FRAME_NAMES}")))?,
        };
        let mut lower_triangle = [0.0; 21];
        for (number, keyword) in lower_triangle.iter_mut().zip(COVARIANCE_KEYWORDS) {
            *number = record.require_number(keyword, unit_of(keyword))?;
        }
        // Diagonal: the last number of each row.
        for (row, index) in [0, 2, 5, 9, 14, 20].into_iter().enumerate() {
            let keyword = COVARIANCE_KEYWORDS.get(index).copied().unwrap_or_default();
            if lower_triangle.get(index).is_some_and(|variance| *variance < 0.0) {
                let expected = format!("a variance of at least 0 (row {})", row + 1);
                return Err(record.refuse(record.require(keyword)?, expected));
            }
        }
        Ok(Self { time, frame, lower_triangle })
    }

    /// Writes the covariance of an ephemeris (with its time) or of one state.
    pub(crate) fn write(&self, writer: &mut Writer, time_system: Option<TimeSystem>) {
        writer.open("covarianceMatrix");
        if let Some(system) = time_system {
            writer.value("EPOCH", system.format_time(self.time));
        }
        writer.value("COV_REF_FRAME", self.frame.code());
        let in_rows = writer.notation() == Notation::Kvn && time_system.is_some();
        let mut numbers = self.lower_triangle.iter().zip(COVARIANCE_KEYWORDS);
        for row in 1..=6 {
            let row: Vec<(&f64, &str)> = numbers.by_ref().take(row).collect();
            if in_rows {
                let words: Vec<String> = row.iter().map(|(number, _)| format!("{number:e}")).collect();
                writer.line(&words.join(" "));
            } else {
                for (number, keyword) in row {
                    writer.exponential(keyword, *number, unit_of(keyword));
                }
            }
        }
        writer.close("covarianceMatrix");
    }
}
