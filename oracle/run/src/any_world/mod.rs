//! Common interface of all worlds, for commands, studies and gates.

mod erased;
mod factory;
mod mission;
mod provenance;
mod scenario;
pub(crate) mod source;
mod world;

use ::scenario::{AttitudeChoice, Stage};

pub use self::factory::AnyFactory;
pub use self::mission::{AnyJudgement, AnyMission};
pub use self::scenario::AnyScenario;
pub use self::source::ScenarioSource;
pub use self::world::{AnyWorld, DatasetAnswers, ErasedWorld, ProcessingOrder};
use crate::choice::renderer_choice::RendererChoice;

/// Options of a run in addition to its scenario. A world refuses options that it does not support.
#[derive(Debug, Default)]
pub struct Options {
    /// Stage of the built-in pipeline whose result is replaced by the truth.
    pub inject: Option<Stage>,
    /// Attitude granted to measurements that have only a centroid; overrides the scenario.
    pub attitude: Option<AttitudeChoice>,
    /// Renderer of the scene.
    pub renderer: RendererChoice,
}
