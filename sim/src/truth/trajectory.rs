//! Positions and velocities of chaser and target at any time.
//!
//! Between manoeuvres each orbit drifts at its own secular rates. The chaser's orbit is stored as one arc
//! from each manoeuvre to the next; any instant can therefore be computed independently. Internal time is
//! seconds (SI, as TT and TAI count them) since the orbit's epoch, exact to 0.1 ns within months of the
//! epoch.

use contract::{Icrs, OutOfRange, Rotation};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clock::parse_utc_field;
use super::ephemeris::check_covered;
use super::manoeuvre::ManoeuvreConfig;
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
}

impl OrbitConfig {
    /// Checks all values, including the order of the manoeuvres.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value.
    pub fn check(&self) -> Result<(), OutOfRange> {
        Trajectory::new(self).map(|_| ())
    }
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

/// Motion of chaser and target over all time.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    epoch: Epoch,
    target: Elements,
    /// Arcs in order of time; the first also extends back before the epoch.
    arcs: Vec<Arc>,
}

/// Orbit of the chaser from one manoeuvre to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arc {
    start_s: f64,
    chaser: Elements,
}

impl Arc {
    fn chaser_at(&self, time_s: f64) -> Elements {
        self.chaser.propagate(time_s - self.start_s)
    }
}

impl Trajectory {
    /// Computes the arcs.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid epoch, or an orbit outside the supported range; [`OutOfRange`] for a
    /// manoeuvre that is out of order, not after the epoch, or results in an unsupported orbit.
    pub fn new(config: &OrbitConfig) -> Result<Self, OutOfRange> {
        let epoch = parse_utc_field("orbit.epoch_utc", &config.epoch_utc)?;
        check_covered("orbit.epoch_utc", &config.epoch_utc, epoch)?;
        let target = config.target.elements()?;
        config.relative.check()?;
        let chaser = config.relative.chaser(&target);
        if !chaser.is_supported() {
            return Err(OutOfRange::new(
                "orbit.relative",
                format!("{:?}", config.relative),
                "a chaser orbit with an eccentricity of at most 0.9, a perigee above 100 km and an \
                 inclination to the equator",
            ));
        }
        let mut last = Arc { start_s: 0.0, chaser };
        let mut arcs = vec![last];
        for (index, manoeuvre) in config.manoeuvres.iter().enumerate() {
            manoeuvre.check(index)?;
            let time = manoeuvre.time()?;
            check_covered(format!("orbit.manoeuvres[{index}].time_utc"), &manoeuvre.time_utc, time)?;
            let start_s = seconds_between(epoch, time);
            if start_s <= last.start_s {
                let expected = "after the orbit's epoch and after the previous manoeuvre";
                return Err(manoeuvre.refused_time(index, expected));
            }
            let chaser = manoeuvre.apply(&last.chaser_at(start_s)).ok_or_else(|| {
                manoeuvre.refused_impulse(index, "an impulse that results in a supported orbit")
            })?;
            last = Arc { start_s, chaser };
            arcs.push(last);
        }
        Ok(Self { epoch, target, arcs })
    }

    /// Returns the orbit's epoch.
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Returns the seconds from the orbit's epoch to `time`, including leap seconds.
    pub fn seconds(&self, time: Epoch) -> f64 {
        seconds_between(self.epoch, time)
    }

    /// Returns the states of chaser and target at `time`.
    pub fn states_at(&self, time: Epoch) -> States {
        self.states_at_seconds(self.seconds(time))
    }

    /// Returns the states of chaser and target `time_s` seconds after the orbit's epoch; at a manoeuvre, the
    /// states just after it.
    pub fn states_at_seconds(&self, time_s: f64) -> States {
        let (chaser, target) = self.elements(time_s);
        States { time_s, chaser: chaser.state(), target: target.state() }
    }

    /// Returns the relative orbital elements at `time`, m; at a manoeuvre, the elements just after it.
    pub fn relative_elements(&self, time: Epoch) -> RelativeElements {
        let (chaser, target) = self.elements(self.seconds(time));
        RelativeElements::between(&chaser, &target)
    }

    /// Returns the elements of (chaser, target).
    fn elements(&self, time_s: f64) -> (Elements, Elements) {
        let begun = self.arcs.partition_point(|arc| arc.start_s <= time_s);
        let arc = &self.arcs[begun.saturating_sub(1)];
        (arc.chaser_at(time_s), self.target.propagate(time_s))
    }
}

/// Returns the seconds from `from` to `to`. Computed in TAI, because a difference of UTC would miss leap
/// seconds, and in integer nanoseconds, because f64 holds 104 days of them exactly.
fn seconds_between(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> OrbitConfig {
        let manoeuvre =
            |time_utc: &str, dv_rtn_m_s| ManoeuvreConfig { time_utc: time_utc.into(), dv_rtn_m_s };
        OrbitConfig {
            epoch_utc: "2012-04-23T00:00:00Z".into(),
            target: ElementsConfig {
                semi_major_axis_km: 7130.0,
                eccentricity: 0.003,
                inclination_deg: 98.28,
                raan_deg: 124.0,
                argument_of_perigee_deg: 90.0,
                mean_anomaly_deg: 270.0,
            },
            relative: RelativeElements { a_dlambda_m: -30_000.0, a_dey_m: 400.0, ..Default::default() },
            manoeuvres: vec![
                manoeuvre("2012-04-23T06:00:00Z", [0.0, -0.02, 0.01]),
                manoeuvre("2012-04-23T06:50:00Z", [0.001, 0.01, 0.0]),
            ],
        }
    }

    #[test]
    fn the_relative_elements_at_the_epoch_are_those_given() {
        let config = config();
        let trajectory = Trajectory::new(&config).unwrap();
        let got = trajectory.relative_elements(trajectory.epoch());
        assert!((got.a_dlambda_m + 30_000.0).abs() < 1e-6);
        assert!((got.a_dey_m - 400.0).abs() < 1e-6);
    }

    #[test]
    fn a_manoeuvre_changes_the_velocity_and_not_the_position() {
        let trajectory = Trajectory::new(&config()).unwrap();
        let manoeuvre_s = 6.0 * 3600.0;
        let before = trajectory.states_at_seconds(manoeuvre_s - 1e-6).chaser;
        let after = trajectory.states_at_seconds(manoeuvre_s).chaser;
        // In a microsecond of flight at 7.5 km/s the position changes by 7.5e-6 km.
        assert!((after.position_km - before.position_km).norm() < 8e-6);
        let dv_m_s = (after.velocity_km_s - before.velocity_km_s) * 1000.0;
        // In that microsecond gravity adds 8e-6 m/s.
        assert!((dv_m_s.norm() - libm::hypot(0.02, 0.01)).abs() < 1e-5, "{dv_m_s}");
        assert!((after.rtn_from_icrs().rotate(&dv_m_s) - Vector3::new(0.0, -0.02, 0.01)).norm() < 1e-5);
    }

    #[test]
    fn the_target_does_not_feel_the_chasers_manoeuvres() {
        let quiet = OrbitConfig { manoeuvres: vec![], ..config() };
        let (a, b) = (Trajectory::new(&quiet).unwrap(), Trajectory::new(&config()).unwrap());
        assert_eq!(a.states_at_seconds(80_000.0).target, b.states_at_seconds(80_000.0).target);
        assert_eq!(a.states_at_seconds(100.0), b.states_at_seconds(100.0));
        assert_ne!(a.states_at_seconds(80_000.0).chaser, b.states_at_seconds(80_000.0).chaser);
    }

    #[test]
    fn a_manoeuvre_out_of_order_is_refused_by_its_index() {
        let with = |k: usize, time: &str| {
            let mut config = config();
            config.manoeuvres[k].time_utc = time.into();
            config.check().unwrap_err().to_string()
        };
        assert!(with(0, "2012-04-22T23:00:00Z").contains("orbit.manoeuvres[0].time_utc"));
        assert!(with(1, "2012-04-23T05:00:00Z").contains("orbit.manoeuvres[1].time_utc"));
        assert!(with(1, "2012-04-23T06:00:00Z").contains("orbit.manoeuvres[1].time_utc"));
        assert!(with(1, "soon").contains("time_utc"));
    }

    #[test]
    fn a_chaser_in_the_ground_is_refused() {
        let mut config = config();
        config.relative.a_da_m = -900_000.0;
        assert!(config.check().unwrap_err().to_string().contains("orbit.relative"));
    }

    #[test]
    fn a_leap_second_is_counted() {
        // The day 2012-06-30 had 86401 seconds.
        let config = OrbitConfig { epoch_utc: "2012-06-30T00:00:00Z".into(), manoeuvres: vec![], ..config() };
        let trajectory = Trajectory::new(&config).unwrap();
        let next_day = parse_utc_field("time", "2012-07-01T00:00:00Z").unwrap();
        assert_eq!(trajectory.seconds(next_day), 86_401.0);
        assert_eq!(trajectory.seconds(trajectory.epoch() - hifitime::Duration::from_seconds(1.5)), -1.5);
    }
}
