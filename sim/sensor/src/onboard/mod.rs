//! On-board processing: shutter control, regions of interest, and the transmitted image.

mod downlink;
mod roi;
mod shutter;

pub use downlink::downlink_in;
pub use downlink::{downlink, downlink_bytes, image_bytes};
pub use roi::{RoiConfig, RoiExtractor, ScanOrder};
pub use shutter::{Shutter, ShutterConfig};
