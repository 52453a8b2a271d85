//! Distributions of dispersed parameters.
use std::path::Path;

use contract::{OutOfRange, bounds};
use files::read_column;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use statistics::normal_quantile;

/// Distribution of a parameter. Every distribution is drawn by its quantile function from numbers of the unit
/// interval, and any design (Sobol, Latin hypercube) can therefore spread it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution {
    /// Normal, truncated where limits are given.
    Normal {
        /// Mean, before truncation.
        #[schemars(range(min = -1e18, max = 1e18))]
        mean: f64,
        /// Standard deviation, before truncation, > 0.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e18))]
        sigma: f64,
        /// Lower limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        min: Option<f64>,
        /// Upper limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        max: Option<f64>,
    },
    /// Uniform between two limits.
    Uniform {
        /// Lower limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        min: f64,
        /// Upper limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        max: f64,
    },
    /// Uniform over the integers from `min` to `max`, both included: for counts and seeds.
    Integer {
        /// Smallest integer, at least 0.
        #[schemars(range(max = 1_u64 << 53))]
        min: u64,
        /// Largest integer, at most 2⁵³.
        #[schemars(range(max = 1_u64 << 53))]
        max: u64,
    },
    /// Log-normal.
    LogNormal {
        /// Median, > 0.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e18))]
        median: f64,
        /// Standard deviation of the natural logarithm, > 0.
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 50))]
        sigma_ln: f64,
    },
    /// Triangular.
    Triangular {
        /// Lower limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        min: f64,
        /// Position of the highest density.
        #[schemars(range(min = -1e18, max = 1e18))]
        mode: f64,
        /// Upper limit.
        #[schemars(range(min = -1e18, max = 1e18))]
        max: f64,
    },
    /// One of several values, of any type.
    Choice {
        /// Possible values.
        #[schemars(length(min = 1))]
        values: Vec<Value>,
        /// Relative frequencies of the values; absent: equal frequencies.
        #[schemars(inner(range(min = 0, max = 1e18)))]
        weights: Option<Vec<f64>>,
    },
    /// Attitude without a preferred direction. The path is a table with `ra_deg`, `dec_deg`, `roll_deg` (a
    /// boresight uniform on the sphere and a uniform roll) or with `phi_deg`, `theta_deg`, `psi_deg` (Euler
    /// angles 123 of a rotation that is uniform over all rotations).
    IsotropicAttitude,
    /// Column of a CSV file, every row with equal probability.
    Table {
        /// Path of the file, relative to the study's directory.
        path: String,
        /// Name of the column; all its cells must be numbers.
        column: String,
    },
}

/// A distribution that is ready to be drawn from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PreparedDistribution {
    /// A distribution with its parameters.
    Distribution(Distribution),
    /// Values of a table's column.
    Column(Vec<f64>),
}

impl Distribution {
    /// Checks the parameters of the distribution.
    pub(crate) fn check(&self, path: &str) -> Result<(), OutOfRange> {
        bounds::check(self, path)?;
        let require = |is_allowed: bool, field: &str, value: &dyn std::fmt::Display, expected| {
            let refused = || OutOfRange::new(format!("{path}.{field}"), value, expected);
            if is_allowed { Ok(()) } else { Err(refused()) }
        };
        match self {
            Self::Normal { mean, sigma, min, max } => {
                let (low, high) = (min.unwrap_or(f64::MIN), max.unwrap_or(f64::MAX));
                require(low < high, "max", &high, "more than min")?;
                let inside = standard_normal((high - mean) / sigma) - standard_normal((low - mean) / sigma);
                let expected = "limits that include at least a millionth of the distribution";
                require(inside > 1e-6, "sigma", sigma, expected)
            }
            Self::Uniform { min, max } => {
                require(min < max && (max - min).is_finite(), "max", max, "more than min")
            }
            Self::Integer { min, max } => require(min <= max, "max", max, "min or more"),
            Self::LogNormal { .. } | Self::IsotropicAttitude | Self::Table { .. } => Ok(()),
            Self::Triangular { min, mode, max } => {
                require(min < max, "max", max, "more than min")?;
                require((*min..=*max).contains(mode), "mode", mode, "a number from min to max")
            }
            Self::Choice { values, weights } => {
                let Some(weights) = weights else { return Ok(()) };
                let is_allowed = weights.len() == values.len() && weights.iter().sum::<f64>() > 0.0;
                let expected = "a number >= 0 for each value, not all 0";
                require(is_allowed, "weights", &format!("{weights:?}"), expected)
            }
        }
    }

    /// Returns how many numbers of the unit interval a draw needs.
    pub(crate) fn dimensions(&self) -> usize {
        if matches!(self, Self::IsotropicAttitude) { 3 } else { 1 }
    }

    /// Reads the files that the distribution needs; paths are relative to `folder`.
    pub(crate) fn load(&self, folder: &Path) -> Result<PreparedDistribution, files::FileError> {
        match self {
            Self::Table { path, column } => {
                Ok(PreparedDistribution::Column(read_column(&folder.join(path), column)?))
            }
            distribution => Ok(PreparedDistribution::Distribution(distribution.clone())),
        }
    }
}

impl PreparedDistribution {
    /// Returns the value at the probability `u` in the open unit interval. Null for attitudes, which have
    /// other functions ([`euler_123`], [`boresight`]).
    pub(crate) fn value(&self, u: f64) -> Value {
        let number = |value: f64| serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number);
        match self {
            Self::Column(values) => values.get(index_at(u, values.len())).map_or(Value::Null, |v| number(*v)),
            Self::Distribution(distribution) => match distribution {
                Distribution::Normal { mean, sigma, min, max } => {
                    let at = |limit: Option<f64>, else_p: f64| {
                        limit.map_or(else_p, |limit| standard_normal((limit - mean) / sigma))
                    };
                    let (low, high) = (at(*min, 0.0), at(*max, 1.0));
                    let value = mean + sigma * normal_quantile(low + u * (high - low));
                    // Rounding of the probabilities may exceed a limit by one floating-point step.
                    number(value.clamp(min.unwrap_or(f64::MIN), max.unwrap_or(f64::MAX)))
                }
                Distribution::Uniform { min, max } => number(min + u * (max - min)),
                Distribution::Integer { min, max } => {
                    let count = (max - min + 1) as f64;
                    Value::from(min + ((u * count) as u64).min(max - min))
                }
                Distribution::LogNormal { median, sigma_ln } => {
                    number(median * libm::exp(sigma_ln * normal_quantile(u)))
                }
                Distribution::Triangular { min, mode, max } => {
                    let (width, rising) = (max - min, mode - min);
                    let value = if u * width < rising {
                        min + (u * width * rising).sqrt()
                    } else {
                        max - ((1.0 - u) * width * (max - mode)).sqrt()
                    };
                    number(value)
                }
                Distribution::Choice { values, weights } => {
                    let index = match weights {
                        None => index_at(u, values.len()),
                        Some(weights) => weighted_index_at(u, weights),
                    };
                    values.get(index).cloned().unwrap_or(Value::Null)
                }
                Distribution::IsotropicAttitude | Distribution::Table { .. } => Value::Null,
            },
        }
    }
}

/// Returns the index of the part that contains `u`, out of `count` equal parts of the unit interval.
fn index_at(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count.saturating_sub(1))
}

fn weighted_index_at(u: f64, weights: &[f64]) -> usize {
    let mut left = u * weights.iter().sum::<f64>();
    for (index, weight) in weights.iter().enumerate() {
        if left < *weight {
            return index;
        }
        left -= weight;
    }
    // Reached by rounding at the end of the interval: the last value with a positive weight.
    weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0)
}

/// Returns right ascension and declination of a direction that is uniform on the sphere, and a uniform roll;
/// degrees.
pub(crate) fn boresight([u, v, w]: [f64; 3]) -> [f64; 3] {
    [360.0 * u, libm::asin(2.0 * v - 1.0).to_degrees(), 360.0 * w]
}

/// Returns Euler angles 123 (φ, θ, ψ) of a rotation that is uniform over all rotations (Haar's measure has
/// the density cos θ), degrees.
pub(crate) fn euler_123([u, v, w]: [f64; 3]) -> [f64; 3] {
    [360.0 * u - 180.0, libm::asin(2.0 * v - 1.0).to_degrees(), 360.0 * w - 180.0]
}

/// Returns the probability that a standard normal random variable is below x.
fn standard_normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the values at the midpoints of `n` equal parts of the unit interval.
    fn values(distribution: Distribution, n: usize) -> Vec<f64> {
        assert_eq!(distribution.check("distribution"), Ok(()));
        let distribution = PreparedDistribution::Distribution(distribution);
        (0..n).map(|i| distribution.value((i as f64 + 0.5) / n as f64).as_f64().unwrap()).collect()
    }

    fn moments(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (mean, (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt())
    }

    /// Mean and standard deviation of each distribution in closed form; the sum over 100,000 midpoints is
    /// accurate to a few parts in 10⁵.
    #[test]
    fn the_moments_are_those_of_the_distributions() {
        let near = |distribution: Distribution, mean: f64, sigma: f64| {
            let (got_mean, got_sigma) = moments(&values(distribution.clone(), 100_000));
            assert!((got_mean - mean).abs() < 1e-4 * sigma, "{distribution:?}: mean {got_mean}, {mean}");
            assert!((got_sigma / sigma - 1.0).abs() < 1e-3, "{distribution:?}: sigma {got_sigma}, {sigma}");
        };
        near(Distribution::Normal { mean: 3.0, sigma: 2.0, min: None, max: None }, 3.0, 2.0);
        // Half a normal distribution: mean σ√(2/π), variance σ²(1 − 2/π).
        let two_over_pi = 2.0 / std::f64::consts::PI;
        near(
            Distribution::Normal { mean: 0.0, sigma: 1.0, min: Some(0.0), max: None },
            two_over_pi.sqrt(),
            (1.0 - two_over_pi).sqrt(),
        );
        near(Distribution::Uniform { min: -1.0, max: 5.0 }, 2.0, 6.0 / 12f64.sqrt());
        near(Distribution::Integer { min: 1, max: 6 }, 3.5, (35.0f64 / 12.0).sqrt());
        let s2 = 0.25f64;
        let mean = 2.0 * libm::exp(0.5 * s2);
        near(Distribution::LogNormal { median: 2.0, sigma_ln: 0.5 }, mean, mean * libm::expm1(s2).sqrt());
        // Variance of the triangular distribution: (a² + b² + c² − ab − ac − bc)/18.
        near(Distribution::Triangular { min: 0.0, mode: 1.0, max: 4.0 }, 5.0 / 3.0, (13.0f64 / 18.0).sqrt());
    }

    #[test]
    fn a_choice_comes_as_often_as_its_weight() {
        let distribution = Distribution::Choice {
            values: [1.0, 2.0, 3.0].map(Value::from).to_vec(),
            weights: Some(vec![1.0, 0.0, 3.0]),
        };
        let values = values(distribution, 1000);
        let count = |value: f64| values.iter().filter(|v| **v == value).count();
        assert_eq!([count(1.0), count(2.0), count(3.0)], [250, 0, 750]);
    }

    /// Archimedes: each coordinate of a direction that is uniform on the sphere is uniform. A rotation that
    /// is uniform over all rotations turns any direction into a uniform one.
    #[test]
    fn isotropic_attitudes_prefer_no_direction() {
        use nalgebra::{Rotation3, Vector3};
        let n = 48;
        let middle = |i: usize| (i as f64 + 0.5) / n as f64;
        let (mut sum, mut squares, mut boresights) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        for i in 0..n * n * n {
            let u = [middle(i % n), middle(i / n % n), middle(i / n / n)];
            let [phi, theta, psi] = euler_123(u).map(f64::to_radians);
            let about = |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle);
            let turned = about(Vector3::z(), psi)
                * about(Vector3::y(), theta)
                * about(Vector3::x(), phi)
                * Vector3::new(0.48, 0.6, 0.64);
            sum += turned;
            squares += turned.component_mul(&turned);
            let [ra, dec, _] = boresight(u).map(f64::to_radians);
            boresights +=
                Vector3::new(libm::cos(dec) * libm::cos(ra), libm::cos(dec) * libm::sin(ra), libm::sin(dec));
        }
        let count = (n * n * n) as f64;
        assert!((sum / count).norm() < 1e-3 && (boresights / count).norm() < 1e-3);
        for k in 0..3 {
            assert!((squares[k] / count - 1.0 / 3.0).abs() < 1e-3, "{}", squares / count);
        }
    }

    proptest! {
        #[test]
        fn a_truncated_distribution_stays_within_its_limits(
            u in 1e-12..1.0f64, mean in -5.0..5.0f64, sigma in 0.1..10.0f64, min in -5.0..0.0f64, width in 0.5..5.0f64,
        ) {
            let distribution = Distribution::Normal { mean, sigma, min: Some(min), max: Some(min + width) };
            prop_assume!(distribution.check("distribution").is_ok());
            let value = PreparedDistribution::Distribution(distribution).value(u).as_f64().unwrap();
            prop_assert!((min..=min + width).contains(&value), "{value}");
        }
    }
}
