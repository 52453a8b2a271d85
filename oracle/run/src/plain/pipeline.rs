//! Interface of the pipelines of plain worlds, built in and external.

use std::marker::PhantomData;
use std::path::Path;

use contract::{ContractError, Frame, Interface, Pipeline, PipelineFactory};
use pipeline::external::{Protocol, WriteTime};
use serde_json::json;

use super::{Plain, PlainWorld};

/// Answer of a pipeline, or the reason of its failure.
pub type Answer<A> = Result<A, String>;

/// A pipeline of a plain world: it receives the frames of a sequence in order.
pub trait PlainPipeline<A>: Send {
    /// Processes a frame.
    fn process(&mut self, frame: &Frame) -> A;
}

impl<P: PlainWorld> Interface for Plain<P> {
    type Setup = P::Setup;
    type Image = Frame;
    type Telemetry = ();
    type Outcome = Answer<P::Answer>;
    const IMAGE: &'static str = "frame";

    fn number(image: &Frame) -> u64 {
        image.number()
    }

    fn failed(reason: String) -> Answer<P::Answer> {
        Err(reason)
    }

    fn failure(outcome: &Answer<P::Answer>) -> Option<&str> {
        outcome.as_ref().err().map(String::as_str)
    }
}

/// A line of JSON in each direction: the setup; number, bit depth and PNG of a frame; the members of the
/// answer.
impl<P: PlainWorld> Protocol for Plain<P> {
    const EXTENSION: &'static str = "png";

    fn greeting(setup: &P::Setup) -> Result<Vec<u8>, String> {
        let line = serde_json::to_string(&json!({ "setup": setup })).map_err(|error| error.to_string())?;
        Ok((line + "\n").into_bytes())
    }

    fn request(image: &Frame, (): &(), _: WriteTime, path: &Path) -> Result<Vec<u8>, String> {
        let line = json!({ "frame": image.number(), "bit_depth": image.bit_depth(), "image": path });
        Ok(format!("{line}\n").into_bytes())
    }

    fn outcome(answer: &[u8], _: u64, _: &P::Setup) -> Result<Answer<P::Answer>, String> {
        serde_json::from_slice(answer).map(Ok).map_err(|error| error.to_string())
    }
}

/// Builds the built-in pipeline of a plain world.
pub(super) struct BuiltIn<P>(PhantomData<fn() -> P>);

impl<P> BuiltIn<P> {
    pub(super) const NEW: Self = Self(PhantomData);
}

impl<P: PlainWorld> PipelineFactory<Plain<P>> for BuiltIn<P> {
    fn name(&self) -> String {
        <Plain<P> as crate::WorldScenario>::CODE.to_owned()
    }

    fn build(&self, setup: &P::Setup) -> Result<Box<dyn Pipeline<Plain<P>>>, ContractError> {
        Ok(Box::new(Built(P::pipeline(setup)?)))
    }
}

struct Built<A>(Box<dyn PlainPipeline<A>>);

impl<P: PlainWorld> Pipeline<Plain<P>> for Built<P::Answer> {
    fn process(&mut self, image: &Frame, (): &()) -> Answer<P::Answer> {
        Ok(self.0.process(image))
    }
}
