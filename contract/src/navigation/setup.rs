//! Data that a navigator receives before the first event.

use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Covariance6, RelativeElements};
use crate::bounds::{self, require};
use crate::{Body, CameraFrame, OutOfRange, Rotation};

/// Data that a navigator receives before the first event. Nothing in it is truth: values are reported or
/// assumed, with their σ.
#[derive(Debug, Clone, PartialEq)]
pub struct NavigationSetup {
    /// Epoch of the prior and of mean elements.
    pub epoch: Epoch,
    /// Absolute orbit of the chaser.
    pub chaser_orbit: ChaserOrbit,
    /// Nominal mounting of the camera.
    pub camera_from_body: Rotation<CameraFrame, Body>,
    /// Relative orbit at the epoch; `None`: the navigator determines it from the measurements alone.
    pub prior: Option<PriorOrbit>,
    /// Errors of the lines of sight.
    pub errors: LineOfSightErrors,
    /// Differential drag.
    pub drag: DifferentialDrag,
}

impl NavigationSetup {
    /// Checks the range of every number, and that reported states are at least two, in order of time.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        self.chaser_orbit.check()?;
        if let Some(prior) = &self.prior {
            bounds::check(&prior.elements, "navigation.prior")?;
        }
        bounds::check(&self.errors, "navigation.errors")?;
        bounds::check(&self.drag, "navigation.drag")
    }
}

/// Absolute orbit of the chaser as known on board or on the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum ChaserOrbit {
    /// Reported osculating states (of a satellite navigation receiver or an orbit determination), in order of
    /// time. They cover the measurements; manoeuvres are in them.
    States(Vec<ReportedState>),
    /// Mean elements at the epoch of the setup. The orbit after a manoeuvre follows from its report.
    Mean(MeanElements),
}

impl ChaserOrbit {
    fn check(&self) -> Result<(), OutOfRange> {
        let path = "navigation.chaser_orbit";
        match self {
            Self::Mean(elements) => bounds::check(elements, path),
            Self::States(states) => {
                let count = states.len() as f64;
                require(path, count, "at least two reported states", |count| count >= 2.0)?;
                for (index, state) in states.iter().enumerate() {
                    state.check(&format!("{path}[{index}]"))?;
                }
                match states.iter().zip(states.iter().skip(1)).position(|(a, b)| a.time >= b.time) {
                    None => Ok(()),
                    Some(index) => Err(OutOfRange::new(
                        format!("{path}[{}].time", index + 1),
                        states.get(index + 1).map_or(String::new(), |state| state.time.to_string()),
                        "later than the previous state",
                    )),
                }
            }
        }
    }
}

/// Reported state of the chaser relative to the Earth's centre, ICRS axes (inertial, not Earth-fixed).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportedState {
    /// Time of the state.
    pub time: Epoch,
    /// Position, km.
    pub position_km: Vector3<f64>,
    /// Inertial velocity, km/s.
    pub velocity_km_s: Vector3<f64>,
    /// Standard deviation of each component of the position, m.
    pub position_sigma_m: f64,
    /// Standard deviation of each component of the velocity, m/s.
    pub velocity_sigma_m_s: f64,
}

impl ReportedState {
    fn check(&self, path: &str) -> Result<(), OutOfRange> {
        let norm = |vector: &Vector3<f64>| vector.norm();
        require(
            format!("{path}.position_km"),
            norm(&self.position_km),
            "a distance of 6400 to 1e5 km",
            |r| (6400.0..=1e5).contains(&r),
        )?;
        require(
            format!("{path}.velocity_km_s"),
            norm(&self.velocity_km_s),
            "a speed of 0.1 to 12 km/s",
            |v| (0.1..=12.0).contains(&v),
        )?;
        let sigmas =
            [("position_sigma_m", self.position_sigma_m), ("velocity_sigma_m_s", self.velocity_sigma_m_s)];
        sigmas.into_iter().try_for_each(|(name, sigma)| {
            require(format!("{path}.{name}"), sigma, "a positive number up to 1e6", |s| s > 0.0 && s <= 1e6)
        })
    }
}

/// Mean Keplerian elements: short-period terms are averaged out, secular ones are not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeanElements {
    /// Semi-major axis, km, 6478 to 1e5.
    #[schemars(range(min = 6478, max = 1e5))]
    pub semi_major_axis_km: f64,
    /// Eccentricity, 0 to 0.9.
    #[schemars(range(min = 0, max = 0.9))]
    pub eccentricity: f64,
    /// Inclination, degrees, 0.01 to 179.99.
    #[schemars(range(min = 0.01, max = 179.99))]
    pub inclination_deg: f64,
    /// Right ascension of the ascending node, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub raan_deg: f64,
    /// Argument of perigee, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub argument_of_perigee_deg: f64,
    /// Mean anomaly at the epoch, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub mean_anomaly_deg: f64,
}

/// Relative orbit before the first measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorOrbit {
    /// Mean relative elements at the epoch of the setup.
    pub elements: RelativeElements,
    /// Covariance of the elements in the order of the fields of [`RelativeElements`], m².
    pub covariance: Covariance6,
}

/// Errors of the lines of sight, by the source of the camera's attitude. The covariance of a measurement
/// replaces the white part of these errors, not the slow and the constant part.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineOfSightErrors {
    /// Errors where the attitude was solved from stars of the same image.
    #[serde(default)]
    pub with_stars: AngleErrors,
    /// Errors where the attitude is that of the telemetry and a mounting, or its source is unknown.
    #[serde(default)]
    pub without_stars: AngleErrors,
    /// Slow displacements of the measured point of the target from its centre of mass, for both classes;
    /// their sum applies; at most eight.
    #[serde(default)]
    #[schemars(length(max = 8))]
    pub displacements: Vec<SlowDisplacement>,
}

/// Errors of a measured direction as rotations about the axes of the camera, arcsec.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AngleErrors {
    /// Standard deviation of the error that is independent in every frame, across columns and across rows,
    /// arcsec, each 0 to 36000; the covariance of a measurement replaces it.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub white_arcsec: [f64; 2],
    /// Slow errors, whose sum applies; at most eight.
    #[serde(default)]
    #[schemars(length(max = 8))]
    pub slow: Vec<SlowError>,
    /// Standard deviation of the constant error (mounting, centre of brightness, alignment) about the
    /// camera's x, y, z axes, arcsec, each 0 to 36000.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub constant_arcsec: [f64; 3],
}

/// A slow error with exponentially decaying memory: autocovariance σ² exp(−|Δt|/τ) cos(2π Δt/P), without
/// the cosine if no period is stated (first-order Gauss–Markov process).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlowError {
    /// Standard deviation across columns and across rows, arcsec, each 0 to 36000.
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub sigma_arcsec: [f64; 2],
    /// Time constant of the memory τ, s, 1 to 1e9.
    #[schemars(range(min = 1, max = 1e9))]
    pub memory_s: f64,
    /// Period P of a periodic error, s, 1 to 1e9; `None` for an aperiodic one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1e9))]
    pub period_s: Option<f64>,
}

/// A slow displacement of the measured point of the target across the line of sight, such as that of the
/// centre of brightness. Its autocovariance is that of a [`SlowError`], in metres; the angle of the error is
/// the displacement over the distance, which the navigator takes from its own trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlowDisplacement {
    /// Standard deviation across columns and across rows, m, each 0 to 10000.
    #[schemars(inner(range(min = 0, max = 1e4)))]
    pub sigma_m: [f64; 2],
    /// Time constant of the memory τ, s, 1 to 1e9.
    #[schemars(range(min = 1, max = 1e9))]
    pub memory_s: f64,
    /// Period P of a periodic displacement, s, 1 to 1e9; `None` for an aperiodic one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1e9))]
    pub period_s: Option<f64>,
}

/// Differential drag: the constant rate of aδa, −n a² ρ (B_chaser − B_target) with the ballistic coefficients
/// B = C_D A/m and the density ρ of the air (D'Amico 2010, section 2.3; sign: a chaser with more drag sinks).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DifferentialDrag {
    /// Expected rate of aδa, m per day, −1e5 to 1e5.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub a_da_rate_m_per_day: f64,
    /// Standard deviation of the rate, m per day, 0 to 1e5; 0: the rate is not estimated.
    #[schemars(range(min = 0, max = 1e5))]
    pub sigma_m_per_day: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup() -> NavigationSetup {
        NavigationSetup {
            epoch: Epoch::from_gregorian_utc_at_midnight(2012, 4, 23),
            chaser_orbit: ChaserOrbit::Mean(MeanElements {
                semi_major_axis_km: 7130.0,
                eccentricity: 0.003,
                inclination_deg: 98.28,
                raan_deg: 126.4,
                argument_of_perigee_deg: 90.0,
                mean_anomaly_deg: 270.0,
            }),
            camera_from_body: Rotation::identity(),
            prior: None,
            errors: LineOfSightErrors::default(),
            drag: DifferentialDrag::default(),
        }
    }

    #[test]
    fn each_value_outside_its_range_is_named() {
        setup().check().unwrap();
        let refused = |change: fn(&mut NavigationSetup)| {
            let mut wrong = setup();
            change(&mut wrong);
            wrong.check().unwrap_err().path
        };
        let state = |seconds: f64| ReportedState {
            time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 23) + hifitime::Unit::Second * seconds,
            position_km: Vector3::new(7130.0, 0.0, 0.0),
            velocity_km_s: Vector3::new(0.0, 7.5, 0.0),
            position_sigma_m: 10.0,
            velocity_sigma_m_s: 0.1,
        };
        let states = |states: Vec<ReportedState>| {
            let setup = NavigationSetup { chaser_orbit: ChaserOrbit::States(states), ..setup() };
            setup.check().map_err(|error| error.path)
        };
        assert_eq!(states(vec![state(0.0), state(60.0)]), Ok(()));
        assert_eq!(states(vec![state(0.0)]), Err("navigation.chaser_orbit".to_owned()));
        assert_eq!(states(vec![state(0.0), state(0.0)]), Err("navigation.chaser_orbit[1].time".to_owned()));
        let lost = ReportedState { position_km: Vector3::repeat(f64::NAN), ..state(60.0) };
        assert_eq!(states(vec![state(0.0), lost]), Err("navigation.chaser_orbit[1].position_km".to_owned()));
        let certain = ReportedState { position_sigma_m: 0.0, ..state(60.0) };
        assert_eq!(
            states(vec![state(0.0), certain]),
            Err("navigation.chaser_orbit[1].position_sigma_m".to_owned())
        );
        assert_eq!(refused(|s| s.drag.sigma_m_per_day = -1.0), "navigation.drag.sigma_m_per_day");
        let path = "navigation.errors.with_stars.white_arcsec[1]";
        assert_eq!(refused(|s| s.errors.with_stars.white_arcsec[1] = f64::NAN), path);
        let displaced = |sigma_m, memory_s, period_s| {
            let mut setup = setup();
            setup.errors.displacements = vec![SlowDisplacement { sigma_m, memory_s, period_s }];
            setup.check().map_err(|error| error.path)
        };
        let path = |key: &str| Err(format!("navigation.errors.displacements[0].{key}"));
        assert_eq!(displaced([0.1, 0.0], 5900.0, Some(5900.0)), Ok(()));
        assert_eq!(displaced([0.1, -0.1], 5900.0, None), path("sigma_m[1]"));
        assert_eq!(displaced([0.1; 2], 0.0, None), path("memory_s"));
        assert_eq!(displaced([0.1; 2], 5900.0, Some(f64::INFINITY)), path("period_s"));
    }
}
