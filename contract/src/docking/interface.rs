//! What a docking pipeline receives and answers.

use crate::docking::{DockingOutcome, DockingSolution, Field, FieldTelemetry, NoPose, TargetModel};
use crate::{Camera, Interface};

/// The interface of docking pipelines: an approach, as the television camera sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Docking;

impl Interface for Docking {
    type Setup = DockingSetup;
    type Image = Field;
    type Telemetry = FieldTelemetry;
    type Outcome = DockingOutcome;

    const IMAGE: &'static str = "field";

    fn number(field: &Field) -> u64 {
        field.number()
    }

    fn failed(reason: String) -> DockingOutcome {
        DockingOutcome::none(NoPose::Failed(reason))
    }

    fn failure(outcome: &DockingOutcome) -> Option<&str> {
        match &outcome.solution {
            DockingSolution::NoSolution(NoPose::Failed(reason)) => Some(reason),
            _ => None,
        }
    }
}

/// What a docking pipeline knows before the first field.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingSetup {
    /// The nominal cameras (lenses), at least one; all have the same detector.
    pub cameras: Vec<Camera>,
    /// Bits of the digitiser.
    pub bit_depth: u8,
    /// The target's dimensions.
    pub target: TargetModel,
}
