//! Attitude ephemeris messages (CCSDS 504.0-B).

use std::path::Path;

use contract::{Body, Icrs, Rotation};
use files::{FileError, FileLocation};
use hifitime::Epoch;

use super::common::{
    Header, Times, check_center, check_count, check_order, read_coverage, read_interpolation,
    read_time_system, write_coverage, write_message,
};
use crate::coverage::Coverage;
use crate::document::{self, Document, Kind, Notation, Record, Segment, Writer};
use crate::ephemeris::{AttitudeEphemeris, AttitudeNodes};
use crate::frame::{FRAME_NAMES, FileAxes, ReferenceFrame};
use crate::interpolation::Interpolation;
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
    /// Name of the body frame, as SC_BODY_1.
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
    /// Creates a node of a segment with the axes ICRF and the direction [`AttitudeDirection::BodyFromFrame`].
    pub fn from_rotation(time: Epoch, body_from_icrs: &Rotation<Body, Icrs>) -> Self {
        let [w, x, y, z] = body_from_icrs.wxyz();
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

    /// [`Aem::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Aem::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Aem, |document| Self::from_document(path, document))
    }

    fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let header = Header::read(&document.header)?;
        let segments: Vec<AemSegment> = document
            .segments
            .iter()
            .map(|segment| AemSegment::read(path, segment))
            .collect::<Result<_, _>>()?;
        for (segment, read) in document.segments.iter().zip(&segments) {
            let Some(first) = segments.first() else { break };
            for (keyword, value, first) in [
                ("OBJECT_NAME", &read.object_name, &first.object_name),
                (segment_body_keyword(segment), &read.body_frame, &first.body_frame),
            ] {
                if !value.eq_ignore_ascii_case(first) {
                    let entry = segment.metadata.require(keyword)?;
                    return Err(segment.metadata.refuse(entry, format!("{first}, as in the first segment")));
                }
            }
        }
        let lines = document.segments.iter().map(|segment| segment.metadata.line);
        let spans: Vec<_> = segments.iter().map(|segment| segment.coverage).zip(lines).collect();
        let system =
            |index: usize| segments.get(index).map_or(TimeSystem::Utc, |segment| segment.time_system);
        check_order(path, system, &spans)?;
        for (segment, line) in segments.iter().zip(spans.iter().map(|(_, line)| *line)) {
            check_count(path, line, segment.polynomial(), segment.attitudes.len())?;
        }
        Ok(Self { header, segments })
    }

    /// Returns the attitude that the message describes. LINEAR, also without a statement, is the shortest
    /// turn at a constant rate; LAGRANGE and HERMITE are the polynomial of the stated degree through the
    /// components of the quaternions, normalised (the message has no derivatives).
    pub fn ephemeris(&self) -> AttitudeEphemeris {
        let segments = self.segments.iter().map(|segment| {
            let nodes = segment.attitudes.iter().map(|node| (node.time, node.body_from_icrs(segment)));
            AttitudeNodes::new(segment.coverage, segment.polynomial(), nodes)
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

/// Returns the keyword that names the body.
fn segment_body_keyword(segment: &Segment<'_>) -> &'static str {
    let is_frame = |keyword| {
        segment.metadata.find(keyword).is_some_and(|entry| ReferenceFrame::parse(entry.value).is_some())
    };
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
        let name = entry.value.to_ascii_uppercase();
        if name.starts_with("SC_BODY") || name.starts_with("SC BODY") {
            Ok(entry.value.to_owned())
        } else {
            Err(metadata.refuse(entry, "SC_BODY_1 or another frame SC_BODY of the spacecraft"))
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

impl AemSegment {
    fn polynomial(&self) -> Interpolation {
        use crate::interpolation::Method;
        match self.interpolation.unwrap_or(Interpolation::ATTITUDE_DEFAULT) {
            Interpolation { method: Method::Hermite, degree } => {
                Interpolation { method: Method::Lagrange, degree }
            }
            stated => stated,
        }
    }

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
