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
mod check;
mod choice;
pub mod docking;
pub mod far_range;
pub mod flight;
pub mod plain;
mod run_result;
pub mod world;
pub mod worlds;

pub use any_world::erased::Of;
pub use any_world::source::world_of_run;
pub use any_world::{AnyFactory, AnyJudgement, AnyMission, AnyScenario, AnyWorld, Options, ScenarioSource};
pub use by_number::ByNumber;
pub use choice::pipeline_choice;
pub use choice::renderer_choice::RendererChoice;
pub use docking::DockingMission;
pub use far_range::{FarRangeMission, SceneTruth};
pub use flight::{Expectation, Flight};
pub use run_result::{AnswerSummary, FirstFailure, NotFlown, RunResult};
pub use world::{
    AnswerCount, FrameAnswer, Judgement, OpenDataset, World, process, process_into, refuse_attitude,
};
pub use worlds::{figure_called, json_schema, register, world_called, worlds};
