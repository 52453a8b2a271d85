//! The sensor: expected photoelectrons → charge → digital numbers.
//!
//! Each stage is a separate type: [`render::draw::ExpectedImage`] holds photoelectrons, [`Charge`] adds the
//! electrons that the detector itself collects (dark current, hot pixels) and each pixel's response,
//! [`RawImage`] holds digital numbers. A charge can be obtained only from an image, and digital numbers only
//! from a charge:
//! ```
//! use boresight_sensor::{ExposureInterval, FrameCharge, PixelSampler, RawImage, Sensor};
//! use draws::Seed;
//! use render::draw::ExpectedImage;
//! fn right(sensor: &Sensor, image: &mut ExpectedImage, sampler: &mut PixelSampler, raw: &mut RawImage) {
//!     let seed = Seed { seed: 1, case: 0 };
//!     let charge = sensor.collect(image, &ExposureInterval { seed, middle_s: 0.0, exposure_s: 0.5 });
//!     let _ = sensor.read_out(&FrameCharge { charge: &charge, seed, frame: 0 }, sampler, raw);
//! }
//! ```
//! A readout of photoelectrons does not compile:
//! ```compile_fail,E0308
//! use boresight_sensor::{FrameCharge, PixelSampler, RawImage, Sensor};
//! use draws::Seed;
//! use render::draw::ExpectedImage;
//! fn wrong(sensor: &Sensor, image: &ExpectedImage, sampler: &mut PixelSampler, raw: &mut RawImage) {
//!     let seed = Seed { seed: 1, case: 0 };
//!     let _ = sensor.read_out(&FrameCharge { charge: image, seed, frame: 0 }, sampler, raw);
//! }
//! ```

mod charge;
mod config;
mod cosmic_rays;
mod detector;
mod fixed_pattern;
mod hot_pixels;
mod interlace;
pub mod onboard;
mod pixel;
mod raw_image;
mod readout;
mod rolling_shutter;
mod spill;
mod telegraph;
pub mod television;

pub use charge::{Charge, ExposureInterval};
pub use config::{
    HotPixelConfig, HotPixelDistribution, LineNoiseConfig, NoiseConfig, SensorConfig, TemperatureConfig,
};
pub use cosmic_rays::{CosmicRayConfig, SouthAtlanticConfig};
pub use cosmic_rays::{CosmicRayHit, CosmicRays};
pub use detector::Sensor;
pub use fixed_pattern::{DarkCurrentDistribution, FixedPatternConfig};
pub use hot_pixels::HotPixel;
pub use interlace::{InterlaceConfig, RowParity};
pub use pixel::poisson::poisson;
pub use pixel::sampler::PixelSampler;
pub(crate) use pixel::ziggurat::Ziggurat;
pub use raw_image::RawImage;
pub use readout::{FrameCharge, SparseImage};
pub use rolling_shutter::RollingShutterConfig;
pub use spill::BloomingConfig;
pub use telegraph::TelegraphConfig;

pub use truth::Switch;
