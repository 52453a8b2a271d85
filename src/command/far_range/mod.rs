//! Commands that only the far-range world has.

mod export;
mod navigate;
mod visibility;

pub(super) use export::{ExportArguments, export};
pub(super) use navigate::{EstimatorName, NavigateArguments, navigate};
pub(super) use visibility::{VisibilityArguments, visibility};
