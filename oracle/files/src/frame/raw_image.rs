//! Images as read from a file, before conversion to a frame.

use std::path::Path;

use contract::{Camera, Frame, Telemetry, Window};
use hifitime::Epoch;

use crate::FileError;
use crate::error::FileLocation;
use crate::table::time::format_utc;

/// Pixels with the metadata in the file.
#[derive(Debug)]
pub struct RawImage {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Digital numbers, row by row.
    pub dn: Vec<u16>,
    /// Bits of the converter, if stated in the file.
    pub bit_depth: Option<u8>,
    /// Largest number of bits that the stored integers hold, if the file has fewer than 16.
    pub stored_bits: Option<u8>,
    /// Transmitted regions, if stated in the file.
    pub windows: Option<Vec<Window>>,
    /// Other frame data stated in the file.
    pub metadata: ImageMetadata,
}

/// Frame data stated in an image, each with its keyword.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ImageMetadata {
    /// Number of the frame.
    pub frame: Option<(&'static str, u64)>,
    /// Middle of the exposure.
    pub time: Option<(&'static str, Epoch)>,
    /// Exposure time, s.
    pub exposure_s: Option<(&'static str, f64)>,
}

impl ImageMetadata {
    /// Tolerance of the time, s: other cameras write milliseconds.
    const TIME_S: f64 = 1e-3;
    /// Relative tolerance of the exposure time, suitable for a number with six digits.
    const EXPOSURE: f64 = 1e-5;

    /// Checks the stated data against a row of the telemetry, to detect images with interchanged file names.
    pub fn check(&self, path: &Path, number: u64, telemetry: &Telemetry) -> Result<(), FileError> {
        let refused = |field: &str, found: String, expected: String| {
            let expected =
                format!("{expected}, the value of frame {number} in the telemetry that names this file");
            Err(FileError::value(path, FileLocation::Header, field, found, expected))
        };
        if let Some((field, frame)) = self.frame.filter(|(_, frame)| *frame != number) {
            return refused(field, frame.to_string(), number.to_string());
        }
        if let Some((field, time)) = self.time
            && (time - telemetry.time).to_seconds().abs() > Self::TIME_S
        {
            return refused(field, format_utc(time), format_utc(telemetry.time));
        }
        let is_other =
            |value: f64| (value - telemetry.exposure_s).abs() > Self::EXPOSURE * telemetry.exposure_s;
        match self.exposure_s.filter(|(_, value)| is_other(*value)) {
            Some((field, value)) => refused(field, value.to_string(), telemetry.exposure_s.to_string()),
            None => Ok(()),
        }
    }
}

/// Required size of an image.
#[derive(Debug, Clone, Copy)]
pub struct RequiredSize<'a> {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Source of the size, for messages: `the size in camera.toml`.
    pub whose: &'a str,
}

impl RawImage {
    /// Converts the image to a frame. Rejects a file that states another bit depth than `bit_depth`, or whose
    /// integers have fewer bits. Regions
    /// from the telemetry take precedence over those in the file. A value above the full scale is rejected:
    /// it indicates a wrong bit depth, which would also make every threshold that a pipeline derives from it
    /// wrong.
    pub fn into_frame(
        self,
        path: &Path,
        number: u64,
        bit_depth: u8,
        windows: Option<Vec<Window>>,
    ) -> Result<Frame, FileError> {
        if let Some(own) = self.bit_depth.filter(|own| *own != bit_depth) {
            let expected = format!("{bit_depth}, the bit depth of the camera");
            return Err(FileError::value(path, FileLocation::Header, "bit depth", own, expected));
        }
        if let Some(stored) = self.stored_bits.filter(|stored| *stored < bit_depth) {
            let expected = format!(
                "at least {bit_depth}, the bit depth of the camera: the image has been scaled or cut to fewer bits"
            );
            return Err(FileError::value(path, FileLocation::Header, "bits of a pixel", stored, expected));
        }
        let columns = self.columns.max(1);
        let frame = Frame::new(number, self.columns, self.rows, bit_depth, self.dn, windows.or(self.windows))
            .map_err(|source| FileError::contract(path, source))?;
        let full_scale = frame.full_scale_dn();
        match frame.dn().iter().enumerate().find(|(_, dn)| **dn > full_scale) {
            None => Ok(frame),
            Some((i, dn)) => Err(FileError::value(
                path,
                FileLocation::Pixel { x: i % columns, y: i / columns },
                "DN",
                dn,
                format!("at most {full_scale}, the full scale of {} bits", frame.bit_depth()),
            )),
        }
    }
}

/// Converts a value to a digital number: rounded to the nearest integer, halves away from zero. Negative
/// values become 0, because calibrated images have noise about zero. Returns `None` for NaN, infinities and
/// values that exceed 16 bits, which no digital number can represent.
pub(crate) fn dn(value: f64) -> Option<u16> {
    let rounded = value.round();
    (rounded.is_finite() && rounded <= f64::from(u16::MAX)).then(|| rounded.max(0.0) as u16)
}

/// Applies [`dn`] to every value, row by row.
pub(crate) fn dn_of_all(
    path: &Path,
    columns: usize,
    values: impl Iterator<Item = f64>,
) -> Result<Vec<u16>, FileError> {
    let columns = columns.max(1);
    let convert = |(i, value)| {
        dn(value).ok_or_else(|| {
            let place = FileLocation::Pixel { x: i % columns, y: i / columns };
            FileError::value(path, place, "DN", value, "a finite number of at most 65535")
        })
    };
    values.enumerate().map(convert).collect()
}

/// Returns columns and rows as stated in a header if they match `size` or, without `size`, are in the range 1
/// to [`Camera::MAX_SIDE_PX`]. Called before memory is allocated for the pixels.
pub fn checked_size(
    path: &Path,
    columns: u64,
    rows: u64,
    size: Option<RequiredSize<'_>>,
) -> Result<(usize, usize), FileError> {
    let side = |n: u64| usize::try_from(n).ok().filter(|n| (1..=Camera::MAX_SIDE_PX).contains(n));
    let found = side(columns).zip(side(rows));
    let is_right = |found: &(usize, usize)| size.is_none_or(|size| *found == (size.columns, size.rows));
    found.filter(is_right).ok_or_else(|| {
        let found = format!("{columns} × {rows}");
        let expected = match size {
            Some(RequiredSize { columns, rows, whose }) => format!("{columns} × {rows}, {whose}"),
            None => format!("1 to {} pixels per side", Camera::MAX_SIDE_PX),
        };
        FileError::value(path, FileLocation::Header, "image size", found, expected)
    })
}

/// Rejects a compressed file that claims more bytes than any supported compression could have packed into its
/// length: deflate packs at most 1032 bytes into one, LZW of 12 bits 2731.
pub(crate) fn check_claim(path: &Path, claimed_bytes: u64) -> Result<(), FileError> {
    const MAX_FROM_ONE_BYTE: u64 = 4096;
    let length = std::fs::metadata(path).map_err(|source| FileError::io(path, "open", source))?.len();
    if claimed_bytes > length.saturating_mul(MAX_FROM_ONE_BYTE) {
        let expected = format!("at most the pixels that a file of {length} bytes can contain");
        Err(FileError::value(path, FileLocation::Header, "bytes of pixels", claimed_bytes, expected))
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_and_noise_below_zero_is_zero() {
        assert_eq!(
            [-3.0, 0.49, 0.5, 1.5, 65535.4].map(dn),
            [Some(0), Some(0), Some(1), Some(2), Some(65535)]
        );
        assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 65535.5].map(dn), [None; 4]);
    }

    #[test]
    fn a_value_above_full_scale_names_its_pixel() {
        let raw = RawImage {
            columns: 2,
            rows: 2,
            dn: vec![0, 0, 0, 1024],
            stored_bits: None,
            bit_depth: None,
            windows: None,
            metadata: ImageMetadata::default(),
        };
        let message = raw.into_frame(Path::new("a.png"), 1, 10, None).unwrap_err().to_string();
        assert_eq!(
            message,
            "a.png, pixel (1, 1): `DN` is `1024`, expected at most 1023, the full scale of 10 bits"
        );
    }
}
