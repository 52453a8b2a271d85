//! Knowledge of the chaser about its own attitude and velocity, with errors.

use contract::{OutOfRange, Telemetry, bounds};
use draws::{Effect, Seed};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attitude::Attitude;
use super::drift::{Drift, DriftConfig, radians_from_arcsec, turned_by, white};
use super::trajectory::Trajectory;

/// First index of the velocity noise in an address; the attitude noise has indices 0 to 2.
const VELOCITY_INDEX: u64 = 3;

/// Errors of the telemetry. With a positive error about a body axis, telemetry reports an attitude rotated by
/// the right-hand rule from the true attitude.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KnowledgeConfig {
    /// Constant error about the body's x, y, z axes, arcsec, each −36000 to 36000.
    #[serde(default)]
    #[schemars(inner(range(min = -36000, max = 36000)))]
    pub bias_arcsec: [f64; 3],
    /// Slow error, for example with the orbital period.
    #[serde(default)]
    pub drift: DriftConfig,
    /// Standard deviation of the noise about x, y, z, drawn anew in every frame, arcsec, 0 to 36000.
    #[serde(default)]
    #[schemars(inner(range(min = 0, max = 36000)))]
    pub noise_arcsec: [f64; 3],
    /// Error of the time tag, s, −60 to 60: the attitude reported for t is that of t − latency.
    #[serde(default)]
    #[schemars(range(min = -60, max = 60))]
    pub latency_s: f64,
    /// Standard deviation of the noise of each velocity component, drawn anew in every frame, m/s, 0 to 1000.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub velocity_noise_m_s: f64,
}

impl KnowledgeConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "knowledge")?;
        self.drift.check("knowledge.drift")
    }
}

/// Generator of telemetry from the ground truth.
#[derive(Debug, Clone)]
pub struct Knowledge {
    bias_rad: Vector3<f64>,
    drift: Drift,
    noise_rad: Vector3<f64>,
    latency_s: f64,
    velocity_noise_km_s: f64,
    seed: Seed,
}

impl Knowledge {
    /// Creates the generator and draws the values that apply to the whole run.
    ///
    /// # Errors
    /// See [`KnowledgeConfig::check`].
    pub fn new(config: &KnowledgeConfig, seed: Seed) -> Result<Self, OutOfRange> {
        config.check()?;
        Ok(Self {
            bias_rad: radians_from_arcsec(config.bias_arcsec),
            drift: Drift::new(&config.drift, seed, Effect::AttitudeKnowledge),
            noise_rad: radians_from_arcsec(config.noise_arcsec),
            latency_s: config.latency_s,
            velocity_noise_km_s: config.velocity_noise_m_s * 1e-3,
            seed,
        })
    }

    /// Returns the telemetry of `frame`, with mid-exposure at `time` and exposure time `exposure_s`.
    ///
    /// The latency shifts guidance and the slow control error; the jitter and the velocity are those of the
    /// frame itself.
    pub fn telemetry(
        &self,
        attitude: &Attitude,
        trajectory: &Trajectory,
        time: Epoch,
        frame: u64,
        exposure_s: f64,
    ) -> Telemetry {
        let time_s = trajectory.seconds(time);
        let sensed = attitude.truth(&trajectory.states_at_seconds(time_s - self.latency_s), frame);
        let noise = white(self.seed, frame, Effect::AttitudeKnowledge, 0, self.noise_rad);
        let error = self.bias_rad + self.drift.error_rad_at(time_s) + noise;
        let sigma = Vector3::repeat(self.velocity_noise_km_s);
        let velocity_noise = white(self.seed, frame, Effect::AttitudeKnowledge, VELOCITY_INDEX, sigma);
        Telemetry {
            time,
            exposure_s,
            body_from_icrs: turned_by(error) * sensed,
            velocity_km_s: Some(trajectory.states_at_seconds(time_s).chaser.velocity_km_s + velocity_noise),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::tests::{SEED, quiet, restless, trajectory};
    use crate::mounting::MountingConfig;
    use hifitime::Duration;

    const DT_S: f64 = 15.0;

    fn attitude(restless_control: bool) -> Attitude {
        let config = if restless_control { restless() } else { quiet() };
        Attitude::new(&config, &MountingConfig::default(), SEED).unwrap()
    }

    fn telemetry_of(config: &KnowledgeConfig, attitude: &Attitude, frame: u64) -> Telemetry {
        let trajectory = trajectory();
        let time = trajectory.epoch() + Duration::from_seconds(DT_S * frame as f64);
        Knowledge::new(config, SEED).unwrap().telemetry(attitude, &trajectory, time, frame, 0.1)
    }

    /// Rotation of the reported body axes from the true body axes, rad.
    fn error(config: &KnowledgeConfig, attitude: &Attitude, frame: u64) -> Vector3<f64> {
        let truth = attitude.truth(&trajectory().states_at_seconds(DT_S * frame as f64), frame);
        let measured_from_true = telemetry_of(config, attitude, frame).body_from_icrs * truth.inverse();
        -measured_from_true.quaternion().scaled_axis()
    }

    #[test]
    fn perfect_knowledge_reports_the_true_attitude() {
        let config = KnowledgeConfig::default();
        assert!(error(&config, &attitude(true), 17).norm() < 1e-15);
        let velocity = telemetry_of(&config, &attitude(true), 17).velocity_km_s.unwrap();
        assert_eq!(velocity, trajectory().states_at_seconds(DT_S * 17.0).chaser.velocity_km_s);
    }

    #[test]
    fn a_bias_turns_the_reported_axes_by_the_right_hand_rule() {
        let config = KnowledgeConfig { bias_arcsec: [100.0, -40.0, 7.0], ..Default::default() };
        assert!(
            (error(&config, &attitude(true), 3) - radians_from_arcsec([100.0, -40.0, 7.0])).norm() < 1e-15
        );
        // With the body reported as rotated by +100″ about x, a star along the true z moves towards +y.
        let config = KnowledgeConfig { bias_arcsec: [100.0, 0.0, 0.0], ..Default::default() };
        let attitude = attitude(false);
        let truth = attitude.truth(&trajectory().states_at_seconds(0.0), 0);
        let star = truth.inverse() * contract::Direction::z();
        let seen = telemetry_of(&config, &attitude, 0).body_from_icrs * star;
        assert!((seen.vector().y - radians_from_arcsec([100.0; 3]).x).abs() < 1e-9);
    }

    #[test]
    fn noise_has_its_configured_standard_deviation() {
        let noise_arcsec = [3.0, 5.0, 30.0];
        let config = KnowledgeConfig { noise_arcsec, velocity_noise_m_s: 0.5, ..Default::default() };
        let (attitude, trajectory) = (attitude(true), trajectory());
        let knowledge = Knowledge::new(&config, SEED).unwrap();
        let (time, states) = (trajectory.epoch(), trajectory.states_at_seconds(0.0));
        let n = 5000;
        let (mut turn, mut velocity) = (Vector3::zeros(), 0.0);
        for frame in 0..n {
            let measured = knowledge.telemetry(&attitude, &trajectory, time, frame, 0.1);
            let off = measured.body_from_icrs * attitude.truth(&states, frame).inverse();
            let scaled = off.quaternion().scaled_axis().component_div(&radians_from_arcsec(noise_arcsec));
            turn += scaled.component_mul(&scaled);
            let dv = measured.velocity_km_s.unwrap() - states.chaser.velocity_km_s;
            velocity += (dv / 0.5e-3).norm_squared();
        }
        // χ² with n degrees of freedom has the standard deviation √(2n) = 100, with 3n degrees 173; the
        // tolerance is four of them.
        for axis in 0..3 {
            assert!((turn[axis] - n as f64).abs() < 400.0, "{turn}");
        }
        assert!((velocity - 3.0 * n as f64).abs() < 700.0, "{velocity}");
    }

    #[test]
    fn noise_of_knowledge_does_not_follow_the_jitter_of_control() {
        let config = KnowledgeConfig { noise_arcsec: [10.0; 3], ..Default::default() };
        let (loud, calm) = (attitude(true), attitude(false));
        // The draws are the same with and without control errors.
        assert!((error(&config, &loud, 5) - error(&config, &calm, 5)).norm() < 1e-15);
    }

    #[test]
    fn a_latency_reports_an_earlier_attitude() {
        let config = KnowledgeConfig { latency_s: 2.0, ..Default::default() };
        // The body rotates about −y at 1.0486e-3 rad/s: its attitude two seconds earlier is rotated in the
        // opposite sense.
        let expected = Vector3::new(0.0, 2.0 * 1.0486e-3, 0.0);
        // Relative effects of the oblateness and of the chaser's eccentricity: 1e-3 and 1e-4.
        assert!((error(&config, &attitude(false), 40) - expected).norm() < 6e-6);
    }

    #[test]
    fn a_drift_is_seen_in_telemetry() {
        let drift = DriftConfig { rms_arcsec: [50.0; 3], periods_s: vec![5992.0] };
        let config = KnowledgeConfig { drift: drift.clone(), ..Default::default() };
        let expected = Drift::new(&drift, SEED, Effect::AttitudeKnowledge).error_rad_at(DT_S * 100.0);
        assert!((error(&config, &attitude(true), 100) - expected).norm() < 1e-15);
        assert!(expected.norm() > 0.0);
    }

    #[test]
    fn a_single_frame_has_the_same_report_as_in_the_run() {
        let config = KnowledgeConfig {
            noise_arcsec: [10.0; 3],
            drift: DriftConfig { rms_arcsec: [50.0; 3], periods_s: vec![5992.0, 700.0] },
            latency_s: 0.3,
            ..Default::default()
        };
        let attitude = attitude(true);
        let in_run: Vec<_> = (0..50).map(|frame| telemetry_of(&config, &attitude, frame)).collect();
        for frame in [49, 0, 25] {
            assert_eq!(telemetry_of(&config, &attitude, frame), in_run[frame as usize]);
        }
    }

    #[test]
    fn knowledge_outside_its_range_is_refused_by_name() {
        let bad = [
            (KnowledgeConfig { latency_s: f64::NAN, ..Default::default() }, "latency_s"),
            (KnowledgeConfig { noise_arcsec: [-1.0, 0.0, 0.0], ..Default::default() }, "noise_arcsec"),
            (KnowledgeConfig { bias_arcsec: [1e6, 0.0, 0.0], ..Default::default() }, "bias_arcsec"),
            (KnowledgeConfig { velocity_noise_m_s: -1.0, ..Default::default() }, "velocity_noise_m_s"),
        ];
        for (config, name) in bad {
            assert!(config.check().unwrap_err().to_string().contains(name));
        }
    }
}
