//! One field of interlaced television, as received.

use crate::docking::Digitiser;
use crate::{ContractError, Frame, OutOfRange};

/// Rows of the camera that an image contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lines {
    /// Every row: a progressive frame.
    All,
    /// Rows 0, 2, 4, … of the camera: the field that holds the top row.
    Even,
    /// Rows 1, 3, 5, … of the camera.
    Odd,
}

impl Lines {
    /// Returns the camera row of row `row` of the image.
    pub fn camera_row(self, row: usize) -> usize {
        match self {
            Self::All => row,
            Self::Even => 2 * row,
            Self::Odd => 2 * row + 1,
        }
    }

    /// Returns the number of camera rows between consecutive image rows: 1 or 2.
    pub fn step(self) -> usize {
        match self {
            Self::All => 1,
            Self::Even | Self::Odd => 2,
        }
    }

    /// Returns the number of image rows for a number of camera rows.
    pub fn rows(self, camera_rows: usize) -> usize {
        match self {
            Self::All => camera_rows,
            Self::Even => camera_rows.div_ceil(2),
            Self::Odd => camera_rows / 2,
        }
    }

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Even => "even",
            Self::Odd => "odd",
        }
    }

    /// Parses the result of [`Lines::code`].
    pub fn parse(code: &str) -> Option<Self> {
        [Self::All, Self::Even, Self::Odd].into_iter().find(|lines| lines.code() == code)
    }
}

/// One field: an image and the camera rows that it contains.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    image: Frame,
    lines: Lines,
    camera_rows: usize,
}

impl Field {
    /// Creates a field of a camera with `camera_rows` rows. The number of the image is the number of the
    /// field in its sequence.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] if the number of image rows differs from the number that `lines` of such
    /// a camera gives.
    pub fn new(image: Frame, lines: Lines, camera_rows: usize) -> Result<Self, ContractError> {
        if image.rows() != lines.rows(camera_rows) {
            let expected = "half the rows of the camera, or all rows of a progressive frame";
            return Err(OutOfRange::new("rows of a field", image.rows(), expected).into());
        }
        Ok(Self { image, lines, camera_rows })
    }

    /// Returns the image in digital numbers.
    pub fn image(&self) -> &Frame {
        &self.image
    }

    /// Returns the image in digital numbers by value, without a copy.
    pub fn into_image(self) -> Frame {
        self.image
    }

    /// Returns the set of camera rows that the field contains.
    pub fn lines(&self) -> Lines {
        self.lines
    }

    /// Returns the number of camera rows.
    pub fn camera_rows(&self) -> usize {
        self.camera_rows
    }

    /// Returns the number of the field in its sequence.
    pub fn number(&self) -> u64 {
        self.image.number()
    }
}

/// Telemetry of a field: the data besides its pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldTelemetry {
    /// Time T of the paper: the middle of the field's exposure, s since the beginning of the sequence.
    pub time_s: f64,
    /// Index in [`crate::docking::DockingSetup::cameras`] of the camera that took the field, from 0: a
    /// spacecraft may change its lens.
    pub camera: usize,
    /// Setting with which the video signal was digitised.
    pub digitiser: Digitiser,
}
