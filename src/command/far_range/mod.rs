//! Commands that only the far-range world has.

mod camera;
mod export;
mod navigate;
mod sky;
mod visibility;

pub(super) use camera::{CameraCommand, CompareArguments, TwinArguments, camera, compare, twin};
pub(super) use export::{ExportArguments, export};
pub(super) use navigate::{EstimatorName, NavigateArguments, navigate};
pub(super) use sky::{SkyArguments, sky};
pub(super) use visibility::{VisibilityArguments, visibility};
