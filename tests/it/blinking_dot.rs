//! A separate world, registered in one line: a dot that blinks on a line of pixels. It runs through render,
//! process, run, score, study, gate and report, none of which refers to it.

use std::path::Path;
use std::sync::Once;

use boresight::failure::Failure;
use boresight::files::{AtomicFile, CsvLine, CsvReader, CsvWriter, FileError, RunDirectory, read_csv, table};
use boresight::run::plain::{CsvAnswers, CsvImages, ScoredUnit, UnitJudgement, UnitScorer};
use boresight::run::world::{Dataset, Scorer};
use boresight::run::{
    ErasedWorld, FrameJobs, OpenDataset, Options, RowsByNumber, ScenarioSource, World, refuse_attitude,
    register,
};
use boresight::run_file::RunFile;
use boresight::scenario::{AttitudeChoice, scenario_file};
use boresight::score::{Definition, Figure, FigureSpec, Reduction, UnitVerdict};
use boresight::toml_file;
use contract::{ContractError, Interface, Pipeline, PipelineFactory};
use indexmap::IndexMap;
use pipeline::external::{Protocol, WriteTime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::support::Bench;

const SCENARIO: &str = "world = \"blinking_dot\"\ntitle = \"A dot that blinks\"\nseed = 1\nframes = 300\nnoise_dn = 40\n\n[blinking_dot]\nthreshold_dn = 50\n";

/// The scenario. The dot has 90 DN in two of three frames, and the noise is at most `noise_dn`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scene {
    world: String,
    title: String,
    seed: u64,
    frames: u64,
    noise_dn: u8,
    /// True if the dot moves on by a column after each frame in which the pipeline finds it.
    #[serde(default)]
    flees: bool,
    blinking_dot: Detector,
}

/// Parameters of the built-in pipeline.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Detector {
    threshold_dn: u8,
}

scenario_file!(Scene, "blinking_dot");

table! {
    /// An image.
    #[derive(Debug, Clone)]
    struct Line: csv {
        /// number of the frame
        number: u64,
        /// values of the pixels
        pixels_dn: [f64; 6] = ["p0_dn", "p1_dn", "p2_dn", "p3_dn", "p4_dn", "p5_dn"],
    }
}

table! {
    /// Column of the dot: the true column or the measured one.
    struct Dot: csv {
        /// number of the frame
        number: u64,
        /// column of the dot; none where it is off, or the pipeline failed
        column: Option<u32>,
    }
}

/// A column, no dot, or the reason of a failure.
type Answer = Result<Option<u32>, String>;

impl From<(u64, &Answer)> for Dot {
    fn from((number, answer): (u64, &Answer)) -> Self {
        Self { number, column: answer.clone().unwrap_or_default() }
    }
}

/// Interface of the world's pipelines.
enum Blinks {}

impl Interface for Blinks {
    type Setup = ();
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
    const EXTENSION: &'static str = "csv";

    fn greeting((): &()) -> Result<Vec<u8>, String> {
        Ok(b"{}\n".to_vec())
    }

    fn request(image: &Line, (): &(), _: WriteTime, path: &Path) -> Result<Vec<u8>, String> {
        Ok(format!("{}\n", json!({ "line": image.number, "path": path })).into_bytes())
    }

    fn outcome(answer: &[u8], _: u64, (): &()) -> Result<Answer, String> {
        serde_json::from_slice(answer).map(Ok).map_err(|error| error.to_string())
    }
}

impl PipelineFactory<Blinks> for Detector {
    fn name(&self) -> String {
        "blinking_dot".to_owned()
    }

    fn build(&self, (): &()) -> Result<Box<dyn Pipeline<Blinks>>, ContractError> {
        Ok(Box::new(*self))
    }
}

/// Measures the brightest pixel above a threshold.
impl Pipeline<Blinks> for Detector {
    fn process(&mut self, image: &Line, (): &()) -> Answer {
        let brightest = (0..).zip(image.pixels_dn).max_by(|(_, a), (_, b)| a.total_cmp(b));
        Ok(brightest.filter(|(_, dn)| *dn > f64::from(self.threshold_dn)).map(|(column, _)| column))
    }
}

/// The true and the measured column.
struct Unit(Dot, Dot);

impl ScoredUnit<BlinkingDot> for Unit {
    fn new(truth: &Dot, (): &(), answer: &Answer) -> Self {
        let Dot { number, column } = *truth;
        Self(Dot { number, column }, Dot::from((number, answer)))
    }

    fn definitions() -> Vec<Definition<'static, Self>> {
        vec![
            Definition::rate("correct_rate", "correct rate", |Unit(truth, answer): &Unit| {
                Some(truth.column == answer.column)
            }),
            Definition::amount(
                "column_rms_px",
                "column RMS",
                "px",
                Reduction::Rms,
                |Unit(truth, answer): &Unit| Some(f64::from(truth.column?) - f64::from(answer.column?)),
            ),
        ]
    }

    fn verdict(&self) -> UnitVerdict {
        let verdict = if self.0.column == self.1.column { "correct" } else { "wrong" }.to_owned();
        UnitVerdict { number: self.0.number, group: "all".to_owned(), verdict, cause: None }
    }
}

/// A scenario, ready to run.
struct BlinkingDot(RunFile<Scene>);

impl World for BlinkingDot {
    const STARTING_POINT: &'static str = SCENARIO;
    const SETUP_FILE: &'static str = "dot.toml";
    const TRUTH_FILE: &'static str = "truth/dots.csv";
    const HEADLINE: &'static str = "correct_rate";
    const IMAGES: CsvImages = CsvImages;
    const PICTURES: &'static str = CsvImages::WORD;
    const IS_SEQUENTIAL: bool = true;

    type Scenario = Scene;
    type Config = Detector;
    type Interface = Blinks;
    type Images = CsvImages;
    type Exposure = (Line, Dot);
    type Workspace<'a> = ();
    type Truth = Dot;
    /// Number of columns that the dot has fled.
    type State = u64;
    type Dataset<'a> = Files;
    type Answers = CsvAnswers<Dot>;
    type Scorer<'a> = UnitScorer<Unit>;
    type Judgement = UnitJudgement;

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

    fn figures() -> Vec<FigureSpec> {
        Unit::definitions().into_iter().map(|definition| definition.figure).collect()
    }

    fn frame_count(&self) -> u64 {
        self.scenario().frames
    }

    fn setup(&self) -> &() {
        &()
    }

    fn exposure_bytes(&self) -> usize {
        size_of::<Line>()
    }

    fn workspace(&self) -> Result<(), Failure> {
        Ok(())
    }

    fn expose(&self, (): &mut (), number: u64, fled: &u64) -> Result<(Line, Dot), Failure> {
        let Scene { seed, noise_dn, .. } = *self.scenario();
        let hash = |place: u64| (seed + place + 97 * number).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
        let column = (!number.is_multiple_of(3)).then_some(((number * 7 + fled) % 6) as u32);
        let noise = |place: usize| (hash(place as u64) % (u64::from(noise_dn) + 1)) as f64;
        let light = |place: usize| if column == Some(place as u32) { 90.0 } else { 0.0 };
        let pixels_dn = std::array::from_fn(|place| noise(place) + light(place));
        Ok((Line { number, pixels_dn }, Dot { number, column }))
    }

    fn receive((line, truth): (Line, Dot), _: &u64) -> (Line, (), Dot) {
        (line, (), truth)
    }

    fn advance(&self, fled: u64, _: u64, answer: &Answer) -> u64 {
        fled + u64::from(self.scenario().flees && matches!(answer, Ok(Some(_))))
    }

    fn write_image(image: &Line, (): &(), path: &Path) -> Result<(), String> {
        std::fs::write(path, format!("{:?}", image.pixels_dn)).map_err(|error| error.to_string())
    }

    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        _: &FrameJobs<CsvImages>,
    ) -> Result<Files, Failure> {
        self.0.write(&directory.run())?;
        let config = format!("threshold_dn = {}\n", self.scenario().blinking_dot.threshold_dn);
        AtomicFile::with_text(&directory.path().join(Self::SETUP_FILE), &config)?.commit_new()?;
        let lines = CsvWriter::create(&directory.path().join("lines.csv"))?;
        Ok(Files { lines, truth: CsvWriter::create(&directory.path().join(Self::TRUTH_FILE))? })
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        let setup = directory.join(Self::SETUP_FILE);
        let text = toml_file::read_text(&setup).map_err(|error| Failure::Usage(error.to_string()))?;
        let lines: Vec<Line> = read_csv(&directory.join("lines.csv"))?;
        let (config, count) = (toml_file::parse(&setup, &text)?, Some(lines.len() as u64));
        let images = Box::new(lines.into_iter().map(|line| Ok((line, ()))));
        Ok(OpenDataset { setup: (), config, count, images })
    }

    fn scorer(&self) -> UnitScorer<Unit> {
        UnitScorer::default()
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        _: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<UnitJudgement, Failure> {
        refuse_attitude(attitude)?;
        let truth = directory.join(Self::TRUTH_FILE);
        let answers = CsvReader::open::<Dot>(measurements)?
            .read_rows(|row, _| Dot::read(row).map(|answer| (answer.number, Ok(answer.column))))?;
        let mut answers = RowsByNumber::new(answers, measurements, "number", &truth);
        let mut scorer = UnitScorer::<Unit>::default();
        for dot in read_csv::<Dot>(&truth)? {
            let answer = answers.take(dot.number)?.unwrap_or(Ok(None));
            Scorer::<Self>::add(&mut scorer, &dot, &(), &answer)?;
        }
        answers.end()?;
        Ok(Scorer::<Self>::finish(scorer))
    }
}

struct Files {
    lines: CsvWriter<Line>,
    truth: CsvWriter<Dot>,
}

impl Dataset<BlinkingDot> for Files {
    fn add(&mut self, line: &Line, (): (), truth: Dot) -> Result<(), FileError> {
        self.truth.line(&truth)?;
        self.lines.line(line)
    }

    fn finish(self) -> Result<(), FileError> {
        self.truth.finish()?;
        self.lines.finish()
    }
}

/// Runs the command with these words in this process, in which the world is registered, and returns its exit
/// status.
fn boresight(words: &str) -> u8 {
    static REGISTERED: Once = Once::new();
    boresight::register_worlds();
    REGISTERED.call_once(|| register(&ErasedWorld::<BlinkingDot>::NEW));
    boresight::command::run_words(["boresight"].into_iter().chain(words.split(' ')).map(Into::into))
}

#[test]
fn a_separate_world_runs_through_every_command() {
    let bench = Bench::new();
    let at = |name: &str| bench.path(name).display().to_string();
    let (scenario, run, set) = (at("dot.toml"), at("run"), at("set"));

    assert_eq!(boresight(&format!("scenario new {scenario} --world blinking_dot")), 0);
    assert_eq!(boresight(&format!("scenario check {scenario}")), 0);
    assert_eq!(boresight(&format!("run {scenario} --out {run}")), 0);
    let score: IndexMap<String, Figure> = serde_json::from_str(&bench.read("run/score.json")).unwrap();
    // The noise never exceeds the threshold in a line without a dot, and never moves the brightest pixel in a
    // line with a dot.
    assert_eq!(score["correct_rate"].value, Some(1.0));
    assert_eq!((score["column_rms_px"].value, score["column_rms_px"].of), (Some(0.0), 200));
    let report = bench.read("run/report.html");
    assert!(report.contains("A dot that blinks") && report.contains("column_rms_px"));

    // The rendered dataset gives the same measurements, and the same score.
    assert_eq!(boresight(&format!("render {scenario} --out {set}")), 0);
    assert_eq!(boresight(&format!("process {set}")), 0);
    assert_eq!(bench.read("set/measurements.csv"), bench.read("run/measurements.csv"));
    assert_eq!(boresight(&format!("score {run} {set}/measurements.csv")), 0);
    assert_eq!(boresight(&format!("report {run} -o {}", at("report.html"))), 0);

    // A pipeline that mistakes noise for the dot is worse than the baseline.
    assert_eq!(boresight(&format!("gate baseline {run} --out {} --reason first", at("baseline"))), 0);
    assert_eq!(boresight(&format!("gate {} {run}", at("baseline"))), 0);
    bench.write("low.toml", SCENARIO.replace("threshold_dn = 50", "threshold_dn = 5"));
    assert_eq!(boresight(&format!("run {} --out {}", at("low.toml"), at("low"))), 0);
    assert_eq!(boresight(&format!("gate {} {}", at("baseline"), at("low"))), 1);

    // A study with varying threshold.
    let distribution = "distribution = { kind = \"choice\", values = [5, 50] }";
    let study = format!(
        "title = \"\"\nscenario = \"dot.toml\"\nseed = 1\n[stop]\ncases = 8\n[[vary]]\npath = \"blinking_dot.threshold_dn\"\n{distribution}\n"
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

    // An unknown world is rejected.
    bench.write("other.toml", SCENARIO.replace("world = \"blinking_dot\"", "world = \"blinking_dott\""));
    assert_eq!(boresight(&format!("run {} --out {}", at("other.toml"), at("other"))), 2);
}

/// A trajectory that depends on the answers: the same on any number of threads, logged, and each frame can be
/// made again alone.
#[test]
fn a_frame_that_depends_on_answers_is_made_again_alone() {
    let bench = Bench::new();
    let at = |name: &str| bench.path(name).display().to_string();
    bench.write("flees.toml", SCENARIO.replace("noise_dn = 40", "noise_dn = 40\nflees = true"));
    assert_eq!(boresight(&format!("run {} --jobs 1 --out {}", at("flees.toml"), at("one"))), 0);
    assert_eq!(boresight(&format!("run {} --jobs 3 --out {}", at("flees.toml"), at("three"))), 0);
    let lines = bench.read("one/lines.csv");
    assert_eq!(lines, bench.read("three/lines.csv"));
    assert!(bench.read("one/truth/states.jsonl").starts_with("{\"frame\":2,\"state\":1}\n"));

    // Without answers the dot stays where it is.
    assert_eq!(boresight(&format!("render {} --out {}", at("flees.toml"), at("unanswered"))), 0);
    assert_ne!(lines, bench.read("unanswered/lines.csv"));
    for frame in [0, 1, 2, 100, 299] {
        let again = format!("frame-{frame}");
        let words =
            format!("render {} --frames {frame}..{} --out {}", at("one/run.toml"), frame + 1, at(&again));
        assert_eq!(boresight(&words), 0);
        let line = bench.read(&format!("{again}/lines.csv")).lines().nth(1).unwrap().to_owned();
        assert_eq!(Some(line.as_str()), lines.lines().nth(frame + 1), "frame {frame}");
    }
}
