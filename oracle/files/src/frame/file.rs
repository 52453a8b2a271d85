//! Frames in files of any supported format.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use contract::{Frame, Window};

use super::raw_image::{RawImage, RequiredSize};
use super::{exr, fits, image16};
use crate::{FileError, FrameHeader};

/// Formats in which frames are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ImageFormat {
    /// 16-bit FITS with exposure, times, seed, version, observer velocity, regions and world coordinates.
    Fits,
    /// 16-bit grey PNG with unstretched values in DN. The file contains only the pixels: bit depth and
    /// regions are in `camera.toml` and `telemetry.csv`.
    Png,
    /// One 32-bit float channel `Y` in DN, with bit depth and regions in its header.
    Exr,
}

impl ImageFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Fits, Self::Png, Self::Exr];

    /// Returns the extension of the file name, without the dot; also the name of the format.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Fits => "fits",
            Self::Png => "png",
            Self::Exr => "exr",
        }
    }
}

impl fmt::Display for ImageFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.extension())
    }
}

impl FromStr for ImageFormat {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|format| format.extension() == text);
        known.ok_or_else(|| format!("`{text}` is not an image format; expected fits, png or exr"))
    }
}

/// Writes a frame. PNG files omit the header.
///
/// # Errors
/// [`FileError::Io`] if the file exists or cannot be written; [`FileError::Value`] for a header value that
/// the format cannot represent.
pub fn write_frame(
    path: &Path,
    format: ImageFormat,
    frame: &Frame,
    header: &FrameHeader,
) -> Result<(), FileError> {
    match format {
        ImageFormat::Fits => fits::write(path, frame, header),
        ImageFormat::Png => image16::write_png(path, frame),
        ImageFormat::Exr => exr::write(path, frame, header),
    }
}

/// Reads a frame from any source. The extension selects the format: `fits`, `fit`, `fts`, `png`, `tif`,
/// `tiff` or `exr`, in upper or lower case.
///
/// Values are rounded to integer DN, halves away from zero, and negative values are raised to 0. A file that
/// states another `bit_depth` is rejected; `windows`, if given, takes precedence over the regions in the
/// file.
///
/// # Errors
/// A [`FileError`] for a file that cannot be read, or an image that is not grey, is larger than
/// [`contract::Camera::MAX_SIDE_PX`] per side, contains NaN, or has a value above the full scale of its bit
/// depth.
pub fn read_frame(
    path: &Path,
    number: u64,
    bit_depth: u8,
    windows: Option<Vec<Window>>,
) -> Result<Frame, FileError> {
    read_image(path, None)?.into_frame(path, number, bit_depth, windows)
}

/// Reads a file with one of the extensions of [`read_frame`] as a raw image. An image whose size differs from
/// the given size is rejected before memory is allocated for it.
pub fn read_image(path: &Path, size: Option<RequiredSize<'_>>) -> Result<RawImage, FileError> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "fits" | "fit" | "fts" => fits::read(path, size),
        "png" => image16::read(path, image::ImageFormat::Png, size),
        "tif" | "tiff" => image16::read(path, image::ImageFormat::Tiff, size),
        "exr" => exr::read(path, size),
        _ => {
            let reason =
                format!("the extension is `{extension}`, expected fits, fit, fts, png, tif, tiff or exr");
            Err(FileError::format(path, "image", reason))
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;
    use crate::parse_utc;

    /// Returns a 12-bit frame with values that differ from pixel to pixel.
    pub(crate) fn ramp(columns: usize, rows: usize, windows: Option<Vec<Window>>) -> Frame {
        let dn = (0..columns * rows).map(|i| (i * 37 % 4096) as u16).collect();
        Frame::new(7, columns, rows, 12, dn, windows).unwrap()
    }

    pub(crate) fn header() -> FrameHeader {
        FrameHeader {
            time: parse_utc("2012-04-25T12:00:00Z").unwrap(),
            exposure_s: 0.25,
            gain_e_per_dn: Some(12.5),
            seed: u64::MAX,
            version: "0.1.0".to_owned(),
            configuration_hash: "ab".repeat(32),
            observer_velocity_km_s: Some(Vector3::new(-17.0, 22.0, 9.5)),
            wcs: None,
        }
    }

    fn read_back(format: ImageFormat, frame: &Frame, windows: Option<Vec<Window>>) -> Frame {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a").with_extension(format.extension());
        write_frame(&path, format, frame, &header()).unwrap();
        read_frame(&path, frame.number(), frame.bit_depth(), windows).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn frames_round_trip_in_every_format(
            columns in 1_usize..40, rows in 1_usize..40, bits in 1_u8..=16, seed in any::<u32>(), regions in 0_usize..4,
        ) {
            let full_scale = u32::MAX >> (32 - u32::from(bits));
            let dn = (0..(columns * rows) as u32)
                .map(|i| (i.wrapping_mul(2_654_435_761).wrapping_add(seed) % (full_scale + 1)) as u16)
                .collect();
            let region = Window { x: columns / 2, y: rows - 1, columns: 1, rows: 1 };
            let windows = (regions > 0).then(|| vec![region; regions - 1]);
            let frame = Frame::new(7, columns, rows, bits, dn, windows.clone()).unwrap();
            for format in [ImageFormat::Fits, ImageFormat::Exr] {
                prop_assert_eq!(&read_back(format, &frame, None), &frame);
            }
            let png = read_back(ImageFormat::Png, &Frame::new(
                7, columns, rows, 12, frame.dn().iter().map(|dn| dn % 4096).collect(), None,
            ).unwrap(), windows.clone());
            prop_assert_eq!(png.windows(), windows.as_deref());
            prop_assert!(png.dn().iter().zip(frame.dn()).all(|(a, b)| *a == b % 4096));
        }
    }

    #[test]
    fn the_same_frame_is_the_same_bytes_and_is_never_overwritten() {
        let directory = tempdir().unwrap();
        for format in ImageFormat::ALL {
            let paths = ["a", "b"].map(|name| directory.path().join(name).with_extension(format.extension()));
            let frame = ramp(40, 30, Some(vec![Window { x: 1, y: 2, columns: 3, rows: 4 }]));
            for path in &paths {
                write_frame(path, format, &frame, &header()).unwrap();
            }
            let again = write_frame(&paths[0], format, &frame, &header());
            assert!(matches!(again, Err(FileError::Io { doing: "create", .. })));
            assert_eq!(std::fs::read(&paths[0]).unwrap(), std::fs::read(&paths[1]).unwrap());
        }
    }

    #[test]
    fn an_unknown_extension_is_refused() {
        let message = read_frame(Path::new("a.jpg"), 0, 8, None).unwrap_err().to_string();
        assert!(message.contains("`jpg`"), "{message}");
        assert!("jpg".parse::<ImageFormat>().is_err());
        assert_eq!("exr".parse(), Ok(ImageFormat::Exr));
    }

    #[test]
    fn a_header_that_fits_cannot_hold_is_refused() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.fits");
        let check = |header: FrameHeader, keyword| {
            let message = fits::write(&path, &ramp(2, 2, None), &header).unwrap_err().to_string();
            assert!(message.contains(keyword), "{message}");
        };
        check(FrameHeader { exposure_s: f64::NAN, ..header() }, "EXPTIME");
        check(FrameHeader { version: "µ".to_owned(), ..header() }, "CREATOR");
    }
}
