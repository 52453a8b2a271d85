//! OpenEXR files: frames in DN, noise-free expectations in electrons, radiances of a scene.

use std::io::{BufWriter, Write};
use std::path::Path;

use contract::Frame;
use exr::prelude::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels, ReadLayers,
    Text, WritableImage, f16, read as exr_reader,
};
use sim::vector::RadianceImage;

use super::raw_image::{ImageMetadata, RawImage, RequiredSize, check_claim, checked_size, dn_of_all};
use crate::error::file_error::{FileLocation, create_new};
use crate::table::windows;
use crate::{FileError, FrameHeader};

/// The single attribute for data without a standard EXR attribute. It is single because the crate keeps a
/// layer's own attributes in a hash map, and two attributes would be written in an order that changes from
/// run to run.
const ATTRIBUTE: &str = "boresight";

/// Noise-free expectation of an exposure.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedImage {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Electrons per pixel, row by row.
    pub electrons: Vec<f32>,
}

/// Writes a frame as one float channel `Y` in DN, which represents every 16-bit integer exactly.
pub(crate) fn write(path: &Path, frame: &Frame, header: &FrameHeader) -> Result<(), FileError> {
    let regions = match frame.windows() {
        None => "all".to_owned(),
        windows => windows::format(windows),
    };
    let own = format!("frame={}|bit_depth={}|windows={regions}", frame.number(), frame.bit_depth());
    let software = format!("boresight {}", header.version);
    let mut attributes = attributes(path, "DN", &own)?;
    attributes.exposure = Some(header.exposure_s as f32);
    attributes.software_name = Text::new_or_none(&software);
    let samples = frame.dn().iter().map(|&dn| f32::from(dn)).collect();
    write_channel(path, (frame.columns(), frame.rows()), attributes, FlatSamples::F32(samples))
}

/// Writes an expectation as one float channel `Y` in electrons.
///
/// # Errors
/// [`FileError::Io`] if the file exists or cannot be written; [`FileError::Value`] if the number of values is
/// not columns × rows.
pub fn write_expected(path: &Path, expected: &ExpectedImage) -> Result<(), FileError> {
    let size = checked_values(path, (expected.columns, expected.rows), expected.electrons.len())?;
    let attributes = attributes(path, "electrons", "expected")?;
    write_channel(path, size, attributes, FlatSamples::F32(expected.electrons.clone()))
}

/// Reads an expectation from the output of [`write_expected`] or any image with one channel.
///
/// # Errors
/// A [`FileError`] for a file that cannot be read or has more than one channel.
pub fn read_expected(path: &Path) -> Result<ExpectedImage, FileError> {
    let channel = read_channel(path, None)?;
    Ok(ExpectedImage { columns: channel.columns, rows: channel.rows, electrons: channel.samples })
}

/// Writes radiances as one channel `Y` of 16-bit floats: compact, and accurate to one part in 2048.
///
/// # Errors
/// [`FileError::Io`] if the file exists or cannot be written; [`FileError::Value`] if the number of values is
/// not columns × rows.
pub fn write_radiance(path: &Path, image: &RadianceImage) -> Result<(), FileError> {
    let size = checked_values(path, (image.columns, image.rows), image.radiance.len())?;
    let attributes = attributes(path, "radiance", "radiance")?;
    let samples = image.radiance.iter().map(|&v| f16::from_f32(v)).collect();
    write_channel(path, size, attributes, FlatSamples::F16(samples))
}

/// Returns the columns and rows of an image, after a check that it has one value per pixel.
fn checked_values(
    path: &Path,
    (columns, rows): (usize, usize),
    values: usize,
) -> Result<(usize, usize), FileError> {
    let (columns, rows) = checked_size(path, columns as u64, rows as u64, None)?;
    if values != columns * rows {
        let wanted = (columns * rows).to_string();
        return Err(FileError::value(path, FileLocation::Header, "pixels", values, wanted));
    }
    Ok((columns, rows))
}

/// Reads radiances from the output of [`write_radiance`], an image rendered by Mitsuba, or any image with one
/// channel.
///
/// # Errors
/// A [`FileError`] for a file that cannot be read or has more than one channel.
pub fn read_radiance(path: &Path) -> Result<RadianceImage, FileError> {
    let channel = read_channel(path, None)?;
    Ok(RadianceImage { columns: channel.columns, rows: channel.rows, radiance: channel.samples })
}

/// Reads a frame from an image with one channel in DN.
pub(crate) fn read(path: &Path, size: Option<RequiredSize<'_>>) -> Result<RawImage, FileError> {
    let Channel { columns, rows, samples, own } = read_channel(path, size)?;
    let dn = dn_of_all(path, columns, samples.into_iter().map(f64::from))?;
    let field = |name: &str| {
        own.split('|').find_map(|field| field.split_once('=').filter(|(key, _)| *key == name)).map(|(_, v)| v)
    };
    let error = |field: &str, value: &str, expected| {
        FileError::value(path, FileLocation::Header, format!("{ATTRIBUTE}.{field}"), value, expected)
    };
    let bit_depth = field("bit_depth")
        .map(|text| text.parse().map_err(|_| error("bit_depth", text, "1 to 16")))
        .transpose()?;
    let windows = match field("windows") {
        None | Some("all") => None,
        Some(text) => windows::parse(text).map_err(|expected| error("windows", text, expected))?,
    };
    let frame =
        field("frame").map(|text| text.parse().map_err(|_| error("frame", text, "a number"))).transpose()?;
    let metadata =
        ImageMetadata { frame: frame.map(|frame| ("boresight.frame", frame)), ..ImageMetadata::default() };
    Ok(RawImage { columns, rows, dn, bit_depth, stored_bits: None, windows, metadata })
}

fn attributes(path: &Path, layer: &str, own: &str) -> Result<LayerAttributes, FileError> {
    let text = |s: &str| {
        Text::new_or_none(s)
            .ok_or_else(|| FileError::value(path, FileLocation::Header, ATTRIBUTE, s, "Latin text"))
    };
    let mut attributes = LayerAttributes::named(text(layer)?);
    attributes.other.insert(text(ATTRIBUTE)?, AttributeValue::Text(text(own)?));
    Ok(attributes)
}

fn write_channel(
    path: &Path,
    size: (usize, usize),
    attributes: LayerAttributes,
    samples: FlatSamples,
) -> Result<(), FileError> {
    let channel = AnyChannel::new("Y", samples);
    let channels = AnyChannels::sort(std::iter::once(channel).collect());
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut file = BufWriter::new(create_new(path)?);
    // Single-threaded: frames are already written in parallel, and this fixes the order of the blocks.
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut file)
        .map_err(|error| exr_error(path, error))?;
    file.flush().map_err(|source| FileError::io(path, "write", source))
}

struct Channel {
    columns: usize,
    rows: usize,
    samples: Vec<f32>,
    /// Text of the attribute [`ATTRIBUTE`]; empty if the file has none.
    own: String,
}

fn read_channel(path: &Path, size: Option<RequiredSize<'_>>) -> Result<Channel, FileError> {
    check_header(path, size)?;
    let image = exr_reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_file(path)
        .map_err(|error| exr_error(path, error))?;
    let layer = image.layer_data;
    let own = match layer.attributes.other.iter().find(|(name, _)| *name == ATTRIBUTE) {
        Some((_, AttributeValue::Text(text))) => text.to_string(),
        _ => String::new(),
    };
    let [channel] = layer.channel_data.list.as_slice() else {
        let channels = layer.channel_data.list.len();
        return Err(FileError::value(path, FileLocation::Header, "number of channels", channels, "1 (grey)"));
    };
    let samples = channel.sample_data.values_as_f32().collect();
    Ok(Channel { columns: layer.size.0, rows: layer.size.1, samples, own })
}

/// Checks the sizes that the header states before any memory is allocated for them.
fn check_header(path: &Path, size: Option<RequiredSize<'_>>) -> Result<(), FileError> {
    let meta = exr::meta::MetaData::read_from_file(path, false).map_err(|error| exr_error(path, error))?;
    for header in &meta.headers {
        let (columns, rows) =
            checked_size(path, header.layer_size.0 as u64, header.layer_size.1 as u64, size)?;
        let channels = header.channels.list.len();
        if channels != 1 {
            return Err(FileError::value(
                path,
                FileLocation::Header,
                "number of channels",
                channels,
                "1 (grey)",
            ));
        }
        check_claim(path, (columns * rows * 4) as u64)?;
    }
    Ok(())
}

fn exr_error(path: &Path, error: exr::error::Error) -> FileError {
    match error {
        exr::error::Error::Io(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            FileError::io(path, "read or write", source)
        }
        other => FileError::format(path, "EXR", other),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;
    use crate::frame::file::tests::{header, ramp};

    #[test]
    fn the_expectation_round_trips_bit_for_bit() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("expected.exr");
        let electrons = (0..12).map(|i| 0.1 * i as f32).collect();
        let expected = ExpectedImage { columns: 4, rows: 3, electrons };
        write_expected(&path, &expected).unwrap();
        assert_eq!(read_expected(&path).unwrap(), expected);
        let short = ExpectedImage { columns: 5, ..expected };
        assert!(write_expected(&directory.path().join("short.exr"), &short).is_err());
    }

    #[test]
    fn radiances_round_trip_within_the_precision_of_their_16_bits() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("radiance.exr");
        let radiance: Vec<f32> = (0..12).map(|i| 0.1 * i as f32).collect();
        let image = RadianceImage { columns: 4, rows: 3, radiance };
        write_radiance(&path, &image).unwrap();
        let back = read_radiance(&path).unwrap();
        assert_eq!((back.columns, back.rows, back.radiance.len()), (4, 3, 12));
        for (written, read) in image.radiance.iter().zip(&back.radiance) {
            assert!((written - read).abs() <= written / 2048.0, "{written} {read}");
        }
        let short = RadianceImage { columns: 5, ..image };
        assert!(write_radiance(&directory.path().join("short.exr"), &short).is_err());
    }

    #[test]
    fn colour_is_refused() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("rgb.exr");
        exr::prelude::write_rgb_file(&path, 4, 4, |_, _| (0.0_f32, 1.0_f32, 2.0_f32)).unwrap();
        let message = read(&path, None).unwrap_err().to_string();
        assert!(message.contains("number of channels") && message.contains("`3`"), "{message}");
    }

    #[test]
    fn a_pixel_without_a_value_is_refused_by_position() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("nan.exr");
        let electrons = vec![1.0, f32::NAN];
        write_expected(&path, &ExpectedImage { columns: 2, rows: 1, electrons }).unwrap();
        let message = read(&path, None).unwrap_err().to_string();
        assert!(message.contains("pixel (1, 0)"), "{message}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        #[test]
        fn no_damage_makes_it_panic(
            changes in prop::collection::vec((0_usize..1500, any::<u8>()), 0..6), cut in 1_usize..3000,
        ) {
            let directory = tempdir().unwrap();
            let path = directory.path().join("a.exr");
            write(&path, &ramp(20, 9, None), &header()).unwrap();
            let mut bytes = fs::read(&path).unwrap();
            for (place, value) in changes {
                let place = place % bytes.len();
                bytes[place] = value;
            }
            bytes.truncate(cut);
            fs::write(&path, bytes).unwrap();
            let _ = read(&path, None);
        }
    }
}
