//! Docking on the page of the monitor.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod report;
mod station_orbit;

use std::any::Any;
use std::path::Path;

use ::monitor::camera;
use ::monitor::feed::{Measurements, MonitorContext, MonitoredWorld, Serve, frames, optional};
use ::monitor::plan::Plan;
use ::monitor::session::Session;
use ::monitor::session::picture::Stretch;
use contract::docking::Digitiser;
use docking::rows::{FeatureRow, FieldTruthRow, read_field_measurements, read_field_telemetry, read_motion};
use docking::{DockingMission, DockingScenario};
use files::{Failure, TableReader};
use hifitime::Epoch;
use run::{WorldFrames as _, WorldScenario as _};
use scenario::run_file::RunFile;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sim::docking::FieldTruth;

use self::report::DockingReporter;
use self::station_orbit::station;

/// Smallest half width of the corridor, m/s.
const MARGIN_M_S: f64 = 0.05;

/// Takes a mission of this world.
pub(crate) fn cast(mission: Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>> {
    let mission = mission.downcast::<DockingMission>()?;
    Ok(Box::new(Monitored(*mission)))
}

/// A mission that the page shows.
struct Monitored(DockingMission);

impl MonitoredWorld for Monitored {
    fn context(&self, measurements: &Measurements) -> Result<MonitorContext, Failure> {
        Ok(MonitorContext {
            ground: station(self.0.simulator()),
            stretch: Stretch::plain(),
            frames: frames::<FieldTruthRow>(measurements, DockingMission::FACTS.truth_file)?,
        })
    }

    fn time(&self, field: u64) -> Option<Epoch> {
        Some(self.0.simulator().field_state(field).ok()?.time)
    }

    fn overview(&self, measurements: &Measurements, context: &MonitorContext) -> Result<[Value; 2], Failure> {
        let (scenario, simulator) = (self.0.scenario(), self.0.simulator());
        let plan = Plan::new("m", &context.frames, MARGIN_M_S, |field| {
            let state = simulator.field_state(field).ok()?.state;
            Some([state.range_m(), state.range_rate_m_s()])
        });
        let cameras: Vec<Value> = scenario.cameras.iter().map(|c| camera(&c.name, &c.camera)).collect();
        let mut notes = Vec::new();
        if let Measurements::Replay(directory) = measurements
            && RunFile::<DockingScenario>::read(&directory.join("run.toml"))?.mitsuba.is_some()
        {
            notes.push("The run used Mitsuba; these pictures are from the fast renderer.");
        }
        if context.ground.is_some() {
            notes.push(
                "The scenario defines no orbit: the ground track is that of an orbit of 51.6° and 370 km \
                 with the scene's direction of the Sun.",
            );
        }
        let session = json!({
            "world": DockingMission::CODE,
            "title": scenario.title,
            "seed": scenario.seed,
            "mode": measurements.mode(),
            "rate_hz": simulator.field_rate_hz(),
            "cameras": cameras,
            "plan": plan,
            "begins": [],
            "docking_unit_m": self.0.setup().target.docking_unit.centre_m,
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
        Ok([session, json!({ "facets": facets })])
    }

    fn feed(
        &self,
        measurements: &Measurements,
        context: &MonitorContext,
        session: &Session,
    ) -> Result<(), Failure> {
        let names = self.0.scenario().cameras.iter().map(|camera| camera.name.clone()).collect();
        let mut reporter = DockingReporter::new(self.0.setup(), names, context.ground.as_ref());
        match measurements {
            Measurements::Live { factory, frames, jobs } => {
                run::sequence::follow(&self.0, frames.clone(), *jobs, factory.downcast()?, |processed| {
                    let number = processed.image.number();
                    session.wait_for_goal(number)?;
                    let features = FeatureRow::from_features(number, &processed.outcome.features);
                    let report = reporter.report(&processed.truth, Some(&processed.outcome), &features);
                    let picture = context.stretch.picture(processed.image.image());
                    session.publish(&report, json!(processed.telemetry.digitiser), Some(picture))
                })
            }
            Measurements::Replay(directory) => replay(directory, &mut reporter, session),
        }
    }

    fn paint(&self, context: &MonitorContext, serve: Serve<'_>) -> Result<(), Failure> {
        let simulator = self.0.simulator();
        let mut workspace = simulator.workspace()?;
        serve(&mut |order| {
            let exposure =
                self.0.renderer().expose(simulator, self.0.setup(), &mut workspace, order.frame)?;
            Ok(context.stretch.picture(exposure.video.digitise(&settings_of(&order.settings)).image()))
        })
    }
}

/// Returns the settings of the digitiser that a field was published with.
fn settings_of(settings: &Value) -> Digitiser {
    Digitiser::deserialize(settings).unwrap_or_default()
}

fn replay(directory: &Path, reporter: &mut DockingReporter<'_>, session: &Session) -> Result<(), Failure> {
    let mut features = optional(&directory.join("features.parquet"))
        .map(|path| TableReader::<FeatureRow>::open(&path))
        .transpose()?;
    let motion = optional(&directory.join("motion.csv")).map(|path| read_motion(&path)).transpose()?;
    let mut motion = motion.unwrap_or_default().into_iter().peekable();
    let mut answers = read_field_measurements(&directory.join("measurements.csv"))?.into_iter().peekable();
    let mut telemetry = read_field_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
    for row in TableReader::<FieldTruthRow>::open(&directory.join("truth/fields.parquet"))? {
        let (number, truths) = row?;
        session.wait_for_goal(number)?;
        let features = features.as_mut().map(|table| table.rows_of(number)).transpose()?.unwrap_or_default();
        let report = motion.next_if(|(reported, _)| *reported == number).map(|(_, report)| report);
        let answer = answers.next_if(|(answered, _)| *answered == number).map(|(_, mut outcome)| {
            outcome.motion = report;
            outcome
        });
        let digitiser = telemetry
            .next_if(|row| row.field == number)
            .map_or_else(Digitiser::default, |row| row.telemetry.digitiser);
        for truth in truths.into_iter().take(1).map(FieldTruth::from) {
            session.publish(&reporter.report(&truth, answer.as_ref(), &features), json!(digitiser), None)?;
        }
    }
    Ok(())
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
    // Coordinates are rounded to the resolution of the drawing, a tenth of a millimetre.
    corners.iter().map(|corner| corner.map(|v| (v * 1e4).round() / 1e4).into()).collect()
}
