//! Reports of far-range frames for the monitor.
use ::monitor::ground::GroundTrack;
use ::monitor::report::{CameraPose, Fact, FrameReport, ImageLayout, Parameter, Phase, Shape};
use contract::{Camera, Label, Outcome, Solution};
use far_range::FarRangeMission;
use files::format_utc;
use hifitime::Epoch;
use nalgebra::Vector3;
use run::WorldScenario as _;
use serde_json::{Value, json};
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Trajectory, Visibility};

/// Half side of the box around a cluster, px.
const CLUSTER_PX: f64 = 5.0;
/// Radius of the smallest circle around a true position, px.
const TRUTH_PX: f64 = 9.0;
/// Maximum number of true objects drawn: in an image full of cosmic-ray hits, more would add no information.
const MAX_TRUTHS: usize = 300;
/// Largest fraction of an object's flux that the regions may cut off before the object counts as outside the
/// image.
const MAX_CUT: f64 = 0.5;

/// Makes the reports of far-range frames.
pub(crate) struct FarRangeReporter<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) trajectory: &'a Trajectory,
    pub(crate) ground: &'a GroundTrack,
    /// Time of the scenario's first frame.
    pub(crate) start: Epoch,
}

impl FarRangeReporter<'_> {
    /// Returns the report of a frame; `outcome` is `None` for a frame that the pipeline did not report.
    pub(crate) fn report(
        &self,
        truth: &FrameTruth,
        objects: &[ObjectTruth],
        outcome: Option<&Outcome>,
    ) -> FrameReport {
        let Camera { columns, rows, .. } = *self.camera;
        FrameReport {
            frame: truth.frame,
            time_utc: format_utc(truth.time),
            elapsed_s: (truth.time - self.start).to_seconds(),
            group: truth.group.clone(),
            image: ImageLayout { columns, rows, first_row: 0, row_step: 1, camera_rows: rows },
            status: status(outcome),
            parameters: parameters(truth, objects, outcome),
            facts: facts(truth, outcome),
            overlay: recognised(outcome),
            truth_overlay: true_positions(objects),
            phase: Phase { measured: None, truth: range_and_rate(self.trajectory, truth.time) },
            ground: self.ground.ground_at(truth.time),
            model: self.model(truth, outcome),
        }
    }

    /// Returns the bodies in the radial, along-track and normal axes of the target's orbit, km.
    fn model(&self, truth: &FrameTruth, outcome: Option<&Outcome>) -> Value {
        let states = self.trajectory.states_at(truth.time);
        let rtn_from_icrs = states.target.rtn_from_icrs();
        let position: [f64; 3] = states.chaser_rtn_km().into();
        let view = |camera_from_icrs: &contract::Rotation<contract::CameraFrame, contract::Icrs>| {
            let icrs_from_camera = camera_from_icrs.inverse();
            let axis = |axis: Vector3<f64>| rtn_from_icrs.rotate(&icrs_from_camera.rotate(&axis)).into();
            CameraPose { position, axes: [axis(Vector3::x()), axis(Vector3::y()), axis(Vector3::z())] }
        };
        let line_of_sight =
            outcome.and_then(Outcome::measurement).and_then(|measurement| measurement.line_of_sight);
        json!({
            "world": FarRangeMission::CODE,
            "measured": outcome.and_then(|outcome| outcome.camera_from_icrs.as_ref()).map(view),
            "truth": view(&truth.camera_from_icrs),
            "sun": <[f64; 3]>::from(rtn_from_icrs.rotate(truth.sun.vector())),
            "line_of_sight": line_of_sight.map(|los| <[f64; 3]>::from(rtn_from_icrs.rotate(los.vector()))),
        })
    }
}

/// Returns range, km, and range rate, m/s.
pub(crate) fn range_and_rate(trajectory: &Trajectory, time: Epoch) -> [f64; 2] {
    let states = trajectory.states_at(time);
    let apart = states.line_of_sight_km();
    let range_km = apart.norm();
    let rate_km_s = apart.dot(&(states.target.velocity_km_s - states.chaser.velocity_km_s)) / range_km;
    [range_km, rate_km_s * 1000.0]
}

fn status(outcome: Option<&Outcome>) -> String {
    match outcome.map(|outcome| &outcome.solution) {
        Some(Solution::Detected(_)) => "detected".to_owned(),
        Some(Solution::NoSolution(reason)) => reason.to_string(),
        None => "not_reported".to_owned(),
    }
}

fn parameters(truth: &FrameTruth, objects: &[ObjectTruth], outcome: Option<&Outcome>) -> Vec<Parameter> {
    const TARGET: &str = "Target";
    let measurement = outcome.and_then(Outcome::measurement);
    let line_of_sight = measurement.and_then(|measurement| measurement.line_of_sight);
    let target = objects.iter().find(|object| object.kind == ObjectKind::Target);
    let place = target.map(|target| target.position).or(truth.target_position);
    let row = |section, name, label, unit, decimals, measured, truth| Parameter {
        section,
        name,
        label,
        unit,
        decimals,
        measured,
        sigma: None,
        truth,
    };
    let los = line_of_sight.as_ref().map(contract::Direction::vector);
    let true_los = truth.line_of_sight.vector();
    let n_stars = outcome.and_then(|outcome| outcome.n_stars).map(f64::from);
    vec![
        row(TARGET, "x_px", "x", "px", 2, measurement.map(|m| m.position.x), place.map(|p| p.x)),
        row(TARGET, "y_px", "y", "px", 2, measurement.map(|m| m.position.y), place.map(|p| p.y)),
        row(
            TARGET,
            "ra_deg",
            "RA",
            "°",
            4,
            line_of_sight.map(|l| l.ra().degrees()),
            Some(truth.line_of_sight.ra().degrees()),
        ),
        row(
            TARGET,
            "dec_deg",
            "Dec",
            "°",
            4,
            line_of_sight.map(|l| l.dec().degrees()),
            Some(truth.line_of_sight.dec().degrees()),
        ),
        row("Line of sight, J2000", "los_j2000_x", "lx", "", 6, los.map(|v| v.x), Some(true_los.x)),
        row("Line of sight, J2000", "los_j2000_y", "ly", "", 6, los.map(|v| v.y), Some(true_los.y)),
        row("Line of sight, J2000", "los_j2000_z", "lz", "", 6, los.map(|v| v.z), Some(true_los.z)),
        row("Scene", "n_stars", "Stars identified", "", 0, n_stars, None),
        row("Scene", "range_km", "Range", "km", 3, None, Some(truth.range_km)),
        row("Scene", "phase_deg", "Phase angle", "°", 1, None, Some(truth.phase_deg)),
        row("Scene", "snr", "Target SNR", "", 1, None, target.map(|target| target.snr)),
    ]
}

fn facts(truth: &FrameTruth, outcome: Option<&Outcome>) -> Vec<Fact> {
    let attitude = outcome
        .and_then(|outcome| outcome.attitude_source)
        .map_or("—".to_owned(), |source| source.code().replace('_', " "));
    let clusters = outcome.map_or(&[][..], |outcome| &outcome.clusters);
    let count = |of: fn(&Label) -> bool| clusters.iter().filter(|cluster| of(&cluster.label)).count();
    let stars = count(|label| matches!(label, Label::Star(_)));
    let hotspots = count(|label| *label == Label::Hotspot);
    let counts = format!("{}: {stars} stars, {hotspots} hotspots", clusters.len());
    vec![
        Fact { label: "Clusters", value: counts },
        Fact { label: "Exposure", value: format!("{:.1} ms", truth.exposure_s * 1000.0) },
        Fact { label: "Attitude from", value: attitude },
        Fact { label: "Shadow", value: truth.shadow.code().to_owned() },
    ]
}

fn recognised(outcome: Option<&Outcome>) -> Vec<Shape> {
    let Some(outcome) = outcome else { return Vec::new() };
    let clusters = outcome.clusters.iter().filter(|cluster| cluster.label != Label::Target);
    let target = outcome
        .measurement()
        .map(|m| Shape::new("cross", "target", [m.position.x, m.position.y], 4.0 * CLUSTER_PX));
    clusters
        .map(|cluster| {
            let place = [cluster.position.x, cluster.position.y];
            let label = match cluster.label {
                Label::Star(id) => format!("HIP {id}"),
                _ => String::new(),
            };
            Shape { label, ..Shape::new("box", cluster.label.code(), place, CLUSTER_PX) }
        })
        .chain(target)
        .collect()
}

fn true_positions(objects: &[ObjectTruth]) -> Vec<Shape> {
    objects
        .iter()
        .filter(|object| Visibility::from_snr(object.snr) != Visibility::Invisible && object.cut < MAX_CUT)
        .take(MAX_TRUTHS)
        .map(|object| {
            let kind = format!("truth {}", object.kind.code());
            let place = [object.position.x, object.position.y];
            let label = if object.kind == ObjectKind::Target { "target" } else { "" };
            Shape {
                label: label.to_owned(),
                ..Shape::new("circle", &kind, place, object.radius_px.max(TRUTH_PX))
            }
        })
        .collect()
}
