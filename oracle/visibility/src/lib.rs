//! Requirements: which camera sees enough stars, and the target.
//!
//! A file of requirements ([`RequirementFile`]) names a camera and what is demanded of it. The answer ([`VisibilityReport`]) is
//! computed from the simulator's models of light by an analytic detection model, and confirmed by frames of the simulator that the detector of the
//! far-range method has looked at: so a mistake of the detection model is seen by the simulation, and what no number of frames could search is
//! found by the detection model.
//!
//! - [`RequirementFile`], [`Requirements`]: what is asked; read and checked.
//! - [`CameraModel`]: the camera, prepared by the simulator's models.
//! - [`PixelThreshold`], [`ImageShares`], [`DetectionCurve`]: the detection model: of a pixel, of an image, of stars.
//! - [`Sky`], [`Curves`], [`at_least`]: stars in the field at every boresight, and how many of them are detected.
//! - [`TargetModel`], [`TargetObservation`]: the target by range, phase angle and attitude.
//! - [`Design`]: one camera and what it reaches of a demand; [`search`]: the parameter that reaches it; [`binding`]: why none does.
//! - [`Bench`]: simulated frames.
//! - [`assess`]: all of it, into a [`VisibilityReport`]; [`write_report`]: its files.

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

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod assess;
mod camera;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod confirm;
mod design;
mod detection_model;
mod report;
mod requirement;
mod sky;
mod target;

pub use assess::{assess, digits};
pub use camera::{CameraConfig, CameraModel, mean_motion_rad_s};
pub use confirm::{Bench, StarFrame, StarTrial};
pub use design::binding::{binding, binding_of};
pub use design::inverse::{FoundValue, Search, resolvable, search};
pub use design::{AspectGroup, Design, DesignPerformance, between};
pub use detection_model::detection::{
    DetectionCurve, FrameThresholds, ImageShares, background_e, is_flooded,
};
pub use detection_model::pixel::{PixelThreshold, readout_e};
pub use detection_model::poisson_binomial::at_least;
pub use report::write::{read_sky, tables, write_report};
pub use report::{
    CameraFigures, DetectionPoint, LimitPoint, PointingStars, RangeByPhase, SearchResult, SimulatedPoint,
    SimulatedRate, SkySummary, StarsLost, Status, Verdict, VisibilityReport, WindowPoint,
};
pub use requirement::definition::{BUILT_IN_REQUIREMENTS, Requirements};
pub use requirement::{
    CameraTable, ConfirmTable, Demand, DetectionRule, ExposureTable, Extreme, FindTable, MotionGuidance,
    MotionTable, Parameter, Requirement, RequirementFile, SkyStatistic, SkyTable, SkyTime, TargetLight,
    TargetTable,
};
pub use sky::star_count::{Curves, StarCount, over_sky, star_trail_px};
pub use sky::{Exclusion, Field, Pointing, Sky, SkyStar};
pub use target::{Aspect, Setting, TargetModel, TargetObservation, TargetSignal};
