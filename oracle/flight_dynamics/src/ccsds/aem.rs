//! Attitude ephemeris messages (CCSDS 504.0-B).

use std::path::Path;

use contract::{Body, Icrs, Rotation};
use files::{FileError, FileLocation};
use hifitime::Epoch;
use nalgebra::Vector4;

use super::common::{
    EphemerisSegment, Header, NO_DESIGNATOR, Times, check_center, lines_of, read_coverage,
    read_interpolation, read_segments, read_time_system, write_coverage, write_message,
};
use crate::coverage::{Coverage, seconds_between};
use crate::document::{self, Document, Kind, Notation, Record, Segment, Writer};
use crate::ephemeris::{AttitudeEphemeris, AttitudeNodes};
use crate::frame::{FRAME_NAMES, FileAxes, ReferenceFrame};
use crate::interpolation::{Interpolation, Method};
use crate::physics::{PointingNode, check_pointing, check_pointing_border};
use crate::time::TimeSystem;

/// Keywords of the metadata of versions 1 and 2.
const METADATA: [&str; 17] = [
    "OBJECT_NAME",
    "OBJECT_ID",
    "CENTER_NAME",
    "REF_FRAME_A",
    "REF_FRAME_B",
    "ATTITUDE_DIR",
    "TIME_SYSTEM",
    "START_TIME",
    "USEABLE_START_TIME",
    "USEABLE_STOP_TIME",
    "STOP_TIME",
    "ATTITUDE_TYPE",
    "QUATERNION_TYPE",
    "RATE_FRAME",
    "ANGVEL_FRAME",
    "INTERPOLATION_METHOD",
    "INTERPOLATION_DEGREE",
];

/// Types that are read: those with a quaternion. Rates beside it are not used.
const TYPES: [&str; 4] = ["QUATERNION", "QUATERNION/DERIVATIVE", "QUATERNION/RATE", "QUATERNION/ANGVEL"];

/// Name of the frame of the spacecraft's body in written messages.
pub const BODY_FRAME: &str = "SC_BODY_1";

/// Name of the frame of the camera in written messages.
pub const CAMERA_FRAME: &str = "INSTRUMENT_1";

/// Quaternions with norms further from 1 than this are refused; five decimals give 1e-5.
const NORM_TOLERANCE: f64 = 1e-4;

/// Direction of the rotations of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttitudeDirection {
    /// From the celestial frame to the body.
    BodyFromFrame,
    /// From the body to the celestial frame.
    FrameFromBody,
}

/// Attitude at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttitudeNode {
    /// Time.
    pub time: Epoch,
    /// Quaternion of CCSDS: Q1, Q2, Q3 and the scalar QC. It turns the axes of frame A onto those of frame B;
    /// our quaternions, which turn components, are its conjugate.
    pub q1_q2_q3_qc: [f64; 4],
}

/// Attitudes of one spacecraft within one span.
#[derive(Debug, Clone, PartialEq)]
pub struct AemSegment {
    /// Name of the spacecraft.
    pub object_name: String,
    /// International designator.
    pub object_id: String,
    /// Celestial frame.
    pub frame: ReferenceFrame,
    /// Name of the frame of the spacecraft: [`BODY_FRAME`], [`CAMERA_FRAME`], or another one of these kinds.
    pub body_frame: String,
    /// Direction of the quaternions.
    pub direction: AttitudeDirection,
    /// Time system of the message.
    pub time_system: TimeSystem,
    /// Span within which the attitudes may be used.
    pub coverage: Coverage,
    /// Interpolation; `None` if the message states none.
    pub interpolation: Option<Interpolation>,
    /// Attitudes in order of time.
    pub attitudes: Vec<AttitudeNode>,
}

/// Attitude ephemeris message.
#[derive(Debug, Clone, PartialEq)]
pub struct Aem {
    /// Header.
    pub header: Header,
    /// Segments in order of time.
    pub segments: Vec<AemSegment>,
}

impl AttitudeNode {
    /// Creates a node of a segment with the axes ICRF and the direction [`AttitudeDirection::BodyFromFrame`],
    /// from the attitude of the body or of the camera.
    pub fn from_rotation<F>(time: Epoch, attitude: &Rotation<F, Icrs>) -> Self {
        let [w, x, y, z] = attitude.wxyz();
        Self { time, q1_q2_q3_qc: [-x, -y, -z, w] }
    }

    fn body_from_icrs(&self, segment: &AemSegment) -> Rotation<Body, Icrs> {
        let [q1, q2, q3, qc] = self.q1_q2_q3_qc;
        let [q1, q2, q3] = match segment.direction {
            AttitudeDirection::BodyFromFrame => [-q1, -q2, -q3],
            AttitudeDirection::FrameFromBody => [q1, q2, q3],
        };
        let quaternion = nalgebra::Quaternion::new(qc, q1, q2, q3);
        let body_from_frame: Rotation<Body, FileAxes> =
            Rotation::from_unit_quaternion(nalgebra::UnitQuaternion::new_normalize(quaternion));
        body_from_frame * segment.frame.icrs_from_frame(self.time).inverse()
    }
}

impl Aem {
    /// Reads a file.
    ///
    /// # Errors
    /// [`FileError`] with line and field for a file that is not an AEM, is truncated, has segments of
    /// different spacecraft or overlapping spans, or a value that is not supported: an attitude without a
    /// quaternion, or a frame outside [`ReferenceFrame`].
    pub fn read(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Aem, |document| Self::from_document(path, document))
    }

    /// Reads a file with the attitude of the spacecraft's body, and not of an instrument.
    ///
    /// # Errors
    /// Those of [`Aem::read`]; [`FileError::Value`] with line and field of an instrument's frame.
    pub fn read_of_body(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Aem, |document| Self::of_body(path, document))
    }

    /// [`Aem::read_of_body`] with a check that a spacecraft can turn as the attitudes do. Returns the
    /// message, and remarks on unusual attitudes with their lines.
    ///
    /// # Errors
    /// Those of [`Aem::read_of_body`]; [`FileError::Value`] with the line of an attitude that its neighbours
    /// contradict, and the likely slip.
    pub fn read_pointing(path: &Path) -> Result<(Self, Vec<String>), FileError> {
        document::read(path, Kind::Aem, |document| {
            let aem = Self::of_body(path, document)?;
            let mut remarks = Vec::new();
            let mut last: Option<PointingNode> = None;
            for (segment, read) in aem.segments.iter().zip(&document.segments) {
                let epoch = aem.segments.first().map_or(segment.coverage.start, |first| first.coverage.start);
                let nodes = segment.pointing_nodes(epoch, &lines_of(read, "attitudeState"));
                if let (Some(before), Some(after)) = (last, nodes.first()) {
                    remarks.extend(check_pointing_border(path, &before, after));
                }
                remarks.extend(check_pointing(path, &nodes)?);
                last = nodes.last().copied();
            }
            Ok((aem, remarks))
        })
    }

    fn of_body(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let aem = Self::from_document(path, document)?;
        for (segment, read) in document.segments.iter().zip(&aem.segments) {
            if !is_body_frame(&read.body_frame) {
                let entry = segment.metadata.require(body_keyword(&segment.metadata))?;
                return Err(segment.metadata.refuse(entry, "SC_BODY_1 or another frame of the body"));
            }
        }
        Ok(aem)
    }

    /// [`Aem::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Aem::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Aem, |document| Self::from_document(path, document))
    }

    fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let header = Header::read(&document.header)?;
        // Version 1 has no default, and both directions are in use.
        if document.header.require(Kind::Aem.version_keyword())?.value == "1.0" {
            for segment in &document.segments {
                segment.metadata.require("ATTITUDE_DIR")?;
            }
        }
        let segments = read_segments(path, document)?;
        Ok(Self { header, segments })
    }

    /// Returns the attitude that the message describes. LINEAR, also without a statement, is the shortest
    /// turn at a constant rate; LAGRANGE and HERMITE are the polynomial of the stated degree through the
    /// components of the quaternions, normalised (the message has no derivatives).
    pub fn ephemeris(&self) -> AttitudeEphemeris {
        let segments = self.segments.iter().map(|segment| {
            let nodes = segment.attitudes.iter().map(|node| (node.time, node.body_from_icrs(segment)));
            AttitudeNodes::new(segment.coverage, segment.applied_interpolation(), nodes)
        });
        AttitudeEphemeris::new(segments.collect())
    }

    /// Returns the message in keyword-value notation, version 1.0.
    pub fn to_kvn(&self) -> String {
        self.to_text(Notation::Kvn)
    }

    /// Returns the message in XML, version 1.0.
    pub fn to_xml(&self) -> String {
        self.to_text(Notation::Xml)
    }

    /// Returns the message in a notation, version 1.0, which more tools read than 2.0.
    pub fn to_text(&self, notation: Notation) -> String {
        let writer = Writer::new(Kind::Aem, notation, "1.0");
        write_message(writer, &self.header, &self.segments, AemSegment::write)
    }
}

/// Returns true for the name of a frame of the spacecraft's body.
fn is_body_frame(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    name.starts_with("SC_BODY") || name.starts_with("SC BODY")
}

/// Returns true for the name of a frame of an instrument.
fn is_instrument_frame(name: &str) -> bool {
    name.to_ascii_uppercase().starts_with("INSTRUMENT")
}

/// Returns the keyword that names the frame of the spacecraft.
fn body_keyword(metadata: &Record<'_>) -> &'static str {
    let is_frame =
        |keyword| metadata.find(keyword).is_some_and(|entry| ReferenceFrame::parse(entry.value).is_some());
    if is_frame("REF_FRAME_B") { "REF_FRAME_A" } else { "REF_FRAME_B" }
}

/// Reads the frames and the direction. Version 1 states the direction; in version 2 it is from A to B.
fn read_frames(metadata: &Record<'_>) -> Result<(ReferenceFrame, String, AttitudeDirection), FileError> {
    let (a, b) = (metadata.require("REF_FRAME_A")?, metadata.require("REF_FRAME_B")?);
    let is_a_to_b = match metadata.find("ATTITUDE_DIR") {
        None => true,
        Some(entry) => match entry.value.to_ascii_uppercase().as_str() {
            "A2B" => true,
            "B2A" => false,
            _ => return Err(metadata.refuse(entry, "A2B or B2A")),
        },
    };
    let body = |entry: &document::Entry<'_>| {
        if is_body_frame(entry.value) || is_instrument_frame(entry.value) {
            Ok(entry.value.to_owned())
        } else {
            Err(metadata.refuse(entry, "SC_BODY_1, INSTRUMENT_1 or another frame of these kinds"))
        }
    };
    let (frame, body_frame, frame_is_a) =
        match (ReferenceFrame::parse(a.value), ReferenceFrame::parse(b.value)) {
            (Some(frame), None) => (frame, body(b)?, true),
            (None, Some(frame)) => (frame, body(a)?, false),
            (None, None) => return Err(metadata.refuse(a, FRAME_NAMES)),
            (Some(_), Some(_)) => {
                return Err(metadata.refuse(b, "SC_BODY_1 or another frame of the spacecraft"));
            }
        };
    let direction = if is_a_to_b == frame_is_a {
        AttitudeDirection::BodyFromFrame
    } else {
        AttitudeDirection::FrameFromBody
    };
    Ok((frame, body_frame, direction))
}

impl EphemerisSegment for AemSegment {
    fn read(path: &Path, segment: &Segment<'_>) -> Result<Self, FileError> {
        let metadata = &segment.metadata;
        let type_entry = metadata.require("ATTITUDE_TYPE")?;
        if !TYPES.iter().any(|name| type_entry.value.eq_ignore_ascii_case(name)) {
            return Err(metadata.refuse(type_entry, format!("one of {}", TYPES.join(", "))));
        }
        metadata.check_keywords(&METADATA)?;
        if let Some(entry) = metadata.find("QUATERNION_TYPE")
            && !["FIRST", "LAST"].iter().any(|name| entry.value.eq_ignore_ascii_case(name))
        {
            return Err(metadata.refuse(entry, "FIRST or LAST"));
        }
        let time_system = read_time_system(metadata)?;
        let (frame, body_frame, direction) = read_frames(metadata)?;
        check_center(metadata, metadata.find("CENTER_NAME"))?;
        let coverage = read_coverage(metadata, time_system)?;
        let mut attitudes = Vec::new();
        let mut times = Times { path, system: time_system, times: Vec::new(), line: metadata.line };
        for record in &segment.data {
            if record.name != "attitudeState" {
                let place = FileLocation::Line(record.line);
                return Err(FileError::value(path, place, "element", record.name, "attitudeState"));
            }
            let time = record.time(record.require("EPOCH")?, time_system)?;
            let q1_q2_q3_qc = record.require_numbers(["Q1", "Q2", "Q3", "QC"], "")?;
            let norm = q1_q2_q3_qc.iter().map(|component| component * component).sum::<f64>().sqrt();
            if norm.is_nan() || (norm - 1.0).abs() > NORM_TOLERANCE {
                let place = FileLocation::Line(record.line);
                let expected = format!("1 within {NORM_TOLERANCE}");
                return Err(FileError::value(path, place, "norm of the quaternion", norm, expected));
            }
            times.times.push((time, record.line));
            attitudes.push(AttitudeNode { time, q1_q2_q3_qc });
        }
        times.check(&coverage)?;
        Ok(Self {
            object_name: metadata.require("OBJECT_NAME")?.value.to_owned(),
            object_id: metadata.require("OBJECT_ID")?.value.to_owned(),
            frame,
            body_frame,
            direction,
            time_system,
            coverage,
            interpolation: read_interpolation(metadata, "INTERPOLATION_METHOD")?,
            attitudes,
        })
    }

    fn names(&self, metadata: &Record<'_>) -> Vec<(&'static str, &str)> {
        vec![("OBJECT_NAME", self.object_name.as_str()), (body_keyword(metadata), self.body_frame.as_str())]
    }

    fn coverage(&self) -> Coverage {
        self.coverage
    }

    fn time_system(&self) -> TimeSystem {
        self.time_system
    }

    fn applied_interpolation(&self) -> Interpolation {
        match self.interpolation.unwrap_or(Interpolation::ATTITUDE_DEFAULT) {
            Interpolation { method: Method::Hermite, degree } => {
                Interpolation { method: Method::Lagrange, degree }
            }
            stated => stated,
        }
    }

    fn record_count(&self) -> usize {
        self.attitudes.len()
    }
}

impl AemSegment {
    /// Returns the attitudes with their lines, times in seconds since `epoch`, axes of the segment.
    fn pointing_nodes(&self, epoch: Epoch, lines: &[u64]) -> Vec<PointingNode> {
        let node = |(attitude, line): (&AttitudeNode, &u64)| {
            let [q1, q2, q3, qc] = attitude.q1_q2_q3_qc;
            PointingNode {
                time_s: seconds_between(epoch, attitude.time),
                wxyz: Vector4::new(qc, q1, q2, q3).normalize(),
                line: *line,
            }
        };
        self.attitudes.iter().zip(lines).map(node).collect()
    }

    /// Creates a segment of attitudes, axes ICRF, direction [`AttitudeDirection::BodyFromFrame`] and UTC,
    /// with turns at constant rates between them.
    ///
    /// `None` unless the attitudes ascend in time and are at least two.
    pub fn from_attitudes(object_name: &str, body_frame: &str, attitudes: Vec<AttitudeNode>) -> Option<Self> {
        let ([first, ..], [.., last]) = (attitudes.as_slice(), attitudes.as_slice()) else { return None };
        let coverage = Coverage { start: first.time, stop: last.time };
        if coverage.start >= coverage.stop || !attitudes.is_sorted_by(|a, b| a.time < b.time) {
            return None;
        }
        Some(Self {
            object_name: object_name.to_owned(),
            object_id: NO_DESIGNATOR.to_owned(),
            frame: ReferenceFrame::Icrf,
            body_frame: body_frame.to_owned(),
            direction: AttitudeDirection::BodyFromFrame,
            time_system: TimeSystem::Utc,
            coverage,
            interpolation: Some(Interpolation::ATTITUDE_DEFAULT),
            attitudes,
        })
    }

    fn write(&self, writer: &mut Writer) {
        let system = self.time_system;
        writer.open("segment");
        writer.line("META_START");
        writer.open("metadata");
        writer.value("OBJECT_NAME", &self.object_name);
        writer.value("OBJECT_ID", &self.object_id);
        writer.value("CENTER_NAME", "EARTH");
        let (a, b) = match self.direction {
            AttitudeDirection::BodyFromFrame => (self.frame.code(), self.body_frame.as_str()),
            AttitudeDirection::FrameFromBody => (self.body_frame.as_str(), self.frame.code()),
        };
        writer.value("REF_FRAME_A", a);
        writer.value("REF_FRAME_B", b);
        writer.value("ATTITUDE_DIR", "A2B");
        writer.value("TIME_SYSTEM", system.code());
        let ends = self.attitudes.first().zip(self.attitudes.last());
        let whole = ends.map_or(self.coverage, |(first, last)| Coverage {
            start: first.time.min(self.coverage.start),
            stop: last.time.max(self.coverage.stop),
        });
        write_coverage(writer, system, &whole, &self.coverage);
        writer.value("ATTITUDE_TYPE", "QUATERNION");
        writer.value("QUATERNION_TYPE", "LAST");
        if let Some(Interpolation { method, degree }) = self.interpolation {
            writer.value("INTERPOLATION_METHOD", method.code());
            writer.value("INTERPOLATION_DEGREE", degree);
        }
        writer.close("metadata");
        writer.line("META_STOP");
        writer.line("DATA_START");
        writer.open("data");
        for node in &self.attitudes {
            let [q1, q2, q3, qc] = node.q1_q2_q3_qc;
            let time = system.format_time(node.time);
            if writer.notation() == Notation::Kvn {
                writer.line(&format!("{time} {q1} {q2} {q3} {qc}"));
                continue;
            }
            writer.open("attitudeState");
            writer.open("quaternionState");
            writer.value("EPOCH", time);
            writer.open("quaternion");
            for (keyword, value) in ["Q1", "Q2", "Q3", "QC"].into_iter().zip([q1, q2, q3, qc]) {
                writer.number(keyword, value, "");
            }
            writer.close("quaternion");
            writer.close("quaternionState");
            writer.close("attitudeState");
        }
        writer.close("data");
        writer.line("DATA_STOP");
        writer.close("segment");
    }
}
