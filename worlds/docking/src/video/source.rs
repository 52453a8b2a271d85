//! Sources of fields.

use std::iter;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use contract::docking::{Digitiser, DockingSetup, Field, FieldTelemetry};
use files::{FileError, FileLocation};

use super::avi::AviReader;
use super::folder;
use super::input::Input;
use super::listed_video::{ListedVideo, video_of};
use super::stream::StreamReader;
use super::video_frame::{FieldOrder, Format, Scan, VideoFrame};
use crate::rows::telemetry::{FieldRow, read_with_lines};

/// Default frame rate of a sequence, frames per second: 625-line television.
const DEFAULT_RATE_HZ: f64 = 25.0;
/// Allowed frame rates of a sequence, Hz.
const RATES_HZ: std::ops::RangeInclusive<f64> = 0.001..=100_000.0;

/// Columns and rows of raw frames, written `768x576`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameSize {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
}

impl FromStr for FrameSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once('x').and_then(|(c, r)| Some((c.parse().ok()?, r.parse().ok()?)));
        let (columns, rows) = sides.ok_or_else(|| {
            format!("`{text}` is not a size of frames; expected COLUMNSxROWS, such as 768x576")
        })?;
        Ok(Self { columns, rows })
    }
}

/// Properties of a sequence that the sequence itself does not state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequenceOptions {
    /// Scan of the rows in whole frames.
    pub scan: Scan,
    /// True if the scan was stated, and takes precedence over the header of the video; false if it is a
    /// default, which the header must not contradict.
    pub scan_is_stated: bool,
    /// Index in [`DockingSetup::cameras`] of the camera that took the sequence, from 0.
    pub camera: usize,
    /// Whole frames per second; default: the rate in the file, or 25.
    pub frame_rate_hz: Option<f64>,
    /// Size of the frames if the input is raw grey bytes; without it, standard input is Y4M.
    pub raw: Option<FrameSize>,
    /// Setting with which the video was digitised.
    pub digitiser: Digitiser,
}

impl SequenceOptions {
    /// Options for interlaced television of the first camera, with the top field first.
    pub const INTERLACED: Self = Self {
        scan: Scan::Interlaced(FieldOrder::Top),
        scan_is_stated: false,
        camera: 0,
        frame_rate_hz: None,
        raw: None,
        digitiser: Digitiser::NEUTRAL,
    };
}

/// Iterator over the fields of a sequence, in order of time.
///
/// A sequence ends at its end or at its first error, which is the last item. Field numbers ascend; those of
/// frames that a recorder dropped are missing.
pub struct FieldSource(Box<dyn Iterator<Item = Result<(Field, FieldTelemetry), FileError>> + Send>);

impl FieldSource {
    /// Opens a sequence:
    ///
    /// - a directory with a `telemetry.csv` ([`crate::rows::FieldRow`]): the fields that the table lists,
    ///   with their images or, if the table names none, those of `fields.avi` or `fields.y4m`; `options` do
    ///   not apply;
    /// - another directory: its images `*.png`, as whole frames in the order of their names;
    /// - `-`: standard input, Y4M or, with `options.raw`, raw frames. Works for live input: a field is
    ///   returned as soon as the last byte of its frame has arrived, and a pipe that is closed between two
    ///   frames ends the sequence;
    /// - a file `*.avi` or `*.y4m`, or with `options.raw` any file of raw frames.
    ///
    /// Field k of a sequence without telemetry has the time k/(fields per second).
    ///
    /// # Errors
    /// A [`FileError`] for a file that is missing or does not have its format, for a size that differs from
    /// that of the camera, for a sequence of 8 bits if the digitiser of the setup has another bit depth, and
    /// for options outside their ranges.
    pub fn open(path: &Path, setup: &DockingSetup, options: &SequenceOptions) -> Result<Self, FileError> {
        let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
        let table = path.join("telemetry.csv");
        if table.exists() {
            let rows = read_with_lines(&table)?;
            if let Some(video) = video_of(path, &rows) {
                return Self::listed_video(&video, table, rows, setup);
            }
            if rows.iter().all(|(_, row)| row.file.is_none()) {
                let expected = "names of images, or fields.avi or fields.y4m in the directory of the table; \
                                a run keeps its images with --save-frames";
                return Err(FileError::value(
                    &table,
                    FileLocation::Header,
                    "file",
                    "empty in every row",
                    expected,
                ));
            }
            let fields = folder::list_fields(path, rows, setup)?;
            let setup = setup.clone();
            return Ok(Self::until_error(fields.into_iter().map(move |field| field.read(&setup))));
        }
        if path.is_dir() {
            let format = format(path, setup, options, setup.bit_depth, None)?;
            let images = folder::by_name(path)?;
            let frames =
                iter::zip(images, 0..).map(move |(path, index)| folder::read_frame(&path, index, &format));
            return Ok(Self::from_frames(path, format, frames));
        }
        let standard_input = path == Path::new("-");
        let open = || if standard_input { Ok(Input::standard_input()) } else { Input::file(path) };
        if options.raw.is_some() {
            Self::raw(open()?, setup, options)
        } else if standard_input || is("y4m") {
            Self::y4m(open()?, setup, options)
        } else if is("avi") {
            Self::avi(open()?, setup, options)
        } else {
            let reason = "the extension is not avi or y4m; raw frames need their size (--raw 768x576)";
            Err(open().err().unwrap_or_else(|| FileError::format(path, "video", reason)))
        }
    }

    /// Returns the fields of a video's whole frames, as listed in a table.
    fn listed_video(
        video: &Path,
        table: PathBuf,
        rows: Vec<(u64, FieldRow)>,
        setup: &DockingSetup,
    ) -> Result<Self, FileError> {
        let camera = setup.cameras.first().map_or((0, 0), |camera| (camera.columns, camera.rows));
        if setup.bit_depth != 8 {
            let expected = format!("{}, the bit depth of the digitiser", setup.bit_depth);
            return Err(FileError::value(video, FileLocation::Header, "bits per sample", 8, expected));
        }
        let input = Input::file(video)?;
        let is_avi = video.extension().is_some_and(|extension| extension == "avi");
        let frames: Box<dyn Iterator<Item = _> + Send> = if is_avi {
            Box::new(AviReader::open(input, camera)?)
        } else {
            Box::new(StreamReader::y4m(input, camera)?)
        };
        ListedVideo::new(table, rows, setup, frames).map(Self::until_error)
    }

    pub(super) fn avi(
        input: Input,
        setup: &DockingSetup,
        options: &SequenceOptions,
    ) -> Result<Self, FileError> {
        let path = input.path().to_owned();
        let reader = AviReader::open(input, size(&path, setup, options)?)?;
        let format = format(&path, setup, options, 8, reader.rate_hz())?;
        Ok(Self::from_frames(&path, format, reader))
    }

    pub(super) fn y4m(
        input: Input,
        setup: &DockingSetup,
        options: &SequenceOptions,
    ) -> Result<Self, FileError> {
        let path = input.path().to_owned();
        let reader = StreamReader::y4m(input, size(&path, setup, options)?)?;
        if !options.scan_is_stated {
            reader.check_default_scan(options.scan)?;
        }
        let format = format(&path, setup, options, 8, reader.rate_hz())?;
        Ok(Self::from_frames(&path, format, reader))
    }

    pub(super) fn raw(
        input: Input,
        setup: &DockingSetup,
        options: &SequenceOptions,
    ) -> Result<Self, FileError> {
        let path = input.path().to_owned();
        let format = format(&path, setup, options, 8, None)?;
        let (columns, rows) = (format.columns, format.rows);
        if let Some(given) = options.raw.filter(|given| (given.columns, given.rows) != (columns, rows)) {
            let size = format!("{} × {}", given.columns, given.rows);
            let expected = format!("{columns} × {rows}, the size of the camera");
            return Err(FileError::value(&path, FileLocation::Whole, "size of raw frames", size, expected));
        }
        Ok(Self::from_frames(&path, format, StreamReader::raw(input, (columns, rows))))
    }

    fn from_frames(
        path: &Path,
        format: Format,
        frames: impl Iterator<Item = Result<VideoFrame, FileError>> + Send + 'static,
    ) -> Self {
        let path = path.to_owned();
        let split = move |frame: Result<VideoFrame, FileError>| {
            let fields = frame
                .and_then(|frame| format.split(&frame).map_err(|source| FileError::contract(&path, source)));
            match fields {
                Ok(fields) => fields.into_iter().map(Ok).collect(),
                Err(error) => vec![Err(error)],
            }
        };
        Self::until_error(frames.flat_map(split))
    }

    fn until_error(
        fields: impl Iterator<Item = Result<(Field, FieldTelemetry), FileError>> + Send + 'static,
    ) -> Self {
        let end_after_error = |failed: &mut bool, field: Result<_, _>| {
            let go_on = !*failed;
            *failed = field.is_err();
            go_on.then_some(field)
        };
        Self(Box::new(fields.fuse().scan(false, end_after_error).fuse()))
    }
}

impl Iterator for FieldSource {
    type Item = Result<(Field, FieldTelemetry), FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.0.next()
    }
}

/// Returns the number of columns and rows of the camera that took the sequence.
fn size(path: &Path, setup: &DockingSetup, options: &SequenceOptions) -> Result<(usize, usize), FileError> {
    let camera = setup.cameras.get(options.camera).ok_or_else(|| {
        let expected = format!("0 to {}, the index of a camera", setup.cameras.len().saturating_sub(1));
        FileError::value(path, FileLocation::Whole, "camera", options.camera, expected)
    })?;
    camera.check().map_err(|source| FileError::contract(path, source))?;
    Ok((camera.columns, camera.rows))
}

/// Returns the common properties of a sequence's frames; `bit_depth` and `rate_hz` are those of the file.
fn format(
    path: &Path,
    setup: &DockingSetup,
    options: &SequenceOptions,
    bit_depth: u8,
    rate_hz: Option<f64>,
) -> Result<Format, FileError> {
    let (columns, rows) = size(path, setup, options)?;
    let wrong = |field: &str, value: String, expected: &str| {
        Err(FileError::value(path, FileLocation::Whole, field, value, expected))
    };
    if bit_depth != setup.bit_depth {
        return wrong(
            "bits per sample",
            bit_depth.to_string(),
            &format!("{}, the bit depth of the digitiser", setup.bit_depth),
        );
    }
    let rate_hz = options.frame_rate_hz.or(rate_hz).unwrap_or(DEFAULT_RATE_HZ);
    if !RATES_HZ.contains(&rate_hz) {
        return wrong("frames per second", rate_hz.to_string(), "0.001 to 100000");
    }
    options.digitiser.check().map_err(|source| FileError::contract(path, source))?;
    let (scan, camera, digitiser) = (options.scan, options.camera, options.digitiser);
    Ok(Format { columns, rows, bit_depth, rate_hz, scan, camera, digitiser })
}
