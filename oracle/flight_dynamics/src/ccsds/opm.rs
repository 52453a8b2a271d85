//! Orbit parameter messages (CCSDS 502.0-B).

use std::path::Path;

use files::{FileError, FileLocation};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::State;

use super::common::{Header, check_center, read_frame, read_time_system};
use super::covariance::{Covariance, CovarianceFrame};
use super::oem::StateNode;
use crate::document::{self, Document, Kind, Notation, Record, Writer};
use crate::frame::ReferenceFrame;
use crate::time::TimeSystem;

/// Keywords of the metadata.
const METADATA: [&str; 6] =
    ["OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "REF_FRAME_EPOCH", "TIME_SYSTEM"];

/// Properties of a spacecraft that forces depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpacecraftParameters {
    /// Mass, kg.
    pub mass_kg: Option<f64>,
    /// Area for solar radiation pressure, m².
    pub solar_radiation_area_m2: Option<f64>,
    /// Coefficient of solar radiation pressure.
    pub solar_radiation_coefficient: Option<f64>,
    /// Area for drag, m².
    pub drag_area_m2: Option<f64>,
    /// Coefficient of drag.
    pub drag_coefficient: Option<f64>,
}

/// Manoeuvre of an orbit parameter message.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// Time of ignition.
    pub ignition: Epoch,
    /// Duration, s; 0 for an impulse.
    pub duration_s: f64,
    /// Change of mass, kg; at most 0.
    pub mass_change_kg: f64,
    /// Axes of the velocity change: RTN, TNW or those of a celestial frame.
    pub frame: CovarianceFrame,
    /// Change of velocity, km/s.
    pub velocity_change_km_s: Vector3<f64>,
}

/// Orbit parameter message: one state, with parameters and planned manoeuvres.
#[derive(Debug, Clone, PartialEq)]
pub struct Opm {
    /// Header.
    pub header: Header,
    /// Name of the spacecraft.
    pub object_name: String,
    /// International designator.
    pub object_id: String,
    /// Axes of the state.
    pub frame: ReferenceFrame,
    /// Time system of the message.
    pub time_system: TimeSystem,
    /// State.
    pub state: StateNode,
    /// Properties of the spacecraft.
    pub parameters: SpacecraftParameters,
    /// Covariance of the state; `None` if the message has none.
    pub covariance: Option<Covariance>,
    /// Manoeuvres in the order of the message.
    pub manoeuvres: Vec<Manoeuvre>,
}

impl Opm {
    /// Reads a file. Keplerian elements, which repeat the state (mandatory by the standard), and user-defined
    /// parameters are not read.
    ///
    /// # Errors
    /// [`FileError`] with line and field for a file that is not an OPM, or a value that is not supported; see
    /// [`Oem::read`](crate::Oem::read).
    pub fn read(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Opm, |document| Self::from_document(path, document))
    }

    /// [`Opm::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Opm::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Opm, |document| Self::from_document(path, document))
    }

    pub(super) fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let header = Header::read(&document.header)?;
        let [segment] = document.segments.as_slice() else {
            let count = document.segments.len();
            return Err(FileError::value(path, FileLocation::Whole, "number of segments", count, "1"));
        };
        let metadata = &segment.metadata;
        metadata.check_keywords(&METADATA)?;
        let time_system = read_time_system(metadata)?;
        let frame = read_frame(metadata, "REF_FRAME")?;
        check_center(metadata, Some(metadata.require("CENTER_NAME")?))?;
        let of_name = |name: &str| segment.data.iter().find(|record| record.name == name);
        let Some(state) = of_name("stateVector") else {
            let place = FileLocation::Line(metadata.line);
            return Err(FileError::value(
                path,
                place,
                "stateVector",
                "missing",
                "EPOCH, X to Z, X_DOT to Z_DOT",
            ));
        };
        let state = StateNode::read(state, time_system)?;
        let parameters = match of_name("spacecraftParameters") {
            Some(record) => SpacecraftParameters::read(record)?,
            None => SpacecraftParameters::default(),
        };
        let covariance = of_name("covarianceMatrix")
            .map(|record| Covariance::read(record, state.time, CovarianceFrame::Reference(frame)))
            .transpose()?;
        let manoeuvres = segment
            .data
            .iter()
            .filter(|record| record.name == "maneuverParameters")
            .map(|record| Manoeuvre::read(record, time_system))
            .collect::<Result<_, _>>()?;
        if let Some(unknown) = segment.data.iter().find(|record| record.name == "unknown") {
            unknown.check_keywords(&["EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT", "MASS"])?;
        }
        Ok(Self {
            header,
            object_name: metadata.require("OBJECT_NAME")?.value.to_owned(),
            object_id: metadata.require("OBJECT_ID")?.value.to_owned(),
            frame,
            time_system,
            state,
            parameters,
            covariance,
            manoeuvres,
        })
    }

    /// Returns the state in ICRS axes.
    pub fn icrs_state(&self) -> State {
        self.state.to_icrs(self.frame)
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
        let mut writer = Writer::new(Kind::Opm, notation, "2.0");
        self.header.write(&mut writer);
        writer.open("body");
        writer.open("segment");
        writer.open("metadata");
        writer.value("OBJECT_NAME", &self.object_name);
        writer.value("OBJECT_ID", &self.object_id);
        writer.value("CENTER_NAME", "EARTH");
        writer.value("REF_FRAME", self.frame.code());
        writer.value("TIME_SYSTEM", self.time_system.code());
        writer.close("metadata");
        writer.open("data");
        self.state.write(&mut writer, self.time_system);
        self.parameters.write(&mut writer);
        if let Some(covariance) = &self.covariance {
            covariance.write(&mut writer, None);
        }
        for manoeuvre in &self.manoeuvres {
            manoeuvre.write(&mut writer, self.time_system);
        }
        writer.close("data");
        writer.close("segment");
        writer.close("body");
        writer.finish()
    }
}

impl SpacecraftParameters {
    fn read(record: &Record<'_>) -> Result<Self, FileError> {
        let number = |keyword: &str, unit: &str| {
            let Some(entry) = record.find(keyword) else { return Ok(None) };
            match record.number(entry, unit)? {
                value if value >= 0.0 => Ok(Some(value)),
                _ => Err(record.refuse(entry, "a number of at least 0")),
            }
        };
        Ok(Self {
            mass_kg: number("MASS", "kg")?,
            solar_radiation_area_m2: number("SOLAR_RAD_AREA", "m**2")?,
            solar_radiation_coefficient: number("SOLAR_RAD_COEFF", "")?,
            drag_area_m2: number("DRAG_AREA", "m**2")?,
            drag_coefficient: number("DRAG_COEFF", "")?,
        })
    }

    fn write(&self, writer: &mut Writer) {
        if *self == Self::default() {
            return;
        }
        writer.open("spacecraftParameters");
        for (keyword, value, unit) in [
            ("MASS", self.mass_kg, "kg"),
            ("SOLAR_RAD_AREA", self.solar_radiation_area_m2, "m**2"),
            ("SOLAR_RAD_COEFF", self.solar_radiation_coefficient, ""),
            ("DRAG_AREA", self.drag_area_m2, "m**2"),
            ("DRAG_COEFF", self.drag_coefficient, ""),
        ] {
            if let Some(value) = value {
                writer.number(keyword, value, unit);
            }
        }
        writer.close("spacecraftParameters");
    }
}

impl Manoeuvre {
    fn read(record: &Record<'_>, system: TimeSystem) -> Result<Self, FileError> {
        let frame = record.require("MAN_REF_FRAME")?;
        Ok(Self {
            ignition: record.time(record.require("MAN_EPOCH_IGNITION")?, system)?,
            duration_s: record.require_number("MAN_DURATION", "s")?,
            mass_change_kg: record.require_number("MAN_DELTA_MASS", "kg")?,
            frame: CovarianceFrame::parse(frame.value)
                .ok_or_else(|| record.refuse(frame, "RTN, TNW, ICRF, GCRF, EME2000 or TEME"))?,
            velocity_change_km_s: record
                .require_numbers(["MAN_DV_1", "MAN_DV_2", "MAN_DV_3"], "km/s")?
                .into(),
        })
    }

    fn write(&self, writer: &mut Writer, system: TimeSystem) {
        writer.open("maneuverParameters");
        writer.value("MAN_EPOCH_IGNITION", system.format_time(self.ignition));
        writer.number("MAN_DURATION", self.duration_s, "s");
        writer.number("MAN_DELTA_MASS", self.mass_change_kg, "kg");
        writer.value("MAN_REF_FRAME", self.frame.code());
        for (keyword, value) in
            ["MAN_DV_1", "MAN_DV_2", "MAN_DV_3"].into_iter().zip(&self.velocity_change_km_s)
        {
            writer.number(keyword, *value, "km/s");
        }
        writer.close("maneuverParameters");
    }
}
