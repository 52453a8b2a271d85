//! The steps tied together: a field in, pose and motion out.

use contract::docking::{
    Circle, Cross, DockingOutcome, DockingPipeline, DockingPipelineFactory, DockingSetup, DockingSolution,
    Features, Field, FieldMeasurement, FieldTelemetry, MotionReport, NoPose, PoseEstimate, TargetModel,
};
use contract::{Camera, ContractError, PixelPoint};
use nalgebra::Vector2;

use super::config::DockingConfig;
use super::contour;
use super::docking_unit::{self, DiskEdge, Side};
use super::histogram::Histogram;
use super::marks::{self, MarkShape};
use super::model_fit::ModelFit;
use super::paper_pose::{PaperMeasurement, PaperTarget};
use super::portions::{ExactPortions, PaperPortions};
use super::recognise::{Recognition, Sight};
use super::region::{Rectangle, Sighting, Track};
use super::self_check;
use super::view::{Lens, View};
use crate::PipelineError;

/// Builds pipelines by the docking method.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingFactory {
    config: DockingConfig,
}

impl DockingFactory {
    /// With a configuration.
    ///
    /// # Errors
    /// Those of [`DockingConfig::check`].
    pub fn new(config: DockingConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config })
    }
}

impl DockingPipelineFactory for DockingFactory {
    fn name(&self) -> String {
        "docking".to_owned()
    }

    fn build(&self, setup: &DockingSetup) -> Result<Box<dyn DockingPipeline>, ContractError> {
        let docking = Docking::new(self.config.clone(), setup).map_err(|error| {
            ContractError::CannotBuild { pipeline: self.name(), reason: error.to_string() }
        })?;
        Ok(Box::new(docking))
    }
}

/// The docking method on a sequence of fields.
#[derive(Debug)]
pub struct Docking {
    config: DockingConfig,
    cameras: Vec<(Camera, Lens)>,
    target: TargetModel,
    shapes: Vec<MarkShape>,
    track: Track,
    fit: ModelFit,
    portion: Portion,
    exact: ExactPortions,
    paper: PaperPortions,
}

/// The fields of a portion so far.
#[derive(Debug, Clone, Default)]
struct Portion {
    fields: u32,
    best: Vec<(f64, PoseEstimate)>,
    paper: Vec<(f64, PaperMeasurement)>,
    last_time_s: Option<f64>,
}

/// What a field gave besides features: a solution and, when measured, what the paper's portions are made of.
type Solved = (DockingSolution, Option<PaperMeasurement>);

impl Docking {
    /// A pipeline that has seen no field.
    ///
    /// # Errors
    /// [`PipelineError`] when the configuration, a camera or the target's dimensions are not allowed.
    pub fn new(config: DockingConfig, setup: &DockingSetup) -> Result<Self, PipelineError> {
        config.check()?;
        let cameras = setup
            .cameras
            .iter()
            .map(|camera| Ok((camera.clone(), Lens::new(camera)?)))
            .collect::<Result<Vec<_>, ContractError>>()?;
        check_target(&setup.target)?;
        Ok(Self {
            exact: ExactPortions::new(config.portions)?,
            paper: PaperPortions::new(config.paper_portions, PaperTarget::of(&setup.target))?,
            shapes: marks::shapes(&setup.target),
            target: setup.target.clone(),
            cameras,
            config,
            track: Track::default(),
            fit: ModelFit::new(),
            portion: Portion::default(),
        })
    }

    /// Recognises and measures, without portions.
    fn solve(
        &mut self,
        field: &Field,
        view: &View<'_>,
        telemetry: &FieldTelemetry,
        features: &mut Features,
        region: &mut Rectangle,
    ) -> Result<Solved, NoPose> {
        let Self { config, cameras, target, shapes, track, fit, .. } = self;
        let (camera, lens) = cameras.get(telemetry.camera).ok_or_else(|| {
            NoPose::Failed(format!("the field is of camera {}, which is not known", telemetry.camera))
        })?;
        if view.columns() != camera.columns {
            return Err(NoPose::Failed(format!(
                "the field has {} columns, expected {}",
                view.columns(),
                camera.columns
            )));
        }
        let whole = Histogram::of(view, &Rectangle::ALL);
        if whole.saturated_share() > MAX_SATURATED_SHARE {
            track.reset();
            return Err(NoPose::SaturatedField);
        }
        let recognition = Recognition { view, lens, model: target, shapes, config };
        let predicted =
            track.predict(telemetry.time_s, telemetry.camera, lens.focal_px(), config.region.max_gap_s);
        let tracked = predicted.map(|(seed, plane)| recognition.track(&seed, &plane));
        let (sight, is_new) = match tracked {
            Some(Ok(sight)) => (sight, false),
            failed => {
                let overview = view.overview();
                match recognition.search(&overview) {
                    Ok(sight) => (sight, true),
                    Err(found) => {
                        track.reset();
                        let reason = match (found, failed) {
                            (NoPose::NoTarget, Some(Err(lost))) => lost,
                            (found, _) => found,
                        };
                        return outline_range(&overview, lens, target, features, region, reason, &whole);
                    }
                }
            }
        };
        *region = plate(lens, &sight, target);
        let (cross, plane) = (&sight.cross, &sight.marks.plane);
        let unit = self_check::docking_unit(view, lens, target, cross, plane, Side::Nominal);
        *features = evidence(lens, &sight, &unit);
        features.station = station(view, lens, target, &sight);
        if is_new && let Err(reason) = self_check::upright(view, lens, target, cross, plane, &unit) {
            track.reset();
            return Err(reason);
        }
        let measurement = PaperMeasurement {
            focal_px: lens.focal_px(),
            cross: cross.seed.centre.into(),
            slope: cross.seed.slope,
            circle: sight.circle.centre.into(),
            radius_px: sight.circle.radius_px,
        };
        let paper = measurement.pose(&PaperTarget::of(target))?;
        track.push(Sighting {
            time_s: telemetry.time_s,
            camera: telemetry.camera,
            focal_px: lens.focal_px(),
            cross: cross.seed,
            plane: *plane,
        });
        let best = fit.fit(field, lens.model(), target, &paper)?.estimate;
        let measured = FieldMeasurement { best, paper: Some(paper) };
        Ok((DockingSolution::Measured(Box::new(measured)), Some(measurement)))
    }

    /// Adds a field to its portion; the motion, when the portion is complete.
    fn add(
        &mut self,
        time_s: f64,
        solution: &DockingSolution,
        paper: Option<PaperMeasurement>,
    ) -> Option<MotionReport> {
        // A sequence that begins anew has no motion from before.
        if self.portion.last_time_s.is_some_and(|last| time_s <= last || time_s - last > MAX_PORTION_GAP_S)
            || !time_s.is_finite()
        {
            self.portion = Portion::default();
            if time_s.is_finite() {
                self.exact = ExactPortions::new(self.config.portions).ok()?;
                let target = PaperTarget::of(&self.target);
                self.paper = PaperPortions::new(self.config.paper_portions, target).ok()?;
            }
        }
        self.portion.last_time_s = Some(time_s).filter(|t| t.is_finite());
        if let DockingSolution::Measured(measurement) = solution {
            self.portion.best.push((time_s, measurement.best));
            self.portion.paper.extend(paper.map(|paper| (time_s, paper)));
        }
        self.portion.fields += 1;
        if self.portion.fields < self.config.portion_fields {
            return None;
        }
        let ended = std::mem::take(&mut self.portion);
        self.portion.last_time_s = ended.last_time_s;
        let paper = self.paper.end(&ended.paper);
        let best = self.exact.end(&ended.best)?;
        Some(MotionReport { best, paper })
    }
}

impl DockingPipeline for Docking {
    fn process(&mut self, field: &Field, telemetry: &FieldTelemetry) -> DockingOutcome {
        let view = View::new(field);
        let mut features = Features::default();
        let mut region = Rectangle::ALL;
        let (solution, paper) = match self.solve(field, &view, telemetry, &mut features, &mut region) {
            Ok(solved) => solved,
            Err(reason) => (DockingSolution::NoSolution(reason), None),
        };
        let motion = self.add(telemetry.time_s, &solution, paper);
        let histogram = Histogram::of(&view, &region);
        let digitiser = self.config.auto_contrast.wish(&histogram, &telemetry.digitiser);
        DockingOutcome { solution, features, motion, digitiser }
    }
}

/// A field of which more than this share is at full scale shows nothing.
const MAX_SATURATED_SHARE: f64 = 0.6;

/// After a longer gap the motion of the portion before says nothing, s.
const MAX_PORTION_GAP_S: f64 = 30.0;

/// A field whose hundredths differ by less than this many grey values is empty.
const EMPTY_RANGE: f64 = 12.0;

fn check_target(target: &TargetModel) -> Result<(), PipelineError> {
    use crate::error::require;
    let positive = |v: f64| v > 0.0;
    require("target.plate_radius_m", target.plate_radius_m, "greater than 0", positive)?;
    require("target.mark_circle_radius_m", target.mark_circle_radius_m, "greater than 0", positive)?;
    require("target.cross.height_m", target.cross.height_m, "greater than 0", positive)?;
    require("target.cross.half_length_m", target.cross.half_length_m, "greater than 0", positive)?;
    require(
        "target.cross.width_m",
        target.cross.width_m,
        "greater than 0, less than the half length",
        |v| v > 0.0 && v < target.cross.half_length_m,
    )?;
    require("target.marks (their number)", target.marks.len() as f64, "5 to 1000", |v| {
        (5.0..=1000.0).contains(&v)
    })?;
    for corner in target.marks.iter().flatten().flatten() {
        require("target.marks", *corner, "finite numbers", |_| true)?;
    }
    for outline in [&target.docking_unit, &target.station] {
        require("radius_m of an outline of the target", outline.radius_m, "greater than 0", positive)?;
        require("depth_m of an outline of the target", outline.depth_m, "a finite number", |_| true)?;
        require("centre_m of an outline of the target", outline.centre_m[0], "a finite number", |_| true)?;
        require("centre_m of an outline of the target", outline.centre_m[1], "a finite number", |_| true)?;
    }
    Ok(())
}

/// The square about the plate: what brightness and contrast are set by.
fn plate(lens: &Lens, sight: &Sight, target: &TargetModel) -> Rectangle {
    let half_side = target.plate_radius_m * sight.marks.plane.scale_px_m;
    lens.to_camera(sight.marks.plane.centre)
        .map_or(Rectangle::ALL, |centre| Rectangle::about(centre, half_side))
}

/// The range from the station's outline alone, or why there is none.
fn outline_range(
    overview: &super::view::Overview,
    lens: &Lens,
    target: &TargetModel,
    features: &mut Features,
    region: &mut Rectangle,
    reason: NoPose,
    whole: &Histogram,
) -> Result<Solved, NoPose> {
    let Some(outline) = contour::find(overview, lens) else {
        // The thousandths hold a small target before an empty sky; a field is empty when they hold nothing.
        let range = whole.quantile(0.999) - whole.quantile(0.01);
        return Err(if reason == NoPose::NoTarget && range < EMPTY_RANGE {
            NoPose::EmptyField
        } else {
            reason
        });
    };
    let circle = camera_circle(lens, outline.circle.centre, outline.circle.radius);
    if let Some((centre, radius_px)) = circle {
        features.station = Some(Circle { centre, raw_centre: centre, radius_px, points: outline.points });
        *region = Rectangle::about(centre, radius_px);
    }
    // A station that is nearer than the target can be resolved is something else, or hides its target.
    let radius_px = outline.circle.radius;
    let resolved = RESOLVED_CIRCLE_PX / target.mark_circle_radius_m * target.station.radius_m;
    match contour::range(&target.station, lens.focal_px(), radius_px, outline.sigma_px) {
        Some((range_m, sigma_m)) if radius_px < resolved && reason == NoPose::NoTarget => {
            Ok((DockingSolution::RangeOnly { range_m, sigma_m }, None))
        }
        _ => Err(reason),
    }
}

/// Radius of the circle of the marks above which a target that is not found is missing, px.
const RESOLVED_CIRCLE_PX: f64 = 30.0;

/// Centre and mean radius, in the camera's pixels, of a circle of the ideal image.
fn camera_circle(lens: &Lens, centre: Vector2<f64>, radius: f64) -> Option<(PixelPoint, f64)> {
    const POINTS: usize = 8;
    let rim: Vec<PixelPoint> = (0..POINTS)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / POINTS as f64);
            lens.to_camera(centre + radius * Vector2::new(cos, sin))
        })
        .collect::<Option<_>>()?;
    let n = POINTS as f64;
    let middle =
        PixelPoint::new(rim.iter().map(|p| p.x).sum::<f64>() / n, rim.iter().map(|p| p.y).sum::<f64>() / n);
    Some((middle, rim.iter().map(|p| p.distance(middle)).sum::<f64>() / n))
}

/// What was recognised, in the camera's pixels.
fn evidence(lens: &Lens, sight: &Sight, unit: &DiskEdge) -> Features {
    let seed = &sight.cross.seed;
    let half = 0.5 * seed.half_length_px;
    let cross = (|| {
        let (left, right) = (lens.to_camera(seed.place(-half, 0.0))?, lens.to_camera(seed.place(half, 0.0))?);
        Some(Cross {
            centre: lens.to_camera(seed.centre)?,
            raw_centre: lens.to_camera(sight.cross.raw_centre)?,
            slope: (right.y - left.y) / (right.x - left.x),
            horizontal_pairs: sight.cross.pairs.0 as u32,
            vertical_pairs: sight.cross.pairs.1 as u32,
        })
    })();
    let circle = (|| {
        let (centre, radius_px) = camera_circle(lens, sight.circle.centre, sight.circle.radius_px)?;
        let (raw_centre, _) = camera_circle(lens, sight.circle.raw_centre, sight.circle.radius_px)?;
        Some(Circle { centre, raw_centre, radius_px, points: sight.circle.points })
    })();
    Features {
        cross,
        circle,
        station: None,
        docking_unit: disk(lens, unit, 0.4),
        marks: sight.marks.marks.iter().map(|seen| seen.mark).collect(),
    }
}

/// The circle of a disk's edge that is seen in at least `share` of its directions.
fn disk(lens: &Lens, edge: &DiskEdge, share: f64) -> Option<Circle> {
    let fit = edge.circle.filter(|_| edge.share >= share)?;
    let (centre, radius_px) = camera_circle(lens, fit.centre, fit.radius)?;
    Some(Circle { centre, raw_centre: centre, radius_px, points: edge.points })
}

/// The station's outline, where cross and marks say that it is.
fn station(view: &View<'_>, lens: &Lens, target: &TargetModel, sight: &Sight) -> Option<Circle> {
    let (plane, cross) = (&sight.marks.plane, sight.cross.seed.centre);
    let place = docking_unit::predict(target, &target.station, lens.focal_px(), plane, cross, Side::Nominal);
    let edge = docking_unit::find(view, lens, place, (0.12 * sight.cross.levels.contrast()).max(8.0));
    disk(lens, &edge, 0.5)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{self, Scene};
    use super::*;
    use contract::docking::{Lines, MarkUse};

    fn docking() -> Docking {
        Docking::new(DockingConfig::default(), &synthetic::setup()).unwrap()
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
            let measurement = outcome.measurement().unwrap_or_else(|| panic!("{range_m}: {outcome:?}"));
            let pose = measurement.paper.unwrap();
            // R to a tenth of a pixel.
            let tolerance = 0.15 / (0.25 * 1055.0 / range_m) * range_m;
            assert!((pose.position_m.z - range_m).abs() < tolerance, "{range_m}: {pose:?}");
            assert!((pose.phi_rad.z + roll_rad).abs() < 0.01, "{range_m}: {pose:?}");
            let cross = outcome.features.cross.unwrap();
            assert!(cross.centre.distance(cross.raw_centre) < 1.5);
            assert!(outcome.features.marks.iter().filter(|m| m.usage == MarkUse::Used).count() >= 11);
        }
    }

    #[test]
    fn a_second_field_is_measured_from_the_prediction_like_the_first() {
        let mut pipeline = docking();
        let scene = Scene::default();
        let first = pipeline.process(&scene.field(Lines::Even), &synthetic::telemetry(0.0));
        let again = pipeline.process(&scene.field(Lines::Even), &synthetic::telemetry(0.02));
        let pose = |outcome: &DockingOutcome| outcome.measurement().unwrap().paper.unwrap().position_m;
        // The same pixels from another start: within the pairs that change sides.
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
        assert!(answer(&upright).measurement().is_some());
        let mut dn = upright.image().dn().to_vec();
        dn.reverse();
        assert_eq!(reason(&synthetic::plain(dn, Lines::All)), NoPose::Inconsistent);
    }

    #[test]
    fn a_field_without_a_target_says_why() {
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
