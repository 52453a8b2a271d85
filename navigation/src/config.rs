//! Parameters of the built-in navigators.

use contract::OutOfRange;
use contract::bounds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::short_period::Osculation;

/// Parameters of the batch least squares.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BatchConfig {
    /// Relation of mean elements and states.
    pub osculation: Osculation,
    /// Largest residual of a used measurement, in standard deviations of two jointly normal angles, 2 to 100.
    #[schemars(range(min = 2, max = 100))]
    pub outlier_sigma: f64,
    /// Stochastic impulses for errors of the dynamics; `None`: the dynamics are exact.
    pub model_errors: Option<ModelErrors>,
}

impl Default for BatchConfig {
    fn default() -> Self {
        Self { osculation: Osculation::default(), outlier_sigma: 5.0, model_errors: None }
    }
}

impl BatchConfig {
    /// Checks the range of every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "navigation.batch")
    }
}

/// Stochastic impulses at regular times, estimated with a prior of zero mean (pseudo-stochastic pulses:
/// Beutler et al. 2006, Journal of Geodesy 80, 353): relative accelerations that the dynamics omit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelErrors {
    /// Interval, s, 600 to 1e6; at most 200 impulses are placed, so a longer campaign has a longer interval.
    #[schemars(range(min = 600, max = 1e6))]
    pub interval_s: f64,
    /// Standard deviation along R, T, N, m/s, each 0 to 1.
    #[schemars(inner(range(min = 0, max = 1)))]
    pub sigma_rtn_m_s: [f64; 3],
}

/// Parameters of the sequential filter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SequentialConfig {
    /// Relation of mean elements and states.
    pub osculation: Osculation,
    /// Largest innovation of a used measurement, in standard deviations of two jointly normal angles, 2 to
    /// 100.
    #[schemars(range(min = 2, max = 100))]
    pub outlier_sigma: f64,
    /// Spectral density of white relative acceleration along R, T, N as the standard deviation of the change
    /// of velocity in an hour, m/s, each 0 to 1: errors of the dynamics.
    #[schemars(inner(range(min = 0, max = 1)))]
    pub velocity_noise_m_s_per_hour: [f64; 3],
    /// Time for which late measurements are inserted, s, 0 to 1e6; later ones are not used.
    #[schemars(range(min = 0, max = 1e6))]
    pub buffer_s: f64,
    /// Number of events that are linearised again when the estimate has moved, 0 to 1000000; older ones keep
    /// their linearisation.
    #[schemars(range(min = 0, max = 1_000_000))]
    pub history: usize,
    /// Number of measurements between two attempts to find an initial orbit without a prior, 4 to 10000.
    #[schemars(range(min = 4, max = 10000))]
    pub initial_measurements: usize,
}

impl Default for SequentialConfig {
    fn default() -> Self {
        Self {
            osculation: Osculation::default(),
            outlier_sigma: 5.0,
            velocity_noise_m_s_per_hour: [0.0; 3],
            buffer_s: 3600.0,
            history: 20_000,
            initial_measurements: 100,
        }
    }
}

impl SequentialConfig {
    /// Checks the range of every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "navigation.sequential")
    }
}
