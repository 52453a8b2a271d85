//! Ground truth: positions of all objects, and their appearance from the chaser.

mod apparent;
pub mod approach;
mod attitude;
mod attitude_profile;
pub mod catalog;
pub mod clock;
pub mod constants;
mod drift;
mod earth_rotation;
pub mod ecliptic;
pub mod ephemeris;
mod error;
mod guidance;
mod kepler;
mod knowledge;
mod manoeuvre;
mod mean_elements;
pub mod memo;
pub mod moon;
mod mounting;
mod numerical;
mod orbit;
mod planets;
mod relative;
mod sampled;
mod schedule;
pub mod shadow;
mod states;
mod switch;
mod table;
mod target_attitude;
mod trajectory;

pub use apparent::{Observer, StarMotion, aberrate, deflect, unaberrate};
pub use attitude::{Attitude, AttitudeConfig, ControlConfig};
pub use attitude_profile::{AttitudeFunction, AttitudeProfile};
pub use drift::DriftConfig;
pub use earth_rotation::geographic;
pub use error::SimError;
pub use guidance::Guidance;
pub use knowledge::{Knowledge, KnowledgeConfig};
pub use manoeuvre::{
    ManoeuvreAxes, ManoeuvreConfig, ManoeuvreErrorsConfig, ManoeuvreReport, ManoeuvreReportsConfig,
    ManoeuvreTruth, PlannedManoeuvre,
};
pub use mounting::MountingConfig;
pub use numerical::{DragConfig, EarthOrientationConfig, GravityConfig, NumericalConfig, RadiationConfig};
pub use orbit::{
    EARTH_GM_KM3_S2, EARTH_J2, EGM96_RADIUS_KM, Elements, ElementsConfig, Rtn, SecularRates, State,
};
pub use planets::{ApparentPlanet, Planet};
pub use relative::RelativeElements;
pub use sampled::{
    Interpolation, MAX_DEGREE, SampledOrbit, SampledSegment, SampledStates, StateSample, first_node,
};
pub use schedule::{GroupConfig, MAX_FRAMES, Schedule, Sequence};
pub use states::{OrbitConfig, States};
pub use switch::Switch;
pub use table::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
pub use target_attitude::TargetAttitudeConfig;
pub use trajectory::{PropagatedStates, Trajectory, TrajectorySource};
