//! Fuzz targets for images.

use std::path::Path;

use boresight::files::{
    FrameHeader, ImageFormat, read_expected, read_frame, read_radiance, write_expected, write_frame,
    write_radiance,
};
use boresight::show::is_boresight_picture;
use hifitime::Epoch;

use crate::{Sandbox, written};

/// Bit depth, 16, which allows every value of an image.
const BITS: u8 = 16;

/// A header without world coordinates.
fn header() -> FrameHeader {
    FrameHeader {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
        exposure_s: 0.5,
        gain_e_per_dn: None,
        seed: 1,
        version: String::new(),
        configuration_hash: String::new(),
        observer_velocity_km_s: None,
        wcs: None,
    }
}

/// Reads a frame; a frame that is read is written in every format and read again. PNG has no regions.
fn frame(sandbox: &Sandbox, path: &Path) {
    let Ok(frame) = read_frame(path, 0, BITS, None) else { return };
    for format in ImageFormat::ALL {
        let windows = frame.windows().map(<[_]>::to_vec);
        let name = format!("again.{format}");
        let write = |path: &Path, frame: &_| write_frame(path, format, frame, &header());
        written::check(sandbox, &name, &frame, write, |path| read_frame(path, 0, BITS, windows));
    }
}

pub(crate) fn fits(sandbox: &Sandbox, bytes: &[u8]) {
    frame(sandbox, &sandbox.file("a.fits", bytes));
}

pub(crate) fn exr(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("a.exr", bytes);
    frame(sandbox, &path);
    if let Ok(expected) = read_expected(&path) {
        written::check(sandbox, "expected.exr", &expected, write_expected, read_expected);
    }
    if let Ok(radiance) = read_radiance(&path) {
        written::check(sandbox, "radiance.exr", &radiance, write_radiance, read_radiance);
    }
}

pub(crate) fn tiff(sandbox: &Sandbox, bytes: &[u8]) {
    frame(sandbox, &sandbox.file("a.tiff", bytes));
}

/// Corrects the checksums first; with wrong checksums, no mutated input would get past their check.
pub(crate) fn png(sandbox: &Sandbox, bytes: &[u8]) {
    let mut bytes = bytes.to_vec();
    mend_checksums(&mut bytes);
    frame(sandbox, &sandbox.file("a.png", &bytes));
    let _ = is_boresight_picture(&bytes);
}

/// Writes the correct checksum after every chunk.
fn mend_checksums(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_be_bytes) {
        let (start, end) = (at + 4, at + 8 + length as usize);
        let Some(checksum) = bytes.get(start..end).map(crc32) else { return };
        let Some(place) = bytes.get_mut(end..end + 4) else { return };
        place.copy_from_slice(&checksum.to_be_bytes());
        at = end + 4;
    }
}

/// Computes the checksum of a chunk (PNG specification, annex D).
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| bit(crc)))
}
