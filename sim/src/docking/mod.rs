//! Simulator of a docking approach: trajectory → scene → lens → television, one function per field.
//!
//! [`DockingSimulator::expose`] makes one field with its truth. The result is bit-identical on any thread and
//! independent of the fields made before.

mod config;
mod geometry;
mod glint;
mod lighting;
mod occlusion;
mod silhouettes;
mod simulator;
mod truth;

pub use config::{CameraConfig, DockingSimulation, LensConfig};
pub use glint::{GlintConfig, GlintImage};
pub use lighting::{FloodlightConfig, LightingConfig, ShadeConfig, SunConfig};
pub use silhouettes::AssemblySilhouette;
pub use simulator::{DockingSimulator, DockingWorkspace, FieldExposure, FieldState};
pub use truth::FieldTruth;

pub use sensor::television::VideoField;
