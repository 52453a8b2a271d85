//! Grey PNG and TIFF with 8 or 16 bits per pixel.

use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use contract::{Camera, Frame};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageBuffer, ImageDecoder, ImageEncoder, ImageReader, Limits, Luma};

use super::png_stream;
use super::raw_image::{ImageMetadata, RawImage, RequiredSize, check_claim, checked_size};
use crate::FileError;
use crate::error::file_error::{FileLocation, create_new, open_regular};

/// Largest memory of a decoder for data other than pixels, bytes.
const ABOUT_PIXELS_BYTES: u64 = 1 << 23;

/// Writes the digital numbers as 16-bit grey PNG, unstretched.
pub(crate) fn write_png(path: &Path, frame: &Frame) -> Result<(), FileError> {
    let (columns, rows) = (frame.columns() as u32, frame.rows() as u32);
    let Some(pixels) = ImageBuffer::<Luma<u16>, _>::from_raw(columns, rows, frame.dn()) else {
        return Err(FileError::value(
            path,
            FileLocation::Header,
            "pixels",
            frame.dn().len(),
            "columns × rows",
        ));
    };
    let mut file = BufWriter::new(create_new(path)?);
    pixels.write_with_encoder(PngEncoder::new(&mut file)).map_err(|error| image_error(path, error))?;
    file.flush().map_err(|source| FileError::io(path, "write", source))
}

/// Writes the digital numbers as grey PNG, unstretched, with 8 bits if the converter has at most 8, otherwise
/// with 16.
pub fn write_png_of_depth(path: &Path, frame: &Frame) -> Result<(), FileError> {
    if frame.bit_depth() > 8 {
        return write_png(path, frame);
    }
    let narrow = |&dn: &u16| u8::try_from(dn).ok();
    let pixels: Option<Vec<u8>> = frame.dn().iter().map(narrow).collect();
    let Some(pixels) = pixels else {
        return Err(FileError::value(path, FileLocation::Header, "DN", "above 255", "8 bits"));
    };
    let mut file = BufWriter::new(create_new(path)?);
    let (columns, rows) = (frame.columns() as u32, frame.rows() as u32);
    PngEncoder::new(&mut file)
        .write_image(&pixels, columns, rows, ExtendedColorType::L8)
        .map_err(|error| image_error(path, error))?;
    file.flush().map_err(|source| FileError::io(path, "write", source))
}

/// Reads a grey image of 8 or 16 bits. Colour, alpha, palettes and fewer bits are rejected, because the
/// values that a decoder derives from them are not digital numbers.
pub(crate) fn read(
    path: &Path,
    format: image::ImageFormat,
    size: Option<RequiredSize<'_>>,
) -> Result<RawImage, FileError> {
    let mut decoder = decoder(path, format)?;
    let (columns, rows) = decoder.dimensions();
    let (columns, rows) = checked_size(path, u64::from(columns), u64::from(rows), size)?;
    let few_bits = if format == image::ImageFormat::Png { fewer_bits(path)? } else { None };
    let color = few_bits.unwrap_or_else(|| decoder.original_color_type());
    if !matches!(color, ExtendedColorType::L8 | ExtendedColorType::L16) {
        let expected = "grey of 8 or 16 bits (L8, L16); convert the image";
        return Err(FileError::value(
            path,
            FileLocation::Header,
            "pixel type",
            format!("{color:?}"),
            expected,
        ));
    }
    check_claim(path, decoder.total_bytes())?;
    // Memory for the pixels, and the same amount for the decoder's own strips.
    let mut limits = limits();
    limits.max_alloc = Some(ABOUT_PIXELS_BYTES.saturating_add(decoder.total_bytes().saturating_mul(2)));
    decoder.set_limits(limits).map_err(|error| image_error(path, error))?;
    let image = image::DynamicImage::from_decoder(decoder).map_err(|error| image_error(path, error))?;
    if format == image::ImageFormat::Png {
        let bytes_per_pixel = if color == ExtendedColorType::L8 { 1 } else { 2 };
        png_stream::check(path, columns, rows, bytes_per_pixel)?;
    }
    let dn = match image {
        image::DynamicImage::ImageLuma8(pixels) => pixels.into_raw().into_iter().map(u16::from).collect(),
        image::DynamicImage::ImageLuma16(pixels) => pixels.into_raw(),
        other => {
            let kind = format!("{:?}", other.color());
            return Err(FileError::value(path, FileLocation::Header, "pixel type", kind, "L8 or L16"));
        }
    };
    let stored_bits = (color == ExtendedColorType::L8).then_some(8);
    let metadata = ImageMetadata::default();
    Ok(RawImage { columns, rows, dn, bit_depth: None, stored_bits, windows: None, metadata })
}

/// Returns the pixel type of a PNG with fewer than 8 bits per sample, whose decoder reports the 8 bits to
/// which it expands them. The bit depth is at a fixed position in the file.
fn fewer_bits(path: &Path) -> Result<Option<ExtendedColorType>, FileError> {
    let mut beginning = [0; 25];
    let mut file = open_regular(path)?;
    let read = std::io::Read::read_exact(&mut file, &mut beginning);
    read.map_err(|source| FileError::io(path, "read", source))?;
    let [.., bits] = beginning;
    let types = [(1, ExtendedColorType::L1), (2, ExtendedColorType::L2), (4, ExtendedColorType::L4)];
    Ok(types.into_iter().find(|(few, _)| *few == bits).map(|(_, color)| color))
}

/// Returns the limits of a decoder before its pixels are requested.
fn limits() -> Limits {
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(Camera::MAX_SIDE_PX as u32);
    limits.max_image_height = Some(Camera::MAX_SIDE_PX as u32);
    limits.max_alloc = Some(ABOUT_PIXELS_BYTES);
    limits
}

/// Returns a decoder that has read all data before the pixels. The colour profile of a PNG is omitted if it
/// unpacks to more than [`ABOUT_PIXELS_BYTES`].
fn decoder(path: &Path, format: image::ImageFormat) -> Result<impl ImageDecoder, FileError> {
    let mut reader = ImageReader::with_format(BufReader::new(open_regular(path)?), format);
    reader.limits(limits());
    reader.into_decoder().map_err(|error| image_error(path, error))
}

/// Returns a decoder of an image of any pixel type, whose size and memory the file justifies.
pub(crate) fn decoder_of_camera(
    path: &Path,
    format: image::ImageFormat,
) -> Result<impl ImageDecoder, FileError> {
    let mut decoder = decoder(path, format)?;
    let (columns, rows) = decoder.dimensions();
    checked_size(path, u64::from(columns), u64::from(rows), None)?;
    check_claim(path, decoder.total_bytes())?;
    let mut limits = limits();
    limits.max_alloc = Some(ABOUT_PIXELS_BYTES.saturating_add(decoder.total_bytes().saturating_mul(2)));
    decoder.set_limits(limits).map_err(|error| image_error(path, error))?;
    Ok(decoder)
}

pub(crate) fn image_error(path: &Path, error: image::ImageError) -> FileError {
    match error {
        image::ImageError::IoError(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            FileError::io(path, "read or write", source)
        }
        other => FileError::format(path, "image", other),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use image::{GrayImage, RgbImage};
    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;
    use crate::frame::file::tests::ramp;
    use crate::read_frame;

    /// PNG with 1, 2 and 4 bits, which the decoder would stretch to 8.
    #[test]
    fn grey_of_fewer_than_8_bits_is_refused() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.png");
        for (bits, depth) in [(1, png::BitDepth::One), (2, png::BitDepth::Two), (4, png::BitDepth::Four)] {
            let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), 8, 1);
            encoder.set_depth(depth);
            encoder.write_header().unwrap().write_image_data(&vec![0x1b; bits]).unwrap();
            let message = read(&path, image::ImageFormat::Png, None).unwrap_err().to_string();
            assert!(message.contains("pixel type") && message.contains(&format!("L{bits}")), "{message}");
        }
    }

    #[test]
    fn grey_of_8_and_16_bits_is_read_from_png_and_tiff() {
        let directory = tempdir().unwrap();
        for extension in ["png", "TIFF"] {
            let path = directory.path().join("a").with_extension(extension);
            GrayImage::from_raw(3, 1, vec![0, 7, 255]).unwrap().save(&path).unwrap();
            assert_eq!(read_frame(&path, 1, 8, None).unwrap().dn(), [0, 7, 255]);
            ImageBuffer::<Luma<u16>, _>::from_raw(2, 1, vec![500_u16, 4095]).unwrap().save(&path).unwrap();
            let frame = read_frame(&path, 1, 12, None).unwrap();
            assert_eq!((frame.dn(), frame.bit_depth()), ([500, 4095].as_slice(), 12));
        }
    }

    #[test]
    fn fewer_bits_than_the_camera_are_refused() {
        let directory = tempdir().unwrap();
        for extension in ["png", "tif"] {
            let path = directory.path().join("a").with_extension(extension);
            GrayImage::from_raw(3, 1, vec![0, 7, 255]).unwrap().save(&path).unwrap();
            assert!(read_frame(&path, 1, 8, None).is_ok() && read_frame(&path, 1, 8, None).is_ok());
            for bits in [9, 12, 16] {
                let message = read_frame(&path, 1, bits, None).unwrap_err().to_string();
                let expected = format!("`bits of a pixel` is `8`, expected at least {bits}");
                assert!(message.contains(&expected), "{message}");
            }
        }
    }

    #[test]
    fn colour_is_refused_by_name() {
        let directory = tempdir().unwrap();
        for extension in ["png", "tif"] {
            let path = directory.path().join("a").with_extension(extension);
            RgbImage::new(4, 4).save(&path).unwrap();
            let message = read_frame(&path, 1, 8, None).unwrap_err().to_string();
            assert!(message.contains("Rgb8") && message.contains("grey"), "{message}");
        }
    }

    #[test]
    fn a_png_that_claims_more_than_it_can_hold_is_refused() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.png");
        write_png(&path, &ramp(4, 4, None)).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        // Overwrites width and height in IHDR, and corrects its checksum.
        bytes[16..24].copy_from_slice(&[0, 0, 0x3f, 0, 0, 0, 0x3f, 0]);
        let checksum = crc32(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
        fs::write(&path, bytes).unwrap();
        let message = read_frame(&path, 1, 12, None).unwrap_err().to_string();
        assert!(message.contains("bytes of pixels"), "{message}");
    }

    /// A colour profile of a gigabyte of zeros takes a megabyte in a file.
    #[test]
    fn ancillary_data_of_a_png_are_bounded() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.png");
        for (length, is_kept) in [(1 << 20, true), (1 << 26, false)] {
            let mut bytes = Vec::new();
            let mut encoder = PngEncoder::new(&mut bytes);
            encoder.set_icc_profile(vec![0; length]).unwrap();
            encoder.write_image(&[0; 16], 4, 4, ExtendedColorType::L8).unwrap();
            fs::write(&path, bytes).unwrap();
            let profile = decoder(&path, image::ImageFormat::Png).unwrap().icc_profile().unwrap();
            assert_eq!(profile.is_some(), is_kept, "{length}");
            assert_eq!(read_frame(&path, 1, 8, None).unwrap().dn(), [0; 16]);
        }
    }

    /// Computes the checksum of a PNG chunk (PNG specification, annex D).
    fn crc32(bytes: &[u8]) -> u32 {
        let bit = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
        !bytes.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| bit(crc)))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        #[test]
        fn no_damage_makes_it_panic(
            changes in prop::collection::vec((0_usize..4000, any::<u8>()), 0..10), cut in 1_usize..4000, tiff: bool,
        ) {
            let directory = tempdir().unwrap();
            let path = directory.path().join(if tiff { "a.tiff" } else { "a.png" });
            let frame = ramp(20, 9, None);
            let pixels = ImageBuffer::<Luma<u16>, _>::from_raw(20, 9, frame.dn().to_vec()).unwrap();
            pixels.save(&path).unwrap();
            let mut bytes = fs::read(&path).unwrap();
            for (place, value) in changes {
                let place = place % bytes.len();
                bytes[place] = value;
            }
            bytes.truncate(cut);
            fs::write(&path, bytes).unwrap();
            let _ = read_frame(&path, 1, 12, None);
        }
    }
}
