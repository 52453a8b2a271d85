//! The one error type of this crate.

use thiserror::Error;

use crate::OutOfRange;

/// A value that the contract does not allow: which, what it was, and what was expected.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContractError {
    /// A number outside its range, or not finite.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Four numbers that are not a unit quaternion.
    #[error("quaternion (w, x, y, z) = {wxyz:?} has norm {norm}, expected 1 within 1e-5")]
    NotUnit {
        /// The components met, scalar first.
        wxyz: [f64; 4],
        /// Their norm.
        norm: f64,
    },
    /// An image whose number of pixels is not columns × rows.
    #[error("an image of {columns} × {rows} pixels has {got} values, expected {}", columns * rows)]
    ImageSize {
        /// Columns expected.
        columns: usize,
        /// Rows expected.
        rows: usize,
        /// Values met.
        got: usize,
    },
    /// A pipeline that cannot be built from its setup.
    #[error("pipeline `{pipeline}` cannot be built: {reason}")]
    CannotBuild {
        /// Name of the pipeline.
        pipeline: String,
        /// Why.
        reason: String,
    },
}
