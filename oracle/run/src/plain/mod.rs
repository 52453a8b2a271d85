//! Plain worlds: a world whose frames are images without telemetry, with one row of truth and one row of the
//! answer each. [`Plain`] makes a [`World`](crate::World) of a [`PlainWorld`]: its files, the protocol of
//! external pipelines, scores, studies and gates are common.
//!
//! Files of a run: `run.toml`, the setup file, `telemetry.csv` (frame, image, bit depth), `frames/*.png`,
//! `truth/frames.parquet`, `measurements.csv` (frame, status, columns of the answer), `score.json`.

mod answers;
mod dataset;
mod pipeline;
mod scoring;
mod world;

use std::fmt::Debug;

use contract::{Frame, OutOfRange};
use files::{CsvLine, Failure, Row};
use scenario::run_file::ScenarioFile;
use score::Definition;
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use self::pipeline::{Answer, PlainPipeline};
pub use self::scoring::{Scored, UnitJudgement};
pub use self::world::{Plain, read_scored};

/// A world of images, each with a row of truth and a row of the answer.
pub trait PlainWorld: Sized + Send + Sync + 'static {
    /// File of a dataset with the data that a pipeline receives before the first frame, unique to the world.
    const SETUP_FILE: &'static str;

    /// Scenarios of the world.
    type Scenario: ScenarioFile;
    /// Data that a pipeline receives before the first frame, with the parameters of the built-in one: the
    /// setup file, and the greeting of an external program.
    type Setup: Clone + Debug + Send + Sync + Serialize + DeserializeOwned;
    /// Row of `truth/frames.parquet`.
    type Truth: Row + Clone + Send + Sync;
    /// Answer of a pipeline: its columns in `measurements.csv`, and its members in the JSON of a program.
    type Answer: CsvLine + Clone + Debug + PartialEq + Send + DeserializeOwned + 'static;
    /// State that answers change and later frames depend on; `()` for a world without a closed loop.
    type State: Clone + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned;

    /// Checks all values of a scenario and prepares its simulator.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value, by its path in the scenario.
    fn new(scenario: &Self::Scenario) -> Result<Self, OutOfRange>;

    /// Returns what a pipeline receives before the first frame.
    fn setup(&self) -> Self::Setup;

    /// Returns the number of frames of the scenario.
    fn frame_count(&self) -> u64;

    /// Makes a frame in a state, with its truth; their bits depend on number and state alone.
    ///
    /// # Errors
    /// A [`Failure`] when the frame cannot be made.
    fn expose(&self, frame: u64, state: &Self::State) -> Result<(Frame, Self::Truth), Failure>;

    /// Returns the state of the next frame, after the answer to a frame: by default unchanged.
    fn advance(&self, state: Self::State, _answer: &Self::Answer) -> Self::State {
        state
    }

    /// Builds the built-in pipeline.
    ///
    /// # Errors
    /// [`OutOfRange`] for a parameter outside its range.
    fn pipeline(setup: &Self::Setup) -> Result<Box<dyn PlainPipeline<Self::Answer>>, OutOfRange>;

    /// Returns the verdict on a frame, `correct` or another word, and its cause.
    fn judge(scored: &Scored<Self>) -> (&'static str, Option<String>);

    /// Returns the figures of the score after `correct_rate`, the fraction of verdicts that are `correct`.
    fn figures() -> Vec<Definition<'static, Scored<Self>>>;
}
