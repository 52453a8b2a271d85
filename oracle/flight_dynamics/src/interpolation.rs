//! Polynomial interpolation between the nodes of a message.

use nalgebra::SVector;

/// Largest degree that is read: that of the simulator's samples.
pub(crate) use sim::truth::MAX_DEGREE;

/// Method of interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Polynomial with the values and derivatives of the nodes.
    Hermite,
    /// Polynomial through the values of the nodes.
    Lagrange,
    /// Straight line between two nodes.
    Linear,
}

/// Method and degree of interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interpolation {
    /// Method.
    pub method: Method,
    /// Degree of the polynomial, 1 to 19; 1 for a straight line.
    pub degree: usize,
}

impl Interpolation {
    /// Interpolation of a message that states none.
    pub const ORBIT_DEFAULT: Self = Self { method: Method::Hermite, degree: 7 };
    /// Interpolation of an attitude message that states none.
    pub const ATTITUDE_DEFAULT: Self = Self { method: Method::Linear, degree: 1 };

    /// Number of nodes of the polynomial. A Hermite polynomial of even degree gets the next odd degree.
    pub(crate) fn nodes(self) -> usize {
        match self.method {
            Method::Hermite => self.degree / 2 + 1,
            Method::Lagrange => self.degree + 1,
            Method::Linear => 2,
        }
    }
}

impl Method {
    /// Methods, for messages.
    pub(crate) const NAMES: &'static str = "HERMITE, LAGRANGE or LINEAR";

    /// Returns the keyword of CCSDS.
    pub fn code(self) -> &'static str {
        match self {
            Self::Hermite => "HERMITE",
            Self::Lagrange => "LAGRANGE",
            Self::Linear => "LINEAR",
        }
    }

    /// Parses a keyword, in capitals or not; `None` for another method.
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Hermite, Self::Lagrange, Self::Linear]
            .into_iter()
            .find(|method| method.code().eq_ignore_ascii_case(code))
    }
}

/// Returns the index of the first of `count` nodes around `time`: half of them on either side, or for an odd
/// number the nearest node in the middle; at an end, the nodes of the end. `times` ascend and are at least
/// `count`.
pub(crate) fn first_node(times: &[f64], count: usize, time: f64) -> usize {
    let after = times.partition_point(|node| *node <= time);
    let middle = if count.is_multiple_of(2) || after == 0 || after == times.len() {
        after
    } else {
        // The nearer of the two neighbours, made the last node of the lower half.
        after + usize::from(times[after] - time < time - times[after - 1])
    };
    let lower = count.div_ceil(2);
    middle.saturating_sub(lower).min(times.len().saturating_sub(count))
}

/// Value and derivative at `time` of the polynomial with the given values and derivatives.
pub(crate) fn hermite<const N: usize>(
    times: &[f64],
    values: &[SVector<f64, N>],
    derivatives: &[SVector<f64, N>],
    time: f64,
) -> (SVector<f64, N>, SVector<f64, N>) {
    let nodes: Vec<f64> = times.iter().flat_map(|node| [*node, *node]).collect();
    let mut table: Vec<SVector<f64, N>> = values.iter().flat_map(|value| [*value, *value]).collect();
    for order in 1..nodes.len() {
        // From the end, so that the lower order is still there.
        for index in (order..nodes.len()).rev() {
            let step = nodes[index] - nodes[index - order];
            table[index] =
                if step == 0.0 { derivatives[index / 2] } else { (table[index] - table[index - 1]) / step };
        }
    }
    newton(&nodes, &table, time)
}

/// Value at `time` of the polynomial through the given values, and its derivative.
pub(crate) fn lagrange<const N: usize>(
    times: &[f64],
    values: &[SVector<f64, N>],
    time: f64,
) -> (SVector<f64, N>, SVector<f64, N>) {
    let mut table = values.to_vec();
    for order in 1..times.len() {
        for index in (order..times.len()).rev() {
            table[index] = (table[index] - table[index - 1]) / (times[index] - times[index - order]);
        }
    }
    newton(times, &table, time)
}

/// Value and derivative of Newton's form.
fn newton<const N: usize>(
    nodes: &[f64],
    coefficients: &[SVector<f64, N>],
    time: f64,
) -> (SVector<f64, N>, SVector<f64, N>) {
    let mut value = SVector::zeros();
    let mut derivative = SVector::zeros();
    for (node, coefficient) in nodes.iter().zip(coefficients).rev() {
        derivative = derivative * (time - node) + value;
        value = value * (time - node) + coefficient;
    }
    (value, derivative)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector1;

    use super::*;

    fn polynomial(degree: i32, time: f64) -> (Vector1<f64>, Vector1<f64>) {
        let power = |exponent: i32| (0..exponent).fold(1.0, |product, _| product * time);
        let value: f64 = (0..=degree).map(|k| f64::from(k + 1) * power(k)).sum();
        let derivative: f64 = (1..=degree).map(|k| f64::from((k + 1) * k) * power(k - 1)).sum();
        (Vector1::new(value), Vector1::new(derivative))
    }

    #[test]
    fn a_polynomial_of_the_degree_is_exact_and_one_above_is_not() {
        let times = [-0.9, -0.4, 0.1, 0.7];
        for (degree, is_exact) in [(7, true), (8, false)] {
            let (values, slopes): (Vec<_>, Vec<_>) = times.iter().map(|t| polynomial(degree, *t)).unzip();
            let (value, slope) = hermite(&times, &values, &slopes, 0.35);
            let (expected, expected_slope) = polynomial(degree, 0.35);
            assert_eq!((value - expected).norm() < 1e-12, is_exact);
            assert_eq!((slope - expected_slope).norm() < 1e-11, is_exact);
        }
        for (degree, is_exact) in [(3, true), (4, false)] {
            let values: Vec<_> = times.iter().map(|t| polynomial(degree, *t).0).collect();
            let (value, slope) = lagrange(&times, &values, 0.35);
            let (expected, expected_slope) = polynomial(degree, 0.35);
            assert_eq!((value - expected).norm() < 1e-12, is_exact);
            assert_eq!((slope - expected_slope).norm() < 1e-11, is_exact);
        }
    }

    #[test]
    fn the_nodes_lie_around_the_time() {
        let times: Vec<f64> = (0..10).map(f64::from).collect();
        for (count, time, first) in [
            (4, 4.2, 3),
            (4, 4.0, 3),
            (4, 0.5, 0),
            (4, 9.0, 6),
            (4, 8.5, 6),
            (2, 4.2, 4),
            (2, 9.0, 8),
            (2, 0.0, 0),
            (3, 4.2, 3),
            (3, 4.7, 4),
            (10, 5.0, 0),
        ] {
            assert_eq!(first_node(&times, count, time), first, "{count} nodes at {time}");
        }
    }
}
