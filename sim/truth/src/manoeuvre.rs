//! Manoeuvres of the chaser: as planned, as executed, as reported.

use contract::{Icrs, OutOfRange, Rotation, bounds};
use draws::{Effect, Seed, normal};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clock::parse_utc_field;
use super::orbit::{Elements, Rtn, State};

/// Planned manoeuvre of the chaser.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreConfig {
    /// Time, UTC, for example 2012-04-24T00:31:07; after the orbit's epoch and after the preceding manoeuvre
    /// of the list.
    pub time_utc: String,
    /// Change of velocity along the chaser's own radial, transverse and normal axes, m/s, each −100 to 100.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub dv_rtn_m_s: [f64; 3],
    /// Duration, s, 0 (the default: an impulse) to 36000. The manoeuvre is centred on its time; the
    /// acceleration is constant along the chaser's axes R, T, N of each instant. Only with a numerical
    /// trajectory.
    #[serde(default)]
    #[schemars(range(min = 0, max = 36000))]
    pub duration_s: f64,
}

/// Random errors of manoeuvres, each drawn anew for each manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreErrorsConfig {
    /// Standard deviation of the size, relative to the size, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub size_sigma: f64,
    /// Standard deviation of the direction about each of two axes perpendicular to it, degrees, 0 to 90.
    #[serde(default)]
    #[schemars(range(min = 0, max = 90))]
    pub direction_sigma_deg: f64,
}

/// Reports of manoeuvres in the telemetry: delay, and errors relative to the manoeuvre as executed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreReportsConfig {
    /// Interval from the end of a manoeuvre to its report, s, 0 to 1e6.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1e6))]
    pub delay_s: f64,
    /// Standard deviation of the reported size, relative to the size, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub size_sigma: f64,
    /// Standard deviation of the reported direction about each of two axes perpendicular to it, degrees, 0 to
    /// 90.
    #[serde(default)]
    #[schemars(range(min = 0, max = 90))]
    pub direction_sigma_deg: f64,
}

impl ManoeuvreReportsConfig {
    pub(super) fn errors(&self) -> ManoeuvreErrorsConfig {
        let Self { size_sigma, direction_sigma_deg, .. } = *self;
        ManoeuvreErrorsConfig { size_sigma, direction_sigma_deg }
    }
}

/// Report of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManoeuvreReport {
    /// Time from which the report is available.
    pub reported: Epoch,
    /// Middle of the manoeuvre.
    pub time: Epoch,
    /// Duration, s; 0 for an impulse.
    pub duration_s: f64,
    /// Reported change of velocity along the chaser's R, T, N axes, m/s.
    pub dv_rtn_m_s: [f64; 3],
}

/// Manoeuvre of the chaser: as planned, as executed and as reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManoeuvreTruth {
    /// Middle of the manoeuvre.
    pub time: Epoch,
    /// Duration, s; 0 for an impulse.
    pub duration_s: f64,
    /// Planned change of velocity along the chaser's R, T, N axes, m/s.
    pub planned_dv_rtn_m_s: [f64; 3],
    /// Executed change of velocity along the chaser's R, T, N axes, m/s.
    pub executed_dv_rtn_m_s: [f64; 3],
    /// Report in the telemetry.
    pub report: ManoeuvreReport,
}

impl ManoeuvreTruth {
    /// Returns the first and the last instant of the manoeuvre; both are its time for an impulse.
    pub fn ends(&self) -> [Epoch; 2] {
        let half = Duration::from_seconds(0.5 * self.duration_s);
        [self.time - half, self.time + half]
    }
}

/// Axes of a change of velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ManoeuvreAxes {
    /// R along the position, N along the angular momentum, T = N × R, of each instant.
    Rtn,
    /// T along the velocity, W along the angular momentum, N = T × W, of each instant; components are T, N,
    /// W.
    Tnw,
    /// Celestial axes.
    Icrs,
}

impl ManoeuvreAxes {
    /// Returns a vector along these axes of a spacecraft as a vector along ICRS axes.
    pub(super) fn to_icrs(self, state: &State, vector: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Rtn => state.rtn_from_icrs().inverse().rotate(vector),
            Self::Tnw => {
                let along = state.velocity_km_s.normalize();
                let normal = state.position_km.cross(&state.velocity_km_s).normalize();
                along * vector.x + along.cross(&normal) * vector.y + normal * vector.z
            }
            Self::Icrs => *vector,
        }
    }

    /// Returns a vector along these axes as one along R, T, N; `state` is that of the spacecraft.
    fn to_rtn(self, state: &State, vector: [f64; 3]) -> [f64; 3] {
        if self == Self::Rtn {
            return vector;
        }
        let rtn_from_icrs: Rotation<Rtn, Icrs> = state.rtn_from_icrs();
        rtn_from_icrs.rotate(&self.to_icrs(state, &vector.into())).into()
    }
}

/// Manoeuvre as planned, with the axes of its change of velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedManoeuvre {
    /// Middle of the manoeuvre.
    pub time: Epoch,
    /// Duration, s; 0 for an impulse. The acceleration is constant along the axes of each instant.
    pub duration_s: f64,
    /// Axes of the change of velocity.
    pub axes: ManoeuvreAxes,
    /// Change of velocity, m/s.
    pub dv_m_s: [f64; 3],
}

/// Errors of a list of manoeuvres, and their seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ManoeuvreDraws {
    pub(super) execution: ManoeuvreErrorsConfig,
    pub(super) reports: ManoeuvreReportsConfig,
    pub(super) seed: u64,
}

impl ManoeuvreDraws {
    /// Returns the executed change of velocity of manoeuvre `index`, m/s, along the axes of the planned one.
    pub(super) fn executed(&self, dv_m_s: [f64; 3], index: usize) -> [f64; 3] {
        self.execution.disturbed(dv_m_s, self.seed(), Effect::ManoeuvreExecution, index)
    }

    /// Returns the reported change of velocity, m/s, from the executed one.
    fn reported(&self, executed_m_s: [f64; 3], index: usize) -> [f64; 3] {
        self.reports.errors().disturbed(executed_m_s, self.seed(), Effect::ManoeuvreReport, index)
    }

    /// Returns plan, execution and report of manoeuvres in their order. `chaser_before` is the chaser's state
    /// at an instant, before an impulse at that instant.
    pub(super) fn truth(
        &self,
        planned: &[PlannedManoeuvre],
        chaser_before: impl Fn(Epoch) -> State,
    ) -> Vec<ManoeuvreTruth> {
        let truth = |(index, manoeuvre): (usize, &PlannedManoeuvre)| {
            let PlannedManoeuvre { time, duration_s, axes, dv_m_s } = *manoeuvre;
            let executed = self.executed(dv_m_s, index);
            let to_rtn = |dv_m_s| match axes {
                ManoeuvreAxes::Rtn => dv_m_s,
                ManoeuvreAxes::Tnw | ManoeuvreAxes::Icrs => axes.to_rtn(&chaser_before(time), dv_m_s),
            };
            ManoeuvreTruth {
                time,
                duration_s,
                planned_dv_rtn_m_s: to_rtn(dv_m_s),
                executed_dv_rtn_m_s: to_rtn(executed),
                report: ManoeuvreReport {
                    reported: time + Duration::from_seconds(0.5 * duration_s + self.reports.delay_s),
                    time,
                    duration_s,
                    dv_rtn_m_s: to_rtn(self.reported(executed, index)),
                },
            }
        };
        planned.iter().enumerate().map(truth).collect()
    }

    fn seed(&self) -> Seed {
        Seed { seed: self.seed, case: 0 }
    }
}

/// Executed manoeuvre on the time axis of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Burn {
    /// Begin, seconds since the epoch.
    pub(super) start_s: f64,
    /// Duration, s; 0 for an impulse.
    pub(super) duration_s: f64,
    /// Axes of the change of velocity.
    pub(super) axes: ManoeuvreAxes,
    /// Change of velocity, km/s.
    pub(super) dv_km_s: Vector3<f64>,
}

impl ManoeuvreErrorsConfig {
    /// Returns a change of velocity with errors. The numbers of manoeuvre `index` depend on seed, effect and
    /// index only.
    pub(super) fn disturbed(&self, dv_m_s: [f64; 3], seed: Seed, effect: Effect, index: usize) -> [f64; 3] {
        if *self == Self::default() {
            return dv_m_s;
        }
        let draw = |number: u64| normal(&mut seed.stream(0, effect, 3 * index as u64 + number));
        let dv = Vector3::from(dv_m_s);
        let Some(direction) = dv.try_normalize(0.0) else { return dv_m_s };
        // The coordinate axis that is farthest from the direction gives the two perpendicular ones.
        let farthest = Vector3::ith(direction.iamin(), 1.0);
        let first = direction.cross(&farthest).normalize();
        let second = direction.cross(&first);
        let sigma = self.direction_sigma_deg.to_radians();
        let tilt = first * (sigma * draw(1)) + second * (sigma * draw(2));
        let angle = tilt.norm();
        let (sin, cos) = libm::sincos(angle);
        let aside = if angle > 0.0 { tilt * (sin / angle) } else { Vector3::zeros() };
        let size = dv.norm() * (1.0 + self.size_sigma * draw(0));
        ((direction * cos + aside) * size).into()
    }
}

impl ManoeuvreConfig {
    /// Checks text and numbers; `index` is the index in the list, counted from 0, for the message.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid time or a change of velocity outside its range.
    pub fn check(&self, index: usize) -> Result<(), OutOfRange> {
        self.time().map_err(|error| error.in_entry(index))?;
        bounds::check(self, &format!("orbit.manoeuvres[{index}]"))
    }

    /// Time of the manoeuvre.
    pub(crate) fn time(&self) -> Result<Epoch, OutOfRange> {
        parse_utc_field("orbit.manoeuvres[].time_utc", &self.time_utc)
    }

    /// Returns the orbit after the impulse, from the orbit just before: the position is unchanged, the
    /// velocity changes exactly. `None` if the resulting orbit is not supported.
    pub(crate) fn apply(&self, before: &Elements) -> Option<Elements> {
        let state = before.state();
        let icrs_from_rtn = state.rtn_from_icrs().inverse();
        let dv_km_s = icrs_from_rtn.rotate(&(Vector3::from(self.dv_rtn_m_s) * 1e-3));
        Elements::from_state(&State { velocity_km_s: state.velocity_km_s + dv_km_s, ..state })
    }

    /// Returns the error for an impulse, with its index in the list.
    pub(crate) fn refused_impulse(&self, index: usize, expected: &'static str) -> OutOfRange {
        OutOfRange::new("orbit.manoeuvres[].dv_rtn_m_s", format!("{:?}", self.dv_rtn_m_s), expected)
            .in_entry(index)
    }

    /// Returns the error for a time, with its index in the list.
    pub(crate) fn refused_time(&self, index: usize, expected: String) -> OutOfRange {
        OutOfRange::new("orbit.manoeuvres[].time_utc", self.time_utc.clone(), expected).in_entry(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relative::RelativeElements;

    const CIRCULAR: Elements = Elements {
        semi_major_axis_km: 7130.0,
        eccentricity: 0.0,
        inclination_rad: 1.7153,
        raan_rad: 2.0,
        argument_of_perigee_rad: 0.0,
        mean_anomaly_rad: 0.7,
    };

    fn impulse(dv_rtn_m_s: [f64; 3]) -> RelativeElements {
        let manoeuvre =
            ManoeuvreConfig { time_utc: "2012-04-23T00:00:00Z".into(), dv_rtn_m_s, duration_s: 0.0 };
        RelativeElements::between(&manoeuvre.apply(&CIRCULAR).unwrap(), &CIRCULAR)
    }

    /// Compares with the linear theory. The second order is Δv/v = 1e-6 of an effect of at most 20 m, and
    /// δi's second order through cot i is equally small: a tenth of a millimetre.
    fn check(got: RelativeElements, expected: [f64; 6]) {
        let got = [got.a_da_m, got.a_dlambda_m, got.a_dex_m, got.a_dey_m, got.a_dix_m, got.a_diy_m];
        for (g, e) in got.iter().zip(expected) {
            assert!((g - e).abs() < 1e-4, "{got:?} {expected:?}");
        }
    }

    // Effects of an impulse on the relative elements in linear theory (D'Amico 2010, chapter 2), evaluated at
    // u = 0.7 rad.

    #[test]
    fn a_radial_impulse_moves_lambda_and_the_eccentricity_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.01, 0.0, 0.0]), [0.0, -2.0 * unit, unit * sin, -unit * cos, 0.0, 0.0]);
    }

    #[test]
    fn a_transverse_impulse_moves_the_axis_and_the_eccentricity_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.0, 0.01, 0.0]), [2.0 * unit, 0.0, 2.0 * unit * cos, 2.0 * unit * sin, 0.0, 0.0]);
    }

    #[test]
    fn a_normal_impulse_moves_the_inclination_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.0, 0.0, 0.01]), [0.0, 0.0, 0.0, 0.0, unit * cos, unit * sin]);
    }

    #[test]
    fn an_impulse_leaves_the_position_where_it_was() {
        let manoeuvre = ManoeuvreConfig {
            time_utc: "2012-04-23T00:00:00Z".into(),
            dv_rtn_m_s: [1.0, -2.0, 3.0],
            duration_s: 0.0,
        };
        let before = Elements { eccentricity: 0.003, ..CIRCULAR };
        let after = manoeuvre.apply(&before).unwrap();
        // Rounding of 7130 km: 1e-12 km, accumulated through several angles.
        assert!((after.state().position_km - before.state().position_km).norm() < 1e-10);
        let dv = after.state().velocity_km_s - before.state().velocity_km_s;
        assert!((dv.norm() - 14.0_f64.sqrt() * 1e-3).abs() < 1e-13);
    }

    #[test]
    fn an_impulse_that_is_not_a_number_is_refused_by_its_index() {
        let manoeuvre = ManoeuvreConfig {
            time_utc: "2012-04-23T00:00:00Z".into(),
            dv_rtn_m_s: [f64::NAN, 0.0, 0.0],
            duration_s: 0.0,
        };
        let message = manoeuvre.check(3).unwrap_err().to_string();
        assert!(message.contains("orbit.manoeuvres[3].dv_rtn_m_s[0] is NaN"), "{message}");
    }

    /// Sample moments over many manoeuvres: size and direction have the stated standard deviations.
    #[test]
    fn errors_have_their_standard_deviations_and_depend_on_their_address_only() {
        let errors = ManoeuvreErrorsConfig { size_sigma: 0.05, direction_sigma_deg: 2.0 };
        let seed = Seed { seed: 7, case: 0 };
        let planned = [0.01, -0.02, 0.005];
        let draw = |index| errors.disturbed(planned, seed, Effect::ManoeuvreExecution, index);
        assert_eq!(draw(17), draw(17));
        assert_ne!(draw(17), errors.disturbed(planned, seed, Effect::ManoeuvreReport, 17));
        let nominal = Vector3::from(planned);
        let n = 20_000;
        let (mut size, mut angle) = (0.0, 0.0);
        for index in 0..n {
            let dv = Vector3::from(draw(index));
            let relative = dv.norm() / nominal.norm() - 1.0;
            size += relative * relative;
            let turned = libm::atan2(dv.cross(&nominal).norm(), dv.dot(&nominal)).to_degrees();
            angle += turned * turned;
        }
        // The standard error of a standard deviation is 1/sqrt(2n) = 0.5 %; the limit is four of them.
        let (size, angle) = ((size / n as f64).sqrt(), (angle / (2 * n) as f64).sqrt());
        assert!((size / 0.05 - 1.0).abs() < 0.02, "{size}");
        assert!((angle / 2.0 - 1.0).abs() < 0.02, "{angle}");
        let none = ManoeuvreErrorsConfig::default();
        assert_eq!(none.disturbed(planned, seed, Effect::ManoeuvreExecution, 3), planned);
    }
}
