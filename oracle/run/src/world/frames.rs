//! Frames of a world: what a camera receives, with its truth.

use contract::Interface;
use files::Failure;
use pipeline::external::Protocol;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Setup that pipelines of a world are built with.
pub type SetupOf<W> = <<W as WorldFrames>::Interface as Interface>::Setup;
/// Image of a world.
pub type ImageOf<W> = <<W as WorldFrames>::Interface as Interface>::Image;
/// Telemetry of an image of a world.
pub type TelemetryOf<W> = <<W as WorldFrames>::Interface as Interface>::Telemetry;
/// Outcome of a pipeline in a world.
pub type OutcomeOf<W> = <<W as WorldFrames>::Interface as Interface>::Outcome;

/// Frames of a scenario: exposed, received, and changed by the outcomes before them.
///
/// An outcome may change the state ([`WorldFrames::State`]) with which later images are received or exposed:
/// a closed loop. Images are received and processed one after the other. Exposures that do not depend on the
/// state are made on any number of threads; the result does not depend on their number. The states of a run
/// are logged ([`crate::sequence`]), so that any frame can be made again alone, bit for bit.
pub trait WorldFrames: Sized + Send + Sync + 'static {
    /// True if an exposure depends on the state: the frames of a run are then exposed one after the other,
    /// each with the state after the frame before. Otherwise only [`WorldFrames::receive`] uses the state.
    const IS_SEQUENTIAL: bool = false;

    /// Input and output of the pipelines.
    type Interface: Protocol;
    /// Result of exposing a frame on a thread, before it is received.
    type Exposure: Send;
    /// Data that a thread reuses from frame to frame.
    type Workspace<'a>
    where
        Self: 'a;
    /// Ground truth of a frame.
    type Truth;
    /// State that outcomes change and later images depend on; `()` for a world without a closed loop.
    type State: Clone + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned;

    /// Returns the number of frames of the whole scenario.
    fn frame_count(&self) -> u64;

    /// Returns the setup that a pipeline receives before the first frame.
    fn setup(&self) -> &SetupOf<Self>;

    /// Returns the size of the pixels of an exposure in memory, bytes.
    fn exposure_bytes(&self) -> usize;

    /// Creates the workspace of a thread.
    ///
    /// # Errors
    /// A [`Failure`] when the workspace cannot be created.
    fn workspace(&self) -> Result<Self::Workspace<'_>, Failure>;

    /// Exposes a frame in a state; its bits depend on these two alone. If exposures do not depend on the
    /// state ([`WorldFrames::IS_SEQUENTIAL`]), it is the default one.
    ///
    /// # Errors
    /// A [`Failure`] when the frame does not exist.
    fn expose(
        &self,
        workspace: &mut Self::Workspace<'_>,
        frame: u64,
        state: &Self::State,
    ) -> Result<Self::Exposure, Failure>;

    /// Returns image, telemetry and ground truth of an exposure, received in a state.
    fn receive(
        exposure: Self::Exposure,
        state: &Self::State,
    ) -> (ImageOf<Self>, TelemetryOf<Self>, Self::Truth);

    /// Returns the state of the next frame, after the outcome of a frame: by default unchanged, for a world
    /// without a closed loop.
    fn advance(&self, state: Self::State, _frame: u64, _outcome: &OutcomeOf<Self>) -> Self::State {
        state
    }

    /// Returns the memory of an image to a workspace.
    fn reuse(_: &mut Self::Workspace<'_>, _: ImageOf<Self>) {}
}
