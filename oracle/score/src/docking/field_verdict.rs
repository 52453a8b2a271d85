//! What the score keeps of a field.

use super::errors::PoseErrors;
use super::portions::PortionVerdict;
use super::verdict::Verdict;

/// What the score keeps of a field.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldVerdict {
    /// Number of the field.
    pub(super) field: u64,
    /// Bin of the true range, and camera; none for the first fields, in which the pipeline starts up.
    pub(super) group: Option<(usize, usize)>,
    /// True ρ, m.
    pub(super) range_m: f64,
    /// Whether the target is resolved and wholly in the image.
    pub(super) is_clear: bool,
    /// Of a clear field, from a second after the first measured one: whether the last report is at most a second old.
    pub(super) is_renewed: Option<bool>,
    /// Whether all six parameters were given, and not doubted.
    pub(super) is_measured: bool,
    /// Whether all six can be asked for: the target is resolved, or they were given all the same.
    pub(super) is_asked: bool,
    pub(super) verdict: Verdict,
    /// Of a success: NEES over its dimension.
    pub(super) nees: Option<f64>,
    /// Of a success: whether each parameter is within three standard deviations.
    pub(super) within: Option<[Option<bool>; 6]>,
    /// Errors of the paper's pose, where there is one.
    pub(super) paper: Option<PoseErrors>,
    pub(super) paper_is_wrong: bool,
    /// The report, where the field ends a portion.
    pub(super) portion: Option<PortionVerdict>,
}
