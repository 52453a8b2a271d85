//! What the page is told once: the scenario, its cameras, the plan, and the scene's facets.
use axum::body::Bytes;
use contract::Camera;
use files::Failure;
use run::World as _;
use scenario::DockingScenario;
use scenario::run_file::RunFile;
use serde::Serialize;
use serde_json::{Value, json};

use super::far_range_report::range_and_rate;
use super::feed::{Feed, Measurements, Surroundings};
use super::plan::Plan;

/// Frames a second at which a far-range sequence is played: its own cadence is many seconds a frame.
const FAR_RANGE_RATE_HZ: f64 = 25.0;
/// Least half width of the corridor, m/s.
const DOCKING_MARGIN_M_S: f64 = 0.05;
const FAR_RANGE_MARGIN_M_S: f64 = 0.1;
/// Points of the relative orbit that are drawn.
const ORBIT_POINTS: u64 = 3000;

/// The documents that do not change.
#[derive(Debug, Clone)]
pub(super) struct Overview {
    pub(super) session: Bytes,
    pub(super) scene: Bytes,
}

impl Overview {
    pub(super) fn of(feed: &Feed, surroundings: &Surroundings) -> Result<Self, Failure> {
        let frames = &surroundings.frames;
        let (session, scene) = match feed {
            Feed::FarRange(prepared, measurements) => {
                let scenario = prepared.scenario();
                let schedule = prepared.simulator().schedule();
                let trajectory = surroundings.trajectory.as_ref();
                let at = |frame| schedule.frame(frame).zip(trajectory);
                let plan = Plan::new("km", frames, FAR_RANGE_MARGIN_M_S, |frame| {
                    at(frame).map(|((_, time), trajectory)| range_and_rate(trajectory, time))
                });
                let radius_km =
                    at(frames.start).map(|((_, time), track)| track.at(time).target.position_km.norm());
                let step = ((frames.end - frames.start) / ORBIT_POINTS).max(1);
                let orbit: Vec<(u64, [f64; 3])> = frames
                    .clone()
                    .step_by(usize::try_from(step).unwrap_or(usize::MAX))
                    .filter_map(|frame| {
                        at(frame).map(|((_, time), track)| (frame, track.at(time).chaser_rtn_km().into()))
                    })
                    .collect();
                // Nobody looked between one day and the next: no line crosses that time.
                let begins: Vec<u64> = schedule.sequences().map(|day| day.frames.start).collect();
                let session = json!({
                    "world": "far_range",
                    "title": scenario.title,
                    "seed": scenario.seed,
                    "mode": measurements.mode(),
                    "rate_hz": FAR_RANGE_RATE_HZ,
                    "cameras": [camera("", &scenario.camera)],
                    "plan": plan,
                    "begins": begins,
                    "orbit_rtn_km": orbit,
                    "orbit_radius_km": radius_km,
                    "notes": [],
                });
                (session, json!({ "facets": [] }))
            }
            Feed::Docking(prepared, measurements) => {
                let (scenario, simulator) = (prepared.scenario(), prepared.simulator());
                let plan = Plan::new("m", frames, DOCKING_MARGIN_M_S, |field| {
                    let state = simulator.moment(field).ok()?.state;
                    Some([state.range_m(), state.range_rate_m_s()])
                });
                let cameras: Vec<Value> =
                    scenario.cameras.iter().map(|c| camera(&c.name, &c.camera)).collect();
                let mut notes = Vec::new();
                if let Measurements::Replay(directory) = measurements
                    && RunFile::<DockingScenario>::read(&directory.join("run.toml"))?.mitsuba.is_some()
                {
                    notes.push("The run's pictures were Mitsuba's; these are the fast renderer's.");
                }
                if surroundings.ground.is_some() {
                    notes.push(
                        "The scenario names no orbit: the track is that of 51.6° and 370 km on which the Sun stands where the \
                         scene has it.",
                    );
                }
                let session = json!({
                    "world": "docking",
                    "title": scenario.title,
                    "seed": scenario.seed,
                    "mode": measurements.mode(),
                    "rate_hz": simulator.field_rate_hz(),
                    "cameras": cameras,
                    "plan": plan,
                    "begins": [],
                    "docking_unit_m": prepared.setup().target.docking_unit.centre_m,
                    "notes": notes,
                });
                let parts = simulator.scene().parts.iter().filter(|part| part.visible);
                let facets: Vec<Facet> = parts
                    .flat_map(|part| &part.facets)
                    .map(|facet| Facet {
                        outer: ring(&facet.outer),
                        holes: facet.holes.iter().map(|hole| ring(hole)).collect(),
                        normal: facet.normal.into(),
                        reflectance: facet.reflectance,
                    })
                    .collect();
                (session, json!({ "facets": facets }))
            }
        };
        Ok(Self { session: bytes(&session)?, scene: bytes(&scene)? })
    }
}

/// A facet of the docking scene, target frame, m.
#[derive(Serialize)]
struct Facet {
    outer: Vec<[f64; 3]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    holes: Vec<Vec<[f64; 3]>>,
    normal: [f64; 3],
    reflectance: f64,
}

fn ring(corners: &[nalgebra::Vector3<f64>]) -> Vec<[f64; 3]> {
    // A tenth of a millimetre is as fine as it is drawn.
    corners.iter().map(|corner| corner.map(|v| (v * 1e4).round() / 1e4).into()).collect()
}

fn camera(name: &str, camera: &Camera) -> Value {
    let (focal_x_px, focal_y_px) = camera.focal_length_px();
    json!({
        "name": name,
        "columns": camera.columns,
        "rows": camera.rows,
        "focal_x_px": focal_x_px,
        "focal_y_px": focal_y_px,
        "principal_x_px": camera.principal_x_px,
        "principal_y_px": camera.principal_y_px,
    })
}

fn bytes(document: &Value) -> Result<Bytes, Failure> {
    serde_json::to_vec(document)
        .map(Bytes::from)
        .map_err(|error| Failure::Usage(format!("the session cannot be written as JSON: {error}")))
}
