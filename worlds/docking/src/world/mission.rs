//! A docking scenario that is ready to run.

use config::toml_file;
use contract::docking::DockingSetup;
use files::Failure;
use run::any_world::ScenarioSource;
use scenario::run_file::RunFile;
use sim::docking::DockingSimulator;
use sim::scene::docking::TargetFile;

use super::renderer::DockingRenderer;
use crate::scenario::DockingScenario;

/// A docking scenario with its simulator, ready to run.
pub struct DockingMission {
    pub(super) simulator: DockingSimulator,
    pub(super) setup: DockingSetup,
    pub(super) renderer: DockingRenderer,
    pub(super) run_file: RunFile<DockingScenario>,
}

impl DockingMission {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value.
    pub fn new(source: &ScenarioSource, renderer: DockingRenderer) -> Result<Self, Failure> {
        let scenario = source.typed::<DockingScenario>("docking")?;
        let simulator = simulator(source, scenario)?;
        let mut run_file = RunFile::new(&source.name, scenario, source.files()?, None, None)?;
        run_file.mitsuba = renderer.record().cloned();
        Ok(Self { setup: simulator.setup(), simulator, renderer, run_file })
    }

    /// Returns the simulator of the fields, which draws them with the fast renderer.
    pub fn simulator(&self) -> &DockingSimulator {
        &self.simulator
    }

    /// Returns the renderer of the scene.
    pub fn renderer(&self) -> &DockingRenderer {
        &self.renderer
    }

    /// Draws a field and discards it, to check the renderer before anything is written.
    pub(super) fn probe(&self, field: u64) -> Result<(), Failure> {
        let mut workspace = self.simulator.workspace()?;
        self.renderer.expose(&self.simulator, &self.setup, &mut workspace, field)?;
        Ok(())
    }
}

/// Creates the simulator of a scenario that was read from `source`. All values are checked, including those
/// of the target's file.
///
/// # Errors
/// A [`Failure`] with the location of the first invalid value.
pub fn simulator(source: &ScenarioSource, scenario: &DockingScenario) -> Result<DockingSimulator, Failure> {
    source.check_part("docking", scenario.docking.check())?;
    check_target(source, &scenario.target)?;
    DockingSimulator::new(&scenario.simulation(), &source.folder).map_err(|error| source.explain(error))
}

/// Checks the target's file, so that a mistake in it is reported with its location in that file.
fn check_target(source: &ScenarioSource, target: &str) -> Result<(), Failure> {
    if TargetFile::built_in(target).is_some() {
        return Ok(());
    }
    let file = source.folder.join(target);
    let text = toml_file::read_text(&file).map_err(|error| {
        let word = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let hint = toml_file::nearest(&word, TargetFile::built_in_names()).map_or_else(
            || format!("built-in targets: {}", TargetFile::built_in_names().collect::<Vec<_>>().join(", ")),
            |name| format!("did you mean `{name}`?"),
        );
        let problem =
            format!("is neither a built-in target nor a TOML file that can be read ({error}); {hint}");
        source.refuse("target", format!("`{}` {problem}", file.display()))
    })?;
    let parsed: TargetFile = toml_file::parse(&file, &text)?;
    parsed.check().map_err(|error| toml_file::out_of_range(&file, &text, &error).into())
}
