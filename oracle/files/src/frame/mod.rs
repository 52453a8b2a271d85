//! Frames in files: FITS with world coordinates, PNG, TIFF, OpenEXR.

mod exr;
pub(crate) mod file;
mod fits;
mod fits_cards;
mod grey_image;
mod header;
pub(crate) mod image16;
mod png_stream;
pub(crate) mod raw_image;
pub(crate) mod wcs;

pub use self::exr::{ExpectedImage, read_expected, read_radiance, write_expected, write_radiance};
pub use file::{ImageFormat, read_frame, read_image, write_frame};
pub use fits::{fits_header, read_sky_header};
pub use grey_image::{GreyImage, PixelConversion, read_grey_image};
pub use header::{FrameHeader, SkyHeader};
pub use image16::write_png_of_depth;
pub use raw_image::{ImageMetadata, RawImage, RequiredSize, checked_size};
pub use wcs::{Sip, SipTerm, TanSip, WcsError};
