//! Error for a truth that cannot be scored.

use thiserror::Error;

/// Error for a truth that cannot be scored.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ScoreError {
    /// A frame that does not follow the previous frame: it would be counted twice, or out of order.
    #[error("frame {frame} follows frame {previous}, expected each frame once, in ascending order")]
    Order {
        /// Number of the previous frame.
        previous: u64,
        /// Number of the frame.
        frame: u64,
    },
    /// A value that is impossible for a frame.
    #[error("frame {frame}: `{field}` is {value}, expected {expected}")]
    Impossible {
        /// Number of the frame.
        frame: u64,
        /// Column of the truth.
        field: &'static str,
        /// Value in the truth.
        value: String,
        /// Possible values.
        expected: &'static str,
    },
    /// An object of another frame.
    #[error("frame {frame} contains an object of frame {object}")]
    ForeignObject {
        /// Number of the scored frame.
        frame: u64,
        /// Number of the object's frame.
        object: u64,
    },
}
