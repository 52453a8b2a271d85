//! Causes of missed fields: every miss has exactly one cause.

use contract::docking::NoPose;

use super::truth::{TargetVisibility, TrueField};

/// Cause of a field with neither pose nor range. When several apply, the first in this order is taken: a
/// missing row; a failure of the pipeline, of which every one is counted, whatever the field showed; by the
/// truth only, a cause that no pipeline could have avoided; the reason that the pipeline states.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MissCause {
    /// The measurements have no row for the field.
    NotReported,
    /// The pipeline failed.
    PipelineFailed,
    /// The target is not resolved: a bar of its cross is narrower than two pixels.
    TooFar,
    /// The target is outside the image ([`TargetVisibility::Outside`]), or partly outside if the pipeline
    /// states so.
    OutsideField,
    /// At least [`MissCause::LOST_LINES`] of the image's lines were lost.
    LostLines,
    /// At least half of the marks are illuminated by neither Sun nor lamp.
    InShadow,
    /// The reason that the pipeline states, if the truth shows no other cause; never [`NoPose::Failed`].
    NoPose(NoPose),
}

impl MissCause {
    /// Smallest fraction of lost lines that counts as the cause.
    pub const LOST_LINES: f64 = 0.1;

    /// Codes of all causes, in order of precedence.
    pub const CODES: [&str; 13] = [
        "not_reported",
        "pipeline_failed",
        "too_far",
        "outside_field",
        "lost_lines",
        "in_shadow",
        "empty_field",
        "saturated_field",
        "no_target",
        "ambiguous_target",
        "out_of_field",
        "too_few_features",
        "inconsistent",
    ];

    /// Returns the cause of a field without a pose; `reason` is that of the pipeline, `None`
    /// without an outcome.
    pub(super) fn from_truth(truth: &TrueField, is_resolved: bool, reason: Option<&NoPose>) -> Self {
        let Some(reason) = reason else { return Self::NotReported };
        if matches!(reason, NoPose::Failed(_)) {
            return Self::PipelineFailed;
        }
        let visibility = truth.visibility;
        if !is_resolved {
            Self::TooFar
        } else if visibility == TargetVisibility::Outside
            || (visibility == TargetVisibility::Partial && *reason == NoPose::OutOfField)
        {
            Self::OutsideField
        } else if truth.lost_lines >= Self::LOST_LINES {
            Self::LostLines
        } else if truth.marks_in_shadow >= 0.5 {
            Self::InShadow
        } else {
            Self::NoPose(reason.clone())
        }
    }

    /// Returns the name used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NotReported => "not_reported",
            Self::PipelineFailed => "pipeline_failed",
            Self::TooFar => "too_far",
            Self::OutsideField => "outside_field",
            Self::LostLines => "lost_lines",
            Self::InShadow => "in_shadow",
            Self::NoPose(reason) => reason.code(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::field;

    fn cause(change: impl FnOnce(&mut TrueField, &mut bool), reason: Option<NoPose>) -> &'static str {
        let (mut truth, mut is_resolved) = (field(0, 10.0), true);
        change(&mut truth, &mut is_resolved);
        let code = MissCause::from_truth(&truth, is_resolved, reason.as_ref()).code();
        assert!(MissCause::CODES.contains(&code), "{code}");
        code
    }

    #[test]
    fn the_truth_precedes_the_pipelines_reason() {
        let reason = || Some(NoPose::NoTarget);
        assert_eq!(cause(|_, is_resolved| *is_resolved = false, reason()), "too_far");
        assert_eq!(cause(|truth, _| truth.visibility = TargetVisibility::Outside, reason()), "outside_field");
        assert_eq!(cause(|truth, _| truth.lost_lines = 0.2, reason()), "lost_lines");
        assert_eq!(cause(|truth, _| truth.marks_in_shadow = 0.6, reason()), "in_shadow");
        assert_eq!(cause(|_, _| (), reason()), "no_target");
        assert_eq!(cause(|_, is_resolved| *is_resolved = false, None), "not_reported");
    }

    #[test]
    fn a_target_partly_outside_is_the_cause_if_the_pipeline_reports_it() {
        let partly = |truth: &mut TrueField, _: &mut bool| truth.visibility = TargetVisibility::Partial;
        assert_eq!(cause(partly, Some(NoPose::OutOfField)), "outside_field");
        assert_eq!(cause(partly, Some(NoPose::TooFewFeatures)), "too_few_features");
        assert_eq!(cause(|_, _| (), Some(NoPose::OutOfField)), "out_of_field");
    }

    #[test]
    fn a_failure_of_the_pipeline_is_one_cause_regardless_of_its_text() {
        let failed = || Some(NoPose::Failed("out of film".to_owned()));
        assert_eq!(cause(|_, _| (), failed()), "pipeline_failed");
        assert_eq!(cause(|_, is_resolved| *is_resolved = false, failed()), "pipeline_failed");
    }
}
