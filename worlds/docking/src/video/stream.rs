//! Frames without a container: YUV4MPEG2 (Y4M) and raw bytes. Both can be live: a frame is returned as soon
//! as its last byte has arrived, without waiting for further bytes.

use files::FileError;

use super::input::Input;
use super::video_frame::{FieldOrder, Scan, VideoFrame};

/// Iterator over the frames of a Y4M stream (8 bits, mono, 4:2:0, 4:2:2 or 4:4:4) or of raw grey bytes. The
/// plane Y of Y4M is used unscaled.
pub(super) struct StreamReader {
    input: Input,
    framing: Framing,
    grey: Vec<u8>,
    /// Number of colour bytes after the grey bytes.
    colour_bytes: u64,
    rate_hz: Option<f64>,
    /// Interlacing that a header states: `p`, `t`, `b` or `m`.
    interlacing: Option<char>,
    next: u64,
}

/// Header before each frame.
#[derive(Clone, Copy, PartialEq)]
enum Framing {
    Nothing,
    FrameLine,
}

const Y4M: &str = "Y4M";
/// Longest line of a header, bytes, as in mjpegtools.
const MAX_HEADER_LINE_BYTES: usize = 1024;

impl StreamReader {
    /// Creates a reader of raw frames: one byte per pixel, row by row, frame after frame.
    pub(super) fn raw(input: Input, (columns, rows): (usize, usize)) -> Self {
        let grey = vec![0; columns * rows];
        Self {
            input,
            framing: Framing::Nothing,
            grey,
            colour_bytes: 0,
            rate_hz: None,
            interlacing: None,
            next: 0,
        }
    }

    /// Reads the header of a Y4M stream; `size` is the number of columns and rows of the camera.
    pub(super) fn y4m(mut input: Input, size: (usize, usize)) -> Result<Self, FileError> {
        let Some(line) = read_line(&mut input, "the header")? else {
            return Err(input.error(Y4M, "it is empty"));
        };
        let Some(parameters) = line.strip_prefix("YUV4MPEG2") else {
            return Err(input.error(Y4M, "it does not begin with YUV4MPEG2"));
        };
        let mut claimed = (None, None);
        let mut rate_hz = None;
        let mut interlacing = None;
        let mut colour = "420";
        for parameter in parameters.split(' ').filter(|text| !text.is_empty()) {
            let (name, value) = (parameter.chars().next(), parameter.get(1..).unwrap_or(""));
            match name {
                Some('W') => claimed.0 = value.parse().ok(),
                Some('H') => claimed.1 = value.parse().ok(),
                Some('F') => rate_hz = rate(&input, value)?,
                Some('I') => interlacing = value.chars().next(),
                Some('C') => colour = value,
                _ => {}
            }
        }
        let (columns, rows) = size;
        if claimed != (Some(columns as u64), Some(rows as u64)) {
            let text = |side: Option<u64>| side.map_or_else(|| "?".to_owned(), |n| n.to_string());
            let (c, r) = (text(claimed.0), text(claimed.1));
            let reason = format!(
                "header: frames of {c} × {r} pixels, expected {columns} × {rows}, the size of the camera"
            );
            return Err(input.error(Y4M, reason));
        }
        let colour_bytes = match colour {
            "mono" => 0,
            "420" | "420jpeg" | "420paldv" | "420mpeg2" => 2 * columns.div_ceil(2) * rows.div_ceil(2),
            "422" => 2 * columns.div_ceil(2) * rows,
            "444" => 2 * columns * rows,
            _ => {
                let reason =
                    format!("header: colour space `{colour}`, expected mono, 420, 422 or 444 of 8 bits");
                return Err(input.error(Y4M, reason));
            }
        };
        let grey = vec![0; columns * rows];
        Ok(Self {
            input,
            framing: Framing::FrameLine,
            grey,
            colour_bytes: colour_bytes as u64,
            rate_hz,
            interlacing,
            next: 0,
        })
    }

    /// Returns the number of frames per second, if stated in the stream.
    pub(super) fn rate_hz(&self) -> Option<f64> {
        self.rate_hz
    }

    /// Checks that the header does not contradict the scan, which is a default and was not stated.
    ///
    /// A header of bottom field first contradicts the default, and mixed frames have no common order. A
    /// header of progressive frames is no contradiction: programs write it for frames of two fields too.
    pub(super) fn check_default_scan(&self, scan: Scan) -> Result<(), FileError> {
        let contradicts = match (self.interlacing, scan) {
            (Some('b'), Scan::Interlaced(FieldOrder::Top)) => "bottom field first",
            (Some('t'), Scan::Interlaced(FieldOrder::Bottom)) => "top field first",
            (Some('m'), Scan::Interlaced(_)) => "mixed frames",
            _ => return Ok(()),
        };
        let reason = format!(
            "header: {contradicts}, which the default order of the fields contradicts; state the order with \
             --field-order top, --field-order bottom or --progressive"
        );
        Err(self.input.error(Y4M, reason))
    }

    fn next_frame(&mut self) -> Result<Option<VideoFrame>, FileError> {
        let index = self.next;
        let begin = self.input.position();
        if self.framing == Framing::FrameLine {
            match read_line(&mut self.input, "a frame's header")? {
                None => return Ok(None),
                Some(line) if line == "FRAME" || line.starts_with("FRAME ") => {}
                Some(_) => {
                    let reason = format!("frame {index} at byte {begin}: it does not begin with FRAME");
                    return Err(self.input.error(Y4M, reason));
                }
            }
        }
        let got = self.input.fill(&mut self.grey)?;
        if got == 0 && self.framing == Framing::Nothing {
            return Ok(None);
        }
        let got = got as u64 + if got == self.grey.len() { self.input.skip(self.colour_bytes)? } else { 0 };
        let expected = self.grey.len() as u64 + self.colour_bytes;
        if got < expected {
            let format = if self.framing == Framing::Nothing { "raw video" } else { Y4M };
            let reason =
                format!("frame {index} at byte {begin}: the input ends after {got} of its {expected} bytes");
            return Err(self.input.error(format, reason));
        }
        self.next += 1;
        Ok(Some(VideoFrame { index, dn: self.grey.iter().map(|&y| u16::from(y)).collect() }))
    }
}

impl Iterator for StreamReader {
    type Item = Result<VideoFrame, FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_frame().transpose()
    }
}

/// Reads a line without its terminator; `None` if the input ends before the line begins.
fn read_line(input: &mut Input, what: &str) -> Result<Option<String>, FileError> {
    let begin = input.position();
    let mut line = Vec::new();
    loop {
        let mut byte = [0];
        match (input.fill(&mut byte)?, byte[0]) {
            (0, _) if line.is_empty() => return Ok(None),
            (0, _) => return Err(input.error(Y4M, format!("byte {begin}: the input ends within {what}"))),
            (_, b'\n') => break,
            (_, byte) => line.push(byte),
        }
        if line.len() > MAX_HEADER_LINE_BYTES {
            let reason = format!("byte {begin}: {what} is longer than {MAX_HEADER_LINE_BYTES} bytes");
            return Err(input.error(Y4M, reason));
        }
    }
    String::from_utf8(line)
        .map(Some)
        .map_err(|_| input.error(Y4M, format!("byte {begin}: {what} is not text")))
}

/// Parses the number of frames per second, for example `25:1`; `0:0` means unknown.
fn rate(input: &Input, text: &str) -> Result<Option<f64>, FileError> {
    let ratio =
        text.split_once(':').and_then(|(n, d)| Some((n.parse::<u32>().ok()?, d.parse::<u32>().ok()?)));
    match ratio {
        Some((0, 0)) => Ok(None),
        Some((n, d)) if n > 0 && d > 0 => Ok(Some(f64::from(n) / f64::from(d))),
        _ => Err(input.error(Y4M, format!("header: frame rate `{text}`, expected a ratio such as 25:1"))),
    }
}
