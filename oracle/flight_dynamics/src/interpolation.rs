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

/// Value at `time` of the polynomial through the given values (Newton's form).
pub(crate) fn lagrange<const N: usize>(
    times: &[f64],
    values: &[SVector<f64, N>],
    time: f64,
) -> SVector<f64, N> {
    let mut table = values.to_vec();
    for order in 1..times.len() {
        // From the end, so that the lower order is still there.
        for index in (order..times.len()).rev() {
            table[index] = (table[index] - table[index - 1]) / (times[index] - times[index - order]);
        }
    }
    let nodes = times.iter().zip(&table).rev();
    nodes.fold(SVector::zeros(), |value, (node, coefficient)| value * (time - node) + coefficient)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector1;

    use super::*;

    #[test]
    fn a_polynomial_of_the_degree_is_exact_and_one_above_is_not() {
        let polynomial = |degree: i32, time: f64| {
            let power = |exponent: i32| (0..exponent).fold(1.0, |product, _| product * time);
            Vector1::new((0..=degree).map(|k| f64::from(k + 1) * power(k)).sum::<f64>())
        };
        let times = [-0.9, -0.4, 0.1, 0.7];
        for (degree, is_exact) in [(3, true), (4, false)] {
            let values: Vec<_> = times.iter().map(|t| polynomial(degree, *t)).collect();
            let error = (lagrange(&times, &values, 0.35) - polynomial(degree, 0.35)).norm();
            assert_eq!(error < 1e-12, is_exact);
        }
    }
}
