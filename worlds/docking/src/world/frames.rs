//! Fields of an approach: drawn as video signals, and digitised with the settings that the pipeline requests.

use contract::Camera;
use contract::docking::{Digitiser, Docking, DockingOutcome, DockingSetup, Field, FieldTelemetry};
use files::Failure;
use run::world::{WorldFrames, WorldScenario as _};
use sim::docking::{DockingWorkspace, FieldExposure, FieldTruth};

use super::mission::DockingMission;

impl WorldFrames for DockingMission {
    type Interface = Docking;
    type Exposure = FieldExposure;
    type Workspace<'a> = DockingWorkspace;
    type Truth = FieldTruth;
    /// Settings of the digitiser.
    type State = Digitiser;

    fn frame_count(&self) -> u64 {
        self.simulator.field_count()
    }

    fn setup(&self) -> &DockingSetup {
        &self.setup
    }

    /// A video signal is stored as f32; a progressive field is a complete frame.
    fn exposure_bytes(&self) -> usize {
        let frame = |camera: &Camera| camera.columns * camera.rows * size_of::<f32>();
        self.setup.cameras.first().map_or(0, frame) / self.scenario().television.interlace.lines(0).step()
    }

    fn workspace(&self) -> Result<DockingWorkspace, Failure> {
        Ok(self.simulator.workspace()?)
    }

    fn expose(
        &self,
        workspace: &mut DockingWorkspace,
        field: u64,
        _: &Digitiser,
    ) -> Result<FieldExposure, Failure> {
        self.renderer.expose(&self.simulator, &self.setup, workspace, field)
    }

    fn receive(exposure: FieldExposure, digitiser: &Digitiser) -> (Field, FieldTelemetry, FieldTruth) {
        (exposure.video.digitise(digitiser), exposure.telemetry(*digitiser), exposure.truth)
    }

    /// Ignores settings that the digitiser does not support.
    fn advance(&self, digitiser: Digitiser, _: u64, outcome: &DockingOutcome) -> Digitiser {
        outcome.digitiser.filter(|wish| wish.check().is_ok()).unwrap_or(digitiser)
    }
}
