//! True attitude of the chaser: guidance through the nominal mounting, plus the errors of the attitude
//! control.

use contract::bounds::{self, require};
use contract::{Body, CameraFrame, Icrs, OutOfRange, Rotation};
use draws::{Effect, Seed};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attitude_profile::AttitudeProfile;
use super::drift::{Drift, DriftConfig, radians_from_arcsec, turned_by, white};
use super::guidance::Guidance;
use super::mounting::MountingConfig;
use super::states::States;
use crate::Switch;

/// Pointing of the chaser.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttitudeConfig {
    /// Intended pointing of the camera.
    pub guidance: Guidance,
    /// Deviation of the actual pointing from the intended pointing.
    #[serde(default)]
    pub control: ControlConfig,
    /// Smear of images by the motion of chaser and target during the exposure; if off, every image shows the
    /// geometry at mid-exposure.
    #[serde(default)]
    pub motion_smear: Switch,
}

/// Error of the attitude control about the body axes. A positive error rotates the body by the right-hand
/// rule from the attitude that guidance commands.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControlConfig {
    /// Slow part of the error; at least three periods, without a common multiple, so that it does not repeat.
    #[serde(default)]
    pub drift: DriftConfig,
    /// Standard deviation of the jitter about x, y, z, drawn anew in every frame, arcsec, 0 to 36000.
    #[serde(default)]
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub jitter_arcsec: [f64; 3],
    /// Standard deviation of the vibration about x, y, z within an exposure, arcsec, 0 (the default: none) to
    /// 36000. Its periods are much shorter than the exposure, so that it blurs images and displaces none.
    #[serde(default)]
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub vibration_arcsec: [f64; 3],
}

impl AttitudeConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "attitude")?;
        let drift = &self.control.drift;
        let count = drift.periods_s.len();
        require("attitude.control.drift.periods_s", count as f64, "3 to 16 periods", |_| {
            drift.is_still() || count >= 3
        })
    }
}

/// True attitude as a function of time and frame.
#[derive(Debug, Clone)]
pub struct Attitude {
    guidance: Guidance,
    /// Guidance assumes the nominal mounting.
    body_from_camera: Rotation<Body, CameraFrame>,
    drift: Drift,
    jitter_rad: Vector3<f64>,
    vibration_rad: Vector3<f64>,
    motion_smear: Switch,
    seed: Seed,
    /// Attitude that replaces guidance, and the origin of the states' times.
    profile: Option<(AttitudeProfile, Epoch)>,
}

impl Attitude {
    /// Creates the attitude and draws the values that apply to the whole run.
    ///
    /// # Errors
    /// See [`AttitudeConfig::check`] and [`MountingConfig::check`].
    pub fn new(config: &AttitudeConfig, mounting: &MountingConfig, seed: Seed) -> Result<Self, OutOfRange> {
        config.check()?;
        mounting.check()?;
        Ok(Self {
            guidance: config.guidance.clone(),
            body_from_camera: mounting.nominal.camera_from_body().inverse(),
            drift: Drift::new(&config.control.drift, seed, Effect::AttitudeControl),
            jitter_rad: radians_from_arcsec(config.control.jitter_arcsec),
            vibration_rad: radians_from_arcsec(config.control.vibration_arcsec),
            motion_smear: config.motion_smear,
            seed,
            profile: None,
        })
    }

    /// Replaces guidance by the attitude of a file; `epoch` is the origin of the states' times.
    ///
    /// # Errors
    /// [`OutOfRange`] for [`Guidance::Aem`] without the attitude of its file.
    pub fn with_profile(self, profile: Option<AttitudeProfile>, epoch: Epoch) -> Result<Self, OutOfRange> {
        if let (Guidance::Aem { file }, None) = (&self.guidance, &profile) {
            return Err(OutOfRange::new(
                "attitude.guidance.file",
                file,
                "the content of the file, with its path",
            ));
        }
        Ok(Self { profile: profile.map(|profile| (profile, epoch)), ..self })
    }

    /// Switch of the smear of images by motion.
    pub fn motion_smear(&self) -> Switch {
        self.motion_smear
    }

    /// Standard deviation of the vibration about the body axes within an exposure, rad.
    pub fn vibration_rad(&self) -> Vector3<f64> {
        self.vibration_rad
    }

    /// Returns the true attitude in `frame`, taken when chaser and target are at `states`.
    pub fn truth(&self, states: &States, frame: u64) -> Rotation<Body, Icrs> {
        let jitter = white(self.seed, frame, Effect::AttitudeControl, 0, self.jitter_rad);
        turned_by(self.drift.error_rad_at(states.time_s) + jitter) * self.guided(states)
    }

    /// Returns the attitude that guidance commands.
    fn guided(&self, states: &States) -> Rotation<Body, Icrs> {
        if let Some((profile, epoch)) = &self.profile {
            let nanoseconds = libm::round(states.time_s * 1e9) as i128;
            return profile.0.body_from_icrs(*epoch + Duration::from_total_nanoseconds(nanoseconds));
        }
        self.body_from_camera * self.guidance.camera_from_icrs(states)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Trajectory;
    use crate::orbit::ElementsConfig;
    use crate::relative::RelativeElements;
    use crate::states::OrbitConfig;
    use contract::{Direction, Mounting};

    pub(crate) const SEED: Seed = Seed { seed: 42, case: 0 };

    pub(crate) fn trajectory() -> Trajectory {
        Trajectory::new(&OrbitConfig {
            epoch_utc: "2012-04-23T00:00:00Z".into(),
            target: ElementsConfig {
                semi_major_axis_km: 7130.0,
                eccentricity: 0.0,
                inclination_deg: 98.28,
                raan_deg: 124.0,
                argument_of_perigee_deg: 0.0,
                mean_anomaly_deg: 0.0,
            },
            relative: RelativeElements { a_dlambda_m: -20_000.0, a_dey_m: 300.0, ..Default::default() },
            manoeuvres: vec![],
            execution: None,
            reports: None,
        })
        .unwrap()
    }

    pub(crate) fn quiet() -> AttitudeConfig {
        AttitudeConfig {
            guidance: Guidance::LocalOrbital { phi_deg: 0.0, theta_deg: 0.0, psi_deg: 0.0 },
            control: ControlConfig::default(),
            motion_smear: Switch::On,
        }
    }

    pub(crate) fn restless() -> AttitudeConfig {
        let control = ControlConfig {
            drift: DriftConfig { rms_arcsec: [60.0; 3], periods_s: vec![97.0, 613.0, 5939.0] },
            jitter_arcsec: [5.0, 10.0, 20.0],
            ..ControlConfig::default()
        };
        AttitudeConfig { control, ..quiet() }
    }

    fn mounting() -> MountingConfig {
        let nominal = Mounting { phi_deg: 10.0, theta_deg: -35.0, psi_deg: 100.0 };
        MountingConfig { actual: Mounting { phi_deg: 10.2, ..nominal }, nominal }
    }

    #[test]
    fn without_errors_the_nominal_camera_has_the_commanded_attitude() {
        let attitude = Attitude::new(&quiet(), &mounting(), SEED).unwrap();
        let states = trajectory().states_at_seconds(4321.0);
        let camera_from_icrs = mounting().nominal.camera_from_body() * attitude.truth(&states, 0);
        let expected = quiet().guidance.camera_from_icrs(&states);
        assert!(camera_from_icrs.angle_to(&expected).radians() < 1e-15);
        // The actual camera deviates by the 0.2° of its mounting.
        let actual = mounting().actual.camera_from_body() * attitude.truth(&states, 0);
        assert!((actual.angle_to(&expected).degrees() - 0.2).abs() < 1e-9);
    }

    #[test]
    fn the_target_stays_near_the_boresight_of_the_local_orbital_frame() {
        let attitude = Attitude::new(&restless(), &MountingConfig::default(), SEED).unwrap();
        let trajectory = trajectory();
        for frame in 0..400 {
            let states = trajectory.states_at_seconds(15.0 * frame as f64);
            let body_from_icrs = attitude.truth(&states, frame);
            let seen = body_from_icrs * Direction::from_vector(states.line_of_sight_km()).unwrap();
            // 300 m and the 600 m/20 km foreshortening at 20 km give 0.87°; control adds a few arcmin.
            assert!(seen.separation(&Direction::z()).degrees() < 1.1);
        }
    }

    #[test]
    fn a_frame_alone_has_the_attitude_it_has_in_the_run() {
        let trajectory = trajectory();
        let make = || Attitude::new(&restless(), &mounting(), SEED).unwrap();
        let run = make();
        let of = |attitude: &Attitude, frame: u64| {
            attitude.truth(&trajectory.states_at_seconds(15.0 * frame as f64), frame)
        };
        let in_run: Vec<_> = (0..700).map(|frame| of(&run, frame)).collect();
        for frame in [699, 0, 350] {
            assert_eq!(of(&make(), frame), in_run[frame as usize]);
        }
    }

    #[test]
    fn jitter_has_its_configured_standard_deviation() {
        let mut config = restless();
        config.control.drift = DriftConfig::default();
        let attitude = Attitude::new(&config, &MountingConfig::default(), SEED).unwrap();
        let still = Attitude::new(&quiet(), &MountingConfig::default(), SEED).unwrap();
        let states = trajectory().states_at_seconds(100.0);
        let n = 5000;
        let mut chi2 = Vector3::zeros();
        for frame in 0..n {
            let off = attitude.truth(&states, frame) * still.truth(&states, frame).inverse();
            let scaled =
                off.quaternion().scaled_axis().component_div(&radians_from_arcsec([5.0, 10.0, 20.0]));
            chi2 += scaled.component_mul(&scaled);
        }
        // χ² with n degrees of freedom: standard deviation √(2n) = 100; the tolerance is four of them.
        for axis in 0..3 {
            assert!((chi2[axis] - n as f64).abs() < 400.0, "{chi2}");
        }
    }

    #[test]
    fn control_that_repeats_is_refused() {
        let mut config = restless();
        config.control.drift.periods_s.truncate(2);
        assert!(config.check().unwrap_err().to_string().contains("periods_s"));
    }
}
