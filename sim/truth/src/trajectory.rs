//! Positions and velocities of chaser and target at any time.
//!
//! [`Trajectory`] has one interface for every kind of motion: [mean elements](MeanElements) that drift at
//! secular rates, [numerically integrated orbits](NumericalConfig), and [sampled states](SampledStates),
//! which a file of flight dynamics contains. Internal time is seconds (SI, as TT and TAI count them) since
//! the trajectory's epoch, exact to 0.1 ns within months of the epoch.

use std::ops::RangeInclusive;
use std::sync::Arc;

use contract::{OutOfRange, bounds};
use hifitime::{Duration, Epoch};

use super::clock::format_utc;
use super::ephemeris::check_covered;
use super::manoeuvre::{
    Burn, ManoeuvreDraws, ManoeuvreErrorsConfig, ManoeuvreReportsConfig, ManoeuvreTruth, PlannedManoeuvre,
};
use super::mean_elements::MeanElements;
use super::numerical::{InitialState, InitialStates, NumericalConfig, NumericalStates};
use super::orbit::{Elements, State};
use super::relative::RelativeElements;
use super::sampled::SampledStates;
use super::schedule::Schedule;
use super::states::{OrbitConfig, States, burns, seconds_between};

/// Origin of the motion of chaser and target.
#[derive(Debug, Clone, PartialEq)]
pub enum TrajectorySource {
    /// Mean elements with secular drift.
    MeanElements(OrbitConfig),
    /// Orbits whose elements are osculating at the epoch, integrated numerically.
    Numerical(OrbitConfig, NumericalConfig),
    /// States, for example from files of flight dynamics, from which the orbits are integrated numerically.
    Propagated(Arc<PropagatedStates>, NumericalConfig),
    /// States sampled over time, for example from a file of flight dynamics.
    Sampled(Arc<SampledStates>),
}

impl TrajectorySource {
    /// Returns the orbits; `None` if the motion is not that of configured orbits.
    pub fn orbit(&self) -> Option<&OrbitConfig> {
        match self {
            Self::MeanElements(orbit) | Self::Numerical(orbit, _) => Some(orbit),
            Self::Propagated(..) | Self::Sampled(_) => None,
        }
    }

    /// [`TrajectorySource::orbit`] for changes.
    pub fn orbit_mut(&mut self) -> Option<&mut OrbitConfig> {
        match self {
            Self::MeanElements(orbit) | Self::Numerical(orbit, _) => Some(orbit),
            Self::Propagated(..) | Self::Sampled(_) => None,
        }
    }
}

/// Initial states of both spacecraft and the chaser's manoeuvres.
#[derive(Debug, Clone, PartialEq)]
pub struct PropagatedStates {
    /// Time and state of the chaser; the time is the trajectory's epoch.
    pub chaser: (Epoch, State),
    /// Time and state of the target.
    pub target: (Epoch, State),
    /// Manoeuvres of the chaser, in order of time, all after its state and apart from each other.
    pub manoeuvres: Vec<PlannedManoeuvre>,
    /// Errors of the executed manoeuvres.
    pub execution: ManoeuvreErrorsConfig,
    /// Reports of the manoeuvres in the telemetry.
    pub reports: ManoeuvreReportsConfig,
}

impl PropagatedStates {
    /// Returns the manoeuvres as executed, seconds since the chaser's state.
    fn burns(&self, draws: &ManoeuvreDraws) -> Result<Vec<Burn>, OutOfRange> {
        let mut free_from_s = 0.0;
        let mut burns = Vec::with_capacity(self.manoeuvres.len());
        for (index, manoeuvre) in self.manoeuvres.iter().enumerate() {
            let PlannedManoeuvre { time, duration_s, axes, dv_m_s } = *manoeuvre;
            let start_s = seconds_between(self.chaser.0, time) - 0.5 * duration_s;
            // The comparison is false for NaN.
            if !(start_s >= free_from_s && duration_s >= 0.0) {
                return Err(OutOfRange::new(
                    "trajectory.chaser",
                    format!("manoeuvre {} at {} for {duration_s} s", index + 1, format_utc(time)),
                    "a manoeuvre after the chaser's state and after the end of the preceding manoeuvre",
                ));
            }
            free_from_s = start_s + duration_s;
            let dv_km_s = nalgebra::Vector3::from(draws.executed(dv_m_s, index)) * 1e-3;
            burns.push(Burn { start_s, duration_s, axes, dv_km_s });
        }
        Ok(burns)
    }
}

/// Motion of chaser and target.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    epoch: Epoch,
    motion: Motion,
    manoeuvres: Vec<ManoeuvreTruth>,
    /// Path in a scenario of the value that gives the motion of one spacecraft relative to the other.
    relative_path: &'static str,
}

/// Value of [`Trajectory::relative_path`] for configured orbits.
const RELATIVE_ORBIT: &str = "orbit.relative";

/// Value of [`Trajectory::relative_path`] for files.
const TARGET_FILE: &str = "trajectory.target";

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
        let planned = OrbitConfig { execution: None, ..config.clone() };
        Self::from_mean_elements(&planned, 0)
    }

    fn from_mean_elements(orbit: &OrbitConfig, seed: u64) -> Result<Self, OutOfRange> {
        let motion = MeanElements::new(orbit, &orbit.executed_manoeuvres(seed))?;
        Ok(Self::unmanoeuvred(motion.epoch(), Motion::MeanElements(motion), RELATIVE_ORBIT)
            .with_manoeuvres(&orbit.draws(seed), &orbit.planned_manoeuvres()?))
    }

    /// Creates the trajectory of `source` for the frames of `schedule`. `seed` is that of the scenario.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid orbit or manoeuvre, see [`Trajectory::new`]; for a schedule with frames
    /// outside [`Trajectory::coverage_s`].
    pub fn from_source(
        source: &TrajectorySource,
        seed: u64,
        schedule: &Schedule,
    ) -> Result<Self, OutOfRange> {
        let integrate = |initial: &InitialStates, config: &NumericalConfig, burns: Vec<Burn>| {
            let ends = schedule.ends().unwrap_or([initial.epoch; 2]);
            NumericalStates::compute(initial, config, burns, ends).map_err(|error| {
                match error.path.as_str() {
                    "epoch" => OutOfRange { path: initial.epoch_path.to_owned(), ..error },
                    _ => error,
                }
            })
        };
        let trajectory = match source {
            TrajectorySource::MeanElements(orbit) => Self::from_mean_elements(orbit, seed)?,
            TrajectorySource::Numerical(orbit, config) => {
                config.check("trajectory")?;
                let (epoch, chaser, target) = orbit.initial_elements()?;
                let at_epoch =
                    |elements: Elements, path| InitialState { time_s: 0.0, state: elements.state(), path };
                let initial = InitialStates {
                    epoch,
                    epoch_path: "orbit.epoch_utc",
                    chaser: at_epoch(chaser, "orbit.relative"),
                    target: at_epoch(target, "orbit.target"),
                };
                let burns = burns(orbit, &orbit.executed_manoeuvres(seed), epoch)?;
                let states = integrate(&initial, config, burns)?;
                Self::unmanoeuvred(epoch, Motion::Numerical(states), RELATIVE_ORBIT)
                    .with_manoeuvres(&orbit.draws(seed), &orbit.planned_manoeuvres()?)
            }
            TrajectorySource::Propagated(propagated, config) => {
                config.check("trajectory.forces")?;
                let PropagatedStates { chaser, target, manoeuvres, execution, reports } = &**propagated;
                bounds::check(execution, "trajectory.execution")?;
                bounds::check(reports, "trajectory.reports")?;
                let epoch = chaser.0;
                let at = |path: &'static str, (time, state): (Epoch, State)| {
                    check_covered(path, &format_utc(time), time)?;
                    Ok::<_, OutOfRange>(InitialState { time_s: seconds_between(epoch, time), state, path })
                };
                let initial = InitialStates {
                    epoch,
                    epoch_path: "trajectory.chaser",
                    chaser: at("trajectory.chaser", *chaser)?,
                    target: at("trajectory.target", *target)?,
                };
                let draws = ManoeuvreDraws { execution: *execution, reports: *reports, seed };
                let states = integrate(&initial, config, propagated.burns(&draws)?)?;
                Self::unmanoeuvred(epoch, Motion::Numerical(states), TARGET_FILE)
                    .with_manoeuvres(&draws, manoeuvres)
            }
            TrajectorySource::Sampled(states) => {
                Self::unmanoeuvred(states.epoch(), Motion::Sampled(states.clone()), TARGET_FILE)
            }
        };
        for time in schedule.ends().into_iter().flatten() {
            trajectory.check_covers("schedule", time)?;
        }
        Ok(trajectory)
    }

    fn unmanoeuvred(epoch: Epoch, motion: Motion, relative_path: &'static str) -> Self {
        Self { epoch, motion, manoeuvres: Vec::new(), relative_path }
    }

    /// Returns the path in a scenario of the value that gives the motion of one spacecraft relative to the
    /// other, for messages.
    pub fn relative_path(&self) -> &'static str {
        self.relative_path
    }

    fn with_manoeuvres(self, draws: &ManoeuvreDraws, planned: &[PlannedManoeuvre]) -> Self {
        /// Interval that separates the state before an impulse from the impulse, s.
        const BEFORE_S: f64 = 1e-6;
        let manoeuvres =
            draws.truth(planned, |time| self.states_at_seconds(self.seconds(time) - BEFORE_S).chaser);
        Self { manoeuvres, ..self }
    }

    /// Returns the manoeuvres of the chaser in order of time; none for sampled states, which contain them.
    pub fn manoeuvres(&self) -> &[ManoeuvreTruth] {
        &self.manoeuvres
    }

    /// Returns the times in ascending order at which the chaser's velocity or acceleration jumps, seconds
    /// since the epoch: impulses, begins and ends of finite burns; borders of segments for sampled states. No
    /// polynomial should cross them.
    pub fn chaser_borders_s(&self) -> Vec<f64> {
        if let Motion::Sampled(states) = &self.motion {
            return states.chaser_borders_s();
        }
        let mut borders: Vec<f64> = self
            .manoeuvres
            .iter()
            .flat_map(|manoeuvre| manoeuvre.ends().map(|time| self.seconds(time)))
            .collect();
        borders.dedup();
        borders
    }

    /// [`Trajectory::chaser_borders_s`] of the target.
    pub fn target_borders_s(&self) -> Vec<f64> {
        match &self.motion {
            Motion::Sampled(states) => states.target_borders_s(),
            Motion::MeanElements(_) | Motion::Numerical(_) => Vec::new(),
        }
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
        // At an impulse, the motion is that just after it.
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
    use super::super::manoeuvre::ManoeuvreConfig;
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
