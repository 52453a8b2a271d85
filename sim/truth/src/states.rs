//! Configuration of the orbits, and the states of chaser and target at an instant.

use contract::{Icrs, OutOfRange, Rotation, bounds};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clock::parse_utc_field;
use super::ephemeris::check_covered;
use super::manoeuvre::{
    Burn, ManoeuvreAxes, ManoeuvreConfig, ManoeuvreDraws, ManoeuvreErrorsConfig, ManoeuvreReportsConfig,
    PlannedManoeuvre,
};
use super::orbit::{Elements, ElementsConfig, Rtn, State};
use super::relative::RelativeElements;

/// Orbits of target and chaser.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrbitConfig {
    /// Epoch of the elements, UTC, as in 2012-04-23T00:00:00.
    pub epoch_utc: String,
    /// Orbit of the target.
    pub target: ElementsConfig,
    /// Orbit of the chaser relative to the target's orbit.
    pub relative: RelativeElements,
    /// Manoeuvres of the chaser, in order of time.
    #[serde(default)]
    pub manoeuvres: Vec<ManoeuvreConfig>,
    /// Errors of the executed manoeuvres; absent: they are executed as planned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub execution: Option<ManoeuvreErrorsConfig>,
    /// Reports of the manoeuvres in the telemetry; absent: immediate and exact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reports: Option<ManoeuvreReportsConfig>,
}

impl OrbitConfig {
    /// Returns the manoeuvres as executed, with the errors drawn from `seed`, the scenario's.
    pub fn executed_manoeuvres(&self, seed: u64) -> Vec<ManoeuvreConfig> {
        let draws = self.draws(seed);
        let execute = |(index, planned): (usize, &ManoeuvreConfig)| ManoeuvreConfig {
            dv_rtn_m_s: draws.executed(planned.dv_rtn_m_s, index),
            ..planned.clone()
        };
        self.manoeuvres.iter().enumerate().map(execute).collect()
    }

    /// Errors of the manoeuvres.
    pub(super) fn draws(&self, seed: u64) -> ManoeuvreDraws {
        ManoeuvreDraws {
            execution: self.execution.unwrap_or_default(),
            reports: self.reports.unwrap_or_default(),
            seed,
        }
    }

    /// Manoeuvres as planned.
    ///
    /// # Errors
    /// [`OutOfRange`] for a time that is not UTC.
    pub(super) fn planned_manoeuvres(&self) -> Result<Vec<PlannedManoeuvre>, OutOfRange> {
        let planned = |(index, manoeuvre): (usize, &ManoeuvreConfig)| {
            Ok(PlannedManoeuvre {
                time: manoeuvre.time().map_err(|error| error.in_entry(index))?,
                duration_s: manoeuvre.duration_s,
                axes: ManoeuvreAxes::Rtn,
                dv_m_s: manoeuvre.dv_rtn_m_s,
            })
        };
        self.manoeuvres.iter().enumerate().map(planned).collect()
    }

    /// Checks the orbits and returns the epoch and the elements of (chaser, target) at it.
    pub(super) fn initial_elements(&self) -> Result<(Epoch, Elements, Elements), OutOfRange> {
        let epoch = parse_utc_field("orbit.epoch_utc", &self.epoch_utc)?;
        check_covered("orbit.epoch_utc", &self.epoch_utc, epoch)?;
        let target = self.target.elements()?;
        self.relative.check()?;
        if let Some(errors) = &self.execution {
            bounds::check(errors, "orbit.execution")?;
        }
        if let Some(reports) = &self.reports {
            bounds::check(reports, "orbit.reports")?;
        }
        let chaser = self.relative.chaser(&target);
        if !chaser.is_supported() {
            return Err(OutOfRange::new(
                "orbit.relative",
                format!("{:?}", self.relative),
                "a chaser orbit with an eccentricity of at most 0.9, a perigee above 100 km and an \
                 inclination to the equator",
            ));
        }
        Ok((epoch, chaser, target))
    }
}

/// Checks the planned manoeuvres of an orbit, and returns the `executed` ones with their times in seconds
/// since `epoch`. The limits of a change of velocity apply to the planned one.
///
/// # Errors
/// [`OutOfRange`] for a value outside its range, and for a manoeuvre that begins before the epoch or before
/// the end of the preceding one.
pub(super) fn burns(
    orbit: &OrbitConfig,
    executed: &[ManoeuvreConfig],
    epoch: Epoch,
) -> Result<Vec<Burn>, OutOfRange> {
    let mut free_from_s = 0.0;
    let mut burns = Vec::with_capacity(executed.len());
    for (index, (manoeuvre, executed)) in orbit.manoeuvres.iter().zip(executed).enumerate() {
        manoeuvre.check(index)?;
        let time = manoeuvre.time()?;
        check_covered(format!("orbit.manoeuvres[{index}].time_utc"), &manoeuvre.time_utc, time)?;
        let duration_s = manoeuvre.duration_s;
        let start_s = seconds_between(epoch, time) - 0.5 * duration_s;
        if start_s <= free_from_s {
            let after = if duration_s > 0.0 { "more than half the duration after" } else { "after" };
            let event =
                if start_s <= 0.0 { "the orbit's epoch" } else { "the end of the preceding manoeuvre" };
            return Err(manoeuvre.refused_time(index, format!("a time {after} {event}")));
        }
        free_from_s = start_s + duration_s;
        let dv_km_s = Vector3::from(executed.dv_rtn_m_s) * 1e-3;
        burns.push(Burn { start_s, duration_s, axes: ManoeuvreAxes::Rtn, dv_km_s });
    }
    Ok(burns)
}

/// States of chaser and target at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct States {
    /// Seconds since the orbit's epoch.
    pub time_s: f64,
    /// State of the chaser.
    pub chaser: State,
    /// State of the target.
    pub target: State,
}

impl States {
    /// Returns the vector from the chaser to the target, km, ICRS axes; geometric, without light time.
    pub fn line_of_sight_km(&self) -> Vector3<f64> {
        self.target.position_km - self.chaser.position_km
    }

    /// Returns the distance between chaser and target, km.
    pub fn range_km(&self) -> f64 {
        self.line_of_sight_km().norm()
    }

    /// Returns the position of the chaser relative to the target along the target's R, T, N axes, km.
    pub fn chaser_rtn_km(&self) -> Vector3<f64> {
        let rtn_from_icrs: Rotation<Rtn, Icrs> = self.target.rtn_from_icrs();
        rtn_from_icrs.rotate(&-self.line_of_sight_km())
    }
}

/// Returns the seconds from `from` to `to`. Computed in TAI, because a difference of UTC would miss leap
/// seconds, and in integer nanoseconds, because f64 holds 104 days of them exactly.
pub(super) fn seconds_between(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}
