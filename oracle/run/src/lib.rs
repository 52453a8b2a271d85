//! Runs: frames are exposed, processed, scored and written in order, the same way in every world ([`world::World`]).

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod any_world;
mod by_number;
mod derived;
pub mod docking;
mod erased;
pub mod far_range;
pub mod flight;
pub mod pipeline_choice;
mod provenance;
mod renderer_choice;
mod run_result;
mod slips;
mod source;
pub mod world;
pub mod worlds;

pub use any_world::{AnyFactory, AnyJudgement, AnyMission, AnyScenario, AnyWorld, Options, ScenarioSource};
pub use docking::DockingMission;
pub use erased::Of;
pub use far_range::{FarRangeMission, SceneTruth};
pub use flight::{Expectation, Flight};
pub use renderer_choice::RendererChoice;
pub use run_result::{AnswerSummary, FirstFailure, NotFlown, RunResult};
pub use source::world_of_run;
pub use world::{
    AnswerCount, FrameAnswer, Judgement, OpenDataset, World, process, process_into, refuse_attitude,
};
pub use worlds::{figure_called, json_schema, register, world_called, worlds};
