//! One field: recognised, measured, checked.

use contract::docking::{
    DockingSetup, DockingSolution, Features, Field, FieldMeasurement, FieldTelemetry, NoPose, Pose,
    TargetModel,
};
use contract::{Camera, ContractError};

use super::config::DockingConfig;
use super::docking_unit::Side;
use super::evidence;
use super::histogram::Histogram;
use super::marks::{self, MarkShape};
use super::model_fit::{Fitted, ModelFit};
use super::outline;
use super::paper_pose::{PaperMeasurement, PaperTarget};
use super::paper_sigma;
use super::recognise::{Recognition, Sight};
use super::region::{Prediction, Rectangle, Sighting, Track};
use super::self_check;
use super::view::{Lens, View};
use crate::PipelineError;
use crate::error::require;

/// Recognises and measures field after field; remembers where the target was.
#[derive(Debug)]
pub(crate) struct Observer {
    config: DockingConfig,
    cameras: Vec<(Camera, Lens)>,
    target: TargetModel,
    shapes: Vec<MarkShape>,
    track: Track,
    fit: ModelFit,
    /// Moment and d3 of the last pose, which a loss of the target does not erase.
    last_range: Option<(f64, f64)>,
}

/// What a field gave.
pub(crate) struct Observed {
    pub(crate) solution: DockingSolution,
    /// What the paper's formulas are made of, where cross and circle were measured.
    pub(crate) paper: Option<PaperMeasurement>,
    pub(crate) features: Features,
    /// Where brightness and contrast are to be judged.
    pub(crate) region: Rectangle,
}

impl Observed {
    fn nothing(reason: NoPose) -> Self {
        Self {
            solution: DockingSolution::NoSolution(reason),
            paper: None,
            features: Features::default(),
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
            last_range: None,
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
        let max_gap_s = self.config.region.max_gap_s;
        let predicted = self.track.predict(sheet.time_s, sheet.camera, lens.focal_px(), max_gap_s);
        let mut lost = None;
        if let Some(prediction) = &predicted {
            match self.follow(&sheet, &lens, prediction) {
                Ok(observed) => return observed,
                Err(reason) => lost = Some(reason),
            }
        }
        let overview = view.overview();
        let found = self.recognition(view, &lens).search(&overview);
        let reason = match found {
            Ok(sight) => match self.measure(&sheet, &lens, &sight, true) {
                Ok(observed) => return observed,
                Err(reason) => reason,
            },
            Err(NoPose::NoTarget) => lost.unwrap_or(NoPose::NoTarget),
            Err(reason) => reason,
        };
        self.track.reset();
        let mut observed = Observed::nothing(reason.clone());
        let Observed { features, region, .. } = &mut observed;
        observed.solution =
            match outline::range(view, &overview, &lens, &self.target, features, region, reason) {
                Ok(DockingSolution::RangeOnly { range_m, .. }) if !self.may_be_at(sheet.time_s, range_m) => {
                    DockingSolution::NoSolution(NoPose::Inconsistent)
                }
                Ok(solution) => solution,
                Err(reason) => DockingSolution::NoSolution(reason),
            };
        observed
    }

    fn recognition<'a>(&'a self, view: &'a View<'a>, lens: &'a Lens) -> Recognition<'a> {
        Recognition { view, lens, model: &self.target, shapes: &self.shapes, config: &self.config }
    }

    /// The target about where the fields before have it: cross and marks, or what is left of them about the predicted pose.
    fn follow(&mut self, sheet: &Sheet, lens: &Lens, prediction: &Prediction) -> Result<Observed, NoPose> {
        let tracked = self.recognition(sheet.view, lens).track(&prediction.cross, &prediction.plane);
        let lost = match tracked.and_then(|sight| self.measure(sheet, lens, &sight, false)) {
            Ok(observed) => return Ok(observed),
            Err(reason) => reason,
        };
        let near_edge = self_check::leaves_field(sheet.view, lens, &self.target, prediction);
        let fitted = self.fit.fit(sheet.field, lens.model(), &self.target, &prediction.pose);
        match fitted {
            Ok(fitted) => Ok(self.remaining(sheet, lens, &fitted)),
            Err(_) if near_edge => Err(NoPose::OutOfField),
            Err(_) => Err(lost),
        }
    }

    /// The answer from cross and marks.
    fn measure(
        &mut self,
        sheet: &Sheet,
        lens: &Lens,
        sight: &Sight,
        is_new: bool,
    ) -> Result<Observed, NoPose> {
        let (cross, plane) = (&sight.cross, &sight.marks.plane);
        let unit = self_check::docking_unit(sheet.view, lens, &self.target, cross, plane, Side::Nominal);
        if is_new {
            self_check::upright(sheet.view, lens, &self.target, cross, plane, &unit)?;
        }
        let measurement = PaperMeasurement {
            focal_px: lens.focal_px(),
            cross: cross.seed.centre.into(),
            slope: cross.seed.slope,
            circle: sight.circle.centre.into(),
            radius_px: sight.circle.radius_px,
        };
        let target = PaperTarget::of(&self.target);
        let paper = measurement.pose(&target)?;
        let mut features = evidence::evidence(lens, sight, &unit);
        features.station = evidence::station(sheet.view, lens, &self.target, sight);
        let best = match self.fit.fit(sheet.field, lens.model(), &self.target, &paper) {
            Ok(fitted) => {
                evidence::refine(&mut features, &fitted);
                fitted.estimate
            }
            // Cross and marks are there and of one target: the paper's pose is worse than the best one, and better than none.
            Err(_) => paper_sigma::estimate(&measurement, &target, cross.seed.half_length_px)?,
        };
        self.remember(sheet, lens, best.pose);
        Ok(Observed {
            solution: DockingSolution::Measured(Box::new(FieldMeasurement { best, paper: Some(paper) })),
            paper: Some(measurement),
            features,
            region: evidence::plate(lens, plane, &self.target),
        })
    }

    /// The answer from what the best estimator found about the predicted pose.
    fn remaining(&mut self, sheet: &Sheet, lens: &Lens, fitted: &Fitted) -> Observed {
        let best = fitted.estimate;
        self.remember(sheet, lens, best.pose);
        let plane = self.track.last().map(|sighting| sighting.plane);
        Observed {
            solution: DockingSolution::Measured(Box::new(FieldMeasurement { best, paper: None })),
            paper: None,
            features: Features { marks: fitted.marks.clone(), ..Features::default() },
            region: plane.map_or(Rectangle::ALL, |plane| evidence::plate(lens, &plane, &self.target)),
        }
    }

    /// Whether a range can be reached from the last pose: what is near and lost is not far.
    fn may_be_at(&self, time_s: f64, range_m: f64) -> bool {
        self.last_range.is_none_or(|(before_s, before_m)| {
            let elapsed_s = time_s - before_s;
            elapsed_s < 0.0 || (range_m - before_m).abs() <= 0.2 * before_m + MAX_SPEED_M_S * elapsed_s
        })
    }

    fn remember(&mut self, sheet: &Sheet, lens: &Lens, pose: Pose) {
        self.last_range = Some((sheet.time_s, pose.position_m.z));
        if let Some(sighting) = Sighting::of(sheet.time_s, sheet.camera, lens, &self.target, pose) {
            self.track.push(sighting);
        }
    }
}

/// A field of which more than this share is at full scale shows nothing.
const MAX_SATURATED_SHARE: f64 = 0.6;

/// No approach is faster than this, m/s.
const MAX_SPEED_M_S: f64 = 10.0;
