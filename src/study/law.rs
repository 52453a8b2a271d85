//! Laws of dispersed parameters.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::quantile::normal_quantile;
use crate::files::read_column;

/// The law of a parameter. Every law is drawn by its quantile function from numbers of the unit interval, so that a design (Sobol,
/// Latin hypercube) spreads any of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Law {
    /// Normal, cut off where limits are given (what is beyond is drawn again, in law).
    Normal {
        /// Mean, before any cutting.
        mean: f64,
        /// Standard deviation, before any cutting, > 0.
        sigma: f64,
        /// Lower limit.
        min: Option<f64>,
        /// Upper limit.
        max: Option<f64>,
    },
    /// Uniform between two limits.
    Uniform {
        /// Lower limit.
        min: f64,
        /// Upper limit.
        max: f64,
    },
    /// Uniform over the whole numbers from `min` to `max`, both included: for counts and seeds.
    Whole {
        /// Smallest number, from 0.
        min: u64,
        /// Largest number, to 2⁵³.
        max: u64,
    },
    /// The logarithm is normal.
    LogNormal {
        /// Median, > 0.
        median: f64,
        /// Standard deviation of the natural logarithm, > 0.
        sigma_ln: f64,
    },
    /// Triangular.
    Triangular {
        /// Lower limit.
        min: f64,
        /// Where the density is highest.
        mode: f64,
        /// Upper limit.
        max: f64,
    },
    /// One of some values, of any type.
    Choice {
        /// The values.
        values: Vec<Value>,
        /// How often each comes, in proportion; absent: equally often.
        weights: Option<Vec<f64>>,
    },
    /// An attitude without a preferred direction. The path is a table with `ra_deg`, `dec_deg`, `roll_deg` (a boresight uniform on
    /// the sphere and any roll) or with `phi_deg`, `theta_deg`, `psi_deg` (Euler angles 123 of a rotation that is uniform over
    /// all rotations).
    IsotropicAttitude,
    /// A column of a CSV file, every row as likely as any other.
    Table {
        /// The file, starting from the study's folder.
        path: String,
        /// The column's name; all its cells numbers.
        column: String,
    },
}

/// A value that is not allowed: field, value, what is expected.
pub(super) type Refused = (&'static str, String, &'static str);

/// A law that is ready to be drawn from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Drawable {
    /// A law with its parameters.
    Law(Law),
    /// The column of a table.
    Column(Vec<f64>),
}

impl Law {
    /// Checks the parameters.
    pub(super) fn check(&self) -> Result<(), Refused> {
        let finite = |field, value: f64| {
            if value.is_finite() { Ok(()) } else { Err((field, value.to_string(), "a finite number")) }
        };
        let require = |is_allowed: bool, field, value: String, expected| {
            if is_allowed { Ok(()) } else { Err((field, value, expected)) }
        };
        match self {
            Self::Normal { mean, sigma, min, max } => {
                finite("mean", *mean)?;
                require(*sigma > 0.0 && sigma.is_finite(), "sigma", sigma.to_string(), "a number > 0")?;
                let (low, high) = (min.unwrap_or(f64::MIN), max.unwrap_or(f64::MAX));
                require(low < high, "max", high.to_string(), "more than min")?;
                let inside = standard_normal((high - mean) / sigma) - standard_normal((low - mean) / sigma);
                require(
                    inside > 1e-6,
                    "sigma",
                    sigma.to_string(),
                    "limits between which a millionth of the law lies at least",
                )
            }
            Self::Uniform { min, max } => {
                finite("min", *min)?;
                finite("max", *max)?;
                require(min < max && (max - min).is_finite(), "max", max.to_string(), "more than min")
            }
            Self::Whole { min, max } => {
                require(*max <= 1 << 53, "max", max.to_string(), "a whole number up to 2^53")?;
                require(min <= max, "max", max.to_string(), "min or more")
            }
            Self::LogNormal { median, sigma_ln } => {
                require(*median > 0.0 && median.is_finite(), "median", median.to_string(), "a number > 0")?;
                require(*sigma_ln > 0.0 && *sigma_ln < 50.0, "sigma_ln", sigma_ln.to_string(), "0 to 50")
            }
            Self::Triangular { min, mode, max } => {
                finite("min", *min)?;
                finite("max", *max)?;
                require(min < max, "max", max.to_string(), "more than min")?;
                require((*min..=*max).contains(mode), "mode", mode.to_string(), "a number from min to max")
            }
            Self::Choice { values, weights } => {
                require(!values.is_empty(), "values", "[]".to_owned(), "one value or more")?;
                let Some(weights) = weights else { return Ok(()) };
                let is_allowed = weights.len() == values.len()
                    && weights.iter().all(|w| *w >= 0.0 && w.is_finite())
                    && weights.iter().sum::<f64>() > 0.0;
                require(
                    is_allowed,
                    "weights",
                    format!("{weights:?}"),
                    "a number >= 0 for each value, not all 0",
                )
            }
            Self::IsotropicAttitude | Self::Table { .. } => Ok(()),
        }
    }

    /// How many numbers of the unit interval a draw takes.
    pub(super) fn dimensions(&self) -> usize {
        if matches!(self, Self::IsotropicAttitude) { 3 } else { 1 }
    }

    /// Reads what the law needs from files; paths start from `folder`.
    pub(super) fn load(&self, folder: &Path) -> Result<Drawable, crate::files::FileError> {
        match self {
            Self::Table { path, column } => Ok(Drawable::Column(read_column(&folder.join(path), column)?)),
            law => Ok(Drawable::Law(law.clone())),
        }
    }
}

impl Drawable {
    /// The value at numbers of the open unit interval, as many as the law has dimensions. Attitudes are not drawn here
    /// ([`euler_123`], [`boresight`]): null.
    pub(super) fn value(&self, u: f64) -> Value {
        let number = |value: f64| serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number);
        match self {
            Self::Column(values) => values.get(place(u, values.len())).map_or(Value::Null, |v| number(*v)),
            Self::Law(law) => match law {
                Law::Normal { mean, sigma, min, max } => {
                    let at = |limit: Option<f64>, else_p: f64| {
                        limit.map_or(else_p, |limit| standard_normal((limit - mean) / sigma))
                    };
                    let (low, high) = (at(*min, 0.0), at(*max, 1.0));
                    let value = mean + sigma * normal_quantile(low + u * (high - low));
                    // Rounding of the probabilities may lead beyond a limit by a unit in the last place.
                    number(value.clamp(min.unwrap_or(f64::MIN), max.unwrap_or(f64::MAX)))
                }
                Law::Uniform { min, max } => number(min + u * (max - min)),
                Law::Whole { min, max } => {
                    let count = (max - min + 1) as f64;
                    Value::from(min + ((u * count) as u64).min(max - min))
                }
                Law::LogNormal { median, sigma_ln } => {
                    number(median * libm::exp(sigma_ln * normal_quantile(u)))
                }
                Law::Triangular { min, mode, max } => {
                    let (width, rising) = (max - min, mode - min);
                    let value = if u * width < rising {
                        min + (u * width * rising).sqrt()
                    } else {
                        max - ((1.0 - u) * width * (max - mode)).sqrt()
                    };
                    number(value)
                }
                Law::Choice { values, weights } => {
                    let index = match weights {
                        None => place(u, values.len()),
                        Some(weights) => weighted_place(u, weights),
                    };
                    values.get(index).cloned().unwrap_or(Value::Null)
                }
                Law::IsotropicAttitude | Law::Table { .. } => Value::Null,
            },
        }
    }
}

/// Which of `count` equal parts of the unit interval a number lies in.
fn place(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count.saturating_sub(1))
}

fn weighted_place(u: f64, weights: &[f64]) -> usize {
    let mut left = u * weights.iter().sum::<f64>();
    for (index, weight) in weights.iter().enumerate() {
        if left < *weight {
            return index;
        }
        left -= weight;
    }
    // Rounding at the end of the interval: the last value that comes at all.
    weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0)
}

/// Right ascension and declination of a direction that is uniform on the sphere, and a uniform roll; degrees.
pub(super) fn boresight([u, v, w]: [f64; 3]) -> [f64; 3] {
    [360.0 * u, libm::asin(2.0 * v - 1.0).to_degrees(), 360.0 * w]
}

/// Euler angles 123 (φ, θ, ψ) of a rotation that is uniform over all rotations (Haar's measure has the density cos θ), degrees.
pub(super) fn euler_123([u, v, w]: [f64; 3]) -> [f64; 3] {
    [360.0 * u - 180.0, libm::asin(2.0 * v - 1.0).to_degrees(), 360.0 * w - 180.0]
}

/// Probability of a standard normal number below x.
fn standard_normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}
