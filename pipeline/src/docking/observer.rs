//! Processing of one field: recognition, measurement, checks.

use contract::bounds::require;
use contract::docking::{
    DockingSetup, DockingSolution, FailedCheck, Features, Field, FieldMeasurement, FieldTelemetry, NoPose,
    Pose, TargetModel,
};
use contract::{Camera, ContractError};
use nalgebra::Matrix6;

use super::config::DockingConfig;
use super::cross_and_circle::marks::{self, MarkShape};
use super::extraction::contour::{self, StationOutline};
use super::extraction::docking_unit::Side;
use super::extraction::evidence;
use super::extraction::orientation::{self, Orientation, Uprightness};
use super::extraction::outline::{self, MIN_CIRCLE_PX, OutlineTrack, RESOLVED_CIRCLE_PX};
use super::extraction::range_memory::RangeMemory;
use super::extraction::recognise::{Recognition, TargetFeatures};
use super::extraction::self_check;
use super::portions::OutlineRange;
use super::pose::model_fit::{FitResult, ModelFit};
use super::pose::paper_pose::{PaperMeasurement, PaperTarget};
use super::pose::paper_sigma;
use super::preprocessing::histogram::Histogram;
use super::preprocessing::region::{FeaturePositions, Prediction, Rectangle, Track};
use super::preprocessing::view::{Lens, View};
use crate::PipelineError;

/// Recognition and measurement of successive fields, with memory of the target's position.
#[derive(Debug)]
pub(crate) struct Observer {
    config: DockingConfig,
    cameras: Vec<(Camera, Lens)>,
    target: TargetModel,
    shapes: Vec<MarkShape>,
    track: Track,
    fit: ModelFit,
    outlines: OutlineTrack,
    orientation: Orientation,
    /// Ranges reported so far. Kept when the target is lost.
    ranges: RangeMemory,
}

/// Result of one field.
pub(crate) struct FieldObservation {
    pub(crate) solution: DockingSolution,
    /// Inputs to the paper's formulas, where cross and circle were measured.
    pub(crate) paper: Option<PaperMeasurement>,
    pub(crate) features: Features,
    /// Part of the pose's covariance due to errors that are common to the fields of several seconds.
    pub(crate) common: Matrix6<f64>,
    /// True if only one of the two methods (cross and circle, best estimator) gave a pose. Such a pose must
    /// be confirmed by the motion.
    pub(crate) is_backup: bool,
    /// True if the cross is a few pixels: another field must confirm such a pose.
    pub(crate) is_small: bool,
    /// Blur across the lines by the best estimator, px.
    pub(crate) blur_px: f64,
    /// Range by the station's outline, which is also an input to the motion.
    pub(crate) outline: Option<OutlineRange>,
    /// Region in which brightness and contrast are measured.
    pub(crate) region: Rectangle,
}

impl FieldObservation {
    fn without_solution(reason: NoPose) -> Self {
        Self {
            solution: DockingSolution::NoSolution(reason),
            paper: None,
            features: Features::default(),
            common: Matrix6::zeros(),
            is_backup: false,
            is_small: false,
            blur_px: 0.0,
            outline: None,
            region: Rectangle::ALL,
        }
    }
}

/// Field with its time and camera.
struct FieldInput<'a> {
    field: &'a Field,
    view: &'a View<'a>,
    time_s: f64,
    camera: usize,
}

impl Observer {
    /// Creates an observer without any field.
    ///
    /// # Errors
    /// [`PipelineError`] when a camera or the target's dimensions are not allowed.
    pub(crate) fn new(config: &DockingConfig, setup: &DockingSetup) -> Result<Self, PipelineError> {
        let cameras = setup
            .cameras
            .iter()
            .map(|camera| Ok((camera.clone(), Lens::new(camera)?)))
            .collect::<Result<Vec<_>, ContractError>>()?;
        setup.target.check()?;
        let marks = setup.target.marks.len() as f64;
        require("target.marks (number)", marks, "5 to 1000", |n| (5.0..=1000.0).contains(&n))?;
        Ok(Self {
            shapes: marks::shapes(&setup.target),
            target: setup.target.clone(),
            cameras,
            config: config.clone(),
            track: Track::default(),
            fit: ModelFit::new(),
            outlines: OutlineTrack::default(),
            orientation: Orientation::default(),
            ranges: RangeMemory::default(),
        })
    }

    /// Measures a field, or returns the reason why it has no pose.
    pub(crate) fn observe(
        &mut self,
        field: &Field,
        view: &View<'_>,
        telemetry: &FieldTelemetry,
    ) -> FieldObservation {
        let Some((camera, lens)) = self.cameras.get(telemetry.camera).cloned() else {
            let text =
                format!("the field names camera {}, which the setup does not contain", telemetry.camera);
            return FieldObservation::without_solution(NoPose::Failed(text));
        };
        if view.columns() != camera.columns {
            let text = format!("the field has {} columns, expected {}", view.columns(), camera.columns);
            return FieldObservation::without_solution(NoPose::Failed(text));
        }
        let whole = Histogram::from_region(view, &Rectangle::ALL);
        if whole.saturated_share() > MAX_SATURATED_SHARE {
            self.track.reset();
            return FieldObservation::without_solution(NoPose::SaturatedField);
        }
        let input = FieldInput { field, view, time_s: telemetry.time_s, camera: telemetry.camera };
        let mut observed = self.acquire(&input, &lens);
        let measured_m = match &observed.solution {
            DockingSolution::Measured(measurement) => Some(measurement.best.pose.position_m.z),
            DockingSolution::RangeOnly { range_m, .. } => Some(*range_m),
            DockingSolution::Doubtful { .. } | DockingSolution::NoSolution(_) => None,
        };
        if measured_m.is_some_and(|range_m| !self.ranges.admit(input.time_s, range_m)) {
            self.track.reset();
            observed.solution = DockingSolution::NoSolution(NoPose::Inconsistent);
            observed.paper = None;
            observed.outline = None;
        }
        observed
    }

    /// Searches for the target near its predicted position, else within the outline of a tracked station,
    /// else in the whole field.
    fn acquire(&mut self, input: &FieldInput, lens: &Lens) -> FieldObservation {
        let max_gap_s = self.config.region.max_gap_s;
        let predicted = self.track.predict(input.time_s, input.camera, lens.focal_px(), max_gap_s);
        let mut lost = None;
        if let Some(prediction) = &predicted {
            match self.track_target(input, lens, prediction) {
                Ok(observed) => return observed,
                Err(reason) => lost = Some(reason),
            }
        }
        if let Some(observed) = self.within_outline(input, lens, max_gap_s) {
            return observed;
        }
        let overview = input.view.overview();
        let found = self.recognition(input.view, lens).search(&overview, predicted.as_ref());
        let reason = match found.and_then(|target_features| self.measure(input, lens, &target_features)) {
            Ok(observed) => return observed,
            Err(NoPose::NoTarget) => lost.unwrap_or(NoPose::NoTarget),
            Err(reason) => reason,
        };
        self.track.reset();
        match contour::find(input.view, &overview, lens) {
            Some(outline) => {
                self.outlines.restart((input.time_s, input.camera), &outline);
                self.range_alone(input.view, lens, &outline, reason)
            }
            None => FieldObservation::without_solution(outline::no_outline_reason(input.view, reason)),
        }
    }

    /// Returns the result while the station's outline is tracked and its target is not yet resolved.
    fn within_outline(
        &mut self,
        input: &FieldInput,
        lens: &Lens,
        max_gap_s: f64,
    ) -> Option<FieldObservation> {
        let outline = self.outlines.follow(input.view, lens, (input.time_s, input.camera), max_gap_s)?;
        let mark_circle_px = outline::mark_circle_px(&self.target, lens, &outline.circle)?;
        if mark_circle_px >= RESOLVED_CIRCLE_PX {
            return None;
        }
        let mut reason = NoPose::NoTarget;
        if mark_circle_px >= MIN_CIRCLE_PX {
            let overview = input.view.overview();
            let recognition = self.recognition(input.view, lens);
            let found = recognition.search_within(&overview, &outline.circle, mark_circle_px);
            match found.and_then(|target_features| self.measure(input, lens, &target_features)) {
                Ok(observed) => return Some(observed),
                Err(why) => reason = why,
            }
        }
        self.track.reset();
        Some(self.range_alone(input.view, lens, &outline, reason))
    }

    fn range_alone(
        &mut self,
        view: &View<'_>,
        lens: &Lens,
        outline: &StationOutline,
        reason: NoPose,
    ) -> FieldObservation {
        if !contour::stands_before_sky(view, lens, &outline.circle) {
            self.outlines = OutlineTrack::default();
            let reason = if reason == NoPose::NoTarget { NoPose::Inconsistent } else { reason };
            return FieldObservation::without_solution(reason);
        }
        let mut observed = FieldObservation::without_solution(reason.clone());
        let FieldObservation { features, region, .. } = &mut observed;
        observed.solution = outline::range(lens, &self.target, outline, features, region, reason)
            .unwrap_or_else(DockingSolution::NoSolution);
        if let DockingSolution::RangeOnly { .. } = observed.solution {
            observed.outline = outline.range(&self.target.station, lens.focal_px());
        }
        observed
    }

    fn recognition<'a>(&'a self, view: &'a View<'a>, lens: &'a Lens) -> Recognition<'a> {
        Recognition { view, lens, model: &self.target, shapes: &self.shapes, config: &self.config }
    }

    /// Finds the target near its position by previous fields: cross and marks, or their visible remainder
    /// near the predicted pose.
    fn track_target(
        &mut self,
        input: &FieldInput,
        lens: &Lens,
        prediction: &Prediction,
    ) -> Result<FieldObservation, NoPose> {
        let tracked = self.recognition(input.view, lens).track(&prediction.cross, &prediction.plane);
        let lost = match tracked.and_then(|target_features| self.measure(input, lens, &target_features)) {
            Ok(observed) => return Ok(observed),
            Err(reason) => reason,
        };
        let near_edge = self_check::leaves_field(input.view, lens, &self.target, prediction);
        let fitted = self.fit.fit(input.field, lens.model(), &self.target, &prediction.pose);
        match fitted {
            Ok(fitted) => Ok(self.observation_from_fit(input, lens, &fitted, near_edge)),
            Err(_) if near_edge => Err(NoPose::OutOfField),
            Err(_) => Err(lost),
        }
    }

    /// Returns the result from cross and marks.
    fn measure(
        &mut self,
        input: &FieldInput,
        lens: &Lens,
        target_features: &TargetFeatures,
    ) -> Result<FieldObservation, NoPose> {
        let (cross, plane) = (&target_features.cross, &target_features.marks.plane);
        let unit = self_check::docking_unit(input.view, lens, &self.target, cross, plane, Side::Nominal);
        let measurement = PaperMeasurement {
            focal_px: lens.focal_px(),
            cross: cross.seed.centre.into(),
            slope: cross.seed.slope,
            circle: target_features.circle.centre.into(),
            radius_px: target_features.circle.radius_px,
        };
        let target = PaperTarget::from_model(&self.target);
        let paper = measurement.pose(&target)?;
        let seen = orientation::assess(input.view, lens, &self.target, cross, plane, &unit);
        if self.orientation.is_turned(input.time_s, seen) {
            // A turned target is tracked too, so its state is still available at short range, where the field
            // does not show it.
            self.remember(input, lens, paper);
            return Ok(FieldObservation::without_solution(NoPose::Inconsistent));
        }
        let mut features = evidence::evidence(lens, target_features, &unit);
        features.station = evidence::station(input.view, lens, &self.target, target_features);
        let mut fitted = self.fit.fit(input.field, lens.model(), &self.target, &paper);
        if fitted.is_err() {
            // At large angles the paper's pose is too far off for the fit to converge.
            fitted = self.fit.fit(input.field, lens.model(), &self.target, &measurement.aimed_pose(&target)?);
        }
        let outline = self_check::outline(input.view, lens, &self.target, cross, plane);
        let outline_range = outline.and_then(|outline| outline.range(&self.target.station, lens.focal_px()));
        if let Some(OutlineRange { range_m, .. }) = outline_range
            && fitted.as_ref().map_or(true, |fitted| fitted.is_poor)
        {
            let start = measurement.facing_at(&target, range_m).aimed_pose(&target)?;
            let again = self.fit.fit(input.field, lens.model(), &self.target, &start);
            fitted = better(fitted, again);
        }
        let by_features = paper_sigma::estimate(&measurement, &target, cross.seed.half_length_px)?;
        let (best, common, mut doubt, is_backup, is_small, blur_px) = match fitted {
            Ok(fitted) => {
                evidence::refine(&mut features, &fitted);
                let doubt = self_check::fit(&self.target, lens.focal_px(), &fitted, &by_features);
                (fitted.estimate, fitted.common, doubt, false, fitted.is_small_cross, fitted.blur_px[1])
            }
            // Cross and marks are present and consistent: the paper's pose is worse than the best one, but
            // better than none.
            Err(_) => (by_features, Matrix6::zeros(), None, true, false, 0.0),
        };
        match self_check::range(lens, &self.target, plane, outline.as_ref(), &best) {
            Ok(()) => {}
            Err(NoPose::Inconsistent) => doubt = doubt.or(Some(FailedCheck::Features)),
            Err(reason) => return Err(reason),
        }
        doubt = doubt.or_else(|| self_check::tilt(&best)).or_else(|| self.doubt_of_roll(&best.pose));
        if doubt.is_none() {
            self.remember(input, lens, best.pose);
        }
        let field = Box::new(FieldMeasurement { best, paper: Some(paper) });
        Ok(FieldObservation {
            solution: match doubt {
                Some(doubt) => DockingSolution::Doubtful { measurement: field, doubt },
                None => DockingSolution::Measured(field),
            },
            paper: Some(measurement),
            features,
            common,
            is_backup,
            is_small,
            blur_px,
            outline: outline_range,
            region: evidence::plate(lens, plane, &self.target),
        })
    }

    /// Returns the result of the best estimator near the predicted pose.
    fn observation_from_fit(
        &mut self,
        input: &FieldInput,
        lens: &Lens,
        fitted: &FitResult,
        near_edge: bool,
    ) -> FieldObservation {
        let best = fitted.estimate;
        self.remember(input, lens, best.pose);
        if self.orientation.is_turned(input.time_s, Uprightness::Unknown) {
            return FieldObservation::without_solution(NoPose::Inconsistent);
        }
        let plane = self.track.last().map(|sighting| sighting.plane);
        let measurement = Box::new(FieldMeasurement { best, paper: None });
        FieldObservation {
            solution: match self.doubt_of_roll(&best.pose) {
                Some(doubt) => DockingSolution::Doubtful { measurement, doubt },
                None => DockingSolution::Measured(measurement),
            },
            paper: None,
            features: Features { marks: fitted.marks.clone(), warp: fitted.warp, ..Features::default() },
            common: fitted.common,
            // If cross and marks should be visible but are not, the prediction may have led the fit to
            // another object.
            is_backup: !near_edge,
            is_small: fitted.is_small_cross,
            blur_px: fitted.blur_px[1],
            outline: None,
            region: plane.map_or(Rectangle::ALL, |plane| evidence::plate(lens, &plane, &self.target)),
        }
    }

    /// Returns a doubt if the target may be turned by a quarter.
    fn doubt_of_roll(&self, pose: &Pose) -> Option<FailedCheck> {
        self.orientation.is_ambiguous(pose.phi_rad.z).then_some(FailedCheck::Unconfirmed)
    }

    fn remember(&mut self, input: &FieldInput, lens: &Lens, pose: Pose) {
        if let Some(sighting) =
            FeaturePositions::from_pose(input.time_s, input.camera, lens, &self.target, pose)
        {
            self.track.push(sighting);
        }
    }
}

/// Returns the fit with the smaller residuals.
fn better(one: Result<FitResult, NoPose>, other: Result<FitResult, NoPose>) -> Result<FitResult, NoPose> {
    match (one, other) {
        (Ok(one), Ok(other)) => Ok(if other.noise_dn < one.noise_dn { other } else { one }),
        (one, other) => one.or(other),
    }
}

/// Share of full-scale pixels above which a field is considered saturated.
const MAX_SATURATED_SHARE: f64 = 0.6;
