//! One field: recognised, measured, checked.

use contract::bounds::require;
use contract::docking::{
    DockingSetup, DockingSolution, Doubt, Features, Field, FieldMeasurement, FieldTelemetry, NoPose, Pose,
    TargetModel,
};
use contract::{Camera, ContractError};
use nalgebra::Matrix6;

use super::config::DockingConfig;
use super::cross_and_circle::marks::{self, MarkShape};
use super::extraction::contour::{self, StationOutline};
use super::extraction::docking_unit::Side;
use super::extraction::evidence;
use super::extraction::orientation::{self, Orientation, Uprightness};
use super::extraction::outline::{self, OutlineTrack, RESOLVED_CIRCLE_PX, SMALLEST_CIRCLE_PX};
use super::extraction::range_memory::RangeMemory;
use super::extraction::recognise::{Recognition, Sight};
use super::extraction::self_check;
use super::portions::OutlineRange;
use super::pose::model_fit::{Fitted, ModelFit};
use super::pose::paper_pose::{PaperMeasurement, PaperTarget};
use super::pose::paper_sigma;
use super::preprocessing::histogram::Histogram;
use super::preprocessing::region::{Prediction, Rectangle, Sighting, Track};
use super::preprocessing::view::{Lens, View};
use crate::PipelineError;

/// Recognises and measures field after field; remembers where the target was.
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
    /// What was told of the range, which a loss of the target does not erase.
    ranges: RangeMemory,
}

/// What a field gave.
pub(crate) struct Observed {
    pub(crate) solution: DockingSolution,
    /// What the paper's formulas are made of, where cross and circle were measured.
    pub(crate) paper: Option<PaperMeasurement>,
    pub(crate) features: Features,
    /// The part of the pose's covariance that is the same error in the fields of seconds.
    pub(crate) common: Matrix6<f64>,
    /// Whether only one of the two ways to a pose has one, cross and circle or the best estimator: it needs the motion's confirmation.
    pub(crate) is_backup: bool,
    /// Blur across the lines that the best estimator found, px.
    pub(crate) blur_px: f64,
    /// The range by the station's outline, which the motion takes too.
    pub(crate) outline: Option<OutlineRange>,
    /// Where brightness and contrast are to be judged.
    pub(crate) region: Rectangle,
}

impl Observed {
    fn nothing(reason: NoPose) -> Self {
        Self {
            solution: DockingSolution::NoSolution(reason),
            paper: None,
            features: Features::default(),
            common: Matrix6::zeros(),
            is_backup: false,
            blur_px: 0.0,
            outline: None,
            region: Rectangle::ALL,
        }
    }
}

/// A field and what it was taken with.
struct Sheet<'a> {
    field: &'a Field,
    view: &'a View<'a>,
    time_s: f64,
    camera: usize,
}

impl Observer {
    /// Nothing seen yet.
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
        require("target.marks (their number)", marks, "5 to 1000", |n| (5.0..=1000.0).contains(&n))?;
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

    /// Measures a field, or says why not.
    pub(crate) fn observe(&mut self, field: &Field, view: &View<'_>, telemetry: &FieldTelemetry) -> Observed {
        let Some((camera, lens)) = self.cameras.get(telemetry.camera).cloned() else {
            let text = format!("the field is of camera {}, which is not known", telemetry.camera);
            return Observed::nothing(NoPose::Failed(text));
        };
        if view.columns() != camera.columns {
            let text = format!("the field has {} columns, expected {}", view.columns(), camera.columns);
            return Observed::nothing(NoPose::Failed(text));
        }
        let whole = Histogram::of(view, &Rectangle::ALL);
        if whole.saturated_share() > MAX_SATURATED_SHARE {
            self.track.reset();
            return Observed::nothing(NoPose::SaturatedField);
        }
        let sheet = Sheet { field, view, time_s: telemetry.time_s, camera: telemetry.camera };
        let mut observed = self.look(&sheet, &lens);
        let told_m = match &observed.solution {
            DockingSolution::Measured(measurement) => Some(measurement.best.pose.position_m.z),
            DockingSolution::RangeOnly { range_m, .. } => Some(*range_m),
            DockingSolution::Doubtful { .. } | DockingSolution::NoSolution(_) => None,
        };
        if told_m.is_some_and(|range_m| !self.ranges.admit(sheet.time_s, range_m)) {
            self.track.reset();
            observed.solution = DockingSolution::NoSolution(NoPose::Inconsistent);
            observed.paper = None;
            observed.outline = None;
        }
        observed
    }

    /// About where the target is predicted; else within the outline of a station that is followed; else in the whole field.
    fn look(&mut self, sheet: &Sheet, lens: &Lens) -> Observed {
        let max_gap_s = self.config.region.max_gap_s;
        let predicted = self.track.predict(sheet.time_s, sheet.camera, lens.focal_px(), max_gap_s);
        let mut lost = None;
        if let Some(prediction) = &predicted {
            match self.follow(sheet, lens, prediction) {
                Ok(observed) => return observed,
                Err(reason) => lost = Some(reason),
            }
        }
        if let Some(observed) = self.within_outline(sheet, lens, max_gap_s) {
            return observed;
        }
        let overview = sheet.view.overview();
        let found = self.recognition(sheet.view, lens).search(&overview, predicted.as_ref());
        let reason = match found.and_then(|sight| self.measure(sheet, lens, &sight)) {
            Ok(observed) => return observed,
            Err(NoPose::NoTarget) => lost.unwrap_or(NoPose::NoTarget),
            Err(reason) => reason,
        };
        self.track.reset();
        match contour::find(sheet.view, &overview, lens) {
            Some(outline) => {
                self.outlines.found((sheet.time_s, sheet.camera), &outline);
                self.range_alone(sheet.view, lens, &outline, reason)
            }
            None => Observed::nothing(outline::nothing(sheet.view, reason)),
        }
    }

    /// The answer while the station's outline is followed and its target not yet resolved.
    fn within_outline(&mut self, sheet: &Sheet, lens: &Lens, max_gap_s: f64) -> Option<Observed> {
        let outline = self.outlines.follow(sheet.view, lens, (sheet.time_s, sheet.camera), max_gap_s)?;
        let mark_circle_px = outline::mark_circle_px(&self.target, lens, &outline.circle)?;
        if mark_circle_px >= RESOLVED_CIRCLE_PX {
            return None;
        }
        let mut reason = NoPose::NoTarget;
        if mark_circle_px >= SMALLEST_CIRCLE_PX {
            let overview = sheet.view.overview();
            let recognition = self.recognition(sheet.view, lens);
            let found = recognition.search_within(&overview, &outline.circle, mark_circle_px);
            match found.and_then(|sight| self.measure(sheet, lens, &sight)) {
                Ok(observed) => return Some(observed),
                Err(why) => reason = why,
            }
        }
        self.track.reset();
        Some(self.range_alone(sheet.view, lens, &outline, reason))
    }

    fn range_alone(
        &mut self,
        view: &View<'_>,
        lens: &Lens,
        outline: &StationOutline,
        reason: NoPose,
    ) -> Observed {
        if !contour::stands_before_sky(view, lens, &outline.circle) {
            self.outlines = OutlineTrack::default();
            let reason = if reason == NoPose::NoTarget { NoPose::Inconsistent } else { reason };
            return Observed::nothing(reason);
        }
        let mut observed = Observed::nothing(reason.clone());
        let Observed { features, region, .. } = &mut observed;
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

    /// The target about where the fields before have it: cross and marks, or what is left of them about the predicted pose.
    fn follow(&mut self, sheet: &Sheet, lens: &Lens, prediction: &Prediction) -> Result<Observed, NoPose> {
        let tracked = self.recognition(sheet.view, lens).track(&prediction.cross, &prediction.plane);
        let lost = match tracked.and_then(|sight| self.measure(sheet, lens, &sight)) {
            Ok(observed) => return Ok(observed),
            Err(reason) => reason,
        };
        let near_edge = self_check::leaves_field(sheet.view, lens, &self.target, prediction);
        let fitted = self.fit.fit(sheet.field, lens.model(), &self.target, &prediction.pose);
        match fitted {
            Ok(fitted) => Ok(self.remaining(sheet, lens, &fitted, near_edge)),
            Err(_) if near_edge => Err(NoPose::OutOfField),
            Err(_) => Err(lost),
        }
    }

    /// The answer from cross and marks.
    fn measure(&mut self, sheet: &Sheet, lens: &Lens, sight: &Sight) -> Result<Observed, NoPose> {
        let (cross, plane) = (&sight.cross, &sight.marks.plane);
        let unit = self_check::docking_unit(sheet.view, lens, &self.target, cross, plane, Side::Nominal);
        let measurement = PaperMeasurement {
            focal_px: lens.focal_px(),
            cross: cross.seed.centre.into(),
            slope: cross.seed.slope,
            circle: sight.circle.centre.into(),
            radius_px: sight.circle.radius_px,
        };
        let target = PaperTarget::of(&self.target);
        let paper = measurement.pose(&target)?;
        let seen = orientation::look(sheet.view, lens, &self.target, cross, plane, &unit);
        if self.orientation.is_turned(sheet.time_s, seen) {
            // It is followed, so that nearer, where nothing in the field tells, it is known.
            self.remember(sheet, lens, paper);
            return Ok(Observed::nothing(NoPose::Inconsistent));
        }
        let mut features = evidence::evidence(lens, sight, &unit);
        features.station = evidence::station(sheet.view, lens, &self.target, sight);
        let mut fitted = self.fit.fit(sheet.field, lens.model(), &self.target, &paper);
        if fitted.is_err() {
            // At large angles the paper's pose is farther off than a fit finds back from.
            fitted = self.fit.fit(sheet.field, lens.model(), &self.target, &measurement.aimed_pose(&target)?);
        }
        let by_features = paper_sigma::estimate(&measurement, &target, cross.seed.half_length_px)?;
        let (best, common, mut doubt, is_backup, blur_px) = match fitted {
            Ok(fitted) => {
                evidence::refine(&mut features, &fitted);
                let doubt = self_check::fit(&self.target, lens.focal_px(), &fitted, &by_features);
                (fitted.estimate, fitted.common, doubt, false, fitted.blur_px[1])
            }
            // Cross and marks are there and of one target: the paper's pose is worse than the best one, and better than none.
            Err(_) => (by_features, Matrix6::zeros(), None, true, 0.0),
        };
        let outline = self_check::outline(sheet.view, lens, &self.target, cross, plane);
        match self_check::range(lens, &self.target, plane, outline.as_ref(), &best) {
            Ok(()) => {}
            Err(NoPose::Inconsistent) => doubt = doubt.or(Some(Doubt::Features)),
            Err(reason) => return Err(reason),
        }
        doubt = doubt.or_else(|| self_check::tilt(&best));
        if doubt.is_none() {
            self.remember(sheet, lens, best.pose);
        }
        let field = Box::new(FieldMeasurement { best, paper: Some(paper) });
        Ok(Observed {
            solution: match doubt {
                Some(doubt) => DockingSolution::Doubtful { measurement: field, doubt },
                None => DockingSolution::Measured(field),
            },
            paper: Some(measurement),
            features,
            common,
            is_backup,
            blur_px,
            outline: outline.and_then(|outline| outline.range(&self.target.station, lens.focal_px())),
            region: evidence::plate(lens, plane, &self.target),
        })
    }

    /// The answer from what the best estimator found about the predicted pose.
    fn remaining(&mut self, sheet: &Sheet, lens: &Lens, fitted: &Fitted, near_edge: bool) -> Observed {
        let best = fitted.estimate;
        self.remember(sheet, lens, best.pose);
        if self.orientation.is_turned(sheet.time_s, Uprightness::Unknown) {
            return Observed::nothing(NoPose::Inconsistent);
        }
        let plane = self.track.last().map(|sighting| sighting.plane);
        Observed {
            solution: DockingSolution::Measured(Box::new(FieldMeasurement { best, paper: None })),
            paper: None,
            features: Features { marks: fitted.marks.clone(), ..Features::default() },
            common: fitted.common,
            // Where cross and marks should be seen and are not, the prediction may have led the fit to something else.
            is_backup: !near_edge,
            blur_px: fitted.blur_px[1],
            outline: None,
            region: plane.map_or(Rectangle::ALL, |plane| evidence::plate(lens, &plane, &self.target)),
        }
    }

    fn remember(&mut self, sheet: &Sheet, lens: &Lens, pose: Pose) {
        if let Some(sighting) = Sighting::of(sheet.time_s, sheet.camera, lens, &self.target, pose) {
            self.track.push(sighting);
        }
    }
}

/// A field of which more than this share is at full scale shows nothing.
const MAX_SATURATED_SHARE: f64 = 0.6;
