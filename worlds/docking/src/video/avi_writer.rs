//! AVI writer for uncompressed grey or Motion-JPEG.

use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use contract::docking::Field;
use files::{FileError, FileLocation, PartialFiles, create_new};
use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;

use super::weaver::Weaver;

/// Storage format of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AviCoding {
    /// Device-independent bitmap of 8 bits with a grey palette: lossless, 11 MB per second of 768 × 576
    /// video.
    Grey,
    /// Grey Motion-JPEG of a quality from 1 to 100.
    MotionJpeg {
        /// Quality, 1 to 100.
        quality: u8,
    },
}

/// Writer of fields to an AVI file (AVI 1.0, with an index). The two fields of a frame are interleaved in one
/// image.
pub struct AviWriter {
    files: PartialFiles,
    file: BufWriter<File>,
    path: PathBuf,
    coding: AviCoding,
    columns: usize,
    rows: usize,
    weaver: Weaver,
    chunk: Vec<u8>,
    /// Offset of each frame's chunk from the kind of the list `movi`, and its length, bytes.
    index: Vec<(u32, u32)>,
    position: u64,
}

/// Length of the list kind `movi`, which ends the headers, bytes.
const HEADERS_MOVI_KIND: u64 = 4;
/// Largest size of a file, bytes: sizes have 32 bits, so a file with its index must stay below 4 GiB.
const MAX_BYTES: u64 = 0xF000_0000;

impl AviCoding {
    /// Returns the largest number of whole frames of a size that one file can hold; `None` for a coding whose
    /// frames differ in size.
    pub fn max_frames(self, (columns, rows): (usize, usize)) -> Option<u64> {
        let frame = columns.next_multiple_of(4) as u64 * rows as u64 + 1;
        (self == Self::Grey).then(|| MAX_BYTES / (frame + 32) - 1)
    }
}

/// Checks the requirements common to all video writers.
///
/// # Errors
/// [`FileError::Value`] for a side that is not 1 to [`contract::Camera::MAX_SIDE_PX`], and a rate that is not
/// 0.001 to 1000 Hz.
pub(super) fn check_frames(
    path: &Path,
    (columns, rows): (usize, usize),
    frame_rate_hz: f64,
) -> Result<(), FileError> {
    files::checked_size(path, columns as u64, rows as u64, None)?;
    if (0.001..=1000.0).contains(&frame_rate_hz) {
        return Ok(());
    }
    Err(FileError::value(path, FileLocation::Header, "frames per second", frame_rate_hz, "0.001 to 1000"))
}

impl AviWriter {
    /// Creates the file, for images of `columns` × `rows` and `frame_rate_hz` whole frames per second (stored
    /// to one millionth). The file gets its name when it is complete.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if it exists; [`FileError::Value`] for a side that is not 1 to
    /// [`contract::Camera::MAX_SIDE_PX`], a rate that is not 0.001 to 1000 Hz, a quality that is not 1 to
    /// 100; [`FileError::Io`].
    pub fn create(
        path: &Path,
        coding: AviCoding,
        (columns, rows): (usize, usize),
        frame_rate_hz: f64,
    ) -> Result<Self, FileError> {
        check_frames(path, (columns, rows), frame_rate_hz)?;
        if let AviCoding::MotionJpeg { quality } = coding
            && !(1..=100).contains(&quality)
        {
            return Err(FileError::value(path, FileLocation::Header, "quality", quality, "1 to 100"));
        }
        let files = PartialFiles::for_paths(&[path])?;
        let file = BufWriter::new(create_new(files.path(0))?);
        let mut writer = Self {
            files,
            file,
            path: path.to_owned(),
            coding,
            columns,
            rows,
            weaver: Weaver::new(path, (columns, rows)),
            chunk: Vec::new(),
            index: Vec::new(),
            position: 0,
        };
        let header = writer.header(frame_rate_hz);
        writer.put(&header)?;
        Ok(writer)
    }

    /// Writes a field: a progressive frame, or one of the two fields of a frame. Fields come in pairs of an
    /// even and an odd field, in either order.
    ///
    /// # Errors
    /// [`FileError::Value`] for a field of another size, for a field that does not complete the frame of the
    /// previous one, and for a value above 255; [`FileError::Io`]; [`FileError::Format`] if the file would
    /// exceed 4 GB.
    pub fn write(&mut self, field: &Field) -> Result<(), FileError> {
        if self.weaver.add(field)? { self.put_frame() } else { Ok(()) }
    }

    /// Completes the file and gives it its name. If the last frame has only one field, the rows of the other
    /// remain black.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn finish(mut self) -> Result<(), FileError> {
        if self.weaver.rest() {
            self.put_frame()?;
        }
        let movi_end = self.position;
        let mut index = Vec::with_capacity(8 + 16 * self.index.len());
        index.extend(b"idx1");
        index.extend(((16 * self.index.len()) as u32).to_le_bytes());
        for (offset, size) in &self.index {
            index.extend(self.chunk_id());
            index.extend(0x10_u32.to_le_bytes()); // AVIIF_KEYFRAME
            index.extend(offset.to_le_bytes());
            index.extend(size.to_le_bytes());
        }
        self.put(&index)?;
        let frames = self.index.len() as u32;
        let headers = self.headers_len();
        for (at, value) in [
            (4, (self.position - 8) as u32),
            (FRAMES_OF_FILE, frames),
            (FRAMES_OF_STREAM, frames),
            (headers - 8, (movi_end - headers + HEADERS_MOVI_KIND) as u32),
        ] {
            self.put_at(at, value)?;
        }
        self.file.flush().map_err(|source| FileError::io(&self.path, "write", source))?;
        self.files.complete()
    }

    fn chunk_id(&self) -> [u8; 4] {
        match self.coding {
            AviCoding::Grey => *b"00db",
            AviCoding::MotionJpeg { .. } => *b"00dc",
        }
    }

    /// Writes the current frame.
    fn put_frame(&mut self) -> Result<(), FileError> {
        self.chunk.clear();
        match self.coding {
            AviCoding::Grey => {
                let padding = self.columns.next_multiple_of(4) - self.columns;
                for row in self.weaver.frame().chunks_exact(self.columns).rev() {
                    self.chunk.extend(row);
                    self.chunk.extend(iter_zero(padding));
                }
            }
            AviCoding::MotionJpeg { quality } => {
                JpegEncoder::new_with_quality(&mut self.chunk, quality)
                    .encode(self.weaver.frame(), self.columns as u32, self.rows as u32, ExtendedColorType::L8)
                    .map_err(|error| FileError::format(&self.path, "JPEG", error))?;
            }
        }
        self.weaver.next();
        let size = self.chunk.len() as u32;
        if self.position + u64::from(size) + 16 * (self.index.len() as u64 + 2) > MAX_BYTES {
            let reason = format!(
                "with frame {} the file exceeds the 4 GB of AVI 1.0; write Motion-JPEG, images, or fewer \
                 frames",
                self.index.len()
            );
            return Err(FileError::format(&self.path, "AVI", reason));
        }
        let offset = self.position - self.headers_len() + HEADERS_MOVI_KIND;
        self.index.push((offset as u32, size));
        if size % 2 == 1 {
            self.chunk.push(0);
        }
        let id = self.chunk_id();
        self.put(&id)?;
        self.put(&size.to_le_bytes())?;
        let chunk = std::mem::take(&mut self.chunk);
        self.put(&chunk)?;
        self.chunk = chunk;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        self.file.write_all(bytes).map_err(|source| FileError::io(&self.path, "write", source))?;
        self.position += bytes.len() as u64;
        Ok(())
    }

    fn put_at(&mut self, at: u64, value: u32) -> Result<(), FileError> {
        let seek = self.file.seek(SeekFrom::Start(at));
        seek.and_then(|_| self.file.write_all(&value.to_le_bytes()))
            .map_err(|source| FileError::io(&self.path, "write", source))
    }

    /// Returns the number of colours in the palette.
    fn colours(&self) -> u32 {
        match self.coding {
            AviCoding::Grey => 256,
            AviCoding::MotionJpeg { .. } => 0,
        }
    }

    /// Returns the number of bytes before the first frame.
    fn headers_len(&self) -> u64 {
        FORMAT_OF_STREAM + 8 + 40 + 4 * u64::from(self.colours()) + 12
    }

    /// Returns the header before the first frame; sizes and counts that are not known yet are 0.
    fn header(&self, frame_rate_hz: f64) -> Vec<u8> {
        let colours = self.colours();
        let (columns, rows) = (self.columns as u32, self.rows as u32);
        let format_size = 40 + 4 * colours;
        let stream_list = 4 + 8 + 56 + 8 + format_size;
        let scale = 1_000_000;
        let rate = (frame_rate_hz * f64::from(scale)).round() as u32;
        let (bits, compression) = match self.coding {
            AviCoding::Grey => (8_u32, [0; 4]),
            AviCoding::MotionJpeg { .. } => (24, *b"MJPG"),
        };
        let image_bytes = columns.next_multiple_of(4) * rows * bits.div_ceil(8);
        let mut h = Vec::with_capacity(2048);
        let words = |h: &mut Vec<u8>, values: &[u32]| values.iter().for_each(|v| h.extend(v.to_le_bytes()));
        h.extend(b"RIFF\0\0\0\0AVI LIST");
        words(&mut h, &[4 + 8 + 56 + 8 + stream_list]);
        h.extend(b"hdrlavih");
        // AVIF_HASINDEX; one stream.
        let period_us = (1e6 / frame_rate_hz).round() as u32;
        words(&mut h, &[56, period_us, 0, 0, 0x10, 0, 0, 1, image_bytes, columns, rows, 0, 0, 0, 0]);
        h.extend(b"LIST");
        words(&mut h, &[stream_list]);
        h.extend(b"strlstrh");
        words(&mut h, &[56]);
        h.extend(b"vids");
        h.extend(match self.coding {
            AviCoding::Grey => *b"DIB ",
            AviCoding::MotionJpeg { .. } => *b"MJPG",
        });
        words(&mut h, &[0, 0, 0, scale, rate, 0, 0, image_bytes, u32::MAX, 0, 0, columns | rows << 16]);
        h.extend(b"strf");
        words(&mut h, &[format_size, 40, columns, rows, 1 | bits << 16]);
        h.extend(compression);
        words(&mut h, &[image_bytes, 0, 0, colours, 0]);
        for grey in 0..colours {
            words(&mut h, &[grey * 0x0001_0101]);
        }
        h.extend(b"LIST\0\0\0\0movi");
        h
    }
}

/// Byte positions in the header: dwTotalFrames of `avih`, dwLength of `strh`, the chunk `strf`.
const FRAMES_OF_FILE: u64 = 32 + 16;
const FRAMES_OF_STREAM: u64 = 108 + 32;
const FORMAT_OF_STREAM: u64 = 164;

fn iter_zero(count: usize) -> impl Iterator<Item = u8> {
    std::iter::repeat_n(0, count)
}
