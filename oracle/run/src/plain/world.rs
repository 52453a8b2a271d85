//! A plain world as a [`World`].

use std::path::Path;

use contract::Frame;
use files::{Failure, RunDirectory, TableReader, write_png_of_depth};
use scenario::AttitudeChoice;
use scenario::run_file::RunFile;
use score::FigureSpec;

use super::answers::{PlainAnswers, read_answers};
use super::dataset::{PlainDataset, PngImages, open};
use super::pipeline::BuiltIn;
use super::scoring::{CORRECT_RATE, UnitJudgement, UnitScorer, definitions};
use super::{Answer, PlainWorld, Scored};
use crate::any_world::{Options, ScenarioSource};
use crate::frame_jobs::FrameJobs;
use crate::rows_by_number::RowsByNumber;
use crate::world::{
    FactoryOf, OpenDataset, Scorer as _, WorldFacts, WorldFiles, WorldFrames, WorldPipelines, WorldScenario,
    WorldScore, refuse_attitude,
};

/// A plain world with a scenario, ready to run.
pub struct Plain<P: PlainWorld> {
    world: P,
    pub(super) run_file: RunFile<P::Scenario>,
    pub(super) setup: P::Setup,
}

impl<P: PlainWorld> Plain<P> {
    /// Returns the world.
    pub fn world(&self) -> &P {
        &self.world
    }
}

impl<P: PlainWorld> WorldFrames for Plain<P> {
    /// A state may change any exposure.
    const IS_SEQUENTIAL: bool = size_of::<P::State>() > 0;

    type Interface = Self;
    type Exposure = (Frame, P::Truth);
    type Workspace<'a> = ();
    type Truth = P::Truth;
    type State = P::State;

    fn frame_count(&self) -> u64 {
        self.world.frame_count()
    }

    fn setup(&self) -> &P::Setup {
        &self.setup
    }

    /// The size is unknown before the first exposure: that of an image of a megapixel.
    fn exposure_bytes(&self) -> usize {
        1 << 21
    }

    fn workspace(&self) -> Result<(), Failure> {
        Ok(())
    }

    fn expose(&self, (): &mut (), frame: u64, state: &P::State) -> Result<(Frame, P::Truth), Failure> {
        self.world.expose(frame, state)
    }

    fn receive((frame, truth): (Frame, P::Truth), _: &P::State) -> (Frame, (), P::Truth) {
        (frame, (), truth)
    }

    fn advance(&self, state: P::State, _: u64, outcome: &Answer<P::Answer>) -> P::State {
        match outcome {
            Ok(answer) => self.world.advance(state, answer),
            Err(_) => state,
        }
    }
}

impl<P: PlainWorld> WorldScenario for Plain<P> {
    const FACTS: WorldFacts = WorldFacts {
        setup_file: P::SETUP_FILE,
        truth_file: "truth/frames.parquet",
        evidence_file: None,
        headline: CORRECT_RATE,
        are_groups_apart: true,
        pictures: PngImages::WORD,
    };

    type Scenario = P::Scenario;

    fn prepare(source: &ScenarioSource, scenario: &P::Scenario, options: Options) -> Result<Self, Failure> {
        refuse_attitude(options.attitude)?;
        let other = options.inject.map(|stage| format!("--inject {stage}"));
        if let Some(option) = other.or_else(|| Some(format!("--renderer {}", options.renderer.word()?))) {
            return Err(Failure::Usage(format!("the world {} has no {option}", Self::CODE)));
        }
        let world = P::new(scenario).map_err(|error| source.out_of_range(&error))?;
        let run_file = RunFile::new(&source.name, scenario, source.files()?, None, None)?;
        let setup = world.setup();
        Ok(Self { world, run_file, setup })
    }

    fn run_file(&self) -> &RunFile<P::Scenario> {
        &self.run_file
    }
}

impl<P: PlainWorld> WorldPipelines for Plain<P> {
    type Config = ();

    fn config(_: &P::Scenario) -> &() {
        &()
    }

    fn built_in((): &()) -> Result<FactoryOf<Self>, Failure> {
        Ok(Box::new(BuiltIn::<P>::NEW))
    }

    fn write_image(frame: &Frame, (): &(), path: &Path) -> Result<(), String> {
        write_png_of_depth(path, frame).map_err(|error| error.to_string())
    }
}

impl<P: PlainWorld> WorldFiles for Plain<P> {
    const IMAGES: PngImages = PngImages;

    type Images = PngImages;
    type Dataset<'a> = PlainDataset<P>;

    fn check_frame_jobs(&self, frame_jobs: &FrameJobs<PngImages>) -> Result<(), Failure> {
        frame_jobs.refuse_expectation(Self::CODE)?;
        P::pipeline(&self.setup).map(drop).map_err(Failure::from)
    }

    fn dataset<'a>(
        &'a self,
        directory: &'a RunDirectory,
        frame_jobs: &FrameJobs<PngImages>,
    ) -> Result<PlainDataset<P>, Failure> {
        PlainDataset::create(self, directory, frame_jobs.images)
    }

    fn save(
        &self,
        (): &(),
        (frame, _): &(Frame, P::Truth),
        directory: &RunDirectory,
        frame_jobs: &FrameJobs<PngImages>,
    ) -> Result<(), Failure> {
        if frame_jobs.images.is_some() {
            write_png_of_depth(&directory.frame(frame.number(), files::ImageFormat::Png), frame)?;
        }
        Ok(())
    }

    fn open(directory: &Path) -> Result<OpenDataset<Self>, Failure> {
        open::<P>(directory)
    }
}

impl<P: PlainWorld> WorldScore for Plain<P> {
    type Answers = PlainAnswers<P>;
    type Scorer<'a> = UnitScorer<P>;
    type Judgement = UnitJudgement;

    fn figures() -> Vec<FigureSpec> {
        definitions::<P>().into_iter().map(|definition| definition.figure).collect()
    }

    fn scorer(&self) -> UnitScorer<P> {
        UnitScorer::default()
    }

    fn score_files(
        directory: &Path,
        measurements: &Path,
        _: Option<&Path>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<UnitJudgement, Failure> {
        refuse_attitude(attitude)?;
        Ok(UnitScorer(read_scored::<P>(directory, measurements)?).finish())
    }
}

/// Reads the truth of a run directory with the answers in the table `measurements`, in the order of the
/// frames.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or an answer to a frame that the truth does not contain.
pub fn read_scored<P: PlainWorld>(directory: &Path, measurements: &Path) -> Result<Vec<Scored<P>>, Failure> {
    let truth = directory.join(Plain::<P>::FACTS.truth_file);
    let answers = read_answers::<P::Answer>(measurements)?;
    let mut answers = RowsByNumber::new(answers, measurements, "frame", &truth);
    let mut scored = Vec::new();
    for rows in TableReader::<P::Truth>::open(&truth)? {
        let (frame, rows) = rows?;
        let answer = answers.take(frame)?.and_then(Result::ok);
        scored.extend(rows.into_iter().map(|truth| Scored { truth, answer: answer.clone() }));
    }
    answers.end()?;
    Ok(scored)
}
