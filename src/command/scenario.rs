//! `boresight scenario`: list scenarios and cameras, check a scenario, print the schema, write a starting
//! point.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

use clap::Subcommand;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use files::Failure;
use run::pipeline_choice::PipelineChoice;
use run::{AnyWorld, Options, ScenarioSource, first_world, json_schema, world_by_name, worlds};
use scenario::{BUILT_IN, BuiltIn, CAMERAS};
use serde_json::json;

use super::Answer;
use super::options::PipelineOptions;
use super::output::Output;

#[derive(Debug, Subcommand)]
pub(super) enum ScenarioCommand {
    /// List the built-in scenarios
    List,
    /// Check a scenario: exit status 0 if it can be run, 1 with the location of the first mistake
    Check {
        /// A built-in scenario or a TOML file
        scenario: String,
        #[command(flatten)]
        pipeline: PipelineOptions,
    },
    /// List the built-in cameras, or print one: the tables [camera], [sensor], [psf] and [radiometry], each
    /// value with its source
    Camera {
        /// A built-in camera
        name: Option<String>,
    },
    /// Print the JSON Schema of scenario files
    Schema {
        /// Only of this world
        #[arg(long, value_name = "WORLD", value_parser = world_parser())]
        world: Option<&'static dyn AnyWorld>,
    },
    /// Write a commented starting point to a new file
    New {
        /// TOML file to write
        file: PathBuf,
        /// World of the scenario; default: the first of the possible ones
        #[arg(long, value_name = "WORLD", value_parser = world_parser())]
        world: Option<&'static dyn AnyWorld>,
    },
}

/// Returns the parser of the code of a world.
fn world_parser() -> impl TypedValueParser<Value = &'static dyn AnyWorld> {
    let codes: Vec<&str> = worlds().into_iter().map(|world| world.code()).collect();
    PossibleValuesParser::new(codes).try_map(|code| world_by_name(&code))
}

pub(super) fn scenario(command: &ScenarioCommand, output: &Output) -> Result<Answer, Failure> {
    match command {
        ScenarioCommand::List => list(output),
        ScenarioCommand::Check { scenario, pipeline } => {
            return check(scenario, &pipeline.choice(&[]), output);
        }
        ScenarioCommand::Camera { name: None } => {
            let names: Vec<_> = CAMERAS.iter().map(|camera| camera.name).collect();
            let lines: Vec<_> = CAMERAS.iter().map(described).collect();
            output.answer(&names, lines.join("\n"))
        }
        ScenarioCommand::Camera { name: Some(name) } => camera(name, output),
        ScenarioCommand::Schema { world } => {
            let schema = json_schema(*world);
            let text = serde_json::to_string_pretty(&schema)
                .map_err(|error| Failure::Usage(format!("the schema cannot be written: {error}")))?;
            output.answer(&schema, text)
        }
        ScenarioCommand::New { file, world } => new(file, world.map_or_else(first_world, Ok)?, output),
    }?;
    Ok(Answer::Yes)
}

fn list(output: &Output) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for built_in in BUILT_IN {
        let source = ScenarioSource::read(built_in.name)?;
        let frames = source.prepare(Options::default())?.frame_count();
        let unit = format!("{}s", source.world().image());
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

/// Returns the name of a camera with the first sentence of the comment at the top of its file.
fn described(camera: &BuiltIn) -> String {
    let comment = camera.text.lines().map_while(|line| line.strip_prefix("# "));
    let words = comment.collect::<Vec<_>>().join(" ");
    let sentence = words.split_once(". ").map_or(words.as_str(), |(first, _)| first);
    format!("{:<24}{}", camera.name, sentence.trim_end_matches('.'))
}

fn camera(name: &str, output: &Output) -> Result<(), Failure> {
    let Some(camera) = CAMERAS.iter().find(|camera| camera.name == name) else {
        let names: Vec<_> = CAMERAS.iter().map(|camera| camera.name).collect();
        return Err(Failure::Usage(format!(
            "`{name}` is not a built-in camera; built-in cameras: {}",
            names.join(", ")
        )));
    };
    output.answer(&json!({ "name": name, "toml": camera.text }), camera.text.trim_end().to_owned())
}

/// Checks a scenario. A mistake in it, or in a file that it names, gives the negative result; a scenario that
/// cannot be read is a failure instead.
fn check(scenario: &str, choice: &PipelineChoice, output: &Output) -> Result<Answer, Failure> {
    let checked = ScenarioSource::read(scenario).and_then(|source| {
        let prepared = source.prepare(Options::default())?;
        source.world().check_choice(&source.scenario, choice)?;
        if choice.is_built_in(source.world().code()) {
            source.world().check_built_in(&source)?;
        }
        Ok((prepared.summary(), prepared.warnings()))
    });
    let ((mut document, mut text), warnings) = match checked {
        Err(mistake @ (Failure::Toml(_) | Failure::File(_) | Failure::Simulation(_))) => {
            let document = json!({ "scenario": scenario, "ok": false, "error": mistake.to_string() });
            output.answer(&document, mistake.explain())?;
            return Ok(Answer::No);
        }
        checked => checked?,
    };
    for warning in &warnings {
        text += &format!("\nwarning: {warning}");
    }
    if let Some(document) = document.as_object_mut() {
        document.insert("warnings".to_owned(), json!(warnings));
    }
    output.answer(&document, text)?;
    Ok(Answer::Yes)
}

fn new(file: &PathBuf, world: &dyn AnyWorld, output: &Output) -> Result<(), Failure> {
    let refuse =
        |error: std::io::Error| Failure::Usage(format!("{}: cannot be created: {error}", file.display()));
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(refuse)?;
    }
    let mut created = OpenOptions::new().write(true).create_new(true).open(file).map_err(refuse)?;
    created.write_all(world.starting_point().as_bytes()).map_err(refuse)?;
    let document = json!({ "file": file });
    output.answer(&document, format!("wrote {0}; try: boresight run {0}", file.display()))
}
