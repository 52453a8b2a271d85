//! `boresight scenario`: what scenarios and cameras there are, whether one is right, what one may contain, and a start.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

use clap::Subcommand;
use files::Failure;
use run::pipeline_choice::PipelineChoice;
use scenario::{
    BUILT_IN, CAMERAS, DOCKING, DockingScenario, FarRangeScenario, STARTING_POINT, Scenario, ScenarioSource,
    World,
};
use serde_json::json;
use sim::onboard::image_bytes;

use super::Answer;
use super::options::PipelineOptions;
use super::output::Output;

#[derive(Debug, Subcommand)]
pub(super) enum ScenarioCommand {
    /// List the built-in scenarios
    List,
    /// Check a scenario: exit status 0 when it can be run, 1 with the place of the first mistake
    Check {
        /// A built-in scenario or a TOML file
        scenario: String,
        #[command(flatten)]
        pipeline: PipelineOptions,
    },
    /// List the built-in cameras, or print one: the tables [camera] and [sensor], each value with its source
    Camera {
        /// A built-in camera
        name: Option<String>,
    },
    /// Print the JSON Schema of scenario files
    Schema {
        /// Of this world alone: far_range or docking
        #[arg(long, value_name = "WORLD")]
        world: Option<World>,
    },
    /// Write a commented starting point to a file that does not exist yet
    New {
        /// The TOML file to write
        file: PathBuf,
        /// Of this world: far_range or docking
        #[arg(long, value_name = "WORLD", default_value_t = World::FarRange)]
        world: World,
    },
}

pub(super) fn scenario(command: &ScenarioCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        ScenarioCommand::List => list(output),
        ScenarioCommand::Check { scenario, pipeline } => return check(scenario, &pipeline.choice(), output),
        ScenarioCommand::Camera { name: None } => {
            let names: Vec<_> = CAMERAS.iter().map(|camera| camera.name).collect();
            output.answer(&names, names.join("\n"))
        }
        ScenarioCommand::Camera { name: Some(name) } => camera(name, output),
        ScenarioCommand::Schema { world } => {
            let schema = Scenario::json_schema(*world);
            let text = serde_json::to_string_pretty(&schema)
                .map_err(|error| Failure::Usage(format!("the schema cannot be written: {error}")))?;
            output.answer(&schema, text)
        }
        ScenarioCommand::New { file, world } => new(file, *world, output),
    }?;
    Ok(Answer::Yes)
}

fn list(output: &Output) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for built_in in BUILT_IN {
        let source = ScenarioSource::read(built_in.name)?;
        let (frames, unit) = match &source.scenario {
            Scenario::FarRange(scenario) => {
                (scenario.schedule.iter().map(|group| group.count).sum(), "frames")
            }
            Scenario::Docking(scenario) => (source.docking_simulator(scenario)?.field_count(), "fields"),
        };
        rows.push((built_in.name, frames, unit, source.scenario.title().to_owned()));
    }
    let document: Vec<_> = rows
        .iter()
        .map(|(name, frames, _, title)| json!({ "name": name, "frames": frames, "title": title }))
        .collect();
    let text: Vec<_> = rows
        .iter()
        .map(|(name, frames, unit, title)| format!("{name:<16}{frames:>7} {unit}  {title}"))
        .collect();
    output.answer(&document, text.join("\n"))
}

fn camera(name: &str, output: &Output) -> Result<(), Failure> {
    let Some(camera) = CAMERAS.iter().find(|camera| camera.name == name) else {
        let names: Vec<_> = CAMERAS.iter().map(|camera| camera.name).collect();
        return Err(Failure::Usage(format!(
            "`{name}` is no built-in camera; there are: {}",
            names.join(", ")
        )));
    };
    output.answer(&json!({ "name": name, "toml": camera.text }), camera.text.trim_end().to_owned())
}

/// A mistake in a scenario is the answer no; a file that cannot be read is none.
fn check(scenario: &str, choice: &PipelineChoice, output: &Output) -> Result<Answer, Failure> {
    let checked = ScenarioSource::read(scenario).and_then(|source| {
        let checked = match &source.scenario {
            Scenario::FarRange(scenario) => check_far_range(&source, scenario)?,
            Scenario::Docking(scenario) => check_docking(&source, scenario)?,
        };
        choice.check(&source.scenario)?;
        if choice.is_built_in(source.scenario.world())
            && let Scenario::FarRange(scenario) = &source.scenario
        {
            source.check_built_in_pipeline(scenario)?;
        }
        Ok(checked)
    });
    let (document, text) = match checked {
        Err(mistake @ Failure::Toml(_)) => {
            let document = json!({ "scenario": scenario, "ok": false, "error": mistake.to_string() });
            output.answer(&document, mistake.explain())?;
            return Ok(Answer::No);
        }
        checked => checked?,
    };
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

/// What a check tells, for a machine and for a person.
type Checked = (serde_json::Value, String);

fn check_far_range(source: &ScenarioSource, scenario: &FarRangeScenario) -> Result<Checked, Failure> {
    let (simulator, name) = (source.simulator(scenario)?, &source.name);
    let (frames, stars) = (simulator.schedule().frame_count(), simulator.catalog().stars().len());
    let (columns, rows, bit_depth) =
        (scenario.camera.columns, scenario.camera.rows, scenario.sensor.bit_depth);
    let image = image_bytes(columns, rows, bit_depth);
    let (budget, telemetry) = match &scenario.roi {
        None => (image, format!("whole images: {image} bytes of telemetry a frame")),
        Some(roi) => {
            let budget = roi.budget_bytes(bit_depth);
            let regions = format!("{} regions of {} × {} pixels", roi.count, roi.columns, roi.rows);
            (budget, format!("{regions}: {budget} bytes of telemetry a frame at most, a whole image {image}"))
        }
    };
    let document = json!({
        "scenario": name,
        "ok": true,
        "frames": frames,
        "stars": stars,
        "frame_bytes_at_most": budget,
        "whole_image_bytes": image,
    });
    let text = format!("{name}: {frames} frames, {stars} stars, no mistake found\n{telemetry}");
    Ok((document, text))
}

fn check_docking(source: &ScenarioSource, scenario: &DockingScenario) -> Result<Checked, Failure> {
    let simulator = source.docking_simulator(scenario)?;
    let (name, fields, target) = (&source.name, simulator.field_count(), simulator.setup().target);
    let seconds = fields as f64 / simulator.field_rate_hz();
    let document = json!({
        "scenario": name,
        "ok": true,
        "world": "docking",
        "frames": fields,
        "duration_s": seconds,
        "target": target.name,
        "marks": target.marks.len(),
        "cameras": scenario.cameras.len(),
    });
    let text = format!(
        "{name}: {fields} fields in {seconds:.0} s, target {} with {} marks, {} cameras, no mistake found",
        target.name,
        target.marks.len(),
        scenario.cameras.len()
    );
    Ok((document, text))
}

fn new(file: &PathBuf, world: World, output: &Output) -> Result<(), Failure> {
    let refuse =
        |error: std::io::Error| Failure::Usage(format!("{}: cannot be created: {error}", file.display()));
    let mut created = OpenOptions::new().write(true).create_new(true).open(file).map_err(refuse)?;
    let text = match world {
        World::FarRange => STARTING_POINT,
        World::Docking => DOCKING,
    };
    created.write_all(text.as_bytes()).map_err(refuse)?;
    let document = json!({ "file": file });
    output.answer(&document, format!("wrote {0}; try: boresight run {0}", file.display()))
}
