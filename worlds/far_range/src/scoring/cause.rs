//! Causes of losing the target: every miss and every wrong measurement has exactly one cause.

use contract::{Cluster, Label, NoSolution, Outcome, Solution};
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};

use super::cluster_members::{covers, holds, merged_with, target};

/// Cause of a miss or of a wrong measurement. When several apply, the first in this order is taken:
///
/// 1. there is no answer to judge: no row ([`Cause::NotReported`]), or a failure of the pipeline
///    ([`Cause::PipelineFailed`]), of which every one is counted, whatever the frame showed;
/// 2. by the truth only, a cause that no pipeline could have avoided: [`Cause::OutsideField`],
///    [`Cause::InEclipse`], [`Cause::TooFaint`], [`Cause::CutByRoi`];
/// 3. the reason that the pipeline states: [`Cause::SaturatedFrame`], [`Cause::NoPreviousFrame`], and an
///    empty frame as [`Cause::BelowThreshold`];
/// 4. if the pipeline reports its clusters, the label of the cluster that is nearest to the target and within
///    its reach of max(`radius_px`, 1.5) px, along its columns by `bloom_px` farther; without such a cluster,
///    a cluster at a star, planet, the Moon, a hot pixel or cosmic-ray hit that touches the target (distance
///    up to the sum of the reaches); without that, [`Cause::BelowThreshold`];
/// 5. by the truth only, the visible star, planet, Moon, hot pixel or cosmic-ray hit that touches the target;
/// 6. [`Cause::Unexplained`].
///
/// A wrong measurement whose chosen cluster holds the target, but contains more electrons of a star, planet,
/// the Moon, a hot pixel or a cosmic-ray hit, has merged with that object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Cause {
    /// The measurements have no row for the frame.
    NotReported,
    /// The pipeline failed, or its measurement is not a direction.
    PipelineFailed,
    /// The centre of the target's image is off the detector, or the target is behind the camera.
    OutsideField,
    /// The target is wholly or partly in the Earth's shadow and not detectable.
    InEclipse,
    /// The target is in sunlight, but not detectable: its signal-to-noise ratio is below 5.
    TooFaint,
    /// More than half of the target's electrons are outside the transmitted regions.
    CutByRoi,
    /// The pipeline gave up because a large part of the frame is saturated.
    SaturatedFrame,
    /// The pipeline had no previous frame from which to measure motion.
    NoPreviousFrame,
    /// The target's image touches that of a visible star: they form one cluster, which was mistaken for the
    /// star or measured at another position.
    MergedWithStar,
    /// The target's image touches that of a visible planet: they form one cluster, which was measured at
    /// another position.
    MergedWithPlanet,
    /// The target's image touches that of the visible Moon: they form one cluster, which was measured at
    /// another position.
    MergedWithMoon,
    /// The target's cluster was labelled as a star although no visible star touches it: a wrong
    /// identification.
    TakenForStar,
    /// The target's cluster was labelled as a hotspot, or it touches a hot pixel.
    TakenForHotspot,
    /// A cosmic-ray hit touches the target.
    MergedWithCosmicRay,
    /// The target's cluster was a candidate, but another candidate was chosen.
    LostMotionTest,
    /// The target's cluster was not linked to the previous frame.
    NotLinked,
    /// The target is detectable, but the pipeline found no cluster at its position.
    BelowThreshold,
    /// Any other cause.
    Unexplained,
}

impl Cause {
    /// All causes, in order of precedence.
    pub const ALL: [Self; 18] = [
        Self::NotReported,
        Self::PipelineFailed,
        Self::OutsideField,
        Self::InEclipse,
        Self::TooFaint,
        Self::CutByRoi,
        Self::SaturatedFrame,
        Self::NoPreviousFrame,
        Self::MergedWithStar,
        Self::MergedWithPlanet,
        Self::MergedWithMoon,
        Self::TakenForStar,
        Self::TakenForHotspot,
        Self::MergedWithCosmicRay,
        Self::LostMotionTest,
        Self::NotLinked,
        Self::BelowThreshold,
        Self::Unexplained,
    ];

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::NotReported => "not_reported",
            Self::OutsideField => "outside_field",
            Self::InEclipse => "in_eclipse",
            Self::TooFaint => "too_faint",
            Self::CutByRoi => "cut_by_roi",
            Self::PipelineFailed => "pipeline_failed",
            Self::SaturatedFrame => "saturated_frame",
            Self::NoPreviousFrame => "no_previous_frame",
            Self::MergedWithStar => "merged_with_star",
            Self::MergedWithPlanet => "merged_with_planet",
            Self::MergedWithMoon => "merged_with_moon",
            Self::TakenForStar => "taken_for_star",
            Self::TakenForHotspot => "taken_for_hotspot",
            Self::MergedWithCosmicRay => "merged_with_cosmic_ray",
            Self::LostMotionTest => "lost_motion_test",
            Self::NotLinked => "not_linked",
            Self::BelowThreshold => "below_threshold",
            Self::Unexplained => "unexplained",
        }
    }

    /// Parses a [`Cause::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cause| cause.code() == code)
    }

    /// Returns true if no pipeline could have found the target: it is outside the field, in eclipse, too
    /// faint or cut off.
    pub fn is_undetectable(self) -> bool {
        matches!(self, Self::OutsideField | Self::InEclipse | Self::TooFaint | Self::CutByRoi)
    }

    /// Returns the cause of losing the target in an image that it shares with a brighter object of this kind.
    pub(super) fn from_brighter_object(kind: ObjectKind) -> Self {
        match kind {
            ObjectKind::Star => Self::MergedWithStar,
            ObjectKind::Planet => Self::MergedWithPlanet,
            ObjectKind::Moon => Self::MergedWithMoon,
            ObjectKind::HotPixel => Self::TakenForHotspot,
            ObjectKind::CosmicRay => Self::MergedWithCosmicRay,
            ObjectKind::Target => Self::Unexplained,
        }
    }
}

/// Size of the detector, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Detector {
    pub columns: usize,
    pub rows: usize,
}

/// Returns the cause, by the precedence defined at [`Cause`].
pub(super) fn cause(
    truth: &FrameTruth,
    objects: &[ObjectTruth],
    outcome: Option<&Outcome>,
    detector: Detector,
) -> Cause {
    let Some(outcome) = outcome else { return Cause::NotReported };
    if matches!(outcome.solution, Solution::NoSolution(NoSolution::Failed(_))) {
        return Cause::PipelineFailed;
    }
    let target = target(objects);
    let neighbour = target.and_then(|target| merged_with(target, objects));
    undetectable_cause(truth, target, detector)
        .or_else(|| pipeline_reason(&outcome.solution))
        .or_else(|| cause_by_label(target?, neighbour, &outcome.clusters))
        .or_else(|| neighbour.map(|other| Cause::from_brighter_object(other.kind)))
        .unwrap_or(Cause::Unexplained)
}

/// Returns true if the target's centre is on the detector.
fn is_in_field(truth: &FrameTruth, detector: Detector) -> bool {
    truth.target_position.is_some_and(|at| at.is_on_detector(detector.columns, detector.rows))
}

/// Returns true if no target is visible: it is outside the field, or invisible by its signal-to-noise ratio.
pub(super) fn is_absent(truth: &FrameTruth, detector: Detector) -> bool {
    !is_in_field(truth, detector) || truth.target_visibility == Visibility::Invisible
}

/// Returns a cause that no pipeline could have avoided.
fn undetectable_cause(truth: &FrameTruth, target: Option<&ObjectTruth>, detector: Detector) -> Option<Cause> {
    if !is_in_field(truth, detector) {
        Some(Cause::OutsideField)
    } else if truth.target_visibility != Visibility::Detectable {
        Some(if truth.shadow == Shadow::Sunlit { Cause::TooFaint } else { Cause::InEclipse })
    } else if target.is_some_and(|target| target.cut > 0.5) {
        Some(Cause::CutByRoi)
    } else {
        None
    }
}

/// Returns the reason stated by the pipeline, if it applies to the whole frame.
fn pipeline_reason(solution: &Solution) -> Option<Cause> {
    match solution {
        Solution::NoSolution(NoSolution::SaturatedFrame) => Some(Cause::SaturatedFrame),
        Solution::NoSolution(NoSolution::NoPreviousFrame) => Some(Cause::NoPreviousFrame),
        Solution::NoSolution(NoSolution::EmptyFrame) => Some(Cause::BelowThreshold),
        Solution::NoSolution(NoSolution::NoTarget | NoSolution::Failed(_)) | Solution::Detected(_) => None,
    }
}

/// Returns the cause from the label of the cluster at the target's position; `None` if no clusters are
/// reported or their labels give no cause.
fn cause_by_label(
    target: &ObjectTruth,
    neighbour: Option<&ObjectTruth>,
    clusters: &[Cluster],
) -> Option<Cause> {
    if clusters.is_empty() {
        return None;
    }
    let distance = |cluster: &Cluster| cluster.position.distance(target.position);
    let nearest = clusters
        .iter()
        .filter(|cluster| covers(cluster.position, target))
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest.map(|cluster| cluster.label) {
        Some(Label::Star(_)) => Some(match neighbour {
            Some(other) if matches!(other.kind, ObjectKind::Star | ObjectKind::Planet | ObjectKind::Moon) => {
                Cause::from_brighter_object(other.kind)
            }
            _ => Cause::TakenForStar,
        }),
        Some(Label::Hotspot) => Some(Cause::TakenForHotspot),
        Some(Label::Candidate) => Some(Cause::LostMotionTest),
        Some(Label::Unlinked) => Some(Cause::NotLinked),
        // The pipeline states that it chose this cluster, but the verdict states otherwise: the cause is
        // determined from the truth.
        Some(Label::Target) => None,
        // A brighter neighbour shifts the centre of a common cluster out of the target's reach.
        None => Some(
            neighbour
                .filter(|other| clusters.iter().any(|cluster| holds(cluster.position, other)))
                .map_or(Cause::BelowThreshold, |other| Cause::from_brighter_object(other.kind)),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{
        CENTRE, COLUMNS, ROWS, cluster, cosmic_ray_at, detected_at, frame, hot_pixel_at, star_at, target_with,
    };
    use contract::PixelPoint;

    const DETECTOR: Detector = Detector { columns: COLUMNS, rows: ROWS };

    /// Returns the cause for a detectable target in sunlight, with no objects besides `others`.
    fn cause_with(outcome: &Outcome, others: &[ObjectTruth]) -> Cause {
        let objects: Vec<_> = [target_with(1000.0)].into_iter().chain(others.iter().cloned()).collect();
        cause(&frame(0), &objects, Some(outcome), DETECTOR)
    }

    fn labelled(label: Label) -> Outcome {
        Outcome { clusters: vec![cluster(CENTRE, label)], ..Outcome::without_solution(NoSolution::NoTarget) }
    }

    fn no_target() -> Outcome {
        Outcome::without_solution(NoSolution::NoTarget)
    }

    fn right_of_target(px: f64) -> PixelPoint {
        PixelPoint::new(CENTRE.x + px, CENTRE.y)
    }

    #[test]
    fn a_hot_pixel_beside_it_does_not_excuse_a_target_that_is_called_a_star() {
        let hot_pixel = hot_pixel_at(3, right_of_target(1.0), 5000.0);
        assert_eq!(cause_with(&labelled(Label::Star(7)), &[hot_pixel]), Cause::TakenForStar);
    }

    #[test]
    fn a_frame_without_a_row_is_not_reported() {
        assert_eq!(cause(&frame(0), &[target_with(1000.0)], None, DETECTOR), Cause::NotReported);
    }

    #[test]
    fn a_target_off_the_detector_or_behind_the_camera_is_outside_the_field() {
        for position in [None, Some(PixelPoint::new(-0.6, 10.0)), Some(PixelPoint::new(10.0, ROWS as f64))] {
            let truth = FrameTruth { target_position: position, ..frame(0) };
            assert_eq!(cause(&truth, &[], Some(&no_target()), DETECTOR), Cause::OutsideField);
        }
    }

    #[test]
    fn a_dark_target_is_in_eclipse_and_a_faint_one_in_sunlight_is_too_faint() {
        for (shadow, visibility, expected) in [
            (Shadow::Umbra, Visibility::Invisible, Cause::InEclipse),
            (Shadow::Penumbra, Visibility::Ambiguous, Cause::InEclipse),
            (Shadow::Penumbra, Visibility::Detectable, Cause::LostMotionTest),
            (Shadow::Sunlit, Visibility::Invisible, Cause::TooFaint),
            (Shadow::Sunlit, Visibility::Ambiguous, Cause::TooFaint),
        ] {
            let truth = FrameTruth { shadow, target_visibility: visibility, ..frame(0) };
            let got = cause(&truth, &[target_with(10.0)], Some(&labelled(Label::Candidate)), DETECTOR);
            assert_eq!(got, expected, "{shadow:?} {visibility:?}");
        }
    }

    #[test]
    fn a_target_mostly_outside_the_windows_is_cut() {
        for (cut, expected) in [(0.6, Cause::CutByRoi), (0.5, Cause::Unexplained), (0.4, Cause::Unexplained)]
        {
            let target = ObjectTruth { cut, ..target_with(1000.0) };
            assert_eq!(cause(&frame(0), &[target], Some(&no_target()), DETECTOR), expected);
        }
    }

    #[test]
    fn a_failure_of_the_pipeline_precedes_the_truth() {
        let crashed = Outcome::without_solution(NoSolution::Failed("exit status 1".into()));
        let invisible = FrameTruth { target_visibility: Visibility::Invisible, ..frame(0) };
        let cut = ObjectTruth { cut: 0.6, ..target_with(1000.0) };
        for (truth, target) in [(&frame(0), cut), (&invisible, target_with(1.0))] {
            assert_eq!(cause(truth, &[target], Some(&crashed), DETECTOR), Cause::PipelineFailed);
        }
    }

    #[test]
    fn the_pipelines_reason_counts() {
        for (reason, expected) in [
            (NoSolution::Failed("out of memory".into()), Cause::PipelineFailed),
            (NoSolution::SaturatedFrame, Cause::SaturatedFrame),
            (NoSolution::NoPreviousFrame, Cause::NoPreviousFrame),
            (NoSolution::EmptyFrame, Cause::BelowThreshold),
            (NoSolution::NoTarget, Cause::Unexplained),
        ] {
            assert_eq!(cause_with(&Outcome::without_solution(reason), &[]), expected);
        }
    }

    #[test]
    fn the_label_of_the_targets_cluster_decides() {
        for (label, expected) in [
            (Label::Star(5), Cause::TakenForStar),
            (Label::Hotspot, Cause::TakenForHotspot),
            (Label::Candidate, Cause::LostMotionTest),
            (Label::Unlinked, Cause::NotLinked),
            (Label::Target, Cause::Unexplained),
        ] {
            assert_eq!(cause_with(&labelled(label), &[]), expected, "{label:?}");
        }
    }

    #[test]
    fn a_star_label_is_a_merger_only_with_a_visible_star_that_touches() {
        let near = star_at(5, right_of_target(2.5), 800.0);
        let invisible = ObjectTruth { snr: 0.5, ..near.clone() };
        let apart = star_at(5, right_of_target(3.5), 800.0);
        assert_eq!(cause_with(&labelled(Label::Star(5)), &[near]), Cause::MergedWithStar);
        assert_eq!(cause_with(&labelled(Label::Star(5)), &[invisible]), Cause::TakenForStar);
        assert_eq!(cause_with(&labelled(Label::Star(5)), &[apart]), Cause::TakenForStar);
    }

    #[test]
    fn a_common_cluster_drawn_to_a_brighter_star_is_still_a_merger() {
        let star = star_at(5, right_of_target(2.5), 50_000.0);
        let clusters = vec![cluster(right_of_target(2.4), Label::Star(5))];
        assert_eq!(cause_with(&Outcome { clusters, ..no_target() }, &[star]), Cause::MergedWithStar);
    }

    #[test]
    fn no_cluster_at_a_detectable_target_is_the_pipelines_threshold() {
        let clusters = vec![cluster(right_of_target(40.0), Label::Candidate)];
        assert_eq!(cause_with(&Outcome { clusters, ..no_target() }, &[]), Cause::BelowThreshold);
    }

    #[test]
    fn without_clusters_the_truth_decides() {
        let star = star_at(5, right_of_target(2.0), 5000.0);
        let hot = hot_pixel_at(9, right_of_target(1.0), 400.0);
        assert_eq!(cause_with(&no_target(), std::slice::from_ref(&star)), Cause::MergedWithStar);
        assert_eq!(cause_with(&no_target(), std::slice::from_ref(&hot)), Cause::TakenForHotspot);
        assert_eq!(cause_with(&no_target(), &[hot, star]), Cause::MergedWithStar);
        let track = cosmic_ray_at(0, right_of_target(1.0), 900.0);
        assert_eq!(cause_with(&no_target(), &[track]), Cause::MergedWithCosmicRay);
    }

    #[test]
    fn a_planet_or_the_moon_at_the_target_is_a_merger_of_its_own() {
        for (kind, cause) in
            [(ObjectKind::Planet, Cause::MergedWithPlanet), (ObjectKind::Moon, Cause::MergedWithMoon)]
        {
            let other = ObjectTruth { kind, ..star_at(5, right_of_target(2.0), 5000.0) };
            assert_eq!(cause_with(&no_target(), std::slice::from_ref(&other)), cause);
            assert_eq!(cause_with(&labelled(Label::Star(5)), &[other]), cause);
        }
    }

    #[test]
    fn a_wrong_answer_has_the_cause_of_the_targets_own_cluster() {
        let elsewhere = right_of_target(40.0);
        let clusters = vec![cluster(elsewhere, Label::Target), cluster(CENTRE, Label::Candidate)];
        let outcome = Outcome { clusters, ..detected_at(elsewhere) };
        assert_eq!(cause_with(&outcome, &[]), Cause::LostMotionTest);
        assert_eq!(cause_with(&detected_at(elsewhere), &[]), Cause::Unexplained);
    }

    #[test]
    fn causes_beyond_any_pipeline_precede_the_pipelines_reason() {
        let truth = FrameTruth { target_visibility: Visibility::Invisible, ..frame(0) };
        let saturated = Outcome::without_solution(NoSolution::SaturatedFrame);
        assert_eq!(cause(&truth, &[target_with(1.0)], Some(&saturated), DETECTOR), Cause::TooFaint);
    }

    #[test]
    fn codes_round_trip_and_the_list_is_complete_and_ordered() {
        for cause in Cause::ALL {
            assert_eq!(Cause::parse(cause.code()), Some(cause));
        }
        assert!(Cause::ALL.is_sorted_by(|a, b| a < b));
        assert_eq!(Cause::Unexplained as usize + 1, Cause::ALL.len());
    }
}
