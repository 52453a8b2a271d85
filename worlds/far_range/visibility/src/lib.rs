//! Requirements on a camera: which camera detects enough stars, and the target.
//!
//! A file of requirements ([`RequirementFile`]) names a camera and the demands on it. The report
//! ([`VisibilityReport`]) is computed from the simulator's radiometric models by an analytic detection model,
//! and confirmed by simulated frames that the detector of the far-range method has processed. The simulation
//! thus reveals an error of the detection model, and the model covers conditions that no number of frames
//! could search.
//!
//! - [`RequirementFile`], [`Requirements`]: the requirements as a file states them; read and checked.
//! - [`CameraModel`]: the camera, prepared by the simulator's models.
//! - [`PixelThreshold`], [`ImageShares`], [`DetectionCurve`]: the detection model: of a pixel, of an image,
//!   of stars.
//! - [`Sky`], [`Curves`], [`at_least`]: stars in the field at every boresight, and the number of them that is
//!   detected.
//! - [`TargetModel`], [`TargetObservation`]: the target by range, phase angle and attitude.
//! - [`Design`]: one camera and its result for a demand; [`search`]: the parameter value that meets it;
//!   [`binding`]: the constraint that prevents this.
//! - [`Bench`]: simulated frames.
//! - [`assess`]: combines all of these into a [`VisibilityReport`]; [`write_report`]: writes its files.

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
