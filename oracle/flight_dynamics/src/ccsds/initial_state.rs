//! State of an orbit parameter message from which an orbit is integrated.

use std::path::Path;

use files::{FileError, FileLocation};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use sim::truth::{EARTH_GM_KM3_S2, ManoeuvreAxes, PlannedManoeuvre, State};

use super::covariance::CovarianceFrame;
use super::opm::{Manoeuvre, Opm, SpacecraftParameters};
use crate::document::{self, Document, Kind, Record};
use crate::physics::implausible_state;

/// Distances from the Earth's centre that are accepted, km: from 100 km above the equator.
const DISTANCE_KM: std::ops::RangeInclusive<f64> = 6_478.0..=1e6;
/// Largest component of a change of velocity, km/s.
const MAX_DV_KM_S: f64 = 0.1;
/// Longest manoeuvre, s.
const MAX_DURATION_S: f64 = 36_000.0;
/// Largest coefficient × area / mass, m²/kg.
const MAX_AREA_TO_MASS: f64 = 10.0;

/// State, surface forces and manoeuvres of an orbit parameter message, ready for an integration.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialState {
    /// Time of the state.
    pub time: Epoch,
    /// State, ICRS axes.
    pub state: State,
    /// Drag coefficient × area / mass, m²/kg; `None` if the message has none of the three.
    pub drag_m2_kg: Option<f64>,
    /// Radiation pressure coefficient × area / mass, m²/kg; `None` if the message has none of the three.
    pub radiation_m2_kg: Option<f64>,
    /// Manoeuvres in order of time, all after the state and apart from each other.
    pub manoeuvres: Vec<PlannedManoeuvre>,
}

impl InitialState {
    /// Reads an orbit parameter message. The mass is that of the state, for all times.
    ///
    /// # Errors
    /// Those of [`Opm::read`]; [`FileError::Value`] with line and field for a state that is no bound orbit
    /// above 100 km, a coefficient without its area or without the mass, a manoeuvre that begins before the
    /// state or before the end of the preceding one, and for values outside their ranges.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        document::read(path, Kind::Opm, |document| Self::from_document(path, document))
    }

    /// [`InitialState::read`] for text in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`InitialState::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, FileError> {
        document::parse(path, text, Kind::Opm, |document| Self::from_document(path, document))
    }

    fn from_document(path: &Path, document: &Document<'_>) -> Result<Self, FileError> {
        let opm = Opm::from_document(path, document)?;
        let records = || document.segments.iter().flat_map(|segment| &segment.data);
        let of_name = |name: &str| records().find(|record| record.name == name);
        let state = opm.icrs_state();
        if let Some(record) = of_name("stateVector") {
            check_orbit(record, &state)?;
        }
        let SpacecraftParameters {
            mass_kg,
            solar_radiation_area_m2,
            solar_radiation_coefficient,
            drag_area_m2,
            drag_coefficient,
        } = opm.parameters;
        let record = of_name("spacecraftParameters");
        let area_to_mass = |coefficient: (&str, Option<f64>), area: (&str, Option<f64>)| {
            area_to_mass(record, mass_kg, coefficient, area)
        };
        let drag_m2_kg = area_to_mass(("DRAG_COEFF", drag_coefficient), ("DRAG_AREA", drag_area_m2))?;
        let radiation_m2_kg = area_to_mass(
            ("SOLAR_RAD_COEFF", solar_radiation_coefficient),
            ("SOLAR_RAD_AREA", solar_radiation_area_m2),
        )?;
        let mut free_from = (opm.state.time, "the state");
        let mut manoeuvres = Vec::with_capacity(opm.manoeuvres.len());
        let manoeuvre_records = records().filter(|record| record.name == "maneuverParameters");
        for (manoeuvre, record) in opm.manoeuvres.iter().zip(manoeuvre_records) {
            check_manoeuvre(record, manoeuvre, free_from.0, free_from.1)?;
            let duration = Duration::from_seconds(manoeuvre.duration_s);
            free_from = (manoeuvre.ignition + duration, "the end of the manoeuvre before");
            manoeuvres.push(planned(manoeuvre));
        }
        Ok(Self { time: opm.state.time, state, drag_m2_kg, radiation_m2_kg, manoeuvres })
    }

    /// Checks that the message has no manoeuvre.
    ///
    /// # Errors
    /// [`FileError::Value`] with the file.
    pub fn check_no_manoeuvres(&self, path: &Path) -> Result<(), FileError> {
        if self.manoeuvres.is_empty() {
            return Ok(());
        }
        let expected = "0: only the chaser manoeuvres";
        Err(FileError::value(
            path,
            FileLocation::Whole,
            "number of manoeuvres",
            self.manoeuvres.len(),
            expected,
        ))
    }
}

fn check_orbit(record: &Record<'_>, state: &State) -> Result<(), FileError> {
    let distance_km = state.position_km.norm();
    let energy = 0.5 * state.velocity_km_s.norm_squared() - EARTH_GM_KM3_S2 / distance_km;
    let refuse = |field: &str, value: String, expected: &str| {
        let place = FileLocation::Line(record.line);
        Err(FileError::value(record.path, place, field, value, expected))
    };
    if !DISTANCE_KM.contains(&distance_km) {
        let expected = "a distance from the Earth's centre of 6478 to 1e6 km";
        return refuse("X, Y, Z", format!("{distance_km:.3} km from the centre"), expected);
    }
    // The comparison is false for NaN.
    if energy < 0.0 {
        return match implausible_state(state) {
            Some(fault) => refuse("X_DOT, Y_DOT, Z_DOT", fault.value(), fault.expected()),
            None => Ok(()),
        };
    }
    let speed = format!("{:.6} km/s", state.velocity_km_s.norm());
    refuse("X_DOT, Y_DOT, Z_DOT", speed, "a velocity of a bound orbit")
}

/// Returns coefficient × area / mass; `None` without coefficient and area.
fn area_to_mass(
    record: Option<&Record<'_>>,
    mass_kg: Option<f64>,
    (coefficient_key, coefficient): (&str, Option<f64>),
    (area_key, area_m2): (&str, Option<f64>),
) -> Result<Option<f64>, FileError> {
    let Some(record) = record else { return Ok(None) };
    let missing = |keyword: &str, expected: String| {
        let place = FileLocation::Line(record.line);
        Err(FileError::value(record.path, place, keyword, "missing", expected))
    };
    let (coefficient, area_m2) = match (coefficient, area_m2) {
        (None, None) => return Ok(None),
        (Some(coefficient), Some(area_m2)) => (coefficient, area_m2),
        (None, Some(_)) => return missing(coefficient_key, format!("a value beside {area_key}")),
        (Some(_), None) => return missing(area_key, format!("a value beside {coefficient_key}")),
    };
    let Some(mass_kg) = mass_kg else {
        return missing("MASS", format!("a value beside {coefficient_key} and {area_key}"));
    };
    let ratio = coefficient * area_m2 / mass_kg;
    if (0.0..=MAX_AREA_TO_MASS).contains(&ratio) {
        return Ok(Some(ratio));
    }
    let field = format!("{coefficient_key} × {area_key} / MASS");
    let place = record.find("MASS").map_or(record.line, |entry| entry.line);
    let expected = format!("0 to {MAX_AREA_TO_MASS} m²/kg");
    Err(FileError::value(record.path, FileLocation::Line(place), field, format!("{ratio} m²/kg"), expected))
}

fn check_manoeuvre(
    record: &Record<'_>,
    manoeuvre: &Manoeuvre,
    free_from: Epoch,
    end: &str,
) -> Result<(), FileError> {
    if manoeuvre.ignition < free_from {
        let time = sim::truth::clock::format_utc(free_from);
        let expected = format!("a time after {end}, {time}");
        return Err(record.refuse(record.require("MAN_EPOCH_IGNITION")?, expected));
    }
    if !(0.0..=MAX_DURATION_S).contains(&manoeuvre.duration_s) {
        return Err(record.refuse(record.require("MAN_DURATION")?, format!("0 to {MAX_DURATION_S} s")));
    }
    for (keyword, value) in
        ["MAN_DV_1", "MAN_DV_2", "MAN_DV_3"].into_iter().zip(&manoeuvre.velocity_change_km_s)
    {
        if value.abs() > MAX_DV_KM_S {
            let expected = format!("at most {MAX_DV_KM_S} km/s either way");
            return Err(record.refuse(record.require(keyword)?, expected));
        }
    }
    Ok(())
}

/// Manoeuvre on the time axis of an integration; its middle is half the duration after the ignition.
fn planned(manoeuvre: &Manoeuvre) -> PlannedManoeuvre {
    let time = manoeuvre.ignition + Duration::from_seconds(0.5 * manoeuvre.duration_s);
    let dv_km_s = &manoeuvre.velocity_change_km_s;
    let (axes, dv_km_s) = match manoeuvre.frame {
        CovarianceFrame::Rtn => (ManoeuvreAxes::Rtn, *dv_km_s),
        CovarianceFrame::Tnw => (ManoeuvreAxes::Tnw, *dv_km_s),
        CovarianceFrame::Reference(frame) => {
            let turned = frame.icrs_state(time, dv_km_s, &Vector3::zeros());
            (ManoeuvreAxes::Icrs, turned.position_km)
        }
    };
    PlannedManoeuvre { time, duration_s: manoeuvre.duration_s, axes, dv_m_s: (dv_km_s * 1000.0).into() }
}
