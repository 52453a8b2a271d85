//! Frames of the far range.

use contract::{FarRange, Frame, Setup, Telemetry};
use files::Failure;
use run::world::WorldFrames;

use super::mission::{FarRangeMission, SceneTruth};

impl WorldFrames for FarRangeMission {
    type Interface = FarRange;
    type Exposure = sim::Exposure;
    type Workspace<'a> = sim::SimulatedCamera<'a>;
    type Truth = SceneTruth;
    /// No feedback: the camera controls its exposure time without the pipeline.
    type State = ();

    fn frame_count(&self) -> u64 {
        self.simulator.schedule().frame_count()
    }

    fn setup(&self) -> &Setup {
        &self.setup
    }

    fn exposure_bytes(&self) -> usize {
        let (columns, rows) = self.simulator.projection().detector();
        columns * rows * size_of::<u16>()
    }

    fn workspace(&self) -> Result<sim::SimulatedCamera<'_>, Failure> {
        Ok(self.simulator.camera()?)
    }

    fn expose(
        &self,
        camera: &mut sim::SimulatedCamera<'_>,
        frame: u64,
        (): &(),
    ) -> Result<sim::Exposure, Failure> {
        Ok(camera.expose(frame)?)
    }

    fn receive(exposure: sim::Exposure, (): &()) -> (Frame, Telemetry, SceneTruth) {
        let sim::Exposure { frame, telemetry, truth, objects } = exposure;
        (frame, telemetry, SceneTruth { frame: truth, objects })
    }

    fn reuse(camera: &mut sim::SimulatedCamera<'_>, frame: Frame) {
        camera.reuse(frame);
    }
}
