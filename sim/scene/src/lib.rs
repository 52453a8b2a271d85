//! Contents of the field of view: stars, planets, the Moon and the target, as sources with a pixel position
//! and an electron rate.

mod aberration;
mod background;
mod camera_motion;
mod disk;
pub mod docking;
pub mod earth;
pub mod moon;
pub mod planets;
pub mod polygon;
pub mod shadow;
mod source;
mod spacecraft;
mod star_field;
mod vibration;

pub use background::{Background, BackgroundConfig, BackgroundField, EarthLightConfig, StrayLightConfig};
pub use camera_motion::CameraMotion;
pub use source::Source;
pub use spacecraft::Outline;
pub use spacecraft::{
    Appearance, BoxConfig, Lighting, MaterialConfig, MeshConfig, NamedPoint, PlateConfig, Spacecraft,
    SurfaceConfig, TargetConfig, TargetShape,
};
pub use star_field::StarField;
pub use vibration::Vibration;
