//! Options that only the docking world has.

mod renderer;
mod sequence;

pub(super) use renderer::RendererOptions;
pub(super) use sequence::{SequenceArguments, is_docking, process_sequence};
