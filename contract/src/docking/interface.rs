//! Inputs and outputs of a docking pipeline.

use crate::docking::{DockingOutcome, DockingSolution, Field, FieldTelemetry, NoPose, TargetModel};
use crate::{Camera, Interface};

/// Interface of docking pipelines: an approach seen by a television camera.
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
        DockingOutcome::without_pose(NoPose::Failed(reason))
    }

    fn failure(outcome: &DockingOutcome) -> Option<&str> {
        match &outcome.solution {
            DockingSolution::NoSolution(NoPose::Failed(reason)) => Some(reason),
            _ => None,
        }
    }
}

/// Data that a docking pipeline receives before the first field.
#[derive(Debug, Clone, PartialEq)]
pub struct DockingSetup {
    /// Nominal cameras (lenses), at least one; all have the same detector.
    pub cameras: Vec<Camera>,
    /// Bit depth of the digitiser.
    pub bit_depth: u8,
    /// Dimensions of the target.
    pub target: TargetModel,
}
