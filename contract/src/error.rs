//! Error type of this crate.

use thiserror::Error;

use crate::OutOfRange;

/// A value that the contract does not allow, with the value and the expected range or property.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContractError {
    /// A number outside its range, or not finite.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Four numbers that are not a unit quaternion.
    #[error("quaternion (w, x, y, z) = {wxyz:?} has norm {norm}, expected 1 within 1e-5")]
    NotUnit {
        /// The rejected components, scalar first.
        wxyz: [f64; 4],
        /// Norm of the components.
        norm: f64,
    },
    /// An image whose number of pixels is not columns × rows.
    #[error("an image of {columns} × {rows} pixels has {got} values, expected {}", columns * rows)]
    ImageSize {
        /// Expected number of columns.
        columns: usize,
        /// Expected number of rows.
        rows: usize,
        /// Actual number of values.
        got: usize,
    },
    /// A pipeline that cannot be built from its setup.
    #[error("pipeline `{pipeline}` cannot be built: {reason}")]
    CannotBuild {
        /// Name of the pipeline.
        pipeline: String,
        /// Reason of the failure.
        reason: String,
    },
}
