//! The one error type of this crate.

use std::path::PathBuf;

use thiserror::Error;

/// Why a simulation cannot be made.
#[derive(Debug, Error)]
pub enum SimError {
    /// A parameter outside its range.
    #[error("{field} is {value}, expected {expected}")]
    Parameter {
        /// Path of the parameter in the scenario, with its unit.
        field: &'static str,
        /// The value met.
        value: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// A parameter outside its range in an entry of a list.
    #[error("{path} is {value}, expected {expected}")]
    Entry {
        /// Path of the parameter in the scenario with the place of its entry, counted from 0: `schedule[2].count`.
        path: String,
        /// The value met.
        value: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// A value that the contract refuses.
    #[error(transparent)]
    Contract(#[from] contract::ContractError),
    /// A star catalogue that cannot be used.
    #[error(transparent)]
    Catalog(#[from] crate::catalog::CatalogError),
    /// A point-spread function of the user's that cannot be used.
    #[error("psf.path {}: {problem}", path.display())]
    PsfFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A docking target that cannot be used.
    #[error("target {target:?}: {problem}")]
    TargetFile {
        /// Its name, or the path of its file.
        target: String,
        /// What is wrong.
        problem: String,
    },
}

impl SimError {
    /// The error of a parameter of a list, as `schedule[].count`, with the place of its entry, counted from 0.
    pub(crate) fn in_entry(self, index: usize) -> Self {
        match self {
            Self::Parameter { field, value, expected } => {
                Self::Entry { path: field.replacen("[]", &format!("[{index}]"), 1), value, expected }
            }
            Self::Entry { path, value, expected } => {
                Self::Entry { path: path.replacen("[]", &format!("[{index}]"), 1), value, expected }
            }
            other => other,
        }
    }
}

/// Checks that `value` is finite and satisfies `holds`.
///
/// # Errors
/// [`SimError::Parameter`] with the field and what was expected.
pub(crate) fn require(
    field: &'static str,
    value: f64,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), SimError> {
    if value.is_finite() && holds(value) {
        Ok(())
    } else {
        Err(SimError::Parameter { field, value: value.to_string(), expected })
    }
}
