//! Checks that any pipeline must pass, whoever wrote it.

mod docking;
mod far_range;

use crate::{Interface, PipelineFactory};

/// A rule of the contract that a pipeline broke.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// The input that showed it.
    pub input: &'static str,
    /// What was wrong with the answer.
    pub broken: String,
}

/// A name, an image and its telemetry.
pub type Input<I> = (&'static str, <I as Interface>::Image, <I as Interface>::Telemetry);

/// An interface with the sequence that its pipelines are checked on.
pub trait Conformance: Interface {
    /// A short sequence with every kind of image that has broken a pipeline.
    fn inputs(setup: &Self::Setup) -> Vec<Input<Self>>;

    /// What makes an answer unusable, if anything does.
    fn violation(outcome: &Self::Outcome, setup: &Self::Setup) -> Option<String>;
}

/// Runs the checks: every kind of image is answered without a panic, no answer holds a NaN or what cannot be (a place off the detector,
/// a negative variance, a setting that no digitiser has), two fresh pipelines give the same answers, and images that are missing,
/// repeated or hours apart do not disturb it.
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
            broke(format!("two fresh pipelines disagree: {outcome:?} and {again:?}"));
        }
    }
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}
