//! A world of its own, registered in one line: a dot that blinks on a line of pixels. It runs through render, process, run, score, study,
//! gate and report, none of which knows it.

use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Once;

use boresight::failure::Failure;
use boresight::files::{FileError, RunDirectory, WholeFile, toml_file};
use boresight::run::world::{Answers, Dataset, Judgement, Scorer};
use boresight::run::{Flight, Of, OpenDataset, Options, ScenarioSource, World, refuse_attitude, register};
use boresight::run_file::RunFile;
use boresight::scenario::{AttitudeChoice, scenario_file};
use boresight::score::{Definition, Figure, FigureSpec, FigureTerms, Reduction, UnitTable, UnitVerdict};
use contract::{ContractError, Interface, Pipeline, PipelineFactory};
use indexmap::IndexMap;
use pipeline::external::{Protocol, WriteTime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::support::Bench;

const COLUMNS: usize = 32;
const SCENARIO: &str = "world = \"blinking_dot\"\ntitle = \"A dot that blinks\"\nseed = 1\nframes = 300\nnoise_dn = 40\n\n[blinking_dot]\nthreshold_dn = 50\n";

/// What it is about. The dot has 90 DN in two frames of three, noise up to `noise_dn`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scene {
    world: String,
    title: String,
    seed: u64,
    frames: u64,
    noise_dn: u8,
    blinking_dot: Detector,
}

/// Parameters of the built-in pipeline.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Detector {
    threshold_dn: u8,
}

scenario_file!(Scene, "blinking_dot");

impl Scene {
    fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        Vec::new()
    }

    /// Column of the dot, where it is on, and the pixels.
    fn frame(&self, number: u64) -> (Truth, Line) {
        let hash = |place: u64| (self.seed + place + 97 * number).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
        let column = (!number.is_multiple_of(3)).then(|| (number as usize * 7) % COLUMNS);
        let noise = |place: usize| (hash(place as u64) % (u64::from(self.noise_dn) + 1)) as u8;
        let pixels = (0..COLUMNS).map(|place| noise(place) + if column == Some(place) { 90 } else { 0 });
        (Truth { number, column }, Line { number, pixels: pixels.collect() })
    }
}

#[derive(Debug, Clone)]
struct Line {
    number: u64,
    pixels: Vec<u8>,
}

struct Truth {
    number: u64,
    column: Option<usize>,
}

/// A column, no dot, or the reason of a failure.
type Answer = Result<Option<usize>, String>;

/// What its pipelines receive and answer.
enum Blinks {}

impl Interface for Blinks {
    type Setup = usize;
    type Image = Line;
    type Telemetry = ();
    type Outcome = Answer;
    const IMAGE: &'static str = "line";

    fn number(image: &Line) -> u64 {
        image.number
    }

    fn failed(reason: String) -> Answer {
        Err(reason)
    }

    fn failure(outcome: &Answer) -> Option<&str> {
        outcome.as_ref().err().map(String::as_str)
    }
}

impl Protocol for Blinks {
    const EXTENSION: &'static str = "txt";

    fn greeting(columns: &usize) -> Result<Vec<u8>, String> {
        Ok(format!("{}\n", json!({ "columns": columns })).into_bytes())
    }

    fn request(image: &Line, (): &(), _: WriteTime, path: &Path) -> Result<Vec<u8>, String> {
        Ok(format!("{}\n", json!({ "line": image.number, "path": path })).into_bytes())
    }

    fn outcome(answer: &[u8], _: u64, _: &usize) -> Result<Answer, String> {
        serde_json::from_slice(answer).map(Ok).map_err(|error| error.to_string())
    }
}

/// The brightest pixel above a threshold.
impl PipelineFactory<Blinks> for Detector {
    fn name(&self) -> String {
        "blinking_dot".to_owned()
    }

    fn build(&self, _: &usize) -> Result<Box<dyn Pipeline<Blinks>>, ContractError> {
        Ok(Box::new(*self))
    }
}

impl Pipeline<Blinks> for Detector {
    fn process(&mut self, image: &Line, (): &()) -> Answer {
        let brightest = image.pixels.iter().enumerate().max_by_key(|(_, dn)| **dn);
        Ok(brightest.filter(|(_, dn)| **dn > self.threshold_dn).map(|(column, _)| column))
    }
}

/// The one format of images: a table with a line of pixels a row.
#[derive(Clone, Copy)]
struct Table;

impl FromStr for Table {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "csv" { Ok(Self) } else { Err(format!("`{text}` is no format of lines; expected csv")) }
    }
}

/// A scenario, ready to fly.
struct BlinkingDot(RunFile<Scene>);

impl World for BlinkingDot {
    const STARTING_POINT: &'static str = SCENARIO;
    const SETUP_FILE: &'static str = "dot.toml";
    const TRUTH_FILE: &'static str = "truth/dots.csv";
    const EVIDENCE_FILE: Option<&'static str> = None;
    const HEADLINE: &'static str = "correct_rate";
    const IMAGES: Table = Table;
    const PICTURES: &'static str = "csv";

    type Scenario = Scene;
    type Config = Detector;
    type Interface = Blinks;
    type Images = Table;
    type Exposure = (Truth, Line);
    type Workspace<'a> = ();
    type Truth = Truth;
    type Feedback = ();
    type Dataset<'a> = Files<'a>;
    type Answers = AnswerFile;
    type Scorer<'a> = Judge;
    type Judgement = Judge;

    fn prepare(source: &ScenarioSource, scene: &Scene, _: Options) -> Result<Self, Failure> {
        Ok(Self(RunFile::new(&source.name, scene, source.files()?, None, None)?))
    }

    fn run_file(&self) -> &RunFile<Scene> {
        &self.0
    }

    fn config(scene: &Scene) -> &Detector {
        &scene.blinking_dot
    }

    fn built_in(config: &Detector) -> Result<Box<dyn PipelineFactory<Blinks> + Send>, Failure> {
        Ok(Box::new(*config))
    }

    fn write_image(image: &Line, (): &(), path: &Path) -> Result<(), String> {
        std::fs::write(path, format!("{:?}", image.pixels)).map_err(|error| error.to_string())
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let config = toml_file::parse(&directory.join("dot.toml"), &text(&directory.join("dot.toml"))?)?;
        let line = |(number, row): (usize, &str)| {
            Ok((Line { number: number as u64, pixels: row.split(' ').flat_map(str::parse).collect() }, ()))
        };
        let images: Vec<_> = text(&directory.join("lines.csv"))?.lines().enumerate().map(line).collect();
        let count = Some(images.len() as u64);
        Ok(OpenDataset { setup: COLUMNS, config, count, images: Box::new(images.into_iter()) })
    }

    fn telemetry_rows(_: &Path, _: &mut dyn FnMut(&dyn Debug)) -> Result<(), Failure> {
        Ok(())
    }

    fn figures() -> Vec<FigureSpec> {
        figures().into_iter().map(|definition| definition.figure).collect()
    }

    fn frame_count(&self) -> u64 {
        self.scenario().frames
    }

    fn setup(&self) -> &usize {
        &COLUMNS
    }

    fn exposure_bytes(&self) -> usize {
        COLUMNS
    }

    fn workspace(&self) -> Result<(), Failure> {
        Ok(())
    }

    fn expose(&self, (): &mut (), frame: u64) -> Result<(Truth, Line), Failure> {
        Ok(self.scenario().frame(frame))
    }

    fn receive((truth, line): (Truth, Line), (): &()) -> (Line, (), Truth) {
        (line, (), truth)
    }

    fn feedback((): (), _: &Answer) {}

    fn dataset<'a>(&'a self, directory: &'a RunDirectory, _: &Flight<Table>) -> Result<Files<'a>, Failure> {
        self.0.write(&directory.run())?;
        let config = format!("threshold_dn = {}\n", self.scenario().blinking_dot.threshold_dn);
        WholeFile::with_text(&directory.path().join("dot.toml"), &config)?.commit_new()?;
        Ok(Files { directory, lines: String::new(), truth: String::new() })
    }

    fn scorer(&self) -> Judge {
        Judge::default()
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        _: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Judge, Failure> {
        refuse_attitude(attitude)?;
        let answers = text(measurements)?;
        let mut answers = answers.lines().map(|row| row.split_once(' ').unwrap_or_default());
        let mut judge = Judge::default();
        for row in text(&directory.join(Self::TRUTH_FILE))?.lines() {
            let (number, column) = row.split_once(' ').unwrap_or_default();
            let truth = Truth { number: number.parse().unwrap_or_default(), column: column.parse().ok() };
            let answer = answers.find(|(answered, _)| *answered == number).map_or("", |(_, column)| column);
            Scorer::add(&mut judge, &truth, &(), &Ok(answer.parse().ok()))?;
        }
        Ok(judge)
    }
}

fn text(path: &Path) -> Result<String, Failure> {
    toml_file::read_text(path).map_err(|error| Failure::Usage(format!("{}: {error}", path.display())))
}

/// A column, or a dash.
fn word(column: Option<usize>) -> String {
    column.map_or_else(|| "-".to_owned(), |column| column.to_string())
}

struct Files<'a> {
    directory: &'a RunDirectory,
    lines: String,
    truth: String,
}

impl Dataset<BlinkingDot> for Files<'_> {
    fn add(&mut self, line: &Line, (): (), truth: Truth) -> Result<(), FileError> {
        self.lines += &(line.pixels.iter().map(u8::to_string).collect::<Vec<_>>().join(" ") + "\n");
        self.truth += &format!("{} {}\n", truth.number, word(truth.column));
        Ok(())
    }

    fn finish(self) -> Result<(), FileError> {
        WholeFile::with_text(&self.directory.path().join("lines.csv"), &self.lines)?.commit_new()?;
        WholeFile::with_text(&self.directory.path().join("truth/dots.csv"), &self.truth)?.commit_new()
    }
}

struct AnswerFile {
    path: PathBuf,
    text: String,
}

impl Answers<Blinks> for AnswerFile {
    fn files(measurements: &Path) -> Vec<PathBuf> {
        vec![measurements.to_owned()]
    }

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        Ok(Self { path: files.iter().collect(), text: String::new() })
    }

    fn add(&mut self, number: u64, answer: &Answer) -> Result<(), FileError> {
        self.text += &format!("{number} {}\n", word(answer.clone().unwrap_or_default()));
        Ok(())
    }

    fn finish(self) -> Result<(), FileError> {
        WholeFile::with_text(&self.path, &self.text)?.commit_new()
    }
}

/// Judges answers: (true column, answered column) by number.
#[derive(Default)]
struct Judge {
    units: Vec<(u64, Option<usize>, Option<usize>)>,
    score: IndexMap<String, Figure>,
}

type Unit = (u64, Option<usize>, Option<usize>);

fn figures() -> [Definition<'static, Unit>; 2] {
    [
        Definition::rate("correct_rate", "correct rate", |(_, truth, answer): &Unit| Some(truth == answer)),
        Definition::of("column_rms_px", "column RMS", "px", Reduction::Rms, |(_, truth, answer): &Unit| {
            Some((*truth)? as f64 - (*answer)? as f64)
        }),
    ]
}

impl Scorer<BlinkingDot> for Judge {
    fn add(&mut self, truth: &Truth, (): &(), answer: &Answer) -> Result<(), Failure> {
        self.units.push((truth.number, truth.column, answer.clone().unwrap_or_default()));
        let sequence: Vec<&Unit> = self.units.iter().collect();
        self.score = figures().iter().map(|d| (d.figure.name.clone(), d.figure(&[&sequence]))).collect();
        Ok(())
    }

    fn finish(self) -> Self {
        self
    }
}

impl Judgement for Judge {
    type Score = IndexMap<String, Figure>;

    fn score(&self) -> &Self::Score {
        &self.score
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.score
    }

    fn units(&self) -> UnitTable {
        let verdict =
            |(_, truth, answer): &Unit| if truth == answer { "correct" } else { "wrong" }.to_owned();
        let unit = |unit: &Unit| UnitVerdict {
            number: unit.0,
            group: "all".to_owned(),
            verdict: verdict(unit),
            cause: None,
        };
        UnitTable {
            units: self.units.iter().map(unit).collect(),
            figures: figures().iter().map(|figure| FigureTerms::new(figure, &self.units)).collect(),
        }
    }
}

/// Runs the command with these words in this process, which knows the world, and gives its exit status.
fn boresight(words: &str) -> u8 {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| register(&Of::<BlinkingDot>::NEW));
    boresight::command::run_words(["boresight"].into_iter().chain(words.split(' ')).map(Into::into))
}

#[test]
fn a_world_of_its_own_runs_through_everything() {
    let bench = Bench::new();
    let at = |name: &str| bench.path(name).display().to_string();
    let (scenario, run, set) = (at("dot.toml"), at("run"), at("set"));

    assert_eq!(boresight(&format!("scenario new {scenario} --world blinking_dot")), 0);
    assert_eq!(boresight(&format!("scenario check {scenario}")), 0);
    assert_eq!(boresight(&format!("run {scenario} --out {run}")), 0);
    let score: IndexMap<String, Figure> = serde_json::from_str(&bench.read("run/score.json")).unwrap();
    // The noise passes the threshold in no line without a dot, and moves the brightest pixel of none with one.
    assert_eq!(score["correct_rate"].value, Some(1.0));
    assert_eq!((score["column_rms_px"].value, score["column_rms_px"].of), (Some(0.0), 200));
    let report = bench.read("run/report.html");
    assert!(report.contains("A dot that blinks") && report.contains("column_rms_px"));

    // What it rendered gives the same answers, and the same score.
    assert_eq!(boresight(&format!("render {scenario} --out {set}")), 0);
    assert_eq!(boresight(&format!("process {set}")), 0);
    assert_eq!(bench.read("set/measurements.csv"), bench.read("run/measurements.csv"));
    assert_eq!(boresight(&format!("score {run} {set}/measurements.csv")), 0);
    assert_eq!(boresight(&format!("report {run} -o {}", at("report.html"))), 0);

    // A pipeline that takes noise for the dot is worse than the baseline.
    assert_eq!(boresight(&format!("gate baseline {run} --out {} --reason first", at("baseline"))), 0);
    assert_eq!(boresight(&format!("gate {} {run}", at("baseline"))), 0);
    bench.write("low.toml", SCENARIO.replace("threshold_dn = 50", "threshold_dn = 5"));
    assert_eq!(boresight(&format!("run {} --out {}", at("low.toml"), at("low"))), 0);
    assert_eq!(boresight(&format!("gate {} {}", at("baseline"), at("low"))), 1);

    // A study of the threshold.
    let law = "law = { kind = \"choice\", values = [5, 50] }";
    let study = format!(
        "title = \"\"\nscenario = \"dot.toml\"\nseed = 1\n[stop]\ncases = 8\n[[vary]]\npath = \"blinking_dot.threshold_dn\"\n{law}\n"
    );
    bench.write("study.toml", study);
    assert_eq!(boresight(&format!("study run {} --out {}", at("study.toml"), at("study"))), 0);
    let summary: Value = serde_json::from_str(&bench.read("study/summary.json")).unwrap();
    assert_eq!(summary["cases"], 8);
    let words = format!("study replay {} --case 0 --save-frames csv --out {}", at("study.toml"), at("case"));
    let replayed = summary.to_string();
    assert!(replayed.contains("--case 0 --hash ") && replayed.contains(" --save-frames csv"));
    assert_eq!(boresight(&words), 0);
    assert_eq!(boresight(&format!("report {} -o {}", at("study"), at("study.html"))), 0);

    // A world that is not there is refused.
    bench.write("other.toml", SCENARIO.replace("world = \"blinking_dot\"", "world = \"blinking_dott\""));
    assert_eq!(boresight(&format!("run {} --out {}", at("other.toml"), at("other"))), 2);
}
