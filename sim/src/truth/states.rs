//! Configuration of the orbits, and the states of chaser and target at an instant.

use contract::{Icrs, Rotation};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::manoeuvre::ManoeuvreConfig;
use super::orbit::{ElementsConfig, Rtn, State};
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
