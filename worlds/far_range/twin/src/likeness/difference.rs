//! The statement on a figure.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::estimate::Estimate;

/// Quantile of the normal distribution for 95 % on both sides, and on one side.
const Z_95: f64 = 1.959_963_984_540_054;
const Z_95_ONE_SIDED: f64 = 1.644_853_626_951_472;

/// Unit of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Unit {
    /// Digital numbers.
    #[serde(rename = "DN")]
    Dn,
    /// Squares of digital numbers.
    #[serde(rename = "DN^2")]
    SquareDn,
    /// Pixels.
    #[serde(rename = "px")]
    Pixels,
    /// A plain number.
    #[serde(rename = "")]
    Number,
    /// Magnitudes per magnitude of B−V.
    #[serde(rename = "mag/mag")]
    MagnitudePerColour,
    /// Percent of the value of the camera; the values are not stated, because they differ from star to star.
    #[serde(rename = "%")]
    Percent,
}

impl Unit {
    /// Returns the unit as it is printed.
    pub fn words(self) -> &'static str {
        match self {
            Self::Dn => "DN",
            Self::SquareDn => "DN²",
            Self::Pixels => "px",
            Self::Number => "",
            Self::MagnitudePerColour => "mag/mag",
            Self::Percent => "%",
        }
    }
}

/// A figure of both sets of frames, with the difference of the two.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Likeness {
    /// Code, unique, in snake case.
    pub code: &'static str,
    /// Name.
    pub name: &'static str,
    /// Unit of all values.
    pub unit: Unit,
    /// Value of the camera; `None` for a figure that is the mean of ratios.
    pub camera: Option<f64>,
    /// Value of the twin.
    pub twin: Option<f64>,
    /// Twin minus camera.
    pub difference: f64,
    /// Half of the interval of 95 % of the difference: Student's t with the degrees of freedom of Welch and
    /// Satterthwaite.
    pub limit: f64,
    /// Difference that would be recognised with a probability of 95 %.
    pub visible: f64,
    /// Probability of a difference at least as large if there is none.
    pub probability: f64,
}

impl Likeness {
    /// States a figure of which each set has an estimate.
    pub(crate) fn new(
        code: &'static str,
        name: &'static str,
        unit: Unit,
        [camera, twin]: [Estimate; 2],
    ) -> Self {
        let difference = Estimate {
            value: twin.value - camera.value,
            sigma: libm::hypot(camera.sigma, twin.sigma),
            freedom: joint_freedom(camera, twin),
        };
        let paired = Self::of_difference(code, name, unit, difference);
        Self { camera: Some(camera.value), twin: Some(twin.value), ..paired }
    }

    /// States a figure of which the difference is estimated directly, star by star.
    pub(crate) fn of_difference(
        code: &'static str,
        name: &'static str,
        unit: Unit,
        difference: Estimate,
    ) -> Self {
        let quantile = student_quantile(difference.freedom);
        Self {
            code,
            name,
            unit,
            camera: None,
            twin: None,
            difference: difference.value,
            limit: quantile * difference.sigma,
            visible: (quantile + Z_95_ONE_SIDED) * difference.sigma,
            probability: chance_of(difference),
        }
    }

    /// States a figure of which the logarithm of the ratio, twin over camera, is estimated: in percent.
    pub(crate) fn of_ratio(code: &'static str, name: &'static str, ln_ratio: Estimate) -> Self {
        let of_logarithm = Self::of_difference(code, name, Unit::Percent, ln_ratio);
        let percent = |logarithm: f64| 100.0 * libm::expm1(logarithm);
        // The limit on the side of the difference, so that both contain 0 or neither.
        let limit = percent(of_logarithm.limit.copysign(ln_ratio.value)).abs();
        Self {
            difference: percent(ln_ratio.value),
            limit,
            visible: percent(of_logarithm.visible),
            ..of_logarithm
        }
    }

    /// Returns true if the interval of the difference contains 0.
    pub fn is_indistinguishable(&self) -> bool {
        self.difference.abs() <= self.limit
    }
}

/// A figure that the frames do not give.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotCompared {
    /// Name of the figure.
    pub name: &'static str,
    /// What the frames lack.
    pub reason: String,
}

/// Returns the degrees of freedom of the difference of two estimates (Welch 1947, Satterthwaite 1946).
fn joint_freedom(first: Estimate, second: Estimate) -> f64 {
    let (first_square, second_square) = (first.sigma * first.sigma, second.sigma * second.sigma);
    let sum = first_square + second_square;
    let of_errors =
        first_square * first_square / first.freedom + second_square * second_square / second.freedom;
    if of_errors > 0.0 { sum * sum / of_errors } else { f64::INFINITY }
}

/// Returns the probability of a difference at least as large, on either side, if there is none.
fn chance_of(difference: Estimate) -> f64 {
    if difference.sigma <= 0.0 {
        return if difference.value == 0.0 { 1.0 } else { 0.0 };
    }
    let t = (difference.value / difference.sigma).abs();
    // Beyond a million degrees of freedom Student's t is normal.
    let freedom = difference.freedom.clamp(1.0, 1e6);
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |student| 2.0 * student.sf(t))
}

/// Returns the 97.5 % quantile of Student's t.
fn student_quantile(freedom: f64) -> f64 {
    // Beyond a million the difference from the normal distribution is below 1e-6.
    if freedom > 1e6 {
        return Z_95;
    }
    StudentsT::new(0.0, 1.0, freedom.max(1.0)).map_or(f64::INFINITY, |student| student.inverse_cdf(0.975))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_welch() {
        // Two samples of ten with standard deviations of their means of 3 and 4: 5, with 9 · 625/337 = 16.7
        // degrees of freedom and a quantile of 2.113 (scipy.stats.t.ppf(0.975, 16.691)).
        let sample = |value, sigma| Estimate { value, sigma, freedom: 9.0 };
        let found = Likeness::new("a", "a", Unit::Dn, [sample(100.0, 3.0), sample(110.0, 4.0)]);
        assert!((found.limit - 5.0 * 2.112_8).abs() < 2e-3, "{found:?}");
        assert!((found.visible - found.limit - 5.0 * Z_95_ONE_SIDED).abs() < 1e-9);
        assert!(found.is_indistinguishable() && found.difference == 10.0);
        let far = Likeness::new("a", "a", Unit::Dn, [sample(100.0, 3.0), sample(111.0, 4.0)]);
        assert!(!far.is_indistinguishable());
    }

    #[test]
    fn two_known_errors_give_the_normal_quantile() {
        let found = Likeness::new("a", "a", Unit::Dn, [Estimate::known(0.0, 1.0); 2]);
        assert!((found.limit - Z_95 * std::f64::consts::SQRT_2).abs() < 1e-12);
    }
}
