//! Error budget: the result of one stage is replaced by the truth, which shows the error contribution of that
//! stage.
use contract::{Direction, Frame, Icrs, ListedStar, Outcome, PixelPoint, Setup, Telemetry};
use files::Failure;
use pipeline::far_range::{FarRangeConfig, FarRangePipeline, Identity, Overrides};
use run::world::InformedPipeline;
use scenario::Stage;
use sim::truth::{ObjectKind, Observer};

use super::{FarRangeMission, SceneTruth};
use crate::scoring::brightest_member;

/// The built-in pipeline with the result of one stage replaced by the truth.
#[derive(Debug)]
pub(super) struct InjectedPipeline {
    stage: Stage,
    pipeline: FarRangePipeline,
}

impl InjectedPipeline {
    /// Creates a pipeline in its initial state.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the configuration or the setup is invalid for the pipeline.
    pub(super) fn new(stage: Stage, config: &FarRangeConfig, setup: &Setup) -> Result<Self, Failure> {
        let pipeline = FarRangePipeline::new(config.clone(), setup)
            .map_err(|error| Failure::Usage(error.to_string()))?;
        Ok(Self { stage, pipeline })
    }
}

impl InformedPipeline<FarRangeMission> for InjectedPipeline {
    fn process(
        &mut self,
        frame: &Frame,
        telemetry: &Telemetry,
        SceneTruth { frame: truth, objects }: &SceneTruth,
    ) -> Result<Outcome, Failure> {
        let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s)?;
        // A true position off the detector would not be a detection; the cluster then keeps the measured
        // position.
        let centroid = |centre: PixelPoint| {
            brightest_member(centre, objects)
                .map(|object| object.position)
                .filter(|place| place.is_on_detector(frame.columns(), frame.rows()))
        };
        // The cluster keeps its own error; only the offset of the centre of brightness is taken away.
        let of_mass = |centre: PixelPoint| {
            let target =
                brightest_member(centre, objects).filter(|object| object.kind == ObjectKind::Target)?;
            let (mass, brightness) = (truth.target_position?, target.position);
            Some(PixelPoint::new(centre.x + mass.x - brightness.x, centre.y + mass.y - brightness.y))
                .filter(|place| place.is_on_detector(frame.columns(), frame.rows()))
        };
        let identity = |centre: PixelPoint| match brightest_member(centre, objects) {
            Some(object) if object.kind == ObjectKind::Star => Identity::Star(object.id),
            Some(object) if object.kind == ObjectKind::HotPixel => Identity::Hotspot,
            _ => Identity::Neither,
        };
        let apparent =
            |star: &ListedStar| -> Direction<Icrs> { observer.apparent_from_astrometric(star.direction) };
        let own = Overrides::default();
        let overrides = match self.stage {
            Stage::Centroids => Overrides { centroid: Some(&centroid), ..own },
            Stage::Identities => Overrides { identity: Some(&identity), ..own },
            Stage::Attitude => Overrides { camera_from_icrs: Some(truth.camera_from_icrs), ..own },
            Stage::Brightness => Overrides { centroid: Some(&of_mass), ..own },
            Stage::Aberration => Overrides { apparent: Some(&apparent), ..own },
            // This stage is replaced in the frames themselves.
            Stage::Roi => own,
        };
        Ok(self.pipeline.process_with(frame, telemetry, &overrides))
    }
}
