//! Writer of grey YUV4MPEG2 (Y4M): a header line, then a line and the bytes of each frame. The output may be
//! a pipe.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use contract::docking::{Field, Lines};
use files::{FileError, PartialFiles, create_new};

use super::avi_writer::check_frames;
use super::weaver::Weaver;

/// Writer of fields as Y4M. The two fields of a frame are interleaved in one image.
pub struct Y4mWriter {
    weaver: Weaver,
    path: PathBuf,
    /// Output file; `None` for standard output.
    files: Option<PartialFiles>,
    out: Box<dyn Write>,
    columns: usize,
    rows: usize,
    frame_rate_hz: f64,
    /// Width and height of a pixel, in a common unit.
    pixel_aspect: (u64, u64),
    header_is_written: bool,
}

impl Y4mWriter {
    /// Creates a file for images of `columns` × `rows` and `frame_rate_hz` whole frames per second (stored to
    /// one millionth). The file gets its name when it is complete.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if it exists; [`FileError::Value`] for a side that is not 1 to
    /// [`contract::Camera::MAX_SIDE_PX`] or a rate that is not 0.001 to 1000 Hz; [`FileError::Io`].
    pub fn create(path: &Path, size: (usize, usize), frame_rate_hz: f64) -> Result<Self, FileError> {
        check_frames(path, size, frame_rate_hz)?;
        let files = PartialFiles::for_paths(&[path])?;
        let file = BufWriter::new(create_new(files.path(0))?);
        Ok(Self::new(path, Some(files), Box::new(file), size, frame_rate_hz))
    }

    /// Creates a writer to standard output, which receives each frame once it is complete.
    ///
    /// # Errors
    /// [`FileError::Value`] under the same conditions as for [`Y4mWriter::create`].
    pub fn standard_output(size: (usize, usize), frame_rate_hz: f64) -> Result<Self, FileError> {
        let path = Path::new("standard output");
        check_frames(path, size, frame_rate_hz)?;
        Ok(Self::new(path, None, Box::new(io::stdout().lock()), size, frame_rate_hz))
    }

    fn new(
        path: &Path,
        files: Option<PartialFiles>,
        out: Box<dyn Write>,
        (columns, rows): (usize, usize),
        frame_rate_hz: f64,
    ) -> Self {
        Self {
            weaver: Weaver::new(path, (columns, rows)),
            path: path.to_owned(),
            files,
            out,
            columns,
            rows,
            frame_rate_hz,
            pixel_aspect: (1, 1),
            header_is_written: false,
        }
    }

    /// Returns the writer with the width and the height of a pixel, µm (stored to 1 nm), instead of square
    /// pixels.
    pub fn with_pixel_size(self, width_um: f64, height_um: f64) -> Self {
        let nanometres = |size_um: f64| ((size_um * 1000.0).round() as u64).max(1);
        let (width, height) = (nanometres(width_um), nanometres(height_um));
        let divisor = greatest_common_divisor(width, height);
        Self { pixel_aspect: (width / divisor, height / divisor), ..self }
    }

    /// Writes a field: a progressive frame, or one of the two fields of a frame. Fields come in pairs of an
    /// even and an odd field, in either order; the header names that of the first field.
    ///
    /// # Errors
    /// [`FileError::Value`] for a field of another size, for a field that does not complete the frame of the
    /// previous one, and for a value above 255; [`FileError::Io`].
    pub fn write(&mut self, field: &Field) -> Result<(), FileError> {
        if !self.header_is_written {
            self.header_is_written = true;
            let interlace = match field.lines() {
                Lines::All => 'p',
                Lines::Even => 't',
                Lines::Odd => 'b',
            };
            let rate = (self.frame_rate_hz * 1e6).round() as u64;
            let (columns, rows) = (self.columns, self.rows);
            let (width, height) = self.pixel_aspect;
            let header = format!(
                "YUV4MPEG2 W{columns} H{rows} F{rate}:1000000 I{interlace} A{width}:{height} Cmono\n"
            );
            self.put(|out, _| out.write_all(header.as_bytes()))?;
        }
        if self.weaver.add(field)? { self.put_frame() } else { Ok(()) }
    }

    /// Completes the file. If the last frame has only one field, the rows of the other remain black.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn finish(mut self) -> Result<(), FileError> {
        if self.weaver.rest() {
            self.put_frame()?;
        }
        self.put(|out, _| out.flush())?;
        self.files.take().map_or(Ok(()), PartialFiles::complete)
    }

    fn put_frame(&mut self) -> Result<(), FileError> {
        self.put(|out, frame| {
            out.write_all(b"FRAME\n")?;
            out.write_all(frame)?;
            out.flush()
        })?;
        self.weaver.next();
        Ok(())
    }

    fn put(&mut self, write: impl FnOnce(&mut dyn Write, &[u8]) -> io::Result<()>) -> Result<(), FileError> {
        write(self.out.as_mut(), self.weaver.frame()).map_err(|source| match source.kind() {
            ErrorKind::BrokenPipe => FileError::io(
                &self.path,
                "write",
                io::Error::new(source.kind(), "the reading process closed the stream"),
            ),
            _ => FileError::io(&self.path, "write", source),
        })
    }
}

/// Greatest common divisor of two positive numbers (Euclid).
fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
