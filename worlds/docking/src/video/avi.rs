//! AVI reader for uncompressed frames and Motion-JPEG.
//!
//! The file is read from front to back; its index is neither needed nor used. Parts after the first (`RIFF
//! AVIX` in files over 1 GB, OpenDML) are read in sequence.

use files::FileError;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::avi_header::{self, Coding, VideoStream};
use super::input::Input;
use super::riff::{Chunk, Item, Walker};
use super::video_frame::VideoFrame;

/// Iterator over the frames of an AVI file.
pub(super) struct AviReader {
    walker: Walker,
    stream: VideoStream,
    bytes: Vec<u8>,
    next: u64,
    in_frames: bool,
}

impl AviReader {
    /// Reads the header; `size` is the number of columns and rows of the camera.
    pub(super) fn open(input: Input, size: (usize, usize)) -> Result<Self, FileError> {
        let mut walker = Walker::new(input);
        let stream = avi_header::read(&mut walker, size)?;
        Ok(Self { walker, stream, bytes: Vec::new(), next: 0, in_frames: true })
    }

    /// Returns the number of frames per second, if stated in the file.
    pub(super) fn rate_hz(&self) -> Option<f64> {
        self.stream.rate_hz
    }

    fn next_frame(&mut self) -> Result<Option<VideoFrame>, FileError> {
        loop {
            let chunk = match self.walker.step()? {
                Item::End => return Ok(None),
                Item::List(kind) => {
                    // Frames are in `movi`, or in a `rec ` inside it; other lists contain no frames.
                    self.in_frames = matches!(&kind.0, b"movi" | b"rec ");
                    continue;
                }
                Item::Chunk(chunk) => chunk,
            };
            if !self.in_frames || chunk.id.0[..2] != self.stream.prefix {
                continue;
            }
            match &chunk.id.0[2..] {
                b"db" | b"dc" => {}
                b"pc" => {
                    return Err(self.walker.error(&chunk, "palette changes are not supported"));
                }
                _ => continue,
            }
            let index = self.next;
            self.next += 1;
            // An empty chunk represents a frame that the recorder dropped: it advances the frame number, but
            // produces no field.
            if chunk.size > 0 {
                return self.decode(&chunk).map(|dn| Some(VideoFrame { index, dn }));
            }
        }
    }

    fn decode(&mut self, chunk: &Chunk) -> Result<Vec<u16>, FileError> {
        let size = chunk.size as usize;
        match &self.stream.coding {
            Coding::Uncompressed(frame) => {
                let lengths = frame.lengths();
                if !lengths.contains(&size) {
                    let expected =
                        format!("{size} bytes, expected {}, or {} with padding", lengths[0], lengths[1]);
                    return Err(self.walker.error(chunk, expected));
                }
                self.walker.read(chunk, &mut self.bytes)?;
                let wrong = || self.walker.error(chunk, "does not match the pixel layout of the stream");
                frame.grey(&self.bytes).ok_or_else(wrong)
            }
            Coding::MotionJpeg => {
                // A JPEG image takes at most the size of its uncompressed colours, plus headers and noise.
                let most = 6 * self.stream.columns * self.stream.rows + (1 << 16);
                if size > most {
                    let reason = format!("{size} bytes of JPEG, expected at most {most} for this image size");
                    return Err(self.walker.error(chunk, reason));
                }
                self.walker.read(chunk, &mut self.bytes)?;
                decode_jpeg(&self.bytes, self.stream.columns, self.stream.rows)
                    .map_err(|reason| self.walker.error(chunk, reason))
            }
        }
    }
}

impl Iterator for AviReader {
    type Item = Result<VideoFrame, FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_frame().transpose()
    }
}

/// Returns the brightness of a JPEG image of a known size. The decoder is strict: filling missing data with
/// grey would invent pixels that no camera recorded.
fn decode_jpeg(bytes: &[u8], columns: usize, rows: usize) -> Result<Vec<u16>, String> {
    let options = DecoderOptions::default()
        .set_max_width(columns)
        .set_max_height(rows)
        .set_strict_mode(true)
        .jpeg_set_max_scans(64)
        .jpeg_set_out_colorspace(ColorSpace::Luma);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| format!("not a readable JPEG image: {error:?}"))?;
    if decoder.dimensions() != Some((columns, rows)) {
        let (c, r) = decoder.dimensions().unwrap_or_default();
        return Err(format!(
            "a JPEG image of {c} × {r} pixels, expected {columns} × {rows} as in the stream header"
        ));
    }
    let grey = decoder.decode().map_err(|error| format!("not a readable JPEG image: {error:?}"))?;
    if grey.len() != columns * rows {
        return Err(format!("{} values, expected one per pixel, {columns} × {rows}", grey.len()));
    }
    Ok(grey.into_iter().map(u16::from).collect())
}
