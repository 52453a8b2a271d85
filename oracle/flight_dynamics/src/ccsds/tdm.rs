//! Tracking data messages (CCSDS 503.0-B) with angles of right ascension and declination.

use std::path::Path;

use contract::{Angle, Direction, Icrs};
use files::{FileError, FileLocation};
use hifitime::Epoch;

use super::common::{Header, read_frame, read_time_system, write_message};
use crate::document::{self, Document, Entry, Kind, Notation, Segment, Writer};
use crate::frame::{FileAxes, ReferenceFrame};
use crate::time::TimeSystem;

/// Right ascension and declination at an instant, in the axes of the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Time.
    pub time: Epoch,
    /// Right ascension (ANGLE_1), degrees, −180 to 360.
    pub right_ascension_deg: f64,
    /// Declination (ANGLE_2), degrees, −90 to 90.
    pub declination_deg: f64,
}

/// Angles between two participants.
#[derive(Debug, Clone, PartialEq)]
pub struct TdmSegment {
    /// Comments on the data, written one line each; not read.
    pub comments: Vec<String>,
    /// Participant that measures.
    pub observer: String,
    /// Participant that is measured.
    pub target: String,
    /// Axes of the angles.
    pub frame: ReferenceFrame,
    /// Time system of the message.
    pub time_system: TimeSystem,
    /// Pairs of angles in order of time.
    pub observations: Vec<Observation>,
}

/// Tracking data message.
#[derive(Debug, Clone, PartialEq)]
pub struct Tdm {
    /// Header.
    pub header: Header,
    /// Segments.
    pub segments: Vec<TdmSegment>,
}

impl Observation {
    /// Creates the observation of a direction in a segment with the axes ICRF.
    pub fn from_direction(time: Epoch, direction: &Direction<Icrs>) -> Self {
        let right_ascension_deg = direction.ra().degrees();
        Self { time, right_ascension_deg, declination_deg: direction.dec().degrees() }
    }

    /// Returns the direction from the observer to the target, ICRS axes; `frame` is that of the segment.
    pub fn direction(&self, frame: ReferenceFrame) -> Direction<Icrs> {
        let in_frame = Direction::from_ra_dec(
            Angle::from_degrees(self.right_ascension_deg),
            Angle::from_degrees(self.declination_deg),
        );
        frame.icrs_from_frame(self.time) * Direction::<FileAxes>::from_unit(*in_frame.vector())
    }
}

impl Tdm {
    /// Reads a file. Every segment has angles of the type RADEC; other observations are refused.
    ///
    /// # Errors
    /// [`FileError`] with line and field for a file that is not a TDM, is truncated, has an angle without its
    /// partner, or a value that is not supported.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Tdm, |document| Self::from_document(path, document))
    }

    /// [`Tdm::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Tdm::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Tdm, |document| Self::from_document(path, document))
    }

    fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let header = Header::read(&document.header)?;
        let segments = document.segments.iter().map(|segment| TdmSegment::read(path, segment));
        Ok(Self { header, segments: segments.collect::<Result<_, _>>()? })
    }

    /// Returns the message in keyword-value notation, version 2.0.
    pub fn to_kvn(&self) -> String {
        self.to_text(Notation::Kvn)
    }

    /// Returns the message in XML, version 2.0.
    pub fn to_xml(&self) -> String {
        self.to_text(Notation::Xml)
    }

    /// Returns the message in a notation, version 2.0.
    pub fn to_text(&self, notation: Notation) -> String {
        let writer = Writer::new(Kind::Tdm, notation, "2.0");
        write_message(writer, &self.header, &self.segments, TdmSegment::write)
    }
}

impl TdmSegment {
    fn read(path: &Path, segment: &Segment<'_>) -> Result<Self, FileError> {
        let metadata = &segment.metadata;
        let require = |keyword: &str, expected: &[&str]| {
            let entry = metadata.require(keyword)?;
            if expected.iter().any(|value| entry.value.eq_ignore_ascii_case(value)) {
                Ok(())
            } else {
                Err(metadata.refuse(entry, expected.join(" or ")))
            }
        };
        let time_system = read_time_system(metadata)?;
        require("ANGLE_TYPE", &["RADEC"])?;
        let frame = read_frame(metadata, "REFERENCE_FRAME")?;
        if let Some(entry) = metadata.find("ANGLE_UNITS")
            && !entry.value.eq_ignore_ascii_case("deg")
        {
            return Err(metadata.refuse(entry, "deg"));
        }
        // A path names the participants in the order of the signal: from the target to the observer.
        let participant = |number: &str| -> Result<String, FileError> {
            Ok(metadata.require(&format!("PARTICIPANT_{number}"))?.value.to_owned())
        };
        let path_entry = metadata.require("PATH")?;
        let numbers: Vec<&str> = path_entry.value.split(',').map(str::trim).collect();
        let [target, observer] = numbers.as_slice() else {
            return Err(
                metadata.refuse(path_entry, "two participants, as 2,1: from the target to the observer")
            );
        };
        let mut observations = Vec::new();
        let mut pending: Option<(Epoch, f64, u64)> = None;
        let unpaired = |line: u64, time: Epoch| {
            let expected = "ANGLE_2 of the same time directly after it";
            let value = time_system.format_time(time);
            FileError::value(path, FileLocation::Line(line), "ANGLE_1", value, expected)
        };
        for record in &segment.data {
            let time = record.time(record.require("EPOCH")?, time_system)?;
            let is_angle = |entry: &&Entry<'_>| entry.keyword != "EPOCH";
            let Some(entry) = record.entries.iter().find(is_angle) else {
                return Err(record.require("ANGLE_1").err().unwrap_or_else(|| unpaired(record.line, time)));
            };
            let value = record.number(entry, "deg")?;
            match (entry.keyword, pending.take()) {
                ("ANGLE_1", None) if (-180.0..=360.0).contains(&value) => {
                    pending = Some((time, value, record.line));
                }
                ("ANGLE_1", None) => return Err(record.refuse(entry, "−180 to 360 degrees")),
                ("ANGLE_2", Some((first, right_ascension_deg, _))) if first == time => {
                    if !(-90.0..=90.0).contains(&value) {
                        return Err(record.refuse(entry, "−90 to 90 degrees"));
                    }
                    observations.push(Observation { time, right_ascension_deg, declination_deg: value });
                }
                (_, Some((first, _, line))) => return Err(unpaired(line, first)),
                ("ANGLE_2", None) => {
                    return Err(record.refuse(entry, "ANGLE_1 of the same time directly before it"));
                }
                (other, None) => {
                    let place = FileLocation::Line(entry.line);
                    return Err(FileError::value(path, place, "keyword", other, "ANGLE_1 or ANGLE_2"));
                }
            }
        }
        if let Some((time, _, line)) = pending {
            return Err(unpaired(line, time));
        }
        Ok(Self {
            comments: Vec::new(),
            observer: participant(observer)?,
            target: participant(target)?,
            frame,
            time_system,
            observations,
        })
    }

    fn write(&self, writer: &mut Writer) {
        let system = self.time_system;
        writer.open("segment");
        writer.line("META_START");
        writer.open("metadata");
        for comment in &self.comments {
            writer.comment(comment);
        }
        writer.value("TIME_SYSTEM", system.code());
        if let Some((first, last)) = self.observations.first().zip(self.observations.last()) {
            writer.value("START_TIME", system.format_time(first.time));
            writer.value("STOP_TIME", system.format_time(last.time));
        }
        writer.value("PARTICIPANT_1", &self.observer);
        writer.value("PARTICIPANT_2", &self.target);
        writer.value("MODE", "SEQUENTIAL");
        writer.value("PATH", "2,1");
        writer.value("ANGLE_TYPE", "RADEC");
        // The schema of the format lists ICRF, and not GCRF.
        let frame = if self.frame == ReferenceFrame::Icrf { "ICRF" } else { self.frame.code() };
        writer.value("REFERENCE_FRAME", frame);
        writer.close("metadata");
        writer.line("META_STOP");
        writer.line("DATA_START");
        writer.open("data");
        for observation in &self.observations {
            let time = system.format_time(observation.time);
            let angles =
                [("ANGLE_1", observation.right_ascension_deg), ("ANGLE_2", observation.declination_deg)];
            for (keyword, value) in angles {
                if writer.notation() == Notation::Kvn {
                    writer.line(&format!("{keyword} = {time} {value}"));
                    continue;
                }
                writer.open("observation");
                writer.value("EPOCH", &time);
                writer.number(keyword, value, "");
                writer.close("observation");
            }
        }
        writer.close("data");
        writer.line("DATA_STOP");
        writer.close("segment");
    }
}
