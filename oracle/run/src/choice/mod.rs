//! Choice of the pipeline and of the renderer.

pub mod pipeline_choice;
pub(crate) mod renderer_choice;
