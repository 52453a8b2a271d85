//! Fuzz targets for images.

use boresight::files::{read_expected, read_frame, read_radiance};
use boresight::show::is_boresight_picture;

use crate::Sandbox;

/// Bit depth, 16, which allows every value of an image.
const BITS: u8 = 16;

pub(crate) fn fits(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = read_frame(&sandbox.file("a.fits", bytes), 0, BITS, None);
}

pub(crate) fn exr(sandbox: &Sandbox, bytes: &[u8]) {
    let path = sandbox.file("a.exr", bytes);
    let _ = read_frame(&path, 0, BITS, None);
    let _ = read_expected(&path);
    let _ = read_radiance(&path);
}

pub(crate) fn tiff(sandbox: &Sandbox, bytes: &[u8]) {
    let _ = read_frame(&sandbox.file("a.tiff", bytes), 0, BITS, None);
}

/// Corrects the checksums first; with wrong checksums, no mutated input would get past their check.
pub(crate) fn png(sandbox: &Sandbox, bytes: &[u8]) {
    let mut bytes = bytes.to_vec();
    mend_checksums(&mut bytes);
    let _ = read_frame(&sandbox.file("a.png", &bytes), 0, BITS, None);
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
