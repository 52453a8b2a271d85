//! Steps of the method combined: from a field to pose and motion.

use contract::docking::{
    Docking, DockingOutcome, DockingSetup, DockingSolution, FailedCheck, Field, FieldTelemetry, MotionReport,
};
use contract::{ContractError, Pipeline, PipelineFactory};

use super::config::DockingConfig;
use super::observer::{FieldObservation, Observer};
use super::portions::{Continuity, MotionTracker, PaperPortions};
use super::pose::paper_pose::{PaperMeasurement, PaperTarget};
use super::preprocessing::histogram::Histogram;
use super::preprocessing::view::View;
use super::repeats::RepeatDetector;
use super::temporal_noise::{PictureAge, TemporalNoise};
use crate::PipelineError;

/// Factory of pipelines by the docking method.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingFactory {
    config: DockingConfig,
}

impl DockingFactory {
    /// Creates a factory from a configuration.
    ///
    /// # Errors
    /// Those of [`DockingConfig::check`].
    pub fn new(config: DockingConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config })
    }
}

impl PipelineFactory<Docking> for DockingFactory {
    fn name(&self) -> String {
        "docking".to_owned()
    }

    fn build(&self, setup: &DockingSetup) -> Result<Box<dyn Pipeline<Docking>>, ContractError> {
        let docking = DockingPipeline::new(self.config.clone(), setup).map_err(|error| {
            ContractError::CannotBuild { pipeline: self.name(), reason: error.to_string() }
        })?;
        Ok(Box::new(docking))
    }
}

/// Docking method applied to a sequence of fields.
#[derive(Debug)]
pub struct DockingPipeline {
    config: DockingConfig,
    target: PaperTarget,
    observer: Observer,
    portion: Portion,
    motion: MotionTracker,
    repeats: RepeatDetector,
    temporal_noise: TemporalNoise,
    paper: PaperPortions,
}

/// Fields of the current portion.
#[derive(Debug, Clone, Default)]
struct Portion {
    fields: u32,
    paper: Vec<(f64, PaperMeasurement)>,
    last_time_s: Option<f64>,
}

impl DockingPipeline {
    /// Creates a pipeline without any field.
    ///
    /// # Errors
    /// [`PipelineError`] when the configuration, a camera or the target's dimensions are not allowed.
    pub fn new(config: DockingConfig, setup: &DockingSetup) -> Result<Self, PipelineError> {
        config.check()?;
        let target = PaperTarget::from_model(&setup.target);
        Ok(Self {
            observer: Observer::new(&config, setup)?,
            motion: MotionTracker::new(config.motion)?,
            repeats: RepeatDetector::default(),
            temporal_noise: TemporalNoise::default(),
            paper: PaperPortions::new(config.paper_portions, target)?,
            target,
            config,
            portion: Portion::default(),
        })
    }

    /// Adds a field to its portion. Returns the motion when the portion is complete.
    fn add(&mut self, time_s: f64, paper: Option<PaperMeasurement>) -> Option<MotionReport> {
        // A new sequence inherits no motion.
        if self.portion.last_time_s.is_some_and(|last| time_s <= last || time_s - last > MAX_PORTION_GAP_S)
            || !time_s.is_finite()
        {
            self.portion = Portion::default();
            if time_s.is_finite() {
                self.paper = PaperPortions::new(self.config.paper_portions, self.target).ok()?;
            }
        }
        self.portion.last_time_s = Some(time_s).filter(|t| t.is_finite());
        self.portion.paper.extend(paper.map(|paper| (time_s, paper)));
        self.portion.fields += 1;
        if self.portion.fields < self.config.portion_fields {
            return None;
        }
        let ended = std::mem::take(&mut self.portion);
        self.portion.last_time_s = ended.last_time_s;
        let paper = self.paper.end(&ended.paper);
        MotionReport::from_estimates(self.motion.report(), paper)
    }

    /// Tests a pose against previous fields, and scales its covariance to their scatter.
    fn test(&mut self, field: &Field, time_s: f64, observed: FieldObservation) -> FieldObservation {
        let mut age = self.temporal_noise.add(field, time_s);
        age.is_repeated |= self.repeats.is_repeated(field);
        let outline = observed.outline.filter(|_| !age.is_repeated);
        let tested = self.test_pose(age, time_s, observed);
        if let Some(outline) = outline {
            self.motion.add_range(time_s, &outline);
        }
        tested
    }

    fn test_pose(&mut self, age: PictureAge, time_s: f64, observed: FieldObservation) -> FieldObservation {
        let FieldObservation {
            solution: DockingSolution::Measured(mut measurement),
            common,
            is_backup,
            is_small,
            blur_px,
            ..
        } = observed
        else {
            return observed;
        };
        let mixed_s = if blur_px > MIXING_BLUR_PX { MIXED_S } else { 0.0 };
        let timing_s = libm::hypot(mixed_s, age.sigma_s);
        if timing_s > 0.0 {
            measurement.best.covariance += self.motion.timing_covariance(time_s, timing_s);
        }
        let doubt = if age.is_repeated {
            Some(FailedCheck::Repeated)
        } else if is_backup && !self.motion.confirms(time_s, &measurement.best) {
            Some(FailedCheck::Residuals)
        } else {
            let (continuity, factor) = self.motion.add(time_s, &measurement.best, &common, is_small);
            measurement.best.covariance *= factor;
            match continuity {
                Continuity::Breaks => Some(FailedCheck::Motion),
                Continuity::Begins if is_small => Some(FailedCheck::Unconfirmed),
                Continuity::Begins | Continuity::Continues => None,
            }
        };
        let solution = match doubt {
            Some(doubt) => DockingSolution::Doubtful { measurement, doubt },
            None => DockingSolution::Measured(measurement),
        };
        FieldObservation { solution, ..observed }
    }
}

impl Pipeline<Docking> for DockingPipeline {
    fn process(&mut self, field: &Field, telemetry: &FieldTelemetry) -> DockingOutcome {
        let view = View::new(field);
        let observed = self.observer.observe(field, &view, telemetry);
        let FieldObservation { solution, paper, features, region, .. } =
            self.test(field, telemetry.time_s, observed);
        let motion = self.add(telemetry.time_s, paper);
        let histogram = Histogram::from_region(&view, &region);
        let digitiser = self.config.auto_contrast.recommend(&histogram, &telemetry.digitiser);
        DockingOutcome { solution, features, motion, digitiser }
    }
}

/// Blur across the lines, px, above which an image may have been blurred as a whole frame. A line then
/// contains as much of its neighbours, which belong to the other field's time, as of its own signal. A lens
/// in focus and a television's aperture cause 0.6 to 0.9 px.
const MIXING_BLUR_PX: f64 = 1.2;

/// Half of the time between the fields of a frame at 50 fields per second, s.
const MIXED_S: f64 = 0.01;

/// Longest gap across which the motion of the previous portion remains valid, s.
const MAX_PORTION_GAP_S: f64 = 30.0;

#[cfg(test)]
mod tests {
    use super::super::synthetic::{self, Scene};
    use super::*;
    use contract::docking::{Lines, MarkUse, NoPose};
    use nalgebra::Vector2;

    fn docking() -> DockingPipeline {
        DockingPipeline::new(DockingConfig::default(), &synthetic::setup()).unwrap()
    }

    fn answer(field: &Field) -> DockingOutcome {
        docking().process(field, &synthetic::telemetry(0.0))
    }

    fn reason(field: &Field) -> NoPose {
        match answer(field).solution {
            DockingSolution::NoSolution(reason) => reason,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_clean_field_is_measured() {
        for (range_m, roll_rad) in [(5.0, 0.0), (2.0, 0.05), (10.0, -0.1)] {
            let scene = Scene { range_m, roll_rad, noise_dn: 2.0, ..Scene::default() };
            let outcome = answer(&scene.field(Lines::Even));
            // At 10 m the cross is small, and no earlier field confirms its pose.
            let is_confirmed = match outcome.solution {
                DockingSolution::Doubtful { doubt, .. } => doubt != FailedCheck::Unconfirmed,
                _ => true,
            };
            assert_eq!(is_confirmed, range_m < 10.0, "{outcome:?}");
            let measurement = outcome.any_measurement().unwrap_or_else(|| panic!("{range_m}: {outcome:?}"));
            let pose = measurement.paper.unwrap();
            // R is accurate to a tenth of a pixel.
            let tolerance = 0.15 / (0.25 * 1055.0 / range_m) * range_m;
            assert!((pose.position_m.z - range_m).abs() < tolerance, "{range_m}: {pose:?}");
            assert!((pose.phi_rad.z + roll_rad).abs() < 0.01, "{range_m}: {pose:?}");
            let cross = outcome.features.cross.unwrap();
            assert!(cross.centre.distance(cross.raw_centre) < 1.5);
            // The scene's cross has no side faces, so the best estimator may reject marks; they are found
            // nevertheless.
            let found = |usage| matches!(usage, MarkUse::Used | MarkUse::Rejected);
            assert!(outcome.features.marks.iter().filter(|m| found(m.usage)).count() >= 11);
        }
    }

    #[test]
    fn a_second_field_is_measured_from_the_prediction_like_the_first() {
        let mut pipeline = docking();
        let scene = Scene::default();
        let first = pipeline.process(&scene.field(Lines::Even), &synthetic::telemetry(0.0));
        let again = pipeline.process(&scene.field(Lines::Even), &synthetic::telemetry(0.02));
        assert!(matches!(again.solution, DockingSolution::Doubtful { doubt: FailedCheck::Repeated, .. }));
        let pose = |outcome: &DockingOutcome| outcome.any_measurement().unwrap().paper.unwrap().position_m;
        // Identical pixels from another start: the results differ only by the edge pairs that change sides.
        assert!((pose(&first) - pose(&again)).norm() < 0.02, "{} {}", pose(&first), pose(&again));
    }

    #[test]
    fn two_targets_are_ambiguous() {
        let scene = Scene {
            range_m: 8.0,
            disk_px: Vector2::new(-150.0, -60.0),
            second_px: Some(Vector2::new(120.0, -40.0)),
            ..Scene::default()
        };
        assert_eq!(reason(&scene.field(Lines::Even)), NoPose::AmbiguousTarget);
    }

    #[test]
    fn a_target_upside_down_is_inconsistent() {
        let scene = Scene { range_m: 12.0, disk_px: Vector2::new(0.0, -60.0), ..Scene::default() };
        let upright = scene.field(Lines::All);
        assert!(answer(&upright).any_measurement().is_some());
        let mut dn = upright.image().dn().to_vec();
        dn.reverse();
        assert_eq!(reason(&synthetic::plain(dn, Lines::All)), NoPose::Inconsistent);
    }

    #[test]
    fn a_field_without_a_target_has_a_reason() {
        assert_eq!(reason(&synthetic::drawn(Lines::Even, |_, _| 20)), NoPose::EmptyField);
        assert_eq!(reason(&synthetic::drawn(Lines::Even, |_, _| 255)), NoPose::SaturatedField);
        assert_eq!(
            reason(&synthetic::drawn(Lines::Odd, |x, y| if (x / 40 + y / 40) % 2 == 0 { 30 } else { 180 })),
            NoPose::NoTarget
        );
        assert_eq!(
            reason(&synthetic::drawn(Lines::Odd, |x, y| ((x * 7919 + y * 104_729) % 251) as u16)),
            NoPose::NoTarget
        );
        let bare = Scene { cross: false, range_m: 3.0, ..Scene::default() };
        assert_eq!(reason(&bare.field(Lines::Even)), NoPose::NoTarget);
    }

    #[test]
    fn a_far_station_gives_its_range_alone() {
        let radius = 1055.0 * 2.05 / 150.45;
        let field = synthetic::drawn(Lines::Even, |x, y| {
            if libm::hypot(x as f64 - 380.0, y as f64 - 290.0) < radius { 130 } else { 9 }
        });
        match answer(&field).solution {
            DockingSolution::RangeOnly { range_m, sigma_m } => {
                assert!((range_m - 150.0).abs() < 3.0 * sigma_m && sigma_m < 15.0, "{range_m} {sigma_m}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_field_of_an_unknown_camera_or_of_another_size_is_a_failure() {
        let field = synthetic::drawn(Lines::Even, |_, _| 20);
        let telemetry = FieldTelemetry { camera: 3, ..synthetic::telemetry(0.0) };
        let outcome = docking().process(&field, &telemetry);
        assert!(matches!(outcome.solution, DockingSolution::NoSolution(NoPose::Failed(_))));
        let small =
            Field::new(contract::Frame::new(0, 1, 1, 8, vec![3], None).unwrap(), Lines::All, 1).unwrap();
        let outcome = docking().process(&small, &synthetic::telemetry(0.0));
        assert!(matches!(outcome.solution, DockingSolution::NoSolution(NoPose::Failed(_))));
    }

    #[test]
    fn a_portion_ends_with_a_motion() {
        let mut pipeline = docking();
        let field = Scene::default().field(Lines::Even);
        let reports: Vec<bool> = (0..20)
            .map(|i| pipeline.process(&field, &synthetic::telemetry(0.02 * f64::from(i))).motion.is_some())
            .collect();
        assert_eq!(reports.iter().filter(|r| **r).count(), 2);
        assert!(reports[9] && reports[19]);
    }
}
