//! Verdict on one far-range frame.

use std::sync::Arc;

use contract::{AttitudeSource, CameraFrame, Direction, NoSolution, Outcome, PixelPoint};
use score::NormalisedError;
use serde::Serialize;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth};

use super::angles::{AnswerError, GrantedAttitude, LineOfSightError};
use super::cause::{Cause, Detector, cause};
use super::cluster_members::{brightest, members, target, transmitted_electrons};
use crate::scoring::covariance::image_state::ImageState;

/// Inverse projection of the true camera: the direction whose image is at a given point, `None` if there is
/// none.
pub type Unproject<'a> = dyn Fn(PixelPoint) -> Option<Direction<CameraFrame>> + 'a;

/// Verdict of the oracle on one frame: exactly one of three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The pipeline reports no target. A measurement whose position is off the detector, or whose line of
    /// sight is not a direction, also counts as missed.
    Missed {
        /// Cause of the miss.
        cause: Cause,
    },
    /// The pipeline found the target.
    ///
    /// An object belongs to the chosen cluster when its true centre lies within max(`radius_px`/2, 1.5) px of
    /// the reported position, along the columns up to `bloom_px`/2 farther. The measurement is correct when
    /// the target belongs to the cluster and contributes more than half of the electrons of all objects that
    /// belong to it (including stars, hot pixels and cosmic-ray hits). Only transmitted electrons count:
    /// electrons × (1 − cut).
    Correct {
        /// Error of the measurement.
        error: AnswerError,
    },
    /// The pipeline reports a target that is another object, or none: detected in the sense of the paper, and
    /// wrong.
    Wrong {
        /// Error of the measurement, relative to the true target.
        error: AnswerError,
        /// Object chosen instead of the target.
        taken: MistakenObject,
        /// Cause why the target was not chosen.
        cause: Cause,
    },
}

/// Object chosen instead of the target: among the objects that belong to the chosen cluster, other than the
/// target, the one with the most transmitted electrons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MistakenObject {
    /// A star, by its number in the catalogue.
    Star(u32),
    /// A planet, by its number, 1 to 8.
    Planet(u32),
    /// The Moon.
    Moon,
    /// A hot pixel, by its number: row × columns + column.
    HotPixel(u32),
    /// A cosmic-ray hit, by its number in the frame.
    CosmicRay(u32),
    /// No object of the truth lies at the reported position: noise, or an invented position.
    Nothing,
}

impl MistakenObject {
    /// Returns the word used in files; the number has a separate column.
    pub fn code(self) -> &'static str {
        match self {
            Self::Star(_) => "star",
            Self::Planet(_) => "planet",
            Self::Moon => "moon",
            Self::HotPixel(_) => "hot_pixel",
            Self::CosmicRay(_) => "cosmic_ray",
            Self::Nothing => "nothing",
        }
    }

    /// Returns the number of the star, planet, hot pixel or cosmic-ray hit; 0 for the Moon, `None` for
    /// [`MistakenObject::Nothing`].
    pub fn id(self) -> Option<u32> {
        match self {
            Self::Star(id) | Self::Planet(id) | Self::HotPixel(id) | Self::CosmicRay(id) => Some(id),
            Self::Moon => Some(0),
            Self::Nothing => None,
        }
    }
}

impl Verdict {
    /// Returns the word used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Missed { .. } => "missed",
            Self::Correct { .. } => "correct",
            Self::Wrong { .. } => "wrong",
        }
    }

    /// Returns true if the pipeline reports a target, rightly or wrongly.
    pub fn is_detected(&self) -> bool {
        !matches!(self, Self::Missed { .. })
    }

    /// Returns the error of a detected target, correct or wrong.
    pub fn error(&self) -> Option<AnswerError> {
        match self {
            Self::Missed { .. } => None,
            Self::Correct { error } | Self::Wrong { error, .. } => Some(*error),
        }
    }

    /// Returns the error of the line of sight, if there is one.
    pub fn line_of_sight_error(&self) -> Option<LineOfSightError> {
        self.error()?.line_of_sight
    }
}

/// Verdict on one frame, with the further data that the figures need.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameVerdict {
    /// Number of the frame.
    pub frame: u64,
    /// Name of the frame's group.
    pub group: Arc<str>,
    /// True if the frame is among the first ones, during which the pipeline starts up; it counts only in the
    /// figures of its group.
    pub is_warm_up: bool,
    /// The verdict.
    pub verdict: Verdict,
    /// State of the target's image in the chosen cluster; `None` unless the measurement is correct.
    pub image: Option<ImageState>,
    /// Number of stars that the pipeline identified; `None` if there is no outcome for the frame.
    pub n_stars: Option<u32>,
    /// Source of the attitude, if the outcome states it.
    pub attitude_source: Option<AttitudeSource>,
    /// True if no target is visible: it is outside the field, or invisible by its signal-to-noise ratio.
    pub is_absent: bool,
    /// Natural logarithm of the odds that the measurement states, if it does.
    pub log_odds: Option<f64>,
}

impl FrameVerdict {
    /// Returns the verdict as a row of a table.
    pub fn row(&self) -> VerdictRow<'_> {
        let (taken, cause) = match self.verdict {
            Verdict::Missed { cause } => (None, Some(cause)),
            Verdict::Correct { .. } => (None, None),
            Verdict::Wrong { taken, cause, .. } => (Some(taken), Some(cause)),
        };
        let centroid_px = self.verdict.error().and_then(|error| error.centroid_px);
        let error = self.verdict.line_of_sight_error();
        let centroid = self.verdict.error().and_then(|error| error.centroid_normalised);
        let direction = self.verdict.error().and_then(|error| error.line_of_sight_normalised);
        let x = |error: NormalisedError| error.over_sigma[0];
        let y = |error: NormalisedError| error.over_sigma[1];
        VerdictRow {
            frame: self.frame,
            group: &self.group,
            verdict: self.verdict.code(),
            cause: cause.map(Cause::code),
            taken: taken.map(MistakenObject::code),
            taken_id: taken.and_then(MistakenObject::id),
            centroid_x_error_px: centroid_px.map(|[x, _]| x),
            centroid_y_error_px: centroid_px.map(|[_, y]| y),
            ra_error_deg: error.map(|error| error.ra.degrees()),
            dec_error_deg: error.map(|error| error.dec.degrees()),
            line_of_sight: error.map(|error| error.attitude.code()),
            n_stars: self.n_stars,
            attitude_source: self.attitude_source.map(AttitudeSource::code),
            image: self.image.map(ImageState::code),
            centroid_x_over_sigma: centroid.map(x),
            centroid_y_over_sigma: centroid.map(y),
            centroid_nees: centroid.map(|error| error.nees),
            ra_over_sigma: direction.map(x),
            dec_over_sigma: direction.map(y),
            line_of_sight_nees: direction.map(|error| error.nees),
            log_odds: self.log_odds,
        }
    }
}

/// A [`FrameVerdict`] in words and numbers, for CSV and JSON; the field names are the column names.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VerdictRow<'a> {
    /// Number of the frame.
    pub frame: u64,
    /// Name of the group.
    pub group: &'a str,
    /// `missed`, `correct` or `wrong`.
    pub verdict: &'static str,
    /// Code of the cause ([`Cause::code`]) if missed or wrong.
    pub cause: Option<&'static str>,
    /// Code of the object measured instead ([`MistakenObject::code`]) if wrong.
    pub taken: Option<&'static str>,
    /// Identifier of the object measured instead ([`MistakenObject::id`]) if wrong.
    pub taken_id: Option<u32>,
    /// Error of the centroid across columns, px, when detected.
    pub centroid_x_error_px: Option<f64>,
    /// Error of the centroid across rows, px, when detected.
    pub centroid_y_error_px: Option<f64>,
    /// Error of the line of sight across columns, degrees, if there is a line of sight.
    pub ra_error_deg: Option<f64>,
    /// Error of the line of sight across rows, degrees, if there is a line of sight.
    pub dec_error_deg: Option<f64>,
    /// `crate::AttitudeUsed::code` of the attitude that the line of sight depends on.
    pub line_of_sight: Option<&'static str>,
    /// Number of identified stars; empty if there is no outcome for the frame.
    pub n_stars: Option<u32>,
    /// Code of the source of the attitude ([`AttitudeSource::code`]).
    pub attitude_source: Option<&'static str>,
    /// Code of the state of the target's image ([`ImageState::code`]) if correct.
    pub image: Option<&'static str>,
    /// Error of the centroid across columns over its standard deviation, if the measurement states one.
    pub centroid_x_over_sigma: Option<f64>,
    /// Error of the centroid across rows over its standard deviation.
    pub centroid_y_over_sigma: Option<f64>,
    /// NEES of the centroid, eᵀ C⁻¹ e / 2.
    pub centroid_nees: Option<f64>,
    /// Error of the line of sight across columns over its standard deviation, if the measurement states one.
    pub ra_over_sigma: Option<f64>,
    /// Error of the line of sight across rows over its standard deviation.
    pub dec_over_sigma: Option<f64>,
    /// NEES of the line of sight, eᵀ C⁻¹ e / 2.
    pub line_of_sight_nees: Option<f64>,
    /// Natural logarithm of the odds that the measurement states, if it does.
    pub log_odds: Option<f64>,
}

/// Determines the verdict on one frame. `objects` are the objects of this frame; `outcome` is `None` when the
/// measurements have no row for the frame.
pub(super) fn judge(
    truth: &FrameTruth,
    objects: &[ObjectTruth],
    outcome: Option<&Outcome>,
    detector: Detector,
    unproject: &Unproject<'_>,
    granted: GrantedAttitude,
) -> Verdict {
    let missed = |outcome| Verdict::Missed { cause: cause(truth, objects, outcome, detector) };
    let Some(answer) = outcome else { return missed(None) };
    let Some(measurement) = answer.measurement() else { return missed(outcome) };
    let line_of_sight = LineOfSightError::from_measurement(measurement, truth, unproject, granted);
    let is_on_detector = measurement.position.is_on_detector(detector.columns, detector.rows);
    if !is_on_detector || (measurement.line_of_sight.is_some() && line_of_sight.is_none()) {
        let no_answer =
            Outcome::without_solution(NoSolution::Failed("the measurement is not a direction".to_owned()));
        return missed(Some(&no_answer));
    }
    let centre = target(objects).map(|target| target.position).or(truth.target_position);
    let centroid_px =
        centre.map(|centre| [measurement.position.x - centre.x, measurement.position.y - centre.y]);
    let error = AnswerError::from_measurement(measurement, centroid_px, line_of_sight);
    match cluster_content(measurement.position, objects) {
        ClusterContent::Target => Verdict::Correct { error },
        ClusterContent::TargetOutshone(by) => {
            Verdict::Wrong { error, taken: mistaken_object(by), cause: Cause::from_brighter_object(by.kind) }
        }
        ClusterContent::Other(other) => Verdict::Wrong {
            error,
            taken: other.map_or(MistakenObject::Nothing, mistaken_object),
            cause: cause(truth, objects, outcome, detector),
        },
    }
}

/// Content of the cluster at the reported position.
enum ClusterContent<'a> {
    /// The target, with more than half of the electrons.
    Target,
    /// The target, and at least as many electrons of other objects; the value is the brightest of these.
    TargetOutshone(&'a ObjectTruth),
    /// No target; the value is the brightest object of the cluster, if any.
    Other(Option<&'a ObjectTruth>),
}

fn cluster_content(position: PixelPoint, objects: &[ObjectTruth]) -> ClusterContent<'_> {
    let members = || members(position, objects);
    let (mut of_target, mut total) = (0.0, 0.0);
    for object in members() {
        let electrons = transmitted_electrons(object);
        total += electrons;
        if object.kind == ObjectKind::Target {
            of_target += electrons;
        }
    }
    if of_target > 0.5 * total {
        return ClusterContent::Target;
    }
    match brightest(members().filter(|object| object.kind != ObjectKind::Target)) {
        Some(other) if of_target > 0.0 => ClusterContent::TargetOutshone(other),
        other => ClusterContent::Other(other),
    }
}

fn mistaken_object(object: &ObjectTruth) -> MistakenObject {
    match object.kind {
        ObjectKind::Star => MistakenObject::Star(object.id),
        ObjectKind::Planet => MistakenObject::Planet(object.id),
        ObjectKind::Moon => MistakenObject::Moon,
        ObjectKind::HotPixel => MistakenObject::HotPixel(object.id),
        ObjectKind::CosmicRay => MistakenObject::CosmicRay(object.id),
        ObjectKind::Target => MistakenObject::Nothing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{
        CENTRE, COLUMNS, ROWS, cluster, cosmic_ray_at, detected_at, frame, hot_pixel_at, star_at,
        target_with, unproject,
    };
    use contract::Label;

    fn verdict(objects: &[ObjectTruth], outcome: &Outcome) -> Verdict {
        granted(objects, outcome, GrantedAttitude::None)
    }

    fn granted(objects: &[ObjectTruth], outcome: &Outcome, granted: GrantedAttitude) -> Verdict {
        let detector = Detector { columns: COLUMNS, rows: ROWS };
        judge(&frame(0), objects, Some(outcome), detector, &unproject, granted)
    }

    fn right_of_target(px: f64) -> PixelPoint {
        PixelPoint::new(CENTRE.x + px, CENTRE.y)
    }

    #[test]
    fn a_position_within_reach_of_the_target_is_correct_and_beyond_is_wrong() {
        let objects = [target_with(1000.0)];
        assert_eq!(verdict(&objects, &detected_at(right_of_target(1.49))).code(), "correct");
        let Verdict::Wrong { taken, .. } = verdict(&objects, &detected_at(right_of_target(1.51))) else {
            panic!("1.51 px off is another place");
        };
        assert_eq!(taken, MistakenObject::Nothing);
    }

    #[test]
    fn a_large_image_is_the_target_as_far_as_its_centre_can_be() {
        let mut target = target_with(1000.0);
        target.radius_px = 12.0;
        let code = |px| verdict(std::slice::from_ref(&target), &detected_at(right_of_target(px))).code();
        assert_eq!((code(5.9), code(6.1)), ("correct", "wrong"));
    }

    #[test]
    fn the_majority_of_the_electrons_decides() {
        for (star, expected) in [(999.0, "correct"), (1000.0, "wrong"), (1001.0, "wrong")] {
            let objects = [target_with(1000.0), star_at(7, right_of_target(1.0), star)];
            assert_eq!(verdict(&objects, &detected_at(right_of_target(0.5))).code(), expected, "{star}");
        }
    }

    #[test]
    fn the_order_of_the_objects_does_not_matter() {
        let objects = [star_at(7, right_of_target(1.0), 3000.0), target_with(1000.0)];
        let reversed = [objects[1].clone(), objects[0].clone()];
        let outcome = detected_at(right_of_target(0.8));
        assert_eq!(verdict(&objects, &outcome), verdict(&reversed, &outcome));
    }

    #[test]
    fn the_object_measured_instead_is_named() {
        let far = right_of_target(50.0);
        for (object, expected, merged) in [
            (star_at(7, far, 500.0), MistakenObject::Star(7), false),
            (hot_pixel_at(99, far, 500.0), MistakenObject::HotPixel(99), false),
            (cosmic_ray_at(2, far, 500.0), MistakenObject::CosmicRay(2), false),
            (star_at(8, right_of_target(1.0), 5000.0), MistakenObject::Star(8), true),
        ] {
            let place = object.position;
            let Verdict::Wrong { taken, cause, .. } =
                verdict(&[target_with(1000.0), object], &detected_at(place))
            else {
                panic!("wrong");
            };
            assert_eq!(taken, expected);
            assert_eq!(cause == Cause::MergedWithStar, merged);
        }
    }

    #[test]
    fn a_hot_pixel_in_the_targets_image_counts_with_its_electrons() {
        let objects = [target_with(1000.0), hot_pixel_at(3, CENTRE, 1500.0)];
        let Verdict::Wrong { taken, cause, .. } = verdict(&objects, &detected_at(CENTRE)) else {
            panic!("most of it is the hot pixel's");
        };
        assert_eq!((taken, cause), (MistakenObject::HotPixel(3), Cause::TakenForHotspot));
    }

    #[test]
    fn electrons_that_were_not_transmitted_do_not_count() {
        let mut star = star_at(7, right_of_target(1.0), 5000.0);
        star.cut = 0.9;
        assert_eq!(verdict(&[target_with(1000.0), star], &detected_at(CENTRE)).code(), "correct");
    }

    #[test]
    fn an_answer_that_is_not_a_number_is_missed_and_has_a_cause() {
        let objects = [target_with(1000.0)];
        let missed = Verdict::Missed { cause: Cause::PipelineFailed };
        assert_eq!(verdict(&objects, &detected_at(PixelPoint::new(f64::NAN, 1.0))), missed);
        assert_eq!(verdict(&objects, &detected_at(PixelPoint::new(1.0, f64::INFINITY))), missed);
    }

    /// The measurement has a centroid, whether or not the camera images a direction there.
    #[test]
    fn an_answer_without_a_direction_is_judged_by_its_centroid() {
        let nowhere = judge(
            &frame(0),
            &[target_with(1000.0)],
            Some(&detected_at(right_of_target(0.5))),
            Detector { columns: COLUMNS, rows: ROWS },
            &|_| None,
            GrantedAttitude::True,
        );
        let measurement = contract::Measurement::new(right_of_target(0.5), None);
        let error = AnswerError::from_measurement(&measurement, Some([0.5, 0.0]), None);
        assert_eq!(nowhere, Verdict::Correct { error });
    }

    #[test]
    fn the_centroid_is_held_against_the_centre_of_the_targets_flux() {
        let mut target = target_with(1000.0);
        target.position = PixelPoint::new(CENTRE.x + 0.75, CENTRE.y - 0.25);
        let error = |objects: &[ObjectTruth]| verdict(objects, &detected_at(right_of_target(1.0))).error();
        assert_eq!(error(&[target]).unwrap().centroid_px, Some([0.25, 0.25]));
        // Without target electrons in the image, the reference is the image point of the true line of sight.
        assert_eq!(error(&[]).unwrap().centroid_px, Some([1.0, 0.0]));
    }

    #[test]
    fn injected_knowledge_changes_no_verdict() {
        let objects = [target_with(1000.0)];
        for (px, code) in [(1.0, "correct"), (30.0, "wrong")] {
            let answer = detected_at(right_of_target(px));
            let [none, with] =
                [GrantedAttitude::None, GrantedAttitude::True].map(|given| granted(&objects, &answer, given));
            assert_eq!((none.code(), with.code()), (code, code));
            assert!(none.line_of_sight_error().is_none() && with.line_of_sight_error().is_some());
        }
    }

    #[test]
    fn an_object_outside_all_regions_was_not_measured() {
        let far = right_of_target(50.0);
        let cut = ObjectTruth { cut: 1.0, ..star_at(7, far, 500.0) };
        let taken = |objects: &[ObjectTruth]| match verdict(objects, &detected_at(far)) {
            Verdict::Wrong { taken, .. } => taken,
            other => panic!("{other:?}"),
        };
        assert_eq!(taken(&[target_with(1000.0), cut.clone()]), MistakenObject::Nothing);
        // Nor does an object that is cut away entirely outshine a target that is cut away entirely.
        let gone = ObjectTruth { position: far, cut: 1.0, ..target_with(1000.0) };
        assert_eq!(taken(&[gone, cut]), MistakenObject::Nothing);
    }

    #[test]
    fn the_object_measured_instead_has_a_name_and_a_number_in_files() {
        let taken = [
            MistakenObject::Star(7),
            MistakenObject::Planet(5),
            MistakenObject::Moon,
            MistakenObject::HotPixel(99),
            MistakenObject::CosmicRay(2),
            MistakenObject::Nothing,
        ];
        let words = ["star", "planet", "moon", "hot_pixel", "cosmic_ray", "nothing"];
        assert_eq!(taken.map(MistakenObject::code), words);
        assert_eq!(taken.map(MistakenObject::id), [Some(7), Some(5), Some(0), Some(99), Some(2), None]);
    }

    /// A target in the cluster with fewer electrons than another object is outshone, regardless of the
    /// pipeline's label of the cluster.
    #[test]
    fn a_target_outshone_by_a_star_is_merged_with_any_label_of_its_cluster() {
        let place = right_of_target(0.5);
        let answer = Outcome { clusters: vec![cluster(place, Label::Candidate)], ..detected_at(place) };
        let cause = |target| match verdict(&[target, star_at(7, right_of_target(1.0), 3000.0)], &answer) {
            Verdict::Wrong { cause, .. } => cause,
            other => panic!("{other:?}"),
        };
        assert_eq!(cause(target_with(1000.0)), Cause::MergedWithStar);
        // A target without electrons is not in the cluster; the cause then follows from the label.
        assert_eq!(cause(target_with(0.0)), Cause::LostMotionTest);
    }

    #[test]
    fn a_target_without_flux_cannot_be_found() {
        let verdict = verdict(&[target_with(0.0)], &detected_at(CENTRE));
        assert!(matches!(verdict, Verdict::Wrong { taken: MistakenObject::Nothing, .. }), "{verdict:?}");
    }

    #[test]
    fn a_row_has_every_column_and_leaves_absent_values_empty() {
        let frame_verdict = |verdict| FrameVerdict {
            frame: 3,
            group: "day 1".into(),
            is_warm_up: false,
            verdict,
            image: None,
            n_stars: Some(12),
            attitude_source: Some(AttitudeSource::Stars),
            is_absent: true,
            log_odds: None,
        };
        let missed = frame_verdict(Verdict::Missed { cause: Cause::TooFaint });
        assert_eq!(
            serde_json::to_string(&missed.row()).unwrap(),
            r#"{"frame":3,"group":"day 1","verdict":"missed","cause":"too_faint","taken":null,"taken_id":null,"centroid_x_error_px":null,"centroid_y_error_px":null,"ra_error_deg":null,"dec_error_deg":null,"line_of_sight":null,"n_stars":12,"attitude_source":"stars","image":null,"centroid_x_over_sigma":null,"centroid_y_over_sigma":null,"centroid_nees":null,"ra_over_sigma":null,"dec_over_sigma":null,"line_of_sight_nees":null,"log_odds":null}"#
        );
    }
}
