//! Orbit ephemeris messages (CCSDS 502.0-B).

use std::path::Path;

use files::FileError;
use hifitime::Epoch;
use nalgebra::{Matrix6, Vector3};
use sim::truth::{Interpolation as SampleInterpolation, SampledSegment, State, StateSample};

use super::common::{
    EphemerisSegment, Header, NO_DESIGNATOR, Times, check_borders, check_center, lines_of, read_coverage,
    read_frame, read_interpolation, read_segments, read_time_system, write_coverage, write_message,
};
use super::covariance::{Covariance, CovarianceFrame};
use crate::coverage::{BorderRule, Coverage, seconds_between};
use crate::document::{self, Document, Kind, Notation, Record, Segment, Writer};
use crate::ephemeris::OrbitEphemeris;
use crate::frame::ReferenceFrame;
use crate::interpolation::{Interpolation, Method};
use crate::physics::{MotionSegment, check_motion};
use crate::time::TimeSystem;

/// Keywords of the metadata.
const METADATA: [&str; 12] = [
    "OBJECT_NAME",
    "OBJECT_ID",
    "CENTER_NAME",
    "REF_FRAME",
    "REF_FRAME_EPOCH",
    "TIME_SYSTEM",
    "START_TIME",
    "USEABLE_START_TIME",
    "USEABLE_STOP_TIME",
    "STOP_TIME",
    "INTERPOLATION",
    "INTERPOLATION_DEGREE",
];

/// State at an instant, in the axes of its segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateNode {
    /// Time.
    pub time: Epoch,
    /// Position relative to the Earth's centre, km.
    pub position_km: Vector3<f64>,
    /// Velocity relative to the Earth's centre, km/s.
    pub velocity_km_s: Vector3<f64>,
}

impl StateNode {
    /// Returns the state in ICRS axes.
    pub(crate) fn to_icrs(self, frame: ReferenceFrame) -> State {
        frame.icrs_state(self.time, &self.position_km, &self.velocity_km_s)
    }

    /// Reads position and velocity of a record.
    pub(crate) fn read(record: &Record<'_>, system: TimeSystem) -> Result<Self, FileError> {
        Ok(Self {
            time: record.time(record.require("EPOCH")?, system)?,
            position_km: record.require_numbers(["X", "Y", "Z"], "km")?.into(),
            velocity_km_s: record.require_numbers(["X_DOT", "Y_DOT", "Z_DOT"], "km/s")?.into(),
        })
    }

    /// Writes position and velocity, keyword by keyword.
    pub(crate) fn write(&self, writer: &mut Writer, system: TimeSystem) {
        writer.open("stateVector");
        writer.value("EPOCH", system.format_time(self.time));
        for (keyword, value) in ["X", "Y", "Z"].into_iter().zip(&self.position_km) {
            writer.number(keyword, *value, "km");
        }
        for (keyword, value) in ["X_DOT", "Y_DOT", "Z_DOT"].into_iter().zip(&self.velocity_km_s) {
            writer.number(keyword, *value, "km/s");
        }
        writer.close("stateVector");
    }
}

/// Ephemeris of one spacecraft within one span.
#[derive(Debug, Clone, PartialEq)]
pub struct OemSegment {
    /// Name of the spacecraft.
    pub object_name: String,
    /// International designator, as 2010-028B.
    pub object_id: String,
    /// Axes of the states.
    pub frame: ReferenceFrame,
    /// Time system of the message.
    pub time_system: TimeSystem,
    /// Span within which the states may be used: the usable one if the message states it.
    pub coverage: Coverage,
    /// Interpolation; `None` if the message states none.
    pub interpolation: Option<Interpolation>,
    /// States in order of time.
    pub states: Vec<StateNode>,
    /// Covariances.
    pub covariances: Vec<Covariance>,
}

/// Orbit ephemeris message.
#[derive(Debug, Clone, PartialEq)]
pub struct Oem {
    /// Header.
    pub header: Header,
    /// Segments in order of time.
    pub segments: Vec<OemSegment>,
}

impl Oem {
    /// Reads a file.
    ///
    /// # Errors
    /// [`FileError`] with line and field for a file that is not an OEM, is truncated, has segments of
    /// different spacecraft or overlapping spans, or a value that is not supported: a central body other than
    /// the Earth, a frame outside [`ReferenceFrame`], a time system outside [`TimeSystem`].
    pub fn read(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Oem, |document| Self::from_document(path, document))
    }

    /// Reads a file whose segments follow each other without a gap.
    ///
    /// # Errors
    /// Those of [`Oem::read`]; [`FileError::Value`] with the line of the segment after a gap.
    pub fn read_without_gaps(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Oem, |document| {
            let oem = Self::from_document(path, document)?;
            check_borders(path, document, &oem.segments, BorderRule::NoGap)?;
            Ok(oem)
        })
    }

    /// Reads a file whose segments follow each other without a gap, and checks that a spacecraft can move as
    /// its states do. Returns the message, and remarks on unusual motion with their lines.
    ///
    /// # Errors
    /// Those of [`Oem::read_without_gaps`]; [`FileError::Value`] with the line of a state that no spacecraft
    /// has or that does not follow from its neighbours, and the likely slip.
    pub fn read_motion(path: &Path) -> Result<(Self, Vec<String>), FileError> {
        document::read(path, Kind::Oem, |document| {
            let oem = Self::from_document(path, document)?;
            check_borders(path, document, &oem.segments, BorderRule::NoGap)?;
            let Some(first) = oem.segments.first() else { return Ok((oem, Vec::new())) };
            let epoch = first.coverage.start;
            let segments: Vec<MotionSegment> = oem
                .segments
                .iter()
                .zip(&document.segments)
                .map(|(segment, read)| MotionSegment {
                    samples: segment.sampled_since(epoch),
                    lines: lines_of(read, "stateVector"),
                })
                .collect();
            let remarks = check_motion(path, epoch, &segments)?;
            Ok((oem, remarks))
        })
    }

    /// [`Oem::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Oem::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Oem, |document| Self::from_document(path, document))
    }

    fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let header = Header::read(&document.header)?;
        let segments = read_segments(path, document)?;
        Ok(Self { header, segments })
    }

    /// Returns the motion that the message describes, ICRS axes, interpolated as it states; without a
    /// statement by a Hermite polynomial of degree 7. Each node is turned to ICRS before the interpolation.
    pub fn ephemeris(&self) -> OrbitEphemeris {
        let segments = self
            .segments
            .iter()
            .map(|segment| (segment.coverage, segment.sampled_since(segment.coverage.start)));
        OrbitEphemeris::from_segments(segments.collect())
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
        let writer = Writer::new(Kind::Oem, notation, "2.0");
        write_message(writer, &self.header, &self.segments, OemSegment::write)
    }
}

impl EphemerisSegment for OemSegment {
    fn read(path: &Path, segment: &Segment<'_>) -> Result<Self, FileError> {
        let metadata = &segment.metadata;
        metadata.check_keywords(&METADATA)?;
        let time_system = read_time_system(metadata)?;
        let frame = read_frame(metadata, "REF_FRAME")?;
        check_center(metadata, Some(metadata.require("CENTER_NAME")?))?;
        let coverage = read_coverage(metadata, time_system)?;
        let mut states = Vec::new();
        let mut covariances = Vec::new();
        let mut covariance_frame = CovarianceFrame::Reference(frame);
        let mut times = Times { path, system: time_system, times: Vec::new(), line: metadata.line };
        for record in &segment.data {
            match record.name {
                "stateVector" => {
                    let node = StateNode::read(record, time_system)?;
                    times.times.push((node.time, record.line));
                    states.push(node);
                }
                "covarianceMatrix" => {
                    let time = record.time(record.require("EPOCH")?, time_system)?;
                    let covariance = Covariance::read(record, time, covariance_frame)?;
                    covariance_frame = covariance.frame;
                    covariances.push(covariance);
                }
                other => {
                    let place = files::FileLocation::Line(record.line);
                    let expected = "stateVector or covarianceMatrix";
                    return Err(FileError::value(path, place, "element", other, expected));
                }
            }
        }
        times.check(&coverage)?;
        Ok(Self {
            object_name: metadata.require("OBJECT_NAME")?.value.to_owned(),
            object_id: metadata.require("OBJECT_ID")?.value.to_owned(),
            frame,
            time_system,
            coverage,
            interpolation: read_interpolation(metadata, "INTERPOLATION")?,
            states,
            covariances,
        })
    }

    fn names(&self, _: &Record<'_>) -> Vec<(&'static str, &str)> {
        vec![("OBJECT_NAME", self.object_name.as_str())]
    }

    fn coverage(&self) -> Coverage {
        self.coverage
    }

    fn time_system(&self) -> TimeSystem {
        self.time_system
    }

    fn applied_interpolation(&self) -> Interpolation {
        self.interpolation.unwrap_or(Interpolation::ORBIT_DEFAULT)
    }

    fn record_count(&self) -> usize {
        self.states.len()
    }
}

impl OemSegment {
    /// Creates a segment of states and their covariances, ICRS axes and UTC. Covariances are those of
    /// position and velocity in km and km/s.
    ///
    /// `None` unless the states ascend in time and are at least two and as many as the interpolation needs.
    pub fn from_states(
        object_name: &str,
        interpolation: Interpolation,
        states: &[(Epoch, State, Option<Matrix6<f64>>)],
    ) -> Option<Self> {
        let ([(start, ..), ..], [.., (stop, ..)]) = (states, states) else { return None };
        let ascends = states.is_sorted_by(|(a, ..), (b, ..)| a < b) && start < stop;
        if !ascends || states.len() < interpolation.nodes() {
            return None;
        }
        let nodes = states.iter().map(|(time, state, _)| StateNode {
            time: *time,
            position_km: state.position_km,
            velocity_km_s: state.velocity_km_s,
        });
        Some(Self {
            object_name: object_name.to_owned(),
            object_id: NO_DESIGNATOR.to_owned(),
            frame: ReferenceFrame::Icrf,
            time_system: TimeSystem::Utc,
            coverage: Coverage { start: *start, stop: *stop },
            interpolation: Some(interpolation),
            states: nodes.collect(),
            covariances: states
                .iter()
                .filter_map(|(time, _, matrix)| Some(Covariance::from_icrf(*time, matrix.as_ref()?)))
                .collect(),
        })
    }

    /// Returns the states in ICRS axes with their interpolation, times in seconds since `epoch`.
    pub fn sampled_since(&self, epoch: Epoch) -> SampledSegment {
        let Interpolation { method, degree } = self.applied_interpolation();
        let samples: Vec<StateSample> = self
            .states
            .iter()
            .map(|node| StateSample {
                time_s: seconds_between(epoch, node.time),
                state: node.to_icrs(self.frame),
            })
            .collect();
        // The message's first and last state may lie within the span by the rounding of its times.
        let within = |time_s: f64| {
            let (first, last) = (samples.first(), samples.last());
            time_s.max(first.map_or(time_s, |s| s.time_s)).min(last.map_or(time_s, |s| s.time_s))
        };
        SampledSegment {
            interpolation: match method {
                Method::Hermite => SampleInterpolation::Hermite,
                Method::Lagrange | Method::Linear => SampleInterpolation::Lagrange,
            },
            degree,
            usable_s: [self.coverage.start, self.coverage.stop]
                .map(|time| within(seconds_between(epoch, time))),
            samples,
        }
    }

    fn write(&self, writer: &mut Writer) {
        let system = self.time_system;
        writer.open("segment");
        writer.line("META_START");
        writer.open("metadata");
        writer.value("OBJECT_NAME", &self.object_name);
        writer.value("OBJECT_ID", &self.object_id);
        writer.value("CENTER_NAME", "EARTH");
        writer.value("REF_FRAME", self.frame.code());
        writer.value("TIME_SYSTEM", system.code());
        let ends = self.states.first().zip(self.states.last());
        let whole = ends.map_or(self.coverage, |(first, last)| Coverage {
            start: first.time.min(self.coverage.start),
            stop: last.time.max(self.coverage.stop),
        });
        write_coverage(writer, system, &whole, &self.coverage);
        if let Some(Interpolation { method, degree }) = self.interpolation {
            writer.value("INTERPOLATION", method.code());
            writer.value("INTERPOLATION_DEGREE", degree);
        }
        writer.close("metadata");
        writer.line("META_STOP");
        writer.open("data");
        for node in &self.states {
            if writer.notation() == Notation::Xml {
                node.write(writer, system);
                continue;
            }
            let [x, y, z]: [f64; 3] = node.position_km.into();
            let [vx, vy, vz]: [f64; 3] = node.velocity_km_s.into();
            writer.line(&format!("{} {x} {y} {z} {vx} {vy} {vz}", system.format_time(node.time)));
        }
        if !self.covariances.is_empty() {
            writer.line("COVARIANCE_START");
            for covariance in &self.covariances {
                covariance.write(writer, Some(system));
            }
            writer.line("COVARIANCE_STOP");
        }
        writer.close("data");
        writer.close("segment");
    }
}
