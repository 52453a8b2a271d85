//! On board: shutter control, regions of interest, and what is sent to the ground.

mod downlink;
mod roi;
mod shutter;

pub(crate) use downlink::downlink_in;
pub use downlink::{downlink, downlink_bytes, image_bytes};
pub use roi::{RoiConfig, RoiExtractor, ScanOrder};
pub use shutter::{Shutter, ShutterConfig};
