//! Which pipeline runs, and who draws.

pub mod pipeline_choice;
pub(crate) mod renderer_choice;
