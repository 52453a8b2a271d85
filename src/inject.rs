//! An error budget: the truth in the place of one stage's result, to see what that stage costs.

use std::fmt;

use clap::ValueEnum;
use contract::{Direction, Icrs, ListedStar, Outcome, PixelPoint, Setup};
use pipeline::far_range::{FarRange, FarRangeConfig, Identity, Overrides};
use serde::{Deserialize, Serialize};
use sim::Exposure;
use sim::truth::{ObjectKind, Observer};

use crate::failure::Failure;
use crate::score::belonging_to;

/// The stage whose result is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Every cluster is where the object is that it belongs to
    Centroids,
    /// Every cluster is known for a star (and which), a hotspot or neither
    Identities,
    /// The camera's attitude is the true one
    Attitude,
    /// Whole images are transmitted: the scenario without its regions of interest
    Roi,
    /// The listed stars are where aberration and deflection make them appear, and nothing is corrected
    Aberration,
}

impl fmt::Display for Stage {
    /// The word of the command line and of files.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Centroids => "centroids",
            Self::Identities => "identities",
            Self::Attitude => "attitude",
            Self::Roi => "roi",
            Self::Aberration => "aberration",
        })
    }
}

/// The built-in pipeline with the truth in the place of one stage's result.
#[derive(Debug)]
pub struct InjectedPipeline {
    stage: Stage,
    pipeline: FarRange,
}

impl InjectedPipeline {
    /// A pipeline that has seen no frame.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the configuration or the setup does not allow the pipeline.
    pub fn new(stage: Stage, config: &FarRangeConfig, setup: &Setup) -> Result<Self, Failure> {
        let pipeline =
            FarRange::new(config.clone(), setup).map_err(|error| Failure::Usage(error.to_string()))?;
        Ok(Self { stage, pipeline })
    }

    /// Answers a frame, with its truth at hand for the one stage.
    ///
    /// # Errors
    /// [`Failure::Simulation`] for a chaser where none can be.
    pub fn answer(&mut self, exposure: &Exposure) -> Result<Outcome, Failure> {
        let (frame, truth) = (&exposure.frame, &exposure.truth);
        let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s)?;
        // A place beside the detector would be no detection: there the cluster keeps its own.
        let centroid = |centre: PixelPoint| {
            belonging_to(centre, &exposure.objects)
                .map(|object| object.position)
                .filter(|place| place.is_on_detector(frame.columns(), frame.rows()))
        };
        let identity = |centre: PixelPoint| match belonging_to(centre, &exposure.objects) {
            Some(object) if object.kind == ObjectKind::Star => Identity::Star(object.id),
            Some(object) if object.kind == ObjectKind::HotPixel => Identity::Hotspot,
            _ => Identity::Neither,
        };
        let apparent = |star: &ListedStar| -> Direction<Icrs> { observer.apparent_of(star.direction) };
        let own = Overrides::default();
        let overrides = match self.stage {
            Stage::Centroids => Overrides { centroid: Some(&centroid), ..own },
            Stage::Identities => Overrides { identity: Some(&identity), ..own },
            Stage::Attitude => Overrides { camera_from_icrs: Some(truth.camera_from_icrs), ..own },
            Stage::Aberration => Overrides { apparent: Some(&apparent), ..own },
            // The frames themselves are other ones.
            Stage::Roi => own,
        };
        Ok(self.pipeline.process_with(frame, &exposure.telemetry, &overrides))
    }
}
