//! Scenario of an approach: its preparation, and the summary of a check.

use files::Failure;
use run::any_world::{Options, ScenarioSource};
use run::check::{FieldOfView, size};
use run::world::{WorldFacts, WorldFrames as _, WorldScenario, refuse_attitude};
use scenario::run_file::RunFile;
use serde_json::{Value, json};
use sim::docking::CameraConfig;
use sim::optics::Projection;

use super::mission::DockingMission;
use super::renderer::DockingRenderer;
use crate::scenario::DockingScenario;
use crate::scoring::names;

impl WorldScenario for DockingMission {
    const FACTS: WorldFacts = WorldFacts {
        setup_file: "setup.toml",
        truth_file: "truth/fields.parquet",
        evidence_file: Some("motion.csv"),
        headline: names::SUCCESS_RATE,
        // An approach is one sequence; its groups are ranges.
        are_groups_apart: false,
        pictures: "png",
    };

    type Scenario = DockingScenario;

    fn prepare(source: &ScenarioSource, _: &DockingScenario, options: Options) -> Result<Self, Failure> {
        refuse_attitude(options.attitude)?;
        match options.inject {
            Some(stage) => Err(Failure::Usage(format!(
                "--inject {stage} does not apply to the world {}, which has no stages to replace",
                Self::CODE
            ))),
            None => Self::new(source, DockingRenderer::new(options.renderer)?),
        }
    }

    fn run_file(&self) -> &RunFile<DockingScenario> {
        &self.run_file
    }

    fn summary(&self) -> (Value, String) {
        let (name, fields, target) = (&self.run_file.name, self.frame_count(), &self.setup.target);
        let (seconds, cameras) =
            (fields as f64 / self.simulator.field_rate_hz(), self.scenario().cameras.len());
        let camera = |camera: &CameraConfig| {
            let Ok(projection) = Projection::new(&camera.camera) else { return (Value::Null, String::new()) };
            let view = FieldOfView::from_projection(&projection);
            let text = format!("\ncamera {}: {}", camera.name, view.text());
            (
                json!({ "name": camera.name, "field_deg": view.field_deg, "pixel_arcsec": view.pixel_arcsec }),
                text,
            )
        };
        let (views, lines): (Vec<Value>, Vec<String>) = self.scenario().cameras.iter().map(camera).unzip();
        let bytes = (self.exposure_bytes() / size_of::<f32>()) as u64;
        let document = json!({
            "scenario": name,
            "ok": true,
            "world": Self::CODE,
            "views": views,
            "field_bytes": bytes,
            "frames": fields,
            "duration_s": seconds,
            "target": target.name,
            "marks": target.marks.len(),
            "cameras": cameras,
        });
        let text = format!(
            "{name}: {fields} fields in {seconds:.0} s, target {} with {} marks, {cameras} cameras, no mistake found{}\n\
             {fields} fields of {} each, uncompressed {} in total",
            target.name,
            target.marks.len(),
            lines.concat(),
            size(bytes),
            size(bytes.saturating_mul(fields)),
        );
        (document, text)
    }
}
