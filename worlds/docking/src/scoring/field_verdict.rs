//! Verdict on a field with the values from which figures are counted.

use super::errors::PoseErrors;
use super::portions::PortionVerdict;
use super::verdict::Verdict;

/// Verdict on a field with the values from which figures are counted.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldVerdict {
    /// Number of the field.
    pub(super) field: u64,
    /// Bin of the true range, and camera; `None` for the first fields, in which the pipeline starts up.
    pub(super) group: Option<(usize, usize)>,
    /// True ρ, m.
    pub(super) range_m: f64,
    /// True if the target is resolved and completely in the image.
    pub(super) is_clear: bool,
    /// True if the last report is at most a second old; `None` for a field that is not clear, or until a
    /// second after the first measured field.
    pub(super) is_renewed: Option<bool>,
    /// True if all six parameters were measured and not doubtful.
    pub(super) is_measured: bool,
    /// True if all six parameters can be required: the target is resolved, or they were measured
    /// nevertheless.
    pub(super) is_asked: bool,
    pub(super) verdict: Verdict,
    /// NEES over its dimension, for a success.
    pub(super) nees: Option<f64>,
    /// For a success, true for each parameter within three standard deviations.
    pub(super) within: Option<[Option<bool>; 6]>,
    /// Errors of the paper's pose, if present.
    pub(super) paper: Option<PoseErrors>,
    pub(super) paper_is_wrong: bool,
    /// Verdict on the report, if the field ends a portion.
    pub(super) portion: Option<PortionVerdict>,
}
