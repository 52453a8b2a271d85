//! Conformance checks for every pipeline, built-in or external.

mod docking;
mod far_range;
pub mod navigation;

use crate::{Interface, PipelineFactory};

/// A violation of a contract rule by a pipeline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// Name of the input that revealed the violation.
    pub input: &'static str,
    /// Description of the violation.
    pub broken: String,
}

/// Name of an input, its image and its telemetry.
pub type Input<I> = (&'static str, <I as Interface>::Image, <I as Interface>::Telemetry);

/// An interface that provides inputs for the conformance checks of its pipelines.
pub trait Conformance: Interface {
    /// Returns a short sequence with every kind of image that has caused a failure of a pipeline.
    fn inputs(setup: &Self::Setup) -> Vec<Input<Self>>;

    /// Returns the reason why an outcome is unusable, or `None` for a sound outcome.
    fn violation(outcome: &Self::Outcome, setup: &Self::Setup) -> Option<String>;
}

/// Runs the conformance checks:
///
/// - every kind of image is answered without a panic;
/// - no outcome contains NaN or an impossible value (a position off the detector, a negative variance, a
///   setting that the digitiser does not support);
/// - two fresh pipelines give the same outcomes;
/// - missing images, repeated images and gaps of hours cause no failure.
///
/// # Errors
/// Every violation found, in the order of the inputs.
pub fn check<I: Conformance>(
    factory: &dyn PipelineFactory<I>,
    setup: &I::Setup,
) -> Result<(), Vec<Violation>> {
    let inputs = I::inputs(setup);
    let run = || -> Result<Vec<I::Outcome>, Violation> {
        let mut pipeline =
            factory.build(setup).map_err(|error| Violation { input: "setup", broken: error.to_string() })?;
        Ok(inputs.iter().map(|(_, image, telemetry)| pipeline.process(image, telemetry)).collect())
    };
    let (first, second) = match (run(), run()) {
        (Ok(first), Ok(second)) => (first, second),
        (Err(violation), _) | (_, Err(violation)) => return Err(vec![violation]),
    };
    let mut violations = Vec::new();
    for ((input, _, _), (outcome, again)) in inputs.iter().zip(first.iter().zip(&second)) {
        let mut broke = |broken: String| violations.push(Violation { input, broken });
        if let Some(broken) = I::violation(outcome, setup) {
            broke(broken);
        }
        if outcome != again {
            broke(format!("two new pipelines return different outcomes: {outcome:?} and {again:?}"));
        }
    }
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}
