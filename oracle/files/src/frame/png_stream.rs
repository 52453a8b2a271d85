//! Completeness of the compressed data of a PNG: decoders ignore data beyond the pixels and the checksum
//! (Adler-32) after them.

use std::io::{BufReader, Read};
use std::path::Path;

use flate2::{Decompress, FlushDecompress, Status};

use crate::FileError;
use crate::error::file_error::{FileLocation, open_regular};

/// Bytes of the signature of a file.
const SIGNATURE: usize = 8;

/// Position of the method of interlacing in the first chunk's data.
const INTERLACE: usize = 12;

/// Checks that the compressed data of a grey image holds its pixels, the checksum of these, and nothing else,
/// and that the file ends with its last chunk. The chunks themselves have been checked by a decoder.
///
/// # Errors
/// [`FileError`] with the number of bytes found and expected.
pub(super) fn check(
    path: &Path,
    columns: usize,
    rows: usize,
    bytes_per_pixel: usize,
) -> Result<(), FileError> {
    let mut file = BufReader::new(open_regular(path)?);
    let io = |source| FileError::io(path, "read", source);
    file.read_exact(&mut [0; SIGNATURE]).map_err(io)?;
    // One byte for the filter of each row. The rows of an interlaced image are divided differently.
    let mut expected = Some(rows as u64 * (1 + columns as u64 * bytes_per_pixel as u64));
    let mut inflated = Inflated { decompress: Decompress::new(true), bytes: 0, surplus: 0, is_whole: false };
    loop {
        let mut head = [0; 8];
        file.read_exact(&mut head).map_err(io)?;
        let [a, b, c, d, kind @ ..] = head;
        let mut left = u64::from(u32::from_be_bytes([a, b, c, d]));
        let mut buffer = [0; 1 << 14];
        let mut is_first = true;
        while left > 0 {
            let count = usize::try_from(left).unwrap_or(usize::MAX).min(buffer.len());
            let part = buffer.get_mut(..count).unwrap_or_default();
            file.read_exact(part).map_err(io)?;
            left -= count as u64;
            match &kind {
                b"IDAT" => inflated.add(part).map_err(|error| FileError::format(path, "image", error))?,
                b"IHDR" if is_first && part.get(INTERLACE) != Some(&0) => expected = None,
                _ => {}
            }
            is_first = false;
        }
        file.read_exact(&mut [0; 4]).map_err(io)?;
        if &kind == b"IEND" {
            break;
        }
    }
    let error = |field, value: u64, expected: String| {
        Err(FileError::value(path, FileLocation::Whole, field, value, expected))
    };
    if let Some(expected) = expected.filter(|expected| *expected != inflated.bytes) {
        return error("bytes of pixels", inflated.bytes, format!("{expected}, by the size of the image"));
    }
    if !inflated.is_whole {
        return error("bytes of pixels", inflated.bytes, "their checksum after them".to_owned());
    }
    let behind = std::io::copy(&mut file, &mut std::io::sink()).map_err(io)?;
    match inflated.surplus + behind {
        0 => Ok(()),
        surplus => error("bytes behind the image", surplus, "0".to_owned()),
    }
}

/// Data after decompression, of which only the length is kept.
struct Inflated {
    decompress: Decompress,
    bytes: u64,
    /// Bytes behind the end of the compressed data.
    surplus: u64,
    /// True if the compressed data has ended with its checksum.
    is_whole: bool,
}

impl Inflated {
    /// Adds a part of the compressed data.
    fn add(&mut self, mut part: &[u8]) -> Result<(), flate2::DecompressError> {
        let mut sink = [0; 1 << 15];
        // A full buffer may leave output in the decompressor when the whole part has been read.
        let mut is_full = false;
        while (!part.is_empty() || is_full) && !self.is_whole {
            let (before_in, before_out) = (self.decompress.total_in(), self.decompress.total_out());
            let status = self.decompress.decompress(part, &mut sink, FlushDecompress::None)?;
            let read = (self.decompress.total_in() - before_in) as usize;
            let written = self.decompress.total_out() - before_out;
            self.bytes += written;
            part = part.get(read..).unwrap_or_default();
            self.is_whole = status == Status::StreamEnd;
            is_full = written == sink.len() as u64;
            if read == 0 && written == 0 {
                break;
            }
        }
        self.surplus += part.len() as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use tempfile::tempdir;

    fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
        let mut crc = flate2::Crc::new();
        crc.update(kind);
        crc.update(data);
        [&(data.len() as u32).to_be_bytes()[..], kind, data, &crc.sum().to_be_bytes()].concat()
    }

    /// Returns the message for a grey image of 3 × 2 pixels with these uncompressed bytes, whose compressed
    /// data and file `change` has altered; empty without an error.
    fn message(raw: &[u8], change: impl Fn(&mut Vec<u8>), behind: &[u8]) -> String {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(raw).unwrap();
        let mut data = encoder.finish().unwrap();
        change(&mut data);
        let header = [0, 0, 0, 3, 0, 0, 0, 2, 8, 0, 0, 0, 0];
        let parts = [chunk(b"IHDR", &header), chunk(b"IDAT", &data), chunk(b"IEND", &[])].concat();
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.png");
        fs::write(&path, [b"\x89PNG\r\n\x1a\n", &parts[..], behind].concat()).unwrap();
        crate::read_frame(&path, 0, 8, None).err().map_or_else(String::new, |error| error.to_string())
    }

    const PIXELS: [u8; 8] = [0, 1, 2, 3, 0, 4, 5, 6];

    #[test]
    fn an_image_holds_its_pixels_and_nothing_else() {
        assert_eq!(message(&PIXELS, |_| {}, b""), "");
        let behind = message(&PIXELS, |_| {}, b"GIF8");
        assert!(behind.contains("bytes behind the image") && behind.contains("`4`"), "{behind}");
        let rows = message(&[&PIXELS[..], &PIXELS].concat(), |_| {}, b"");
        assert!(rows.contains("bytes of pixels") && rows.contains("`16`, expected 8"), "{rows}");
        let surplus = message(&PIXELS, |data| data.extend(b"more"), b"");
        assert!(surplus.contains("bytes behind the image"), "{surplus}");
    }

    /// The decompressor's buffer is smaller than the image.
    #[test]
    fn a_large_image_is_whole() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.png");
        let pixels = (0..768 * 288).map(|i: u32| (i.wrapping_mul(2_654_435_761) >> 27) as u8).collect();
        image::GrayImage::from_raw(768, 288, pixels).unwrap().save(&path).unwrap();
        super::check(&path, 768, 288, 1).unwrap();
    }

    #[test]
    fn a_wrong_checksum_of_the_pixels_is_refused() {
        let wrong = message(&PIXELS, |data| *data.last_mut().unwrap() ^= 1, b"");
        assert!(wrong.contains("image"), "{wrong}");
        let missing = message(&PIXELS, |data| data.truncate(data.len() - 4), b"");
        assert!(missing.contains("checksum"), "{missing}");
    }
}
