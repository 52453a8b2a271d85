//! Motion from poses of fields, with acceleration: three filters of one state that differ in how hard the camera accelerates, and a
//! probability of each.
//!
//! State: (d, φ), its rates and accelerations. An acceleration is a random function of time with a standard deviation σ and a
//! memory τ (Singer 1970); the filters have σ, a fifth and a thirtieth of it, and exchange their estimates as the probabilities of a change between them
//! say (interacting multiple models: Blom & Bar-Shalom 1988). A hold or a glide is followed with a small σ, a braking ship
//! with a large one, and the covariance holds the doubt which of them it is.

use contract::docking::{Motion, PoseEstimate};
use contract::{OutOfRange, bounds};
use nalgebra::{Cholesky, Matrix6, SMatrix, SVector, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::scatter::Scatter;
use crate::PipelineError;
use crate::docking::pose::geometry::{to_pose, to_vector};

/// (d, φ), rates, accelerations.
type State = SVector<f64, 18>;
type Square = SMatrix<f64, 18, 18>;

/// How the camera may move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// Standard deviation of each component of acceleration while the ship manoeuvres, m/s², above 0 to 100: a change of speed by
    /// 0.8 m/s within 3 s.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub acceleration_m_s2: f64,
    /// The same of rotation, degrees/s², above 0 to 100.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub angular_acceleration_deg_s2: f64,
    /// Memory of an acceleration, s, 0.1 to 1000.
    #[schemars(range(min = 0.1, max = 1000))]
    pub memory_s: f64,
    /// Standard deviation of each component of velocity before anything is measured, m/s, above 0 to 100; no motion is reported
    /// whose range rate is above three of it.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub speed_m_s: f64,
    /// The same of rotation, degrees/s, above 0 to 100.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub rotation_deg_s: f64,
    /// A field is left out when its pose is off the motion by more than this normalised square (chi-square of 6 degrees of
    /// freedom), above 0 to 1e12.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub field_gate: f64,
}

impl Default for MotionConfig {
    /// A cargo ship that docks; a gate that noise passes once in 10⁷ fields.
    fn default() -> Self {
        Self {
            acceleration_m_s2: 0.3,
            angular_acceleration_deg_s2: 0.3,
            memory_s: 3.0,
            speed_m_s: 2.0,
            rotation_deg_s: 1.0,
            field_gate: 45.0,
        }
    }
}

impl MotionConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first one outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "motion")
    }
}

/// Accelerations of the filters, as parts of the configured one.
const MODES: [f64; 3] = [1.0, 0.2, 0.03];

/// Mean time after which one filter's motion gives way to another's, s.
const CHANGE_S: f64 = 5.0;

/// Longest step of a prediction, s: accelerations fade within some of them.
const STEP_S: f64 = 0.5;

/// After a longer time without a pose nothing is known of the motion, s.
const MAX_GAP_S: f64 = 5.0;

/// Fields in a row that are off the motion, and near each other, begin it anew.
const CONTRARY: u32 = 5;

/// Fields after which a motion confirms a pose that would not be told alone.
const ESTABLISHED: u32 = 4;

/// Fields without which a motion is not reported.
const LEAST_FIELDS: u32 = 3;

/// Motion of the camera, field by field.
#[derive(Debug, Clone)]
pub struct MotionTracker {
    config: MotionConfig,
    track: Option<Track>,
    scatter: Scatter,
    /// Fields in a row that were left out.
    contrary: u32,
    /// Fields taken since the last report, and since the motion began.
    fields: u32,
    all_fields: u32,
}

#[derive(Debug, Clone)]
struct Track {
    time_s: f64,
    modes: [Mode; MODES.len()],
    /// What errs alike in the fields of seconds: added to what the filters say.
    common: Matrix6<f64>,
}

/// One filter.
#[derive(Debug, Clone)]
struct Mode {
    probability: f64,
    state: State,
    covariance: Square,
}

/// Whether a pose is on the motion so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Continuity {
    /// It is, or nothing is known of the motion.
    Continues,
    /// It is off it by more than the gate.
    Breaks,
}

impl MotionTracker {
    /// Nothing measured yet.
    ///
    /// # Errors
    /// Those of [`MotionConfig::check`].
    pub fn new(config: MotionConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config, track: None, scatter: Scatter::default(), contrary: 0, fields: 0, all_fields: 0 })
    }

    /// Whether a pose lies on a motion that is established, by as many fields as would begin one anew.
    pub fn confirms(&self, time_s: f64, estimate: &PoseEstimate) -> bool {
        let Some(track) = self.track.as_ref().filter(|_| self.all_fields >= ESTABLISHED) else {
            return false;
        };
        let elapsed_s = time_s - track.time_s;
        if !(elapsed_s > 0.0 && elapsed_s <= MAX_GAP_S) {
            return false;
        }
        let mut next = track.clone();
        next.predict(time_s, &self.config);
        let square = next.least_square(&to_vector(&estimate.pose), &(estimate.covariance + track.common));
        square.is_some_and(|square| square <= self.config.field_gate)
    }

    /// Takes the pose of a field, and the part of its covariance that errs alike in the fields of seconds. Says whether it continues the
    /// motion, and by which factor the fields scatter more than their covariances say.
    pub fn add(&mut self, time_s: f64, estimate: &PoseEstimate, common: &Matrix6<f64>) -> (Continuity, f64) {
        if !time_s.is_finite() {
            return (Continuity::Continues, 1.0);
        }
        let is_kept = self.track.as_ref().is_some_and(|track| {
            let elapsed_s = time_s - track.time_s;
            elapsed_s > 0.0 && elapsed_s <= MAX_GAP_S
        });
        if !is_kept {
            self.scatter = Scatter::default();
            self.scatter.add(time_s, estimate);
            self.begin(time_s, estimate, common);
            return (Continuity::Continues, 1.0);
        }
        let factor = self.scatter.add(time_s, estimate);
        let noise = PoseEstimate { covariance: estimate.covariance * factor, ..*estimate };
        (self.follow(time_s, &noise, common), factor)
    }

    fn follow(&mut self, time_s: f64, estimate: &PoseEstimate, common: &Matrix6<f64>) -> Continuity {
        let noise = &estimate.covariance;
        let measured = to_vector(&estimate.pose);
        let Some(track) = &mut self.track else { return Continuity::Continues };
        let mut next = track.clone();
        next.predict(time_s, &self.config);
        let Some(square) = next.least_square(&measured, &(noise + common)) else {
            self.begin(time_s, estimate, common);
            return Continuity::Continues;
        };
        if square > self.config.field_gate {
            self.contrary += 1;
            if self.contrary >= CONTRARY {
                self.begin(time_s, estimate, common);
            }
            return Continuity::Breaks;
        }
        self.contrary = 0;
        if next.update(&measured, noise) {
            next.common = *common;
            *track = next;
            self.fields += 1;
            self.all_fields += 1;
        } else {
            self.begin(time_s, estimate, common);
        }
        Continuity::Continues
    }

    fn begin(&mut self, time_s: f64, estimate: &PoseEstimate, common: &Matrix6<f64>) {
        self.contrary = 0;
        self.fields = 1;
        self.all_fields = 1;
        self.track = Some(Track::begin(time_s, estimate, common, &self.config));
    }

    /// The motion at the last field that was taken; `None` when fewer than three were since the last report, or when its range
    /// rate is one that no approach has.
    pub fn report(&mut self) -> Option<Motion> {
        let fields = std::mem::take(&mut self.fields);
        if fields < LEAST_FIELDS || self.all_fields < LEAST_FIELDS {
            return None;
        }
        let motion = self.track.as_ref()?.motion(fields);
        let rate_m_s = motion.velocity_m_s.norm();
        (rate_m_s.is_finite() && rate_m_s <= 3.0 * self.config.speed_m_s).then_some(motion)
    }
}

impl Track {
    fn begin(time_s: f64, estimate: &PoseEstimate, common: &Matrix6<f64>, config: &MotionConfig) -> Self {
        let modes = MODES.map(|part| {
            let mut state = State::zeros();
            state.fixed_rows_mut::<6>(0).copy_from(&to_vector(&estimate.pose));
            let mut covariance = Square::zeros();
            covariance.fixed_view_mut::<6, 6>(0, 0).copy_from(&estimate.covariance);
            for axis in 0..6 {
                let (rate, acceleration) = spread(config, axis);
                covariance[(6 + axis, 6 + axis)] = rate * rate;
                covariance[(12 + axis, 12 + axis)] = (part * acceleration) * (part * acceleration);
            }
            Mode { probability: 1.0 / MODES.len() as f64, state, covariance }
        });
        Self { time_s, modes, common: *common }
    }

    fn predict(&mut self, time_s: f64, config: &MotionConfig) {
        while self.time_s < time_s {
            let step_s = (time_s - self.time_s).min(STEP_S);
            self.mix(step_s);
            for (mode, part) in self.modes.iter_mut().zip(MODES) {
                mode.predict(step_s, part, config);
            }
            self.time_s = if step_s < STEP_S { time_s } else { self.time_s + step_s };
        }
    }

    /// Each filter begins from all of them, weighted by how probably it follows on each.
    fn mix(&mut self, step_s: f64) {
        let change = 1.0 - libm::exp(-step_s / CHANGE_S);
        let others = (MODES.len() - 1) as f64;
        let before = self.modes.clone();
        for (k, mode) in self.modes.iter_mut().enumerate() {
            let weight = |j: usize| {
                let passes = if j == k { 1.0 - change } else { change / others };
                passes * before[j].probability
            };
            let total: f64 = (0..MODES.len()).map(weight).sum();
            mode.probability = total;
            mode.state = before.iter().enumerate().map(|(j, one)| one.state * (weight(j) / total)).sum();
            mode.covariance = before
                .iter()
                .enumerate()
                .map(|(j, one)| {
                    let off = one.state - mode.state;
                    (one.covariance + off * off.transpose()) * (weight(j) / total)
                })
                .sum();
        }
    }

    /// The smallest normalised square by which a pose is off any filter.
    fn least_square(&self, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> Option<f64> {
        let squares = self.modes.iter().map(|mode| Some(Innovation::of(mode, measured, noise)?.square));
        squares.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::min)
    }

    /// Whether it could be done.
    fn update(&mut self, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> bool {
        let mut logs = [0.0; MODES.len()];
        for (mode, log) in self.modes.iter_mut().zip(&mut logs) {
            let Some(innovation) = Innovation::of(mode, measured, noise) else { return false };
            *log = innovation.log_likelihood + libm::log(mode.probability.max(1e-12));
            innovation.update(mode);
        }
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights = logs.map(|log| libm::exp(log - most));
        let total: f64 = weights.iter().sum();
        if !total.is_finite() {
            return false;
        }
        for (mode, weight) in self.modes.iter_mut().zip(weights) {
            mode.probability = weight / total;
        }
        self.modes.iter().all(|mode| mode.state.iter().all(|v| v.is_finite()))
    }

    /// The mean of the filters and the covariance about it, with what the fields of seconds have in common.
    fn motion(&self, fields: u32) -> Motion {
        let state: State = self.modes.iter().map(|mode| mode.state * mode.probability).sum();
        let mut covariance: Square = self
            .modes
            .iter()
            .map(|mode| {
                let off = mode.state - state;
                (mode.covariance + off * off.transpose()) * mode.probability
            })
            .sum();
        {
            let mut pose = covariance.fixed_view_mut::<6, 6>(0, 0);
            pose += self.common;
        }
        {
            let mut rate = covariance.fixed_view_mut::<6, 6>(6, 6);
            rate += self.common / (COMMON_S * COMMON_S);
        }
        let pick = |first: usize| {
            let place = |i: usize| if i < 3 { first + i } else { first + i + 3 };
            let part = Matrix6::from_fn(|i, j| covariance[(place(i), place(j))]);
            (part + part.transpose()) * 0.5
        };
        Motion {
            time_s: self.time_s,
            pose: to_pose(&state.fixed_rows::<6>(0).into_owned()),
            velocity_m_s: state.fixed_rows::<3>(6).into(),
            phi_rate_rad_s: state.fixed_rows::<3>(9).into(),
            position_covariance: pick(0),
            attitude_covariance: pick(3),
            cross_covariance: covariance.fixed_view::<3, 3>(0, 3).into(),
            fields,
        }
    }
}

/// Time over which what the fields have in common changes, s: an edge passes from pixel to pixel, a shadow over a mark.
const COMMON_S: f64 = 3.0;

/// Standard deviations of the rate and of the acceleration along an axis of the pose.
fn spread(config: &MotionConfig, axis: usize) -> (f64, f64) {
    match axis {
        0..3 => (config.speed_m_s, config.acceleration_m_s2),
        _ => (config.rotation_deg_s.to_radians(), config.angular_acceleration_deg_s2.to_radians()),
    }
}

impl Mode {
    fn predict(&mut self, step_s: f64, part: f64, config: &MotionConfig) {
        let tau_s = config.memory_s;
        // How an acceleration `s` earlier has moved place, rate and acceleration since.
        let effect = |s: f64| {
            let x = s / tau_s;
            let faded = libm::exp(-x);
            [tau_s * tau_s * (x - 1.0 + faded), tau_s * (1.0 - faded), faded]
        };
        let [place, rate, left] = effect(step_s);
        let mut by = Square::identity();
        for axis in 0..6 {
            by[(axis, 6 + axis)] = step_s;
            by[(axis, 12 + axis)] = place;
            by[(6 + axis, 12 + axis)] = rate;
            by[(12 + axis, 12 + axis)] = left;
        }
        self.state = by * self.state;
        self.covariance = by * self.covariance * by.transpose();
        // ∫ effect effectᵀ ds by Gauss and Legendre's four points.
        const POINTS: [(f64, f64); 4] = [
            (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
            (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
            (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
            (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
        ];
        let mut grown = [[0.0; 3]; 3];
        for (at, weight) in POINTS {
            let effect = effect(at * step_s);
            for (i, row) in grown.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell += weight * step_s * effect[i] * effect[j];
                }
            }
        }
        for axis in 0..6 {
            let (_, acceleration) = spread(config, axis);
            let density = 2.0 * (part * acceleration) * (part * acceleration) / tau_s;
            for (i, row) in grown.iter().enumerate() {
                for (j, cell) in row.iter().enumerate() {
                    self.covariance[(6 * i + axis, 6 * j + axis)] += density * cell;
                }
            }
        }
    }
}

/// A measured pose less a filter's.
struct Innovation {
    off: Vector6<f64>,
    noise: Matrix6<f64>,
    inverse: Matrix6<f64>,
    square: f64,
    log_likelihood: f64,
}

impl Innovation {
    fn of(mode: &Mode, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> Option<Self> {
        let off = measured - mode.state.fixed_rows::<6>(0);
        let covariance: Matrix6<f64> = mode.covariance.fixed_view::<6, 6>(0, 0) + noise;
        // Metres beside radians: scaled to a unit diagonal first.
        let scale = covariance.diagonal().map(|variance| 1.0 / variance.sqrt());
        let factor = Cholesky::new(Matrix6::from_fn(|i, j| covariance[(i, j)] * scale[i] * scale[j]))?;
        let diagonal = factor.l_dirty().diagonal();
        let log_determinant: f64 =
            diagonal.iter().zip(scale.iter()).map(|(l, s)| 2.0 * libm::log(l / s)).sum();
        let scaled = factor.inverse();
        let inverse = Matrix6::from_fn(|i, j| scaled[(i, j)] * scale[i] * scale[j]);
        let square = off.dot(&(inverse * off));
        let log_likelihood = -0.5 * (square + log_determinant);
        (square.is_finite() && log_likelihood.is_finite()).then_some(Self {
            off,
            noise: *noise,
            inverse,
            square,
            log_likelihood,
        })
    }

    fn update(&self, mode: &mut Mode) {
        let gain: SMatrix<f64, 18, 6> = mode.covariance.fixed_columns::<6>(0) * self.inverse;
        mode.state += gain * self.off;
        // Joseph's form: what is left stays a covariance, however much more is measured than was known.
        let mut kept = Square::identity();
        {
            let mut columns = kept.fixed_columns_mut::<6>(0);
            columns -= gain;
        }
        let left = kept * mode.covariance * kept.transpose() + gain * self.noise * gain.transpose();
        mode.covariance = (left + left.transpose()) * 0.5;
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{approach, normal};
    use super::*;
    use contract::docking::Pose;

    /// Covariance of a field: metres beside radians, and lateral position with attitude as strongly correlated as they are.
    fn field_covariance() -> Matrix6<f64> {
        let mut shape = Matrix6::identity();
        for (i, j, correlation) in [(0, 4, 0.98), (1, 3, -0.98)] {
            shape[(i, j)] = correlation;
            shape[(j, i)] = correlation;
        }
        let sigma = Vector6::new(4e-3, 4e-3, 2e-3, 8e-4, 8e-4, 1e-4);
        Matrix6::from_fn(|i, j| shape[(i, j)] * sigma[i] * sigma[j])
    }

    /// The pose of field `k` of a motion, with noise of the covariance.
    fn measured(motion: impl Fn(f64) -> Pose, k: u32, seed: u64) -> (f64, PoseEstimate) {
        let covariance = field_covariance();
        let root = Cholesky::new(covariance).unwrap().l();
        let t = f64::from(k) * 0.02;
        let draw = Vector6::from_fn(|i, _| normal(seed * 1_000_003 + u64::from(k) * 16 + i as u64));
        (t, PoseEstimate { pose: to_pose(&(to_vector(&motion(t)) + root * draw)), covariance })
    }

    /// Brakes from 0.3 m/s with 0.06 m/s² between 2 s and 7 s, and stands.
    fn braking(t: f64) -> Pose {
        let mut pose = approach(t.min(2.0));
        let s = (t - 2.0).clamp(0.0, 5.0);
        pose.position_m.z += -0.3 * s + 0.03 * s * s;
        pose
    }

    /// Errors of (d, φ) at the reports of a motion over their covariance, and those of d3's rate over its standard deviation.
    fn reports(motion: impl Fn(f64) -> Pose, seed: u64, seconds: u32) -> Vec<(f64, f64)> {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let mut told = Vec::new();
        for k in 0..50 * seconds {
            let (t, estimate) = measured(&motion, k, seed);
            assert_eq!(tracker.add(t, &estimate, &Matrix6::zeros()).0, Continuity::Continues, "field {k}");
            if k % 10 == 9 {
                let report = tracker.report().unwrap();
                let off = report.pose.position_m - motion(t).position_m;
                let h = 1e-3;
                let rate = (motion(t + h).position_m.z - motion(t - h).position_m.z) / (2.0 * h);
                let sigma = report.position_covariance.diagonal().map(f64::sqrt);
                told.push((off.z / sigma[2], (report.velocity_m_s.z - rate) / sigma[5]));
            }
        }
        told
    }

    fn share_within_3_sigma(motion: impl Fn(f64) -> Pose + Copy, seconds: u32) -> (f64, f64) {
        let told: Vec<(f64, f64)> = (0..10).flat_map(|seed| reports(motion, seed, seconds)).collect();
        let share = |of: &dyn Fn(&(f64, f64)) -> f64| {
            told.iter().filter(|one| of(one).abs() <= 3.0).count() as f64 / told.len() as f64
        };
        (share(&|one| one.0), share(&|one| one.1))
    }

    #[test]
    fn a_glide_and_a_braking_ship_are_within_what_is_told() {
        // 10 sequences of 15 and 45 reports, 99.7 % of which are expected within 3 σ.
        let (place, rate) = share_within_3_sigma(approach, 3);
        assert!(place >= 0.98 && rate >= 0.98, "{place} {rate}");
        let (place, rate) = share_within_3_sigma(braking, 9);
        assert!(place >= 0.98 && rate >= 0.97, "{place} {rate}");
    }

    #[test]
    fn a_steady_glide_makes_the_rate_known_better() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let mut sigmas = Vec::new();
        for k in 0..200 {
            let (t, estimate) = measured(approach, k, 1);
            tracker.add(t, &estimate, &Matrix6::zeros());
            if k % 10 == 9 {
                sigmas.push(tracker.report().unwrap().position_covariance[(5, 5)].sqrt());
            }
        }
        // A field's 2 mm over 0.2 s; and over seconds of constant velocity.
        assert!(sigmas[0] > 0.01 && sigmas[19] < 0.25 * sigmas[0], "{sigmas:?}");
    }

    #[test]
    fn a_wrong_field_breaks_the_motion_and_is_left_out() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        for k in 0..30 {
            let (t, mut estimate) = measured(approach, k, 4);
            let is_wrong = k == 20;
            if is_wrong {
                estimate.pose.position_m.z += 0.5;
                assert!(!tracker.confirms(t, &estimate));
            }
            let (continuity, _) = tracker.add(t, &estimate, &Matrix6::zeros());
            assert_eq!(continuity == Continuity::Breaks, is_wrong, "field {k}");
        }
        let motion = tracker.report().unwrap();
        assert_eq!(motion.fields, 29);
        assert!((motion.pose.position_m.z - approach(motion.time_s).position_m.z).abs() < 0.01);
    }

    #[test]
    fn fields_that_all_contradict_begin_the_motion_anew() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let elsewhere = |t: f64| {
            let mut pose = approach(t);
            pose.position_m.z += if t < 0.399 { 0.0 } else { 3.0 };
            pose
        };
        let broken = (0..40).filter(|k| {
            let (t, estimate) = measured(elsewhere, *k, 5);
            tracker.add(t, &estimate, &Matrix6::zeros()).0 == Continuity::Breaks
        });
        assert_eq!(broken.collect::<Vec<_>>(), (20..20 + CONTRARY).collect::<Vec<_>>());
    }

    #[test]
    fn what_fields_have_in_common_is_added_and_not_averaged() {
        let common = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6));
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        for k in 0..100 {
            let (t, estimate) = measured(approach, k, 6);
            tracker.add(t, &estimate, &common);
        }
        assert!(tracker.report().unwrap().position_covariance[(2, 2)] >= 1e-4);
    }

    #[test]
    fn too_few_fields_and_impossible_rates_are_not_reported() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        assert_eq!(tracker.report(), None);
        for k in 0..2 {
            let (t, estimate) = measured(approach, k, 7);
            tracker.add(t, &estimate, &Matrix6::zeros());
        }
        assert_eq!(tracker.report(), None);
        let config = MotionConfig { speed_m_s: 0.05, ..MotionConfig::default() };
        let mut slow = MotionTracker::new(config).unwrap();
        for k in 0..100 {
            let (t, estimate) = measured(approach, k, 7);
            slow.add(t, &estimate, &Matrix6::zeros());
        }
        assert_eq!(slow.report(), None, "0.3 m/s is six times the speed that is expected");
    }
}
