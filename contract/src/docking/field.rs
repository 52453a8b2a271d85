//! One field of television, as it arrives.

use crate::docking::Digitiser;
use crate::{ContractError, Frame, OutOfRange};

/// Which rows of the camera an image holds.
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
    /// The camera's row of the image's row `row`.
    pub fn camera_row(self, row: usize) -> usize {
        match self {
            Self::All => row,
            Self::Even => 2 * row,
            Self::Odd => 2 * row + 1,
        }
    }

    /// Rows of the camera from one row of the image to the next: 1 or 2.
    pub fn step(self) -> usize {
        match self {
            Self::All => 1,
            Self::Even | Self::Odd => 2,
        }
    }

    /// Rows of the image, from the rows of the camera.
    pub fn rows(self, camera_rows: usize) -> usize {
        match self {
            Self::All => camera_rows,
            Self::Even => camera_rows.div_ceil(2),
            Self::Odd => camera_rows / 2,
        }
    }

    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Even => "even",
            Self::Odd => "odd",
        }
    }

    /// Reads [`Lines::code`].
    pub fn parse(code: &str) -> Option<Self> {
        [Self::All, Self::Even, Self::Odd].into_iter().find(|lines| lines.code() == code)
    }
}

/// One field: an image and which rows of the camera it holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    image: Frame,
    lines: Lines,
    camera_rows: usize,
}

impl Field {
    /// A field of a camera with `camera_rows` rows. The image's number is the field's number in its sequence.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] when the image has not as many rows as `lines` of such a camera.
    pub fn new(image: Frame, lines: Lines, camera_rows: usize) -> Result<Self, ContractError> {
        if image.rows() != lines.rows(camera_rows) {
            let expected = "half the rows of the camera, or all of them when it is not interlaced";
            return Err(OutOfRange::new("rows of a field", image.rows(), expected).into());
        }
        Ok(Self { image, lines, camera_rows })
    }

    /// The digital numbers.
    pub fn image(&self) -> &Frame {
        &self.image
    }

    /// The digital numbers, given away without a copy.
    pub fn into_image(self) -> Frame {
        self.image
    }

    /// Which rows of the camera they are.
    pub fn lines(&self) -> Lines {
        self.lines
    }

    /// Rows of the camera.
    pub fn camera_rows(&self) -> usize {
        self.camera_rows
    }

    /// Number of the field in its sequence.
    pub fn number(&self) -> u64 {
        self.image.number()
    }
}

/// What is known of a field besides its pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldTelemetry {
    /// T of the paper: the field's own moment (middle of its exposure), s since the beginning of the sequence.
    pub time_s: f64,
    /// Which of [`crate::docking::DockingSetup::cameras`] took it (0-based): a spacecraft may change its lens.
    pub camera: usize,
    /// How the video signal was digitised.
    pub digitiser: Digitiser,
}
