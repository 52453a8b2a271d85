//! Motion by four filters of one state that differ in the camera's acceleration, with a probability for each.
//!
//! State: (d, φ), its rates and accelerations, and two errors of the station's outline: of its scale, and of
//! the position of its edge in the image. An acceleration is a random function of time with a standard
//! deviation σ and a memory τ (Singer 1970). The filters have σ, 0.2 σ and 0.03 σ on all axes; the fourth has
//! 0.3 σ along the axis of the approach and 0.03 σ on the others. They exchange their estimates once a second
//! according to the probabilities of a change between them (interacting multiple models: Blom & Bar-Shalom
//! 1988). A hold or a glide is followed with a small σ, a braking ship with a large one, and the covariance
//! includes the uncertainty about which filter applies.

use contract::docking::{Motion, PoseEstimate};
use contract::{OutOfRange, bounds};
use nalgebra::{Cholesky, Matrix6, SMatrix, SVector, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::docking::pose::geometry::{to_pose, to_vector};

const SIZE: usize = 20;
/// Index of the outline's scale error in the state, relative to the radius.
const SCALE: usize = 18;
/// Index of the outline's edge error in the state, px outwards.
const EDGE: usize = 19;
type State = SVector<f64, SIZE>;
type Square = SMatrix<f64, SIZE, SIZE>;

/// Limits of the camera's motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// Standard deviation of each component of acceleration while the ship manoeuvres, m/s², above 0 to 100:
    /// a change of speed by 0.8 m/s within 3 s.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub acceleration_m_s2: f64,
    /// Standard deviation of each component of angular acceleration while the ship manoeuvres, degrees/s²,
    /// above 0 to 100.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub angular_acceleration_deg_s2: f64,
    /// Correlation time of an acceleration, s, 0.1 to 1000.
    #[schemars(range(min = 0.1, max = 1000))]
    pub memory_s: f64,
    /// Standard deviation of each component of velocity before any measurement, m/s, above 0 to 100. A motion
    /// whose speed exceeds three standard deviations is not reported.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub speed_m_s: f64,
    /// Standard deviation of each component of angular velocity before any measurement, degrees/s, above 0 to
    /// 100.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub rotation_deg_s: f64,
    /// Largest normalised square of the difference between a field's pose and the motion (chi-square of 6
    /// degrees of freedom), above 0 to 1e12. Fields with a larger one are left out.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub field_gate: f64,
}

impl Default for MotionConfig {
    /// Returns the values for a docking cargo ship, with a gate that noise exceeds once in 10⁷ fields.
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
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "motion")
    }
}

/// Accelerations of the filters along the axes of the pose, relative to the configured one. In the last, the
/// ship brakes along the axis of the approach and holds everything else.
const MODES: [[f64; 6]; 4] = [[1.0; 6], [0.2; 6], [0.03; 6], [0.03, 0.03, 0.3, 0.03, 0.03, 0.03]];

/// Time between exchanges of the filters' estimates, s. A change of acceleration shows in many fields, and
/// the filters' probabilities need as many from each filter alone. An exchange at every field would make all
/// filters that of the most probable one.
const MIXING_S: f64 = 1.0;

/// Mean time between changes from one filter's motion to another's, s.
const CHANGE_S: f64 = 5.0;

/// Relative error of the radius of a station's outline, one standard deviation, and the change of this error
/// within a second. Causes: a rim that is brighter than the face, a shadow on it, structure visible behind
/// it.
const OUTLINE_SCALE: f64 = 0.01;
const OUTLINE_DRIFT: f64 = 2e-4;

/// Error of the radius of a station's outline that is the same in pixels at every range, px, one standard
/// deviation: blur moves the steepest fall of brightness towards the darker or the narrower side of a rim, by
/// a part of its own width of 0.6 to 1 px. As a relative error it decreases with the range, which would
/// otherwise appear as a range rate.
const OUTLINE_EDGE_PX: f64 = 0.5;

/// Standard deviations of the lateral offset, relative to the range, and of the attitude, rad, before any
/// pose is measured.
const PRIOR_OFFSET_SHARE: f64 = 0.2;
const PRIOR_ANGLE_RAD: f64 = 0.2;

/// Range by a station's outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::docking) struct OutlineRange {
    /// d3, m.
    pub(in crate::docking) range_m: f64,
    /// Standard deviation of the range from field to field, m, without errors common to many fields.
    pub(in crate::docking) sigma_m: f64,
    /// Radius of the outline, px.
    pub(in crate::docking) radius_px: f64,
}

/// Longest step of a prediction, s. Accelerations fade within some of these steps.
const STEP_S: f64 = 0.5;

/// State of the filters at one time.
#[derive(Debug, Clone)]
pub(super) struct Track {
    pub(super) time_s: f64,
    /// Time at which the filters last exchanged their estimates, s.
    mixed_s: f64,
    modes: [Mode; MODES.len()],
    /// Covariance of the errors common to the fields of several seconds, added to that of the filters.
    pub(super) common: Matrix6<f64>,
}

/// One filter.
#[derive(Debug, Clone)]
struct Mode {
    probability: f64,
    state: State,
    covariance: Square,
}

impl Track {
    pub(super) fn begin(
        time_s: f64,
        estimate: &PoseEstimate,
        common: &Matrix6<f64>,
        config: &MotionConfig,
    ) -> Self {
        let modes = MODES.map(|part| {
            let mut state = State::zeros();
            state.fixed_rows_mut::<6>(0).copy_from(&to_vector(&estimate.pose));
            let mut covariance = Square::zeros();
            covariance.fixed_view_mut::<6, 6>(0, 0).copy_from(&estimate.covariance);
            for (axis, part) in part.into_iter().enumerate() {
                let (rate, acceleration) = spread(config, axis);
                covariance[(6 + axis, 6 + axis)] = rate * rate;
                covariance[(12 + axis, 12 + axis)] = (part * acceleration) * (part * acceleration);
            }
            covariance[(SCALE, SCALE)] = OUTLINE_SCALE * OUTLINE_SCALE;
            covariance[(EDGE, EDGE)] = OUTLINE_EDGE_PX * OUTLINE_EDGE_PX;
            Mode { probability: 1.0 / MODES.len() as f64, state, covariance }
        });
        Self { time_s, mixed_s: time_s, modes, common: *common }
    }

    pub(super) fn predict(&mut self, time_s: f64, config: &MotionConfig) {
        while self.time_s < time_s {
            let step_s = (time_s - self.time_s).min(STEP_S);
            let apart_s = self.time_s + step_s - self.mixed_s;
            if apart_s >= MIXING_S {
                self.mix(apart_s, config);
                self.mixed_s = self.time_s + step_s;
            }
            for (mode, part) in self.modes.iter_mut().zip(&MODES) {
                mode.predict(step_s, part, config);
            }
            self.time_s = if step_s < STEP_S { time_s } else { self.time_s + step_s };
        }
    }

    /// Begins from a station's outline only, which determines only the range.
    pub(super) fn begin_at_range(time_s: f64, range: &OutlineRange, config: &MotionConfig) -> Self {
        let (position, angle) = (PRIOR_OFFSET_SHARE * range.range_m, PRIOR_ANGLE_RAD);
        let sigma = Vector6::new(position, position, position, angle, angle, angle);
        let covariance = Matrix6::from_diagonal(&sigma.component_mul(&sigma));
        let pose = to_pose(&Vector6::new(0.0, 0.0, range.range_m, 0.0, 0.0, 0.0));
        let mut track = Self::begin(time_s, &PoseEstimate { pose, covariance }, &Matrix6::zeros(), config);
        track.update_range(range);
        track
    }

    /// Mixes the filters: each begins from all of them, weighted by the probability of a transition. A
    /// transition is a thruster that is switched on or off, so the acceleration begins anew.
    fn mix(&mut self, step_s: f64, config: &MotionConfig) {
        let change = 1.0 - libm::exp(-step_s / CHANGE_S);
        let others = (MODES.len() - 1) as f64;
        let before = self.modes.clone();
        for (k, mode) in self.modes.iter_mut().enumerate() {
            let weight = |j: usize| {
                let passes = if j == k { 1.0 - change } else { change / others };
                passes * before[j].probability
            };
            let total: f64 = (0..MODES.len()).map(weight).sum();
            let from: [Mode; MODES.len()] = std::array::from_fn(|j| {
                if j == k { before[j].clone() } else { before[j].switched(&MODES[k], config) }
            });
            mode.probability = total;
            mode.state = from.iter().enumerate().map(|(j, one)| one.state * (weight(j) / total)).sum();
            mode.covariance = from
                .iter()
                .enumerate()
                .map(|(j, one)| {
                    let off = one.state - mode.state;
                    (one.covariance + off * off.transpose()) * (weight(j) / total)
                })
                .sum();
        }
    }

    /// Returns the smallest normalised square, over the filters, of the difference between a pose and the
    /// prediction.
    pub(super) fn least_square(&self, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> Option<f64> {
        let squares =
            self.modes.iter().map(|mode| Some(Innovation::from_pose(mode, measured, noise)?.square));
        squares.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::min)
    }

    /// Returns the smallest normalised square, over the filters, of the difference between the range by a
    /// station's outline and the prediction.
    pub(super) fn least_square_of_range(&self, range: &OutlineRange) -> f64 {
        self.modes
            .iter()
            .map(|mode| RangeInnovation::from_range(mode, range).square())
            .fold(f64::INFINITY, f64::min)
    }

    /// Updates the filters with a measured pose. Returns true on success.
    pub(super) fn update(&mut self, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> bool {
        let mut logs = [0.0; MODES.len()];
        for (mode, log) in self.modes.iter_mut().zip(&mut logs) {
            let Some(innovation) = Innovation::from_pose(mode, measured, noise) else { return false };
            *log = innovation.log_likelihood;
            innovation.update(mode);
        }
        self.update_probabilities(logs)
    }

    /// Updates the filters with a range by a station's outline. Returns true on success.
    pub(super) fn update_range(&mut self, range: &OutlineRange) -> bool {
        let mut logs = [0.0; MODES.len()];
        for (mode, log) in self.modes.iter_mut().zip(&mut logs) {
            let innovation = RangeInnovation::from_range(mode, range);
            *log = -0.5 * (innovation.square() + libm::log(innovation.variance));
            innovation.update(mode);
        }
        self.update_probabilities(logs)
    }

    /// Updates the filters' probabilities by the likelihoods of their predictions. Returns true if all states
    /// are finite.
    fn update_probabilities(&mut self, logs: [f64; MODES.len()]) -> bool {
        let mut weights = logs;
        for (weight, mode) in weights.iter_mut().zip(&self.modes) {
            *weight += libm::log(mode.probability.max(1e-12));
        }
        let most = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights = weights.map(|log| libm::exp(log - most));
        let total: f64 = weights.iter().sum();
        if !total.is_finite() {
            return false;
        }
        for (mode, weight) in self.modes.iter_mut().zip(weights) {
            mode.probability = weight / total;
        }
        self.modes.iter().all(|mode| mode.state.iter().all(|v| v.is_finite()))
    }

    /// Returns the expected products of the rates of the pose.
    pub(super) fn squares_of_rates(&self) -> Matrix6<f64> {
        let of_mode = |mode: &Mode| {
            let rate = mode.state.fixed_rows::<6>(6);
            (mode.covariance.fixed_view::<6, 6>(6, 6) + rate * rate.transpose()) * mode.probability
        };
        self.modes.iter().map(of_mode).sum()
    }

    /// Returns the mean of the filters and its covariance, including the errors common to the fields of
    /// several seconds.
    pub(super) fn motion(&self, fields: u32) -> Motion {
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
            let position = |i: usize| if i < 3 { first + i } else { first + i + 3 };
            let part = Matrix6::from_fn(|i, j| covariance[(position(i), position(j))]);
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

/// Time over which the common errors of fields change, s: an edge passes from pixel to pixel, a shadow over a
/// mark.
const COMMON_S: f64 = 3.0;

/// Returns the standard deviations of the rate and of the acceleration along an axis of the pose.
fn spread(config: &MotionConfig, axis: usize) -> (f64, f64) {
    match axis {
        0..3 => (config.speed_m_s, config.acceleration_m_s2),
        _ => (config.rotation_deg_s.to_radians(), config.angular_acceleration_deg_s2.to_radians()),
    }
}

/// Returns the expected products of the rates, as [`Track::squares_of_rates`], before any measurement.
pub(super) fn unknown_rates(config: &MotionConfig) -> Matrix6<f64> {
    let rates = Vector6::from_fn(|axis, _| spread(config, axis).0);
    Matrix6::from_diagonal(&rates.component_mul(&rates))
}

impl Mode {
    /// Returns the filter with its accelerations reset to zero mean and their standard deviation.
    fn switched(&self, part: &[f64; 6], config: &MotionConfig) -> Self {
        let mut switched = self.clone();
        for (axis, part) in part.iter().enumerate() {
            let (_, acceleration) = spread(config, axis);
            let i = 12 + axis;
            switched.state[i] = 0.0;
            switched.covariance.row_mut(i).fill(0.0);
            switched.covariance.column_mut(i).fill(0.0);
            switched.covariance[(i, i)] = (part * acceleration) * (part * acceleration);
        }
        switched
    }

    fn predict(&mut self, step_s: f64, part: &[f64; 6], config: &MotionConfig) {
        let tau_s = config.memory_s;
        // Effect of an acceleration `s` earlier on position, rate and acceleration now.
        let effect = |s: f64| {
            let x = s / tau_s;
            let faded = libm::exp(-x);
            [tau_s * tau_s * (x - 1.0 + faded), tau_s * (1.0 - faded), faded]
        };
        let [position, rate, left] = effect(step_s);
        let mut by = Square::identity();
        for axis in 0..6 {
            by[(axis, 6 + axis)] = step_s;
            by[(axis, 12 + axis)] = position;
            by[(6 + axis, 12 + axis)] = rate;
            by[(12 + axis, 12 + axis)] = left;
        }
        self.state = by * self.state;
        self.covariance = by * self.covariance * by.transpose();
        self.covariance[(SCALE, SCALE)] += OUTLINE_DRIFT * OUTLINE_DRIFT * step_s;
        // ∫ effect effectᵀ ds by four-point Gauss–Legendre quadrature.
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
        for (axis, part) in part.iter().enumerate() {
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

/// Difference between a measured pose and a filter's.
struct Innovation {
    off: Vector6<f64>,
    noise: Matrix6<f64>,
    inverse: Matrix6<f64>,
    square: f64,
    log_likelihood: f64,
}

impl Innovation {
    fn from_pose(mode: &Mode, measured: &Vector6<f64>, noise: &Matrix6<f64>) -> Option<Self> {
        let off = measured - mode.state.fixed_rows::<6>(0);
        let covariance: Matrix6<f64> = mode.covariance.fixed_view::<6, 6>(0, 0) + noise;
        // Metres and radians differ in scale, so the matrix is first scaled to a unit diagonal.
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
        let gain: SMatrix<f64, SIZE, 6> = mode.covariance.fixed_columns::<6>(0) * self.inverse;
        mode.state += gain * self.off;
        // Joseph's form: the result remains a valid covariance even if the measurement is much more accurate
        // than the prior.
        let mut kept = Square::identity();
        {
            let mut columns = kept.fixed_columns_mut::<6>(0);
            columns -= gain;
        }
        let left = kept * mode.covariance * kept.transpose() + gain * self.noise * gain.transpose();
        mode.covariance = (left + left.transpose()) * 0.5;
    }
}

/// Difference between the range by a station's outline and a filter's.
struct RangeInnovation {
    off_m: f64,
    /// Derivative of the range with respect to the state.
    by_state: State,
    variance: f64,
}

impl RangeInnovation {
    fn from_range(mode: &Mode, range: &OutlineRange) -> Self {
        let mut by_state = State::zeros();
        (by_state[2], by_state[SCALE]) = (1.0, range.range_m);
        by_state[EDGE] = -range.range_m / range.radius_px;
        let variance = by_state.dot(&(mode.covariance * by_state)) + range.sigma_m * range.sigma_m;
        Self { off_m: range.range_m - by_state.dot(&mode.state), by_state, variance }
    }

    fn square(&self) -> f64 {
        self.off_m * self.off_m / self.variance
    }

    fn update(&self, mode: &mut Mode) {
        let gain = mode.covariance * self.by_state / self.variance;
        mode.state += gain * self.off_m;
        mode.covariance -= gain * gain.transpose() * self.variance;
    }
}
