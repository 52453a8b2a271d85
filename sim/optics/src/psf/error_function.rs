//! Error function from a table, for images that evaluate it hundreds of times each.

use std::sync::LazyLock;

/// Error function by Taylor's polynomial of degree 5 about the nearest node of a grid, with an absolute error
/// below 1e-13.
#[derive(Debug)]
pub(super) struct ErrorFunction {
    /// Coefficients of 1, d, d² … about each node; nodes after the end are unused.
    nodes: Box<[[f64; 6]; NODES]>,
}

/// Number of nodes per unit: the next term is at most (1/128)⁶ · max|erf⁽⁶⁾|/6! = 2.3e-13 · 0.4.
const NODES_PER_UNIT: f64 = 64.0;
/// Argument from which erf is 1, to 2e-17.
const ARGUMENT_END: f64 = 6.0;
/// Number of nodes, a power of two; indices modulo this number never exceed the table.
const NODES: usize = 512;
/// In a sum with this number the last bit of a float has the value one.
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;

impl ErrorFunction {
    /// Returns the table, which is computed once.
    pub(super) fn shared() -> &'static Self {
        static TABLE: LazyLock<ErrorFunction> = LazyLock::new(ErrorFunction::new);
        &TABLE
    }

    fn new() -> Self {
        let node = |k: usize| {
            let z = k as f64 / NODES_PER_UNIT;
            let z2 = z * z;
            // The derivatives of erf are those of its density 2/√π exp(−z²): Hermite polynomials times the
            // density.
            let density = std::f64::consts::FRAC_2_SQRT_PI * libm::exp(-z2);
            [
                libm::erf(z),
                density,
                -z * density,
                (2.0 * z2 - 1.0) / 3.0 * density,
                (3.0 - 2.0 * z2) * z / 6.0 * density,
                ((4.0 * z2 - 12.0) * z2 + 3.0) / 30.0 * density,
            ]
        };
        Self { nodes: Box::new(std::array::from_fn(node)) }
    }

    /// erf(z).
    #[inline(always)]
    pub(super) fn value_at(&self, z: f64) -> f64 {
        let size = if z.abs() < ARGUMENT_END { z.abs() } else { ARGUMENT_END };
        let counted = size * NODES_PER_UNIT + TWO_TO_52;
        let [c0, c1, c2, c3, c4, c5] = self.nodes[counted.to_bits() as usize % NODES];
        let d = size - (counted - TWO_TO_52) / NODES_PER_UNIT;
        (c0 + d * (c1 + d * (c2 + d * (c3 + d * (c4 + d * c5))))).copysign(z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_error_function() {
        let erf = ErrorFunction::shared();
        for i in -70_000..70_000 {
            let z = f64::from(i) * 1.003e-4;
            let error = erf.value_at(z) - libm::erf(z);
            assert!(error.abs() < 1e-13, "{z}: {error}");
        }
        assert_eq!(
            (erf.value_at(0.0), erf.value_at(1e300), erf.value_at(f64::NEG_INFINITY)),
            (0.0, 1.0, -1.0)
        );
    }
}
