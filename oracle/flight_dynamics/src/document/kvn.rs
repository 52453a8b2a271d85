//! Keyword-value notation.

use std::path::Path;

use files::{FileError, FileLocation};

use super::keywords::{COVARIANCE, opm_element};
use super::kind::Kind;
use super::message::{Document, Segment};
use super::record::{Entry, Record};

/// Keywords of the header, besides the version.
const HEADER: [&str; 5] =
    ["CREATION_DATE", "ORIGINATOR", "MESSAGE_ID", "CLASSIFICATION", "OBJECT_DESIGNATOR"];

/// Keywords of an OPM's metadata: its KVN has no marks around them.
const OPM_METADATA: [&str; 6] =
    ["OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "REF_FRAME_EPOCH", "TIME_SYSTEM"];

/// Keywords of a line of ephemeris; the accelerations are optional.
const STATE: [&str; 10] = ["EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT", "X_DDOT", "Y_DDOT", "Z_DDOT"];

/// Columns of an attitude, by type: those of versions 1 and 2 with the scalar last.
const QUATERNION_LAST: [&str; 9] =
    ["EPOCH", "Q1", "Q2", "Q3", "QC", "extra_1", "extra_2", "extra_3", "extra_4"];
/// Columns of an attitude of version 1 with `QUATERNION_TYPE = FIRST`.
const QUATERNION_FIRST: [&str; 9] =
    ["EPOCH", "QC", "Q1", "Q2", "Q3", "extra_1", "extra_2", "extra_3", "extra_4"];

/// Line of a file that is neither blank nor a comment.
#[derive(Debug, Clone, Copy)]
struct Line<'a> {
    number: u64,
    text: &'a str,
}

impl<'a> Line<'a> {
    /// Returns keyword and value of a line `KEYWORD = value`.
    fn entry(self) -> Option<Entry<'a>> {
        let (keyword, value) = self.text.split_once('=')?;
        Some(Entry { keyword: keyword.trim(), value: value.trim(), unit: None, line: self.number })
    }
}

/// Part of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Header,
    Metadata,
    Data,
    Covariance,
    /// After the data of an AEM or TDM, and before the next segment.
    Between,
}

impl Part {
    /// Returns the mark that ends the part, if it must have one.
    fn end(self, kind: Kind) -> Option<&'static str> {
        match self {
            Self::Metadata => Some("META_STOP"),
            Self::Data if matches!(kind, Kind::Aem | Kind::Tdm) => Some("DATA_STOP"),
            Self::Covariance => Some("COVARIANCE_STOP"),
            _ => None,
        }
    }
}

/// Separates a file into records.
pub(super) fn document<'a>(path: &'a Path, text: &'a str, kind: Kind) -> Result<Document<'a>, FileError> {
    let mut lines = text.lines().zip(1..).filter_map(|(text, number)| {
        let text = text.trim();
        let is_comment = text.strip_prefix("COMMENT").is_some_and(|rest| {
            rest.is_empty() || rest.starts_with(|first: char| first.is_whitespace() || first == '=')
        });
        (!text.is_empty() && !is_comment).then_some(Line { number, text })
    });
    let mut header = Record::new(path, "header", 1);
    let first = lines.next().and_then(|line| line.entry().ok_or(line).ok());
    match first {
        Some(entry) if entry.keyword == kind.version_keyword() => header.entries.push(entry),
        _ => {
            let reason = format!("its first line is not `{} = …`", kind.version_keyword());
            return Err(FileError::format(path, kind.name(), reason));
        }
    }
    if kind == Kind::Opm { opm(header, lines) } else { Reader::new(header, kind).read(lines) }
}

/// State of reading a message with marked segments.
struct Reader<'a> {
    kind: Kind,
    part: Part,
    header: Record<'a>,
    segments: Vec<Segment<'a>>,
    last_line: u64,
}

impl<'a> Reader<'a> {
    fn new(header: Record<'a>, kind: Kind) -> Self {
        Self { kind, part: Part::Header, header, segments: Vec::new(), last_line: 1 }
    }

    fn read(mut self, lines: impl Iterator<Item = Line<'a>>) -> Result<Document<'a>, FileError> {
        for line in lines {
            self.last_line = line.number;
            if !self.mark(line)? {
                self.content(line)?;
            }
        }
        if let Some(mark) = self.part.end(self.kind) {
            return Err(self.truncated(mark));
        }
        if self.segments.last().is_some_and(|segment| segment.data.is_empty()) {
            return Err(self.truncated("a line of data"));
        }
        Ok(Document { header: self.header, segments: self.segments })
    }

    fn truncated(&self, mark: &str) -> FileError {
        let expected = format!("{mark} before the end of the file: it is truncated");
        self.refused(self.last_line, "end of file", "missing", expected)
    }

    fn refused(&self, line: u64, field: &str, value: &str, expected: impl Into<String>) -> FileError {
        FileError::value(self.header.path, FileLocation::Line(line), field, value, expected)
    }

    /// Changes the part at a mark; returns false for a line that is no mark.
    fn mark(&mut self, line: Line<'a>) -> Result<bool, FileError> {
        let is_oem = self.kind == Kind::Oem;
        let next = match (line.text, self.part) {
            ("META_START", Part::Header | Part::Between) => Part::Metadata,
            ("META_START", Part::Data) if is_oem => Part::Metadata,
            ("META_STOP", Part::Metadata) if is_oem => Part::Data,
            ("META_STOP", Part::Metadata) => Part::Between,
            ("DATA_START", Part::Between) if !is_oem && !self.segments.is_empty() => Part::Data,
            ("DATA_STOP", Part::Data) if !is_oem => Part::Between,
            ("COVARIANCE_START", Part::Data) if is_oem => Part::Covariance,
            ("COVARIANCE_STOP", Part::Covariance) => Part::Data,
            (
                "META_START" | "META_STOP" | "DATA_START" | "DATA_STOP" | "COVARIANCE_START"
                | "COVARIANCE_STOP",
                part,
            ) => {
                let expected = match part.end(self.kind) {
                    Some(end) => format!("{end} before it"),
                    None => "it in its place: META_START, META_STOP, data".to_owned(),
                };
                return Err(self.refused(line.number, "mark", line.text, expected));
            }
            _ => return Ok(false),
        };
        if next == Part::Metadata {
            let metadata = Record::new(self.header.path, "metadata", line.number);
            self.segments.push(Segment { metadata, data: Vec::new() });
        }
        self.part = next;
        Ok(true)
    }

    /// Adds a line to the current part.
    fn content(&mut self, line: Line<'a>) -> Result<(), FileError> {
        let path = self.header.path;
        let needs_entry =
            || FileError::value(path, FileLocation::Line(line.number), "line", line.text, "KEYWORD = value");
        match (self.part, self.segments.last_mut()) {
            (Part::Header, _) => {
                let entry = line.entry().ok_or_else(needs_entry)?;
                if !HEADER.contains(&entry.keyword) {
                    let expected = format!("META_START or one of {}", HEADER.join(", "));
                    return Err(self.refused(line.number, "keyword", entry.keyword, expected));
                }
                self.header.entries.push(entry);
            }
            (Part::Metadata, Some(segment)) => {
                segment.metadata.entries.push(line.entry().ok_or_else(needs_entry)?);
            }
            (Part::Data, Some(segment)) => {
                let record = match self.kind {
                    Kind::Oem => columns(path, "stateVector", line, &STATE, &[7, 10])?,
                    Kind::Aem => attitude(path, line, &segment.metadata)?,
                    _ => observation(path, line)?,
                };
                segment.data.push(record);
            }
            (Part::Covariance, Some(segment)) => covariance_line(path, segment, line)?,
            (Part::Between, _) | (_, None) => {
                let expected = "META_START or DATA_START";
                return Err(self.refused(line.number, "line", line.text, expected));
            }
        }
        Ok(())
    }
}

/// Reads a line of columns; `counts` are the accepted numbers of columns.
fn columns<'a>(
    path: &'a Path,
    name: &'static str,
    line: Line<'a>,
    keywords: &[&'static str],
    counts: &[usize],
) -> Result<Record<'a>, FileError> {
    let mut record = Record::new(path, name, line.number);
    record.entries.reserve_exact(7);
    let count = line.text.split_whitespace().count();
    if !counts.contains(&count) {
        let words: Vec<String> = counts.iter().map(ToString::to_string).collect();
        let names: Vec<&str> = keywords.iter().take(counts.first().copied().unwrap_or(0)).copied().collect();
        let expected = format!("{} columns: {}", words.join(" or "), names.join(" "));
        let place = FileLocation::Line(line.number);
        return Err(FileError::value(path, place, "number of columns", count, expected));
    }
    let values = line.text.split_whitespace().zip(keywords);
    record.entries.extend(values.map(|(value, keyword)| Entry {
        keyword,
        value,
        unit: None,
        line: line.number,
    }));
    Ok(record)
}

/// Reads a line of attitude. Types without a quaternion are refused by the reader of the metadata.
fn attitude<'a>(path: &'a Path, line: Line<'a>, metadata: &Record<'a>) -> Result<Record<'a>, FileError> {
    let value = |keyword| metadata.find(keyword).map_or("", |entry| entry.value);
    let is_first = value("QUATERNION_TYPE").eq_ignore_ascii_case("FIRST");
    let keywords = if is_first { &QUATERNION_FIRST } else { &QUATERNION_LAST };
    let count = match value("ATTITUDE_TYPE").to_ascii_uppercase().as_str() {
        "QUATERNION/DERIVATIVE" => 9,
        "QUATERNION/RATE" | "QUATERNION/ANGVEL" => 8,
        _ => 5,
    };
    columns(path, "attitudeState", line, keywords, &[count])
}

/// Reads a line `KEYWORD = time value`.
fn observation<'a>(path: &'a Path, line: Line<'a>) -> Result<Record<'a>, FileError> {
    let parts = line.entry().and_then(|entry| {
        let (time, value) = entry.value.split_once(char::is_whitespace)?;
        Some((entry, time, value.trim_start()))
    });
    let Some((entry, time, value)) = parts else {
        let place = FileLocation::Line(line.number);
        return Err(FileError::value(path, place, "line", line.text, "KEYWORD = time value"));
    };
    let mut record = Record::new(path, "observation", line.number);
    record.entries = vec![Entry { keyword: "EPOCH", value: time, ..entry }, Entry { value, ..entry }];
    Ok(record)
}

/// Adds a line to a covariance: `EPOCH = …` begins one, `COV_REF_FRAME = …` belongs to it, other lines are
/// rows of its lower triangle.
fn covariance_line<'a>(path: &'a Path, segment: &mut Segment<'a>, line: Line<'a>) -> Result<(), FileError> {
    let refused = |field: &str, value: &str, expected: String| {
        Err(FileError::value(path, FileLocation::Line(line.number), field, value, expected))
    };
    let numbers = |record: &Record<'_>| {
        record.entries.iter().filter(|entry| COVARIANCE.contains(&entry.keyword)).count()
    };
    if let Some(entry) = line.entry() {
        if entry.keyword == "EPOCH" {
            let mut record = Record::new(path, "covarianceMatrix", line.number);
            record.entries.push(entry);
            segment.data.push(record);
            return Ok(());
        }
        return match segment.data.last_mut().filter(|record| record.name == "covarianceMatrix") {
            Some(record) if entry.keyword == "COV_REF_FRAME" && numbers(record) == 0 => {
                record.entries.push(entry);
                Ok(())
            }
            _ => refused("keyword", entry.keyword, "EPOCH, then COV_REF_FRAME or rows of numbers".to_owned()),
        };
    }
    let Some(record) = segment.data.last_mut().filter(|record| record.name == "covarianceMatrix") else {
        return refused("line", line.text, "EPOCH = time before a covariance".to_owned());
    };
    // Rows 1 to 6 have 1 to 6 numbers: n rows have n (n + 1) / 2.
    let known = numbers(record);
    let row = (1..=6).find(|row| row * (row - 1) / 2 == known);
    let count = line.text.split_whitespace().count();
    if row != Some(count) {
        let expected = match row {
            Some(row) => format!("{row} numbers in row {row} of the lower triangle"),
            None => "6 rows".to_owned(),
        };
        return refused("number of columns", &count.to_string(), expected);
    }
    let values = line.text.split_whitespace().zip(COVARIANCE.iter().skip(known));
    record.entries.extend(values.map(|(value, keyword)| Entry {
        keyword,
        value,
        unit: None,
        line: line.number,
    }));
    Ok(())
}

/// Separates an OPM, whose parts are recognised by their keywords.
fn opm<'a>(mut header: Record<'a>, lines: impl Iterator<Item = Line<'a>>) -> Result<Document<'a>, FileError> {
    let path = header.path;
    let mut metadata = Record::new(path, "metadata", 1);
    let mut data: Vec<Record<'a>> = Vec::new();
    for line in lines {
        if matches!(line.text, "META_START" | "META_STOP") {
            continue;
        }
        let Some(entry) = line.entry() else {
            let place = FileLocation::Line(line.number);
            return Err(FileError::value(path, place, "line", line.text, "KEYWORD = value"));
        };
        if HEADER.contains(&entry.keyword) {
            header.entries.push(entry);
            continue;
        }
        if OPM_METADATA.contains(&entry.keyword) {
            metadata.entries.push(entry);
            continue;
        }
        let name = opm_element(entry.keyword);
        let begins = entry.keyword == "MAN_EPOCH_IGNITION";
        match data.last_mut() {
            Some(record) if record.name == name && !begins => record.entries.push(entry),
            _ => {
                let mut record = Record::new(path, name, line.number);
                record.entries.push(entry);
                data.push(record);
            }
        }
    }
    Ok(Document { header, segments: vec![Segment { metadata, data }] })
}
