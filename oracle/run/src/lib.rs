//! Runs: frames are exposed, processed, scored and written in order, in the same way for every world
//! ([`world::World`]).

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
pub mod check;
mod choice;
pub mod frame_jobs;
mod navigation;
pub mod plain;
mod rows_by_number;
mod run_result;
pub mod sequence;
pub mod world;
pub mod worlds;

pub use any_world::source::{check_world_of_run, world_of_run};
pub use any_world::{
    AnyFactory, AnyJudgement, AnyMission, AnyScenario, AnyWorld, ErasedWorld, Options, ScenarioSource,
};
pub use choice::pipeline_choice;
pub use choice::renderer_choice::RendererChoice;
pub use frame_jobs::{Expectation, FrameJobs};
pub use navigation::{NavigationFigure, WorldNavigation, navigation_of, register_navigation};
pub use rows_by_number::RowsByNumber;
pub use run_result::{AnswerSummary, FirstFailure, IncompleteRun, RunResult};
pub use sequence::{AnswerCount, process, process_into};
pub use world::{
    FrameAnswer, Judgement, OpenDataset, World, WorldFacts, WorldFiles, WorldFrames, WorldPipelines,
    WorldScenario, WorldScore, refuse_attitude,
};
pub use worlds::{
    figure_by_name, first_world, json_schema, register, register_figures, world_by_name, worlds,
};
