//! Frames as FITS images, based on the card and sample layers of `fitsio-pure`.
//!
//! Its upper layers are not used: `compat` cannot write comments or COMMENT cards at a chosen position, and
//! `parse_fits` requires the whole file in memory and adds offsets unchecked, which a malicious header can
//! overflow.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use contract::{Frame, Window};
use fitsio_pure::BLOCK_SIZE;
use fitsio_pure::checksum::{checksum_blocks, stamp_checksum};
use fitsio_pure::header::{Card, parse_header_blocks, serialize_header};
use fitsio_pure::image_writer::ImageWriter;
use fitsio_pure::primary::build_primary_header;
use fitsio_pure::value::Value;
use hifitime::{Epoch, Unit};

use super::fits_cards;
use super::raw_image::{ImageMetadata, RawImage, RequiredSize, checked_size, dn_of_all};
use crate::error::file_error::{FileLocation, create_new, open_regular};
use crate::table::time::parse_utc;
use crate::table::windows;
use crate::{FileError, FrameHeader, SkyHeader};

/// Longest exposure that is read from a header, s: a day.
const MAX_EXPOSURE_S: f64 = 86_400.0;

/// Longest header that is read, in blocks of 36 cards: no frame needs a hundredth of it.
const MAX_HEADER_BLOCKS: usize = 1024;

/// Writes a frame as unsigned 16-bit FITS. The first row of the frame is the first row of the file, as in
/// every array: viewers that display it at the bottom show the image and its world coordinates upside down.
pub(crate) fn write(path: &Path, frame: &Frame, header: &FrameHeader) -> Result<(), FileError> {
    let error = |error| fits_error(path, error);
    // Subtracting 32768 from a u16 and casting to i16 is a flip of the highest bit.
    let samples = || frame.dn().iter().map(|&dn| (dn ^ 0x8000) as i16);
    let header = primary_header(path, frame, header)?;
    let header = stamp_checksum(&header, &samples().flat_map(i16::to_be_bytes).collect::<Vec<u8>>());
    let file = BufWriter::new(create_new(path)?);
    let mut writer = ImageWriter::new(file, &header).map_err(error)?;
    writer.write_iter(samples()).map_err(error)?;
    writer.finish().map_err(error)?;
    Ok(())
}

/// Returns the header of the FITS file of a frame as text, cards of 80 characters in blocks of 36, without
/// the checksums. `path` names the file in errors.
///
/// # Errors
/// [`FileError::Value`] for a value that FITS cannot represent.
pub fn fits_header(path: &Path, frame: &Frame, header: &FrameHeader) -> Result<String, FileError> {
    let cards = primary_header(path, frame, header)?;
    let bytes = serialize_header(&cards).map_err(|error| fits_error(path, error))?;
    // Every card is checked to be printable ASCII.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn primary_header(path: &Path, frame: &Frame, header: &FrameHeader) -> Result<Vec<Card>, FileError> {
    let cards = fits_cards::frame_cards(path, frame, header)?;
    let mandatory = build_primary_header(16, &[frame.columns(), frame.rows()]);
    let mut all = mandatory.map_err(|error| fits_error(path, error))?;
    all.extend(cards);
    Ok(all)
}

fn fits_error(path: &Path, error: fitsio_pure::Error) -> FileError {
    match error {
        fitsio_pure::Error::Io(source) => FileError::io(path, "write", source),
        other => FileError::format(path, "FITS", other),
    }
}

/// Reads the first two-dimensional image of a FITS file: samples of 8, 16, 32 or 64 bits or floating point,
/// with BSCALE and BZERO applied, converted by the rule of [`crate::frame::raw_image::dn`]; BLANK pixels and
/// NaN are rejected. Tile-compressed images are not supported.
pub(crate) fn read(path: &Path, size: Option<RequiredSize<'_>>) -> Result<RawImage, FileError> {
    in_image_unit(path, |header, reader, span, data_at| {
        let image = read_image(header, reader, header.data_bytes()?, size)?;
        check_sums(header, reader, span, data_at)?;
        Ok(image)
    })
}

/// Reads what the header of the first two-dimensional image states of time and field.
///
/// # Errors
/// [`FileError`] for a file that is no FITS file with an image, and for a time or a scale that cannot be
/// read.
pub fn read_sky_header(path: &Path) -> Result<SkyHeader, FileError> {
    in_image_unit(path, |header, _, _, _| {
        Ok(SkyHeader {
            time: header.middle_of_exposure()?,
            field_deg: header.field_deg()?,
            exposure_s: header.exposure_s()?,
        })
    })
}

/// Applies a function to the first two-dimensional image of a file: to its header, the file at the beginning
/// of its data, the extent of header and data in the file, and the beginning of the data.
fn in_image_unit<T>(
    path: &Path,
    function: impl FnOnce(&Header<'_>, &mut BufReader<File>, Range<u64>, u64) -> Result<T, FileError>,
) -> Result<T, FileError> {
    let io = |source| FileError::io(path, "read", source);
    let file = open_regular(path)?;
    let length = file.metadata().map_err(io)?.len();
    let mut reader = BufReader::new(file);
    let mut offset = 0_u64;
    loop {
        let start = offset;
        let cards = read_header(path, &mut reader, offset == 0)?;
        let header = Header { path, cards: &cards };
        header.check_once()?;
        offset = reader.stream_position().map_err(io)?;
        let bytes = header.data_bytes()?;
        let end = offset.checked_add(bytes).filter(|&end| end <= length).ok_or_else(|| {
            let left = length.saturating_sub(offset);
            header.error("bytes of data", bytes, format!("at most {left}, the bytes left in the file"))
        })?;
        if header.is_image()? {
            return function(&header, &mut reader, start..end, offset);
        }
        offset = end.next_multiple_of(BLOCK_SIZE as u64);
        if offset >= length {
            return Err(FileError::format(path, "FITS", "it contains no two-dimensional image"));
        }
        reader.seek(SeekFrom::Start(offset)).map_err(io)?;
    }
}

fn read_header(path: &Path, reader: &mut impl Read, first: bool) -> Result<Vec<Card>, FileError> {
    let mut header = Vec::new();
    while header.len() < MAX_HEADER_BLOCKS * BLOCK_SIZE {
        let mut block = [0; BLOCK_SIZE];
        reader.read_exact(&mut block).map_err(|source| match source.kind() {
            std::io::ErrorKind::UnexpectedEof => {
                FileError::format(path, "FITS", "the file ends within a header")
            }
            _ => FileError::io(path, "read", source),
        })?;
        header.extend_from_slice(&block);
        let mandatory: &[u8] = if first { b"SIMPLE  " } else { b"XTENSION" };
        if !header.starts_with(mandatory) {
            let keyword = String::from_utf8_lossy(mandatory);
            let reason = format!("a header does not begin with {}", keyword.trim_end());
            return Err(FileError::format(path, "FITS", reason));
        }
        if block.chunks_exact(80).any(|card| card.starts_with(b"END     ")) {
            return parse_header_blocks(&header).map_err(|error| FileError::format(path, "FITS", error));
        }
    }
    Err(FileError::format(path, "FITS", format!("a header has no END within {MAX_HEADER_BLOCKS} blocks")))
}

/// Cards of one header, accessed by keyword.
struct Header<'a> {
    path: &'a Path,
    cards: &'a [Card],
}

impl Header<'_> {
    fn error(&self, keyword: &str, value: impl ToString, expected: impl Into<String>) -> FileError {
        FileError::value(self.path, FileLocation::Header, keyword, value, expected)
    }

    fn value(&self, keyword: &str) -> Option<&Value> {
        self.cards.iter().find(|card| card.keyword_str() == keyword).and_then(|card| card.value.as_ref())
    }

    /// Rejects a header in which a keyword that defines the storage of the pixels occurs twice: other readers
    /// may use either value.
    fn check_once(&self) -> Result<(), FileError> {
        const STORED: [&str; 8] =
            ["BITPIX", "NAXIS", "NAXIS1", "NAXIS2", "BSCALE", "BZERO", "BLANK", "ROWORDER"];
        let count = |keyword: &str| self.cards.iter().filter(|card| card.keyword_str() == keyword).count();
        match STORED.into_iter().find(|keyword| count(keyword) > 1) {
            Some(keyword) => Err(self.error(keyword, format!("present {} times", count(keyword)), "once")),
            None => Ok(()),
        }
    }

    /// Returns an integer value; `None` if the keyword is absent.
    fn integer(&self, keyword: &str) -> Result<Option<i64>, FileError> {
        match self.value(keyword) {
            None | Some(Value::Undefined) => Ok(None),
            Some(Value::Integer(number)) => Ok(Some(*number)),
            Some(other) => Err(self.error(keyword, format!("{other:?}"), "an integer")),
        }
    }

    /// Returns a non-negative integer value.
    fn count(&self, keyword: &str, default: Option<u64>) -> Result<u64, FileError> {
        let number = self.integer(keyword)?;
        match (number.map(u64::try_from), default) {
            (Some(Ok(count)), _) => Ok(count),
            (None, Some(default)) => Ok(default),
            _ => {
                let value = number.map_or_else(|| "missing".to_owned(), |n| n.to_string());
                Err(self.error(keyword, value, "an integer, 0 or greater"))
            }
        }
    }

    fn number(&self, keyword: &str, default: f64) -> Result<f64, FileError> {
        match self.value(keyword) {
            None | Some(Value::Undefined) => Ok(default),
            Some(Value::Integer(number)) => Ok(*number as f64),
            Some(Value::Float(number)) if number.is_finite() => Ok(*number),
            Some(other) => Err(self.error(keyword, format!("{other:?}"), "a finite number")),
        }
    }

    fn axes(&self) -> Result<Vec<u64>, FileError> {
        let count = self.count("NAXIS", None)?;
        if count > 999 {
            return Err(self.error("NAXIS", count, "at most 999"));
        }
        (1..=count).map(|axis| self.count(&format!("NAXIS{axis}"), None)).collect()
    }

    fn bytes_per_sample(&self) -> Result<u64, FileError> {
        match self.integer("BITPIX")? {
            Some(bits @ (8 | 16 | 32 | 64 | -32 | -64)) => Ok(bits.unsigned_abs() / 8),
            Some(other) => Err(self.error("BITPIX", other, "8, 16, 32, 64, -32 or -64")),
            None => Err(self.error("BITPIX", "missing", "8, 16, 32, 64, -32 or -64")),
        }
    }

    /// Returns the number of data bytes: |BITPIX|/8 · GCOUNT · (PCOUNT + Π NAXISn) (FITS standard 4.0, Eq.
    /// 2).
    fn data_bytes(&self) -> Result<u64, FileError> {
        let axes = self.axes()?;
        let samples = match axes.as_slice() {
            [] => Some(0),
            axes => axes.iter().try_fold(1_u64, |product, &n| product.checked_mul(n)),
        };
        let (groups, parameters) = (self.count("GCOUNT", Some(1))?, self.count("PCOUNT", Some(0))?);
        let bytes_per_sample = self.bytes_per_sample()?;
        samples
            .and_then(|n| n.checked_add(parameters))
            .and_then(|n| n.checked_mul(groups))
            .and_then(|n| n.checked_mul(bytes_per_sample))
            .ok_or_else(|| self.error("NAXISn", format!("{axes:?}"), "axes whose product fits 64 bits"))
    }

    /// Returns true if this unit contains an image with at least two axes; further axes of length 1 are
    /// ignored.
    fn is_image(&self) -> Result<bool, FileError> {
        if self.value("ZIMAGE") == Some(&Value::Logical(true)) {
            return Err(FileError::format(
                self.path,
                "FITS",
                "tile-compressed images are not supported; decompress the file with funpack",
            ));
        }
        let image = match self.value("XTENSION") {
            None => self.value("GROUPS") != Some(&Value::Logical(true)),
            Some(Value::String(name)) => name.trim() == "IMAGE",
            Some(_) => false,
        };
        let axes = self.axes()?;
        match axes.as_slice() {
            [columns, rows, others @ ..] if image && *columns > 0 && *rows > 0 => {
                if others.iter().all(|&n| n == 1) {
                    Ok(true)
                } else {
                    Err(self.error("NAXISn", format!("{axes:?}"), "a two-dimensional image"))
                }
            }
            _ => Ok(false),
        }
    }

    fn bit_depth(&self) -> Result<Option<u8>, FileError> {
        let depth = self.integer("BITDEPTH")?;
        depth
            .map(|bits| {
                u8::try_from(bits)
                    .ok()
                    .filter(|bits| (1..=16).contains(bits))
                    .ok_or_else(|| self.error("BITDEPTH", bits, "1 to 16"))
            })
            .transpose()
    }

    /// Returns the frame data that the header states; the time only if it is in UTC.
    fn metadata(&self) -> Result<ImageMetadata, FileError> {
        let frame = self.integer("FRAMENO")?.map(|_| self.count("FRAMENO", None)).transpose()?;
        let exposure_s = self.value("EXPTIME").map(|_| self.number("EXPTIME", 0.0)).transpose()?;
        Ok(ImageMetadata {
            frame: frame.map(|frame| ("FRAMENO", frame)),
            time: self.utc("DATE-AVG")?.map(|time| ("DATE-AVG", time)),
            exposure_s: exposure_s.map(|exposure_s| ("EXPTIME", exposure_s)),
        })
    }

    /// Returns the time of a keyword; `None` without it, and if the header has another time scale than UTC.
    fn utc(&self, keyword: &str) -> Result<Option<Epoch>, FileError> {
        let is_utc = match self.value("TIMESYS") {
            Some(Value::String(scale)) => scale.trim() == "UTC",
            _ => true,
        };
        match self.value(keyword).filter(|_| is_utc) {
            Some(Value::String(text)) => {
                let time = parse_utc(&format!("{}Z", text.trim().trim_end_matches('Z')));
                Ok(Some(time.map_err(|expected| self.error(keyword, text, expected))?))
            }
            _ => Ok(None),
        }
    }

    /// Returns the exposure time, s: `EXPTIME`; `None` without it.
    fn exposure_s(&self) -> Result<Option<f64>, FileError> {
        if self.value("EXPTIME").is_none() {
            return Ok(None);
        }
        let exposure_s = self.number("EXPTIME", 0.0)?;
        if !(0.0..=MAX_EXPOSURE_S).contains(&exposure_s) {
            return Err(self.error("EXPTIME", exposure_s, format!("0 to {MAX_EXPOSURE_S} s")));
        }
        Ok(Some(exposure_s))
    }

    /// Returns the middle of the exposure: `DATE-AVG`, or half of `EXPTIME`, s, after `DATE-OBS`, the
    /// beginning (FITS standard 4.0, 9.5). `None` without these, and for a `DATE-OBS` without a time of day.
    fn middle_of_exposure(&self) -> Result<Option<Epoch>, FileError> {
        if let Some(time) = self.utc("DATE-AVG")? {
            return Ok(Some(time));
        }
        let has_time = matches!(self.value("DATE-OBS"), Some(Value::String(text)) if text.contains('T'));
        if !has_time {
            return Ok(None);
        }
        let exposure_s = self.exposure_s()?.unwrap_or(0.0);
        Ok(self.utc("DATE-OBS")?.map(|start| start + Unit::Second * (0.5 * exposure_s)))
    }

    /// Returns the width of the field along the columns, degrees, by the gnomonic world coordinates (TAN,
    /// TAN-SIP) of the image: 2 atan(N s/2) for N columns of the scale s, rad, at the reference point
    /// (Calabretta & Greisen 2002, A&A 395, 1077). `None` without them.
    fn field_deg(&self) -> Result<Option<f64>, FileError> {
        let is_gnomonic = matches!(self.value("CTYPE1"), Some(Value::String(kind)) if kind.contains("-TAN"));
        if !is_gnomonic {
            return Ok(None);
        }
        // The first column of the matrix is the step of a pixel along the columns: CDi_1, or CDELTi PCi_1.
        let mut squared = 0.0;
        for (axis, diagonal) in [(1, 1.0), (2, 0.0)] {
            let step = match self.value(&format!("CD{axis}_1")) {
                Some(_) => self.number(&format!("CD{axis}_1"), 0.0)?,
                None if self.value("CD1_1").is_some() => 0.0,
                None => {
                    self.number(&format!("CDELT{axis}"), 0.0)?
                        * self.number(&format!("PC{axis}_1"), diagonal)?
                }
            };
            squared += step * step;
        }
        let columns = self.count("NAXIS1", None)? as f64;
        let field_deg = 2.0 * libm::atan(0.5 * columns * squared.sqrt().to_radians()).to_degrees();
        Ok(Some(field_deg).filter(|field_deg| *field_deg > 0.0))
    }

    /// Returns true if the first row of the file is the bottom row of the image, by `ROWORDER`, a convention
    /// of astronomical cameras (Siril, N.I.N.A.); without the keyword the first row is the top row.
    fn is_bottom_up(&self) -> Result<bool, FileError> {
        const EXPECTED: &str = "`TOP-DOWN` or `BOTTOM-UP`";
        let is_bottom_up = match self.value("ROWORDER") {
            None | Some(Value::Undefined) => return Ok(false),
            Some(Value::String(order)) => match order.trim().to_ascii_uppercase().as_str() {
                "TOP-DOWN" => false,
                "BOTTOM-UP" => true,
                _ => return Err(self.error("ROWORDER", order, EXPECTED)),
            },
            Some(other) => return Err(self.error("ROWORDER", format!("{other:?}"), EXPECTED)),
        };
        if is_bottom_up && self.integer("NROI")?.is_some() {
            return Err(self.error("ROWORDER", "BOTTOM-UP", "`TOP-DOWN`, because the file states regions"));
        }
        Ok(is_bottom_up)
    }

    /// Returns the transmitted regions, in the form written by [`write`].
    fn windows(&self) -> Result<Option<Vec<Window>>, FileError> {
        if self.integer("NROI")?.is_none() {
            return Ok(None);
        }
        let count = self.count("NROI", None)?;
        let region = |number: u64| {
            let keyword = format!("ROI{number}");
            match self.value(&keyword) {
                Some(Value::String(text)) => windows::parse_one(text)
                    .ok_or_else(|| self.error(&keyword, text, "`x y columns rows` within the detector")),
                _ => Err(self.error(&keyword, "missing", format!("a region, because NROI is {count}"))),
            }
        };
        // Stops at the first missing region, so a false NROI costs no memory.
        (1..=count).map(region).collect::<Result<_, _>>().map(Some)
    }
}

/// Checks header and data, at `span` in the file, against the keyword CHECKSUM (FITS standard 4.0, 4.4.2.7
/// and appendix J: their sum in ones' complement is minus zero), and the data, from `data_at` on, against
/// DATASUM, if these keywords are present.
fn check_sums(
    header: &Header<'_>,
    reader: &mut (impl Read + Seek),
    span: Range<u64>,
    data_at: u64,
) -> Result<(), FileError> {
    // The standard uses an empty string for an unknown sum.
    let recorded = |keyword: &str| match header.value(keyword) {
        Some(Value::String(text)) if !text.trim().is_empty() => Some(text),
        _ => None,
    };
    let (sum, data_sum) = (recorded("CHECKSUM"), recorded("DATASUM"));
    if (sum.is_none() && data_sum.is_none()) || span.is_empty() {
        return Ok(());
    }
    let io = |source| FileError::io(header.path, "read", source);
    reader.seek(SeekFrom::Start(span.start)).map_err(io)?;
    let mut unit = Vec::new();
    let length = (span.end - span.start).next_multiple_of(BLOCK_SIZE as u64);
    reader.take(length).read_to_end(&mut unit).map_err(io)?;
    // A truncated last block differs from the written file, even if only zeros are missing.
    let is_whole = unit.len() as u64 == length;
    let refused = |keyword: &str, recorded: &str, of: &str| {
        let expected = format!(
            "the checksum of {of}: the file is damaged, or a program changed it without updating the keyword"
        );
        Err(header.error(keyword, recorded, expected))
    };
    if let Some(recorded) = sum.filter(|_| !is_whole || !matches!(checksum_blocks(&unit), 0 | u32::MAX)) {
        return refused("CHECKSUM", recorded, "header and data");
    }
    let data = unit.get((data_at - span.start) as usize..).unwrap_or_default();
    // Zero and minus zero are equal.
    let is_sum = |text: &str| {
        text.trim()
            .parse::<u32>()
            .is_ok_and(|recorded| recorded % u32::MAX == checksum_blocks(data) % u32::MAX)
    };
    match data_sum.filter(|recorded| !is_whole || !is_sum(recorded)) {
        Some(recorded) => refused("DATASUM", recorded, "the data"),
        None => Ok(()),
    }
}

fn read_image(
    header: &Header<'_>,
    reader: &mut impl Read,
    bytes: u64,
    size: Option<RequiredSize<'_>>,
) -> Result<RawImage, FileError> {
    let path = header.path;
    let [columns, rows, ..] = *header.axes()? else {
        return Err(FileError::format(path, "FITS", "it contains no two-dimensional image"));
    };
    let (columns, rows) = checked_size(path, columns, rows, size)?;
    let (scale, zero) = (header.number("BSCALE", 1.0)?, header.number("BZERO", 0.0)?);
    if scale == 0.0 {
        return Err(header.error(
            "BSCALE",
            scale,
            "a number other than 0, which would make all pixels equal",
        ));
    }
    let width = header.bytes_per_sample()? as usize;
    let pixel_bytes = columns * rows * width;
    if bytes != pixel_bytes as u64 {
        return Err(header.error(
            "PCOUNT and GCOUNT",
            bytes,
            format!("{pixel_bytes} bytes of data, the size of the image"),
        ));
    }
    // The size has two limits: the largest detector, and the length of the file, which the caller has
    // checked.
    let mut data = vec![0; pixel_bytes];
    reader.read_exact(&mut data).map_err(|source| FileError::io(path, "read", source))?;

    let blank = header.integer("BLANK")?;
    let integer = |stored: i64| if blank == Some(stored) { f64::NAN } else { zero + scale * stored as f64 };
    let float = |stored: f64| zero + scale * stored;
    let samples = data.chunks_exact(width);
    let dn = match header.integer("BITPIX")? {
        Some(8) => dn_of_all(path, columns, samples.map(|b| integer(i64::from(u8::from_be_bytes(fixed(b)))))),
        Some(16) => {
            dn_of_all(path, columns, samples.map(|b| integer(i64::from(i16::from_be_bytes(fixed(b))))))
        }
        Some(32) => {
            dn_of_all(path, columns, samples.map(|b| integer(i64::from(i32::from_be_bytes(fixed(b))))))
        }
        Some(64) => dn_of_all(path, columns, samples.map(|b| integer(i64::from_be_bytes(fixed(b))))),
        Some(-32) => {
            dn_of_all(path, columns, samples.map(|b| float(f64::from(f32::from_be_bytes(fixed(b))))))
        }
        _ => dn_of_all(path, columns, samples.map(|b| float(f64::from_be_bytes(fixed(b))))),
    }?;
    let (bit_depth, windows, metadata) = (header.bit_depth()?, header.windows()?, header.metadata()?);
    let dn = if header.is_bottom_up()? { reversed_rows(&dn, columns) } else { dn };
    // A scale other than 1 spreads the 8 bits over more.
    let stored_bits = (width == 1 && scale == 1.0).then_some(8);
    Ok(RawImage { columns, rows, dn, bit_depth, stored_bits, windows, metadata })
}

/// Returns the rows of an image in reverse order.
fn reversed_rows(dn: &[u16], columns: usize) -> Vec<u16> {
    let mut reversed = Vec::with_capacity(dn.len());
    for row in dn.chunks_exact(columns).rev() {
        reversed.extend_from_slice(row);
    }
    reversed
}

/// Returns the bytes of one sample; `chunks_exact` supplies exactly this number.
fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes.get(i).copied().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;
    use crate::frame::file::tests::{header, ramp};

    /// Returns a FITS file with the given cards and data.
    fn file(cards: &[&str], data: &[u8]) -> Vec<u8> {
        let mut bytes: Vec<u8> =
            cards.iter().chain(&["END"]).flat_map(|c| format!("{c:80}").into_bytes()).collect();
        bytes.resize(bytes.len().next_multiple_of(BLOCK_SIZE), b' ');
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(BLOCK_SIZE), 0);
        bytes
    }

    fn read_bytes(bytes: &[u8]) -> Result<RawImage, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.fits");
        fs::write(&path, bytes).unwrap();
        read(&path, None)
    }

    fn image(bitpix: i64, more: &[&str], data: &[u8]) -> Result<RawImage, FileError> {
        let bitpix = format!("BITPIX  = {bitpix:20}");
        let cards = ["SIMPLE  =                    T", &bitpix, "NAXIS   = 2", "NAXIS1  = 2", "NAXIS2  = 1"];
        read_bytes(&file(&[&cards, more].concat(), data))
    }

    /// Returns what the header of a file with the given cards, besides those of its pixels, states of the
    /// sky.
    fn sky_header(cards: &[(&str, Value)]) -> Result<SkyHeader, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.fits");
        let mut all = build_primary_header(8, &[1000, 2]).unwrap();
        all.extend(cards.iter().map(|(keyword, value)| Card::new(keyword, value.clone()).unwrap()));
        let mut bytes = serialize_header(&all).unwrap();
        bytes.resize(bytes.len() + BLOCK_SIZE, 0);
        fs::write(&path, bytes).unwrap();
        read_sky_header(&path)
    }

    #[test]
    fn time_and_field_are_those_of_the_header() {
        let text = |text: &str| Value::String(text.to_owned());
        let seconds = |header: SkyHeader| {
            (header.time.unwrap() - parse_utc("2026-03-01T00:00:00Z").unwrap()).to_seconds()
        };
        let start = ("DATE-OBS", text("2026-03-01T00:00:10.5"));
        assert_eq!(seconds(sky_header(&[start.clone(), ("EXPTIME", Value::Float(4.0))]).unwrap()), 12.5);
        assert_eq!(
            seconds(sky_header(&[start.clone(), ("DATE-AVG", text("2026-03-01T00:00:11"))]).unwrap()),
            11.0
        );
        assert_eq!(sky_header(&[("DATE-OBS", text("2026-03-01"))]).unwrap(), SkyHeader::default());
        assert_eq!(sky_header(&[("TIMESYS", text("TAI")), start.clone()]).unwrap(), SkyHeader::default());
        let refused = sky_header(&[start, ("EXPTIME", Value::Float(-1.0))]).unwrap_err().to_string();
        assert!(refused.contains("EXPTIME") && refused.contains("0 to 86400 s"), "{refused}");
        // A scale of 0.02° in a rotated image of 1000 columns: 2 atan(500 · 0.02°) = 19.8°.
        let tan = ("CTYPE1", text("RA---TAN-SIP"));
        let turned = [tan.clone(), ("CD1_1", Value::Float(-0.012)), ("CD2_1", Value::Float(0.016))];
        let scaled = [tan, ("CDELT1", Value::Float(-0.02)), ("CDELT2", Value::Float(0.02))];
        for cards in [&turned[..], &scaled[..]] {
            let field_deg = sky_header(cards).unwrap().field_deg.unwrap();
            assert!((field_deg - 19.8006).abs() < 1e-3, "{field_deg}");
        }
        let other = [("CTYPE1", text("RA---SIN")), ("CDELT1", Value::Float(-0.02))];
        assert_eq!(sky_header(&other).unwrap(), SkyHeader::default());
    }

    #[test]
    fn the_rows_are_in_the_order_that_the_file_states() {
        let rows = |order: &str| {
            let cards = ["SIMPLE  =                    T", "BITPIX  = 8", "NAXIS   = 2", "NAXIS1  = 2"];
            read_bytes(&file(&[&cards, &["NAXIS2  = 2", order] as &[_]].concat(), &[1, 2, 3, 4]))
        };
        for order in ["ROWORDER= 'TOP-DOWN'", "COMMENT none"] {
            assert_eq!(rows(order).unwrap().dn, [1, 2, 3, 4], "{order}");
        }
        assert_eq!(rows("ROWORDER= 'BOTTOM-UP'").unwrap().dn, [3, 4, 1, 2]);
        check_refused(rows("ROWORDER= 'LEFT'"), &["ROWORDER", "LEFT", "BOTTOM-UP"]);
        check_refused(rows("ROWORDER= 3"), &["ROWORDER", "BOTTOM-UP"]);
    }

    fn check_refused(result: Result<RawImage, FileError>, parts: &[&str]) {
        let message = result.unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }

    /// A sparse file claims and has 2 GiB of doubles: the size of the camera rejects it before memory is
    /// allocated.
    #[test]
    fn an_image_of_another_size_than_the_cameras_is_refused_before_it_is_read() {
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.fits");
        let header: String =
            ["SIMPLE  = T", "BITPIX  = -64", "NAXIS   = 2", "NAXIS1  = 16384", "NAXIS2  = 16384", "END"]
                .map(|card| format!("{card:80}"))
                .concat();
        fs::write(&path, format!("{header:2880}")).unwrap();
        let file = File::options().write(true).open(&path).unwrap();
        file.set_len(2880 + 8 * 16384 * 16384).unwrap();
        let size = RequiredSize { columns: 752, rows: 580, whose: "the size of the camera" };
        let message = read(&path, Some(size)).unwrap_err().to_string();
        assert!(
            message.contains("16384 × 16384") && message.contains("752 × 580, the size of the camera"),
            "{message}"
        );
    }

    #[test]
    fn every_kind_of_sample_is_read() {
        let be = |a: &[u8], b: &[u8]| [a, b].concat();
        let signed = ["BZERO   = 32768", "BSCALE  = 1.0"];
        assert_eq!(image(8, &[], &[3, 255]).unwrap().dn, [3, 255]);
        assert_eq!(image(16, &[], &be(&(-5_i16).to_be_bytes(), &7_i16.to_be_bytes())).unwrap().dn, [0, 7]);
        let extremes = be(&i16::MIN.to_be_bytes(), &i16::MAX.to_be_bytes());
        assert_eq!(image(16, &signed, &extremes).unwrap().dn, [0, 65535]);
        assert_eq!(image(32, &[], &be(&9_i32.to_be_bytes(), &70_i32.to_be_bytes())).unwrap().dn, [9, 70]);
        assert_eq!(image(64, &[], &be(&9_i64.to_be_bytes(), &70_i64.to_be_bytes())).unwrap().dn, [9, 70]);
        assert_eq!(image(-32, &[], &be(&0.4_f32.to_be_bytes(), &2.6_f32.to_be_bytes())).unwrap().dn, [0, 3]);
        let scaled = image(-64, &["BSCALE  = 2.0"], &be(&0.4_f64.to_be_bytes(), &2.6_f64.to_be_bytes()));
        assert_eq!(scaled.unwrap().dn, [1, 5]);
    }

    #[test]
    fn an_image_in_an_extension_is_found() {
        let mut bytes = file(&["SIMPLE  =                    T", "BITPIX  = 8", "NAXIS   = 0"], &[]);
        let cards = [
            "XTENSION= 'IMAGE   '",
            "BITPIX  = 8",
            "NAXIS   = 3",
            "NAXIS1  = 2",
            "NAXIS2  = 1",
            "NAXIS3  = 1",
            "PCOUNT  = 0",
            "GCOUNT  = 1",
        ];
        bytes.extend(file(&cards, &[1, 2]));
        assert_eq!(read_bytes(&bytes).unwrap().dn, [1, 2]);
    }

    #[test]
    fn pixels_without_a_value_are_refused_by_position() {
        let nan = [1.0_f32.to_be_bytes(), f32::NAN.to_be_bytes()].concat();
        check_refused(image(-32, &[], &nan), &["pixel (1, 0)", "NaN"]);
        check_refused(image(8, &["BLANK   = 9"], &[9, 1]), &["pixel (0, 0)", "NaN"]);
        check_refused(image(32, &[], &[0, 1, 0, 0, 0, 0, 0, 0]), &["pixel (0, 0)", "65536"]);
    }

    #[test]
    fn a_lying_header_is_refused_before_anything_is_allocated() {
        let image = |axes: [&str; 2]| {
            read_bytes(&file(
                &["SIMPLE  =                    T", "BITPIX  = -64", "NAXIS   = 2", axes[0], axes[1]],
                &[],
            ))
        };
        check_refused(image(["NAXIS1  = 16000", "NAXIS2  = 16000"]), &["bytes of data", "2048000000"]);
        check_refused(image(["NAXIS1  = 9223372036854775807", "NAXIS2  = 9"]), &["NAXISn"]);
        check_refused(image(["NAXIS1  = -4", "NAXIS2  = 9"]), &["NAXIS1", "-4"]);
        check_refused(image(["NAXIS1  = 'many'", "NAXIS2  = 9"]), &["NAXIS1", "many"]);
        check_refused(image(["NAXIS1  = 0", "NAXIS2  = 9"]), &["no two-dimensional image"]);
        check_refused(image(["COMMENT", "NAXIS2  = 9"]), &["NAXIS1", "missing"]);
    }

    #[test]
    fn unsupported_files_are_reported_as_such() {
        check_refused(read_bytes(b"P5 2 2 255 abcd"), &["not a readable FITS file"]);
        check_refused(read_bytes(&[b'x'; 2880]), &["does not begin with SIMPLE"]);
        check_refused(image(7, &[], &[0, 0]), &["BITPIX", "`7`"]);
        check_refused(image(8, &["BITDEPTH= 17"], &[0, 0]), &["BITDEPTH", "1 to 16"]);
        check_refused(image(8, &["BZERO   = 'x'"], &[0, 0]), &["BZERO"]);
        check_refused(image(8, &["NROI    = 4000000000"], &[0, 0]), &["ROI1", "missing"]);
        check_refused(image(8, &["ZIMAGE  =                    T"], &[0, 0]), &["funpack"]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        #[test]
        fn no_damage_makes_it_panic(
            changes in prop::collection::vec((0_usize..9000, any::<u8>()), 1..20), cut in 0_usize..9000,
        ) {
            let directory = tempdir().unwrap();
            let path = directory.path().join("a.fits");
            write(&path, &ramp(16, 9, None), &header()).unwrap();
            let mut bytes = fs::read(&path).unwrap();
            for (place, value) in changes {
                let place = place % bytes.len();
                bytes[place] = value;
            }
            let _ = read_bytes(&bytes);
            bytes.truncate(cut);
            let _ = read_bytes(&bytes);
        }
    }
}
