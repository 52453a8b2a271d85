//! The interface of docking pipelines.

use crate::docking::{DockingOutcome, Field, FieldTelemetry, TargetModel};
use crate::{Camera, ContractError};

/// A pipeline that monitors a docking approach.
///
/// Built fresh for each sequence of fields, and given them in order; fields may be missing. It must answer every field,
/// and what it answers must hold no NaN: see [`crate::conformance`].
pub trait DockingPipeline: Send {
    /// Answers one field.
    fn process(&mut self, field: &Field, telemetry: &FieldTelemetry) -> DockingOutcome;
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

/// Builds docking pipelines, one a sequence.
pub trait DockingPipelineFactory: Sync {
    /// Name, for tables and logs.
    fn name(&self) -> String;

    /// A fresh pipeline that has seen no field.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] when the setup or the pipeline's own configuration does not allow it.
    fn build(&self, setup: &DockingSetup) -> Result<Box<dyn DockingPipeline>, ContractError>;
}
