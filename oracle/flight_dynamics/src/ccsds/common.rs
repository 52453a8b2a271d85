//! Parts that messages share.

use std::path::Path;

use files::{FileError, FileLocation};
use hifitime::{Duration, Epoch};

use crate::coverage::{BorderRule, Coverage};
use crate::document::{Document, Record, Segment, Writer};
use crate::frame::{FRAME_NAMES, ReferenceFrame};
use crate::interpolation::{Interpolation, MAX_DEGREE, Method};
use crate::time::TimeSystem;

/// Tolerance between the span that a message states and its first and last record: writers round times to
/// milliseconds.
const ROUNDING: Duration = Duration::from_parts(0, 1_000_000);

/// International designator of spacecraft that have none.
pub(crate) const NO_DESIGNATOR: &str = "UNKNOWN";

/// Header of a message.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Organisation or program that made the message.
    pub originator: String,
    /// Time at which the message was made.
    pub creation_time: Epoch,
    /// Identifier of the message; `None` if it has none.
    pub message_id: Option<String>,
    /// Comments, written one line each; not read.
    pub comments: Vec<String>,
}

impl Header {
    pub(crate) fn read(record: &Record<'_>) -> Result<Self, FileError> {
        Ok(Self {
            originator: record.require("ORIGINATOR")?.value.to_owned(),
            creation_time: record.time(record.require("CREATION_DATE")?, TimeSystem::Utc)?,
            message_id: record.find("MESSAGE_ID").map(|entry| entry.value.to_owned()),
            comments: Vec::new(),
        })
    }

    pub(crate) fn write(&self, writer: &mut Writer) {
        writer.open("header");
        for comment in &self.comments {
            writer.comment(comment);
        }
        writer.value("CREATION_DATE", TimeSystem::Utc.format_time(self.creation_time));
        writer.value("ORIGINATOR", &self.originator);
        writer.close("header");
    }
}

/// Checks that the central body is the Earth.
pub(crate) fn check_center(
    metadata: &Record<'_>,
    entry: Option<&crate::document::Entry<'_>>,
) -> Result<(), FileError> {
    match entry {
        Some(entry) if !entry.value.eq_ignore_ascii_case("EARTH") => Err(metadata.refuse(entry, "EARTH")),
        _ => Ok(()),
    }
}

pub(crate) fn read_frame(metadata: &Record<'_>, keyword: &str) -> Result<ReferenceFrame, FileError> {
    let entry = metadata.require(keyword)?;
    ReferenceFrame::parse(entry.value).ok_or_else(|| metadata.refuse(entry, FRAME_NAMES))
}

pub(crate) fn read_time_system(metadata: &Record<'_>) -> Result<TimeSystem, FileError> {
    let entry = metadata.require("TIME_SYSTEM")?;
    TimeSystem::parse(entry.value).ok_or_else(|| {
        metadata.refuse(entry, "UTC, TAI, TT, TDB or GPS (UT1 needs measured values of UT1 − UTC)")
    })
}

/// Reads the span within which a segment is used: the usable one if stated, otherwise the whole.
pub(crate) fn read_coverage(metadata: &Record<'_>, system: TimeSystem) -> Result<Coverage, FileError> {
    let whole = ["START_TIME", "STOP_TIME"].map(|keyword| metadata.require(keyword));
    let [start_entry, stop_entry] = whole;
    let (start_entry, stop_entry) = (start_entry?, stop_entry?);
    let (start, stop) = (metadata.time(start_entry, system)?, metadata.time(stop_entry, system)?);
    if stop <= start {
        return Err(metadata.refuse(stop_entry, format!("a time after START_TIME, {}", start_entry.value)));
    }
    let within = |keyword: &str, default: Epoch| match metadata.find(keyword) {
        None => Ok(default),
        Some(entry) => {
            let time = metadata.time(entry, system)?;
            if start <= time && time <= stop {
                Ok(time)
            } else {
                let expected = format!("a time from {} to {}", start_entry.value, stop_entry.value);
                Err(metadata.refuse(entry, expected))
            }
        }
    };
    let usable_start = within("USEABLE_START_TIME", start)?;
    let usable_stop = within("USEABLE_STOP_TIME", stop)?;
    if usable_stop <= usable_start {
        let entry = metadata.find("USEABLE_STOP_TIME").or(metadata.find("USEABLE_START_TIME"));
        return Err(metadata.refuse(entry.unwrap_or(stop_entry), "a usable span of more than 0 s"));
    }
    Ok(Coverage { start: usable_start, stop: usable_stop })
}

/// Reads method and degree; `keyword` is that of the method.
pub(crate) fn read_interpolation(
    metadata: &Record<'_>,
    keyword: &str,
) -> Result<Option<Interpolation>, FileError> {
    let Some(entry) = metadata.find(keyword) else { return Ok(None) };
    let method = Method::parse(entry.value).ok_or_else(|| metadata.refuse(entry, Method::NAMES))?;
    let Some(degree_entry) = metadata.find("INTERPOLATION_DEGREE") else {
        return match method {
            Method::Linear => Ok(Some(Interpolation { method, degree: 1 })),
            _ => metadata.require("INTERPOLATION_DEGREE").map(|_| None),
        };
    };
    let largest = if method == Method::Linear { 1 } else { MAX_DEGREE };
    match degree_entry.value.parse() {
        Ok(degree) if (1..=largest).contains(&degree) => Ok(Some(Interpolation { method, degree })),
        _ => {
            let expected = format!("an integer from 1 to {largest} for {}", method.code());
            Err(metadata.refuse(degree_entry, expected))
        }
    }
}

/// Times of records with their lines.
pub(crate) struct Times<'a> {
    pub(crate) path: &'a Path,
    pub(crate) system: TimeSystem,
    pub(crate) times: Vec<(Epoch, u64)>,
    /// Line of the metadata.
    pub(crate) line: u64,
}

impl Times<'_> {
    /// Checks that the times ascend and cover the span.
    pub(crate) fn check(&self, coverage: &Coverage) -> Result<(), FileError> {
        let text = |time: Epoch| self.system.format_time(time);
        let refused = |line: u64, value: String, expected: String| {
            Err(FileError::value(self.path, FileLocation::Line(line), "EPOCH", value, expected))
        };
        for pair in self.times.windows(2) {
            if let [(earlier, _), (later, line)] = pair
                && later <= earlier
            {
                return refused(*line, text(*later), format!("a time after {}", text(*earlier)));
            }
        }
        let (Some((first, first_line)), Some((last, last_line))) = (self.times.first(), self.times.last())
        else {
            let place = FileLocation::Line(self.line);
            return Err(FileError::value(self.path, place, "data", "missing", "records after the metadata"));
        };
        if *first > coverage.start + ROUNDING {
            let expected =
                format!("a first record not after the start of the span, {}", text(coverage.start));
            return refused(*first_line, text(*first), expected);
        }
        if *last < coverage.stop - ROUNDING {
            let expected = format!(
                "a last record not before the end of the span, {}: the file is truncated, or its times are \
                 wrong",
                text(coverage.stop)
            );
            return refused(*last_line, text(*last), expected);
        }
        Ok(())
    }
}

/// Segment of an ephemeris message, of an orbit or of an attitude.
pub(crate) trait EphemerisSegment: Sized {
    /// Reads the segment.
    fn read(path: &Path, segment: &Segment<'_>) -> Result<Self, FileError>;

    /// Returns the names that all segments of a message share, with their keywords in `metadata`.
    fn names(&self, metadata: &Record<'_>) -> Vec<(&'static str, &str)>;

    /// Returns the span within which the records may be used.
    fn coverage(&self) -> Coverage;

    /// Returns the time system.
    fn time_system(&self) -> TimeSystem;

    /// Returns the interpolation that applies, stated or not.
    fn applied_interpolation(&self) -> Interpolation;

    /// Returns the number of records.
    fn record_count(&self) -> usize;
}

/// Reads the segments of an ephemeris message: of one spacecraft, in order of time, sharing no more than an
/// instant, each with enough records for its interpolation.
pub(crate) fn read_segments<S: EphemerisSegment>(
    path: &Path,
    document: &Document<'_>,
) -> Result<Vec<S>, FileError> {
    let read = document.segments.iter().map(|segment| S::read(path, segment));
    let segments: Vec<S> = read.collect::<Result<_, _>>()?;
    let with_metadata = || segments.iter().zip(document.segments.iter().map(|segment| &segment.metadata));
    let Some((first, first_metadata)) = with_metadata().next() else { return Ok(segments) };
    let first_names = first.names(first_metadata);
    for (segment, metadata) in with_metadata() {
        for ((keyword, name), (_, first)) in segment.names(metadata).into_iter().zip(&first_names) {
            if !name.eq_ignore_ascii_case(first) {
                let expected = format!("{first}, as in the first segment");
                return Err(metadata.refuse(metadata.require(keyword)?, expected));
            }
        }
        check_count(path, metadata.line, segment.applied_interpolation(), segment.record_count())?;
    }
    check_borders(path, document, &segments, BorderRule::NoOverlap)?;
    Ok(segments)
}

/// Checks the start of each segment of an ephemeris message against the end of the segment before.
pub(crate) fn check_borders<S: EphemerisSegment>(
    path: &Path,
    document: &Document<'_>,
    segments: &[S],
    rule: BorderRule,
) -> Result<(), FileError> {
    for (pair, next) in segments.windows(2).zip(document.segments.iter().skip(1)) {
        let [earlier, later] = pair else { continue };
        let system = later.time_system();
        if let Some(expected) = rule.broken_by(&earlier.coverage(), &later.coverage(), system) {
            let place = FileLocation::Line(next.metadata.line);
            let value = format!("from {}", system.format_time(later.coverage().start));
            return Err(FileError::value(path, place, "usable span of the segment", value, expected));
        }
    }
    Ok(())
}

/// Returns the lines of the records of a segment with one name.
pub(crate) fn lines_of(segment: &Segment<'_>, name: &str) -> Vec<u64> {
    segment.data.iter().filter(|record| record.name == name).map(|record| record.line).collect()
}

/// Checks that a segment has enough records for its interpolation.
fn check_count(path: &Path, line: u64, interpolation: Interpolation, count: usize) -> Result<(), FileError> {
    if count >= interpolation.nodes() {
        return Ok(());
    }
    let Interpolation { method, degree } = interpolation;
    Err(FileError::value(
        path,
        FileLocation::Line(line),
        "number of records of the segment",
        count,
        format!("{} or more for {} of degree {degree}", interpolation.nodes(), method.code()),
    ))
}

/// Writes start and end of a segment, whose usable span is the whole.
pub(crate) fn write_coverage(writer: &mut Writer, system: TimeSystem, whole: &Coverage, usable: &Coverage) {
    writer.value("START_TIME", system.format_time(whole.start));
    if usable != whole {
        writer.value("USEABLE_START_TIME", system.format_time(usable.start));
        writer.value("USEABLE_STOP_TIME", system.format_time(usable.stop));
    }
    writer.value("STOP_TIME", system.format_time(whole.stop));
}

/// Returns the text of a message: header, and its segments within the body.
pub(super) fn write_message<S>(
    mut writer: Writer,
    header: &Header,
    segments: &[S],
    write: impl Fn(&S, &mut Writer),
) -> String {
    header.write(&mut writer);
    writer.open("body");
    for segment in segments {
        write(segment, &mut writer);
    }
    writer.close("body");
    writer.finish()
}
