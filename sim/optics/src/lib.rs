//! Optics: the position of a direction on the detector, and the spread of its light there.

mod field;
mod image_blur;
pub mod pixel_factors;
mod projection;
mod psf;
mod radiometry;
pub mod simd_kernel;
pub mod smooth_field;
mod stamp;
mod trail;
mod vignetting;

pub use field::OpticsConfig;
pub use image_blur::ImageBlur;
pub use image_blur::{correlate, gaussian_kernel, pad};
pub use projection::Projection;
pub use psf::{Psf, PsfConfig};
pub use radiometry::{
    KnownDetector, QuantumEfficiency, Radiometry, RadiometryConfig, SUN_B_MINUS_V, SUN_V_MAG_AT_1_AU,
};
pub use stamp::{Stamp, StampTruth};
pub use trail::{ImagePoint, trail};
pub use vignetting::Vignetting;
