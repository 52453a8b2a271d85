//! Header of an AVI file: video stream, image size, frame rate and pixel format.

use files::FileError;

use super::luma::{Layout, UncompressedFormat, grey_of_bgr};
use super::riff::{Chunk, FourCc, Item, Walker};

/// Storage format of a frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Coding {
    Uncompressed(UncompressedFormat),
    MotionJpeg,
}

/// First video stream of a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VideoStream {
    /// Two digits at the beginning of the stream's chunk names.
    pub(super) prefix: [u8; 2],
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Frames per second, if stated in the file.
    pub(super) rate_hz: Option<f64>,
    pub(super) coding: Coding,
}

/// Longest header chunk that is read, bytes: a bitmap header with its palette is 1,064 bytes.
const MAX_HEADER_CHUNK_BYTES: u32 = 4096;

/// Reads the headers up to the list of frames (`movi`), where it leaves the walker. `size` is the required
/// size of the video; memory is never allocated for any other size.
pub(super) fn read(walker: &mut Walker, size: (usize, usize)) -> Result<VideoStream, FileError> {
    if !matches!(walker.step()?, Item::List(kind) if &kind.0 == b"AVI ") {
        return Err(walker.input().error("AVI", "its RIFF type is not `AVI `"));
    }
    let mut streams = 0_u8;
    let mut rate_hz = None;
    let mut is_video = false;
    let mut found = None;
    let mut bytes = Vec::new();
    loop {
        match walker.step()? {
            Item::List(kind) if &kind.0 == b"movi" => break,
            Item::Chunk(chunk) if &chunk.id.0 == b"strh" => {
                read_header_chunk(walker, &chunk, 48, &mut bytes)?;
                streams = streams.saturating_add(1);
                is_video = bytes.starts_with(b"vids");
                rate_hz = rate(walker, &chunk, &bytes)?;
            }
            Item::Chunk(chunk) if &chunk.id.0 == b"strf" && is_video && found.is_none() => {
                read_header_chunk(walker, &chunk, 40, &mut bytes)?;
                found = Some(video_stream(walker, &chunk, &bytes, size, streams - 1, rate_hz)?);
            }
            Item::List(_) | Item::Chunk(_) => {}
            Item::End => return Err(walker.input().error("AVI", "it has no list `movi`")),
        }
    }
    found.ok_or_else(|| walker.input().error("AVI", "it has no video stream before the list `movi`"))
}

fn read_header_chunk(
    walker: &mut Walker,
    chunk: &Chunk,
    shortest: u32,
    bytes: &mut Vec<u8>,
) -> Result<(), FileError> {
    if (shortest..=MAX_HEADER_CHUNK_BYTES).contains(&chunk.size) {
        walker.read(chunk, bytes)
    } else {
        let reason = format!("{} bytes, expected {shortest} to {MAX_HEADER_CHUNK_BYTES}", chunk.size);
        Err(walker.error(chunk, reason))
    }
}

/// Returns the little-endian word at a byte position; 0 beyond the end.
fn word(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes)
}

/// Returns the frames per second of a stream header: dwRate over dwScale.
fn rate(walker: &Walker, chunk: &Chunk, bytes: &[u8]) -> Result<Option<f64>, FileError> {
    let (scale, rate) = (word(bytes, 20), word(bytes, 24));
    match (scale, rate) {
        (0, 0) => Ok(None),
        (0, _) | (_, 0) => Err(walker.error(chunk, format!("a rate of {rate}/{scale} frames per second"))),
        _ => Ok(Some(f64::from(rate) / f64::from(scale))),
    }
}

/// Reads the video stream's data from a bitmap header.
fn video_stream(
    walker: &Walker,
    chunk: &Chunk,
    bytes: &[u8],
    (columns, rows): (usize, usize),
    index: u8,
    rate_hz: Option<f64>,
) -> Result<VideoStream, FileError> {
    let width = word(bytes, 4) as i32;
    let height = word(bytes, 8) as i32;
    if i64::from(width) != columns as i64 || i64::from(height).abs() != rows as i64 {
        let reason = format!(
            "images of {width} × {height} pixels, expected {columns} × {rows}, the size of the camera"
        );
        return Err(walker.error(chunk, reason));
    }
    if index > 99 {
        return Err(walker.error(chunk, "more than 100 streams"));
    }
    let bits = word(bytes, 12) >> 16;
    let compression = FourCc(word(bytes, 16).to_le_bytes());
    let (layout, bottom_up) = match (&compression.0.to_ascii_uppercase()[..], bits) {
        (b"MJPG", _) => {
            let prefix = [b'0' + index / 10, b'0' + index % 10];
            return Ok(VideoStream { prefix, columns, rows, rate_hz, coding: Coding::MotionJpeg });
        }
        // A device-independent bitmap is stored from the bottom up unless the height is negative.
        (b"\0\0\0\0" | b"DIB ", 8) => (Layout::Grey { palette: palette(walker, chunk, bytes)? }, height > 0),
        (b"\0\0\0\0" | b"DIB ", 24) => (Layout::Bgr { bytes: 3 }, height > 0),
        (b"\0\0\0\0" | b"DIB ", 32) => (Layout::Bgr { bytes: 4 }, height > 0),
        // Named pixel formats are stored from the top down, independently of the sign.
        (b"Y800" | b"Y8  " | b"GREY", _) => (Layout::Grey { palette: None }, false),
        (b"YUY2" | b"YUYV", _) => (Layout::Packed422 { first: 0 }, false),
        (b"UYVY", _) => (Layout::Packed422 { first: 1 }, false),
        (b"I420" | b"IYUV" | b"YV12", _) => (Layout::Planar420, false),
        _ => {
            let reason = format!(
                "compression `{compression}` with {bits} bits per pixel; expected MJPG, Y800, YUY2, UYVY, I420 or \
                 uncompressed bitmaps of 8, 24 or 32 bits"
            );
            return Err(walker.error(chunk, reason));
        }
    };
    let coding = Coding::Uncompressed(UncompressedFormat { layout, columns, rows, bottom_up });
    Ok(VideoStream { prefix: [b'0' + index / 10, b'0' + index % 10], columns, rows, rate_hz, coding })
}

/// Returns the grey values of a bitmap's palette, stored as four bytes per colour after the header; `None` if
/// there is no palette and the bytes are grey values themselves. Entries beyond the end of the palette are
/// black, because no pixel should use them.
fn palette(walker: &Walker, chunk: &Chunk, bytes: &[u8]) -> Result<Option<Box<[u8; 256]>>, FileError> {
    let header = word(bytes, 0) as usize;
    let Some(colours) = bytes.get(header.max(40)..) else {
        return Err(walker.error(chunk, format!("a bitmap header of {header} bytes, longer than its chunk")));
    };
    if colours.len() < 4 {
        return Ok(None);
    }
    let mut table = Box::new([0; 256]);
    let colours = colours.chunks_exact(4).filter_map(|colour| colour.first_chunk());
    for (grey, &[blue, green, red]) in table.iter_mut().zip(colours) {
        *grey = grey_of_bgr(blue, green, red);
    }
    Ok(Some(table))
}
