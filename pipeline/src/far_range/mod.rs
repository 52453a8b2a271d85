//! Far-range method (Benninghoff, Tzschichholz, Boge, Gaias: image processing of the ARGON experiment).
//!
//! Clusters of bright pixels are detected, identified as stars with a list and the spacecraft's attitude, and
//! linked from frame to frame. The cluster whose motion differs from that of all others is the target; its
//! line of sight follows from the camera's attitude, calibrated with the stars. Each step of the paper is one
//! file here; equation numbers are the paper's.

mod aberration;
mod assignment;
mod attitude;
mod background;
mod best;
mod config;
mod detect;
mod hotspots;
mod identify;
mod line_of_sight;
mod method;
mod motion;
mod overrides;
mod pipeline;
mod threshold;
mod track;
mod unusable_frame;

pub use aberration::aberration_correction;
pub use attitude::AttitudeConfig;
pub use best::{
    AttitudePrior, BestConfig, InputMistake, Mounting, PixelOrder, PlateSolution, PlateSolver,
    QuaternionForm, QuaternionOrder, UnmatchedFrame, find_mistake,
};
pub use config::{AberrationConfig, FarRangeConfig, Mode};
pub use detect::Weights;
pub use hotspots::HotspotConfig;
pub use identify::IdentificationConfig;
pub use method::{FarRangeFactory, FarRangePipeline};
pub use overrides::{ApparentPlace, Identity, Overrides};
pub use threshold::ThresholdConfig;
pub use track::TrackingConfig;
