//! Contents of the field of view: stars, planets, the Moon and the target, as sources with a pixel position
//! and an electron rate.

mod aberration;
mod background;
mod camera_motion;
mod disk;
pub mod docking;
pub(crate) mod earth;
pub(crate) mod moon;
pub(crate) mod planets;
mod source;
mod spacecraft;
mod star_field;

pub use background::{Background, BackgroundConfig, BackgroundField, EarthLightConfig, StrayLightConfig};
pub use camera_motion::CameraMotion;
pub use source::Source;
pub(crate) use spacecraft::Outline;
pub use spacecraft::{Appearance, BoxConfig, Lighting, PlateConfig, Spacecraft, SurfaceConfig, TargetConfig};
pub use star_field::StarField;
