//! Images as cameras write them, in grey: also colour, and JPEG.

use std::path::Path;

use image::{ColorType, DynamicImage, ImageDecoder};

use super::file::read_image;
use super::image16::{decoder_of_camera, image_error};
use crate::FileError;
use crate::error::file_error::FileLocation;

/// Grey values of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct GreyImage {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Values, row by row, in units of the file.
    pub values: Vec<f32>,
    /// Largest value that the file can hold.
    pub full_scale: f64,
    /// How the values were made from those of the file.
    pub conversion: PixelConversion,
}

/// Conversion of the pixels of a file to grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelConversion {
    /// None: the file is grey.
    None,
    /// Mean of the three colours as stored; a transparency is ignored.
    MeanOfColours,
}

impl GreyImage {
    /// Returns the value of a pixel.
    ///
    /// # Panics
    /// If the pixel is outside the image.
    #[expect(clippy::indexing_slicing, reason = "the caller's own indices, nothing that was read")]
    pub fn at(&self, column: usize, row: usize) -> f64 {
        f64::from(self.values[row * self.columns + column])
    }
}

/// Reads a PNG, TIFF or JPEG of grey or colour with 8 or 16 bits, or a grey FITS or OpenEXR image.
///
/// # Errors
/// [`FileError`] for an unknown extension, and for an image that cannot be read or has another pixel type.
pub fn read_grey_image(path: &Path) -> Result<GreyImage, FileError> {
    let extension =
        path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    let format = match extension.as_str() {
        "png" => image::ImageFormat::Png,
        "tif" | "tiff" => image::ImageFormat::Tiff,
        "jpg" | "jpeg" => image::ImageFormat::Jpeg,
        _ => return grey_of_raw(path),
    };
    let decoder = decoder_of_camera(path, format)?;
    let (columns, rows) = decoder.dimensions();
    let color = decoder.color_type();
    let refused = || {
        let expected = "grey or colour of 8 or 16 bits; convert the image";
        FileError::value(path, FileLocation::Header, "pixel type", format!("{color:?}"), expected)
    };
    let (channels, full_scale) = match color {
        ColorType::L8 => (1, 255.0),
        ColorType::La8 => (2, 255.0),
        ColorType::Rgb8 => (3, 255.0),
        ColorType::Rgba8 => (4, 255.0),
        ColorType::L16 => (1, 65_535.0),
        ColorType::La16 => (2, 65_535.0),
        ColorType::Rgb16 => (3, 65_535.0),
        ColorType::Rgba16 => (4, 65_535.0),
        _ => return Err(refused()),
    };
    let image = DynamicImage::from_decoder(decoder).map_err(|error| image_error(path, error))?;
    let samples: Vec<f32> = match image {
        DynamicImage::ImageLuma8(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageLumaA8(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageRgb8(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageRgba8(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageLuma16(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageLumaA16(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageRgb16(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        DynamicImage::ImageRgba16(pixels) => pixels.into_raw().into_iter().map(f32::from).collect(),
        _ => return Err(refused()),
    };
    let conversion = if channels < 3 { PixelConversion::None } else { PixelConversion::MeanOfColours };
    let values = match channels {
        1 => samples,
        _ => samples.chunks_exact(channels).map(grey_of_pixel).collect(),
    };
    Ok(GreyImage { columns: columns as usize, rows: rows as usize, values, full_scale, conversion })
}

/// Returns the mean of the colours of a pixel; with fewer than three samples, the first.
fn grey_of_pixel(samples: &[f32]) -> f32 {
    match samples {
        [red, green, blue, ..] => (red + green + blue) / 3.0,
        [grey, ..] => *grey,
        [] => 0.0,
    }
}

fn grey_of_raw(path: &Path) -> Result<GreyImage, FileError> {
    let raw = read_image(path, None)?;
    let bits = raw.bit_depth.or(raw.stored_bits).unwrap_or(16);
    let full_scale = f64::from((1_u32 << bits.min(16)) - 1);
    let values = raw.dn.into_iter().map(f32::from).collect();
    let (columns, rows, conversion) = (raw.columns, raw.rows, PixelConversion::None);
    Ok(GreyImage { columns, rows, values, full_scale, conversion })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn colour_and_grey_of_every_depth_are_read() {
        let folder = tempdir().unwrap();
        let colour = image::RgbaImage::from_fn(3, 2, |x, y| image::Rgba([x as u8, 10, 20 + y as u8, 7]));
        colour.save(folder.path().join("a.png")).unwrap();
        let read = read_grey_image(&folder.path().join("a.png")).unwrap();
        assert_eq!((read.columns, read.rows, read.full_scale), (3, 2, 255.0));
        assert_eq!(read.conversion, PixelConversion::MeanOfColours);
        assert!((read.at(2, 0) - 32.0 / 3.0).abs() < 1e-5 && (read.at(0, 1) - 31.0 / 3.0).abs() < 1e-5);
        let grey = image::ImageBuffer::<image::Luma<u16>, _>::from_fn(2, 2, |x, y| {
            image::Luma([(1000 * x + y) as u16])
        });
        grey.save(folder.path().join("b.tiff")).unwrap();
        let read = read_grey_image(&folder.path().join("b.tiff")).unwrap();
        assert_eq!((read.values, read.full_scale), (vec![0.0, 1000.0, 1.0, 1001.0], 65_535.0));
        let jpeg = image::GrayImage::from_pixel(16, 16, image::Luma([90]));
        jpeg.save(folder.path().join("c.jpg")).unwrap();
        let read = read_grey_image(&folder.path().join("c.jpg")).unwrap();
        assert!((read.at(8, 8) - 90.0).abs() <= 1.0 && read.conversion == PixelConversion::None);
    }

    #[test]
    fn a_file_of_another_kind_is_refused_by_name() {
        let folder = tempdir().unwrap();
        for (name, part) in [("a.png", "a.png"), ("a.txt", "expected fits"), ("b.jpg", "b.jpg")] {
            std::fs::write(folder.path().join(name), "no image").unwrap();
            let told = read_grey_image(&folder.path().join(name)).unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
    }
}
