//! A world: the parts in which runs differ. The run itself is the same for every world ([`crate::sequence`]).

mod files;
mod frames;
mod pipelines;
mod scenario;
mod score;

use ::files::Failure;
use ::scenario::AttitudeChoice;

pub use self::files::{Dataset, Images, OpenDataset, WorldFiles};
pub use self::frames::{ImageOf, OutcomeOf, SetupOf, TelemetryOf, WorldFrames};
pub use self::pipelines::{FactoryOf, InformedPipeline, WorldPipelines};
pub use self::scenario::{WorldFacts, WorldScenario};
pub use self::score::{Answers, Judgement, Scorer, WorldScore, paths, unscorable};

/// A scenario with its simulator, ready to run: the world-specific parts of a run, in five groups. Every type
/// with these is a world; functions without a default are those in which worlds differ.
pub trait World: WorldFrames + WorldScenario + WorldPipelines + WorldFiles + WorldScore {}

impl<W: WorldFrames + WorldScenario + WorldPipelines + WorldFiles + WorldScore> World for W {}

/// An image of a run with the outcome of the pipeline.
pub struct FrameAnswer<W: WorldFrames> {
    /// Image as received.
    pub image: ImageOf<W>,
    /// Telemetry that the pipeline received.
    pub telemetry: TelemetryOf<W>,
    /// Ground truth.
    pub truth: W::Truth,
    /// Outcome of the pipeline.
    pub outcome: OutcomeOf<W>,
}

/// Refuses to grant an attitude in a world whose measurements are not lines of sight.
///
/// # Errors
/// [`Failure::Usage`] when an attitude is requested.
pub fn refuse_attitude(attitude: Option<AttitudeChoice>) -> Result<(), Failure> {
    attitude.map_or(Ok(()), |_| {
        Err(Failure::Usage("--attitude requires a world whose measurements are lines of sight".to_owned()))
    })
}
