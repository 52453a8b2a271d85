//! Positions and velocities of chaser and target at any time.
//!
//! [`Trajectory`] has one interface for every kind of motion: [mean elements](MeanElements) that drift at
//! secular rates, [numerically integrated orbits](NumericalConfig), and [sampled states](SampledStates),
//! which a file of flight dynamics contains. Internal time is seconds (SI, as TT and TAI count them) since
//! the trajectory's epoch, exact to 0.1 ns within months of the epoch.

use std::ops::RangeInclusive;
use std::sync::Arc;

use contract::OutOfRange;
use hifitime::{Duration, Epoch};

use super::clock::format_utc;
use super::manoeuvre::ManoeuvreConfig;
use super::mean_elements::MeanElements;
use super::numerical::{NumericalConfig, NumericalStates};
use super::orbit::Elements;
use super::relative::RelativeElements;
use super::sampled::SampledStates;
use super::schedule::Schedule;
use super::states::{OrbitConfig, States, burns, seconds_between};

/// Origin of the motion of chaser and target.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TrajectorySource {
    /// Mean elements of [`OrbitConfig`] with secular drift.
    #[default]
    MeanElements,
    /// Orbits of [`OrbitConfig`], whose elements are osculating at the epoch, integrated numerically.
    Numerical(NumericalConfig),
    /// States sampled over time, for example from a file of flight dynamics. [`OrbitConfig`] has no effect.
    Sampled(Arc<SampledStates>),
}

/// Motion of chaser and target.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    epoch: Epoch,
    motion: Motion,
}

/// Motion of one kind.
#[derive(Debug, Clone, PartialEq)]
enum Motion {
    MeanElements(MeanElements),
    Numerical(Arc<NumericalStates>),
    Sampled(Arc<SampledStates>),
}

impl Trajectory {
    /// Creates the trajectory of mean elements with the manoeuvres as planned.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid epoch, or an orbit outside the supported range; [`OutOfRange`] for a
    /// manoeuvre that is out of order, not after the epoch, or results in an unsupported orbit.
    pub fn new(config: &OrbitConfig) -> Result<Self, OutOfRange> {
        Self::from_mean_elements(config, &config.manoeuvres)
    }

    fn from_mean_elements(config: &OrbitConfig, manoeuvres: &[ManoeuvreConfig]) -> Result<Self, OutOfRange> {
        let motion = MeanElements::new(config, manoeuvres)?;
        Ok(Self { epoch: motion.epoch(), motion: Motion::MeanElements(motion) })
    }

    /// Creates the trajectory of `source` for the frames of `schedule`. `seed` is that of the scenario.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid orbit or manoeuvre, see [`Trajectory::new`]; for a schedule with frames
    /// outside [`Trajectory::coverage_s`].
    pub fn from_source(
        orbit: &OrbitConfig,
        source: &TrajectorySource,
        seed: u64,
        schedule: &Schedule,
    ) -> Result<Self, OutOfRange> {
        let trajectory = match source {
            TrajectorySource::MeanElements => {
                Self::from_mean_elements(orbit, &orbit.executed_manoeuvres(seed))?
            }
            TrajectorySource::Numerical(config) => {
                let (epoch, ..) = orbit.initial_elements()?;
                let burns = burns(&orbit.executed_manoeuvres(seed), epoch)?;
                let ends = schedule.ends().unwrap_or([epoch; 2]);
                let states = NumericalStates::compute(orbit, config, burns, ends)?;
                Self { epoch: states.epoch(), motion: Motion::Numerical(states) }
            }
            TrajectorySource::Sampled(states) => {
                Self { epoch: states.epoch(), motion: Motion::Sampled(states.clone()) }
            }
        };
        for time in schedule.ends().into_iter().flatten() {
            trajectory.check_covers("schedule", time)?;
        }
        Ok(trajectory)
    }

    /// Returns the trajectory's epoch.
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Returns the interval of time in which the states are defined, seconds since the epoch; unlimited for
    /// mean elements. Outside it, [`Trajectory::states_at_seconds`] continues the nearest state as a
    /// Keplerian orbit.
    pub fn coverage_s(&self) -> RangeInclusive<f64> {
        match &self.motion {
            Motion::MeanElements(_) => f64::NEG_INFINITY..=f64::INFINITY,
            Motion::Numerical(states) => states.coverage_s(),
            Motion::Sampled(states) => states.coverage_s(),
        }
    }

    /// Checks that the states are defined at `time`, a time of the field `path`.
    ///
    /// # Errors
    /// [`OutOfRange`] with the covered interval.
    pub fn check_covers(&self, path: &str, time: Epoch) -> Result<(), OutOfRange> {
        let coverage = self.coverage_s();
        if coverage.contains(&self.seconds(time)) {
            return Ok(());
        }
        let utc = |seconds: f64| format_utc(self.epoch + Duration::from_seconds(seconds));
        let expected = format!(
            "times from {} to {}, which the trajectory covers",
            utc(*coverage.start()),
            utc(*coverage.end())
        );
        Err(OutOfRange::new(path, format_utc(time), expected))
    }

    /// Returns the seconds from the trajectory's epoch to `time`, including leap seconds.
    pub fn seconds(&self, time: Epoch) -> f64 {
        seconds_between(self.epoch, time)
    }

    /// Returns the states of chaser and target at `time`.
    pub fn states_at(&self, time: Epoch) -> States {
        self.states_at_seconds(self.seconds(time))
    }

    /// Returns the states of chaser and target `time_s` seconds after the trajectory's epoch; at an impulsive
    /// manoeuvre, the states just after it.
    pub fn states_at_seconds(&self, time_s: f64) -> States {
        match &self.motion {
            Motion::MeanElements(motion) => motion.states_at(time_s),
            Motion::Numerical(states) => states.states_at(time_s),
            Motion::Sampled(states) => states.states_at(time_s),
        }
    }

    /// Returns the relative orbital elements at `time`, m; at an impulsive manoeuvre, the elements just after
    /// it. They are differences of mean elements if the trajectory has them, otherwise of osculating
    /// elements. `None` if a state has no supported elements.
    pub fn relative_elements(&self, time: Epoch) -> Option<RelativeElements> {
        let time_s = self.seconds(time);
        if let Motion::MeanElements(motion) = &self.motion {
            let (chaser, target) = motion.elements(time_s);
            return Some(RelativeElements::between(&chaser, &target));
        }
        let states = self.states_at_seconds(time_s);
        let (chaser, target) = (Elements::from_state(&states.chaser)?, Elements::from_state(&states.target)?);
        Some(RelativeElements::between(&chaser, &target))
    }
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

#[cfg(test)]
mod tests {
    use super::super::clock::parse_utc_field;
    use super::super::orbit::ElementsConfig;
    use super::*;
    use nalgebra::Vector3;

    fn config() -> OrbitConfig {
        let manoeuvre = |time_utc: &str, dv_rtn_m_s| ManoeuvreConfig {
            time_utc: time_utc.into(),
            dv_rtn_m_s,
            duration_s: 0.0,
        };
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
            execution: None,
            reports: None,
        }
    }

    #[test]
    fn the_relative_elements_at_the_epoch_are_those_given() {
        let config = config();
        let trajectory = Trajectory::new(&config).unwrap();
        let got = trajectory.relative_elements(trajectory.epoch()).unwrap();
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
        assert_eq!(trajectory.seconds(trajectory.epoch() - Duration::from_seconds(1.5)), -1.5);
    }
}
